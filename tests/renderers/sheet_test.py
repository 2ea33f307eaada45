"""Mitsuba's picture of the wrinkled sheet, from a .bsdf file, is preview's, from the model."""

import pathlib
import tempfile
import unittest

import mitsuba as mi
import numpy as np

import program
import sheet
from directions import vectors

SIZE = 256
LIGHTS_DEG = ((0, 0), (40, 20), (60, 250))
# Largest relative difference of lit pixels, the worst of R, G and B in each, percent: at the median and the 99th
# percentile. The file alone accounts for 0.3 and 5 (eval_test.py).
LIMITS = {50: 0.5, 99: 5}


class SheetTest(unittest.TestCase):
    """Lit from above and from the side, by files of 5 MB."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def compare(self, name: str, ours: np.ndarray, theirs: np.ndarray):
        """Pixel by pixel."""
        lit = ours.min(axis=-1) > 0
        self.assertGreater(lit.mean(), 0.8, name)
        # A pixel at the edge of the shadow may round to either side.
        dark_differ = (lit != (theirs.min(axis=-1) > 0)).sum()
        both = lit & (theirs.min(axis=-1) > 0)
        errors = 100 * np.abs(theirs[both] / ours[both] - 1).max(axis=-1)
        reached = {percentile: np.percentile(errors, percentile) for percentile in LIMITS}
        print(f"{name}: {lit.sum()} lit pixels, {dark_differ} lit in one only; difference at percentiles",
              {percentile: f"{error:.3f} %" for percentile, error in reached.items()}, f"largest {errors.max():.3f} %",
              flush=True)
        self.assertLessEqual(dark_differ, 5, name)
        for percentile, error in reached.items():
            self.assertLessEqual(error, LIMITS[percentile], f"{name}, percentile {percentile}")

    def test_mitsuba_draws_the_sheet_as_preview_does(self):
        mesh = self.folder / "sheet.ply"
        sheet.write_ply(mesh, SIZE)
        kept = program.pictures_folder()
        for material in (*program.plain_materials(), program.turned_material(self.folder)):
            bsdf = program.tabulate(material, self.folder, "--size", 5_000_000)
            for light_deg in LIGHTS_DEG:
                name = f"{material.stem} lit from {light_deg}"
                with self.subTest(name):
                    ours = sheet.preview(material, SIZE, light_deg, self.folder)
                    theirs = sheet.render(bsdf, mesh, SIZE, vectors(*np.radians(light_deg)))
                    picture = kept / f"sheet_{material.stem}_{light_deg[0]}.png"
                    mi.util.write_bitmap(str(picture), np.hstack([ours, theirs]))
                    self.compare(name, ours, theirs)


def setUpModule():
    mi.set_variant("scalar_rgb")


if __name__ == "__main__":
    unittest.main()
