"""KHR_materials_sheen: the Charlie distribution over a base layer.

Sources: Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF" (2017), sections 2 and 3; KHR_materials_sheen for the layering.
The lobe of the extension reflects more than it receives at small roughness; here it is divided by max(1, E(v), E(l)), which is reciprocal.
"""

from functools import lru_cache

import numpy as np

from directions import at_cosine, half_vector, per_channel
from quadrature import Interpolated, gauss

MIN_ROUGHNESS = 0.01  # below, the lobe is left out
MIN_COSINE = 1e-5  # below, E is not resolved: the lobe is as narrow as the angle of v to the horizon

# Estevez and Kulla (2017): the fit's coefficients a, b, c, d and e at alpha 0 and 1.
FIT_SMOOTH = np.array([25.3245, 3.32435, 0.16801, -1.27393, -4.85967])
FIT_ROUGH = np.array([21.5473, 3.82987, 0.19823, -1.97760, -4.32054])


def D(h, alpha):
    """Density of normals, 1/sr: (2 + 1/alpha) sin^(1/alpha) / (2 pi)."""
    z = h[..., 2]
    return (2 + 1 / alpha) * np.sqrt((1 - z) * (1 + z)) ** (1 / alpha) / (2 * np.pi)


def Lambda(cosine, alpha):
    """The fitted Lambda of the distribution, cosine > 0."""
    a, b, c, d, e = FIT_ROUGH + (FIT_SMOOTH - FIT_ROUGH) * (1 - alpha) ** 2

    def fit(x):
        return a / (1 + b * x**c) + d * x + e

    return np.exp(np.where(cosine < 0.5, fit(np.minimum(cosine, 0.5)), 2 * fit(0.5) - fit(np.minimum(1 - cosine, 0.5))))


def eval_unscaled(v, l, roughness):
    """V D |nl| in 1/sr as in the extension, without color (...); 0 for l below the horizon."""
    alpha = roughness**2
    upper = l[..., 2] > 0
    l = np.where(upper[..., None], l, [0, 0, 1])
    masking = 1 + Lambda(v[..., 2], alpha) + Lambda(l[..., 2], alpha)
    return np.where(upper, D(half_vector(v, l), alpha) / (masking * 4 * v[..., 2]), 0)


def nodes(n_z=48, n_phi=48):
    """Directions (m, 3) and weights (m,) in solid angle for v at azimuth 0: dense near the horizon opposite to v, where the lobe lies."""
    x, w_x = gauss(n_z)
    y, w_y = gauss(n_phi)
    z = x**4
    l = at_cosine(z[:, None], np.pi * (1 - y**2))
    weights = (w_x * 4 * x**3)[:, None] * (w_y * 2 * np.pi * 2 * y)  # twice: both half circles
    return l.reshape(-1, 3), weights.ravel()


def directional_albedo(mu, roughness, n_z=48, n_phi=48):
    """E(mu) (n,) of eval_unscaled, by quadrature."""
    l, w = nodes(n_z, n_phi)
    return eval_unscaled(at_cosine(mu)[..., None, :], l, roughness) @ w


@lru_cache(maxsize=None)
def albedo_curve(roughness):
    """E as a function of mu > 0, interpolated in mu^(1/4); constant below MIN_COSINE."""
    return Interpolated(lambda mu: directional_albedo(mu, roughness), 4, MIN_COSINE)


def eval(v, l, color, roughness):
    """The sheen lobe times |nl| in 1/sr, per channel (..., 3); color (3,) is linear."""
    if roughness < MIN_ROUGHNESS:
        return np.zeros(np.broadcast_shapes(v.shape, l.shape))
    e = albedo_curve(roughness)
    scale = np.maximum(1, np.maximum(e(v[..., 2]), e(np.abs(l[..., 2]))))
    return np.asarray(color, float) * per_channel(eval_unscaled(v, l, roughness) / scale)


def base_factor(v, l, color, roughness):
    """What the sheen leaves to the layers under it (...): min(1 - c E(v), 1 - c E(l)), at least 0, c the largest channel."""
    if roughness < MIN_ROUGHNESS:
        return np.ones(np.broadcast_shapes(v.shape, l.shape)[:-1])
    e = albedo_curve(roughness)
    return np.maximum(0, 1 - np.max(color) * np.maximum(e(v[..., 2]), e(np.abs(l[..., 2]))))


def eval_layered(v, l, base, color, roughness):
    """Sheen over a base layer whose eval gave base (..., 3)."""
    return eval(v, l, color, roughness) + base * per_channel(base_factor(v, l, color, roughness))


def pdf(l):
    """Density of the lobe's sampler, the uniform hemisphere."""
    return np.where(l[..., 2] > 0, 1 / (2 * np.pi), 0)
