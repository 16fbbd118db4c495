"""The kernels' table of anisotropic albedos (shaders/shared/scene_types.h), by the same rules of quadrature.

An entry is (E, c): E is the albedo for a reflectance of 1, and c the cosine, over the length of the stretched direction, at which Schlick's
weight is its mean over the reflected light.
"""

from functools import lru_cache
from itertools import product

import numpy as np

from directions import at_cosine
from fresnel import schlick_weight
from quadrature import gauss

COSINES, RATIOS, ALPHAS = 32, 6, 12
AVERAGE_RATIOS, AVERAGE_ALPHAS = 12, 48
LEAST_COSINE, LEAST_RATIO, LEAST_ALPHA = 1e-4, 1e-3, 1e-3


def stretched_length(w, ax, ay):
    return np.sqrt((ax * w[..., 0]) ** 2 + (ay * w[..., 1]) ** 2 + w[..., 2] ** 2)


def albedo(v, ax, ay):
    """A + B and B of directions (..., 3): over slopes tan(beta) at azimuths about that of the stretched v, in terms of tan(beta / 2)."""
    x, y, z = (v[..., axis, None, None] for axis in range(3))
    facing = np.sqrt((ax * x) ** 2 + (ay * y) ** 2)
    c, s = (np.where(facing > 0, a / np.where(facing > 0, facing, 1), b) for a, b in ((ax * x, 1), (ay * y, 0)))
    t, weight = gauss(28, -1, 1)
    half = np.pi / 16 * t * (15 - 10 * t**2 + 3 * t**4)
    phi, weight = np.concatenate([half, half + np.pi])[:, None], np.tile(np.pi * 15 / 16 * (1 - t**2) ** 2 * weight, 2)[:, None]
    slope_x, slope_y = ax * (c * np.cos(phi) - s * np.sin(phi)), ay * (s * np.cos(phi) + c * np.sin(phi))
    width = np.hypot(slope_x, slope_y)
    across = (x * slope_x + y * slope_y) / width
    sine, cosine = across / np.hypot(across, z), z / np.hypot(across, z)
    rise = np.where(sine > 0, 1 + sine, cosine**2 / (1 - np.minimum(sine, 0)))
    cos_end, sin_end = (part / np.hypot(rise, width * cosine) for part in (width * cosine, rise))
    end, beyond_end = sin_end / (1 + cos_end), 2 * cos_end / (1 + cos_end)
    u, u_weight = gauss(8)
    w, rest = end * (1 - u**2), beyond_end + end**2 * u**2 * (2 - u**2)
    hz = rest / np.hypot(rest, 2 * width * w)
    tangent = 2 * w / rest
    vh = hz * (z + tangent * width * across)
    l = np.stack([2 * vh * hz * tangent * slope_x - x, 2 * vh * hz * tangent * slope_y - y, 2 * vh * hz - z], axis=-1)
    visible = 2 * vh * l[..., 2] / (hz * (stretched_length(v, ax, ay)[..., None, None] * l[..., 2] + stretched_length(l, ax, ay) * z))
    measure = weight * end * 2 * u * u_weight * 4 * w * rest / (np.pi * (1 + w**2) ** 3)
    integrand = np.where((l[..., 2] > 0) & (vh > 0), visible * measure, 0)
    return np.sum(integrand, axis=(-2, -1)), np.sum(integrand * schlick_weight(np.minimum(vh, 1)), axis=(-2, -1))


def steps(count, least, power=1.0):
    return np.maximum((np.arange(count) / (count - 1)) ** power, least)


@lru_cache(maxsize=None)
def entries():
    """(alpha, along over alpha, the lesser alpha over along, cosine, 2)."""
    table = np.empty((ALPHAS, RATIOS, RATIOS, COSINES, 2))
    seen = steps(COSINES, LEAST_COSINE, 4 / 3)
    ratios = steps(RATIOS, LEAST_RATIO)
    for (i, ax), (j, wide), (k, narrow) in product(*map(enumerate, (steps(ALPHAS, LEAST_ALPHA, 4 / 3), ratios, ratios))):
        along = wide * ax
        ay = narrow * along
        squares = ax**2 - ay**2
        cos2 = np.clip((along**2 - ay**2) / squares, 0, 1) if squares > 1e-12 * ax**2 else 1.0
        z = np.sqrt((seen * along) ** 2 / ((1 - seen) * (1 + seen) + (seen * along) ** 2))
        sine = np.sqrt(1 - z**2)
        e, b = albedo(np.stack([sine * np.sqrt(cos2), sine * np.sqrt(1 - cos2), z], axis=-1), ax, ay)
        table[i, j, k] = np.stack([e, (1 - (b / e) ** 0.2) * seen / z], axis=-1)
    return table


def interpolate(table, *places):
    """Linear in each place in [0, 1] along the axes of the table."""
    cells = []
    for place, count in zip(places, table.shape):
        at = np.minimum(place, 1.0) * (count - 1)
        first = np.minimum(at.astype(int), count - 2)
        cells.append((first, at - first))
    value = 0
    for corner in product((0, 1), repeat=len(cells)):
        weight = np.prod([part if upper else 1 - part for upper, (_, part) in zip(corner, cells)], axis=0)
        value = value + weight[..., None] * table[tuple(first + upper for upper, (first, _) in zip(corner, cells))]
    return value


def look_up(w, ax, ay):
    """A + B and B of directions (..., 3) by the table."""
    sine, length = np.hypot(w[..., 0], w[..., 1]), stretched_length(w, ax, ay)
    along = np.where(sine > 0, np.hypot(ax * w[..., 0], ay * w[..., 1]) / np.where(sine > 0, sine, 1), ax)
    size = np.full(along.shape, ax)
    entry = interpolate(entries(), size**0.75, along / ax, ay / along, (w[..., 2] / length) ** 0.75)
    return entry[..., 0], entry[..., 0] * schlick_weight(np.minimum(entry[..., 1] * length, 1))


@lru_cache(maxsize=None)
def averages():
    """(alpha, ratio of alphas, 2): what E lacks of 1 over alpha, and B; averages over the hemisphere of what the table gives."""
    x, x_weight = gauss(24)
    phi, phi_weight = gauss(10, 0, np.pi / 2)
    w = at_cosine(x[:, None] ** 4, phi)
    weight = 8 * x[:, None] ** 7 * x_weight[:, None] * phi_weight / (np.pi / 2)
    table = np.empty((AVERAGE_ALPHAS, AVERAGE_RATIOS, 2))
    for (i, ax), (j, ratio) in product(enumerate(steps(AVERAGE_ALPHAS, LEAST_ALPHA, 2)), enumerate(steps(AVERAGE_RATIOS, LEAST_RATIO))):
        e, b = look_up(w, ax, ratio * ax)
        table[i, j] = np.sum(weight * (1 - e)) / ax, np.sum(weight * b)
    return table


def look_up_average(ax, ay):
    """The averages of A + B and B by the table."""
    lost, b = interpolate(averages(), np.sqrt([ax]), np.array([ay / ax]))[0]
    return 1 - lost * ax, b
