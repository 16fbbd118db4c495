"""The kernels' table of interfaces that reflect and refract (shaders/shared/scene_types.h), by the same rules of quadrature.

An entry is (t, p, q): the albedo of single scattering is t + F0 p + F90 q.
"""

from functools import lru_cache

import numpy as np

import transmission
from anisotropic_table import interpolate, steps
from fresnel import f0_of_ior
from quadrature import gauss

COSINES, ALPHAS = 32, 24
DENSER, THINNER = 10, 24  # indices above and below 1
LEAST_COSINE, LEAST_ALPHA = 1e-6, 1e-4
ROOTS = 0.22, 0.9


def etas(denser):
    r = np.linspace(*ROOTS, DENSER if denser else THINNER) ** 4
    return (1 + r) / (1 - r) if denser else (1 - r) / (1 + r)


@lru_cache(maxsize=None)
def row(denser, i, j):
    """Of one index and alpha: (cosine, 3), and the averages over the hemisphere of what it gives, with the reflected share of
    the thinner side (4,)."""
    alpha = steps(ALPHAS, LEAST_ALPHA, 2)[j]
    values = transmission.glass_parts(steps(COSINES, LEAST_COSINE, 4), alpha, etas(denser)[i], 987, 610).T
    x, weight = (part.ravel() for part in gauss(8, *np.stack([np.arange(COSINES - 1), np.arange(1, COSINES)]) / (COSINES - 1)))
    average = np.sum(8 * (x**7 * weight)[:, None] * interpolate(values, x), axis=0)
    return values, np.append(average, transmission.reflected_share(alpha, f0_of_ior(etas(denser)[i])))


def between(alpha, eta, value):
    """Bilinear in the rows that alpha and the index lie between, of value(row)."""
    denser = eta > 1
    count = DENSER if denser else THINNER
    root = np.clip((abs((eta - 1) / (eta + 1)) ** 0.25 - ROOTS[0]) / (ROOTS[1] - ROOTS[0]), 0, 1) * (count - 1)
    place = np.sqrt(alpha) * (ALPHAS - 1)
    i, j = min(int(root), count - 2), min(int(place), ALPHAS - 2)
    lower, upper = (value(row(denser, k, j)) * (1 - place + j) + value(row(denser, k, j + 1)) * (place - j) for k in (i, i + 1))
    return lower + (upper - lower) * (root - i)


def look_up(mu, alpha, eta):
    """t, p and q (..., 3) at cosines by the table."""
    return between(alpha, eta, lambda row: interpolate(row[0], np.asarray(mu, float) ** 0.25))


def look_up_average(alpha, eta):
    """Their averages and the reflected share (4,), by the table."""
    return between(alpha, eta, lambda row: row[1])
