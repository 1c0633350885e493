"""What users of other packages are hurt by: vertices moved about, arrays misread, copies made behind their back."""

from __future__ import annotations

import copy
import gc
import pickle
import weakref

import numpy as np
import pytest

import batten
from conftest import grid

SQUARE = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]


def variants(points: np.ndarray) -> dict[str, np.ndarray]:
    """The same numbers in every layout that NumPy knows."""
    wide = np.full((2 * len(points), 5), np.nan)
    wide[::2, 1:4] = points
    frozen = points.copy()
    frozen.setflags(write=False)
    return {
        "float32": points.astype(np.float32),
        "sliced": wide[::2, 1:4],
        "reversed": points[::-1].copy()[::-1],
        "fortran": np.asfortranarray(points),
        "big-endian": points.astype(">f8"),
        "read-only": frozen,
        "list": points.tolist(),
    }


def test_every_layout_gives_the_same_surface(creature: batten.Mesh) -> None:
    points = np.round(creature.points * 64) / 64  # exact in float32
    expected = batten.interpolate(creature.with_points(points)).control
    solver = batten.Interpolator(creature)
    for name, variant in variants(points).items():
        assert np.array_equal(solver.solve(variant).control, expected), name
        assert np.array_equal(batten.Mesh(variant, creature.faces).points, points), name


def test_faces_may_be_given_in_every_way(creature: batten.Mesh) -> None:
    faces = np.asarray(creature.faces)
    for given in (
        faces.astype(np.int64),
        faces.astype(np.uint16),
        faces.astype(">i4"),
        np.asfortranarray(faces),
        faces[::-1][::-1],
        faces.tolist(),
        [tuple(face) for face in faces],
        (creature.face_offsets, creature.face_vertices),
    ):
        assert np.array_equal(batten.Mesh(creature.points, given).face_vertices, creature.face_vertices)
    mixed = batten.Mesh(SQUARE, [[0, 1, 2], [2, 3, 0]])
    assert np.array_equal(mixed.faces, [[0, 1, 2], [2, 3, 0]])
    mixed = batten.Mesh(SQUARE + [[2.0, 0.5, 0.0]], [[0, 1, 2, 3], [1, 4, 2]])
    assert [len(face) for face in mixed.faces] == [4, 3]


def test_doubles_cross_without_a_copy() -> None:
    points = np.array(SQUARE)
    mesh = batten.Mesh(points, [[0, 1, 2, 3]])
    assert np.shares_memory(mesh.points, points)
    points[0, 2] = 7.0
    assert batten.limit_positions(mesh)[0, 2] > 1.0  # read where it stands


def test_results_own_their_memory() -> None:
    surface = batten.LimitSurface(grid(4, 4))
    points = surface.points([0, 1], [[0.5, 0.5], [0.25, 0.75]])
    kept = points.copy()
    del surface
    gc.collect()
    assert np.array_equal(points, kept)
    mesh = grid(3, 3)
    gone = weakref.ref(mesh)
    solver = batten.Interpolator(mesh)
    del mesh
    gc.collect()
    assert gone() is not None  # its owner keeps it alive
    del solver
    gc.collect()
    assert gone() is None


def test_vertex_i_is_vertex_i(creature: batten.Mesh) -> None:
    cage = batten.interpolate(creature)
    assert np.array_equal(cage.mesh.face_vertices, creature.face_vertices)
    assert np.abs(batten.limit_positions(cage.mesh) - creature.points).max() <= 1e-10 * cage.report.diagonal
    finer = batten.subdivide(cage.mesh)
    assert np.abs(batten.limit_positions(finer)[: creature.vertex_count] - creature.points).max() < 1e-8


def test_objects_pickle_and_copy(creature: batten.Mesh) -> None:
    cage = batten.interpolate(creature)
    solver = batten.Interpolator(creature, tolerance=1e-8)
    surface = batten.LimitSurface(cage.mesh)
    search = batten.NearestPoints(cage.mesh)
    series = batten.MeshSeries(creature)
    for again in (pickle.loads(pickle.dumps(cage)), copy.deepcopy(cage)):
        assert np.array_equal(again.control, cage.control)
        assert again.report == cage.report
    for again in (pickle.loads(pickle.dumps(solver)), copy.deepcopy(solver)):
        assert np.array_equal(again.solve(creature.points).control, solver.solve(creature.points).control)
    again_surface = pickle.loads(pickle.dumps(surface))
    assert np.array_equal(again_surface.points([3], [[0.2, 0.7]]), surface.points([3], [[0.2, 0.7]]))
    query = creature.points[:5] + 0.1
    assert np.array_equal(pickle.loads(pickle.dumps(search)).query(query).points, search.query(query).points)
    assert np.array_equal(copy.deepcopy(series).smooth(creature.points), series.smooth(creature.points))
    tessellator = batten.Tessellator(creature, 2, normals=True)
    assert np.array_equal(pickle.loads(pickle.dumps(tessellator))(creature.points), tessellator(creature.points))
    updates = solver.updates(creature.points)
    updates.update(3, creature.points[3] + 0.1)
    assert np.abs(copy.deepcopy(updates).control - updates.control).max() < 1e-6
    energy = batten.SurfaceEnergy(creature, tension=2.0)
    assert abs(copy.deepcopy(energy).matrix() - energy.matrix()).max() == 0.0
    motion = batten.ElasticMotion(batten.ElasticSurface(creature), gravity=(0.0, 0.0, -1.0), held=[0])
    motion.step(3)
    later = copy.deepcopy(motion)
    assert later.time == motion.time and np.array_equal(later.positions, motion.positions)
    later.step()
    motion.step()
    assert np.array_equal(later.positions, motion.positions)
    with pytest.raises(TypeError, match="refined motion"):
        pickle.dumps(motion.refined())


def test_errors_say_what_and_carry_a_code() -> None:
    with pytest.raises(batten.Error) as caught:
        batten.interpolate(batten.Mesh(SQUARE, [[0, 1, 2, 7]]))
    assert caught.value.code == "index-out-of-range" and "7" in str(caught.value)
    assert isinstance(caught.value, ValueError)
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.code == caught.value.code and str(again) == str(caught.value)
    for points, code in (([[0.0, 1.0]], "bad-shape"), (np.zeros((2, 3, 3)), "bad-shape")):
        with pytest.raises(batten.Error) as caught:
            batten.Mesh(points, [[0, 1, 2]])
        assert caught.value.code == code
    with pytest.raises(batten.Error, match="not float"):
        batten.Mesh(SQUARE, [[0.0, 1.0, 2.0]])
    with pytest.raises(batten.Error, match="32-bit"):
        batten.Mesh(SQUARE, [[0, 1, 2**40]])
    with pytest.raises(batten.Error) as caught:
        batten.limit_positions(batten.Mesh(np.full((4, 3), np.nan), [[0, 1, 2, 3]]))
    assert caught.value.code == "not-finite"
    with pytest.raises(batten.Error, match="catmull-clark, loop"):
        batten.limit_positions(batten.Mesh(SQUARE, [[0, 1, 2, 3]]), scheme="catmul")
    with pytest.raises(batten.Error, match="no mesh"):
        batten.interpolate(42)


def test_meshes_of_other_packages_are_taken_as_they_are(creature: batten.Mesh) -> None:
    class Trimesh:
        vertices = creature.points
        faces = np.asarray(creature.faces)

    class PyVista:
        points = creature.points
        faces = np.insert(np.asarray(creature.faces), 0, 4, axis=1).reshape(-1)

    class Block:
        type = "quad"
        data = np.asarray(creature.faces)

    class Meshio:
        points = creature.points
        cells = [Block()]

    expected = batten.limit_positions(creature)
    for other in (Trimesh(), PyVista(), Meshio()):
        assert np.array_equal(batten.limit_positions(other), expected)
