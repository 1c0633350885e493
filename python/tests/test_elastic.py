"""Elastic surfaces and pictures."""

from __future__ import annotations

import pathlib

import numpy as np
import pytest

import batten
from conftest import grid


def test_energies_are_quadratic_forms() -> None:
    mesh = grid(6, 5, 0.5)
    energy = batten.SurfaceEnergy(mesh)
    for kind in ("mass", "membrane", "thin-plate"):
        matrix = energy.matrix(kind)
        assert abs(matrix - matrix.T).max() < 1e-15
        expected = 0.5 * np.sum(mesh.points * (matrix @ mesh.points))
        assert energy.energy(kind, mesh.points) == pytest.approx(expected, rel=1e-12)
    assert energy.matrix("mass").sum() == pytest.approx(30.0)  # unit squares
    assert abs(energy.matrix("stiffness") @ np.ones(mesh.vertex_count)).max() < 1e-12


def test_forces_are_the_gradient_of_the_energy() -> None:
    mesh = grid(4, 4, 0.3)
    body = batten.ElasticSurface(mesh)
    at = mesh.points + 0.1 * np.sin(3 * mesh.points[:, ::-1])
    force = body.force(at)
    step = np.zeros_like(at)
    step[7, 1] = 1e-6
    slope = (body.energy(at + step) - body.energy(at - step)) / 2e-6
    assert -slope == pytest.approx(force[7, 1], rel=1e-5)


def test_a_sheet_hangs_from_its_pins_and_stays_the_same_when_refined() -> None:
    mesh = grid(6, 6, 0.0)
    body = batten.ElasticSurface(mesh, density=1.0, damping=4.0)
    corners = [batten.Place(0, (0.0, 0.0), (0.0, 0.0, 0.0)), batten.Place(5, (1.0, 0.0), (6.0, 0.0, 0.0))]
    motion = batten.ElasticMotion(body, pins=corners, gravity=(0.0, 0.0, -1.0), step=0.05)
    motion.step(20)
    assert motion.time == pytest.approx(1.0)
    assert motion.positions[:, 2].min() < -0.1
    surface = batten.LimitSurface(motion.mesh)
    assert np.abs(surface.points([0, 5], [[0.0, 0.0], [1.0, 0.0]]) - [[0, 0, 0], [6, 0, 0]]).max() < 1e-9
    again = batten.ElasticMotion(body, pins=corners, gravity=(0.0, 0.0, -1.0), step=0.05)
    again.step(10)
    taken_up = batten.ElasticMotion(body, pins=corners, gravity=(0.0, 0.0, -1.0), step=0.05)
    taken_up.set_state(again.time, again.positions, again.velocities)
    taken_up.step(10)
    assert np.array_equal(taken_up.positions, motion.positions)  # bit for bit
    finer = motion.refined()
    assert np.abs(batten.LimitSurface(finer.mesh).points([0], [[0.0, 0.0]])).max() < 1e-9
    report = motion.find_equilibrium()
    assert report.converged and motion.measure().residual_force < 1e-6
    with pytest.raises(batten.Error) as caught:
        batten.ElasticMotion(body, held=[99])
    assert caught.value.code == "index-out-of-range"


def test_pictures(tmp_path: pathlib.Path, creature: batten.Mesh) -> None:
    surface = batten.tessellate(creature, 2)
    plain = batten.render(surface, width=160, height=120)
    assert plain.shape == (120, 160, 3) and plain.dtype == np.uint8
    assert np.ptp(plain.astype(int)) > 100  # something is there
    values = batten.render(surface, values=surface.points[:, 2], lines=creature, width=160, height=120)
    assert not np.array_equal(values, plain)
    clear = batten.render(surface, width=160, height=120, transparent=True)
    assert clear.shape == (120, 160, 4) and clear[0, 0, 3] == 0 and clear[60, 80, 3] == 255
    batten.write_png(tmp_path / "a.png", clear)
    assert (tmp_path / "a.png").read_bytes()[:4] == b"\x89PNG"
    with pytest.raises(batten.Error, match="front"):
        batten.render(surface, view="behind")
