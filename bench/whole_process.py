#!/usr/bin/env python3
"""Times the program as a user meets it, adds what tabulate_bench measured, and writes both down; bench/run calls it."""

import array
import collections
import datetime
import json
import os
import pathlib
import platform
import random
import statistics
import subprocess
import sys
import tempfile
import time

import effects

SOURCE = pathlib.Path(__file__).resolve().parent.parent
MATERIAL = str(SOURCE / "materials" / "silk.json")
SHOT_SILK = str(SOURCE / "materials" / "tamamushi.json")
RUNS = 15
Run = collections.namedtuple("Run", "seconds peak_mb")


def run(*command):
    """Runs a program to its end."""
    silent = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]
    start = time.perf_counter()
    process = os.posix_spawnp(command[0], command, os.environ, file_actions=silent)
    _, status, usage = os.wait4(process, 0)
    seconds = time.perf_counter() - start
    if status != 0:
        sys.exit(f"whole_process.py: failed: {' '.join(command)}")
    return Run(seconds, usage.ru_maxrss * 1024 / 1e6)


def against_copy(tabulate, source, replace):
    """Seconds of `tabulate` and of cp of its result, in turn, each to a fresh name or over a file of its own."""
    folder, ending = source.parent, source.suffix
    seconds = {"tabulate": [], "cp": []}
    for number in range(-1, RUNS):  # the first is the warm-up, and leaves the files to be replaced
        for who, taken in seconds.items():
            target = folder / (f"{who}{ending}" if replace else f"{who}{number}{ending}")
            command = [*tabulate, "-o", str(target)] if who == "tabulate" else ["cp", str(source), str(target)]
            taken.append(run(*command).seconds)
            if not replace:
                target.unlink()
    for who in seconds:
        (folder / f"{who}{ending}").unlink(missing_ok=True)
    return {who: taken[1:] for who, taken in seconds.items()}


def spread(seconds):
    low, middle, high = (1e3 * f(seconds) for f in (min, statistics.median, max))
    return {"median_ms": round(middle, 3), "min_ms": round(low, 3), "max_ms": round(high, 3)}


def whole_processes(program, folder):
    """The figures of whole runs: {name: {value, unit, ...}}."""
    figures = {}
    tabulate = [program, "tabulate", MATERIAL]
    first = run(*tabulate, "-o", str(folder / "source.binary"))
    run(program, "--version")
    start_up = [run(program, "--version").seconds for _ in range(RUNS)]
    for how in ("fresh", "replace"):
        seconds = against_copy(tabulate, folder / "source.binary", how == "replace")
        ratio = statistics.median(seconds["tabulate"]) / statistics.median(seconds["cp"])
        pairwise = statistics.median(a / b for a, b in zip(seconds["tabulate"], seconds["cp"]))
        figures[f"tabulate / cp, {how}"] = {
            "value": ratio, "unit": "", "limit": 1.5, "median_of_pairwise_ratios": round(pairwise, 3),
            **{who: spread(taken) for who, taken in seconds.items()}}
        if how == "fresh":
            share = statistics.median(start_up) / statistics.median(seconds["tabulate"])
            figures["start-up, share of tabulate"] = {
                "value": 100 * share, "unit": "%", "start_up": spread(start_up)}
    # Linux counts a process from before its exec, so no peak is less than this script's own.
    least = round(run("true").peak_mb, 1)
    figures["peak memory, silk.binary"] = {
        "value": first.peak_mb, "unit": "MB", "limit": 100, "least_measurable": least}
    (folder / "source.binary").unlink()

    pairs = [program, "tabulate", SHOT_SILK, "--grid", "inout:24x96x24x96"]
    run(*pairs, "-o", str(folder / "pairs.exr"))
    seconds = against_copy(pairs, folder / "pairs.exr", False)
    figures["tabulate / cp, in/out"] = {
        "value": statistics.median(seconds["tabulate"]) / statistics.median(seconds["cp"]), "unit": "", "limit": 2.5,
        **{who: spread(taken) for who, taken in seconds.items()}}
    (folder / "pairs.exr").unlink()

    picture = [program, "preview", MATERIAL, "--size", "1024", "-o", str(folder / "picture.png")]
    figures["preview of 1024 x 1024"] = {
        "value": statistics.median(run(*picture).seconds for _ in range(5)), "unit": "s", "limit": 1}

    huge = folder / "huge.exr"
    streamed = run(*tabulate, "--grid", "halfdiff4d:90x72x90x180", "--half", "-o", str(huge))
    figures["peak memory, 105 million cells"] = {
        "value": streamed.peak_mb, "unit": "MB", "limit": 256, "least_measurable": least,
        "file_mb": round(huge.stat().st_size / 1e6, 1), "seconds": round(streamed.seconds, 3)}
    huge.unlink()

    large = folder / "large.exr"
    streamed = run(*tabulate, "--grid", "halfdiff4d:90x36x90x90", "-o", str(large))
    figures["peak memory, large.exr"] = {
        "value": streamed.peak_mb, "unit": "MB", "limit": 200, "least_measurable": least,
        "file_mb": round(large.stat().st_size / 1e6, 1), "seconds": round(streamed.seconds, 3)}
    figures |= tensor_files(program, folder)
    return figures


def tensor_files(program, folder):
    """Whole processes that write RGL's .bsdf files, of the largest sizes that the limits are for."""
    figures = {}
    for size, limit in ((5_000_000, 0.5), (50_000_000, 3)):
        write = (program, "tabulate", "materials/silk.json", "-o", folder / "silk.bsdf", "--size", str(size))
        runs = [run(*write) for _ in range(5)]
        name = f"RGL file of {size // 1_000_000} MB"
        figures[name] = {"value": statistics.median(r.seconds for r in runs), "unit": "s", "limit": limit}
        figures[name + ", peak memory"] = {"value": max(r.peak_mb for r in runs), "unit": "MB", "limit": 300}
    return figures


def with_noise(source, target, relative):
    """A MERL file with independent Gaussian noise on every value."""
    content = source.read_bytes()
    values = array.array("d", content[12:])
    gauss = random.Random(1).gauss
    for k, value in enumerate(values):
        if value > 0:
            values[k] = value * (1 + relative * gauss(0, 1))
    target.write_bytes(content[:12] + values.tobytes())


def fits(program, folder):
    """Fits of a full MERL table with 1 % noise, as whole processes."""
    clean, table, found = folder / "clean.binary", folder / "noisy.binary", folder / "found.json"
    run(program, "tabulate", SHOT_SILK, "-o", str(clean))
    with_noise(clean, table, 0.01)
    clean.unlink()
    fit = [program, "fit", str(table)]
    given = ["--reflectance", "microfacet", "--paths", "all"]
    warm = [*fit, *given, "--start", str(found), "--fix", "layers"]
    blind = [run(*fit, *given, "--material", str(found)) for _ in range(3)]
    figures = {
        "fit, blind start": {"value": statistics.median(b.seconds for b in blind), "unit": "s", "limit": 5},
        "fit, all defaults": {"value": run(*fit).seconds, "unit": "s"},
        "fit, warm start": {"value": statistics.median(run(*warm).seconds for _ in range(5)), "unit": "s", "limit": 0.2},
        "fit, peak memory": {"value": max(b.peak_mb for b in blind), "unit": "MB", "limit": 300},
    }
    table.unlink()
    return figures


def kernels(report):
    """{name: microseconds of processor time, million cells per second} from Google Benchmark's JSON."""
    runs = collections.defaultdict(list)
    for row in report["benchmarks"]:
        if row["run_type"] == "iteration":
            runs["/".join(row["name"].split("/")[:2])].append(row)
    result = {}
    for name, rows in runs.items():
        clock = "real_time" if name.startswith(("threads_", "fit/")) else "cpu_time"
        times = [row[clock] for row in rows]
        result[name] = {"median_us": round(statistics.median(times), 1), "min_us": round(min(times), 1)}
        if "cells" in rows[0]:
            rate = statistics.median(row["cells"] for row in rows) / 1e6
            result[name]["million_cells_per_s"] = float(f"{rate:.4g}")
        if "multiply_adds" in rows[0]:
            result[name]["multiply_adds"] = rows[0]["multiply_adds"]
    return result


def kernel_figures(measured):
    """Rates of kernels beside each other, and beside the machine's own."""
    def rate(name):
        return measured[name]["million_cells_per_s"]

    single, of_all = "two_yarns_single", "two_yarns_all"
    scalar = rate(f"evaluate/{single}")
    targets = [name.split("/")[0] for name in measured if name.startswith("batch ") and name.endswith(single)]
    fastest = max(targets, key=lambda target: rate(f"{target}/{single}"))
    flops = rate(f"{fastest}/{single}") * measured[f"{fastest}/{single}"]["multiply_adds"]
    figures = {
        f"{targets[0]}, million pairs/s": {"value": rate(f"{targets[0]}/{single}"), "unit": "", "at_least": 100},
        "paths single / paths all": {
            "value": rate(f"{targets[0]}/{single}") / rate(f"{targets[0]}/{of_all}"), "unit": "", "limit": 2},
        **{f"{target} / scalar": {"value": rate(f"{target}/{single}") / scalar, "unit": "", **bound}
           for target in targets
           for bound in [{"batch AVX-512": {"at_least": 12}, "batch AVX2": {"at_least": 8}}.get(target, {})]},
        "batch, share of multiply-adds": {"value": 100 * flops / rate("peak/multiply_adds"), "unit": "%"},
        "batch, share of memory writes": {
            "value": 100 * 12 * rate(f"{fastest}/{single}") / rate("peak/memory_writes"), "unit": "%"},
    }
    figures["fit of all cells / reduced rows"] = {
        "value": measured["fit/all_cells"]["median_us"] / measured["fit/reduced_rows"]["median_us"], "unit": ""}
    for grid in ("inout", "average"):
        one, two = (measured[f"threads_{grid}/{threads}"]["median_us"] for threads in (1, 2))
        figures[f"two threads / one, {grid}"] = {"value": one / two, "unit": "", "at_least": 1.8}
    return figures


def git(*arguments):
    done = subprocess.run(["git", "--no-optional-locks", "-C", str(SOURCE), *arguments],
                          capture_output=True, text=True, check=False)
    return done.stdout.strip() or "unknown"


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


def file_system(folder):
    """Type of the file system that holds a folder."""
    mounts = (line.split() for line in pathlib.Path("/proc/self/mounts").read_text(encoding="utf-8").splitlines())
    holding = [(len(at), kind) for _, at, kind, *_ in mounts if folder.is_relative_to(at)]
    return max(holding)[1] if holding else "unknown"


def print_report(result):
    print("{commit}, {date}; {processor}, {processors} processors; Linux {kernel}; {compiler}; {file_system}; "
          "load {load}".format_map(result))
    print(f"\n{'kernel, one core':32}{'median us':>12}{'least us':>12}{'Mcells/s':>12}{'ns/cell':>12}")
    for name, row in result["kernels"].items():
        rate = row.get("million_cells_per_s")
        per_cell = f"{rate:12.4g}{1e3 / rate:12,.2f}" if rate else ""
        print(f"{name:32}{row['median_us']:12.1f}{row['min_us']:12.1f}{per_cell}")
    print(f"\n{'whole runs, ms':32}{'median':>12}{'least':>12}{'most':>12}")
    for name, figure in result["figures"].items():
        for who in ("tabulate", "cp", "start_up"):
            if who in figure:
                label = f"{who}, {name.split(', ')[1]}" if who != "start_up" else "--version"
                print(f"{label:32}" + "".join(f"{time_ms:12.1f}" for time_ms in figure[who].values()))
    print(f"\n{'figure':48}{'value':>12}    {'limit':>12}")
    for name, figure in result["figures"].items():
        bound = f"{figure['limit']:12g}" if "limit" in figure else f">={figure.get('at_least', 0):10g}"
        limit = f"{bound}  {'met' if figure['met'] else 'MISSED'}" if "met" in figure else ""
        at_most = " (or less)" if figure["value"] <= 1.02 * figure.get("least_measurable", 0) else ""
        print(f"{name:48}{figure['value']:12.4g} {figure['unit']:3}{limit}{at_most}".rstrip())
    missed = [name for name, figure in result["figures"].items() if not figure.get("met", True)]
    print("\n" + (f"limits missed: {'; '.join(missed)}" if missed else "all limits met"))
    if result["file_system"] in ("tmpfs", "ramfs"):
        print("the build folder is no disk: the ratios to cp say little")


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    google = json.loads(pathlib.Path(sys.argv[2]).read_text(encoding="utf-8"))
    load = os.getloadavg()[0]
    measured = kernels(google)
    compute = {"value": measured["compute/silk.binary"]["median_us"] / 1e3, "unit": "ms", "limit": 10}
    with tempfile.TemporaryDirectory(dir=build / "bench") as folder:
        figures = {"computing silk.binary, one core": compute, **kernel_figures(measured),
                   **whole_processes(str(build / "clothbrdf"), pathlib.Path(folder)),
                   **fits(str(build / "clothbrdf"), pathlib.Path(folder)),
                   **effects.figures(build, SOURCE / "examples" / "scenes", pathlib.Path(folder))}
    for figure in figures.values():
        if "limit" in figure:
            figure["met"] = figure["value"] <= figure["limit"]
        if "at_least" in figure:
            figure["met"] = figure["value"] >= figure["at_least"]
        figure["value"] = float(f"{figure['value']:.4g}")
    result = {
        "commit": git("describe", "--always", "--dirty", "--exclude=*"),
        "date": datetime.date.today().isoformat(), "processor": processor(), "processors": os.cpu_count(),
        "kernel": platform.release(), "compiler": google["context"]["compiler"], "file_system": file_system(build),
        "load": round(load, 2), "runs": RUNS, "figures": figures, "kernels": measured}
    print_report(result)
    output = SOURCE / "bench" / "results" / f"{result['date']}-{result['commit']}.json"
    output.parent.mkdir(exist_ok=True)
    output.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    print(f"written: {output.relative_to(SOURCE)}")


main()
