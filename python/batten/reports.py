"""Reports: frozen records that print as tables, in notebooks too."""

from __future__ import annotations

import html
from dataclasses import dataclass, fields
from typing import Any, Optional


def _text(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, tuple) and len(value) > 6:
        return f"{len(value)} entries"
    return str(value)


class Report:
    """The base of all reports."""

    def _rows(self) -> list[tuple[str, str]]:
        return [(f.name.replace("_", " "), _text(getattr(self, f.name))) for f in fields(self)]

    def __repr__(self) -> str:
        rows = self._rows()
        width = max(len(name) for name, _ in rows)
        return "\n".join([type(self).__name__] + [f"  {name:{width}}  {text}" for name, text in rows])

    def _repr_html_(self) -> str:
        cells = "".join(
            f"<tr><th style='text-align:left'>{html.escape(name)}</th><td>{html.escape(text)}</td></tr>"
            for name, text in self._rows()
        )
        return f"<table>{cells}</table>"


@dataclass(frozen=True, repr=False)
class InterpolationReport(Report):
    """How near the surface comes to its targets. Lengths are in the targets' unit.

    Attributes:
        name: of the values: "points", or an attribute's name.
        outcome: "reached"; "rounding" (as near as doubles come at these coordinates); "least-squares"; "not-reached".
        method: what solved the equations.
        iterations: applications of the limit matrix.
        residuals: the greatest distance from a target, each time it was measured.
        seconds: wall clock.
        diagonal: of the targets' bounding box.
        max_error: the greatest distance from a vertex's limit position to its target.
        rms_error: the root mean square of these.
        max_movement: how far the control point farthest from its target is.
        worst: up to ten (vertex, error), the worst first.
        singular_components: components without a surface for arbitrary targets.
    """

    name: str
    outcome: str
    method: str
    iterations: int
    residuals: tuple[float, ...]
    seconds: float
    diagonal: float
    max_error: float
    rms_error: float
    max_movement: float
    worst: tuple[tuple[int, float], ...]
    singular_components: int

    @property
    def converged(self) -> bool:
        """Whether the targets are met: within the tolerance, to rounding, or as near as a singular part can be."""
        return self.outcome != "not-reached"


@dataclass(frozen=True, repr=False)
class FairReport(Report):
    """What a fair surface reaches: energies of its shape, distances in the targets' unit, angles in radians."""

    method: str
    iterations: int
    converged: bool
    levels: int
    plain_energy: float
    energy: float
    diagonal: float
    max_error: float
    rms_error: float
    worst_vertex: int
    normal_count: int
    max_angle: float


@dataclass(frozen=True, repr=False)
class UpdateReport(Report):
    """What one change of targets did: control points moved, and the greatest errors left, in the targets' unit."""

    is_local: bool
    moved: int
    max_error: float
    error_bound: float
    max_miss: float
    worst_miss: int


@dataclass(frozen=True, repr=False)
class DenoiseReport(Report):
    """What was removed: lengths in the points' unit, along the normals and in all."""

    noise: float
    m: int
    passes: int
    removed: float
    moved: float
    most_moved: float
    most_moved_vertex: int
    volume_before: float
    volume_after: float


@dataclass(frozen=True, repr=False)
class SharpenReport(Report):
    """How much detail was added, and how far vertices moved, in the points' unit."""

    amount: float
    growth: float
    moved: float
    most_moved: float
    most_moved_vertex: int
    turned_faces: int


@dataclass(frozen=True, repr=False)
class DistanceSummary(Report):
    """Sizes of many distances, in the points' unit; shares are of the points."""

    max: float
    max_point: int
    rms: float
    mean: float
    median: float
    most_of_95: float
    most_of_99: float


@dataclass(frozen=True, repr=False)
class FitReport(Report):
    """How near a fitted surface comes to its points, both ways, and why the search ended.

    Attributes:
        end: "tolerance", "budget", "rounds" or "cancelled".
        to_surface: distances from the points that are no outliers to the surface.
        to_points: distances from places on the surface to the nearest point; not below the points' spacing.
        diameter: of the smallest sphere around the points.
    """

    end: str
    to_surface: DistanceSummary
    to_points: DistanceSummary
    diameter: float
    spacing: float
    outliers: int
    rounds: int
    seconds: float


@dataclass(frozen=True, repr=False)
class SegmentReport(Report):
    """What a surface in a volume holds, and how well it sits. Lengths are in millimetres; None where nothing was given.

    Attributes:
        vertices: of the control mesh, as ``faces``.
        genus: of all components together.
        dropped_parts: specks too small to follow.
        rounds: steps that moved the surface.
        cut_steps: steps taken back, because the surface would have met itself.
        self_intersections: pairs of triangles of the fine mesh that meet.
        edge_strength: the derivative of the smoothed image along the normal under the surface, its mean, per mm.
        best_edge_strength: the same, each place at its best within two voxels.
        mask_volume: of the label that was given or compared with.
        dice: of the voxels whose centres are inside.
        to_surface: distances from the middles of the mask's outer faces to the surface.
        to_border: distances from the surface to them.
        region_volume: of what was found around a seed.
        region_open: the share of its border that has no edge; from 0.06 on it may leak.
    """

    vertices: int
    faces: int
    scheme: str
    genus: int
    components: int
    dropped_parts: int
    rounds: int
    cut_steps: int
    volume: float
    area: float
    self_intersections: int
    edge_strength: float
    best_edge_strength: float
    mask_volume: Optional[float]
    dice: Optional[float]
    to_surface: Optional[DistanceSummary]
    to_border: Optional[DistanceSummary]
    region_volume: Optional[float]
    region_open: Optional[float]
    seconds: float

    @property
    def edge_share(self) -> float:
        """The edges under the surface, as a share of the best within two voxels."""
        return self.edge_strength / self.best_edge_strength if self.best_edge_strength > 0 else 0.0


@dataclass(frozen=True, repr=False)
class EquilibriumReport(Report):
    """How a search for equilibrium ended: the last round's change, and the greatest force that nothing balances."""

    rounds: int
    change: float
    residual_force: float
    converged: bool


@dataclass(frozen=True, repr=False)
class MotionMeasure(Report):
    """Energies of a body in motion, and the greatest force on a control point that nothing balances."""

    kinetic_energy: float
    elastic_energy: float
    force_energy: float
    residual_force: float


@dataclass(frozen=True, repr=False)
class RepairChange(Report):
    """One kind of change that a repair made."""

    kind: str
    count: int
    text: str


@dataclass(frozen=True, repr=False)
class Problem(Report):
    """One kind of reason why a mesh has no surface; messages name the first elements and say what to do."""

    code: str
    count: int
    messages: tuple[str, ...]
