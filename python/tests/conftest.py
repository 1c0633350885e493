"""Meshes that the tests share."""

from __future__ import annotations

import pathlib

import numpy as np
import pytest

import batten

MODELS = pathlib.Path(__file__).resolve().parents[2] / "models"


@pytest.fixture(scope="session")
def models() -> pathlib.Path:
    return MODELS


@pytest.fixture
def creature() -> batten.Mesh:
    return batten.read(MODELS / "creature.obj")


def grid(columns: int, rows: int, height: float = 0.1) -> batten.Mesh:
    """A wavy sheet of quads."""
    u, v = np.meshgrid(np.arange(columns + 1), np.arange(rows + 1))
    points = np.stack([u, v, height * np.sin(0.7 * u) * np.cos(0.5 * v)], axis=-1).reshape(-1, 3).astype(float)
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).reshape(-1)
    return batten.Mesh(points, np.stack([first, first + 1, first + columns + 2, first + columns + 1], axis=-1))
