"""Triangles as Mitsuba wants them."""

from dataclasses import replace

import numpy as np

# Two one-sided sheets stand for a triangle that emits from both sides. Their distance, as a share of the triangle's side:
SHEET_GAP = 1e-3


def two_sheets(mesh):
    """Flat triangles twice, once turned over, moved apart along their normals by a gap that shadows nothing."""
    order = np.concatenate([mesh.triangles, mesh.triangles[:, ::-1]]).ravel()
    corners = mesh.positions[mesh.triangles.ravel()].reshape(-1, 3, 3)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normals, axis=1, keepdims=True)
    apart = (0.5 * SHEET_GAP * normals / np.sqrt(np.maximum(area, 1e-30)))[:, None, :]
    points = np.concatenate([corners + apart, (corners - apart)[:, ::-1]]).reshape(-1, 3)
    return replace(mesh, positions=points, triangles=np.arange(len(points), dtype=np.uint32).reshape(-1, 3), normals=None,
                   uvs=[None if uv is None else uv[order] for uv in mesh.uvs],
                   colors=None if mesh.colors is None else mesh.colors[order], tangents=None)


def joined(rows):
    return None if rows[0] is None else np.concatenate(rows)


def join(meshes):
    """One mesh of several that have the same attributes."""
    firsts = np.cumsum([0] + [len(mesh.positions) for mesh in meshes])
    return replace(meshes[0], positions=joined([mesh.positions for mesh in meshes]),
                   triangles=np.concatenate([mesh.triangles.astype(np.int64) + first for mesh, first in zip(meshes, firsts)]),
                   normals=joined([mesh.normals for mesh in meshes]), colors=joined([mesh.colors for mesh in meshes]),
                   tangents=joined([mesh.tangents for mesh in meshes]),
                   uvs=[joined([mesh.uvs[i] for mesh in meshes]) for i in range(len(meshes[0].uvs))])
