"""Transmission through surfaces: thin walls, rough glass and diffuse transmission. Fresnel is exact for the first two.

Sources: KHR_materials_transmission, KHR_materials_volume and KHR_materials_diffuse_transmission; Walter et al.,
"Microfacet Models for Refraction through Rough Surfaces" (2007), whose equations the functions name.
Light that glass scatters more than once: in the form of Kulla and Conty, "Revisiting Physically Based Shading at Imageworks" (2017).
Masking and shadowing are height-correlated, 1/(1 + Lambda(v) + Lambda(l)), on both sides.
"""

import numpy as np

import core
import ggx
from directions import at_cosine, dot, half_vector, mirror, normalize, per_channel, reflect
from fresnel import dielectric, f0_of_ior

MIN_ETA_STEP = 1e-4  # closer to 1, an interface of this index bends nothing and its half vector is undefined


def is_pass_through(eta):
    return abs(eta - 1) < MIN_ETA_STEP


def eval_thin(v, l, base, alpha, ior):
    """A thin wall, times |nl|, in 1/sr, per channel (..., 3): F V D above, base (1 - F) V D of the mirrored l below; v above."""
    above = l[..., 2] > 0
    mirrored = np.where(per_channel(above) > 0, l, mirror(l))
    f = dielectric(dot(v, half_vector(v, mirrored)), ior)
    color = np.where(per_channel(above) > 0, per_channel(f), per_channel(1 - f) * np.asarray(base, float))
    return color * per_channel(ggx.eval(v, mirrored, alpha, alpha))


def pdf_thin(v, l, alpha, ior):
    """Density of sample_thin in solid angle, over both sides."""
    above = l[..., 2] > 0
    mirrored = np.where(per_channel(above) > 0, l, mirror(l))
    f = dielectric(dot(v, half_vector(v, mirrored)), ior)
    return np.where(above, f, 1 - f) * ggx.pdf(v, mirrored, alpha, alpha)


def sample_thin(v, alpha, ior, u):
    """Directions (n, 3) and whether they carry anything (n,), for one v (3,) above and u (n, 3): a visible normal, then a choice by F."""
    h = ggx.sample_D_v(v, alpha, alpha, u[:, :2])
    l = reflect(v, h)
    reflected = u[:, 2] < dielectric(dot(v, h), ior)
    return np.where(per_channel(reflected) > 0, l, mirror(l)), l[:, 2] > 0


def refract(v, h, eta):
    """The direction away from the surface that v refracts to, h on v's side; eta = index of the far side over the index of v's side."""
    cos_i = dot(v, h)
    cos_t = np.sqrt(np.maximum(0, 1 - (1 - cos_i**2) / eta**2))
    return per_channel(cos_i / eta - cos_t) * h - v / eta


def to_upper_side(v, l, ior):
    """(v, l, eta) reflected through the origin where v is below, inside the glass: the distributions are symmetric."""
    side = np.where(v[..., 2] > 0, 1.0, -1.0)
    return v * per_channel(side), l * per_channel(side), np.where(side > 0, ior, 1 / ior)


def refraction_terms(v, l, eta):
    """For v above and l below: (h on the upper side, vh, lh, whether l can refract from v, vh + eta lh)."""
    h = normalize(-(v + per_channel(eta) * l))
    h = h * per_channel(np.where(h[..., 2] > 0, 1, -1))
    cos_v, cos_l = dot(v, h), dot(l, h)
    valid = (l[..., 2] < 0) & (cos_v > 0) & (cos_l < 0)
    return h, cos_v, cos_l, valid, np.where(valid, cos_v + eta * cos_l, 1)


def eval_glass(v, l, alpha, ior):
    """Rough glass, times |nl|, in 1/sr (...); v and l on any side, the glass is below. The base color multiplies the refracted part.

    The refracted part has no factor for compressed radiance: f(v, l) / eta_l^2 is reciprocal. Walter et al. (2007), eq. 20 and 21.
    """
    v, l, eta = to_upper_side(v, l, ior)
    l_above = np.where(per_channel(l[..., 2] > 0) > 0, l, mirror(l))
    reflected = dielectric(dot(v, half_vector(v, l_above)), eta) * ggx.eval(v, l_above, alpha, alpha)
    h, cos_v, cos_l, valid, denominator = refraction_terms(v, l, eta)
    f = dielectric(cos_v, eta)
    refracted = -cos_l * cos_v / v[..., 2] * eta**2 * (1 - f) * ggx.G(v, l, alpha, alpha) * ggx.D(h, alpha, alpha) / denominator**2
    return np.where(l[..., 2] > 0, reflected, np.where(valid, refracted, 0))


def pdf_glass(v, l, alpha, ior):
    """Density of sample_glass in solid angle, over both sides: Walter et al. (2007), eq. 17, with visible normals."""
    v, l, eta = to_upper_side(v, l, ior)
    l_above = np.where(per_channel(l[..., 2] > 0) > 0, l, mirror(l))
    reflected = dielectric(dot(v, half_vector(v, l_above)), eta) * ggx.pdf(v, l_above, alpha, alpha)
    h, cos_v, cos_l, valid, denominator = refraction_terms(v, l, eta)
    refracted = (1 - dielectric(cos_v, eta)) * ggx.D_v(v, h, alpha, alpha) * -cos_l * eta**2 / denominator**2
    return np.where(l[..., 2] > 0, reflected, np.where(valid, refracted, 0))


def sample_glass(v, alpha, ior, u):
    """Directions (n, 3) and whether they carry anything (n,), for one v (3,) and u (n, 3): a visible normal, then a choice by F."""
    side = np.sign(v[2])
    eta = ior if side > 0 else 1 / ior
    h = ggx.sample_D_v(v * side, alpha, alpha, u[:, :2])
    reflected = u[:, 2] < dielectric(dot(v * side, h), eta)
    l = np.where(per_channel(reflected) > 0, reflect(v * side, h), refract(v * side, h, eta))
    return l * side, (l[:, 2] > 0) == reflected


def glass_parts(mu, alpha, eta, nodes=4181, step=2584):
    """(t, p, q), as (3, k), at cosines (k,): the albedo of single scattering of both lobes together is t + F0 p + F90 q.

    The reflectance is F0 + (F90 - F0) w, w the exact one scaled to begin at 0, and 1 under total reflection. By visible normals, at a
    lattice of two numbers of Fibonacci over the height on the spherical cap and half of the azimuths.
    """
    mu = np.asarray(mu, float)[:, None]
    v = at_cosine(mu)
    stretched = normalize(ggx.stretch(v, alpha, alpha))
    i = np.arange(nodes)
    q, phi = (i + 0.5) / nodes * (1 + stretched[..., 2]), np.pi * (i * step % nodes) / nodes
    r = np.sqrt(q * (2 - q))
    cap = np.stack(np.broadcast_arrays(r * np.cos(phi), r * np.sin(phi), 1 - q), axis=-1) + stretched
    h = normalize(ggx.stretch(cap, alpha, alpha))
    cosine = dot(v, h)

    def passed(z):
        w = at_cosine(np.clip(z, 1e-12, 1))
        return np.where(z > 0, ggx.G(v, w, alpha, alpha) / ggx.G1(v, alpha, alpha), 0)

    f, f0 = dielectric(cosine, eta), f0_of_ior(eta)
    reflected = passed(2 * cosine * h[..., 2] - mu)
    refracted = passed(-refract(v, h, eta)[..., 2])
    w, total = (f - f0) / (1 - f0), f >= 1
    parts = np.where(total, reflected, refracted), *(np.where(total, 0, part * (reflected - refracted)) for part in (1 - w, w))
    return np.mean(parts, axis=-1)


def reflected_share(alpha, f0):
    """The share of what single scattering loses of light from the side of the smaller index that leaves on that side.

    Fitted to random walks: Heitz et al., "Multiple-Scattering Microfacet BSDFs with the Smith Model" (2016).
    """
    return np.minimum(0.345 * alpha**-0.25 * f0 ** (0.9 * np.sqrt(alpha)), 1)


def eval_further(v, l, eta, lost, average):
    """Light scattered more than once, times |nl| in 1/sr, per channel (n, 3): (reflected, refracted) parts for v (3,) above.

    lost(mu, eta): what single scattering loses (..., 3); average(eta): its average (3,) and the reflected share of the thinner side.
    The refracted part is reciprocal as that of eval_glass is.
    """
    (here, share), (beyond, other) = average(eta), average(1 / eta)
    ratio = beyond * eta**2 / here
    reflected = np.maximum(share, 1 - ratio) if eta > 1 else np.maximum(1 - (1 - other) * ratio, 0)
    cosine = np.abs(l[..., 2])
    common = lost(v[None, 2], eta) * per_channel(cosine / np.pi)
    return common * reflected / here * lost(cosine, eta), common * (1 - reflected) / beyond * lost(cosine, 1 / eta)


def eval_diffuse(v, l, lobes, factor, color):
    """The diffuse lobe of core with KHR_materials_diffuse_transmission, times |nl| in 1/sr, per channel (..., 3); v above.

    factor: the share transmitted; color (3,), linear: of the far side. The interface takes its share on both sides alike.
    """
    far = factor * np.asarray(color, float) * per_channel(core.diffuse_coupling(v, l, lobes) * np.maximum(-l[..., 2], 0))
    return (1 - factor) * core.eval_diffuse(v, l, lobes) + far


def pdf_diffuse(l, factor):
    """Density of a cosine lobe on the far side, chosen with the probability factor, else on the near side."""
    return np.where(l[..., 2] > 0, 1 - factor, factor) * np.abs(l[..., 2]) / np.pi
