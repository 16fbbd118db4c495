#!/usr/bin/env python3
"""The reference of the glTF material against what theory promises, quadrature against sampling, and numbers known otherwise.

z: samples' means against quadrature, |z| <= 4.56, by which a family of 200 comparisons fails by chance in one run of a thousand.
Other tolerances are errors of quadrature, seen by doubling its nodes, or half a unit of the last digit of a printed number.
"""

import math
import os
import sys
import unittest

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import clearcoat  # noqa: E402
import core  # noqa: E402
import fresnel  # noqa: E402
import ggx  # noqa: E402
import iridescence  # noqa: E402
import media  # noqa: E402
import sheen  # noqa: E402
import slab  # noqa: E402
import tone  # noqa: E402
import transmission  # noqa: E402
from directions import at_cosine, dot, half_vector, mirror, per_channel, reflect, rotate_z, sample_uniform_hemisphere  # noqa: E402
from quadrature import Interpolated, cosine_average, gauss, hemisphere  # noqa: E402

MAX_Z = 4.56
QUADRATURE = 1e-6  # 32 nodes of the half vectors' quadrature against 96: 4e-8; interpolation: 3e-7
ROUNDING = 1e-12
WHITE = np.ones(3)
ROUGHNESSES = (0.1, 0.3, 0.5, 1.0)
COSINES = np.array([1, 0.7, 0.5, 0.2, 0.05, 0.01])


def random(n, columns=3, seed=1):
    return np.random.default_rng(seed).random((n, columns))


def random_directions(n, seed):
    """Uniform on the upper side, but for the last thousandth at the horizon."""
    u = random(n, 2, seed)
    u[:, 0] = 1e-3 + (1 - 1e-3) * u[:, 0]
    return sample_uniform_hemisphere(u)


def integrate_reflection(eval_lobes, mu, ax, ay=None, phi=0.0, n=48):
    """The integral over the upper side of eval_lobes(v, l), for v of the cosines mu."""
    v = at_cosine(mu, phi)
    l, w = ggx.reflection_nodes(v, ax, ax if ay is None else ay, n, n)
    return np.sum(eval_lobes(v[..., None, :], l) * per_channel(w), axis=-2)


class OracleTestCase(unittest.TestCase):
    def assert_near(self, value, expected, tolerance):
        error = np.max(np.abs(np.asarray(value, float) - expected))
        self.assertFalse(np.isnan(error))
        self.assertLessEqual(error, tolerance, f"{value} != {expected}")

    def assert_at_most(self, value, bound):
        self.assertTrue(np.all(np.asarray(value) <= bound), f"{np.max(value)} > {bound}")

    def assert_mean(self, samples, expected):
        """samples (n,) or (n, k) have the expected mean within the statistical bound."""
        samples = np.asarray(samples, float)
        error = np.std(samples, axis=0, ddof=1) / math.sqrt(len(samples))
        self.assertTrue(np.all(error > 0))
        z = (np.mean(samples, axis=0) - expected) / error
        self.assertTrue(np.all(np.abs(z) <= MAX_Z), f"z = {z}")


class QuadratureTest(OracleTestCase):
    def test_hemisphere(self):
        l, w = hemisphere()
        self.assert_near(w.sum(), 2 * np.pi, ROUNDING * 10)
        self.assert_near(w @ (l[:, 2:] * l), [0, 0, 2 * np.pi / 3], ROUNDING * 10)

    def test_cosine_average_of_a_power(self):
        self.assert_near(cosine_average(lambda mu: mu**3), 2 / 5, ROUNDING)

    def test_half_vectors_hold_the_hemisphere(self):
        # At alpha 1 these nodes suit functions without peaks.
        self.assert_near(integrate_reflection(lambda v, l: per_channel(l[..., 2]), COSINES[:5], 1.0), np.pi, ROUNDING * 10)


class FresnelTest(OracleTestCase):
    def test_known_values(self):
        self.assert_near(fresnel.dielectric(1.0, 1.5), 0.04, ROUNDING)
        self.assert_near(fresnel.dielectric(1.0, 1 / 1.5), 0.04, ROUNDING)
        self.assert_near(fresnel.dielectric(0.0, 1.5), 1, ROUNDING)
        brewster = math.cos(math.atan(1.5))  # there the parallel part vanishes
        self.assert_near(fresnel.dielectric(brewster, 1.5), ((1.5**2 - 1) / (1.5**2 + 1)) ** 2 / 2, ROUNDING)
        self.assert_near(fresnel.schlick(0.5, 0.04), 0.07, ROUNDING)

    def test_total_internal_reflection(self):
        critical = math.sqrt(1 - 1 / 1.5**2)
        self.assertEqual(fresnel.dielectric(critical - 1e-6, 1 / 1.5), 1)
        self.assertLess(fresnel.dielectric(critical + 1e-2, 1 / 1.5), 0.7)

    def test_index_one_reflects_nothing(self):
        self.assert_near(fresnel.dielectric(COSINES, 1.0), 0, ROUNDING)
        self.assert_near(fresnel.specular_f0(1.0, 1.0, WHITE)[0], 0, ROUNDING)

    def test_both_sides_agree_by_snell(self):
        cos_t = np.sqrt(1 - (1 - COSINES**2) / 1.5**2)
        self.assert_near(fresnel.dielectric(COSINES, 1.5), fresnel.dielectric(cos_t, 1 / 1.5), ROUNDING)

    def test_average(self):
        self.assert_near(cosine_average(lambda mu: fresnel.schlick(mu, 0.3, 0.8)), fresnel.schlick_average(0.3, 0.8), ROUNDING)

    def test_ior_of_f0(self):
        self.assert_near(fresnel.f0_of_ior(fresnel.ior_of_f0(0.3)), 0.3, ROUNDING)


class GgxTest(OracleTestCase):
    def test_projected_normals_have_area_one(self):
        l, w = hemisphere(96, 128)
        for ax, ay in ((0.3, 0.3), (1.0, 0.4)):
            self.assert_near(w @ (ggx.D(l, ax, ay) * l[:, 2]), 1, ROUNDING)

    def test_masked_projection_is_that_of_the_surface(self):
        # int G1 max(vh, 0) D dh = nv (Heitz 2014), hence D_v has the integral 1.
        for alpha in (0.01, 0.3, 1.0):
            for mu in (1.0, 0.5, 0.05):
                v = at_cosine(mu, 0.4)
                total = 0
                for below in (False, True):
                    h, w = ggx.half_vector_nodes(v, alpha, 0.5 * alpha, 64, 64, below)
                    total += np.sum(w * ggx.D_v(v, h, alpha, 0.5 * alpha) / (ggx.D(h, alpha, 0.5 * alpha) * h[:, 2]))
                self.assert_near(total, 1, ROUNDING)

    def test_V_is_G_over_cosines(self):
        v, l = random_directions(1000, 1), random_directions(1000, 2)
        expected = ggx.G(v, l, 0.5, 0.2) / (4 * v[:, 2] * l[:, 2])
        self.assert_near(ggx.V(v, l, 0.5, 0.2) / expected, 1, ROUNDING)

    def test_isotropic_forms_of_the_appendix(self):
        v, l = random_directions(1000, 1), random_directions(1000, 2)
        a, nv, nl, nh = 0.3, v[:, 2], l[:, 2], half_vector(v, l)[:, 2]
        self.assert_near(ggx.D(half_vector(v, l), a, a), a**2 / (np.pi * (nh**2 * (a**2 - 1) + 1) ** 2), ROUNDING)
        lengths = nl * np.sqrt(nv**2 * (1 - a**2) + a**2) + nv * np.sqrt(nl**2 * (1 - a**2) + a**2)
        self.assert_near(ggx.V(v, l, a, a) * lengths, 0.5, ROUNDING)

    def test_pdf_integrates_to_one_minus_the_share_below_the_horizon(self):
        for ax, ay in ((0.1, 0.1), (0.5, 0.2), (1.0, 1.0)):
            for mu in (1.0, 0.3, 0.05):
                v = at_cosine(mu, 1.0)
                l, w = ggx.reflection_nodes(v, ax, ay, 64, 64)
                share = np.sum(w * ggx.pdf(v, l, ax, ay))
                h, w = ggx.half_vector_nodes(v, ax, ay, 64, 64, below=True)
                below = np.sum(w * ggx.D_v(v, h, ax, ay) / (ggx.D(h, ax, ay) * h[:, 2]))
                self.assert_near(share + below, 1, ROUNDING)
                drawn = ggx.sample(v, ax, ay, random(20000, 2))[:, 2] <= 0
                if below > 1e-3:
                    self.assert_mean(drawn, below)

    def test_samples_follow_D_v(self):
        for ax, ay in ((0.1, 0.4), (1.0, 1.0)):
            for mu in (1.0, 0.3, 0.02):
                v = at_cosine(mu, 0.7)
                h = ggx.sample_D_v(v, ax, ay, random(40000, 2))
                expected = 0
                for below in (False, True):
                    nodes, w = ggx.half_vector_nodes(v, ax, ay, 64, 64, below)
                    w = w * ggx.D_v(v, nodes, ax, ay) / (ggx.D(nodes, ax, ay) * nodes[:, 2])
                    expected = expected + w @ np.concatenate([nodes, nodes**2], axis=-1)
                self.assert_mean(np.concatenate([h, h**2], axis=-1), expected)

    def test_weight_is_eval_over_pdf(self):
        v = at_cosine(0.3, 0.7)
        l = ggx.sample(v, 0.5, 0.2, random(1000, 2))
        l = l[l[:, 2] > 1e-3]
        weight = (1 + ggx.Lambda(v, 0.5, 0.2)) / (1 + ggx.Lambda(v, 0.5, 0.2) + ggx.Lambda(l, 0.5, 0.2))
        self.assert_near(ggx.eval(v, l, 0.5, 0.2) / ggx.pdf(v, l, 0.5, 0.2), weight, ROUNDING)
        self.assert_at_most(weight, 1)

    def test_sampled_albedo_is_quadrature(self):
        for roughness in (0.1, 0.5, 1.0):
            for mu in (0.7, 0.05):
                v, alpha = at_cosine(mu), roughness**2
                h = ggx.sample_D_v(v, alpha, alpha, random(20000, 2))
                l = reflect(v, h)
                weight = np.where(l[:, 2] > 0, ggx.G(v, l, alpha, alpha) / ggx.G1(v, alpha, alpha), 0)
                s = fresnel.schlick_weight(dot(v, h))
                self.assert_mean(np.stack([weight * (1 - s), weight * s], axis=-1), ggx.directional_albedo(v, alpha, alpha))

    def test_albedo_converged(self):
        for alpha in (ggx.MIN_ALPHA, 0.01, 0.09, 1.0):
            v = at_cosine(COSINES)
            self.assert_near(ggx.directional_albedo(v, alpha, alpha), ggx.directional_albedo(v, alpha, alpha, 96, 96), QUADRATURE)

    def test_curves_interpolate_quadrature(self):
        mu = random(50, 1)[:, 0] ** 3
        for alpha in (ggx.MIN_ALPHA, 0.01, 0.25, 1.0):
            curves = ggx.albedo_curves(alpha)
            exact = ggx.directional_albedo(at_cosine(mu), alpha, alpha)
            self.assert_near([curves.A(mu), curves.B(mu)], exact, QUADRATURE)

    def test_albedo_of_a_mirror_is_schlick(self):
        curves = ggx.albedo_curves(0.0)
        self.assert_near(0.04 * curves.A(COSINES) + curves.B(COSINES), fresnel.schlick(COSINES, 0.04), ROUNDING)
        self.assert_near(curves.E1_avg, 1, ROUNDING)

    def test_albedo_in_other_coordinates(self):
        l, w = hemisphere(128, 128)
        for alpha in (0.25, 1.0):
            for mu in (0.9, 0.3):
                v = at_cosine(mu)
                self.assert_near(w @ ggx.eval(v, l, alpha, alpha), ggx.albedo_curves(alpha).E1(mu), 2e-6)  # hemisphere: 1e-6


def appendix_mix(v, l, base, f0, alpha):
    """The literal dielectric of glTF 2.0, appendix B: mix(diffuse, specular, F(v.h)), the diffuse part alone, times nl."""
    f = fresnel.schlick(dot(v, half_vector(v, l)), f0)
    return base * (1 - f) / np.pi * l[..., 2]


class CoreTest(OracleTestCase):
    def test_appendix_mix_creates_energy(self):
        # Measured elsewhere: directional albedo of a white base of F0 .04 at mu 1, .5, .2 and .05.
        table = {0.1: (1.000, 1.025, 1.297, 1.680), 0.3: (1.000, 1.025, 1.198, 1.327), 0.5: (0.997, 1.011, 1.074, 1.132),
                 0.7: (0.988, 0.993, 1.018, 1.047), 1.0: (0.972, 0.976, 0.984, 1.001)}
        v = at_cosine(np.array([1, 0.5, 0.2, 0.05]))
        l, w = hemisphere()
        diffuse = appendix_mix(v[:, None], l, 1, 0.04, 1) @ w
        for roughness, expected in table.items():
            a, b = ggx.directional_albedo(v, roughness**2, roughness**2)
            self.assert_near(0.04 * a + b + diffuse, expected, 6e-4)

    def test_ggx_part_alone(self):
        table = {0.1: (0.040, 0.070, 0.352, 0.743), 0.5: (0.037, 0.056, 0.128, 0.195), 1.0: (0.012, 0.021, 0.039, 0.065)}
        for roughness, expected in table.items():
            a, b = ggx.directional_albedo(at_cosine(np.array([1, 0.5, 0.2, 0.05])), roughness**2, roughness**2)
            self.assert_near(0.04 * a + b, expected, 6e-4)

    def test_error_of_a_table_of_32(self):
        # Measured elsewhere: rms 1.8e-3 in E1, bilinear in sqrt(mu) and roughness; it depends on the points of comparison, hence 20 %.
        axis = np.linspace(0, 1, 32)
        mu = np.maximum(axis, 1e-4) ** 2
        table = np.array([np.sum(ggx.directional_albedo(at_cosine(mu), r * r, r * r), axis=0) for r in axis])
        u = random(400, 2)
        errors = []
        for x, r in u:
            i, j = min(int(x * 31), 30), min(int(r * 31), 30)
            s, t = x * 31 - i, r * 31 - j
            value = (1 - t) * ((1 - s) * table[j, i] + s * table[j, i + 1]) + t * ((1 - s) * table[j + 1, i] + s * table[j + 1, i + 1])
            errors.append(value - np.sum(ggx.directional_albedo(at_cosine(x * x), r * r, r * r)))
        self.assert_near(np.sqrt(np.mean(np.square(errors))), 1.8e-3, 0.36e-3)

    def test_merged_lobe_is_the_mix(self):
        base, m = np.array([0.9, 0.5, 0.1]), 0.3
        v, l = random_directions(1000, 1), random_directions(1000, 2)
        lobes = core.metallic_roughness(base, m, 0.4, 1.7, 0.6, (1, 0.5, 2), 0.5)
        cosine = per_channel(dot(v, half_vector(v, l)))
        plastic = fresnel.schlick(cosine, (0.7 / 2.7) ** 2 * np.array([1, 0.5, 2]) * 0.6, 0.6)
        f = (1 - m) * plastic + m * fresnel.schlick(cosine, base)
        self.assert_near(core.eval_single_scattering(v, l, lobes), f * per_channel(ggx.eval(v, l, 0.16 + 0.84 * 0.25, 0.16)), ROUNDING)
        self.assert_near(lobes.diffuse, (1 - m) * base, ROUNDING)

    def test_white_furnaces_are_exactly_one(self):
        for roughness in ROUGHNESSES:
            for lobes in (core.metallic_roughness(WHITE, 0, roughness), core.metallic_roughness(WHITE, 1, roughness),
                          core.metallic_roughness(WHITE, 0, roughness, ior=2.4, specular=0.5)):
                ggx_part = integrate_reflection(lambda v, l: core.eval_single_scattering(v, l, lobes), COSINES, roughness**2)
                cosine_part = integrate_reflection(
                    lambda v, l: core.eval_multiple_scattering(v, l, lobes) + core.eval_diffuse(v, l, lobes), COSINES, 1.0)
                self.assert_near(ggx_part + cosine_part, 1, QUADRATURE)

    def test_multiple_scattering_is_the_sum_of_bounces(self):
        # A path of k + 1 reflections takes Fresnel's average k + 1 times; 1 - E1_avg stays inside at each bounce.
        curves, f0, f90 = ggx.albedo_curves(1.0), np.array([0.9, 0.5, 0.04]), 0.8
        f_avg, inside = fresnel.schlick_average(f0, f90), 1 - curves.E1_avg
        series = sum(f_avg ** (k + 1) * inside ** (k - 1) * curves.E1_avg for k in range(1, 200))
        self.assert_near(core.multiple_scattering_fresnel(curves, f0, f90), series, ROUNDING)
        lobes = core.Lobes(1.0, 1.0, f0, f90, np.zeros(3), 0.0, 0.0)
        total = integrate_reflection(lambda v, l: core.eval(v, l, lobes), COSINES, 1.0)
        self.assert_near(total, core.specular_albedo(COSINES, curves, f0, f90), QUADRATURE)
        average = [cosine_average(lambda mu: core.specular_albedo(mu, curves, f, f90)[..., 0]) for f in f0]
        self.assert_near(core.specular_albedo_average(curves, f0, f90), average, ROUNDING)

    def test_energy_of_random_materials(self):
        rng = np.random.default_rng(3)
        for _ in range(30):
            base, color = rng.random(3), rng.random(3)
            m, r, ior, specular = rng.random(), 0.15 + 0.85 * rng.random(), 1 + 1.5 * rng.random(), rng.random()
            lobes = core.metallic_roughness(base, m, r, ior, specular, color)
            total = integrate_reflection(lambda v, l: core.eval(v, l, lobes), np.array([0.9, 0.3, 0.05]), r * r)
            self.assert_at_most(total, 1 + QUADRATURE)
            plastic = core.metallic_roughness(base, 0, r, ior, specular, color)
            ed = core.interface_albedo(np.array([0.9, 0.3, 0.05]), plastic)[:, None]
            metal = core.specular_albedo(np.array([0.9, 0.3, 0.05]), lobes.curves, base, 1.0)
            self.assert_at_most(total, (1 - m) * (ed + (1 - ed) * base) + m * metal + QUADRATURE)

    def test_reciprocal(self):
        v, l = random_directions(2000, 4), random_directions(2000, 5)
        for lobes in (core.metallic_roughness((0.9, 0.5, 0.1), 0.3, 0.4, anisotropy=0.7, rotation=0.8),
                      core.specular_glossiness((0.5, 0.6, 0.7), (0.2, 0.1, 0.3), 0.6)):
            forth, back = core.eval(v, l, lobes) / l[:, 2:], core.eval(l, v, lobes) / v[:, 2:]
            self.assert_near(forth / back, 1, ROUNDING)

    def test_sampled_albedo_is_quadrature(self):
        for lobes in (core.metallic_roughness((0.9, 0.5, 0.1), 0.3, 0.5),
                      core.metallic_roughness((1, 0.8, 0.1), 1, 0.7, anisotropy=0.5, rotation=1.0)):
            for mu in (0.8, 0.1):
                v = at_cosine(mu)
                l = core.sample(v, lobes, random(20000))
                upper = l[:, 2] > 0
                weight = core.eval(v, l, lobes) / per_channel(np.where(upper, core.pdf(v, l, lobes), 1))
                exact = integrate_reflection(lambda v, l: core.eval(v, l, lobes), mu, 1.0, n=96)
                self.assert_mean(weight, exact)

    def test_pdf_integrates_to_the_share_above(self):
        lobes = core.metallic_roughness((0.9, 0.5, 0.1), 0.3, 0.7, anisotropy=0.3, rotation=0.5)
        for mu in (0.9, 0.1):
            v = at_cosine(mu)
            share = integrate_reflection(lambda v, l: per_channel(core.pdf(v, l, lobes)), mu, 1.0, n=96)
            self.assert_mean(core.sample(v, lobes, random(20000))[:, 2] > 0, share[0])

    def test_probability(self):
        v = at_cosine(np.array([0.9, 0.01]))
        self.assert_near(core.specular_probability(v, core.metallic_roughness(WHITE, 1)), 1, 0)
        self.assert_near(core.specular_probability(v, core.metallic_roughness(WHITE, specular=0)), 0, 0)
        self.assert_near(core.specular_probability(at_cosine(1.0), core.metallic_roughness(WHITE, ior=1.01)), core.MIN_PROBABILITY, 0)
        lobes = core.metallic_roughness(WHITE, roughness=0.3)
        self.assert_near(core.specular_probability(v, lobes), core.interface_albedo(v[:, 2], lobes), ROUNDING)

    def test_ior_limits(self):
        v, l = random_directions(100, 1), random_directions(100, 2)
        mirror_like = core.metallic_roughness((0.5, 0.5, 0.5), ior=0, roughness=0.5)
        self.assert_near(mirror_like.f0, 1, 0)
        self.assert_near(core.eval_diffuse(v, l, mirror_like), 0, 0)
        self.assert_near(integrate_reflection(lambda v, l: core.eval(v, l, mirror_like), 0.5, 0.25), 1, QUADRATURE)
        bare = core.metallic_roughness((0.5, 0.6, 0.7), ior=1, specular=0, roughness=0.5)
        self.assert_near(core.eval(v, l, bare), np.array([0.5, 0.6, 0.7]) / np.pi * l[:, 2:], ROUNDING)

    def test_specular(self):
        f0, f90 = fresnel.specular_f0(1.5, 0.5, (1, 2, 30))
        self.assert_near(f0, [0.02, 0.04, 0.5], ROUNDING)
        self.assertEqual(f90, 0.5)

    def test_specular_glossiness(self):
        lobes = core.specular_glossiness((0.5, 0.6, 0.7), (0.2, 0.1, 0.4), 0.7)
        self.assert_near(lobes.alpha_x, 0.09, ROUNDING)
        self.assert_near(lobes.f0, [0.2, 0.1, 0.4], 0)
        self.assert_near(lobes.diffuse, [0.3, 0.36, 0.42], ROUNDING)
        total = integrate_reflection(lambda v, l: core.eval(v, l, core.specular_glossiness(WHITE, (0.3, 0.3, 0.3), 0.3)), COSINES[:5], 0.49)
        self.assert_at_most(total, 1)


class AnisotropyTest(OracleTestCase):
    def test_albedo_and_its_isotropic_equivalents(self):
        ax, ay = core.anisotropic_alpha(0.3, 1.0)
        self.assert_near(np.sum(ggx.directional_albedo(at_cosine(1.0), ax, ay)), 0.530, 6e-4)
        self.assert_near(ggx.albedo_curves(math.sqrt((ax * ax + ay * ay) / 2)).E1(1.0), 0.496, 6e-4)
        self.assert_near(ggx.albedo_curves(math.sqrt(ax * ay)).E1(1.0), 0.877, 6e-4)

    def test_curves_interpolate_quadrature(self):
        v = random_directions(300, 3)
        for roughness, strength in ((0.3, 1.0), (0.7, 0.4)):
            lobes = core.metallic_roughness(WHITE, 1, roughness, anisotropy=strength)
            exact = ggx.directional_albedo(v, lobes.alpha_x, lobes.alpha_y, 192, 32)
            self.assert_near([lobes.curves.A(v), lobes.curves.B(v)], exact, 2e-4)  # 96 nodes of the azimuth against 192

    def test_furnace_over_azimuth(self):
        # Measured elsewhere: E from .52 to .79 at mu .2. By the albedo of the mean square of the alphas it was .71 to 1.06 in the furnace.
        mu, phi = np.array([[1], [0.7], [0.5], [0.35], [0.2], [0.1], [0.05]]), np.linspace(0, np.pi / 2, 7)
        lobes = core.metallic_roughness(WHITE, 1, 0.3, anisotropy=1.0, rotation=0.4)
        e = np.sum(ggx.directional_albedo(at_cosine(mu, phi), lobes.alpha_x, lobes.alpha_y, 192, 32), axis=0)
        half_a_digit = 7e-3  # of printed numbers with two
        self.assert_near((e[4].min(), e[4].max()), (0.52, 0.79), half_a_digit)
        l, w = hemisphere(32, 64)
        for i, j in np.ndindex(e.shape):
            v = at_cosine(mu[i, 0], phi[j] + lobes.rotation)
            more = w @ core.eval_multiple_scattering(v, l, lobes)[:, 0]
            self.assert_near(e[i, j] + more, 1, 5e-4)  # 32 nodes against 64: 2e-4

    def test_rotation(self):
        v, l = random_directions(100, 1), random_directions(100, 2)
        straight = core.metallic_roughness(WHITE, 1, 0.3, anisotropy=0.6)
        turned = core.metallic_roughness(WHITE, 1, 0.3, anisotropy=0.6, rotation=0.7)
        self.assert_near(core.eval(rotate_z(v, 0.7), rotate_z(l, 0.7), turned), core.eval(v, l, straight), ROUNDING)
        self.assertGreater(np.max(np.abs(core.eval(v, l, turned) - core.eval(v, l, straight))), 0.1)

    def test_strength_zero_is_isotropic(self):
        self.assertEqual(core.anisotropic_alpha(0.3, 0.0), (0.09, 0.09))
        self.assertEqual(core.anisotropic_alpha(0.3, 1.0)[0], 1)


class ClearcoatTest(OracleTestCase):
    def furnace(self, lobes, factor, roughness, coupling, mu=COSINES):
        alpha = roughness**2
        coat = integrate_reflection(lambda v, l: per_channel(clearcoat.eval_coat(v, l, factor, roughness)), mu, alpha)

        def eval_base(v, l):
            return core.eval(v, l, lobes) * per_channel(clearcoat.base_factor(v, l, factor, roughness, coupling))

        return coat + integrate_reflection(eval_base, mu, lobes.alpha_x, n=64)

    def test_conserves_energy(self):
        for roughness in (0.1, 0.5):
            for metallic in (0, 1):
                lobes = core.metallic_roughness(WHITE, metallic, 0.7)
                self.assert_near(self.furnace(lobes, 0.8, roughness, "view", COSINES[:5]), 1, QUADRATURE)

    def test_product_over_diffuse_is_one_and_reciprocal(self):
        lobes = core.metallic_roughness(WHITE, 0, 1.0, specular=0)
        self.assert_near(self.furnace(lobes, 0.8, 0.3, "product", COSINES[:5]), 1, QUADRATURE)
        v, l = random_directions(1000, 1), random_directions(1000, 2)
        forth = clearcoat.eval(v, l, core.eval(v, l, lobes), 0.8, 0.3, "product") / l[:, 2:]
        back = clearcoat.eval(l, v, core.eval(l, v, lobes), 0.8, 0.3, "product") / v[:, 2:]
        self.assert_near(forth / back, 1, ROUNDING)

    def test_product_over_a_smooth_metal_creates_energy(self):
        # (1 - F0)^2 / (1 - Ec_avg) at normal incidence over a base that is nearly a mirror.
        lobes = core.metallic_roughness(WHITE, 1, 0.2)
        curves = ggx.albedo_curves(0.09)
        passed, average = 1 - clearcoat.coat_albedo(1.0, 0.3), 1 - (0.04 * curves.A_avg + curves.B_avg)
        expected = 1 - passed + passed**2 / average
        self.assertGreater(expected, 1.03)
        self.assert_near(self.furnace(lobes, 1.0, 0.3, "product", 1.0), expected, 3e-3)  # the base's lobe spreads over alpha = .04

    def test_factor_zero_is_no_coat(self):
        v, l = random_directions(100, 1), random_directions(100, 2)
        base = core.eval(v, l, core.metallic_roughness((0.9, 0.5, 0.1)))
        for coupling in ("view", "product"):
            self.assert_near(clearcoat.eval(v, l, base, 0.0, 0.3, coupling), base, 0)

    def test_smooth_coat(self):
        self.assert_near(clearcoat.coat_albedo(COSINES, 0.0), fresnel.schlick(COSINES, 0.04), ROUNDING)

    def test_weight_is_at_most_fresnel(self):
        v = at_cosine(0.3)
        l = ggx.sample(v, 0.25, 0.25, random(1000, 2))
        l = l[l[:, 2] > 0]
        weight = clearcoat.eval_coat(v, l, 1.0, 0.5) / clearcoat.pdf(v, l, 0.5)
        f = fresnel.schlick(dot(v, half_vector(v, l)), 0.04)
        self.assert_near(weight, f * ggx.G(v, l, 0.25, 0.25) / ggx.G1(v, 0.25, 0.25), ROUNDING)


class SheenTest(OracleTestCase):
    def test_charlie_normals_have_area_one(self):
        l, w = hemisphere(128, 8)
        for alpha in (0.04, 0.25, 1.0):
            self.assert_near(w @ (sheen.D(l, alpha) * l[:, 2]), 1, 1e-6)  # the root in sin at alpha 1: 6e-7

    def test_lobe_creates_energy(self):
        # Measured elsewhere, at mu .05 and .02.
        for roughness, expected in ((0.07, (1.08, 2.00)), (0.1, (1.03, 1.63)), (0.2, (0.81, 1.05))):
            self.assert_near(sheen.directional_albedo(np.array([0.05, 0.02]), roughness), expected, 6e-3)
        for roughness in (0.3, 0.5, 0.7, 0.9):
            self.assert_at_most(sheen.directional_albedo(np.array([1, 0.3, 0.1, 0.05]), roughness), 0.85)
        self.assert_near(sheen.directional_albedo(np.array([0.02]), 1.0), 0.915, 6e-4)

    def test_albedo_converged_and_interpolated(self):
        mu = np.concatenate([COSINES, [1e-3]])
        for roughness in (0.07, 0.3, 1.0):
            exact = sheen.directional_albedo(mu, roughness, 96, 96)
            self.assert_near(sheen.directional_albedo(mu, roughness), exact, 1e-5)
            self.assert_near(sheen.albedo_curve(roughness)(mu), exact, 1e-5)

    def test_conserves_energy_over_a_white_base(self):
        l, w = sheen.nodes(64, 64)
        lobes = core.metallic_roughness(WHITE, 0, 1.0, specular=0)
        for roughness in (0.07, 0.2, 0.5, 1.0):
            for color in (WHITE, np.array([0.2, 1, 0.5])):
                v = at_cosine(np.array([1, 0.3, 0.05, 0.02]))[:, None]
                lobe = sheen.eval(v, l, color, roughness)
                total = np.einsum("vlc,l->vc", sheen.eval_layered(v, l, core.eval(v, l, lobes), color, roughness), w)
                self.assert_at_most(np.einsum("vlc,l->vc", lobe, w), 1 + 1e-5)  # interpolation: 4e-6
                self.assert_at_most(total, 1 + 1e-5)
                self.assertGreater(np.max(total), 0.9)

    def test_reciprocal(self):
        v, l = random_directions(1000, 1), random_directions(1000, 2)
        lobes = core.metallic_roughness((0.5, 0.6, 0.7))
        forth, back = (sheen.eval_layered(a, b, core.eval(a, b, lobes), (0.9, 0.5, 0.2), 0.1) / b[:, 2:] for a, b in ((v, l), (l, v)))
        self.assert_near(forth - back, 0, ROUNDING * np.max(forth))

    def test_lambda_is_smooth_at_half(self):
        for alpha in (0.01, 1.0):
            step = np.array([0.5 - 1e-6, 0.5 + 1e-6])
            below, above = sheen.Lambda(step, alpha)
            self.assert_near(above / below, 1, 1e-5)  # the slope times the step: 7e-6

    def test_weight_of_uniform_samples_is_bounded(self):
        roughness, v, l = 0.3, at_cosine(0.2), sample_uniform_hemisphere(random(20000, 2))
        alpha = roughness**2
        weight = sheen.eval_unscaled(v, l, roughness) / sheen.pdf(l)
        self.assert_at_most(weight, (2 + 1 / alpha) / (4 * v[2] * (1 + sheen.Lambda(v[2], alpha))))
        self.assert_mean(weight, sheen.directional_albedo(np.array([0.2]), roughness)[0])

    def test_left_out_below_the_least_roughness(self):
        v, l = random_directions(10, 1), random_directions(10, 2)
        base = core.eval(v, l, core.metallic_roughness(WHITE))
        self.assert_near(sheen.eval_layered(v, l, base, WHITE, 0.005), base, 0)
        self.assert_near(sheen.eval_layered(v, l, base, np.zeros(3), 0.5), base, 0)


class IridescenceTest(OracleTestCase):
    def test_no_thickness_is_schlick(self):
        # R12 is 0 at normal incidence, and with it all that the film adds.
        self.assert_near(iridescence.film(np.array([1.0]), 1.3, 0.0, (0.04, 0.2, 0.9)), [[0.04, 0.2, 0.9]], ROUNDING)

    def test_factor_zero_is_schlick(self):
        plain = fresnel.schlick(per_channel(COSINES), np.array([0.04, 0.2, 0.9]))
        self.assert_near(iridescence.fresnel(COSINES, 0.0, 1.3, 400.0, (0.04, 0.2, 0.9)), plain, 0)

    def test_thick_film_is_the_incoherent_sum(self):
        r12, r23, *_ = iridescence.interfaces(0.8, 1.3, 1e6, (0.04, 0.2, 0.9))
        self.assert_near(iridescence.film(0.8, 1.3, 1e6, (0.04, 0.2, 0.9)), r12 + (1 - r12) ** 2 * r23 / (1 - r12 * r23), ROUNDING)

    def test_total_reflection(self):
        self.assert_near(iridescence.film(np.array([0.1]), 0.5, 400.0, (0.04, 0.04, 0.04)), 1, 0)

    def test_sum_of_amplitudes_is_the_equal_energy_white(self):
        self.assert_near(np.linalg.solve(iridescence.XYZ_TO_REC709, iridescence.sensitivity(0.0, np.zeros(3))), 1, 2e-3)  # the fits' digits

    def test_phase_is_the_sign_of_the_amplitudes(self):
        for ior in (0.8, 1.3, 1.6):
            for f0 in (0.01, 0.04, 0.2):
                base_ior = fresnel.ior_of_f0(f0)
                _, _, _, shift, _ = iridescence.interfaces(1.0, ior, 400.0, np.full(3, f0))
                self.assert_near(np.cos(shift), np.sign((ior - 1) * (ior - base_ior)), ROUNDING)

    def test_matrix_holds_the_primaries_and_white_of_rec_709(self):
        primaries = np.array([[0.64, 0.33, 0.03], [0.30, 0.60, 0.10], [0.15, 0.06, 0.79]]).T
        channels = iridescence.XYZ_TO_REC709 @ primaries
        self.assert_near(channels - np.diag(np.diag(channels)), 0, 1e-4)  # the white point's digits
        self.assert_near(iridescence.XYZ_TO_REC709 @ [0.95047, 1, 1.08883], 1, 1e-4)

    def test_fits_lie_at_the_maxima_of_the_color_matching_functions(self):
        # CIE 1931: x at 599 and 442 nm, y at 555, z at 446; the fit of an asymmetric function lies beside its maximum.
        self.assert_near(1e9 / iridescence.WAVENUMBER, [599, 555, 446, 442], 8)

    def test_spectral_integral(self):
        # The exact Airy reflectance, integrated over Gaussians in wavenumber whose transform is the sensitivity. The sum up to m = 2
        # misses 2 sum_{m > 2} |Rs - T| r123^m, times the amplitude of a channel, at most that of the sum of |matrix elements|.
        base_f0, ior, cosine = np.full(3, 0.2), 1.6, 0.7
        gain = np.max(np.sum(np.abs(iridescence.XYZ_TO_REC709), axis=1))
        x, w = gauss(400, -8, 8)
        for thickness in (150.0, 400.0, 700.0):
            r12, r23, opd, shift, _ = iridescence.interfaces(cosine, ior, thickness, base_f0)
            r12, r23, shift = r12[0], r23[0], shift[0]
            k = iridescence.WAVENUMBER[:, None] + x * np.sqrt(2 * iridescence.VARIANCE)[:, None]
            density = np.exp(-x**2 / 2) / np.sqrt(2 * np.pi) * (iridescence.AMPLITUDE * np.sqrt(2 * np.pi * iridescence.VARIANCE))[:, None]
            r = np.sqrt(r12 * r23)
            wave = r * np.exp(1j * (2 * np.pi * k * opd * 1e-9 + shift))
            once = (1 - r12) ** 2 * r23 / (1 - r12 * r23)
            oscillation = (once - (1 - r12)) * 2 * np.real(wave / (1 - wave))
            bands = (density * oscillation) @ w / iridescence.NORMALIZATION
            expected = r12 + once + iridescence.XYZ_TO_REC709 @ (bands[:3] + bands[3] * np.array([1, 0, 0]))
            missing = 2 * gain * abs(once - (1 - r12)) * r**3 / (1 - r)
            self.assertLess(missing, 0.05)
            self.assert_near(iridescence.film(cosine, ior, thickness, base_f0), np.clip(expected, 0, 1), missing)
            self.assertGreater(np.max(np.abs(expected - r12 - once)), missing)

    def test_airy_sum_is_that_of_amplitudes(self):
        # The form with Rs and T that test_spectral_integral takes, against |r12 + t12 t21 r23 e^{i phi} / (1 - r21 r23 e^{i phi})|^2.
        r12, r23 = 0.1, 0.3
        for phi in (0.3, 2.0, 3.0):
            wave = -math.sqrt(r12 * r23) * np.exp(1j * phi)  # r21 = -r12
            amplitude = math.sqrt(r12) + (1 - r12) * math.sqrt(r23) * np.exp(1j * phi) / (1 - wave)
            once = (1 - r12) ** 2 * r23 / (1 - r12 * r23)
            self.assert_near(r12 + once + (once - (1 - r12)) * 2 * np.real(wave / (1 - wave)), abs(amplitude) ** 2, ROUNDING)

    def test_between_zero_and_one(self):
        mu = np.linspace(0.01, 1, 50)
        for thickness in (50.0, 400.0, 900.0):
            for f0 in ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (0.9, 0.5, 0.1)):
                f = iridescence.film(mu, 1.3, thickness, f0)
                self.assertTrue(np.all((f >= 0) & (f <= 1)))

    def test_eval(self):
        v, l = random_directions(100, 1), random_directions(100, 2)
        lobes = core.metallic_roughness((0.9, 0.5, 0.1), 1, 0.5)
        self.assert_near(iridescence.eval(v, l, 0.25, 0.25, 0.0, 1.3, 400.0, lobes.f0), core.eval_single_scattering(v, l, lobes), ROUNDING)
        forth = iridescence.eval(v, l, 0.25, 0.25, 0.7, 1.3, 400.0, lobes.f0) / l[:, 2:]
        back = iridescence.eval(l, v, 0.25, 0.25, 0.7, 1.3, 400.0, lobes.f0) / v[:, 2:]
        self.assert_near(forth / back, 1, ROUNDING)

    def test_equivalent_f0(self):
        mu = np.array([1, 0.5, 0.1])
        f0 = np.array([0.04, 0.2, 0.9])
        self.assert_near(iridescence.equivalent_f0(mu, fresnel.schlick(per_channel(mu), f0, 0.8), 0.8), f0, ROUNDING)
        self.assert_near(iridescence.equivalent_f0(np.array([0.1]), np.zeros((1, 3))), 0, 0)


class TransmissionTest(OracleTestCase):
    def refracted_nodes(self, v, ior, n=96):
        """Nodes and weights over the refracted directions of v: h on the upper side bounds their cosines by |vz|/eta (Walter, eq. 16)."""
        eta = ior if v[2] > 0 else 1 / ior
        edge = min(abs(v[2]) / eta, 1)
        z, w_z = gauss(n, *((edge, 1.0) if eta > 1 else (0.0, edge)))
        phi = (np.arange(2 * n) + 0.5) * np.pi / n
        l = at_cosine(z[:, None], phi).reshape(-1, 3)
        return -np.sign(v[2]) * l, np.repeat(w_z * np.pi / n, 2 * n)

    def test_thin_wall_loses_only_what_single_scattering_does(self):
        for alpha in (0.09, 0.5):
            for mu in (0.9, 0.1):
                v = at_cosine(mu)
                l, w = ggx.reflection_nodes(v, alpha, alpha)
                both = w @ (transmission.eval_thin(v, l, WHITE, alpha, 1.5) + transmission.eval_thin(v, mirror(l), WHITE, alpha, 1.5))
                self.assert_near(both, ggx.albedo_curves(alpha).E1(mu), QUADRATURE)

    def test_thin_wall_samples(self):
        base, alpha, v = np.array([0.9, 0.5, 0.1]), 0.3, at_cosine(0.4)
        l, carries = transmission.sample_thin(v, alpha, 1.5, random(20000))
        nodes, w = ggx.reflection_nodes(v, alpha, alpha, 48, 48)
        both = np.concatenate([nodes, mirror(nodes)]), np.concatenate([w, w])
        self.assert_mean(carries, both[1] @ transmission.pdf_thin(v, both[0], alpha, 1.5))
        l = l[carries]
        weight = transmission.eval_thin(v, l, base, alpha, 1.5) / per_channel(transmission.pdf_thin(v, l, alpha, 1.5))
        upper = np.where(per_channel(l[:, 2] > 0) > 0, l, mirror(l))
        expected = per_channel(ggx.G(v, upper, alpha, alpha) / ggx.G1(v, alpha, alpha)) * np.where(l[:, 2:] > 0, 1, base)
        self.assert_near(weight, expected, ROUNDING)
        share = np.zeros((20000, 3))
        share[: len(weight)] = weight
        self.assert_mean(share, both[1] @ transmission.eval_thin(v, both[0], base, alpha, 1.5))

    def test_refraction_follows_snell(self):
        v, h = random_directions(1000, 1), np.array([0.0, 0.0, 1.0])
        for eta in (1.5, 2.4):
            l = transmission.refract(v, h, eta)
            self.assert_near(dot(l, l), 1, ROUNDING)
            self.assert_near(l[:, :2] * eta, -v[:, :2], ROUNDING)
            self.assertTrue(np.all(l[:, 2] < 0))

    def test_glass_samples_against_quadrature(self):
        for mu in (0.8, 0.2, -0.8, -0.5):
            v = at_cosine(abs(mu)) * np.array([1, 1, np.sign(mu)])
            for alpha in (0.25, 1.0):
                l, carries = transmission.sample_glass(v, alpha, 1.5, random(20000))
                reflected, w_r = hemisphere(96, 96)
                refracted, w_t = self.refracted_nodes(v, 1.5)
                nodes = np.concatenate([np.sign(mu) * reflected, refracted]), np.concatenate([w_r, w_t])
                share = nodes[1] @ transmission.pdf_glass(v, nodes[0], alpha, 1.5)
                self.assert_mean(carries, share)
                density = transmission.pdf_glass(v, l, alpha, 1.5)
                weight = np.where(carries, transmission.eval_glass(v, l, alpha, 1.5) / np.where(carries, density, 1), 0)
                albedo = nodes[1] @ transmission.eval_glass(v, nodes[0], alpha, 1.5)
                self.assert_mean(weight, albedo)
                self.assert_at_most(albedo, 1)
                expected = (ggx.G(v, l, alpha, alpha) / ggx.G1(v, alpha, alpha))[carries]
                self.assert_near(weight[carries], expected, 1e-9)  # h from v and l cancels where they are nearly opposite

    def test_glass_is_reciprocal(self):
        v, l = random_directions(4000, 1), mirror(random_directions(4000, 2))
        forth = transmission.eval_glass(v, l, 0.5, 1.5) / np.abs(l[:, 2]) / 1.5**2
        back = transmission.eval_glass(l, v, 0.5, 1.5) / v[:, 2]
        valid = forth > 0
        self.assertGreater(np.sum(valid), 400)
        self.assert_near(back[~valid], 0, 0)
        self.assert_near(forth[valid] / back[valid], 1, 1e-9)  # h from v and l cancels where they are nearly opposite

    def test_parts_of_glass_are_the_albedo_of_its_samples(self):
        for ior, alpha in ((1.5, 0.25), (1.1, 1.0), (2.4, 0.6)):
            for mu in (0.8, 0.2, -0.8, -0.3):
                t, p, q = transmission.glass_parts([abs(mu)], alpha, ior if mu > 0 else 1 / ior)[:, 0]
                v = at_cosine(abs(mu)) * np.array([1, 1, np.sign(mu)])
                l, carries = transmission.sample_glass(v, alpha, ior, random(20000))
                side = np.sign(mu) * np.array([1, 1, 1])
                weight = np.where(carries, ggx.G(v * side, l * side, alpha, alpha) / ggx.G1(v * side, alpha, alpha), 0)
                self.assert_mean(weight, t + fresnel.f0_of_ior(ior) * p + q)

    def test_glass_with_further_scattering_keeps_all_light_and_is_reciprocal(self):
        alpha, ior = 0.5, 1.5
        f0, x, w = fresnel.f0_of_ior(ior), *(part.ravel() for part in gauss(32))
        curves = {eta: Interpolated(lambda mu, eta=eta: 1 - np.array([1, f0, 1]) @ transmission.glass_parts(mu, alpha, eta), 4, 1e-6)
                  for eta in (ior, 1 / ior)}
        share = transmission.reflected_share(alpha, f0)
        averages = {eta: np.atleast_1d(cosine_average(curve)) for eta, curve in curves.items()}

        def further(v, l, eta):
            return transmission.eval_further(v, l, eta, lambda mu, eta: per_channel(curves[eta](mu)), lambda eta: (averages[eta], share))

        l = at_cosine(x**2)
        for eta in (ior, 1 / ior):
            for mu in (1.0, 0.4, 0.05):
                both = sum(part[:, 0] @ (2 * np.pi * 2 * x * w) for part in further(at_cosine(mu), l, eta))
                self.assert_near(both, curves[eta](np.array([mu]))[0], 2e-4)  # the averages by 64 nodes, this by 32
        v, l = at_cosine(0.3), at_cosine(np.array([0.8]))
        forth, back = further(v, l, ior)[1] / l[:, 2:] / ior**2, further(l[0], v[None], 1 / ior)[1] / v[2]
        self.assert_near(forth / back, 1, ROUNDING)

    def test_glass_of_index_one(self):
        self.assertTrue(transmission.is_pass_through(1.00005))
        self.assertFalse(transmission.is_pass_through(1.001))
        v = at_cosine(0.5)
        l, carries = transmission.sample_glass(v, 0.3, 1.001, random(1000))
        self.assertLess(np.max(np.linalg.norm(l[carries] + v, axis=1)), 0.03)  # (eta - 1) tan of the steepest facet's angle

    def test_diffuse_transmission(self):
        lobes = core.metallic_roughness(WHITE, roughness=0.5)
        l, w = hemisphere()
        for mu in (0.9, 0.1):
            v = at_cosine(mu)
            near = w @ transmission.eval_diffuse(v, l, lobes, 0.3, WHITE)
            far = w @ transmission.eval_diffuse(v, mirror(l), lobes, 0.3, WHITE)
            passed = 1 - core.interface_albedo(mu, lobes)
            self.assert_near(near, 0.7 * passed, QUADRATURE)
            self.assert_near(far, 0.3 * passed, QUADRATURE)
        self.assert_near(w @ transmission.pdf_diffuse(l, 0.3), 0.7, ROUNDING * 10)
        self.assert_near(w @ transmission.pdf_diffuse(mirror(l), 0.3), 0.3, ROUNDING * 10)
        v, l = random_directions(100, 1), random_directions(100, 2)
        self.assert_near(transmission.eval_diffuse(v, l, lobes, 0.0, WHITE), core.eval_diffuse(v, l, lobes), 0)


class MediaTest(OracleTestCase):
    def test_transmittance_is_a_power(self):
        color = np.array([0.9, 0.5, 0.1])
        length = np.array([0.0, 0.3, 2.0, 5.0])
        expected = color ** (length[:, None] / 2)
        self.assert_near(media.transmittance(media.sigma_t(color, 2.0), length), expected, ROUNDING)

    def test_limits(self):
        black = media.sigma_t(np.zeros(3), 1.0)
        self.assertTrue(np.all(np.isfinite(black)))
        self.assert_near(media.transmittance(black, 0.0), 1, 0)
        self.assert_near(media.transmittance(black, 1.0), 0, 1.1e-6)
        self.assert_near(media.transmittance(media.sigma_t(np.array([0.0, 0.5, 1]), math.inf), 1e9), 1, 0)

    def test_dispersion(self):
        # The Abbe number is (nd - 1)/(nF - nC), at 587.6, 486.1 and 656.3 nm; the constants have 4 to 5 digits.
        d, f, c = media.ior_at(np.array([587.6, 486.1, 656.3]), 1.5, 20 / 30)
        self.assert_near(d, 1.5, 1e-5)
        self.assert_near(0.5 / (f - c), 30, 0.03)
        self.assertEqual(media.ior_at(500.0, 1.5, 0.0), 1.5)
        self.assertEqual(media.ior_at(2000.0, 1.05, 20.0), 1)


def half_space_albedo(albedo, cosine):
    """1 - sqrt(1 - albedo) H(cosine), of isotropic scattering: Chandrasekhar, "Radiative Transfer", 1950, chapter 5."""
    x, w = np.polynomial.legendre.leggauss(64)
    mu, root, h = (x + 1) / 2, math.sqrt(1 - albedo), np.ones(64)
    for _ in range(2000):
        h = 1 / (root + albedo / 2 * ((mu * h * w / 2) / (mu[:, None] + mu)).sum(axis=1))
    return 1 - root / (root + albedo / 2 * (mu * h * w / 2 / (cosine + mu)).sum())


class SlabTest(OracleTestCase):
    def diffuse(self, *medium):
        x, w = np.polynomial.legendre.leggauss(16)
        mu = (x + 1) / 2
        return [float((mu * w * seen).sum()) for seen in slab.slab(*medium, mu)]

    def test_a_white_slab_loses_no_light(self):
        for tau, g in ((0.1, 0.0), (1.0, 0.8), (100.0, -0.5)):
            reflected, transmitted = slab.slab(1.0, tau, g, COSINES)
            self.assert_near(reflected + transmitted, 1, 1e-5)

    def test_a_black_slab_absorbs(self):
        reflected, transmitted = slab.slab(0.0, 2.0, 0.0, COSINES)
        self.assert_near(reflected, 0, 0)
        self.assert_near(transmitted, np.exp(-2 / COSINES), 1e-8)

    def test_half_space(self):
        for albedo in (0.5, 0.9, 0.99):
            for cosine in (1.0, 0.5, 0.1):
                self.assert_near(slab.slab(albedo, 400.0, 0.0, [cosine])[0], half_space_albedo(albedo, cosine), 1e-6)

    def test_diffusion(self):
        # 4/3 / (tau (1 - g) + 2 q), with Milne's q = .7104 for isotropic scattering.
        for tau in (10.0, 50.0):
            self.assert_near(self.diffuse(1.0, tau, 0.0)[1], 4 / 3 / (tau + 2 * 0.71044609), 1e-6)
            self.assert_near(self.diffuse(1.0, 5 * tau, 0.8)[1] * (tau + 2 * 0.71044609), 4 / 3, 2e-3)

    def test_a_thick_slab_has_the_colour_that_glTF_names(self):
        for color in (0.1, 0.3, 0.5, 0.8, 0.95):
            s = 4.09712 + 4.20863 * color - math.sqrt(9.59217 + 41.6808 * color + 17.7126 * color**2)
            self.assert_near(self.diffuse(1 - s * s, 1000.0, 0.0)[0], color, 2e-3)


class ToneTest(OracleTestCase):
    def test_neutral_by_hand(self):
        # 1 - .04 is above the start of compression, .76: 1 - .24^2 / (.96 + 1 - 1.52). Below, colours lose .04 or, if dark, less.
        rows = np.array([[1, 1, 1], [0.5, 0.3, 0.2], [0.04, 0.3, 0.04], [0, 0, 0]])
        expected = [[1 - 0.0576 / 0.44] * 3, [0.46, 0.26, 0.16], [0.01, 0.27, 0.01], [0, 0, 0]]
        self.assert_near(tone.neutral(rows), expected, ROUNDING)

    def test_neutral_is_continuous(self):
        for scale in (0.08, 0.8):  # where the offset and where the compression begins
            below, above = (tone.neutral(np.full(3, scale * (1 + e))) for e in (-1e-9, 1e-9))
            self.assert_near(above, below, 1e-8)

    def test_polynomial_is_the_fit_of_the_sigmoid(self):
        x = np.linspace(0, 1, 4096)
        curve = tone.agx_sigmoid(x)
        fit = np.polyfit(x, curve, 6)
        self.assert_near(np.mean((np.polyval(fit, x) - curve) ** 2), 3.6705141e-06, 1e-12)  # as Wrensch states it
        self.assert_near(fit / tone.AGX_POLYNOMIAL, 1, 5e-4)  # four digits
        self.assert_near(tone.agx_polynomial(x), curve, 0.006)
        self.assert_near(tone.agx_sigmoid(np.array([0, 10 / 16.5, 1])), [0, 0.5, 1], ROUNDING)

    def test_range_of_agx(self):
        self.assert_near(2 ** np.array(tone.AGX_STOPS), 0.18 * 2 ** np.array([-10, 6.5]), 1e-5)

    def test_light_stays_in_order_and_grey(self):
        grey = np.geomspace(1e-6, 1e6, 2000)[:, None] * WHITE
        for curve, tint in ((tone.neutral, 0), (tone.agx, 6e-4)):
            shown = curve(grey)
            self.assertTrue(np.all(np.diff(shown, axis=0) >= 0))
            self.assert_near(shown, shown[:, :1], tint)
            self.assert_near(shown[-1], 1, 0.004)
            colours = curve(10 ** (12 * random(10000) - 6))
            self.assertTrue(np.all((colours >= 0) & (colours <= 1)))


if __name__ == "__main__":
    unittest.main()
