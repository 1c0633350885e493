"""Small, editable surfaces from points or fine meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native
from .mesh import Array, Mesh, as_mesh, points_array
from .progress import Progress, callback
from .reports import DistanceSummary, FitReport


@dataclass(frozen=True)
class Fit:
    """A surface fitted to points.

    Attributes:
        mesh: the control mesh.
        distances: from each point to the surface, in the points' unit.
        report: how near, both ways, and why the search ended.
    """

    mesh: Mesh
    distances: Array
    report: FitReport


def fit(
    points: npt.ArrayLike,
    *,
    normals: npt.ArrayLike | None = None,
    vertices: int | None = None,
    tolerance: float = 0.0,
    init: Any = "auto",
    scheme: str = "auto",
    genus: int | None = None,
    bridge: float | None = None,
    method: str = "squared-distance",
    creases: str | None = None,
    rounds: int | None = None,
    progress: Progress = None,
) -> Fit:
    """A control mesh whose limit surface passes near points, (n, 3).

    Args:
        normals: (n, 3), outward; estimated if not given.
        vertices: at most so many control points; 400 if not given.
        tolerance: stop when no point is farther away than this, in the points' unit.
        init: "auto": a first mesh of the right genus; "sphere"; or a mesh, whose vertex i is vertex i of the result.
        genus: demanded of the first mesh.
        bridge: gaps up to this width are closed, wider ones become boundaries.
        method: "squared-distance", or "dynamic": by springs that draw an elastic surface.
        creases: "auto": along sharp edges that the points show, or the tags of a mesh in ``init``; "none"; "keep": those
            tags alone. "auto" if not given.
        rounds: at most so many for each number of control points.
    """
    cloud = points_array(points)
    start, initial = (init, None) if isinstance(init, str) else ("auto", as_mesh(init)._data())
    directions = np.zeros((0, 3)) if normals is None else points_array(normals, "normals")
    data, distances, numbers = _native.fit(
        cloud, directions, start, initial, scheme, vertices, float(tolerance), genus, bridge, method, creases, rounds, callback(progress)
    )
    for way in ("to_surface", "to_points"):
        numbers[way] = DistanceSummary(**numbers[way])
    return Fit(Mesh._of(data), distances, FitReport(**numbers))
