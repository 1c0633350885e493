"""Surfaces of volumes."""

from __future__ import annotations

import copy
import importlib
import pathlib
import pickle
import sys
from typing import Any

import numpy as np
import pytest

import batten

RADIUS = 12.0
CENTRE = np.array([-10.0, -20.0, 30.0])
SPACING = (2.0, 2.0, 3.0)
ORIGIN = CENTRE - [19.0, 19.0, 21.0]
AFFINE = np.array([[2.0, 0, 0, ORIGIN[0]], [0, 2.0, 0, ORIGIN[1]], [0, 0, 3.0, ORIGIN[2]], [0, 0, 0, 1.0]])
VOLUME = 4.0 / 3.0 * np.pi * RADIUS**3


def distances() -> np.ndarray:
    """From the voxels' centres to the ball's, mm."""
    i, j, k = np.meshgrid(np.arange(20), np.arange(20), np.arange(15), indexing="ij")
    places = np.stack([2.0 * i, 2.0 * j, 3.0 * k], axis=-1) + ORIGIN
    return np.asarray(np.linalg.norm(places - CENTRE, axis=-1))


def ball() -> np.ndarray:
    return np.where(distances() < RADIUS, 7, 0).astype(np.uint8)


def middle(mesh: batten.Mesh) -> np.ndarray:
    return np.asarray(0.5 * (mesh.points.min(axis=0) + mesh.points.max(axis=0)))


def files() -> None:
    try:
        importlib.import_module("batten._volumes")
    except ImportError:
        pytest.skip("built without volumes (BATTEN_WITH_VOLUMES)")


def test_a_ball_is_found_where_it_is() -> None:
    found = batten.segment(ball(), affine=AFFINE, label=7, vertices=100)
    report = found.report
    assert np.linalg.norm(middle(found.mesh) - CENTRE) < 1.0
    assert abs(report.volume / VOLUME - 1) < 0.03 and report.genus == 0 and report.self_intersections == 0
    assert report.dice is not None and report.dice > 0.97
    assert abs(report.volume - (report.mask_volume or 0)) < 0.02 * VOLUME
    inside = found.inside()
    assert inside.dtype == bool and inside.shape == (20, 20, 15)
    assert 2 * (inside & (ball() == 7)).sum() / (inside.sum() + (ball() == 7).sum()) == pytest.approx(report.dice)
    parts = found.parts()
    assert parts.min() > -1e-6 and parts.max() <= 1 + 1e-6
    assert parts.sum(dtype=np.float64) * 12.0 == pytest.approx(report.volume, rel=1e-5)
    assert abs(parts[distances() < RADIUS - 4] - 1).max() < 1e-6 and abs(parts[distances() > RADIUS + 4]).max() < 1e-6
    limit = np.linalg.norm(batten.limit_positions(found.mesh) - CENTRE, axis=1)
    assert abs(limit - RADIUS).max() < 1.5  # half of a voxel along its longest side


def test_every_layout_gives_the_same_surface() -> None:
    labels = ball()
    expected = batten.segment(labels, affine=AFFINE, vertices=100).mesh
    wide = np.zeros((20, 40, 15), dtype=np.int16)
    wide[:, ::2] = labels
    frozen = np.asfortranarray(labels, dtype=np.float32)
    frozen.setflags(write=False)
    for name, given in {
        "double": labels.astype(float),
        "fortran, read-only": frozen,
        "big-endian": labels.astype(">i4"),
        "sliced": wide[:, ::2],
        "reversed": labels[::-1].copy()[::-1],
        "bool": labels > 0,
        "list": labels.tolist(),
    }.items():
        found = batten.segment(given, affine=AFFINE, vertices=100)
        assert np.array_equal(found.mesh.points, expected.points), name
    spaced = batten.segment(labels, spacing=SPACING, vertices=100).mesh
    assert np.allclose(spaced.points + ORIGIN, expected.points, atol=1e-6)


def test_the_world_may_be_lps() -> None:
    turned = np.diag([-1.0, -1.0, 1.0, 1.0]) @ AFFINE
    ras = batten.segment(ball(), affine=AFFINE, seed=CENTRE, vertices=100)
    lps = batten.segment(ball(), affine=turned, seed=CENTRE * [-1, -1, 1], vertices=100, space="lps")
    assert np.array_equal(lps.mesh.points * [-1, -1, 1], ras.mesh.points)
    assert np.array_equal(lps.parts(), ras.parts()) and np.array_equal(lps.affine, ras.affine)
    assert ras.report.region_volume is not None and ras.report.dice is None


def test_points_seeds_and_meshes_start_a_surface() -> None:
    image = 100.0 / (1.0 + np.exp(distances() - RADIUS))
    rng = np.random.default_rng(3)
    rays = rng.standard_normal((60, 3))
    clicks = CENTRE + RADIUS * rays / np.linalg.norm(rays, axis=1, keepdims=True)
    mask = batten.Volume(ball(), affine=AFFINE)
    from_points = batten.segment(image, affine=AFFINE, mask=mask, points=clicks, vertices=100)
    from_seed = batten.segment(image, affine=AFFINE, mask=ball(), seed=CENTRE, numbers=(40, 200), vertices=100)
    again = batten.segment(image, affine=AFFINE, start=from_seed.mesh)
    for found in (from_points, from_seed, again):  # slices three times as thick as the edge is wide make it larger
        assert abs(found.report.volume / VOLUME - 1) < 0.1 and found.report.edge_share > 0.9
    for found in (from_points, from_seed):
        assert found.report.dice is not None and found.report.dice > 0.93
    assert np.array_equal(again.mesh.face_vertices, from_seed.mesh.face_vertices)


def test_slices_of_labels_are_points() -> None:
    image = 100.0 / (1.0 + np.exp(distances() - RADIUS))
    found = batten.segment(image, affine=AFFINE, mask=ball(), slices=2, vertices=100)
    assert found.report.dice is not None and found.report.dice > 0.93
    few = ball()
    few[:, :, [0, 1, 3, 4, 6, 7, 9, 10, 12, 13]] = 0
    painted = batten.segment(image, affine=AFFINE, mask=few, slices=1, vertices=100)
    assert painted.report.dice is None and abs(painted.report.volume / VOLUME - 1) < 0.15
    for wrong in ({"slices": 2}, {"slices": 2, "mask": ball(), "points": [[0, 0, 0]]}, {"slices": 0, "mask": ball()}):
        with pytest.raises(batten.Error, match="slice"):
            batten.segment(image, affine=AFFINE, **wrong)


def test_points_of_slicer_come_in_the_world_that_is_asked(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "border.fcsv"
    path.write_text("# CoordinateSystem = LPS\n# columns = id,x,y,z\na,1,2,3\nb,-4,5,6.5\n")
    assert np.array_equal(batten.read_marked_points(path), [[-1, -2, 3], [4, -5, 6.5]])
    assert np.array_equal(batten.read_marked_points(path, space="lps"), [[1, 2, 3], [-4, 5, 6.5]])
    path.write_text("a,1,2,3\n")
    with pytest.raises(batten.Error, match="border.fcsv"):
        batten.read_marked_points(path)


def test_surfaces_together_do_not_meet() -> None:
    halves = ball()
    halves[:10] = np.where(halves[:10] == 7, 3, 0)
    both = batten.segment_together(halves, [3, 7], affine=AFFINE, vertices=100)
    assert both.first_meetings > 0 and both.rounds > 0 and 0 < both.most_withdrawn < 4
    left, right = both.surfaces
    assert left.mesh.points[:, 0].mean() < CENTRE[0] < right.mesh.points[:, 0].mean()
    shares = left.parts() + right.parts()
    assert shares.max() < 1 + 1e-5  # no place is inside both
    assert left.report.dice is not None and left.report.dice > 0.9
    again = pickle.loads(pickle.dumps(both))
    assert np.array_equal(again.surfaces[1].mesh.points, right.mesh.points)
    for labels, said in (([3], "two labels"), ([3, 3], "twice"), ([3, 8], "no voxel has the label")):
        with pytest.raises(batten.Error, match=said):
            batten.segment_together(halves, labels, affine=AFFINE)


def test_files_and_arrays_are_the_same_volume(tmp_path: pathlib.Path) -> None:
    files()
    path = tmp_path / "ball.nii.gz"
    batten.write_volume(path, batten.Volume(ball().astype(np.float32), affine=AFFINE))
    volume = batten.read_volume(path)
    assert np.array_equal(volume.values, ball()) and np.allclose(volume.affine, AFFINE, atol=1e-5)
    assert volume.values.flags.f_contiguous and volume.spacing == pytest.approx(SPACING)
    from_file = batten.segment(path, vertices=100)
    assert np.array_equal(from_file.mesh.points, batten.segment(volume, vertices=100).mesh.points)
    inside = tmp_path / "inside.nrrd"
    batten.write_volume(inside, batten.Volume(from_file.inside(), affine=from_file.affine))
    assert np.array_equal(batten.read_volume(inside).values > 0, from_file.inside())

    class Image:  # as nibabel's are
        dataobj = ball()
        affine = AFFINE

    assert batten.segment(Image(), vertices=100).report.vertices == from_file.report.vertices
    with pytest.raises(batten.Error, match="nowhere") as caught:
        batten.segment(tmp_path / "nowhere.nii")
    assert caught.value.code == "file-not-readable"


def test_a_build_without_files_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "batten._volumes", None)
    with pytest.raises(batten.Error, match="BATTEN_WITH_VOLUMES") as caught:
        batten.read_volume("a.nii")
    assert caught.value.code == "not-available"
    assert batten.segment(ball(), vertices=100).report.genus == 0  # arrays do


def test_results_pickle_and_calls_stop() -> None:
    found = batten.segment(ball(), affine=AFFINE, vertices=100)
    for other in (pickle.loads(pickle.dumps(found)), copy.deepcopy(found)):
        assert np.array_equal(other.mesh.points, found.mesh.points) and other.report == found.report
        assert np.array_equal(other.inside(), found.inside())
    volume = pickle.loads(pickle.dumps(batten.Volume(ball(), spacing=2)))
    assert np.array_equal(volume.values, ball()) and "20 x 20 x 15 voxels of 2 x 2 x 2 mm" in repr(volume)
    assert "dice" in repr(found.report) and "<table>" in found.report._repr_html_()
    seen: list[float] = []
    batten.segment(ball(), affine=AFFINE, vertices=100, seed=CENTRE, progress=seen.append)
    assert seen == sorted(seen) and seen[-1] == 1.0
    with pytest.raises(batten.Error) as caught:
        batten.segment(ball(), vertices=100, progress=lambda done: False)
    assert caught.value.code == "cancelled"


@pytest.mark.parametrize(
    ("options", "said", "code"),
    [
        ({"label": 9}, "there are 7", "bad-argument"),
        ({"label": []}, "no label", "bad-argument"),
        ({"affine": np.eye(3)}, "4, 4", "bad-shape"),
        ({"affine": np.eye(4), "spacing": 2}, "one of both", "bad-argument"),
        ({"affine": np.diag([1.0, 1, 0, 1])}, "plane", "bad-argument"),
        ({"spacing": (1, 2)}, "one number or three", "bad-shape"),
        ({"space": "north"}, "ras, lps", "bad-argument"),
        ({"edges": True}, "mask", "bad-argument"),
        ({"seed": [1, 2]}, "3 numbers", "bad-shape"),
        ({"seed": [1000.0, 0, 0]}, "outside", "bad-argument"),
        ({"seed": [np.nan, 0, 0]}, "not finite", "not-finite"),
        ({"numbers": (1, 2)}, "seed", "bad-argument"),
        ({"seed": [9.0, 9, 9], "points": np.eye(3)}, "starts from points", "bad-argument"),
        ({"seed": [9.0, 9, 9], "label": 7}, "volume of labels", "bad-argument"),
        ({"mask": np.zeros((2, 2, 2))}, "Volume", "bad-shape"),
        ({"scheme": "butterfly"}, "Loop", "bad-argument"),
        ({"vertices": 1}, "", "bad-argument"),
        ({"start": batten.Mesh(np.eye(3), [[0, 1, 2]])}, "holes", "bad-argument"),
        ({"start": batten.Mesh(np.eye(3), [[0, 1, 2]]), "vertices": 9}, "leave them out", "bad-argument"),
    ],
)
def test_what_is_wrong_is_said(options: dict[str, Any], said: str, code: str) -> None:
    with pytest.raises(batten.Error, match=said) as caught:
        batten.segment(ball(), **options)
    assert caught.value.code == code


def test_arrays_that_are_no_volume_are_refused() -> None:
    with pytest.raises(batten.Error, match="three dimensions"):
        batten.segment(np.zeros((4, 4)))
    with pytest.raises(batten.Error, match="voxel"):
        batten.segment(np.full((4, 4, 4), np.nan))
    with pytest.raises(batten.Error, match="number the labels anew"):
        batten.Volume(np.full((2, 2, 2), 2**25))
    with pytest.raises(batten.Error, match="numbers"):
        batten.Volume(np.full((2, 2, 2), "a"))
    with pytest.raises(batten.Error, match="leave spacing"):
        batten.segment(batten.Volume(ball()), spacing=2)
