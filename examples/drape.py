"""Drapes a square of cloth over a ball, and writes it as drape.ply: how the example scenes' mesh was made.

Needs numpy. The cloth is a grid of points, joined along the yarns, across the squares and over two of them, that falls
on a ball (position-based dynamics). The texture coordinates are the flat cloth's, u along the
weft, so that dp/du is where the weft runs.
"""

import sys

import numpy as np

POINTS = 65  # along an edge
EDGE = 1.8  # m, about x = y = 0
RADIUS = 0.5  # of the ball
CENTRE = np.array([0, 0, 0.65])
GRIP = 0.7  # share of a slide on the ball that friction takes back
STEP = 1 / 120  # s
STEPS = 480
ROUNDS = 40  # of all links, in each step
AIR = 0.98  # share of the speed that a step leaves
GRAVITY = 9.8

# Offsets along rows and columns of the points that a link joins, and its stiffness, 0 to 1.
LINKS = [((0, 1), 1.0), ((1, 0), 1.0), ((1, 1), 0.15), ((1, -1), 0.15), ((0, 2), 0.3), ((2, 0), 0.3)]


def flat_cloth() -> np.ndarray:
    """Points, [row][column][3], just above the ball; a little uneven, as no cloth falls quite level."""
    along = np.linspace(-EDGE / 2, EDGE / 2, POINTS)
    x, y = np.meshgrid(along, along)
    z = CENTRE[2] + RADIUS + 0.05 + 0.004 * np.sin(3 * x + 1) * np.cos(4 * y + 2) + 0.003 * np.sin(7 * y - 2 * x)
    return np.stack([x + 0.03, y - 0.02, z], axis=-1)


def batches(offset: tuple[int, int]):
    """Slices of both ends of the links of an offset, in batches whose links share no point."""
    down, right = offset
    ends = [(0, POINTS - down), (max(0, -right), POINTS - max(0, right))]
    axis = 0 if down else 1
    period = 2 * max(offset)
    for start in range(period):
        near, far = [], []
        for a, (first, stop) in enumerate(ends):
            step = period if a == axis else 1
            first += start if a == axis else 0
            near.append(slice(first, stop, step))
            far.append(slice(first + offset[a], stop + offset[a], step))
        yield tuple(near), tuple(far)


def pull(points: np.ndarray, offset: tuple[int, int], stiffness: float):
    """Moves the ends of each link toward its length in the flat cloth."""
    length = EDGE / (POINTS - 1) * np.hypot(*offset)
    for near, far in batches(offset):
        between = points[far] - points[near]
        distance = np.linalg.norm(between, axis=-1, keepdims=True)
        move = 0.5 * stiffness * (1 - length / distance) * between
        points[near] += move
        points[far] -= move


def collide(points: np.ndarray, before: np.ndarray):
    """Pushes points out of the ball, on which they slide little."""
    away = points - CENTRE
    distance = np.linalg.norm(away, axis=-1, keepdims=True)
    inside = (distance < RADIUS)[..., 0]
    points[inside] = (CENTRE + away / distance * RADIUS)[inside]
    points[inside] += GRIP * (before - points)[inside]


def drape() -> np.ndarray:
    """Points of the cloth at rest, [row][column][3]."""
    points = flat_cloth()
    speed = np.zeros_like(points)
    for _ in range(STEPS):
        before = points.copy()
        speed[..., 2] -= STEP * GRAVITY
        points += STEP * speed
        for _ in range(ROUNDS):
            for offset, stiffness in LINKS:
                pull(points, offset, stiffness)
        collide(points, before)
        speed = AIR * (points - before) / STEP
    return smoothed(smoothed(points))


def smoothed(points: np.ndarray) -> np.ndarray:
    """Inner points moved half way to the mean of their four neighbours: no teeth where a fold is narrow."""
    result = points.copy()
    around = points[:-2, 1:-1] + points[2:, 1:-1] + points[1:-1, :-2] + points[1:-1, 2:]
    result[1:-1, 1:-1] = 0.5 * points[1:-1, 1:-1] + 0.125 * around
    return result


def normals(points: np.ndarray) -> np.ndarray:
    """Unit normals, upward where the cloth lies flat."""
    n = np.cross(np.gradient(points, axis=1), np.gradient(points, axis=0))
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


def write_ply(path: str, points: np.ndarray):
    """Binary PLY with normals and texture coordinates."""
    names = ("x", "y", "z", "nx", "ny", "nz", "u", "v")
    v, u = np.meshgrid(*2 * [np.linspace(0, 1, POINTS)], indexing="ij")
    vertices = np.concatenate([points, normals(points), u[..., None], v[..., None]], axis=-1).astype("<f4")
    corner = np.arange(POINTS * POINTS).reshape(POINTS, POINTS)[:-1, :-1].ravel()
    faces = np.zeros(2 * len(corner), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"][0::2] = corner[:, None] + (0, 1, POINTS + 1)
    faces["corners"][1::2] = corner[:, None] + (0, POINTS + 1, POINTS)
    properties = "".join(f"property float {name}\n" for name in names)
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {POINTS * POINTS}\n{properties}"
              f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    with open(path, "wb") as file:
        file.write(header.encode() + vertices.tobytes() + faces.tobytes())


if __name__ == "__main__":
    write_ply(sys.argv[1] if len(sys.argv) > 1 else "drape.ply", drape())
