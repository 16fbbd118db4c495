#!/usr/bin/env python3
"""Writes cases for the kernels' tests (tests/kernels) with what the reference expects: arrays of float32, a row per case.

Usage: write_cases.py FOLDER

Inputs are rounded to float32 before the reference sees them. An expectation comes with a tolerance, for arithmetic in float32: some
roundings of the result, and what roundings of the inputs would change.
"""

import sys
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

import anisotropic_table
import clearcoat
import core
import fresnel
import ggx
import glass_table
import iridescence
import media
import sheen
import slab
import tone
import transmission
from directions import at_cosine, dot, half_vector, mirror, normalize, per_channel, sample_uniform_hemisphere

HALF_ULP = 2.0**-24
ROUGHNESSES = (0.04, 0.1, 0.2, 0.5, 1.0)
COSINES = (1.0, 0.7, 0.3, 0.05, 0.01)
ANISOTROPIES = (0.0, 0.5, 1.0)
ETAS = (1.1, 1.5, 1 / 1.5, 2.4)
TABLE_SIZE = 64
TABLE_ERROR = 4e-7  # of an entry, which is rounded to 2^-22, and of interpolating in float32


def rounded(x):
    return np.asarray(x, np.float32).astype(float)


def tolerance(f, inputs, roundings=2, relative=32 * HALF_ULP):
    """Of f(*inputs): `relative` of its size, and as much as `roundings` of each number of the inputs change it."""
    value = f(*inputs)
    result = relative * np.abs(value)
    for i, array in enumerate(inputs):
        array = np.asarray(array, float)
        for place in [(..., axis) for axis in range(3)] if array.shape[-1:] == (3,) else [...]:
            changed = array.copy()
            changed[place] *= 1 - roundings * HALF_ULP
            result = result + np.abs(f(*inputs[:i], changed, *inputs[i + 1 :]) - value)
    return value, result


def columns(n, *parts):
    """The parts side by side, each (n,), (n, k), or a tuple or number for all rows."""
    parts = [np.tile(np.asarray(part, float), (n, 1)) if isinstance(part, (tuple, float)) else part.reshape(n, -1) for part in parts]
    return np.concatenate(parts, axis=1)


def directions_to(v, ax, ay, rng, n=8):
    """Directions above: n where GGX reflects v to, n uniform ones and n at the horizon."""
    u = rng.random((3 * n, 2))
    u[2 * n :, 0] *= 0.02
    l = sample_uniform_hemisphere(u)
    reflected = ggx.sample(v, ax, ay, u[:n])
    l[:n] = np.where(reflected[:, 2:] > 1e-3, reflected, l[:n])
    return rounded(l)


def ggx_cases(rng):
    rows = []
    for roughness in ROUGHNESSES:
        for anisotropy in ANISOTROPIES:
            ax, ay = (float(rounded(a)) for a in core.anisotropic_alpha(roughness, anisotropy))
            for mu in COSINES:
                v = rounded(at_cosine(mu, 2 * np.pi * rng.random()))
                l = directions_to(v, ax, ay, rng)
                value = tolerance(lambda v, l: ggx.eval(v, l, ax, ay), (v, l))
                pdf = tolerance(lambda v, l: ggx.pdf(v, l, ax, ay), (v, l))
                rows.append(columns(len(l), (*v,), l, (ax, ay), *value, *pdf))
    return np.concatenate(rows)


def bare_glass(f, v, l, alpha, eta):
    """transmission.eval_glass or pdf_glass of l below, without Fresnel's transmittance; 0 if no facet refracts v to l."""
    _, cosine, _, valid, _ = transmission.refraction_terms(v, l, eta)
    passed = np.where(valid, 1 - fresnel.dielectric(cosine, eta), 0)
    return np.where(passed > 0, f(v, l, alpha, eta) / np.where(passed > 0, passed, 1), 0)


def transmission_cases(rng):
    rows = []
    for eta in map(float, rounded(ETAS)):
        for roughness in ROUGHNESSES:
            alpha = float(rounded(roughness**2))
            for mu in COSINES:
                v = rounded(at_cosine(mu, 2 * np.pi * rng.random()))
                u = np.concatenate([rng.random((60, 2)), np.ones((60, 1))], axis=1)
                refracted, carries = transmission.sample_glass(v, alpha, eta, u)
                others = mirror(sample_uniform_hemisphere(rng.random((12, 2))))
                bent = np.abs(dot(refracted, refracted) - 1) < 1e-6  # not reflected totally
                refracted = refracted[carries & (refracted[:, 2] < -1e-3) & bent]
                l = rounded(np.concatenate([refracted[:12], others]))
                h, cosine, _, valid, _ = transmission.refraction_terms(v, l, eta)
                # Where rounding decides whether a facet refracts v to l, the kernel may say either.
                clear = np.min(np.abs([1 + eta * dot(v, l), eta + dot(v, l), h[:, 2]]), axis=0) > 1e-4
                l = l[clear & ~(valid & (fresnel.dielectric(cosine, eta) > 0.999))]
                n = len(l)
                eval_ = tolerance(lambda v, l, e: bare_glass(transmission.eval_glass, v, l, alpha, e) / e**2, (v, l, np.full(n, eta)))
                pdf = tolerance(lambda v, l, e: bare_glass(transmission.pdf_glass, v, l, alpha, e), (v, l, np.full(n, eta)))
                mu_h = rounded(rng.random(n) ** 2)
                rows.append(columns(n, (*v,), l, alpha, eta, *eval_, *pdf, mu_h, *tolerance(fresnel.dielectric, (mu_h, np.full(n, eta)))))
    return np.concatenate(rows)


def sheen_cases(rng):
    """With the masking of both directions."""
    rows = []
    for roughness in (0.01, 0.07, *ROUGHNESSES[1:]):
        alpha = float(rounded(roughness**2))
        # The exponent of a power multiplies its logarithm's error of 2e-7; masking is exp of a sum of numbers up to 9.
        relative = 96 * HALF_ULP
        for mu in COSINES:
            v = rounded(at_cosine(mu, 2 * np.pi * rng.random()))
            l = directions_to(v, 1.0, 1.0, rng)
            numbers = tolerance(lambda v, l: sheen.eval_unscaled(v, l, np.sqrt(alpha)), (v, l), relative=relative + 2e-7 * np.log(2) / alpha)
            masking = tolerance(lambda c: sheen.Lambda(c, alpha), (l[:, 2],), relative=relative)
            numbers = numbers[0], np.maximum(numbers[1], 1e-36)  # smaller numbers are 0 on the device
            rows.append(columns(len(l), (*v,), l, alpha, *numbers, *masking))
    return np.concatenate(rows)


def film_cases(rng):
    rows = []
    for ior in map(float, rounded((0.8, 1.0, 1.1, 1.3, 1.5, 2.4))):
        for thickness in map(float, rounded([0, 0.01, 0.03, 1e4, *(1000 * rng.random(36))])):
            cosine = rounded(np.concatenate([COSINES, rng.random(25)]))
            cosine = cosine[np.abs(1 - (1 - cosine**2) / ior**2) > 1e-4]  # else rounding decides whether the film reflects all
            n = len(cosine)
            f0 = rounded(rng.choice([0, 1e-4, 0.02, 0.05, 0.2, 0.5, 0.9, 1], (n, 3)))
            value, accuracy = tolerance(iridescence.film, (cosine, ior, thickness, f0))
            # The colour matrix multiplies the error of the response to the phase.
            rows.append(columns(n, cosine, ior, thickness, f0, value, accuracy + 4e-6))
    return np.concatenate(rows)


def multiple_scattering_cases(rng):
    rows = []
    for roughness in ROUGHNESSES:
        curves = ggx.albedo_curves(roughness**2)
        for mu in COSINES:
            for f0, f90 in (((0.04, 0.04, 0.04), 1.0), ((0.9, 0.5, 0.1), 1.0), ((0, 0.02, 1), 0.5), ((1, 1, 1), 1.0)):
                f0 = rounded(f0)
                albedo = core.specular_albedo(mu, curves, f0, f90)
                rows.append(np.concatenate([[curves.A(mu), curves.B(mu), curves.A_avg, curves.B_avg], f0, [f90],
                                            core.multiple_scattering_fresnel(curves, f0, f90), albedo]))
    return np.array(rows)


def albedo_cases(rng):
    """Directional albedos of GGX and sheen at cosines and alphas between those of the tables."""
    rows = []
    for alpha in rounded(np.concatenate([np.square(ROUGHNESSES), rng.random(40) ** 2])):
        cosine = rounded(np.concatenate([COSINES, 0.005 + 0.995 * rng.random(40) ** 2]))
        curves = ggx.albedo_curves(float(alpha))
        of_sheen = sheen.directional_albedo(cosine, np.sqrt(alpha), 96, 96)
        rows.append(columns(len(cosine), cosine, float(alpha), curves.A(cosine), curves.B(cosine), (curves.A_avg, curves.B_avg), of_sheen))
    return np.concatenate(rows)


def ior_cases(rng):
    n = 1000
    nm, ior, dispersion = rounded(400 + 300 * rng.random(n)), rounded(1 + 1.4 * rng.random(n)), rng.random(n) * 3
    spread = rounded((ior - 1) * dispersion / 20)
    return columns(n, nm, ior, spread, media.ior_at(nm, ior, np.where(ior > 1, 20 * spread / (ior - 1), 0)))


def slab_cases(rng):
    """Thin and thick slabs, seen straight and aslant: what they reflect and transmit."""
    rows = []
    for albedo, tau, g in ((1, 1, 0), (1, 4, 0.8), (0.9, 2, -0.5), (0.5, 1, 0.8), (0.99, 10, 0.5), (0.999, 100, 0)):
        for cosine in (1, 0.5):
            (reflected,), (transmitted,) = slab.slab(albedo, tau, g, [cosine])
            rows.append([albedo, tau, g, cosine, reflected, transmitted])
    return np.array(rows, float)


def root_of(i):
    return (i / (TABLE_SIZE - 1)) ** 4


@lru_cache(maxsize=None)
def albedo_row(j):
    """A and B (2, 64) at the cosines of the kernels' table, and their averages (2,) over the function that is linear between them."""
    axis = np.arange(TABLE_SIZE)
    mu = np.maximum(root_of(axis), 1e-9)
    s = fresnel.schlick_weight(mu)
    ab = np.array([1 - s, s]) if j == 0 else np.array(ggx.directional_albedo(at_cosine(mu), root_of(j), root_of(j)))
    x = axis / (TABLE_SIZE - 1)
    slope = np.diff(ab) / np.diff(x)
    averages = 8 * np.sum((ab[:, :-1] - slope * x[:-1]) * np.diff(x**8) / 8 + slope * np.diff(x**9) / 9, axis=1)
    return ab, averages


class TabledCurves:
    """ggx.AlbedoCurves by the kernels' table: bilinear in the fourth roots of cosine and alpha. The shifts are added to A and its average."""

    shift = average_shift = 0.0

    def __init__(self, alpha):
        y = alpha**0.25 * (TABLE_SIZE - 1)
        j = min(int(y), TABLE_SIZE - 2)
        (lower, lower_average), (upper, upper_average) = albedo_row(j), albedo_row(j + 1)
        self.values = lower + (upper - lower) * (y - j)
        self.average = lower_average + (upper_average - lower_average) * (y - j)

    def at(self, mu):
        return [np.interp(np.asarray(mu) ** 0.25 * (TABLE_SIZE - 1), np.arange(TABLE_SIZE), row) for row in self.values]

    def A(self, mu):
        return self.at(mu)[0] + self.shift

    def B(self, mu):
        return self.at(mu)[1]

    def E1(self, mu):
        return self.A(mu) + self.B(mu)

    @property
    def A_avg(self):
        return self.average[0] + self.average_shift

    @property
    def B_avg(self):
        return self.average[1]

    @property
    def E1_avg(self):
        return self.A_avg + self.B_avg


class TabledAnisotropic(TabledCurves):
    """ggx.AnisotropicAlbedo by the kernels' table."""

    def __init__(self, ax, ay):
        self.alpha = ax, ay
        e, b = anisotropic_table.look_up_average(ax, ay)
        self.average = e - b, b

    def at(self, w):
        e, b = anisotropic_table.look_up(w, *self.alpha)
        return e - b, b


@lru_cache(maxsize=None)
def sheen_row(j):
    mu = np.maximum(root_of(np.arange(TABLE_SIZE)), sheen.MIN_COSINE)
    return sheen.directional_albedo(mu, np.sqrt(max(root_of(j), sheen.MIN_ROUGHNESS**2)), 32, 32)


@lru_cache(maxsize=None)
def tabled_sheen(roughness):
    y = roughness**0.5 * (TABLE_SIZE - 1)
    j = min(int(y), TABLE_SIZE - 2)
    values = sheen_row(j) + (sheen_row(j + 1) - sheen_row(j)) * (y - j)
    return lambda mu: np.interp(np.asarray(mu) ** 0.25 * (TABLE_SIZE - 1), np.arange(TABLE_SIZE), values)


@dataclass(frozen=True)
class Material:
    """The fields of tests/support/material_case.h, in its order."""

    base: tuple = (0.8, 0.5, 0.2)
    metallic: float = 0.0
    roughness: float = 0.5
    ior: float = 1.5
    specular: float = 1.0
    specular_color: tuple = (1, 1, 1)
    anisotropy: float = 0.0
    clearcoat: float = 0.0
    clearcoat_roughness: float = 0.0
    coat_normal: tuple = (0, 0, 1)
    sheen_color: tuple = (0, 0, 0)
    sheen_roughness: float = 0.0
    film: float = 0.0
    film_ior: float = 1.3
    film_thickness: float = 400.0
    transmission: float = 0.0
    diffuse_transmission: float = 0.0
    diffuse_transmission_color: tuple = (1, 1, 1)
    solid: float = 0.0
    inside: float = 0.0  # v is within the solid

    def numbers(self):
        return np.concatenate([np.atleast_1d(value) for value in self.__dict__.values()])

    def rounded(self):
        return Material(*(rounded(value) if np.ndim(value) else float(rounded(value)) for value in self.__dict__.values()))


# Each lobe alone, then together.
MATERIALS = (
    *(Material(roughness=r, anisotropy=a) for r in ROUGHNESSES for a in ANISOTROPIES),
    *(Material(roughness=r, metallic=m) for r in ROUGHNESSES for m in (0.3, 1.0)),
    Material(roughness=0.3, ior=1.8, specular=0.6, specular_color=(1, 0.5, 3), metallic=0.2),
    Material(roughness=0.4, ior=0.0, specular_color=(0.3, 0.2, 0.5)),  # of KHR_materials_pbrSpecularGlossiness
    *(Material(clearcoat=0.8, clearcoat_roughness=r, metallic=m) for r in (0.04, 0.3, 1.0) for m in (0, 1)),
    Material(clearcoat=1.0, clearcoat_roughness=0.4, coat_normal=tuple(at_cosine(0.9, 1.0)), anisotropy=0.6),
    *(Material(sheen_color=(0.9, 0.5, 1), sheen_roughness=r) for r in (0.07, 0.2, 0.5, 1.0)),
    Material(sheen_color=(0.9, 0.5, 0.2), sheen_roughness=0.3, clearcoat=0.7, clearcoat_roughness=0.2, metallic=0.4),
    *(Material(film=1.0, film_thickness=d, metallic=m, roughness=0.3) for d in (150, 480) for m in (0, 0.5, 1)),
    *(Material(transmission=1.0, roughness=r) for r in ROUGHNESSES),
    *(Material(transmission=t, solid=1, inside=i, roughness=r, ior=n, base=(0.9, 0.8, 1))
      for r in ROUGHNESSES for n, i in ((1.1, 0), (1.5, 0), (1.5, 1), (2.4, 0)) for t in (1.0, 0.4)),
    Material(transmission=0.6, metallic=0.5, anisotropy=0.5),
    Material(transmission=0.7, solid=1, metallic=0.5, film=0.6, clearcoat=0.5, clearcoat_roughness=0.3),
    Material(diffuse_transmission=0.4, diffuse_transmission_color=(0.3, 1, 0.6), roughness=0.3),
    Material(diffuse_transmission=0.4, diffuse_transmission_color=(0.3, 1, 0.6), transmission=0.5, sheen_color=(0.5, 0.5, 0.5),
             sheen_roughness=0.4),
)


def in_coat_frame(w, normal):
    """Directions relative to the coat's normal; its lobe does not depend on the azimuth."""
    x = normalize(np.cross([0, 1, 0], normal))
    return w @ np.stack([x, np.cross(normal, x), normal], axis=1)


def eval_principled(v, l, m):
    """The whole material times |nl|, per channel (n, 3), for v (3,) above and l (n, 3) on either side, as glim layers it.

    Where glim departs from the reference's defaults: the two parts of a half-metal scatter multiply each with its own F0; Fresnel's
    equations hold for solids alone, and Schlick's for thin walls; what lies below a solid interface gets 1 - max(E, F) of both directions;
    coat and sheen leave the lesser of what they leave of v and of l; the sheen lies below the coat; radiance is scaled by 1/eta^2.
    """
    eta = (1 / m.ior if m.inside else m.ior) if m.solid else 1.0
    f0, f90 = fresnel.specular_f0(m.ior, m.specular, m.specular_color)
    base, ax_ay = np.asarray(m.base), core.anisotropic_alpha(m.roughness, m.anisotropy)
    alpha = np.maximum(ax_ay, ggx.MIN_ALPHA)
    above = l[:, 2] > 0
    upper = np.where(above[:, None], l, mirror(l))
    solid = m.solid and m.transmission > 0
    table_alpha = np.sqrt(np.mean(np.square(ax_ay)))

    def dielectric(cosine):
        if solid:
            normal = fresnel.f0_of_ior(eta)
            s = (fresnel.dielectric(cosine, eta) - normal) / (1 - normal)
            outside = np.sqrt(np.maximum(0, 1 - (1 - np.square(cosine)) / eta**2)) if eta < 1 else cosine
        else:
            s, outside = fresnel.schlick_weight(cosine), cosine
        plain = f0 + (f90 - f0) * per_channel(s)
        film = iridescence.film(outside, m.film_ior, m.film_thickness, f0)
        return np.where(per_channel(s) >= 1, 1, plain + (film - plain) * m.film) if solid else plain + (film - plain) * m.film

    def metal(cosine):
        return iridescence.fresnel(cosine, m.film, m.film_ior, m.film_thickness, base)

    # The interface, and the light that it scatters more than once.
    cosine = dot(v, half_vector(v, upper))
    reflected = dielectric(cosine) + (metal(cosine) - dielectric(cosine)) * m.metallic
    f = np.where(above[:, None], reflected * per_channel(ggx.eval(v, upper, *alpha)), 0)
    table_f0, table_metal = f0, base
    if m.film > 0:
        table_f0 = iridescence.equivalent_f0(v[2], dielectric(v[2]), f90)
        table_metal = iridescence.equivalent_f0(v[2], metal(v[2]))
    lobes = core.Lobes(*ax_ay, table_f0, f90, base, np.max(table_f0), f90)
    more = core.eval_multiple_scattering(v, l, lobes)
    share = m.transmission if alpha[0] > ggx.MIN_ALPHA else 0
    if solid:
        more = more * (1 - share)
    f = f + more + (core.eval_multiple_scattering(v, l, replace(lobes, f0=table_metal, f90=1.0)) - more) * m.metallic
    if m.transmission > 0:
        if solid:
            _, cosine, *_ = transmission.refraction_terms(v, l, eta)
            lobe = per_channel(bare_glass(transmission.eval_glass, v, l, alpha[0], eta) / eta**2)
        else:
            lobe = per_channel(ggx.eval(v, upper, *alpha))
        f = f + np.where(above[:, None], 0, (1 - dielectric(cosine)) * lobe * base * m.transmission * (1 - m.metallic))
        if solid:
            shift = TabledCurves.shift

            def lost(parts):
                return 1 - shift - parts[..., :1] - f0 * parts[..., 1:2] - f90 * parts[..., 2:3]

            def average(eta):
                parts = glass_table.look_up_average(table_alpha, eta)
                return lost(parts) + shift - TabledCurves.average_shift, parts[3] + TabledCurves.average_shift

            near, far = transmission.eval_further(v, l, eta, lambda mu, eta: lost(glass_table.look_up(mu, table_alpha, eta)), average)
            further = np.where(above[:, None], near, far / eta**2 * base)
        else:
            fms = core.multiple_scattering_fresnel(lobes.curves, table_f0, f90)
            white = core.eval_multiple_scattering(v, upper, replace(lobes, f0=np.ones(3), f90=1.0))
            further = np.where(above[:, None], 0, white * (1 - fms) * base)
        f = f + further * share * (1 - m.metallic)
    # Below it.
    left = (1 - m.metallic) * (1 - m.transmission)
    if solid:
        shift = TabledCurves.shift  # 1 - F has the same absolute error
        passed = [np.minimum(1 - core.interface_albedo(lobes.place(w), lobes), 1 - shift - np.max(dielectric(np.abs(w[..., 2])), axis=-1))
                  for w in (v, l)]
        coupling = passed[0] * passed[1] / np.pi
    else:
        coupling = core.diffuse_coupling(v, l, lobes)
    near = base * (1 - m.diffuse_transmission)
    far = np.asarray(m.diffuse_transmission_color) * m.diffuse_transmission
    f = f + per_channel(left * coupling * np.abs(l[:, 2])) * np.where(above[:, None], near, far)
    # Above it.
    cv, cl = in_coat_frame(v, np.asarray(m.coat_normal)), in_coat_frame(l, np.asarray(m.coat_normal))
    coat = [clearcoat.base_factor(a, b, m.clearcoat, m.clearcoat_roughness) for a, b in ((cv, cl), (at_cosine(np.abs(cl[:, 2])), cv))]
    sheen_v, sheen_l = 1.0, 1.0
    if np.max(m.sheen_color) > 0:
        e, most = sheen.albedo_curve(m.sheen_roughness), np.max(m.sheen_color)
        sheen_v, sheen_l = (np.maximum(0, 1 - most * e(np.abs(w[..., 2]))) for w in (v, l))
    f = f * per_channel(np.minimum(coat[0] * sheen_v, coat[1] * sheen_l))
    if np.max(m.sheen_color) > 0:
        f = f + sheen.eval(v, l, m.sheen_color, m.sheen_roughness) * per_channel(np.minimum(*coat))
    if m.clearcoat > 0:
        f = f + per_channel(np.where(above & (cl[:, 2] > 0), clearcoat.eval_coat(cv, cl, m.clearcoat, m.clearcoat_roughness), 0))
    return f


def principled_cases(rng):
    ggx.albedo_curves, ggx.anisotropic_albedo = lru_cache(maxsize=None)(TabledCurves), lru_cache(maxsize=None)(TabledAnisotropic)
    sheen.albedo_curve = tabled_sheen
    rows = []
    for m in (m.rounded() for m in MATERIALS):
        alpha = np.maximum(core.anisotropic_alpha(m.roughness, m.anisotropy), ggx.MIN_ALPHA)
        for mu in COSINES:
            v = rounded(at_cosine(mu, 2 * np.pi * rng.random()))
            if in_coat_frame(v, np.asarray(m.coat_normal))[2] < 1e-3:
                continue
            l = directions_to(v, *alpha, rng, 4)
            if m.transmission > 0 or m.diffuse_transmission > 0:
                below = mirror(directions_to(v, *alpha, rng, 4))
                if m.solid:
                    eta = 1 / m.ior if m.inside else m.ior
                    h = ggx.sample_D_v(v, *alpha, rng.random((12, 2)))
                    bent = transmission.refract(v, h, eta)
                    good = (bent[:, 2] < -1e-3) & (fresnel.dielectric(dot(v, h), eta) < 0.99)
                    below = rounded(np.concatenate([bent[good], below[4:8]]))
                    cosine = below @ v
                    below = below[(np.abs(1 + eta * cosine) > 1e-3) & (np.abs(eta + cosine) > 1e-3)]
                l = np.concatenate([l, below])
            value, accuracy = tolerance(lambda v, l: eval_principled(v, l, m), (v, l), 4, 64 * HALF_ULP)
            for shift in ("shift", "average_shift"):
                setattr(TabledCurves, shift, TABLE_ERROR)
                accuracy = accuracy + np.abs(eval_principled(v, l, m) - value)
                setattr(TabledCurves, shift, 0.0)
            if np.max(m.sheen_color) > 0:
                accuracy = accuracy + value * (2e-7 * np.log(2) / m.sheen_roughness**2)  # as in sheen_cases
            rows.append(columns(len(l), (*v,), l, (*m.numbers(),), value, accuracy))
    return np.concatenate(rows)


def tone_cases(rng):
    """Each colour by both tones: of any brightness, at the bounds of the curves, black, and as bright as floats are."""
    greys = np.array([0, 1e-38, 0.04, 0.08, 0.08 + 1e-6, 0.18, 0.76, 0.8, 0.8 + 1e-6, 1, 1e6, 1e30, 3e38])
    primaries = np.array([0.01, 0.5, 0.8, 4, 1e4, 1e30])[:, None, None] * np.eye(3)
    colors = rounded(np.concatenate([10 ** rng.uniform(-6, 6, (2000, 3)), rng.random((2000, 3)), greys[:, None] * np.ones(3),
                                     primaries.reshape(-1, 3)]))
    rows = []
    for number, curve in ((1.0, tone.neutral), (2.0, tone.agx)):
        rows.append(columns(len(colors), colors, number, curve(np.minimum(colors, 1e30))))
    return np.concatenate(rows)


# The last one puts tables in the place of exact albedos.
WRITERS = (ggx_cases, transmission_cases, sheen_cases, film_cases, multiple_scattering_cases, albedo_cases, ior_cases, slab_cases, tone_cases, principled_cases)


def main():
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for writer in WRITERS:
        rows = writer(np.random.default_rng(1))
        assert np.all(np.isfinite(rows)), writer.__name__
        rows.astype(np.float32).tofile(folder / f"{writer.__name__}.bin")


if __name__ == "__main__":
    main()
