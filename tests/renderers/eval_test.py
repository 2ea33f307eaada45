"""What Mitsuba reads in an RGB .bsdf file is the model's f_r."""

import os
import tempfile
import unittest

import mitsuba as mi
import numpy as np

import program
from accuracy import error_percentiles, judge
from directions import light_and_eye, random_pairs
from measured import Measured

SEED = 20261122
PAIRS = 10000
# Bytes allowed: the largest errors where theta < 80 degrees, percent.
LIMITS = {5_000_000: (0.30, 1.8, 5.0), 50_000_000: (0.08, 0.55, 1.4)}
UNLIMITED = (np.inf, np.inf, np.inf)


class EvalTest(unittest.TestCase):
    """Over pairs uniform in solid angle."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def tabulated(self, material: str, size: int) -> Measured:
        """A file no larger than `size` bytes."""
        path = os.path.join(self.folder, f"{material}.bsdf")
        program.run("tabulate", program.material_file(material), "-o", path, "--size", size)
        print(f"{material}: {os.path.getsize(path)} bytes")
        self.assertLessEqual(os.path.getsize(path), size)
        return Measured(path)

    def errors(self, material: str, bsdf: Measured, below_deg: float) -> np.ndarray:
        """Below an angle; fails for what is negative or no number."""
        pairs = random_pairs(np.random.default_rng(SEED), PAIRS, below_deg)
        exact = program.exact(program.material_file(material), pairs, self.folder)
        f = bsdf.f_r(*light_and_eye(pairs))
        self.assertTrue(np.isfinite(f).all(), f"{material}: theta < {below_deg}: not finite")
        self.assertGreaterEqual(f.min(), 0, f"{material}: theta < {below_deg}")
        return error_percentiles(f, exact)

    def test_files_of_every_size_hold_the_material(self):
        for material in program.MATERIALS:
            for size, limits in LIMITS.items():
                with self.subTest(material=material, size=size):
                    bsdf = self.tabulated(material, size)
                    judge(self, f"{material}, theta < 88", self.errors(material, bsdf, 88), UNLIMITED)
                    judge(self, f"{material}, theta < 80", self.errors(material, bsdf, 80), limits)

    def test_light_and_eye_keep_their_places(self):
        # This material is not reciprocal: exchanged directions are off by 12 % at the median.
        errors = self.errors("silk_paper", self.tabulated("silk_paper", 5_000_000), 80)
        judge(self, "silk_paper, theta < 80", errors, (1, np.inf, np.inf))


def setUpModule():
    mi.set_variant("scalar_rgb")
    print("seed", SEED)


if __name__ == "__main__":
    unittest.main()
