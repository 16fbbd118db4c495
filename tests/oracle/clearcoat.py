"""KHR_materials_clearcoat: a dielectric GGX layer over the base. v and l are relative to the coat's normal.

The extension weighs the layers by the Fresnel term at n.v. Here the coat reflects cc F(v.h) V D, and the base gets what the coat's
directional albedo Ec leaves: this is the energy that the coat really reflects, also where it is rough.
"""

import numpy as np

import ggx
from directions import dot, half_vector, per_channel
from fresnel import schlick

F0 = 0.04  # ior 1.5


def eval_coat(v, l, factor, roughness):
    """cc F V D |nl| in 1/sr (...), for roughness^2 >= ggx.MIN_ALPHA."""
    alpha = roughness**2
    return factor * schlick(dot(v, half_vector(v, l)), F0) * ggx.eval(v, l, alpha, alpha)


def pdf(v, l, roughness):
    """Density of the coat's sampler of visible normals, in solid angle."""
    return ggx.pdf(v, l, roughness**2, roughness**2)


def coat_albedo(mu, roughness):
    """Ec (...): directional albedo of the coat of factor 1; also that of the delta lobe, roughness 0."""
    curves = ggx.albedo_curves(roughness**2)
    return F0 * curves.A(mu) + curves.B(mu)


def base_factor(v, l, factor, roughness, coupling="view"):
    """What the coat leaves to the base (...).

    "view": 1 - cc Ec(v), which conserves energy; emission takes it too.
    "product": (1 - cc Ec(v)) (1 - cc Ec(l)) / (1 - cc Ec_avg), which is reciprocal and conserves energy over a diffuse base only.
    """
    passed_v = 1 - factor * coat_albedo(v[..., 2], roughness)
    if coupling == "view":
        return np.broadcast_to(passed_v, np.broadcast_shapes(v.shape, l.shape)[:-1])
    curves = ggx.albedo_curves(roughness**2)
    passed_l = 1 - factor * coat_albedo(np.abs(l[..., 2]), roughness)
    return passed_v * passed_l / (1 - factor * (F0 * curves.A_avg + curves.B_avg))


def eval(v, l, base, factor, roughness, coupling="view"):
    """The coat over a base whose eval gave base (..., 3): the BSDF times |nl| in 1/sr."""
    return per_channel(eval_coat(v, l, factor, roughness)) + base * per_channel(base_factor(v, l, factor, roughness, coupling))
