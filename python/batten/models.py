"""Surfaces of medial models, and surfaces coloured by noise."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

from . import _native
from .mesh import Array, Mesh, PathLike, as_mesh
from .progress import Progress, callback

__all__ = ["MedialSurface", "medial", "texture"]


@dataclass(frozen=True)
class MedialSurface:
    """The closed surface through the ends of a medial model's spokes; entry i belongs to spoke and vertex i.

    Attributes:
        mesh: the control mesh, with attributes "medial" and "radius".
        ends: (n, 3), the ends of the spokes. radii: (n,), their lengths.
        distances: (n,), from an end to the surface's vertex. angles: (n,), between spoke and normal, in radians.
        shifts: (n,), how far the medial point that the surface's own normal gives is from the model's.
    """

    mesh: Mesh
    ends: Array
    radii: Array
    distances: Array
    angles: Array
    shifts: Array


def medial(path: PathLike, *, normals: bool = False, progress: Progress = None) -> MedialSurface:
    """Reads a medial model (3D Slicer's ``.srep.json``, or Batten's own) and makes its surface.

    Args:
        normals: turn the surface's normals to the spokes; the control mesh is then refined twice.
    """
    data, *rows = _native.medial(os.fspath(path), normals, callback(progress))
    return MedialSurface(Mesh._of(data), *rows)


def texture(
    mesh: Any,
    preset: str = "marble",
    *,
    seed: int = 1,
    frequency: float = 0.0,
    levels: int = 3,
    flat: bool = False,
    displacement: float = 0.0,
    scheme: str = "auto",
    boundary: str | None = None,
    progress: Progress = None,
) -> Mesh:
    """The limit surface with a colour at each vertex: "marble", "wood", "granite", "rust" or "clouds".

    Args:
        frequency: of the main noise; 0: the preset's. displacement: moves the surface along its normals by the noise,
            in the points' unit. flat: the control mesh's own faces, not the smooth surface.
    """
    control = as_mesh(mesh)
    topology, rules = control._surface(scheme, boundary)
    return Mesh._of(
        _native.texture(
            topology,
            rules,
            control._data(),
            preset,
            seed,
            float(frequency),
            levels,
            flat,
            float(displacement),
            callback(progress),
        )
    )
