"""Tone mapping of scene-linear colours (..., 3), not negative, to linear light of a display in [0, 1].

Khronos PBR Neutral: KhronosGroup/ToneMapping, PBR_Neutral/README.md. AgX: Troy Sobotka, github.com/sobotka/AgX, with matrices and the
polynomial by Benjamin Wrensch, Minimal AgX Implementation, iolite-engine.com, 2023.
"""

import numpy as np

AGX_STOPS = (-12.47393, 4.026069)  # log2(.18) - 10 and log2(.18) + 6.5
AGX_INSET = np.array(
    [
        [0.842479062253094, 0.0784335999999992, 0.0792237451477643],
        [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
        [0.0423756549057051, 0.0784336, 0.879142973793104],
    ]
)
AGX_POLYNOMIAL = (15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232)


def neutral(c):
    f90, ks, kd = 0.04, 0.8 - 0.04, 0.15
    x = np.min(c, axis=-1, keepdims=True)
    shifted = c - np.where(x <= 2 * f90, x - x**2 / (4 * f90), f90)
    p = np.max(shifted, axis=-1, keepdims=True)
    bright = np.maximum(p, ks)
    pn = 1 - (1 - ks) ** 2 / (bright + 1 - 2 * ks)
    g = 1 / (kd * (bright - pn) + 1)
    return np.where(p <= ks, shifted, shifted * pn / bright * g + pn * (1 - g))


def agx_sigmoid(x):
    """Sobotka's curve over the normalized stops: slope 2 in middle grey, powers 3 of the toe and 3.25 of the shoulder, through 0 and 1."""
    pivot, grey, slope = 10 / 16.5, 0.5, 2.0
    across = np.where(x < pivot, pivot, 1 - pivot)
    up = np.where(x < pivot, grey, 1 - grey)
    power = np.where(x < pivot, 3.0, 3.25)
    scale = ((slope * across) ** -power * ((slope * across / up) ** power - 1)) ** (-1 / power)
    t = slope * np.abs(x - pivot) / scale
    return grey + np.sign(x - pivot) * scale * t / (1 + t**power) ** (1 / power)


def agx_polynomial(x):
    return np.polyval(AGX_POLYNOMIAL, x)


def agx(c, curve=agx_polynomial):
    low, high = AGX_STOPS
    stops = np.log2(np.maximum(c @ AGX_INSET.T, 1e-300))
    encoded = curve(np.clip((stops - low) / (high - low), 0, 1)) @ np.linalg.inv(AGX_INSET).T
    return np.clip(encoded, 0, 1) ** 2.2
