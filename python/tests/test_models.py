"""Medial models and textures."""

from __future__ import annotations

import pathlib

import numpy as np
import pytest

import batten


def test_the_surface_of_an_s_rep_passes_through_its_spoke_ends(models: pathlib.Path) -> None:
    made = batten.medial(models / "bean.srep.json")
    assert made.mesh.vertex_count == len(made.ends) == len(made.radii)
    assert made.distances.max() < 1e-10 and (made.radii > 0).all()
    assert np.abs(batten.limit_positions(made.mesh) - made.ends).max() < 1e-10
    turned = batten.medial(models / "bean.srep.json", normals=True)
    assert turned.angles.max() < 1e-6 < made.angles.max()
    with pytest.raises(batten.Error) as caught:
        batten.medial(models / "cube.obj")
    assert caught.value.code in {"unknown-format", "bad-file"}


def test_textures_colour_the_surface(creature: batten.Mesh) -> None:
    for preset in ("marble", "wood", "granite", "rust", "clouds"):
        drawn = batten.texture(creature, preset, levels=2)
        color = np.asarray(drawn.attributes["color"])
        assert color.shape == (drawn.vertex_count, 3) and color.min() >= 0 and color.max() <= 1 and np.ptp(color) > 0.1
        again = batten.texture(creature, preset, levels=2)
        assert np.array_equal(np.asarray(again.attributes["color"]), color)
    rough = batten.texture(creature, "rust", levels=2, displacement=0.05)
    assert 0 < np.linalg.norm(rough.points - drawn.points, axis=1).max() < 0.2
    with pytest.raises(batten.Error, match="marble, wood"):
        batten.texture(creature, "moss")
