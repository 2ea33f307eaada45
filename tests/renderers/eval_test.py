"""What Mitsuba reads in an RGB .bsdf file is the model's f_r."""

import os
import tempfile
import unittest

import mitsuba as mi
import numpy as np

import program
from directions import random_pairs, vectors
from measured import Measured

SEED = 20261122
PAIRS = 10000
PERCENTILES = (50, 95, 99)
# Bytes allowed: the largest error at each percentile where theta < 80 degrees, percent.
LIMITS = {5_000_000: (0.30, 1.8, 5.0), 50_000_000: (0.08, 0.55, 1.4)}


def error_percentiles(f: np.ndarray, exact: np.ndarray) -> np.ndarray:
    """Percent, at PERCENTILES, of the channel that is worst there; relative with a floor of 0.001 of the mean."""
    error = np.abs(f - exact) / (exact + 0.001 * exact.mean(axis=0))
    return 100 * np.percentile(error, PERCENTILES, axis=0).max(axis=1)


class EvalTest(unittest.TestCase):
    """Over pairs uniform in solid angle."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def percentiles(self, material: str, bsdf: Measured, below_deg: float) -> np.ndarray:
        """Errors below an angle; fails for what is negative or no number."""
        pairs = random_pairs(np.random.default_rng(SEED), PAIRS, below_deg)
        exact = program.exact(program.material_file(material), pairs, self.folder)
        wo = vectors(pairs[:, 2], pairs[:, 3])
        f = bsdf.eval_cos(vectors(pairs[:, 0], pairs[:, 1]), wo) / wo[:, 2:]
        self.assertTrue(np.isfinite(f).all(), f"{material}: theta < {below_deg}: not finite")
        self.assertGreaterEqual(f.min(), 0, f"{material}: theta < {below_deg}")
        return error_percentiles(f, exact)

    def check(self, material: str, size: int):
        """Size and accuracy of one file."""
        path = os.path.join(self.folder, f"{material}.bsdf")
        program.run("tabulate", program.material_file(material), "-o", path, "--size", size)
        self.assertLessEqual(os.path.getsize(path), size)
        bsdf = Measured(path)
        for below_deg in (80, 88):
            errors = self.percentiles(material, bsdf, below_deg)
            print(f"{material}: {os.path.getsize(path)} bytes, theta < {below_deg}: error at percentiles",
                  PERCENTILES, np.round(errors, 3), "%", flush=True)
            if below_deg == 80:
                for limit, error, percentile in zip(LIMITS[size], errors, PERCENTILES):
                    self.assertLessEqual(error, limit, f"{material}, {size} bytes, percentile {percentile}")
        os.remove(path)

    def test_files_of_every_size_hold_the_material(self):
        for material in program.MATERIALS:
            for size in LIMITS:
                with self.subTest(material=material, size=size):
                    self.check(material, size)


def setUpModule():
    mi.set_variant("scalar_rgb")
    print("seed", SEED)


if __name__ == "__main__":
    unittest.main()
