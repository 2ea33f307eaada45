"""What Mitsuba reads in a spectral .bsdf file is the model's f_r, or has the colour of its R, G and B."""

import json
import pathlib
import tempfile
import unittest

import mitsuba as mi
import numpy as np

import program
from accuracy import error_percentiles, judge
from directions import light_and_eye, random_pairs
from measured import Measured

PAIRS = 3000
BYTES = 30_000_000  # as many nodes as RGB files of 5 MB have, and held to the same
LIMITS = (0.30, 1.8, 5.0)  # percent, where theta < 80 degrees
ALIKE = 4  # wavelengths that Mitsuba evaluates together

# A silk dyed red, at wavelengths of its own.
WAVELENGTHS_NM = [400, 450, 500, 550, 600, 700]
ABSORPTION = [0.9, 0.7, 0.8, 0.5, 0.1, 0.05]


def spectra(bsdf: Measured, pairs: np.ndarray, wavelengths_nm) -> np.ndarray:
    """f_r, [pair][wavelength]."""
    count = len(wavelengths_nm)
    padded = list(wavelengths_nm) + [wavelengths_nm[-1]] * (-count % ALIKE)
    parts = [bsdf.f_r(*light_and_eye(pairs), padded[k : k + ALIKE]) for k in range(0, len(padded), ALIKE)]
    return np.concatenate(parts, axis=1)[:, :count]


def rgb_weights(wavelengths_nm: np.ndarray) -> np.ndarray:
    """Of linear R, G, B in light D65 at equally spaced wavelengths, by Mitsuba's tables: [wavelength][3]."""
    light = [mi.cie_d65(float(wavelength)) for wavelength in wavelengths_nm]
    observer = np.array([list(mi.cie1931_xyz(float(wavelength))) for wavelength in wavelengths_nm])
    weights = np.array([list(mi.xyz_to_srgb(row.tolist())) for row in observer * np.array(light)[:, None]])
    return weights / weights.sum(axis=0)


class SpectralTest(unittest.TestCase):
    """Over pairs uniform in solid angle."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.pairs = random_pairs(np.random.default_rng(program.SEED), PAIRS, 80)

    def tabulated(self, material: pathlib.Path) -> Measured:
        """A spectral file."""
        return Measured(program.tabulate(material, self.folder, "--flavour", "spectral", "--size", BYTES))

    def test_a_material_of_wavelengths_is_held_at_each(self):
        material = json.loads(program.material_file("silk").read_text()) | {"wavelengths_nm": WAVELENGTHS_NM}
        material["warp"]["absorption"] = ABSORPTION
        material.pop("$schema")
        path = self.folder / "red_silk.json"
        path.write_text(json.dumps(material))
        f = spectra(self.tabulated(path), self.pairs, WAVELENGTHS_NM)
        self.assertTrue(np.isfinite(f).all() and f.min() >= 0)
        judge(self, "at wavelengths", error_percentiles(f, program.exact(path, self.pairs, self.folder)), LIMITS)

    def test_spectra_have_the_colour_of_the_materials_rgb(self):
        # Every 5 nm: what lies between is the file's straight line, which Mitsuba follows.
        wavelengths = np.arange(360, 831, 5.0)
        for material in program.plain_materials():
            with self.subTest(material.stem):
                pairs = self.pairs[:1000]
                f = spectra(self.tabulated(material), pairs, wavelengths.tolist())
                self.assertTrue(np.isfinite(f).all() and f.min() >= 0, material.stem)
                colours = f @ rgb_weights(wavelengths)
                errors = error_percentiles(colours, program.exact(material, pairs, self.folder))
                judge(self, f"{material.stem}, colours", errors, LIMITS)


def setUpModule():
    mi.set_variant("scalar_spectral")
    print("seed", program.SEED)


if __name__ == "__main__":
    unittest.main()
