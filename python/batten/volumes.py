"""Small, smooth surfaces of parts of volumes, such as MRI and CT."""

from __future__ import annotations

import collections.abc as abc
import importlib
import os
import time
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native
from .errors import Error
from .mesh import Array, Mesh, PathLike, as_mesh, points_array
from .progress import Progress, callback
from .reports import DistanceSummary, SegmentReport

__all__ = [
    "Segmented",
    "Together",
    "Volume",
    "read_marked_points",
    "read_volume",
    "segment",
    "segment_together",
    "write_volume",
]


_LPS = np.diag([-1.0, -1.0, 1.0, 1.0])
_LARGEST_LABEL = 2**24  # beyond, floats do not tell whole numbers apart


def _largest(numbers: npt.NDArray[Any]) -> int:
    return max(abs(int(numbers.min())), abs(int(numbers.max())))


def _placed(spacing: Any, affine: Any, space: str) -> Array:
    """The matrix, in RAS, that a spacing or a matrix in `space` says."""
    if space not in ("ras", "lps"):
        raise Error(f"the space is one of ras, lps, not '{space}'")
    if affine is not None and spacing is not None:
        raise Error("an affine matrix says the spacing; give one of both")
    if affine is None:
        steps = np.ones(3) if spacing is None else np.asarray(spacing, dtype=np.float64)
        if steps.shape not in ((), (3,)):
            raise Error(f"the spacing is one number or three, not an array of shape {steps.shape}", "bad-shape")
        matrix = np.diag(np.append(np.broadcast_to(steps, 3), 1.0))
    else:
        matrix = np.array(affine, dtype=np.float64)
        if matrix.shape != (4, 4):
            raise Error(f"an affine matrix must be an array of shape (4, 4), not {matrix.shape}", "bad-shape")
    return np.asarray(matrix if space == "ras" else _LPS @ matrix)


class Volume:
    """Numbers at voxels, and where these are.

    Args:
        values: (ni, nj, nk): ``values[i, j, k]`` belongs to voxel (i, j, k). The array is kept as it is; surfaces are
            found in single precision.
        spacing: between voxels, mm: one number or three; 1 where nothing is said.
        affine: (4, 4), instead: the matrix that takes (i, j, k, 1) to the voxel's centre in the world, in mm.
        space: the world of ``affine``: "ras" (right, anterior, superior: NIfTI) or "lps" (left, posterior, superior:
            DICOM, ITK).

    Raises:
        Error: for an array that has not three dimensions. Objects with ``dataobj`` and ``affine`` (nibabel) are taken
        as volumes wherever one is asked for.
    """

    def __init__(
        self,
        values: npt.ArrayLike,
        *,
        spacing: float | abc.Sequence[float] | None = None,
        affine: npt.ArrayLike | None = None,
        space: str = "ras",
    ) -> None:
        self._values = np.asarray(values)
        if self._values.ndim != 3:
            raise Error(f"a volume must be an array of three dimensions, not {self._values.ndim}", "bad-shape")
        kind = self._values.dtype.kind
        if kind not in "biuf":
            raise Error(f"a volume's values must be numbers, not {self._values.dtype}")
        if kind in "iu" and self._values.size and _largest(self._values) > _LARGEST_LABEL:
            raise Error(f"whole numbers beyond {_LARGEST_LABEL} are not told apart; number the labels anew")
        self._affine = _placed(spacing, affine, space)

    @property
    def values(self) -> npt.NDArray[Any]:
        """(ni, nj, nk)."""
        return self._values

    @property
    def affine(self) -> Array:
        """(4, 4), from (i, j, k, 1) to the world, in RAS and mm."""
        return self._affine

    @property
    def shape(self) -> tuple[int, int, int]:
        """(ni, nj, nk)."""
        ni, nj, nk = self._values.shape
        return ni, nj, nk

    @property
    def spacing(self) -> tuple[float, float, float]:
        """Between voxels along each index, mm."""
        x, y, z = np.linalg.norm(self._affine[:3, :3], axis=0)
        return float(x), float(y), float(z)

    def __repr__(self) -> str:
        size = " x ".join(str(n) for n in self.shape)
        return f"Volume({size} voxels of {' x '.join(f'{step:.3g}' for step in self.spacing)} mm)"


def _files() -> Any:
    """The module that reads and writes files, which a build may lack."""
    try:
        module = importlib.import_module("batten._volumes")
    except ImportError as error:
        raise Error(
            f"this build reads and writes no files of volumes ({error}); give arrays, or build with "
            "BATTEN_WITH_VOLUMES=ON",
            "not-available",
        ) from error
    module.set_error_type(Error)
    return module


def read_volume(path: PathLike) -> Volume:
    """Reads NIfTI, NRRD, MetaImage, or a folder with the slices of one DICOM series, with its place in the world.

    Raises:
        Error: naming the file; "not-available" where the package was built without ITK.
    """
    values, affine = _files().read(os.fspath(path))
    return Volume(values, affine=affine)


def read_marked_points(path: PathLike, *, space: str = "ras") -> Array:
    """Points that were placed in 3D Slicer, (n, 3), in mm: of a .mrk.json or .fcsv, all lists and curves of it together.

    The file says its world; ``space`` is the one that you get them in, "ras" or "lps". What was not placed is left out.
    """
    return _native.read_marked_points(os.fspath(path), space)


def write_volume(path: PathLike, volume: Any) -> None:
    """Writes a volume as ``.nii``, ``.nii.gz``, ``.nrrd`` or ``.mha``: booleans as bytes, all else as floats. An
    existing file is replaced only when all is written."""
    given = _as_volume(volume)
    _files().write(os.fspath(path), given.values, given.affine, given.values.dtype.kind == "b")


def _as_volume(given: Any, spacing: Any = None, affine: Any = None, space: str = "ras") -> Volume:
    own = spacing is not None or affine is not None
    if isinstance(given, Volume) or hasattr(given, "dataobj") or isinstance(given, (str, os.PathLike)):
        if own:
            raise Error("the volume says itself where its voxels are; leave spacing and affine out")
        if isinstance(given, Volume):
            return given
        if hasattr(given, "dataobj"):
            return Volume(np.asanyarray(given.dataobj), affine=given.affine)
        return read_volume(given)
    return Volume(given, spacing=spacing, affine=affine, space=space)


@dataclass(frozen=True)
class Segmented:
    """The surface of a part of a volume.

    Attributes:
        mesh: the control mesh, with its scheme.
        fine: the limit surface as triangles.
        report: volume, area, and how well it sits.
        shape: of the volume that it was found in.
        affine: of that volume, in RAS.
        space: the world of ``mesh`` and ``fine``.
    """

    mesh: Mesh
    fine: Mesh
    report: SegmentReport
    shape: tuple[int, int, int]
    affine: Array
    space: str

    def inside(self) -> npt.NDArray[np.bool_]:
        """(ni, nj, nk): whether the centre of the volume's voxel is inside."""
        return _native.inside(self.fine._data(), self.space, self.shape, self.affine, False) > 0.5

    def parts(self) -> npt.NDArray[np.float32]:
        """(ni, nj, nk): the share of each of the volume's voxels that is inside, exact for ``fine``."""
        return _native.inside(self.fine._data(), self.space, self.shape, self.affine, True)


@dataclass(frozen=True)
class Together:
    """Surfaces of several labels that do not meet each other.

    Attributes:
        surfaces: in the order of the labels; the seconds of their reports are those of all.
        first_meetings: pairs of triangles of two surfaces that met before they were moved apart.
        rounds: that moved them apart.
        most_withdrawn: how far the border that they are drawn to was moved inwards at most, mm.
    """

    surfaces: tuple[Segmented, ...]
    first_meetings: int
    rounds: int
    most_withdrawn: float


def _labels(label: Any) -> list[float]:
    if label is None:
        return []
    labels = [float(number) for number in np.atleast_1d(np.asarray(label)).ravel()]
    if not labels:
        raise Error("there is no label in the list; leave it out for all numbers but 0")
    return labels


def _triple(numbers: Any, count: int, what: str) -> tuple[float, ...] | None:
    if numbers is None:
        return None
    values = np.asarray(numbers, dtype=np.float64)
    if values.shape != (count,):
        raise Error(f"{what} must be {count} numbers, not an array of shape {values.shape}", "bad-shape")
    return tuple(values.tolist())


def _mask_pair(mask: Any, image: Volume) -> tuple[npt.NDArray[Any], Array] | None:
    """Labels say where they are, or are an array on the image's grid."""
    if mask is None:
        return None
    if isinstance(mask, (Volume, str, os.PathLike)) or hasattr(mask, "dataobj"):
        given = _as_volume(mask)
        return given.values, given.affine
    given = Volume(mask, affine=image.affine)
    if given.shape != image.shape:
        raise Error(f"labels of shape {given.shape} for an image of shape {image.shape}; give a Volume", "bad-shape")
    return given.values, given.affine


def _segmented(
    mesh: _native.MeshData,
    fine: _native.MeshData,
    report: dict[str, Any],
    volume: Volume,
    space: str,
    seconds: float,
) -> Segmented:
    for way in ("to_surface", "to_border"):
        report[way] = None if report[way] is None else DistanceSummary(**report[way])
    numbers = SegmentReport(**report, seconds=seconds)
    return Segmented(Mesh._of(mesh), Mesh._of(fine), numbers, volume.shape, volume.affine, space)


def segment(
    image: Any,
    *,
    spacing: float | abc.Sequence[float] | None = None,
    affine: npt.ArrayLike | None = None,
    mask: Any = None,
    label: int | abc.Sequence[int] | None = None,
    points: npt.ArrayLike | None = None,
    slices: int | None = None,
    seed: npt.ArrayLike | None = None,
    numbers: tuple[float, float] | None = None,
    start: Any = None,
    edges: bool = False,
    vertices: int | None = None,
    genus: int | None = None,
    smoothing: float | None = None,
    scheme: str | None = None,
    space: str = "ras",
    progress: Progress = None,
) -> Segmented:
    """A small control mesh whose smooth surface is the border of a part of a volume, in mm.

    Without points, slices, seed or start it is the surface of a label. These give a surface that is drawn to the image's
    edges, and labels are then only compared with.

    Args:
        image: a path, a Volume, a nibabel image, or an array (ni, nj, nk).
        spacing, affine: of an array, as in Volume.
        mask: labels: what ``image`` may be; an array has the image's shape. The image itself where nothing is given.
        label: a number of the mask, or several as one; all but 0 where nothing is given.
        points: (n, 3), on the part's border: start and targets.
        slices: the points are the labels' border in every n-th slice; 1 for labels painted in a few slices only.
        seed: a place in the part. numbers: the least and the greatest number of the image in it.
        start: a closed control mesh.
        edges: draws the surface of a label to the image's edges, too.
        vertices: about so many control points; 386.
        genus: demanded; found where nothing is said.
        smoothing: how far the surface may stay away from the steps between voxels to be smooth: RMS, in voxels; 0.15.
        scheme: "catmull-clark", if not given, or "loop".
        space: the world of affine, points, seed and start, and of the surface: "ras" or "lps".
    """
    began = time.perf_counter()
    given = _as_volume(image, spacing, affine, space)
    labels = _mask_pair(mask, given)
    if edges and labels is None:
        raise Error("edges=True draws the surface of a mask to the image; give the mask")
    if start is not None and any(option is not None for option in (vertices, genus, smoothing, scheme)):
        raise Error("the mesh to start from has its own vertices, genus, smoothness and scheme; leave them out")
    if slices is not None and (points is not None or labels is None):
        raise Error("slices are those of a mask, in place of points; give the mask")
    options = {
        "label": _labels(label),
        "slices": slices,
        "points": np.zeros((0, 3)) if points is None else points_array(points),
        "seed": _triple(seed, 3, "a seed"),
        "numbers": _triple(numbers, 2, "the numbers of the part"),
        "start": None if start is None else as_mesh(start)._data(),
        "edges": edges,
        "vertices": vertices,
        "genus": genus,
        "smoothing": smoothing,
        "scheme": scheme,
    }
    found = _native.segment(given.values, given.affine, labels, options, space, callback(progress))
    return _segmented(*found, given, space, time.perf_counter() - began)


def segment_together(
    image: Any,
    labels: abc.Sequence[int],
    *,
    spacing: float | abc.Sequence[float] | None = None,
    affine: npt.ArrayLike | None = None,
    mask: Any = None,
    vertices: int | None = None,
    genus: int | None = None,
    smoothing: float | None = None,
    scheme: str | None = None,
    space: str = "ras",
    progress: Progress = None,
) -> Together:
    """A surface for each of several labels; the surfaces do not meet each other. Arguments are those of ``segment``."""
    began = time.perf_counter()
    given = _as_volume(image, spacing, affine, space)
    pair = _mask_pair(mask, given)
    options = {
        "label": _labels(labels),
        "slices": None,
        "points": np.zeros((0, 3)),
        "seed": None,
        "numbers": None,
        "start": None,
        "edges": False,
        "vertices": vertices,
        "genus": genus,
        "smoothing": smoothing,
        "scheme": scheme,
    }
    surfaces, meetings, rounds, withdrawn = _native.segment_together(
        given.values, given.affine, pair, options, space, callback(progress)
    )
    seconds = time.perf_counter() - began
    parts = tuple(_segmented(*found, given, space, seconds) for found in surfaces)
    return Together(parts, meetings, rounds, withdrawn)
