"""The library through its Python names, against NumPy and against itself."""

from __future__ import annotations

import pathlib
import pickle
import subprocess

import numpy as np
import pytest

import batten
from conftest import grid


def test_files_come_back_bit_for_bit(tmp_path: pathlib.Path, creature: batten.Mesh) -> None:
    mesh = batten.Mesh(
        creature.points + np.pi,
        creature.faces,
        creases=[(0, int(np.asarray(creature.faces)[0][1]), 2.5)],
        attributes={"color": np.random.default_rng(1).random((creature.vertex_count, 3))},
        scheme="catmull-clark",
    )
    lost = batten.write(tmp_path / "a.obj", mesh)
    assert lost == []
    again = batten.read(tmp_path / "a.obj")
    assert np.array_equal(again.points, mesh.points)
    assert np.array_equal(again.face_vertices, mesh.face_vertices)
    assert batten.write(tmp_path / "a.stl", batten.triangulate(mesh)) != []  # creases and colours
    with pytest.raises(batten.Error) as caught:
        batten.read(tmp_path / "none.obj")
    assert caught.value.code == "file-not-readable"


def test_check_and_repair() -> None:
    fan = batten.Mesh(np.eye(5, 3) + np.arange(5)[:, None], [[0, 1, 2], [1, 0, 3], [0, 1, 4]])
    problems = batten.check(fan)
    assert [problem.code for problem in problems][0] == "non-manifold-edge"
    fixed = batten.repair(fan)
    assert batten.check(fixed.mesh) == []
    assert fixed.changes and fixed.changes[0].kind == "split-edges"
    assert np.array_equal(fixed.mesh.points, fan.points[fixed.vertex_sources])


def test_places_are_the_weights_times_the_control_points() -> None:
    mesh = grid(5, 4, 0.8)
    surface = batten.LimitSurface(mesh)
    rng = np.random.default_rng(3)
    face = rng.integers(0, surface.face_count, 50)
    uv = rng.random((50, 2))
    jets = surface.jets(face, uv)
    for i, part in enumerate(("point", "du", "dv", "duu", "duv", "dvv")):
        weights = batten.surface_weights(mesh, face, uv, part=part)
        assert np.abs(weights @ mesh.points - jets[:, i]).max() < 1e-12
    step = 1e-5
    ahead = surface.points(face, np.minimum(uv + [step, 0.0], 1.0))
    behind = surface.points(face, np.maximum(uv - [step, 0.0], 0.0))
    inside = (uv[:, 0] > step) & (uv[:, 0] < 1 - step)
    assert np.abs((ahead - behind) / (2 * step) - jets[:, 1])[inside].max() < 1e-8
    curvature = surface.curvature(face, uv)
    assert np.abs((curvature.greatest + curvature.least) / 2 - curvature.mean).max() < 1e-12
    assert np.abs(np.einsum("ij,ij->i", curvature.normal, jets[:, 1])).max() < 1e-12


def test_nearest_places_are_none_farther_than_samples(creature: batten.Mesh) -> None:
    search = batten.NearestPoints(creature)
    samples = batten.tessellate(creature, 3).points
    queries = creature.points[::40] * 1.05
    found = search.query(queries)
    sampled = np.linalg.norm(samples[None] - queries[:, None], axis=-1).min(axis=1)
    assert (found.distances <= sampled + search.tolerance).all()
    assert (found.distances > sampled - 0.2).all()
    again = batten.LimitSurface(creature).points(found.faces, found.uv)
    assert np.abs(again - found.points).max() < 1e-12
    assert batten.distance(creature, samples[:500]).summary.max < 1e-9


def test_interpolation_in_all_its_forms(creature: batten.Mesh) -> None:
    fair = batten.interpolate(creature, fair=True, normals="estimate")
    assert fair.is_refined and fair.report.max_angle < 1e-8 and fair.report.converged
    assert np.abs(batten.limit_positions(fair.mesh)[: creature.vertex_count] - creature.points).max() < 1e-9
    solver = batten.Interpolator(creature)
    updates = solver.updates(creature.points)
    moved = creature.points.copy()
    moved[17] += [0.1, 0.0, 0.2]
    report = updates.update(17, moved[17])
    assert report.is_local
    solved_again = solver.solve(moved)
    assert np.abs(updates.control - solved_again.control).max() < 1e-9 * solved_again.report.diagonal
    radii = np.linalg.norm(creature.points, axis=1)
    assert np.abs(batten.limit_positions(creature, solver.solve_values(radii))[:, 0] - radii).max() < 1e-8
    cube = batten.Mesh(
        [[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)],
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]],
    )
    cube.points[0] -= 0.2
    solved = batten.interpolate(cube)  # singular: two-colourable, all of valence 3
    assert solved.is_refined and solved.report.singular_components == 1
    with pytest.raises(batten.Error) as caught:
        batten.interpolate(cube, on_singular="refuse")
    assert caught.value.code == "singular-system"


def test_tessellators_reuse_their_memory(creature: batten.Mesh) -> None:
    tessellator = batten.Tessellator(creature, 2, normals=True)
    first = tessellator(creature.points)
    again = tessellator(creature.points * 2)
    assert first is again and again.dtype == np.float32 and tessellator.faces.shape[1] == 4
    exact = batten.Tessellator(creature, 2, dtype=np.float64)(creature.points * 2)
    assert np.abs(exact - again).max() < 1e-5
    assert np.abs(np.linalg.norm(tessellator.normals, axis=1) - 1).max() < 1e-6
    mesh = batten.tessellate(creature, chord=0.01)
    assert mesh.faces.shape[1] == 3 and batten.distance(creature, mesh.points).summary.max < 1e-9
    with pytest.raises(batten.Error, match="either levels, or bounds"):
        batten.tessellate(creature)


def test_a_refinement_is_that_of_subdivide(creature: batten.Mesh) -> None:
    step = batten.Refinement(creature)
    expected = batten.subdivide(creature)
    assert step.vertex_count == expected.vertex_count
    assert np.array_equal(step.mesh.points, expected.points)
    assert np.array_equal(step.mesh.face_vertices, expected.face_vertices) and step.mesh.scheme == expected.scheme
    assert np.array_equal(step(creature.points[:, 0]), expected.points[:, 0])
    twice = np.asfortranarray(2 * creature.points, dtype=np.float32)
    assert np.allclose(step(twice), 2 * expected.points, rtol=1e-6)
    again = pickle.loads(pickle.dumps(step))
    assert np.array_equal(again(creature.points), step(creature.points))
    with pytest.raises(batten.Error) as caught:
        step(creature.points[:-1])
    assert caught.value.code == "bad-shape"


def test_series_and_bands(creature: batten.Mesh) -> None:
    mesh = batten.subdivide(creature, 2)
    noisy = mesh.with_points(mesh.points + 0.01 * np.random.default_rng(5).standard_normal(mesh.points.shape))
    clean = batten.denoise(noisy)
    assert np.linalg.norm(clean.mesh.points - mesh.points) < 0.6 * np.linalg.norm(noisy.points - mesh.points)
    assert batten.sharpen(mesh).report.moved > 0.0
    assert np.abs(batten.bands(mesh, [1, 1, 1, 1]).mesh.points - mesh.points).max() < 1e-12
    assert len(batten.bands(mesh, [2, 1, 1]).energies) == 3
    ends = batten.morph(mesh, noisy, [0.0, 0.5, 1.0])
    assert np.abs(ends[0].points - mesh.points).max() < 1e-12
    assert np.abs(ends[2].points - noisy.points).max() < 1e-12


def test_fit_finds_a_sphere() -> None:
    golden = np.pi * (3 - np.sqrt(5)) * np.arange(1500)
    z = 1 - (2 * np.arange(1500) + 1) / 1500
    points = np.stack([np.sqrt(1 - z * z) * np.cos(golden), np.sqrt(1 - z * z) * np.sin(golden), z], axis=1)
    fit = batten.fit(points, vertices=100, init="sphere")
    assert fit.mesh.vertex_count <= 100 and fit.report.to_surface.max < 0.01
    assert fit.distances.shape == (1500,)


def test_fit_takes_its_method_and_creases() -> None:
    box = batten.Mesh(*_box(12))
    sharp = batten.fit(box.points, vertices=60, rounds=10)
    smooth = batten.fit(box.points, vertices=60, creases="none", rounds=10)
    assert len(sharp.mesh.creases) > 0 and len(smooth.mesh.creases) == 0
    assert sharp.report.to_surface.rms < smooth.report.to_surface.rms
    springs = batten.fit(box.points, vertices=98, method="dynamic", init="sphere")
    assert springs.mesh.vertex_count == 98
    for options in ({"method": "luck"}, {"creases": "some"}):
        with pytest.raises(batten.Error, match="is one of"):
            batten.fit(box.points, **options)  # type: ignore[arg-type]


def _box(n: int) -> tuple[np.ndarray, list[list[int]]]:
    """Points on the faces of a cube, and no faces that matter."""
    side = np.linspace(-1, 1, n)
    u, v = (part.ravel() for part in np.meshgrid(side, side))
    one = np.ones_like(u)
    faces = [np.roll(np.stack([u, v, sign * one], axis=1), turn, axis=1) for sign in (-1, 1) for turn in range(3)]
    return np.unique(np.concatenate(faces), axis=0), [[0, 1, 2]]


def test_reports_are_records_and_tables(creature: batten.Mesh) -> None:
    report = batten.interpolate(creature).report
    assert "max error" in repr(report) and report._repr_html_().startswith("<table>")
    with pytest.raises(AttributeError):
        report.max_error = 0.0  # type: ignore[misc]


def test_the_tool_gives_the_same(tmp_path: pathlib.Path, models: pathlib.Path) -> None:
    tool = models.parent / "build" / "release" / "bin" / "batten"
    if not tool.exists():
        pytest.skip("the tool is not built: ./batten info models/cube.obj builds it")
    subprocess.run([tool, "interpolate", models / "tripod.obj", "-o", tmp_path / "tool.obj"], check=True)
    batten.write(tmp_path / "python.obj", batten.interpolate(batten.read(models / "tripod.obj")).mesh)
    assert np.array_equal(batten.read(tmp_path / "tool.obj").points, batten.read(tmp_path / "python.obj").points)
