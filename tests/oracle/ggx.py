"""The GGX (Trowbridge-Reitz) microfacet distribution, anisotropic, with height-correlated Smith masking.

v, l, h: unit directions (..., 3) on the upper side; ax, ay: alpha along x and y. Results have no channel axis.
Sources: Walter et al., "Microfacet Models for Refraction through Rough Surfaces" (2007); Heitz, "Understanding the Masking-Shadowing
Function in Microfacet-Based BRDFs" (2014); glTF 2.0, appendix B; KHR_materials_anisotropy.
"""

from functools import lru_cache

import numpy as np

from directions import at_cosine, dot, half_vector, normalize, reflect
from fresnel import schlick_weight
from quadrature import Interpolated, cosine_average, gauss

MIN_ALPHA = 1e-3  # below, the lobe is a delta distribution and has no density


def stretch(w, ax, ay):
    return w * np.stack(np.broadcast_arrays(ax, ay, 1.0), axis=-1)


def D(h, ax, ay):
    """Density of normals, 1/sr; 0 on the lower side. In terms of sin^2, without cancellation at small alpha."""
    x, y, z = h[..., 0], h[..., 1], h[..., 2]
    return np.where(z > 0, 1 / (np.pi * ax * ay * ((x / ax) ** 2 + (y / ay) ** 2 + z**2) ** 2), 0)


def Lambda(w, ax, ay):
    """Smith's Lambda of GGX: Heitz (2014)."""
    return (np.sqrt(1 + ((ax * w[..., 0]) ** 2 + (ay * w[..., 1]) ** 2) / w[..., 2] ** 2) - 1) / 2


def G1(w, ax, ay):
    """Masking of one direction: Heitz (2014), eq. 43."""
    return 1 / (1 + Lambda(w, ax, ay))


def G(v, l, ax, ay):
    """Height-correlated masking and shadowing: Heitz (2014), eq. 99."""
    return 1 / (1 + Lambda(v, ax, ay) + Lambda(l, ax, ay))


def V(v, l, ax, ay):
    """G / (4 nv nl), finite at grazing directions; KHR_materials_anisotropy."""
    length_v = np.sqrt(dot(stretch(v, ax, ay), stretch(v, ax, ay)))
    length_l = np.sqrt(dot(stretch(l, ax, ay), stretch(l, ax, ay)))
    return 0.5 / (v[..., 2] * length_l + l[..., 2] * length_v)


def D_v(v, h, ax, ay):
    """Density of the normals visible from v, 1/sr; it integrates to 1: Heitz (2014)."""
    return G1(v, ax, ay) * np.maximum(dot(v, h), 0) * D(h, ax, ay) / v[..., 2]


def sample_D_v(v, ax, ay, u):
    """Visible normals by spherical caps; u has the shape (n, 2).

    Source: Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps" (2023); sin^2 = q (2 - q) avoids cancellation.
    """
    w = normalize(stretch(v, ax, ay))
    q = u[:, 1] * (1 + w[..., 2])
    phi = 2 * np.pi * u[:, 0]
    sine = np.sqrt(q * (2 - q))
    cap = np.stack([sine * np.cos(phi), sine * np.sin(phi), 1 - q], axis=-1)
    return normalize(stretch(cap + w, ax, ay))


def sample(v, ax, ay, u):
    """Directions reflected at visible normals; those below the horizon carry nothing."""
    return reflect(v, sample_D_v(v, ax, ay, u))


def pdf(v, l, ax, ay):
    """Density of sample in solid angle; it integrates over the upper side to 1 minus the share of directions below the horizon."""
    h = half_vector(v, l)
    return np.where(l[..., 2] > 0, D(h, ax, ay) * G1(v, ax, ay) / (4 * v[..., 2]), 0)


def eval(v, l, ax, ay):
    """V D |nl| in 1/sr: the single-scattering lobe with F = 1; 0 where l is below the horizon."""
    upper = l[..., 2] > 0
    l = np.where(upper[..., None], l, [0, 0, 1])
    return np.where(upper, V(v, l, ax, ay) * D(half_vector(v, l), ax, ay) * l[..., 2], 0)


def half_vector_nodes(v, ax, ay, n_phi=32, n_theta=32, below=False):
    """Normals h (..., m, 3) and weights (..., m): sum w g(h) = int g(h) D(h) hz dh over the h that reflect v to the upper side.

    below=True takes the other visible normals instead, those that reflect v below the horizon.
    Slopes are (ax cos phi, ay sin phi) tan beta. The range of beta is known in closed form, so the integrand is smooth inside.
    Gauss-Legendre in substitutes of phi and beta that put more nodes where a grazing v makes it steep: at the ends of both.
    """
    v = np.asarray(v, float)[..., None, None, :]
    facing = np.arctan2(ay * v[..., 1], ax * v[..., 0])
    t, w_t = gauss(n_phi, -1, 1)
    half_circle, w_half = np.pi / 16 * t * (15 - 10 * t**2 + 3 * t**4), np.pi * 15 / 16 * (1 - t**2) ** 2 * w_t
    phi, w_phi = facing + np.concatenate([half_circle, half_circle + np.pi])[:, None], np.tile(w_half, 2)[:, None]
    x, y = ax * np.cos(phi), ay * np.sin(phi)
    length = np.hypot(x, y)
    # The azimuth of h; at alpha = 0, where all h are the normal, that of the limit.
    cos_azimuth, sin_azimuth = (x / length, y / length) if ax * ay > 0 else (np.cos(phi), np.sin(phi))
    psi = np.arctan2(v[..., 0] * cos_azimuth + v[..., 1] * sin_azimuth, v[..., 2])
    theta_horizon = (np.pi / 2 + psi) / 2  # where reflect(v, h) reaches the horizon
    theta_visible = np.minimum(np.pi / 2, np.pi / 2 + psi)  # where h turns away from v
    low = np.arctan2(np.sin(theta_horizon), length * np.cos(theta_horizon)) if below else np.zeros_like(psi)
    end = theta_visible if below else theta_horizon
    high = np.arctan2(np.sin(end), length * np.cos(end))
    t, w_t = gauss(n_theta)
    beta, w_beta = high - (high - low) * t**3, (high - low) * 3 * t**2 * w_t
    weights = w_phi * w_beta * np.sin(beta) * np.cos(beta) / np.pi
    h = normalize(np.stack(np.broadcast_arrays(x * np.sin(beta), y * np.sin(beta), np.cos(beta)), axis=-1))
    return h.reshape(*h.shape[:-3], -1, 3), weights.reshape(*weights.shape[:-2], -1)


def reflection_nodes(v, ax, ay, n_phi=32, n_theta=32):
    """Directions l (..., m, 3) on the upper side and weights (..., m) in solid angle, dense where GGX reflects v to."""
    h, w = half_vector_nodes(v, ax, ay, n_phi, n_theta)
    v = np.asarray(v, float)[..., None, :]
    return reflect(v, h), w * 4 * dot(v, h) / (D(h, ax, ay) * h[..., 2])


def directional_albedo(v, ax, ay, n_phi=32, n_theta=32):
    """(A, B) with E(v) = F0 A + F90 B for Schlick's Fresnel: A = int (1 - s) V D nl dl, B = int s V D nl dl, s = (1 - vh)^5."""
    v = np.asarray(v, float)
    h, w = half_vector_nodes(v, ax, ay, n_phi, n_theta)
    v = v[..., None, :]
    l = reflect(v, h)
    cos_h = dot(v, h)
    integrand = w * G(v, l, ax, ay) * cos_h / (v[..., 2] * h[..., 2])
    s = schlick_weight(cos_h)
    return np.sum((1 - s) * integrand, axis=-1), np.sum(s * integrand, axis=-1)


class AlbedoCurves:
    """A and B of one isotropic alpha, as functions of mu > 0 (interpolated in sqrt(mu)), and their cosine averages; E1 = A + B."""

    def __init__(self, alpha):
        self.A_and_B = Interpolated(lambda mu: np.stack(directional_albedo(at_cosine(mu), alpha, alpha), axis=-1), root=2)
        self.A_avg, self.B_avg = cosine_average(self.A), cosine_average(self.B)
        self.E1_avg = self.A_avg + self.B_avg

    def A(self, mu):
        return self.A_and_B(mu)[..., 0]

    def B(self, mu):
        return self.A_and_B(mu)[..., 1]

    def E1(self, mu):
        return self.A(mu) + self.B(mu)


@lru_cache(maxsize=None)
def albedo_curves(alpha):
    return AlbedoCurves(alpha)


class AnisotropicAlbedo:
    """A and B of two alphas as functions of directions (..., 3), and their cosine averages; E1 = A + B.

    A Chebyshev polynomial in sqrt(mu), and cosines of even multiples of the azimuth.
    """

    DEGREE, AZIMUTHS = 48, 64

    def __init__(self, ax, ay):
        nodes = np.polynomial.chebyshev.chebpts1(self.DEGREE + 1)
        phi = (np.arange(self.AZIMUTHS) + 0.5) * np.pi / 2 / self.AZIMUTHS
        v = at_cosine(((nodes + 1) / 2)[:, None] ** 2, phi)
        values = np.stack([np.stack(directional_albedo(row, ax, ay, 96, 16), axis=-1) for row in v])
        series = np.einsum("mpc,pk->mkc", values, self.cosines(phi) * np.where(np.arange(self.AZIMUTHS) > 0, 2, 1) / self.AZIMUTHS)
        self.coefficients = np.polynomial.chebyshev.chebfit(nodes, series.reshape(len(nodes), -1), self.DEGREE).reshape(series.shape)
        self.A_avg, self.B_avg = (cosine_average(lambda mu, c=c: self.at(mu, self.coefficients[:, 0, c])) for c in (0, 1))
        self.E1_avg = self.A_avg + self.B_avg

    def cosines(self, phi):
        return np.cos(2 * np.asarray(phi)[..., None] * np.arange(self.AZIMUTHS))

    @staticmethod
    def at(mu, coefficients):
        return np.polynomial.chebyshev.chebval(2 * np.sqrt(mu) - 1, coefficients, tensor=coefficients.ndim > 1)

    def of(self, w, channel):
        series = np.moveaxis(self.at(w[..., 2], self.coefficients[..., channel]), 0, -1)
        return np.sum(series * self.cosines(np.arctan2(w[..., 1], w[..., 0])), axis=-1)

    def A(self, w):
        return self.of(w, 0)

    def B(self, w):
        return self.of(w, 1)

    def E1(self, w):
        return self.A(w) + self.B(w)


@lru_cache(maxsize=None)
def anisotropic_albedo(ax, ay):
    return AnisotropicAlbedo(ax, ay)
