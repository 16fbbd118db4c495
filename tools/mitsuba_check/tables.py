"""Directional albedos of the GGX and sheen lobes by the quadrature of tests/oracle: tables that owe nothing to glim's."""

import os
import sys
from functools import lru_cache

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ORACLE = os.path.join(ROOT, "tests", "oracle")
COSINES = 160  # columns, even in cosine^(1/4)
LEAST_COSINE = 1e-6
ROUGHNESSES = 33  # rows between the least and the greatest roughness of a material
AZIMUTHS = 65  # of an anisotropic lobe, even from the tangent to the bitangent
WIDTHS = 17  # its rows, between the least and the greatest roughness or strength


def cosines():
    return np.maximum(np.linspace(0, 1, COSINES) ** 4, LEAST_COSINE)


def oracle(name):
    if ORACLE not in sys.path:
        sys.path.append(ORACLE)
    return __import__(name)


@lru_cache(maxsize=None)
def ggx_row(roughness):
    """a and b over the cosines, and their averages: the albedo is F0 a + F90 b by Schlick's reflectance."""
    ggx, directions, quadrature = oracle("ggx"), oracle("directions"), oracle("quadrature")
    alpha = max(roughness * roughness, 1e-8)

    def albedo(mu):
        return np.stack(ggx.directional_albedo(directions.at_cosine(mu), alpha, alpha), axis=-1)
    nodes, weights = quadrature.gauss(48)
    return albedo(cosines()), (4 * nodes ** 3 * weights) @ albedo(nodes ** 2)


@lru_cache(maxsize=None)
def anisotropic_row(roughness, strength):
    """a and b over azimuths and cosines, and their averages."""
    ggx, core, directions, quadrature = oracle("ggx"), oracle("core"), oracle("directions"), oracle("quadrature")
    ax, ay = np.maximum(core.anisotropic_alpha(roughness, strength), ggx.MIN_ALPHA)

    def albedo(mu, phi):
        return np.stack([np.stack(ggx.directional_albedo(directions.at_cosine(mu, angle), ax, ay, 96, 16), axis=-1) for angle in phi])
    nodes, weights = quadrature.gauss(48)
    angles, angle_weights = quadrature.gauss(32)
    means = np.einsum("p,m,pmc->c", angle_weights, 4 * nodes ** 3 * weights, albedo(nodes ** 2, angles * np.pi / 2))
    return albedo(cosines(), np.linspace(0, np.pi / 2, AZIMUTHS)), means


@lru_cache(maxsize=None)
def sheen_row(roughness):
    """The albedo of white sheen over the cosines, which may exceed 1."""
    sheen = oracle("sheen")
    return sheen.directional_albedo(np.maximum(cosines(), sheen.MIN_COSINE), roughness)[:, None]


def rows_between(low, high):
    return np.array([low]) if high - low < 1e-7 else np.linspace(low, high, ROUGHNESSES)


def ggx_table(low, high):
    """Rows of roughness x cosines x (a, b), and the averages: roughness x (a, b)."""
    found = [ggx_row(float(r)) for r in rows_between(low, high)]
    return np.stack([row for row, _ in found]), np.stack([mean for _, mean in found])


def anisotropic_table(roughnesses, strengths):
    """Rows from the least to the greatest of both x azimuths x cosines x (a, b), and the averages: rows x (a, b)."""
    count = 1 if roughnesses[0] == roughnesses[1] and strengths[0] == strengths[1] else WIDTHS
    pairs = zip(np.linspace(*roughnesses, count), np.linspace(*strengths, count))
    found = [anisotropic_row(float(roughness), float(strength)) for roughness, strength in pairs]
    return np.stack([row for row, _ in found]), np.stack([mean for _, mean in found])


def sheen_table(low, high):
    return np.stack([sheen_row(float(r)) for r in rows_between(low, high)])
