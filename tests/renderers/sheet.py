"""The wrinkled sheet of `clothbrdf preview`, drawn by Mitsuba from a .bsdf file.

preview draws each point where it lies on the flat sheet, lit as if it were inclined: a flat mesh with inclined shading
frames. Each pixel has a square of its own, so that its frame is that of its centre wherever in it a ray falls.
"""

import pathlib

import mitsuba as mi
import numpy as np

import program

VERTEX = np.dtype([(name, "<f4") for name in ("x", "y", "z", "nx", "ny", "nz", "u", "v")])
FACE = np.dtype([("count", "u1"), ("corners", "<i4", 3)])


def slopes(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """dz/dx and dz/dy of the sheet over the unit square, y upward (the formula above sheet_slope)."""
    turn = 2 * np.pi
    bend = turn * (0.35 * x + 0.75 * y)
    p = turn * (1.7 * x - y + 0.16 * np.sin(bend))
    q = turn * (0.8 * x + 1.3 * y + 0.2)
    bent = turn * 0.16 * np.cos(bend)
    along_p, along_q = 0.045 * turn * np.cos(p), 0.024 * turn * np.cos(q)
    return along_p * (1.7 + bent * 0.35) + along_q * 0.8, along_p * (-1 + bent * 0.75) + along_q * 1.3


def normals(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """[...][3]."""
    along_x, along_y = slopes(*np.broadcast_arrays(x, y))
    n = np.stack([-along_x, -along_y, np.ones_like(along_x)], axis=-1)
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


def flat_tangents(n: np.ndarray) -> np.ndarray:
    """What dp/du must be in the plane of the sheet, [...][2], for a renderer that makes it orthogonal to n.

    The weft is x turned the short way from z to n, t = x - n_x (x n_x + y n_y) / (1 + n_z) - z n_x. t + n n_x / n_z
    lies in the plane and becomes t again.
    """
    share = n[..., 0] * (1 / n[..., 2] - 1 / (1 + n[..., 2]))
    return np.stack([1 + share * n[..., 0], share * n[..., 1]], axis=-1)


def write_ply(path: pathlib.Path, size: int):
    """A mesh of size x size pixels over the unit square."""
    lower = np.arange(size) / size
    y, x = np.meshgrid(lower, lower, indexing="ij")
    n = normals(x + 0.5 / size, y + 0.5 / size)
    dp_du = flat_tangents(n)
    vertices = np.zeros((size, size, 4), VERTEX)
    for corner, (right, up) in enumerate([(0, 0), (1, 0), (1, 1), (0, 1)]):
        at = vertices[:, :, corner]
        at["x"], at["y"] = x + right / size, y + up / size
        at["nx"], at["ny"], at["nz"] = np.moveaxis(n, -1, 0)
        # p = u dp_du + v (dp_du turned by 90 degrees), in pixels from the lower left corner
        length = (dp_du**2).sum(axis=-1)
        at["u"] = (dp_du[..., 0] * right + dp_du[..., 1] * up) / length
        at["v"] = (dp_du[..., 0] * up - dp_du[..., 1] * right) / length
    faces = np.zeros((size * size, 2), FACE)
    faces["count"] = 3
    first = 4 * np.arange(size * size)
    faces["corners"][:, 0] = first[:, None] + (0, 1, 2)
    faces["corners"][:, 1] = first[:, None] + (0, 2, 3)
    properties = "".join(f"property float {name}\n" for name in VERTEX.names)
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {vertices.size}\n{properties}"
              f"element face {faces.size}\nproperty list uchar int vertex_indices\nend_header\n")
    path.write_bytes(header.encode() + vertices.tobytes() + faces.tobytes())


def render(bsdf: pathlib.Path, mesh: pathlib.Path, size: int, light: np.ndarray) -> np.ndarray:
    """The sheet seen from straight above, [row][column][3], by a light of irradiance pi where it faces the light."""
    look = mi.ScalarTransform4f().look_at(origin=[0.5, 0.5, 1], target=[0.5, 0.5, 0], up=[0, 1, 0])
    scene = mi.load_dict({
        "type": "scene",
        "integrator": {"type": "direct", "bsdf_samples": 0, "emitter_samples": 1},
        "sensor": {
            "type": "orthographic",
            "to_world": look @ mi.ScalarTransform4f().scale([0.5, 0.5, 1]),
            "film": {"type": "hdrfilm", "width": size, "height": size, "component_format": "float32",
                     "rfilter": {"type": "box"}},
            "sampler": {"type": "independent", "sample_count": 1},
        },
        "light": {"type": "directional", "direction": (-light).tolist(), "irradiance": {"type": "rgb", "value": np.pi}},
        "sheet": {"type": "ply", "filename": str(mesh), "bsdf": {"type": "measured", "filename": str(bsdf)}},
    })
    return np.array(mi.render(scene))[..., :3]


def preview(file: pathlib.Path, size: int, light_deg: tuple[float, float], folder: pathlib.Path) -> np.ndarray:
    """Our own picture of a material or table, [row][column][3], without its caption."""
    path = folder / "preview.exr"
    program.run("preview", file, "-o", path, "--size", size, "--light", f"{light_deg[0]},{light_deg[1]}")
    picture = np.array(mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))
    gap = (picture.shape[1] - size) // 2
    return picture[-gap - size : -gap, gap:-gap]
