"""Surfaces through points: the control mesh whose limit surface passes through a mesh's vertices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native
from .errors import Error
from .mesh import Array, Indices, Mesh, as_mesh, points_array
from .progress import Progress, callback
from .rebuilt import Rebuilt
from .reports import FairReport, InterpolationReport, UpdateReport


def _report(numbers: dict[str, Any]) -> InterpolationReport:
    numbers["residuals"] = tuple(numbers["residuals"])
    numbers["worst"] = tuple(numbers["worst"])
    return InterpolationReport(**numbers)


@dataclass(frozen=True)
class Interpolant:
    """A surface through targets.

    Attributes:
        mesh: the control mesh. Vertex i < n belongs to target i.
        report: how near the surface comes to them. A FairReport where it is fair.
        attribute_reports: the same for each attribute at vertices that was solved for.
        is_refined: the mesh has more vertices than targets: singular parts, or a fair surface.
    """

    mesh: Mesh
    report: InterpolationReport | FairReport
    attribute_reports: tuple[InterpolationReport, ...] = ()
    is_refined: bool = False

    @property
    def control(self) -> Array:
        """The control points, one row for each vertex of ``mesh``."""
        return self.mesh.points


class Interpolator(Rebuilt):
    """Solves for control points again and again, for targets on the same connectivity.

    Args:
        mesh: its faces and tags; its points are no targets.
        scheme: "catmull-clark", "loop" or "auto", which is what the mesh says, else by its faces.
        boundary: "edge-only", "edge-and-corner" or "none".
        tolerance: the greatest miss, of the targets' bounding box's diagonal.
        method: "auto", "chebyshev", "conjugate-gradient", "direct", "jacobi" (Thall's), "richardson" (Lai and Cheng's).
        on_singular: where no surface passes through all targets: "alpha" refines there once, "least-squares" comes as
            near as can be, "refuse" raises.
    """

    def __init__(
        self,
        mesh: Any,
        *,
        scheme: str = "auto",
        boundary: str | None = None,
        tolerance: float = 1e-10,
        method: str = "auto",
        on_singular: str = "alpha",
        progress: Progress = None,
    ) -> None:
        self._mesh = as_mesh(mesh)
        topology, rules = self._mesh._surface(scheme, boundary)
        self._native = _native.Interpolator(
            topology, rules, float(tolerance), method, on_singular, callback(progress)
        )

    @property
    def mesh(self) -> Mesh:
        """The mesh whose connectivity it was built for."""
        return self._mesh

    def solve(self, targets: npt.ArrayLike, *, progress: Progress = None) -> Interpolant:
        """The control mesh of the surface through ``targets``, (n, 3). Where the tolerance is not reached, the report
        says so."""
        control, numbers, refined = self._native.solve(points_array(targets, "targets"), callback(progress))
        if refined is None:
            return Interpolant(self._mesh.with_points(control), _report(numbers))
        topology, rules = refined
        return Interpolant(Mesh._of(_native.mesh_of(topology, control, rules)), _report(numbers), is_refined=True)

    def solve_values(self, targets: npt.ArrayLike, *, progress: Progress = None) -> Array:
        """Control values for targets of any number of columns, (n, k): of colours or radii, say.

        Raises:
            Error: where they do not exist on this connectivity; ``interpolate`` refines it.
        """
        values = np.ascontiguousarray(targets, dtype=np.float64)
        control, numbers, refined = self._native.solve(values, callback(progress))
        if refined is not None:
            raise Error("a part of the mesh has no surface through these values; interpolate(mesh)", "singular-system")
        if numbers["outcome"] == "not-reached":
            raise Error(f"the values are missed by up to {numbers['max_error']:.3g}", "not-converged")
        return control

    def updates(self, targets: npt.ArrayLike, *, progress: Progress = None) -> "Updates":
        """Solves once and then follows changed targets, in less than a millisecond each on quads."""
        return Updates(self, targets, progress=progress)


class Updates(Rebuilt):
    """A surface whose targets move: see Interpolator.updates."""

    def __init__(self, interpolator: Interpolator, targets: npt.ArrayLike, *, progress: Progress = None) -> None:
        self._interpolator = interpolator
        self._native = _native.Updates(interpolator._native, points_array(targets, "targets"), callback(progress))

    def __reduce__(self) -> tuple[Any, ...]:
        return (Updates, (self._interpolator, self.targets))

    def update(
        self, rows: npt.ArrayLike, targets: npt.ArrayLike, *, rings: int | None = None, progress: Progress = None
    ) -> UpdateReport:
        """Targets ``rows[i]`` become ``targets[i]``.

        Args:
            rings: move only control points within so many rings of faces; None: all that the exact surface asks for.
        """
        changed = np.atleast_1d(np.asarray(rows, dtype=np.int32))
        values = np.atleast_2d(np.asarray(targets, dtype=np.float64))
        numbers = self._native.update(changed, values, -1 if rings is None else rings, callback(progress))
        return UpdateReport(**numbers)

    @property
    def targets(self) -> Array:
        """A copy of all targets as they are."""
        return self._native.targets()

    @property
    def control(self) -> Array:
        """A copy of all control points as they are."""
        return self._native.control()

    @property
    def moved(self) -> Indices:
        """The vertices whose control points the last update moved."""
        return self._native.moved()


def interpolate(
    mesh: Any,
    *,
    scheme: str = "auto",
    boundary: str | None = None,
    fair: bool = False,
    normals: npt.ArrayLike | str | None = None,
    energy: str = "variation",
    smoothing: float = 0.0,
    levels: int | None = None,
    tolerance: float = 1e-10,
    method: str = "auto",
    on_singular: str = "alpha",
    progress: Progress = None,
) -> Interpolant:
    """The control mesh whose limit surface passes through the vertices of ``mesh``; attributes at vertices too.

    Args:
        fair: on the mesh refined once, the surface that swings least of all through the points.
        normals: (n, 3) wanted at the vertices, zeros for none, or "estimate"; with ``fair``.
        energy: what a fair surface has little of: "variation" of curvature, "bending" or "stretch".
        smoothing: a length: bumps shorter than this may leave the points. With ``fair``.
        levels: refinements of a fair surface, 1 or 2.
        For the others see Interpolator.
    """
    given = as_mesh(mesh)
    if not fair:
        if normals is not None or smoothing != 0.0 or levels is not None:
            raise Error("normals, smoothing and levels are of fair surfaces; give fair=True")
        solver = Interpolator(
            given, scheme=scheme, boundary=boundary, tolerance=tolerance, method=method, on_singular=on_singular
        )
        data, is_refined, of_sets = solver._native.interpolate(given._data(), callback(progress))
        reports = [_report(numbers) for numbers in of_sets]
        return Interpolant(Mesh._of(data), reports[0], tuple(reports[1:]), is_refined)
    topology, rules = given._surface(scheme, boundary)
    if isinstance(normals, str):
        if normals != "estimate":
            raise Error(f"normals are an array or 'estimate', not '{normals}'")
        wanted = _native.estimated_normals(topology, given.points)
    else:
        wanted = np.zeros((0, 3)) if normals is None else points_array(normals, "normals")
    data, numbers = _native.interpolate_fairly(
        topology, rules, given.points, wanted, energy, float(smoothing), levels or 0, callback(progress)
    )
    return Interpolant(Mesh._of(data), FairReport(**numbers), is_refined=True)
