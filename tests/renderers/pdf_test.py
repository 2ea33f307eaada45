"""Mitsuba's sampling of our .bsdf files: densities that integrate to 1, samples that follow them, right weights."""

import tempfile
import unittest

import mitsuba as mi
import numpy as np

import program
from chi_square import sidak, significance
from directions import angles, hemisphere, vectors
from measured import Measured

SAMPLES = 50000
ROWS, COLUMNS = 240, 480  # of the quadrature: the sharpest lobe is 0.1 rad wide, 15 steps
BIN_ROWS, BIN_COLUMNS = 12, 24
THETAS_DEG = (0, 20, 40, 60, 70, 80)
PHIS_DEG = (0, 90, 205)
MOST_OFF_ONE = 0.01
MOST_ALBEDO_ERROR = 0.005
MOST_WEIGHT = 10  # of a sample; larger ones are bright dots in pictures
LEVEL = 0.01  # chance that the chi-square tests of all directions and files fail for right samples


def binned(values: np.ndarray) -> np.ndarray:
    """Sums of the quadrature's values over the bins, [BIN_ROWS][BIN_COLUMNS]."""
    return values.reshape(BIN_ROWS, ROWS // BIN_ROWS, BIN_COLUMNS, COLUMNS // BIN_COLUMNS).sum(axis=(1, 3))


def counted(directions: np.ndarray) -> np.ndarray:
    """Samples in each bin."""
    theta, phi = angles(directions).T
    edges = (np.linspace(0, np.pi / 2, BIN_ROWS + 1), np.linspace(0, 2 * np.pi, BIN_COLUMNS + 1))
    return np.histogram2d(theta, phi % (2 * np.pi), edges)[0]


class Figures:
    """What one file does for one wi."""

    def __init__(self, bsdf: Measured, wi: np.ndarray, random: np.random.Generator):
        grid, solid_angles = hemisphere(ROWS, COLUMNS)
        f_cos, density = bsdf.eval_pdf(wi, grid.reshape(-1, 3))
        expected = density.reshape(ROWS, COLUMNS) * solid_angles
        self.integral = expected.sum()
        self.albedo = (f_cos.reshape(ROWS, COLUMNS, -1) * solid_angles[..., None]).sum(axis=(0, 1))
        directions, self.densities, self.weights = bsdf.sample(wi, random.random((SAMPLES, 2)))
        above = directions[:, 2] > 0
        self.above = above.mean()
        self.sampled_albedo = (self.weights * above[:, None]).mean(axis=0)
        self.significance = significance(counted(directions[above]), above.sum() * binned(expected) / self.integral)

    def albedo_error(self) -> float:
        """Relative, of the channel that is worst."""
        return float(np.abs(self.sampled_albedo / self.albedo - 1).max())


class PdfTest(unittest.TestCase):
    """Up to 80 degrees."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def check(self, name: str, figures: Figures, level: float):
        """All that holds for one wi."""
        self.assertTrue(np.isfinite(figures.weights).all() and np.isfinite(figures.densities).all(), name)
        self.assertGreaterEqual(figures.weights.min(), 0, name)
        self.assertLessEqual(figures.weights.max(), MOST_WEIGHT, f"{name}: weight")
        self.assertLessEqual(abs(figures.integral - 1), MOST_OFF_ONE, f"{name}: integral of the density")
        self.assertLessEqual(figures.albedo_error(), MOST_ALBEDO_ERROR, f"{name}: albedo of the samples")
        self.assertGreaterEqual(figures.significance, level, f"{name}: chi-square")

    def test_samples_follow_their_density_and_carry_the_right_weights(self):
        directions = [(theta, phi) for theta in THETAS_DEG for phi in (PHIS_DEG if theta > 0 else (0,))]
        materials = [*program.plain_materials(), program.turned_material(self.folder)]
        level = sidak(LEVEL, len(directions) * len(materials))
        random = np.random.default_rng(program.SEED)
        for material in materials:
            bsdf = Measured(program.tabulate(material, self.folder, "--size", 5_000_000))
            for theta, phi in directions:
                name = f"{material.stem} from theta_i {theta}, phi_i {phi}"
                figures = Figures(bsdf, vectors(np.radians(theta), np.radians(phi)), random)
                print(f"{name}: integral {figures.integral:.4f}, samples above {figures.above:.4f}, albedo off by "
                      f"{100 * figures.albedo_error():.3f} %, largest weight {figures.weights.max():.3f}, "
                      f"chi-square {figures.significance:.4f}", flush=True)
                with self.subTest(name):
                    self.check(name, figures, level)


def setUpModule():
    mi.set_variant("scalar_rgb")
    print("seed", program.SEED)


if __name__ == "__main__":
    unittest.main()
