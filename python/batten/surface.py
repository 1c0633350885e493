"""The limit surface of a control mesh: exact places, nearest places, triangles and quads to draw."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _native
from .errors import Error
from .mesh import Array, Indices, Mesh, as_mesh, points_array
from .progress import Progress, callback
from .rebuilt import Rebuilt
from .reports import DistanceSummary

Floats = npt.NDArray[np.float32]
_PARTS = ("point", "du", "dv", "duu", "duv", "dvv")


def limit_positions(
    mesh: Any,
    values: npt.ArrayLike | None = None,
    *,
    scheme: str = "auto",
    boundary: str | None = None,
    progress: Progress = None,
) -> Array:
    """Where the limit surface has the vertices of a control mesh, (n, 3); or the limits of other values, (n, k)."""
    control = as_mesh(mesh)
    topology, rules = control._surface(scheme, boundary)
    given = control.points if values is None else np.ascontiguousarray(values, dtype=np.float64)
    return _native.limit_positions(topology, rules, given, callback(progress))


def limit_normals(
    mesh: Any, *, scheme: str = "auto", boundary: str | None = None, progress: Progress = None
) -> Array:
    """The limit surface's unit normals at the vertices, (n, 3); zeros where there is none."""
    control = as_mesh(mesh)
    topology, rules = control._surface(scheme, boundary)
    return _native.limit_normals(topology, rules, control.points, callback(progress))


@dataclass(frozen=True)
class Curvature:
    """Curvatures at places, positive where the surface bends away from its outward normal, in 1/unit.

    Attributes:
        normal: (n, 3) unit vectors; zeros where there is no tangent plane.
        mean, gaussian, greatest, least: (n,).
        greatest_direction, least_direction: (n, 3) unit vectors.
    """

    normal: Array
    mean: Array
    gaussian: Array
    greatest: Array
    least: Array
    greatest_direction: Array
    least_direction: Array


class LimitSurface(Rebuilt):
    """Exact places on the limit surface of a control mesh.

    A place is a face and (u, v) in it: u runs from the face's first corner to its second, v to a quad's fourth or a
    triangle's third. Where a Catmull-Clark mesh has faces that are no quads, the faces are those of its first refinement:
    the quad at each corner of each face, in the order of ``face_vertices``.
    """

    def __init__(
        self, mesh: Any, *, scheme: str = "auto", boundary: str | None = None, progress: Progress = None
    ) -> None:
        self._mesh = as_mesh(mesh)
        topology, rules = self._mesh._surface(scheme, boundary)
        self._native = _native.LimitSurface(topology, rules, self._mesh.points, callback(progress))

    @property
    def mesh(self) -> Mesh:
        """The control mesh."""
        return self._mesh

    @property
    def face_count(self) -> int:
        """How many faces places may name."""
        return int(self._native.face_count())

    def jets(self, face: npt.ArrayLike, uv: npt.ArrayLike) -> Array:
        """Points and derivatives, (n, 6, 3): point, du, dv, duu, duv, dvv."""
        return self._native.jets(np.atleast_1d(np.asarray(face, dtype=np.int32)), np.atleast_2d(uv))

    def points(self, face: npt.ArrayLike, uv: npt.ArrayLike) -> Array:
        """(n, 3)."""
        return self.jets(face, uv)[:, 0]

    def normals(self, face: npt.ArrayLike, uv: npt.ArrayLike) -> Array:
        """Unit normals, (n, 3)."""
        return self.curvature(face, uv).normal

    def curvature(self, face: npt.ArrayLike, uv: npt.ArrayLike) -> Curvature:
        """Normals and curvatures of each place."""
        normals, numbers, directions = self._native.curvatures(
            np.atleast_1d(np.asarray(face, dtype=np.int32)), np.atleast_2d(uv)
        )
        mean, gaussian, greatest, least = numbers.T
        return Curvature(normals, mean, gaussian, greatest, least, directions[:, 0], directions[:, 1])


@dataclass(frozen=True)
class SparseRows:
    """A sparse matrix row by row: row i has ``data[indptr[i]:indptr[i + 1]]`` in the columns ``indices`` there."""

    data: Array
    indices: Indices
    indptr: Indices
    shape: tuple[int, int]


def sparse_rows(data: Array, indices: Indices, indptr: Indices, shape: tuple[int, int]) -> Any:
    """A scipy.sparse.csr_array where SciPy is installed, else SparseRows."""
    try:
        csr_array = importlib.import_module("scipy.sparse").csr_array
    except ImportError:
        return SparseRows(data, indices, indptr, shape)
    return csr_array((data, indices, indptr), shape=shape)


def surface_weights(
    mesh: Any,
    face: npt.ArrayLike,
    uv: npt.ArrayLike,
    *,
    part: str = "point",
    scheme: str = "auto",
    boundary: str | None = None,
    progress: Progress = None,
) -> Any:
    """The matrix W with W @ control points = the surface's points (or ``part``: du, dv, duu, duv, dvv) at places.

    A scipy.sparse.csr_array where SciPy is installed, else SparseRows.
    """
    if part not in _PARTS:
        raise Error(f"the part is one of {', '.join(_PARTS)}, not '{part}'")
    topology, rules = as_mesh(mesh)._surface(scheme, boundary)
    data, indices, indptr, shape = _native.surface_weights(
        topology,
        rules,
        np.atleast_1d(np.asarray(face, dtype=np.int32)),
        np.atleast_2d(uv),
        _PARTS.index(part),
        callback(progress),
    )
    return sparse_rows(data, indices, indptr, shape)


@dataclass(frozen=True)
class Nearest:
    """The nearest places of a surface: points (n, 3), distances (n,), and their faces (n,) and uv (n, 2)."""

    points: Array
    distances: Array
    faces: Indices
    uv: Array


class NearestPoints(Rebuilt):
    """Finds the nearest places of a control mesh's limit surface: proved, not sampled."""

    def __init__(
        self, mesh: Any, *, scheme: str = "auto", boundary: str | None = None, progress: Progress = None
    ) -> None:
        control = as_mesh(mesh)
        topology, rules = control._surface(scheme, boundary)
        self._native = _native.NearestPoints(topology, rules, control.points, callback(progress))

    @property
    def tolerance(self) -> float:
        """No other place is nearer by more than this, in the points' unit."""
        return float(self._native.tolerance())

    def query(self, points: npt.ArrayLike, *, progress: Progress = None) -> Nearest:
        """The nearest place to each of the points, (n, 3)."""
        return Nearest(*self._native.query(points_array(points), callback(progress)))


@dataclass(frozen=True)
class Distances:
    """Distances of points from a surface.

    Attributes:
        values: (n,); negative inside where the surface is closed.
        summary: of their sizes.
        closed: whether there is an inside.
        diagonal: of the surface's box.
    """

    values: Array
    summary: DistanceSummary
    closed: bool
    diagonal: float


def distance(
    mesh: Any, points: npt.ArrayLike, *, scheme: str = "auto", boundary: str | None = None, progress: Progress = None
) -> Distances:
    """How far points, (n, 3), lie from the limit surface of a control mesh."""
    control = as_mesh(mesh)
    topology, rules = control._surface(scheme, boundary)
    values, closed, diagonal, _ = _native.distances(
        topology, rules, control.points, points_array(points), callback(progress)
    )
    return Distances(values, DistanceSummary(**_native.summarize(values)), closed, diagonal)


class Refinement(Rebuilt):
    """One step of uniform refinement, made once for a connectivity and used for any values at its vertices.

    Row i < n of what comes out belongs to vertex i; then come the edges, and for Catmull-Clark the faces.
    """

    def __init__(
        self, mesh: Any, *, scheme: str = "auto", boundary: str | None = None, progress: Progress = None
    ) -> None:
        self._control = as_mesh(mesh)
        self._native = _native.Refinement(*self._control._surface(scheme, boundary), callback(progress))

    @property
    def vertex_count(self) -> int:
        """Of the refined mesh."""
        return self._native.vertex_count()

    @property
    def mesh(self) -> Mesh:
        """The refined control mesh of the one that was given, without its attributes; the surface is the same."""
        return Mesh._of(self._native.mesh(self(self._control.points)))

    def __call__(self, values: npt.ArrayLike, *, progress: Progress = None) -> Array:
        """Values at the refined mesh's vertices, (n', k) or (n',), from those at the control mesh's, (n, k) or (n,)."""
        given = np.asarray(values, dtype=np.float64)
        refined = self._native.apply(given, callback(progress))
        return refined[:, 0] if given.ndim == 1 else refined


class Tessellator(Rebuilt):
    """The limit surface, or the refined control mesh, of the same connectivity again and again, into the same memory.

    Attributes:
        points: (n, 3) of the last call; float32 unless dtype says float64.
        normals: (n, 3), or None.
    """

    def __init__(
        self,
        mesh: Any,
        levels: int,
        *,
        limit: bool = True,
        normals: bool = False,
        dtype: npt.DTypeLike = np.float32,
        scheme: str = "auto",
        boundary: str | None = None,
    ) -> None:
        control = as_mesh(mesh)
        topology, rules = control._surface(scheme, boundary)
        self._limit = limit
        self._native = _native.Tessellator(topology, rules, levels)
        count = self._native.vertex_count()
        kind = np.dtype(dtype)
        if kind not in (np.dtype(np.float32), np.dtype(np.float64)):
            raise Error(f"points are float32 or float64, not {kind}")
        self.points: Union[Floats, Array] = np.empty((count, 3), dtype=kind)
        self.normals: Union[Floats, Array, None] = np.empty((count, 3), dtype=kind) if normals else None
        self._none = np.empty((0, 3), dtype=kind)

    @property
    def faces(self) -> Indices:
        """(m, 4) quads, or (m, 3) triangles."""
        return self._native.faces()

    def __call__(self, control: npt.ArrayLike, *, progress: Progress = None) -> Union[Floats, Array]:
        """Fills ``points`` and ``normals`` from control points, (n, 3), and returns the points."""
        normals = self._none if self.normals is None else self.normals
        self._native.into(points_array(control, "control points"), self.points, normals, self._limit, callback(progress))
        return self.points


def tessellate(
    mesh: Any,
    levels: int | None = None,
    *,
    chord: float = 0.0,
    edge_length: float = 0.0,
    angle: float = 0.0,
    scheme: str = "auto",
    boundary: str | None = None,
    progress: Progress = None,
) -> Mesh:
    """The limit surface as a mesh to draw: refined so often, with attributes; or triangles as bounds ask.

    Args:
        levels: refinements, with every vertex on the limit surface.
        chord: the greatest distance of a triangle from the surface, in the points' unit.
        edge_length: the greatest length of an edge.
        angle: the greatest angle between the normals at a triangle's corners, in radians.

    Raises:
        Error: unless there are either levels or bounds.
    """
    control = as_mesh(mesh)
    topology, rules = control._surface(scheme, boundary)
    bounded = chord > 0.0 or edge_length > 0.0 or angle > 0.0
    if bounded == (levels is not None):
        raise Error("give either levels, or bounds: chord, edge_length, angle")
    if levels is not None:
        return Mesh._of(_native.surface_mesh(topology, rules, control._data(), levels, callback(progress)))
    data, _ = _native.tessellate_adaptively(
        topology, rules, control.points, chord, edge_length, angle, callback(progress)
    )
    return Mesh._of(data)
