"""clothbrdf reads .bsdf files as Mitsuba does: its preview of a file is Mitsuba's picture, to rounding.

Each pixel of the wrinkled sheet is a pair of directions of its own.
"""

import pathlib
import tempfile
import unittest

import mitsuba as mi
import numpy as np

import program
import sheet
from directions import vectors

SIZE = 128
LIGHTS_DEG = ((0, 0), (40, 20), (70, 250))
FELT = "rgl_acrylic_felt_green_rgb.bsdf"
# Relative differences of pixels: Mitsuba computes in single precision.
LIMITS = {50: 1e-6, 99: 1e-4}


class ReaderTest(unittest.TestCase):
    """A measured isotropic file and an anisotropic one of ours."""

    def compare(self, bsdf: pathlib.Path, folder: pathlib.Path):
        """At the pairs of directions of a sheet under several lights."""
        mesh = folder / "sheet.ply"
        sheet.write_ply(mesh, SIZE)
        for light_deg in LIGHTS_DEG:
            ours = sheet.preview(bsdf, SIZE, light_deg, folder)
            theirs = sheet.render(bsdf, mesh, SIZE, vectors(*np.radians(light_deg)))
            lit = (ours.min(axis=-1) > 0) & (theirs.min(axis=-1) > 0)
            self.assertGreater(lit.mean(), 0.8)
            errors = np.abs(theirs[lit] / ours[lit] - 1).max(axis=-1)
            reached = {percentile: np.percentile(errors, percentile) for percentile in LIMITS}
            shown = ", ".join(f"{error:.1e} at {percentile}" for percentile, error in reached.items())
            print(f"{bsdf.name} lit from {light_deg}: {lit.sum()} lit pixels, percentiles of the difference: {shown}, "
                  f"largest {errors.max():.1e}", flush=True)
            for percentile, error in reached.items():
                self.assertLessEqual(error, LIMITS[percentile], f"{bsdf.name}, {light_deg}, percentile {percentile}")

    def test_a_measured_file_is_read_as_mitsuba_reads_it(self):
        felt = program.shared_data() / FELT
        if not felt.exists():
            self.skipTest(f"no {felt}")
        with tempfile.TemporaryDirectory() as folder:
            self.compare(felt, pathlib.Path(folder))

    def test_our_files_are_read_as_mitsuba_reads_them(self):
        with tempfile.TemporaryDirectory() as folder:
            bsdf = program.tabulate(program.turned_material(folder), folder, "--size", 5_000_000)
            self.compare(bsdf, pathlib.Path(folder))


def setUpModule():
    mi.set_variant("scalar_rgb")


if __name__ == "__main__":
    unittest.main()
