"""Runs clothbrdf, the program under test."""

import json
import os
import pathlib
import subprocess

import numpy as np

PROGRAM = os.environ["CLOTHBRDF_PROGRAM"]
SEED = int(os.environ.get("CLOTHBRDF_SEED", "20261122"))  # of the tests' random numbers
SOURCE = pathlib.Path(__file__).resolve().parents[2]


def material_file(name: str) -> pathlib.Path:
    """One of the project's materials."""
    return SOURCE / "materials" / f"{name}.json"


def plain_materials() -> list[pathlib.Path]:
    """The paper's three cloths."""
    return [material_file(name) for name in ("silk", "cotton", "tamamushi")]


def turned_material(folder) -> pathlib.Path:
    """Shot silk turned by 30 degrees: unlike the plain ones it is not its own mirror image."""
    path = pathlib.Path(folder) / "turned_tamamushi.json"
    path.write_text(json.dumps(json.loads(material_file("tamamushi").read_text()) | {"rotation_deg": 30}))
    return path


def tabulate(material: pathlib.Path, folder, *options) -> pathlib.Path:
    """The material's .bsdf file in a folder."""
    path = pathlib.Path(folder) / f"{material.stem}.bsdf"
    run("tabulate", material, "-o", path, *options)
    print(f"{path.name}: {path.stat().st_size} bytes")
    return path


def shared_data() -> pathlib.Path:
    """Measured files, which are not part of the project; the folder may be absent."""
    return pathlib.Path(os.environ.get("CLOTHBRDF_SHARED_DATA", SOURCE.parent / "shared" / "data"))


def run(*arguments) -> str:
    """Standard output of clothbrdf; RuntimeError with its message where it fails."""
    result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise RuntimeError(f"clothbrdf {' '.join(map(str, arguments))}: {result.returncode}: {result.stderr.strip()}")
    return result.stdout


def exact(material, pairs, folder) -> np.ndarray:
    """f_r of the model, [pair][channel], 1/sr.

    pairs: [pair][theta_i, phi_i, theta_o, phi_o], radians; folder: where the list for eval may lie.
    """
    listing = pathlib.Path(folder) / "pairs.txt"
    np.savetxt(listing, np.degrees(pairs), fmt="%.17g")
    lines = run("eval", material, "--pairs", listing).splitlines()
    return np.array([json.loads(line)["f_r"]["total"] for line in lines])


def pictures_folder() -> pathlib.Path:
    """Where pictures are kept to be looked at."""
    folder = SOURCE / "out" / "renders"
    folder.mkdir(parents=True, exist_ok=True)
    return folder
