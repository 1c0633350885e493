"""One step of Loop subdivision as packages of Python make it: array operations of NumPy alone, no mesh structure."""

import numpy as np


def loop_step(points: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points and faces after one step. Triangles, boundaries smooth, no creases; corners as any boundary vertex."""
    corners = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, of_corner, count = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    inner = count == 2
    opposite = faces[:, [2, 0, 1]].reshape(-1)
    across = np.zeros((len(edges), 3))
    np.add.at(across, of_corner, points[opposite])
    ends = points[edges].sum(axis=1)
    odd = np.where(inner[:, None], 3 / 8 * ends + 1 / 8 * across, 1 / 2 * ends)

    def neighbours(kept: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        sums, valence = np.zeros_like(points), np.zeros(len(points))
        for here, there in ((0, 1), (1, 0)):
            np.add.at(sums, edges[kept, here], points[edges[kept, there]])
            np.add.at(valence, edges[kept, here], 1)
        return sums, valence

    around, valence = neighbours(np.ones(len(edges), dtype=bool))
    along, _ = neighbours(~inner)
    beta = (5 / 8 - (3 / 8 + np.cos(2 * np.pi / np.maximum(valence, 1)) / 4) ** 2) / np.maximum(valence, 1)
    even = (1 - valence * beta)[:, None] * points + beta[:, None] * around
    boundary = np.unique(edges[~inner])
    even[boundary] = 3 / 4 * points[boundary] + 1 / 8 * along[boundary]

    middle = len(points) + of_corner.reshape(-1, 3)
    children = [[faces[:, 0], middle[:, 0], middle[:, 2]], [middle[:, 0], faces[:, 1], middle[:, 1]],
                [middle[:, 2], middle[:, 1], faces[:, 2]], [middle[:, 0], middle[:, 1], middle[:, 2]]]
    return np.vstack([even, odd]), np.stack([np.stack(child, axis=1) for child in children], axis=1).reshape(-1, 3)
