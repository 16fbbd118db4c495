"""Triangles as Mitsuba wants them."""

import numpy as np

# Two one-sided sheets stand for a triangle that emits from both sides. Their distance, as a share of the triangle's side:
SHEET_GAP = 1e-3


def two_sheets(positions, triangles):
    """Flat triangles twice, once turned over, moved apart along their normals by a gap that shadows nothing."""
    corners = positions[triangles.ravel()].reshape(-1, 3, 3)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normals, axis=1, keepdims=True)
    apart = (0.5 * SHEET_GAP * normals / np.sqrt(np.maximum(area, 1e-30)))[:, None, :]
    points = np.concatenate([corners + apart, (corners - apart)[:, ::-1]]).reshape(-1, 3)
    return points, np.arange(len(points)).reshape(-1, 3)


def join(meshes):
    """One mesh of several."""
    firsts = np.cumsum([0] + [len(mesh.positions) for mesh in meshes])
    return (np.concatenate([mesh.positions for mesh in meshes]),
            np.concatenate([mesh.triangles.astype(np.int64) + first for mesh, first in zip(meshes, firsts)]))
