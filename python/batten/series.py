"""The mesh series: smoothing, sharpening, bands of detail, morphing."""

from __future__ import annotations

import collections.abc as abc
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native
from .errors import Error
from .mesh import Array, Mesh, as_mesh
from .progress import Progress, callback
from .rebuilt import Rebuilt
from .reports import DenoiseReport, SharpenReport

__all__ = [
    "Bands",
    "Denoised",
    "MeshSeries",
    "Sharpened",
    "bands",
    "denoise",
    "morph",
    "sharpen",
]


class MeshSeries(Rebuilt):
    """Smooths values at the vertices of a mesh by powers of its limit matrix, after Lai and Cheng.

    Args:
        matrix: "limit": by the mesh; "cotangent": by the shape of its points, the same however finely it is meshed.
        kept: (n,) booleans: vertices that keep their values.
    """

    def __init__(
        self,
        mesh: Any,
        *,
        matrix: str = "limit",
        kept: npt.ArrayLike | None = None,
        scheme: str = "auto",
        boundary: str | None = None,
        progress: Progress = None,
    ) -> None:
        given = as_mesh(mesh)
        topology, self._rules = given._surface(scheme, boundary)
        shape = given.points if matrix == "cotangent" else np.zeros((0, 3))
        marks = np.zeros(0, dtype=bool) if kept is None else np.asarray(kept, dtype=bool)
        self._native = _native.MeshSeries(topology, self._rules, matrix, shape, marks, callback(progress))

    def smooth(self, values: npt.ArrayLike, *, m: int = 2, passes: int = 4, progress: Progress = None) -> Array:
        """Values, (n, k), after so many passes that keep the terms 0 to m."""
        given = np.ascontiguousarray(values, dtype=np.float64)
        return self._native.smooth(given, m, passes, callback(progress))

    def term(self, values: npt.ArrayLike, index: int, *, progress: Progress = None) -> Array:
        """One term of the series of values, (n, k)."""
        return self._native.term(np.ascontiguousarray(values, dtype=np.float64), index, callback(progress))

    def partial_sum(self, values: npt.ArrayLike, last: int, *, progress: Progress = None) -> Array:
        """The terms 0 to ``last`` together."""
        given = np.ascontiguousarray(values, dtype=np.float64)
        return self._native.partial_sum(given, last, callback(progress))


@dataclass(frozen=True)
class Denoised:
    """A mesh without its noise, and what was removed. Sharp edges that were found are its creases."""

    mesh: Mesh
    report: DenoiseReport


def denoise(
    mesh: Any,
    *,
    passes: int | None = None,
    m: int = 2,
    matrix: str = "limit",
    features: float | None = None,
    keep_boundary: bool = False,
    keep_volume: bool = False,
    scheme: str = "auto",
    boundary: str | None = None,
    progress: Progress = None,
) -> Denoised:
    """Smooths noise away and leaves the shape.

    Args:
        passes: how strongly; None: as the noise that is measured asks for.
        features: keep edges sharper than this many degrees, found in the noise, besides the mesh's creases.
    """
    given = as_mesh(mesh)
    topology, rules = given._surface(scheme, boundary)
    points, numbers, creases = _native.denoise(
        topology,
        rules,
        given.points,
        matrix,
        m,
        -1 if passes is None else passes,
        features or 0.0,
        keep_boundary,
        keep_volume,
        callback(progress),
    )
    result = given.with_points(points)
    if creases:
        result = Mesh(
            points,
            (given.face_offsets, given.face_vertices),
            creases=list(given.creases) + creases,
            corners=given.corners,
            holes=given.holes,
            attributes=given.attributes,
            scheme=given.scheme,
            boundary=given.boundary,
        )
    return Denoised(result, DenoiseReport(**numbers))


@dataclass(frozen=True)
class Sharpened:
    """A mesh with stronger detail, and by how much."""

    mesh: Mesh
    report: SharpenReport


def sharpen(
    mesh: Any,
    *,
    amount: float = 1.0,
    m: int = 1,
    n: int = 3,
    passes: int = 1,
    scheme: str = "auto",
    boundary: str | None = None,
    progress: Progress = None,
) -> Sharpened:
    """Makes detail stronger: adds the powers m to n of what the limit matrix takes away, times ``amount``."""
    given = as_mesh(mesh)
    topology, rules = given._surface(scheme, boundary)
    points, numbers = _native.sharpen(topology, rules, given.points, m, n, passes, amount, callback(progress))
    return Sharpened(given.with_points(points), SharpenReport(**numbers))


@dataclass(frozen=True)
class Bands:
    """A mesh mixed anew from bands of detail.

    Attributes:
        mesh: the result.
        energies: how much detail each band had.
        lengths: the shortest and longest bumps of each band, in mean edges; the last goes on without end.
    """

    mesh: Mesh
    energies: tuple[float, ...]
    lengths: tuple[tuple[float, float], ...]


def bands(
    mesh: Any,
    gains: abc.Sequence[float],
    *,
    matrix: str = "limit",
    scheme: str = "auto",
    boundary: str | None = None,
    progress: Progress = None,
) -> Bands:
    """Splits the points into as many octaves of detail as there are gains, finest first, and adds them up, each times
    its gain; the last is the overall shape. All ones give the mesh itself."""
    given = as_mesh(mesh)
    series = MeshSeries(given, matrix=matrix, scheme=scheme, boundary=boundary)
    points, energies, lengths = series._native.equalize(
        series._rules, matrix, given.points, [float(gain) for gain in gains], callback(progress)
    )
    return Bands(given.with_points(points), tuple(energies), tuple(lengths))


def morph(
    start: Any,
    end: Any,
    times: npt.ArrayLike,
    *,
    stages: int = 4,
    m: int = 1,
    low_first: bool = True,
    scheme: str = "auto",
    boundary: str | None = None,
    progress: Progress = None,
) -> list[Mesh]:
    """The meshes on the way from one to another of the same connectivity, at times in [0, 1].

    Args:
        stages: how many octaves move one after the other; 0: straight lines.
        low_first: the overall shape moves before the detail.
    """
    first, last = as_mesh(start), as_mesh(end)
    if not np.array_equal(first.face_vertices, last.face_vertices) or not np.array_equal(
        first.face_offsets, last.face_offsets
    ):
        raise Error("both meshes must have the same faces with the same vertices", "bad-shape")
    series = MeshSeries(first, scheme=scheme, boundary=boundary)
    way = _native.Morph(series._native, first.points, last.points, m, stages, low_first, callback(progress))
    return [first.with_points(way.at(float(t))) for t in np.atleast_1d(np.asarray(times, dtype=np.float64))]
