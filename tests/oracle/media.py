"""What light meets inside glass: KHR_materials_volume and KHR_materials_dispersion."""

import numpy as np

MIN_COLOR = 1e-6  # a black channel would have an infinite coefficient


def sigma_t(color, distance):
    """Attenuation coefficients, 1/unit of length, per channel (3,): -ln(color)/distance; an infinite distance gives 0."""
    return -np.log(np.maximum(color, MIN_COLOR)) / distance


def transmittance(sigma, length):
    """exp(-sigma length) = color^(length/distance), per channel: lengths (...) give (..., 3)."""
    return np.exp(-np.asarray(length, float)[..., None] * sigma)


def ior_at(wavelength_nm, ior, dispersion):
    """Cauchy's equation by the index at 587.6 nm and dispersion = 20 / Abbe number; at least 1."""
    return np.maximum(ior + (ior - 1) * dispersion / 20 * (523655 / np.square(wavelength_nm, dtype=float) - 1.5168), 1)
