"""KHR_materials_iridescence: Fresnel reflectance of a thin film over the base.

Source: Belcour and Barla, "A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence" (2017), in the form
that the extension gives: unpolarized, Schlick's Fresnel, Airy sum up to m = 2, Gaussian fits of the CIE color matching functions.
The product R12 R23 may be 0 here, so that a film of no thickness is exactly Schlick's Fresnel at normal incidence.
"""

import numpy as np

import ggx
from directions import dot, half_vector, per_channel
from fresnel import f0_of_ior, ior_of_f0, schlick, schlick_weight

MAX_REFLECTANCE = 0.9999  # an ior must exist for F0, and the Airy sum must converge
MIN_F0 = 1e-4

# Belcour and Barla's fit of the Fourier transform of x, y, z and the second lobe of x: amplitudes, mean wavenumbers (1/m), squared widths.
AMPLITUDE = np.array([5.4856e-13, 4.4201e-13, 5.2481e-13, 9.7470e-14])
WAVENUMBER = np.array([1.6810e6, 1.7953e6, 2.2084e6, 2.2399e6])
VARIANCE = np.array([4.3278e9, 9.3046e9, 6.6121e9, 4.5282e9])
NORMALIZATION = 1.0685e-7  # the integral of y
XYZ_TO_REC709 = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]])


def sensitivity(opd_nm, shift):
    """Linear Rec. 709 response (..., 3) to a cosine of the path difference; the shifts (..., 3) of R, G and B act on X, Y and Z."""
    phase = per_channel(2 * np.pi * 1e-9 * np.asarray(opd_nm, float))
    shifts = np.concatenate([shift, shift[..., :1]], axis=-1)
    lobes = AMPLITUDE * np.sqrt(2 * np.pi * VARIANCE) * np.cos(WAVENUMBER * phase + shifts) * np.exp(-VARIANCE * phase**2)
    xyz = lobes[..., :3] + lobes[..., 3:] * np.array([1, 0, 0])
    return xyz / NORMALIZATION @ XYZ_TO_REC709.T


def interfaces(cos_1, film_ior, thickness_nm, base_f0):
    """Of the film in air: (R12 (..., 1), R23 (..., 3), path difference in nm (...), phase shift (..., 3), total reflection (...))."""
    cos_1 = np.asarray(cos_1, float)
    t = np.clip(thickness_nm / 0.03, 0, 1)
    ior = 1 + (film_ior - 1) * t * t * (3 - 2 * t)  # a film of no thickness has no interface
    cos_2_squared = 1 - (1 - cos_1**2) / ior**2
    total = cos_2_squared < 0
    cos_2 = np.sqrt(np.where(total, 0, cos_2_squared))
    r12 = per_channel(schlick(cos_1, f0_of_ior(ior)))
    base_ior = ior_of_f0(np.clip(np.asarray(base_f0, float), MIN_F0, MAX_REFLECTANCE))
    r23 = schlick(per_channel(cos_2), f0_of_ior(base_ior, ior))
    phase_21 = np.pi if ior >= 1 else 0.0
    phase_23 = np.where(base_ior < ior, np.pi, 0.0)
    return r12, r23, 2 * ior * thickness_nm * cos_2, np.broadcast_to(phase_21 + phase_23, r23.shape), total


def film(cos_1, film_ior, thickness_nm, base_f0):
    """Reflectance of the film with the base, per channel (..., 3), clamped to [0, 1]; cos_1 (...) is on the side of air, base_f0 (3,)."""
    r12, r23, opd, shift, total = interfaces(cos_1, film_ior, thickness_nm, base_f0)
    t121 = 1 - r12
    r123 = np.minimum(r12 * r23, MAX_REFLECTANCE)
    once = t121**2 * r23 / (1 - r123)
    reflectance = r12 + once
    for m in (1, 2):
        reflectance = reflectance + (once - t121) * np.sqrt(r123) ** m * 2 * sensitivity(m * opd, m * shift)
    return np.where(total[..., None], 1, np.clip(reflectance, 0, 1))


def fresnel(cosine, factor, film_ior, thickness_nm, base_f0, base_f90=1.0):
    """mix(Schlick of the base, film, factor), per channel (..., 3)."""
    plain = schlick(per_channel(cosine), np.asarray(base_f0, float), base_f90)
    return plain + (film(cosine, film_ior, thickness_nm, base_f0) - plain) * factor


def eval(v, l, alpha_x, alpha_y, factor, film_ior, thickness_nm, base_f0, base_f90=1.0):
    """The single-scattering GGX lobe with this Fresnel at v.h, times |nl| in 1/sr, per channel (..., 3). Its density is ggx.pdf."""
    f = fresnel(dot(v, half_vector(v, l)), factor, film_ior, thickness_nm, base_f0, base_f90)
    return f * per_channel(ggx.eval(v, l, alpha_x, alpha_y))


def equivalent_f0(cosine, reflectance, f90=1.0):
    """The Schlick F0 (..., 3) that gives reflectance (..., 3) at the cosine (...), clamped to [0, 1]; for tables linear in F0 and F90."""
    s = per_channel(schlick_weight(cosine))
    return np.clip((reflectance - f90 * s) / (1 - s), 0, 1)
