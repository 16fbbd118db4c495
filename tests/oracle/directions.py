"""Unit directions in the shading frame (z is the normal).

An array of directions has the shape (..., 3); arguments broadcast against each other.
"""

import numpy as np


def dot(a, b):
    return np.sum(a * b, axis=-1)


def normalize(a):
    return a / np.sqrt(dot(a, a))[..., None]


def half_vector(v, l):
    return normalize(v + l)


def reflect(v, h):
    return 2 * dot(v, h)[..., None] * h - v


def mirror(l):
    """Mirrors directions about the surface."""
    return l * np.array([1, 1, -1])


def at_cosine(mu, phi=0.0):
    """Directions of the cosines mu to the normal, at the azimuths phi in radians."""
    mu, phi = np.broadcast_arrays(np.asarray(mu, float), phi)
    sine = np.sqrt((1 - mu) * (1 + mu))
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), mu], axis=-1)


def rotate_z(w, angle):
    """Rotates directions about the normal, counterclockwise, by an angle in radians."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * w[..., 0] - s * w[..., 1], s * w[..., 0] + c * w[..., 1], w[..., 2]], axis=-1)


def per_channel(x):
    """Appends the axis of the color channels."""
    return np.asarray(x, float)[..., None]


def sample_cosine_hemisphere(u):
    """Malley's method: u has the shape (n, 2); the density is cos/pi per solid angle."""
    return at_cosine(np.sqrt(1 - u[:, 0]), 2 * np.pi * u[:, 1])


def sample_uniform_hemisphere(u):
    """u has the shape (n, 2); the density is 1/(2 pi) per solid angle."""
    return at_cosine(u[:, 0], 2 * np.pi * u[:, 1])
