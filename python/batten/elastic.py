"""Elastic surfaces: a subdivision surface as a body under forces, in time; and the energies it is made of."""

from __future__ import annotations

import collections.abc as abc
from dataclasses import dataclass
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _native
from .errors import Error
from .mesh import Array, Mesh, as_mesh, points_array
from .progress import Progress, callback
from .rebuilt import Rebuilt
from .reports import EquilibriumReport, MotionMeasure
from .surface import sparse_rows

__all__ = ["ElasticMotion", "ElasticSurface", "Place", "SurfaceEnergy"]

Coefficient = Union[float, abc.Sequence[float]]
Vector = abc.Sequence[float]


def _numbers(coefficient: Coefficient) -> list[float]:
    return [float(number) for number in np.atleast_1d(coefficient)]


@dataclass(frozen=True)
class Place:
    """A place of a surface and a point in space: of a spring, or a pin.

    Attributes:
        face, uv: as LimitSurface has them.
        target: (3,), where the spring pulls to or the place is held.
    """

    face: int
    uv: tuple[float, float]
    target: Vector


class SurfaceEnergy(Rebuilt):
    """Energies of a limit surface as quadratic forms of its control points, 1/2 sum p^T K p over the columns.

    Args:
        density, tension, rigidity: coefficients of "mass", "membrane" and "thin-plate"; one, or one a face.
    """

    def __init__(
        self,
        mesh: Any,
        *,
        density: Coefficient = 1.0,
        tension: Coefficient = 1.0,
        rigidity: Coefficient = 1.0,
        scheme: str = "auto",
        boundary: str | None = None,
        progress: Progress = None,
    ) -> None:
        topology, rules = as_mesh(mesh)._surface(scheme, boundary)
        self._native = _native.SurfaceEnergy(
            topology, rules, _numbers(density), _numbers(tension), _numbers(rigidity), callback(progress)
        )

    def matrix(self, kind: str = "stiffness", *, progress: Progress = None) -> Any:
        """K, (n, n): of "mass", "membrane", "thin-plate", or "stiffness", the sum of the last two."""
        return sparse_rows(*self._native.matrix(kind, callback(progress)))

    def energy(self, kind: str, control: npt.ArrayLike) -> float:
        """The energy of control points or other values, (n, k)."""
        return self._native.energy(kind, np.ascontiguousarray(control, dtype=np.float64))


class ElasticSurface(Rebuilt):
    """A body: mass, damping, stretching and bending of the limit surface of ``mesh``, at rest in its shape.

    Args:
        density: kg/m^2. damping: kg/(m^2 s). tension: N/m, against stretching. rigidity: N m, against bending. One, or
            one a face; any consistent units do.
        rest: "rotating": each face's rest shape turns freely; "linear": for small motion; "point": a free body shrinks
            to a point, as in the paper.
    """

    def __init__(
        self,
        mesh: Any,
        *,
        density: Coefficient = 1.0,
        damping: Coefficient = 1.0,
        tension: Coefficient = 100.0,
        rigidity: Coefficient = 1.0,
        rest: str = "rotating",
        scheme: str = "auto",
        boundary: str | None = None,
        progress: Progress = None,
    ) -> None:
        self._mesh = as_mesh(mesh)
        topology, rules = self._mesh._surface(scheme, boundary)
        self._native = _native.ElasticSurface(
            topology,
            rules,
            self._mesh.points,
            _numbers(density),
            _numbers(damping),
            _numbers(tension),
            _numbers(rigidity),
            rest,
            callback(progress),
        )

    @property
    def mesh(self) -> Mesh:
        """The rest shape."""
        return self._mesh

    def mass(self) -> Any:
        """M, (n, n): its entries sum to the mass."""
        return sparse_rows(*self._native.mass())

    def stiffness(self) -> Any:
        """K, (n, n)."""
        return sparse_rows(*self._native.stiffness())

    def energy(self, positions: npt.ArrayLike) -> float:
        """The elastic energy at control points, (n, 3)."""
        return self._native.energy(points_array(positions, "positions"))

    def force(self, positions: npt.ArrayLike) -> Array:
        """The elastic force on the control points, (n, 3): the energy's gradient, but for its sign."""
        return self._native.force(points_array(positions, "positions"))


def _arrays(places: abc.Sequence[Place]) -> tuple[Any, Any, Any]:
    return (
        np.array([place.face for place in places], dtype=np.int32),
        np.array([place.uv for place in places], dtype=np.float64).reshape(-1, 2),
        np.array([place.target for place in places], dtype=np.float64).reshape(-1, 3),
    )


class ElasticMotion(Rebuilt):
    """A body in time, starting at rest. Any step is stable, however stiff the springs.

    Args:
        step: seconds.
        springs: pull places to points with ``stiffness``, N/m each.
        pins: hold places exactly. held: vertices whose control points stay.
        gravity: (3,), m/s^2. pressure: N/m^2, outwards. volume: wanted of a closed surface, held by ``bulk_modulus``,
            N/m^2. wind: (3,), m/s.
        plane: (point, normal) of a floor. ball: (centre, radius) of an obstacle. Both push with ``contact``, N/m^3, and
            rub with ``friction``.
        scheme: "backward-euler", "second-order", "mass-free", "paper" or "paper-mass-free".
    """

    def __init__(
        self,
        body: ElasticSurface,
        *,
        step: float = 1.0 / 60.0,
        springs: abc.Sequence[Place] = (),
        stiffness: float = 1.0,
        pins: abc.Sequence[Place] = (),
        held: npt.ArrayLike | None = None,
        gravity: Vector | None = None,
        pressure: float = 0.0,
        volume: float | None = None,
        bulk_modulus: float = 1.0,
        wind: Vector | None = None,
        plane: tuple[Vector, Vector] | None = None,
        ball: tuple[Vector, float] | None = None,
        contact: float = 1e4,
        friction: float = 0.0,
        scheme: str = "backward-euler",
    ) -> None:
        loads = _native.Loads(body._native)
        if springs:
            loads.add_springs(*_arrays(springs), float(stiffness))
        if gravity is not None:
            loads.add_gravity(gravity)
        if pressure != 0.0:
            loads.add_pressure(float(pressure))
        if volume is not None:
            loads.add_volume(float(volume), float(bulk_modulus))
        if wind is not None:
            loads.add_wind(wind, 1.0, 0.1)
        if plane is not None:
            loads.add_plane(plane[0], plane[1], contact, friction)
        if ball is not None:
            loads.add_sphere(ball[0], ball[1], contact, friction)
        if pins:
            loads.pin(*_arrays(pins))
        if held is not None:
            loads.hold(np.atleast_1d(np.asarray(held, dtype=np.int32)))
        self._native = _native.Motion(loads, float(step), scheme)

    def __reduce__(self) -> tuple[Any, ...]:
        if self._made_of is None:
            raise TypeError("a refined motion depends on its past; pickle the one that it comes from")
        return (*super().__reduce__(), (self.time, self.positions, self.velocities))

    def __setstate__(self, state: tuple[float, Array, Array]) -> None:
        self.set_state(*state)

    def step(self, count: int = 1, *, progress: Progress = None) -> None:
        """Goes on by so many steps."""
        if count < 0:
            raise Error(f"a motion goes on by 0 steps or more, not {count}")
        self._native.step(count, callback(progress))

    def find_equilibrium(self, *, progress: Progress = None) -> EquilibriumReport:
        """Moves the body to where it comes to rest."""
        return EquilibriumReport(**self._native.find_equilibrium(callback(progress)))

    def refined(self, *, progress: Progress = None) -> "ElasticMotion":
        """The same motion on the control mesh refined once: the surface, its springs and supports stay."""
        result: ElasticMotion = ElasticMotion.__new__(ElasticMotion)
        result._made_of = None
        result._native = self._native.refined(callback(progress))
        return result

    def measure(self) -> MotionMeasure:
        """Energies and the greatest unbalanced force, as the body stands."""
        return MotionMeasure(**self._native.measure())

    @property
    def time(self) -> float:
        """Seconds."""
        return self._native.time()

    @property
    def positions(self) -> Array:
        """A copy of the control points, (n, 3)."""
        return self._native.positions()

    @property
    def velocities(self) -> Array:
        """A copy of their velocities, (n, 3)."""
        return self._native.velocities()

    def set_state(self, time: float, positions: npt.ArrayLike, velocities: npt.ArrayLike) -> None:
        """Puts the body where it was at another time."""
        self._native.set(float(time), points_array(positions, "positions"), points_array(velocities, "velocities"))

    @property
    def mesh(self) -> Mesh:
        """The control mesh as it stands."""
        return Mesh._of(self._native.mesh())
