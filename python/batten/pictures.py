"""Pictures of surfaces, as the tool makes them."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native
from .errors import Error
from .mesh import PathLike, as_mesh
from .progress import Progress, callback

__all__ = ["render", "write_png"]

Pixels = npt.NDArray[np.uint8]


def _linear(colors: npt.ArrayLike) -> npt.NDArray[np.float64]:
    given = np.asarray(colors, dtype=np.float64)
    return np.where(given <= 0.04045, given / 12.92, ((given + 0.055) / 1.055) ** 2.4)


def render(
    mesh: Any,
    *,
    values: npt.ArrayLike | None = None,
    map: str = "sequential",
    range: tuple[float, float] | None = None,
    colors: npt.ArrayLike | None = None,
    normals: npt.ArrayLike | None = None,
    lines: Any = None,
    points: npt.ArrayLike | None = None,
    width: int = 800,
    height: int = 600,
    view: str = "auto",
    up: str = "auto",
    zebra: bool = False,
    transparent: bool = False,
    progress: Progress = None,
) -> Pixels:
    """A picture of a mesh as it is (``tessellate`` a control mesh first): (h, w, 3), or (h, w, 4) if transparent.

    Args:
        values: (n,) numbers at the vertices, in colours of ``map``: "sequential", or "diverging" around zero.
        range: the numbers at both ends of the colours.
        colors: (n, 3) in [0, 1], as files hold them (sRGB).
        normals: (n, 3) for shading; computed from the faces if not given.
        lines: a mesh whose edges are drawn, such as the control mesh. points: (k, 3), drawn as dots.
        view: "auto", "front", "back", "left", "right", "top", "bottom" or "iso". up: "auto", "x", "y", "z", "-x", ...
        zebra: bands of light that show how smooth the surface is.
    """
    if not hasattr(_native, "render"):
        raise Error("this build has no pictures; build the package with BATTEN_WITH_RENDER", "not-available")
    nothing = np.zeros((0, 3))
    return _native.render(
        as_mesh(mesh)._data(),
        None if lines is None else as_mesh(lines)._data(),
        np.zeros(0) if values is None else np.ascontiguousarray(values, dtype=np.float64),
        map,
        range,
        nothing if colors is None else _linear(colors),
        nothing if normals is None else np.ascontiguousarray(normals, dtype=np.float64),
        nothing if points is None else np.ascontiguousarray(points, dtype=np.float64),
        width,
        height,
        view,
        up,
        zebra,
        transparent,
        callback(progress),
    )


def write_png(path: PathLike, pixels: npt.ArrayLike) -> None:
    """Writes a picture, (h, w, 3) or (h, w, 4) of uint8."""
    _native.write_png(os.fspath(path), np.asarray(pixels, dtype=np.uint8))
