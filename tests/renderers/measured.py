"""Mitsuba's `measured` BSDF, asked for many directions at once. Set a scalar variant first."""

import mitsuba as mi
import numpy as np


class Measured:
    """A .bsdf file as Mitsuba reads it."""

    def __init__(self, path):
        self.bsdf = mi.load_dict({"type": "measured", "filename": str(path)})
        self.context = mi.BSDFContext()
        self.interaction = mi.SurfaceInteraction3f()

    def f_r(self, light, eye, wavelengths_nm=None) -> np.ndarray:
        """1/sr, [pair][channel], of unit vectors to the light and to the eye, [pair][3].

        As in a picture Mitsuba's wi is the direction to the eye, and what it returns holds the light's cosine.
        wavelengths_nm: the four that a spectral variant evaluates together.
        """
        if wavelengths_nm is not None:
            self.interaction.wavelengths = list(wavelengths_nm)
        values = []
        for wi, wo in zip(eye.tolist(), light.tolist()):
            self.interaction.wi = wi
            values.append(list(self.bsdf.eval(self.context, self.interaction, wo)))
        return np.array(values) / light[:, 2:]

    def eval_pdf(self, wi, wo) -> tuple[np.ndarray, np.ndarray]:
        """f_r cos(theta_o), [direction][channel], and density of samples: one wi, [3], many wo, [direction][3]."""
        self.interaction.wi = wi.tolist()
        values, densities = [], []
        for one_wo in wo.tolist():
            value, density = self.bsdf.eval_pdf(self.context, self.interaction, one_wo)
            values.append(list(value))
            densities.append(density)
        return np.array(values), np.array(densities)

    def sample(self, wi, uniform) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Directions [sample][3], their densities and weights [sample][channel], from uniform numbers [sample][2]."""
        self.interaction.wi = wi.tolist()
        directions, densities, weights = [], [], []
        for pair in uniform.tolist():
            drawn, weight = self.bsdf.sample(self.context, self.interaction, 0.5, pair)
            directions.append(list(drawn.wo))
            densities.append(drawn.pdf)
            weights.append(list(weight))
        return np.array(directions), np.array(densities), np.array(weights)
