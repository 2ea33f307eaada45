"""The commands of examples/README.md draw one cloth in R, G, B and in wavelengths; pbrt's scene is Mitsuba's."""

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import mitsuba as mi
import numpy as np

import program

EXAMPLES = program.SOURCE / "examples"
SMALL = ["-D", "width=120", "-D", "height=100", "-D", "samples=32"]
# Of the means over 10 x 10 pixels, which are noisy: the 95th percentile of their relative difference.
MOST_DIFFERENCE = 0.05


def commands(program_name: str) -> list[list[str]]:
    """The README's commands that run a program."""
    lines = re.findall(r"^    (.*)$", (EXAMPLES / "README.md").read_text(), re.MULTILINE)
    return [shlex.split(line) for line in lines if line.startswith(program_name + " ")]


def run(command: list[str], folder: pathlib.Path):
    """In a folder, with the program under test and this environment's mitsuba on the PATH."""
    path = [os.path.dirname(program.PROGRAM), os.path.dirname(sys.executable), os.environ["PATH"]]
    subprocess.run(command, cwd=folder, env=os.environ | {"PATH": os.pathsep.join(path)}, check=True,
                   stdout=subprocess.DEVNULL)


def picture(path: pathlib.Path) -> np.ndarray:
    """[row][column][3]."""
    return np.array(mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))


def blocks(image: np.ndarray) -> np.ndarray:
    """Means over 10 x 10 pixels."""
    rows, columns, channels = image.shape
    return image.reshape(rows // 10, 10, columns // 10, 10, channels).mean(axis=(1, 3))


def pbrt_scene() -> list[tuple[str, list]]:
    """Directives of examples/pbrt/drape.pbrt with their values: text in quotes, numbers, lists in brackets."""
    text = re.sub(r"#.*", "", (EXAMPLES / "pbrt" / "drape.pbrt").read_text())
    scene, values = [], []
    for token in re.findall(r'"[^"]*"|\[|\]|[^\s"\[\]]+', text):
        if token[0].isalpha():
            scene.append((token, []))
            values = scene[-1][1]
        elif token == "[":
            scene[-1][1].append(values := [])
        elif token == "]":
            values = scene[-1][1]
        else:
            values.append(token.strip('"') if token[0] == '"' else float(token))
    return scene


def pbrt_values() -> dict[str, list]:
    """Values of each directive and of each of its parameters, in order: "Camera float fov": [[24.0]]."""
    result: dict[str, list] = {}
    for directive, values in pbrt_scene():
        result.setdefault(directive, []).append(values)
        for name, value in zip(values[1::2], values[2::2]):
            result.setdefault(f"{directive} {name}", []).append(value)
    return result


def mitsuba_values() -> dict[str, list]:
    """Values of each name in examples/mitsuba/drape.xml, in order: "fov": [[24.0]]."""
    result: dict[str, list] = {}
    for element in xml.etree.ElementTree.parse(EXAMPLES / "mitsuba" / "drape.xml").iter():
        if element.tag == "lookat":
            parts = ",".join(element.get(part) for part in ("origin", "target", "up"))
            result["lookat"] = [[float(number) for number in parts.split(",")]]
        elif re.fullmatch(r"[-\d., ]+", element.get("value", "")):
            numbers = [float(number) for number in element.get("value").split(",")]
            result.setdefault(element.get("name"), []).append(numbers)
    return result


class ExampleTest(unittest.TestCase):
    """Of the folder examples/."""

    def test_readme_draws_the_cloth_in_every_flavour(self):
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary) / "examples"
            shutil.copytree(EXAMPLES, folder)
            shutil.copytree(program.SOURCE / "materials", folder.parent / "materials")
            for command in commands("clothbrdf"):
                run(command, folder)
            for command in commands("mitsuba"):
                run(command + SMALL, folder)
            pictures = {flavour: picture(folder / f"drape_{flavour}.exr") for flavour in ("rgb", "spec")}
        for flavour, image in pictures.items():
            self.assertTrue(np.isfinite(image).all() and image.min() >= 0, flavour)
            mi.util.write_bitmap(str(program.pictures_folder() / f"example_{flavour}.png"), image)
        rgb, spectral = (blocks(image) for image in pictures.values())
        self.assertGreater(rgb[4:7, 5:7, 0].min(), 1.2 * rgb[4:7, 5:7, 2].max(), "golden silk in the middle")
        difference = np.percentile(np.abs(spectral / rgb - 1), 95, axis=(0, 1))
        print("wavelengths against R, G, B, means over 10 x 10 pixels, 95th percentile:", np.round(difference, 4))
        self.assertLessEqual(difference.max(), MOST_DIFFERENCE)

    def test_pbrt_draws_what_mitsuba_draws(self):
        pbrt, mitsuba = pbrt_values(), mitsuba_values()
        same = {
            "LookAt": "lookat", "Camera float fov": "fov", "Film integer xresolution": "width",
            "Film integer yresolution": "height", "Sampler integer pixelsamples": "samples",
            "Translate": "center", "Shape float radius": "radius", "Material rgb reflectance": "reflectance",
        }
        for ours, theirs in same.items():
            self.assertEqual(pbrt[ours], mitsuba[theirs], ours)
        self.assertEqual(pbrt["AreaLightSource rgb L"] + pbrt["LightSource rgb L"], mitsuba["radiance"])
        # pbrt counts bounces, Mitsuba the pieces of a path.
        self.assertEqual(pbrt["Integrator integer maxdepth"][0][0], mitsuba["max_depth"][0][0] - 1)


def setUpModule():
    mi.set_variant("scalar_rgb")


if __name__ == "__main__":
    unittest.main()
