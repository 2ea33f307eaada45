"""An isotropic .bsdf file holds the mean of f_r over rotations of the cloth."""

import pathlib
import tempfile
import unittest

import mitsuba as mi
import numpy as np

import program
from accuracy import error_percentiles, judge
from directions import light_and_eye, random_pairs
from measured import Measured

PAIRS = 500
ROTATIONS = 160  # over half a turn, after which our cloths are as before; a lobe is 2 steps wide or more
LIMITS = (0.05, 0.4, 1.0)  # percent


class IsotropicTest(unittest.TestCase):
    """Over pairs uniform in solid angle where theta < 80 degrees."""

    def means(self, material: pathlib.Path, pairs: np.ndarray, folder: str) -> np.ndarray:
        """The model's, [pair][channel]."""
        turned = np.repeat(pairs, ROTATIONS, axis=0)
        turned[:, 1::2] += np.tile(np.arange(ROTATIONS) * np.pi / ROTATIONS, len(pairs))[:, None]
        exact = program.exact(material, turned, folder)
        return exact.reshape(len(pairs), ROTATIONS, -1).mean(axis=1)

    def test_isotropic_files_hold_the_mean_over_rotations(self):
        pairs = random_pairs(np.random.default_rng(program.SEED), PAIRS, 80)
        for material in program.plain_materials():
            with self.subTest(material.stem), tempfile.TemporaryDirectory() as folder:
                f = Measured(program.tabulate(material, folder, "--isotropic")).f_r(*light_and_eye(pairs))
                self.assertTrue(np.isfinite(f).all() and f.min() >= 0, material.stem)
                judge(self, material.stem, error_percentiles(f, self.means(material, pairs, folder)), LIMITS)


def setUpModule():
    mi.set_variant("scalar_rgb")
    print("seed", program.SEED)


if __name__ == "__main__":
    unittest.main()
