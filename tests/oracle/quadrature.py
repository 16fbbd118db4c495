"""Integrals over hemispheres, and functions of mu = |cos| known by values."""

import numpy as np

from directions import at_cosine, per_channel


def gauss(n, a=0.0, b=1.0):
    """Nodes and weights of the Gauss-Legendre rule on [a, b]; a and b broadcast against each other, the nodes follow as the last axis."""
    x, w = np.polynomial.legendre.leggauss(n)
    middle, half = per_channel(np.add(a, b) / 2), per_channel(np.subtract(b, a) / 2)
    return middle + half * x, half * w


def hemisphere(n_z=64, n_phi=128):
    """Nodes (m, 3) and weights (m,) in solid angle: Gauss-Legendre in sqrt(z), the trapezoidal rule in azimuth."""
    x, w = gauss(n_z)
    phi = (np.arange(n_phi) + 0.5) * 2 * np.pi / n_phi
    nodes = at_cosine((x * x)[:, None], phi)
    weights = np.broadcast_to((2 * x * w * 2 * np.pi / n_phi)[:, None], nodes.shape[:-1])
    return nodes.reshape(-1, 3), weights.ravel()


def cosine_average(albedo, n=64):
    """2 int E(mu) mu dmu over [0, 1], for a function E of arrays of cosines; Gauss-Legendre in sqrt(mu)."""
    x, w = gauss(n)
    return np.sum(4 * x**3 * w * albedo(x * x))


class Interpolated:
    """A function of mu in (0, 1] as a Chebyshev polynomial in mu^(1/root), whose nodes are dense towards grazing directions.

    values maps mu (n,) to (n,) or (n, k); the result has the shape of mu, or one axis more. Below lowest the function is constant.
    """

    DEGREE = 128

    def __init__(self, values, root, lowest=0.0):
        self.root, self.lowest = root, lowest
        self.start = lowest ** (1 / root)
        nodes = np.polynomial.chebyshev.chebpts1(self.DEGREE + 1)
        mu = (self.start + (1 - self.start) * (nodes + 1) / 2) ** root
        self.coefficients = np.polynomial.chebyshev.chebfit(nodes, values(mu), self.DEGREE)

    def __call__(self, mu):
        x = (np.maximum(mu, self.lowest) ** (1 / self.root) - self.start) / (1 - self.start)
        values = np.polynomial.chebyshev.chebval(2 * x - 1, self.coefficients)
        return np.moveaxis(values, 0, -1) if self.coefficients.ndim > 1 else values
