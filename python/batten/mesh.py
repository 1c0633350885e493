"""Meshes: points, faces of any size, and what makes a surface of them."""

from __future__ import annotations

import collections.abc as abc
import os
from dataclasses import dataclass
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _native
from .errors import Error
from .progress import Progress, callback
from .reports import Problem, RepairChange

__all__ = [
    "Array",
    "Attribute",
    "CornerValues",
    "Indices",
    "Mesh",
    "PathLike",
    "Repaired",
    "as_mesh",
    "check",
    "points_array",
    "read",
    "repair",
    "subdivide",
    "triangulate",
    "write",
]

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]
PathLike = Union[str, "os.PathLike[str]"]


@dataclass(frozen=True)
class CornerValues:
    """Values at the corners of faces, such as texture coordinates with seams.

    Attributes:
        values: (k, n) rows that corners share.
        rows: for each corner, face by face, its row of ``values``, or -1 for none.
    """

    values: Array
    rows: Indices


Attribute = Union[Array, CornerValues]


def points_array(points: npt.ArrayLike, what: str = "points") -> Array:
    """C-contiguous doubles of shape (n, 3): the array itself where it is that already."""
    array = np.ascontiguousarray(points, dtype=np.float64)
    if array.size == 0 and array.ndim < 2:
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise Error(f"{what} must be an array of shape (n, 3), not {array.shape}", "bad-shape")
    return array


def _int32(numbers: npt.ArrayLike, what: str) -> Indices:
    array = np.asarray(numbers)
    if array.size == 0:
        return np.zeros(array.shape, dtype=np.int32)
    if array.dtype.kind not in "iu":
        raise Error(f"{what} must be integers, not {array.dtype}", "bad-argument")
    if array.max() > np.iinfo(np.int32).max or array.min() < np.iinfo(np.int32).min:
        raise Error(f"{what} are beyond a 32-bit index", "index-out-of-range")
    return np.ascontiguousarray(array, dtype=np.int32)


def _faces(faces: Any) -> tuple[Indices, Indices]:
    """Offsets and vertices of faces given in any of the ways that Mesh takes."""
    if isinstance(faces, tuple) and len(faces) == 2 and all(np.ndim(part) == 1 for part in faces):
        offsets, vertices = _int32(faces[0], "face offsets"), _int32(faces[1], "face vertices")
        if offsets.size == 0 or offsets[0] != 0 or offsets[-1] != vertices.size or np.any(np.diff(offsets) < 0):
            raise Error("face offsets must rise from 0 to the number of face vertices", "bad-shape")
        return offsets.copy(), vertices.copy()
    if not isinstance(faces, np.ndarray):
        faces = list(faces)
        sizes = [len(face) for face in faces]
        if len(set(sizes)) > 1:
            offsets = np.zeros(len(sizes) + 1, dtype=np.int32)
            np.cumsum(sizes, out=offsets[1:])
            return offsets, _int32(np.concatenate([np.asarray(face) for face in faces]), "face vertices").copy()
        faces = np.asarray(faces) if faces else np.zeros((0, 3), dtype=np.int32)
    if faces.ndim != 2:
        raise Error(
            "faces are an (m, k) array of integers, a list of lists, or (offsets, vertices), "
            f"not an array of shape {faces.shape}",
            "bad-shape",
        )
    count, size = faces.shape
    return (np.arange(count + 1, dtype=np.int64) * size).astype(np.int32), _int32(faces, "faces").reshape(-1).copy()


def _padded_faces(numbers: Any) -> tuple[Indices, Indices]:
    """PyVista's faces: each vertex list after its length, in one row."""
    flat = _int32(numbers, "faces").reshape(-1)
    sizes: list[int] = []
    at = 0
    while at < flat.size:
        sizes.append(int(flat[at]))
        at += 1 + sizes[-1]
    offsets = np.zeros(len(sizes) + 1, dtype=np.int32)
    np.cumsum(sizes, out=offsets[1:])
    lengths_at = offsets[:-1] + np.arange(len(sizes), dtype=np.int32)
    return offsets, np.delete(flat, lengths_at)


class Mesh:
    """A control mesh, or the mesh whose vertices a surface shall pass through. Vertex i stays vertex i.

    Args:
        points: (n, 3). An array of C-contiguous doubles is kept as it is, without a copy.
        faces: (m, 3) or (m, 4) integers, a list of lists, or ``(offsets, vertices)``; counter-clockwise from outside.
        creases: (a, b, sharpness) of edges that stay sharp for so many levels; 10 and more: forever.
        corners: (vertex, sharpness).
        holes: faces that shape the surface but are not part of it.
        attributes: names to values at vertices, (n, k), or CornerValues.
        scheme: "catmull-clark", "loop", "butterfly" or "modified-butterfly"; None: chosen by the faces.
        boundary: "edge-only", "edge-and-corner" or "none"; None: edge-only.

    Raises:
        Error: for arrays of a wrong shape. Whether the faces form a surface is checked where one is made of them;
            ``check`` says all that stands against it.
    """

    def __init__(
        self,
        points: npt.ArrayLike,
        faces: Any,
        *,
        creases: abc.Iterable[tuple[int, int, float]] = (),
        corners: abc.Iterable[tuple[int, float]] = (),
        holes: abc.Iterable[int] = (),
        attributes: abc.Mapping[str, Any] | None = None,
        scheme: str | None = None,
        boundary: str | None = None,
    ) -> None:
        self._points = points_array(points)
        self._offsets, self._vertices = _faces(faces)
        self._offsets.setflags(write=False)
        self._vertices.setflags(write=False)
        self._creases = tuple((int(a), int(b), float(s)) for a, b, s in creases)
        self._corners = tuple((int(v), float(s)) for v, s in corners)
        self._holes = tuple(int(f) for f in holes)
        self._attributes: dict[str, Attribute] = {}
        for name, values in (attributes or {}).items():
            self._attributes[name] = (
                values if isinstance(values, CornerValues) else np.ascontiguousarray(values, dtype=np.float64)
            )
        self._scheme = scheme
        self._boundary = boundary
        self._surfaces: dict[tuple[str, str], tuple[_native.Topology, _native.Scheme]] = {}

    @property
    def points(self) -> Array:
        """(n, 3) doubles; writing into them moves the vertices."""
        return self._points

    @property
    def face_offsets(self) -> Indices:
        """(m + 1,): face f has the corners from ``face_offsets[f]`` up to ``face_offsets[f + 1]``. Read-only."""
        return self._offsets

    @property
    def face_vertices(self) -> Indices:
        """The vertex of each corner, face by face. Read-only."""
        return self._vertices

    @property
    def faces(self) -> Union[Indices, list[Indices]]:
        """(m, k) where all faces have k corners, else a list of arrays."""
        sizes = np.diff(self._offsets)
        if sizes.size == 0:
            return np.zeros((0, 3), dtype=np.int32)
        if (sizes == sizes[0]).all():
            return self._vertices.reshape(-1, int(sizes[0]))
        return np.split(self._vertices, self._offsets[1:-1])

    @property
    def creases(self) -> tuple[tuple[int, int, float], ...]:
        """(a, b, sharpness) of sharp edges."""
        return self._creases

    @property
    def corners(self) -> tuple[tuple[int, float], ...]:
        """(vertex, sharpness)."""
        return self._corners

    @property
    def holes(self) -> tuple[int, ...]:
        """Faces that are not part of the surface."""
        return self._holes

    @property
    def attributes(self) -> abc.Mapping[str, Attribute]:
        """Values at vertices, (n, k), or at corners."""
        return self._attributes

    @property
    def scheme(self) -> str | None:
        """What the mesh says about its surface's scheme."""
        return self._scheme

    @property
    def boundary(self) -> str | None:
        """What the mesh says about its surface's boundary."""
        return self._boundary

    @property
    def vertex_count(self) -> int:
        """n."""
        return int(self._points.shape[0])

    @property
    def face_count(self) -> int:
        """m."""
        return int(self._offsets.size) - 1

    def with_points(self, points: npt.ArrayLike) -> "Mesh":
        """The same connectivity, tags and attributes with other points, (n, 3)."""
        moved = points_array(points)
        if moved.shape != self._points.shape:
            raise Error(f"there are {self.vertex_count} vertices, but points of shape {moved.shape}", "bad-shape")
        result = Mesh.__new__(Mesh)
        result.__dict__.update(self.__dict__)
        result._points = moved
        return result

    def __repr__(self) -> str:
        extra = [f"{len(self._creases)} creases"] if self._creases else []
        extra += [f"attributes {', '.join(self._attributes)}"] if self._attributes else []
        return f"Mesh({', '.join([f'{self.vertex_count} vertices', f'{self.face_count} faces'] + extra)})"

    def __getstate__(self) -> dict[str, Any]:
        state = dict(self.__dict__)
        state["_surfaces"] = {}
        return state

    def _data(self) -> _native.MeshData:
        data = _native.MeshData(
            self._points,
            self._offsets,
            self._vertices,
            self._creases,
            self._corners,
            self._holes,
            self._scheme or "",
            self._boundary or "",
        )
        for name, values in self._attributes.items():
            if isinstance(values, CornerValues):
                data.add_attribute(name, values.values, values.rows)
            else:
                data.add_attribute(name, values, np.zeros(0, dtype=np.int32))
        return data

    @staticmethod
    def _of(data: _native.MeshData) -> "Mesh":
        attributes = {
            name: CornerValues(values, rows) if rows.size else values for name, values, rows in data.attributes()
        }
        return Mesh(
            data.points(),
            (data.face_offsets(), data.face_vertices()),
            creases=data.creases(),
            corners=data.corners(),
            holes=data.holes(),
            attributes=attributes,
            scheme=data.scheme() or None,
            boundary=data.boundary() or None,
        )

    def _surface(self, scheme: str = "auto", boundary: str | None = None) -> tuple[_native.Topology, _native.Scheme]:
        """The checked connectivity and the rules, made once."""
        key = (scheme, boundary or "")
        if key not in self._surfaces:
            data = self._data()
            topology = next((known for known, _ in self._surfaces.values()), None)
            self._surfaces[key] = (
                topology or _native.Topology(data, None),
                _native.scheme_of(data, scheme, boundary or ""),
            )
        return self._surfaces[key]


def as_mesh(mesh: Any) -> Mesh:
    """A Mesh itself, or what other packages call one, taken as it is: ``vertices`` and ``faces`` (trimesh), ``points``
    and ``faces`` padded (PyVista), ``points`` and ``cells`` (meshio)."""
    if isinstance(mesh, Mesh):
        return mesh
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        return Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces))
    if hasattr(mesh, "points") and hasattr(mesh, "cells"):
        faces: list[Any] = []
        for block in mesh.cells:
            if block.type in ("triangle", "quad", "polygon"):
                faces.extend(np.asarray(block.data))
        return Mesh(np.asarray(mesh.points), faces)
    if hasattr(mesh, "points") and hasattr(mesh, "faces"):
        return Mesh(np.asarray(mesh.points), _padded_faces(mesh.faces))
    raise Error(f"a {type(mesh).__name__} is no mesh; give a batten.Mesh, or an object with vertices and faces")


def read(path: PathLike, *, format: str = "", progress: Progress = None) -> Mesh:
    """Reads OBJ, PLY, OFF, STL, XYZ, GLB or glTF, packed by gzip or not; every double bit for bit.

    What the file holds and a Mesh does not is said by a UserWarning each.

    Raises:
        Error: naming the file and the line or byte.
    """
    import warnings

    data, notes = _native.read(os.fspath(path), format, callback(progress))
    for note in notes:
        warnings.warn(note, stacklevel=2)
    return Mesh._of(data)


def write(
    path: PathLike, mesh: Any, *, format: str = "", binary: bool = True, progress: Progress = None
) -> list[str]:
    """Writes OBJ, PLY, OFF, STL, XYZ, GLB or USDA. An existing file is replaced only when all is written.

    Returns:
        What the format does not keep of the mesh, such as ``["creases"]``.
    """
    return _native.write(os.fspath(path), as_mesh(mesh)._data(), format, binary, callback(progress))


def check(mesh: Any, *, limit: int = 1, progress: Progress = None) -> list[Problem]:
    """Why no surface can be made of the mesh: nothing if one can. At most ``limit`` messages for each kind."""
    found = _native.check(as_mesh(mesh)._data(), limit, callback(progress))
    return [Problem(_native.code_of(kind), count, tuple(messages)) for kind, count, messages in found]


@dataclass(frozen=True)
class Repaired:
    """A repaired mesh and where its elements come from.

    Attributes:
        mesh: of which a surface can be made.
        changes: by kind; none where nothing was changed.
        vertex_sources: the input's vertex of each vertex.
        face_sources: the input's face of each face.
        vertex_targets: for each of the input's vertices the first that it became, or -1.
        face_targets: for each of the input's faces the first that it became, or -1.
    """

    mesh: Mesh
    changes: tuple[RepairChange, ...]
    vertex_sources: Indices
    face_sources: Indices
    vertex_targets: Indices
    face_targets: Indices


def repair(mesh: Any, *, weld: float = 0.0, progress: Progress = None) -> Repaired:
    """Repairs a mesh that has no surface; what has one is returned bit for bit.

    Args:
        weld: the greatest distance at which vertices of boundaries are joined, of the bounding box's diagonal.
    """
    data, changes, *sources = _native.repair(as_mesh(mesh)._data(), weld, callback(progress))
    return Repaired(Mesh._of(data), tuple(RepairChange(*change) for change in changes), *sources)


def triangulate(mesh: Any) -> Mesh:
    """The same vertices with every face cut into triangles."""
    return Mesh._of(_native.triangulate(as_mesh(mesh)._data()))


def subdivide(
    mesh: Any, levels: int = 1, *, scheme: str = "auto", boundary: str | None = None, progress: Progress = None
) -> Mesh:
    """Refines a control mesh so often; the surface stays. Row i < n belongs to vertex i, attributes go along."""
    control = as_mesh(mesh)
    topology, rules = control._surface(scheme, boundary)
    return Mesh._of(_native.refine(control._data(), topology, rules, levels, callback(progress)))
