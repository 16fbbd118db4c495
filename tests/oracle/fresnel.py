"""Fresnel reflectances without units; cosines and parameters broadcast against each other."""

import numpy as np


def schlick_weight(cosine):
    """(1 - cos)^5: Schlick (1994), section 3."""
    return (1 - np.clip(cosine, 0, 1)) ** 5


def schlick(cosine, f0, f90=1.0):
    """Schlick (1994) with F90, as glTF 2.0 (appendix B) and KHR_materials_specular have it."""
    return f0 + (f90 - f0) * schlick_weight(cosine)


def schlick_average(f0, f90=1.0):
    """The cosine-weighted average of schlick: 2 int (1 - mu)^5 mu dmu = 1/21."""
    return f0 + (f90 - f0) / 21


def f0_of_ior(eta, eta_outside=1.0):
    """Reflectance at normal incidence between two indices of refraction."""
    return ((eta - eta_outside) / (eta + eta_outside)) ** 2


def ior_of_f0(f0):
    """The index of refraction against air that has the reflectance f0 < 1 at normal incidence."""
    root = np.sqrt(f0)
    return (1 + root) / (1 - root)


def dielectric(cos_i, eta):
    """Unpolarized Fresnel reflectance of a smooth dielectric; 1 under total internal reflection.

    cos_i >= 0 on the side of incidence; eta = index of the other side over the index of the side of incidence.
    Source: Pharr, Jakob and Humphreys, Physically Based Rendering, 4th edition (2023), section 9.3.5.
    """
    cos_i, eta = np.broadcast_arrays(np.clip(cos_i, 0, 1), np.asarray(eta, float))
    cos_t_squared = 1 - (1 - cos_i**2) / eta**2
    total = cos_t_squared <= 0
    cos_t = np.sqrt(np.where(total, 1, cos_t_squared))
    parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t)
    perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t)
    return np.where(total, 1, (parallel**2 + perpendicular**2) / 2)


def specular_f0(ior, specular, specular_color):
    """(F0, F90) of a dielectric; F0 per channel. ior = 0 gives F0 = min(specular_color, 1) * specular.

    Source: KHR_materials_specular, KHR_materials_ior.
    """
    return np.minimum(f0_of_ior(ior) * np.asarray(specular_color, float), 1) * specular, float(specular)
