"""What leaving effects and cells out saves: instructions, as callgrind counts them, and times of one run."""

import json
import os
import pathlib
import subprocess

# Shares of the evaluation of two different yarns of 6 layers with all their paths.
LIMITS = {"specular only": 0.35, "diffuse only": 0.05, "no-colour": 0.55}
CELLS = {"inout:24x96x24x96": 0.15, "halfdiff3d:90x90x180": None}
# Clearing memory in one instruction, which callgrind counts byte by byte, becomes a loop.
COUNTABLE = os.environ | {"GLIBC_TUNABLES": "glibc.cpu.x86_rep_stosb_threshold=0x7fffffff"}


def output(*command, env=None):
    return subprocess.run(command, env=env, check=True, capture_output=True, text=True).stdout


def instructions(bench, case, plans, folder):
    counts = folder / "callgrind.out"
    output("valgrind", "--tool=callgrind", "--instr-atstart=no", f"--callgrind-out-file={counts}",
           bench, "count", case, *plans, env=COUNTABLE)
    totals = [line for line in counts.read_text(encoding="utf-8").splitlines() if line.startswith("totals:")]
    counts.unlink()
    return int(totals[-1].split()[1])


def figures(build, scenes, folder):
    """{name: {value, unit, limit}}: ratios of the work with something left out to that without."""
    bench = str(build / "bench" / "effects_bench")
    plans = []
    for scene in sorted(scenes.glob("*.json")):
        plans.append(str(folder / scene.name))
        output(str(build / "clothbrdf"), "plan", str(scene), "-o", plans[-1])
    cases = output(bench, "list", *plans).splitlines()
    count = {case: instructions(bench, case, plans, folder) for case in cases}
    timed = (line.split(maxsplit=1) for line in output(bench, "time", *plans).splitlines())
    seconds = {case: float(taken) for taken, case in timed}
    result = {}

    def add(name, part, whole, limit=None):
        for what, of in (("instructions", count), ("time", seconds)):
            figure = {"value": of[part] / of[whole], "unit": ""}
            result[f"{name}, {what}"] = figure | ({"limit": limit} if limit else {})

    for case in cases[1:cases.index(next(iter(CELLS)))]:
        add(f"{case} / full", case, "full", LIMITS.get(case))
    for grid, limit in CELLS.items():
        add(f"{grid}, a scene's cells / all", f"{grid} reached", grid, limit)
    for plan in plans:
        name = pathlib.Path(plan).stem
        add(f"{name}, evaluation", f"{name} planned", f"{name} whole")
        saving = json.loads(pathlib.Path(plan).read_text(encoding="utf-8"))["saving"]
        result[f"{name}, evaluation, predicted"] = {"value": 1 - saving["evaluation"], "unit": ""}
        result[f"{name}, cells"] = {"value": 1 - saving["cells"], "unit": ""}
    return result
