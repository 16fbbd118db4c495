"""Tangents of meshes that have none, as glTF asks for: those of MikkTSpace (Mikkelsen, "Simulation of Wrinkled Surfaces Revisited",
2008). Here corners are averaged where position, normal, coordinates and handedness are equal; that differs from MikkTSpace where
triangles touch in a vertex only."""

import numpy as np


def unit_rows(rows):
    length = np.linalg.norm(rows, axis=-1, keepdims=True)
    return np.divide(rows, length, out=np.zeros_like(rows), where=length > 0)


def across(rows, normals):
    """The rows' unit parts perpendicular to the normals."""
    return unit_rows(rows - normals * np.sum(rows * normals, axis=-1, keepdims=True))


def corner_tangents(positions, normals, uv):
    """xyz along rising u and the sign w, of each corner: arrays of triangle x 3 x columns; `normals` are of unit length.
    The bitangent cross(normal, xyz) w runs upwards in the texture, along falling v."""
    edges, steps = positions[:, 1:] - positions[:, :1], uv[:, 1:] - uv[:, :1]
    area = steps[:, 0, 0] * steps[:, 1, 1] - steps[:, 0, 1] * steps[:, 1, 0]
    along = (edges[:, 0] * steps[:, 1, 1:] - edges[:, 1] * steps[:, 0, 1:]) * np.sign(area)[:, None]
    sign = np.where(area > 0, -1.0, 1.0)  # v grows downwards
    tangents = across(along[:, None, :], normals)
    before, after = (across(np.roll(positions, shift, axis=1) - positions, normals) for shift in (1, -1))
    angles = np.arccos(np.clip(np.sum(before * after, axis=-1), -1, 1))
    keys = np.concatenate([positions, normals, uv, np.broadcast_to(sign[:, None, None], angles.shape + (1,))], axis=-1)
    groups = np.unique(keys.reshape(-1, keys.shape[-1]), axis=0, return_inverse=True)[1].ravel()
    sums = np.zeros((groups.max() + 1, 3))
    np.add.at(sums, groups, (tangents * angles[..., None]).reshape(-1, 3))
    mean = unit_rows(sums[groups]).reshape(tangents.shape)
    return np.concatenate([mean, np.broadcast_to(sign[:, None, None], angles.shape + (1,))], axis=-1)
