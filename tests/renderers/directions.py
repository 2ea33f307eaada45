"""Directions in the cloth's frame: theta from the normal, phi from the weft (the tangent), radians."""

import numpy as np


def vectors(theta, phi) -> np.ndarray:
    """Unit vectors, [...][3]."""
    theta, phi = np.broadcast_arrays(theta, phi)
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)


def angles(w) -> np.ndarray:
    """theta and phi of unit vectors, [...][2]."""
    theta = np.arctan2(np.hypot(w[..., 0], w[..., 1]), w[..., 2])
    return np.stack([theta, np.arctan2(w[..., 1], w[..., 0])], axis=-1)


def random_pairs(random: np.random.Generator, count: int, below_deg: float) -> np.ndarray:
    """[count][theta_i, phi_i, theta_o, phi_o], both uniform in solid angle where theta < below_deg."""
    cosine = random.uniform(np.cos(np.radians(below_deg)), 1, (count, 2))
    phi = random.uniform(0, 2 * np.pi, (count, 2))
    theta = np.arccos(cosine)
    return np.stack([theta[:, 0], phi[:, 0], theta[:, 1], phi[:, 1]], axis=-1)


def light_and_eye(pairs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors wi, to the light, and wo, to the eye, of [pair][theta_i, phi_i, theta_o, phi_o]."""
    return vectors(pairs[:, 0], pairs[:, 1]), vectors(pairs[:, 2], pairs[:, 3])


def hemisphere(rows: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """Midpoints of equal steps in theta and phi: vectors, [rows][columns][3], and solid angles, [rows][1]."""
    step = np.pi / 2 / rows
    theta = (np.arange(rows) + 0.5) * step
    phi = (np.arange(columns) + 0.5) * 2 * np.pi / columns
    bands = np.cos(theta - step / 2) - np.cos(theta + step / 2)
    return vectors(theta[:, None], phi[None, :]), bands[:, None] * 2 * np.pi / columns
