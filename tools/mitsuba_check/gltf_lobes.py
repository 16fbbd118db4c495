"""The lobes of glTF's material: what glim computes (shaders/access/principled.glsl says why), written for Dr.Jit with sampling of its own,
and with albedos by quadrature (tables.py). Directions are in the shading frame, z on the side of the viewer."""

import math
from types import SimpleNamespace

import drjit as dr
import mitsuba as mi
import numpy as np

from .errors import CheckError
from .gltf_surface import frame_along, greatest, lerp, reflect, visible_normal
from .materials import SMOOTH_ALPHA
from .tables import AZIMUTHS, COSINES, ROUGHNESSES, WIDTHS, anisotropic_table, ggx_table, sheen_table

COAT_F0 = 0.04
LEAST_SHARE = 0.02  # of the samples, of a lobe that is not black
MIN_SHEEN_ROUGHNESS = 0.01
MIN_ETA_STEP = 1e-4  # of an index from 1: closer, an interface bends nothing
LEAST_COSINE = 1e-6
MIN_F0, MAX_REFLECTANCE = 1e-4, 0.9999  # of a film's base and of its sum


def mean(v):
    return (v.x + v.y + v.z) / 3


def schlick_weight(cosine):
    return dr.clip(1 - cosine, 0, 1) ** 5


def dielectric(cosine, eta):
    """Fresnel reflectance without polarisation; 1 under total internal reflection."""
    c = dr.clip(cosine, 0, 1)
    square = 1 - (1 - c * c) / (eta * eta)
    t = dr.sqrt(dr.maximum(square, 0))
    parallel, perpendicular = (eta * c - t) / (eta * c + t), (c - eta * t) / (c + eta * t)
    return dr.select(square > 0, 0.5 * (parallel * parallel + perpendicular * perpendicular), 1)


class Table:
    """Rows over cosine^(1/4), between two values of roughness."""

    def __init__(self, low, high, rows, means=None):
        self.low, self.high, self.rows = low, high, len(rows)
        doubled = [np.repeat(part, 2, axis=0) if len(part) == 1 else part for part in (rows, means) if part is not None]
        textures = [mi.Texture2f(mi.TensorXf(np.ascontiguousarray(part, dtype=np.float32)))
                    for part in (doubled[0], *(part[:, None] for part in doubled[1:]))]
        self.image, self.means = textures[0], textures[1] if means is not None else None

    def row(self, roughness):
        if self.rows == 1:
            return mi.Float(0.5)
        place = dr.clip((roughness - self.low) / (self.high - self.low), 0, 1)
        return (place * (ROUGHNESSES - 1) + 0.5) / ROUGHNESSES

    def at(self, row, cosine):
        place = dr.sqrt(dr.sqrt(dr.clip(cosine, 0, 1)))
        return self.image.eval(mi.Point2f((place * (COSINES - 1) + 0.5) / COSINES, row))

    def mean_at(self, row):
        return self.means.eval(mi.Point2f(0.5, row))


class AnisotropicTable:
    """Azimuths x cosine^(1/4), between two values of roughness or of strength."""

    def __init__(self, roughnesses, strengths):
        if roughnesses[0] < roughnesses[1] and strengths[0] < strengths[1]:
            raise CheckError("a material has textures of both roughness and anisotropy; expected one of them at most.")
        self.roughnesses, self.strengths = roughnesses, strengths
        rows, means = (np.repeat(part, 2, axis=0) if len(part) == 1 else part for part in anisotropic_table(roughnesses, strengths))
        self.image = mi.Texture3f(mi.TensorXf(np.ascontiguousarray(rows, dtype=np.float32)))
        self.means = mi.Texture2f(mi.TensorXf(np.ascontiguousarray(means[:, None], dtype=np.float32)))

    def row(self, roughness, strength):
        (low, high), (least, most) = self.roughnesses, self.strengths
        if low == high and least == most:
            return mi.Float(0.5)
        place = (roughness - low) / (high - low) if low < high else (strength - least) / (most - least)
        return (dr.clip(place, 0, 1) * (WIDTHS - 1) + 0.5) / WIDTHS

    def at(self, row, w):
        cosine, azimuth = dr.sqrt(dr.sqrt(dr.clip(w.z, 0, 1))), dr.atan2(abs(w.y), abs(w.x)) / (math.pi / 2)
        return self.image.eval(mi.Point3f((cosine * (COSINES - 1) + 0.5) / COSINES, (azimuth * (AZIMUTHS - 1) + 0.5) / AZIMUTHS, row))

    def mean_at(self, row):
        return self.means.eval(mi.Point2f(0.5, row))


class Ggx:
    """The microfacets' lobe for a reflectance of 1, times the cosine of wi; ax and ay are at least SMOOTH_ALPHA."""

    def __init__(self, ax, ay):
        self.ax, self.ay = ax, ay

    def stretched(self, w):
        return dr.norm(mi.Vector3f(self.ax * w.x, self.ay * w.y, w.z))

    def distribution(self, h):
        s = dr.square(h.x / self.ax) + dr.square(h.y / self.ay) + dr.square(h.z)
        return 1 / (math.pi * self.ax * self.ay * s * s)

    def eval(self, wo, wi):
        correlated = wo.z * self.stretched(wi) + wi.z * self.stretched(wo)
        return 0.5 * self.distribution(dr.normalize(wo + wi)) * wi.z / correlated

    def pdf(self, wo, wi):
        return 0.5 * self.distribution(dr.normalize(wo + wi)) / (wo.z + self.stretched(wo))

    def normal(self, wo, u):
        """One of those visible from wo (Dupuy and Benyoub 2023)."""
        w = dr.normalize(mi.Vector3f(self.ax * wo.x, self.ay * wo.y, wo.z))
        q = u.y * (1 + w.z)
        s, c = dr.sincos(2 * math.pi * u.x)
        radius = dr.sqrt(dr.maximum(q * (2 - q), 0))
        cap = mi.Vector3f(radius * c, radius * s, 1 - q) + w
        return dr.normalize(mi.Vector3f(self.ax * cap.x, self.ay * cap.y, dr.maximum(cap.z, 0)))

    def refraction(self, wo, wi, eta):
        """Normal that refracts wo to wi, whether there is one, the lobe, and the density (Walter et al. 2007)."""
        h = dr.normalize(wo + eta * wi)
        h = dr.select(eta > 1, -h, h)
        cos_o, cos_i = dr.dot(wo, h), dr.dot(wi, h)
        exists = (cos_o > 0) & (cos_i < 0) & (h.z > 0)
        jacobian = eta * eta * -cos_i / dr.square(cos_o + eta * cos_i)
        common = 2 * cos_o * self.distribution(h) * jacobian
        correlated = wo.z * self.stretched(wi) - wi.z * self.stretched(wo)
        return h, exists, common * -wi.z / (correlated * eta * eta), common / (wo.z + self.stretched(wo))


def below(w):
    return mi.Vector3f(w.x, w.y, -w.z)


def film_reflectance(cosine, film_ior, thickness, base_f0):
    """Belcour and Barla (2017), as KHR_materials_iridescence gives it."""
    t = dr.clip(thickness / 0.03, 0, 1)
    ior = lerp(1, film_ior, t * t * (3 - 2 * t))
    square = 1 - (1 - cosine * cosine) / (ior * ior)
    inside = dr.sqrt(dr.maximum(square, 0))
    root = dr.sqrt(dr.clip(base_f0, MIN_F0, MAX_REFLECTANCE))
    base_ior = (1 + root) / (1 - root)
    outer0, inner0 = dr.square((ior - 1) / (ior + 1)), dr.square((base_ior - ior) / (base_ior + ior))
    outer = lerp(outer0, 1, schlick_weight(cosine))
    inner = lerp(inner0, mi.Color3f(1), schlick_weight(inside))
    shift = dr.select(ior >= 1, math.pi, 0.0) + dr.select(base_ior < ior, mi.Color3f(math.pi), 0.0)
    difference = 2 * ior * thickness * inside
    both = dr.minimum(outer * inner, MAX_REFLECTANCE)
    once = dr.square(1 - outer) * inner / (1 - both)
    total = outer + once
    for m in (1, 2):
        total += (once - (1 - outer)) * dr.sqrt(both) ** m * 2 * film_response(m * difference, m * shift)
    return dr.select(square < 0, 1, dr.clip(total, 0, 1))


def film_response(difference, shift):
    phase = 2 * math.pi * 1e-9 * difference

    def gaussian(amplitude, wavenumber, variance, channel):
        size = amplitude * math.sqrt(2 * math.pi * variance) / 1.0685e-7
        turns = (wavenumber * phase + channel) / (2 * math.pi)
        return size * dr.exp(-variance * phase * phase) * dr.cos(2 * math.pi * (turns - dr.floor(turns)))
    x = gaussian(5.4856e-13, 1.6810e6, 4.3278e9, shift.x) + gaussian(9.7470e-14, 2.2399e6, 4.5282e9, shift.x)
    y, z = gaussian(4.4201e-13, 1.7953e6, 9.3046e9, shift.y), gaussian(5.2481e-13, 2.2084e6, 6.6121e9, shift.z)
    return mi.Color3f(3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
                      0.0556434 * x - 0.2040259 * y + 1.0572252 * z)


def sheen_masking(cosine, alpha):
    """Estevez and Kulla (2017), section 3."""
    t = dr.square(1 - alpha)
    a, b, c, d, e = (lerp(rough, smooth, t) for rough, smooth in zip(
        (21.5473, 3.82987, 0.19823, -1.97760, -4.32054), (25.3245, 3.32435, 0.16801, -1.27393, -4.85967)))

    def fit(x):
        return a / (1 + b * dr.power(x, c)) + d * x + e
    low = fit(dr.maximum(dr.minimum(cosine, 1 - cosine), 1e-12))
    return dr.exp(dr.select(cosine < 0.5, low, 2 * fit(mi.Float(0.5)) - low))


def sheen_lobe(wo, wi, alpha):
    """White, times the cosine of wi."""
    h = dr.normalize(wo + wi)
    sine = dr.sqrt(dr.maximum((1 - h.z) * (1 + h.z), 1e-24))
    density = (2 + 1 / alpha) * dr.power(sine, 1 / alpha) / (2 * math.pi)
    return density / ((1 + sheen_masking(wo.z, alpha) + sheen_masking(wi.z, alpha)) * 4 * wo.z)


def range_of(pixels, channel, factor):
    if pixels is None:
        return factor, factor
    return factor * float(pixels[..., channel].min()), factor * float(pixels[..., channel].max())


class Lobes:
    """The lobes of one material: `at` gives what they are at a hit."""

    def __init__(self, material, pixels):
        self.material = m = material
        if m.glossy:
            low, high = range_of(pixels.get("specularColorTexture"), 3, m.roughness)
            low, high = 1 - high, 1 - low
        else:
            low, high = range_of(pixels.get("metallicRoughnessTexture"), 1, m.roughness)
        self.smooth, self.rough = low ** 2 < SMOOTH_ALPHA, high ** 2 >= SMOOTH_ALPHA or m.anisotropy > 0
        if m.anisotropy > 0:
            self.table = AnisotropicTable((low, high), range_of(pixels.get("anisotropyTexture"), 2, m.anisotropy))
        else:
            self.table = Table(low, high, *ggx_table(low, high))
        if m.clearcoat > 0:
            low, high = range_of(pixels.get("clearcoatRoughnessTexture"), 1, m.clearcoat_roughness)
            self.coat_smooth, self.coat_rough = low ** 2 < SMOOTH_ALPHA, high ** 2 >= SMOOTH_ALPHA
            self.coat_table = Table(low, high, *ggx_table(low, high))
        if max(m.sheen_color) > 0:
            low, high = (max(r, MIN_SHEEN_ROUGHNESS) for r in range_of(pixels.get("sheenRoughnessTexture"), 3, m.sheen_roughness))
            self.sheen_table = Table(low, high, sheen_table(low, high))
        self.delta = self.smooth or (m.clearcoat > 0 and self.coat_smooth)

    def interface_albedo(self, p, w):
        """a and b of a direction above the surface."""
        return self.table.at(p.row, w if self.material.anisotropy > 0 else w.z)

    # What the interface reflects.

    def with_film(self, p, f, f0, cosine):
        if not self.material.iridescence > 0:
            return f
        outside = cosine
        if self.refracts:
            square = 1 - (1 - cosine * cosine) / (p.eta * p.eta)
            outside = dr.select(p.eta < 1, dr.sqrt(dr.maximum(square, 0)), cosine)
        return dr.select(p.film > 0, lerp(f, film_reflectance(outside, self.material.iridescence_ior, p.thickness, f0), p.film), f)

    def dielectric_fresnel(self, p, cosine):
        s = schlick_weight(cosine)
        if self.refracts:
            f0 = dr.square((p.eta - 1) / (p.eta + 1))
            exact = dr.clip((dielectric(cosine, p.eta) - f0) / (1 - f0), 0, 1)
            s = dr.select(p.refracts, exact, s)
        f = lerp(p.dielectric_f0, mi.Color3f(p.specular), s)
        filmed = self.with_film(p, f, p.dielectric_f0, cosine)
        return dr.select(p.refracts & (s >= 1), 1, filmed) if self.refracts else filmed

    def metal_fresnel(self, p, cosine):
        return self.with_film(p, lerp(p.base, mi.Color3f(1), schlick_weight(cosine)), p.base, cosine)

    def fresnel(self, p, cosine):
        return lerp(self.dielectric_fresnel(p, cosine), self.metal_fresnel(p, cosine), p.metallic)

    def multiple(self, average, f0, f90):
        """Kulla and Conty (2017): the share of lost light that further bounces reflect."""
        e = average[0] + average[1]
        f = f0 + (f90 - f0) / 21
        return f * f * e / (1 - f * (1 - e))

    def kept(self, p, ab):
        """What the interface keeps from what is below."""
        f0, f90 = p.below_f0, p.specular
        return f0 * ab[0] + f90 * ab[1] + p.below_multiple * (1 - ab[0] - ab[1])

    def passed_interface(self, p, ab, cosine):
        passed = 1 - self.kept(p, ab)
        if self.refracts:
            passed = dr.select(p.refracts, dr.minimum(passed, 1 - greatest(self.dielectric_fresnel(p, cosine))), passed)
        return passed

    def reflected_share(self, p, cosine):
        if not self.material.transmission > 0:
            return mi.Float(1)
        r, t = mean(self.fresnel(p, cosine)), mean(p.transmitted * (1 - self.dielectric_fresnel(p, cosine)))
        return dr.select(r + t > 0, r / dr.maximum(r + t, 1e-30), 1)

    @property
    def refracts(self):
        return self.material.solid and self.material.transmission > 0

    def passed_layers(self, p, coat_albedo, sheen_albedo):
        passed = mi.Float(1)
        if self.material.clearcoat > 0:
            passed *= 1 - p.coat * coat_albedo
        if max(self.material.sheen_color) > 0:
            passed *= dr.maximum(0, 1 - p.sheen_most * sheen_albedo)
        return passed

    def coat_albedo(self, p, cosine):
        ab = self.coat_table.at(p.coat_row, cosine)
        return COAT_F0 * ab[0] + ab[1]

    def sheen_albedo(self, p, cosine):
        return self.sheen_table.at(p.sheen_row, cosine)[0]

    def at(self, g):
        """g: of Surface."""
        m, p = self.material, SimpleNamespace(**vars(g))
        n = visible_normal(g)
        p.frame = frame_along(n, g.tangent) if m.anisotropy > 0 else mi.Frame3f(n)
        wo = p.frame.to_local(g.wo)
        p.wo = wo = mi.Vector3f(wo.x, wo.y, dr.maximum(wo.z, LEAST_COSINE))
        alpha = dr.square(p.roughness)
        along = lerp(alpha, 1, dr.square(p.anisotropy))
        p.is_smooth = along < SMOOTH_ALPHA
        p.lobe = Ggx(dr.maximum(along, SMOOTH_ALPHA), dr.maximum(alpha, SMOOTH_ALPHA))
        p.refracts = g.transmission > 0 if self.refracts else mi.Bool(False)
        reflectance = ((m.ior - 1) / (m.ior + 1)) ** 2
        if self.refracts:
            reflectance = dr.select(p.refracts, dr.square((g.eta - 1) / (g.eta + 1)), reflectance)
            p.is_smooth |= p.refracts & (abs(g.eta - 1) < MIN_ETA_STEP)
        p.dielectric_f0 = dr.minimum(reflectance * p.specular_color, mi.Color3f(1)) * p.specular
        share = mi.Float(0) if m.passes_straight else g.transmission
        p.transmitted = p.base * (share * (1 - p.metallic))
        table_dielectric, table_metal = p.dielectric_f0, p.base
        if m.iridescence > 0:
            s = schlick_weight(wo.z)
            rest = 1 - dr.minimum(s, 0.999)
            table_dielectric = dr.select(g.film > 0, dr.clip((self.dielectric_fresnel(p, wo.z) - p.specular * s) / rest, 0, 1),
                                         table_dielectric)
            table_metal = dr.select(g.film > 0, dr.clip((self.metal_fresnel(p, wo.z) - s) / rest, 0, 1), table_metal)
        p.row = self.table.row(p.roughness, p.anisotropy) if m.anisotropy > 0 else self.table.row(p.roughness)
        p.ab, average = self.interface_albedo(p, wo), self.table.mean_at(p.row)
        p.below_f0 = greatest(table_dielectric)
        p.below_multiple = self.multiple(average, p.below_f0, p.specular)
        multiple = lerp(self.multiple(average, table_dielectric, p.specular), self.multiple(average, table_metal, 1.0), p.metallic)
        lost = 1 - p.ab[0] - p.ab[1]
        scattered = multiple * lost
        below_ = (1 - p.metallic) * self.passed_interface(p, p.ab, wo.z) * (1 - g.transmission)
        diffuse = p.base * (below_ * (1 - g.diffuse_transmission))
        through = g.far_color * (below_ * g.diffuse_transmission)
        self.set_layers(p)
        albedo = lerp(table_dielectric, table_metal, p.metallic) * p.ab[0] + lerp(p.specular, 1, p.metallic) * p.ab[1]
        if m.transmission > 0:
            albedo = dr.select(p.refracts, self.fresnel(p, wo.z), albedo) + p.transmitted * (1 - self.dielectric_fresnel(p, wo.z))
        self.set_shares(p, mean(albedo), mean(scattered + diffuse), mean(through))
        norm = dr.maximum(1 - self.kept(p, average), 1e-6)
        scale = 1 / (math.pi * (dr.select(p.refracts, 1, norm) if self.refracts else norm))
        p.scattered = scattered / (math.pi * dr.maximum(1 - average[0] - average[1], 1e-6))
        p.diffuse, p.through = diffuse * scale, through * scale
        if m.solid:
            p.through /= dr.square(g.eta)
        return p

    def set_layers(self, p):
        m = self.material
        coat_albedo = sheen_albedo = None
        if m.clearcoat > 0:
            n = dr.select(dr.dot(p.coat_normal, p.wo_world) > 0, p.coat_normal, p.ng)
            n = dr.select(dr.dot(n, p.wo_world) > 0, n, p.frame.n)
            p.coat_frame = mi.Frame3f(n)
            alpha = dr.square(p.coat_roughness)
            p.coat_is_smooth = alpha < SMOOTH_ALPHA
            p.coat_lobe = Ggx(dr.maximum(alpha, SMOOTH_ALPHA), dr.maximum(alpha, SMOOTH_ALPHA))
            p.coat_row = self.coat_table.row(p.coat_roughness)
            p.coat_wo = p.coat_frame.to_local(p.wo_world)
            p.coat_kept = coat_albedo = self.coat_albedo(p, p.coat_wo.z)
        if max(m.sheen_color) > 0:
            p.sheen = dr.select(p.sheen_roughness >= MIN_SHEEN_ROUGHNESS, p.sheen, 0)
            p.sheen_most = greatest(p.sheen)
            roughness = dr.maximum(p.sheen_roughness, MIN_SHEEN_ROUGHNESS)
            p.sheen_alpha, p.sheen_row = dr.square(roughness), self.sheen_table.row(roughness)
            p.sheen_kept = sheen_albedo = self.sheen_albedo(p, p.wo.z)
        p.passed = self.passed_layers(p, coat_albedo, sheen_albedo)

    def set_shares(self, p, interface, diffuse, through):
        """Probabilities of the lobes."""
        weights = {"interface": interface * p.passed, "diffuse": diffuse * p.passed, "through": through * p.passed}
        if self.material.clearcoat > 0:
            weights["coat"] = p.coat * p.coat_kept
        if max(self.material.sheen_color) > 0:
            weights["sheen"] = mean(p.sheen) * dr.minimum(p.sheen_kept, 1)
        total = dr.maximum(sum(weights.values()), 1e-30)
        shares = {name: dr.select(w > 0, dr.maximum(w / total, LEAST_SHARE), 0) for name, w in weights.items()}
        total = dr.maximum(sum(shares.values()), 1e-30)
        p.shares = {name: share / total for name, share in shares.items()}

    # Evaluation, of all lobes that are not delta.

    def eval_above(self, p, wi):
        ab = self.interface_albedo(p, wi)
        f = (p.scattered * (1 - ab[0] - ab[1]) + p.diffuse * self.passed_interface(p, ab, wi.z)) * wi.z
        pdf = p.shares["diffuse"] * wi.z / math.pi
        if self.rough:
            cosine = dr.dot(p.wo, dr.normalize(p.wo + wi))
            f += dr.select(p.is_smooth, 0, self.fresnel(p, cosine) * p.lobe.eval(p.wo, wi))
            pdf += dr.select(p.is_smooth, 0, p.shares["interface"] * self.reflected_share(p, cosine) * p.lobe.pdf(p.wo, wi))
        return f, pdf

    def eval_below(self, p, wi):
        f, pdf = mi.Color3f(0), mi.Float(0)
        if self.material.diffuse_transmission > 0:
            f += p.through * (self.passed_interface(p, self.interface_albedo(p, below(wi)), -wi.z) * -wi.z)
            pdf += p.shares["through"] * -wi.z / math.pi
        if self.material.transmission > 0 and self.rough:
            h = dr.normalize(p.wo + below(wi))
            exists, lobe, density = mi.Bool(True), p.lobe.eval(p.wo, below(wi)), p.lobe.pdf(p.wo, below(wi))
            if self.refracts:
                bent, bends, bent_lobe, bent_density = p.lobe.refraction(p.wo, wi, p.eta)
                h, exists = dr.select(p.refracts, bent, h), bends | ~p.refracts
                lobe, density = dr.select(p.refracts, bent_lobe, lobe), dr.select(p.refracts, bent_density, density)
            cosine = dr.dot(p.wo, h)
            exists &= ~p.is_smooth & (greatest(p.transmitted) > 0)
            f += dr.select(exists, p.transmitted * (1 - self.dielectric_fresnel(p, cosine)) * lobe, 0)
            pdf += dr.select(exists, p.shares["interface"] * (1 - self.reflected_share(p, cosine)) * density, 0)
        return f, pdf

    def eval_local(self, p, wi):
        m = self.material
        above = wi.z > 0
        safe = dr.select(above, wi, mi.Vector3f(0, 0, 1))
        f, pdf = self.eval_above(p, safe)
        f, pdf = dr.select(above, f, 0), dr.select(above, pdf, 0)
        if m.transmission > 0 or m.diffuse_transmission > 0:
            under = wi.z < 0
            f_, pdf_ = self.eval_below(p, dr.select(under, wi, mi.Vector3f(0, 0, -1)))
            f, pdf = dr.select(under, f_, f), dr.select(under, pdf_, pdf)
        coat_albedo = sheen_albedo = None
        if m.clearcoat > 0:
            coat_wi = p.coat_frame.to_local(p.frame.to_world(wi))
            coat_albedo = self.coat_albedo(p, abs(coat_wi.z))
        if max(m.sheen_color) > 0:
            sheen_albedo = self.sheen_albedo(p, abs(wi.z))
        f *= dr.minimum(p.passed, self.passed_layers(p, coat_albedo, sheen_albedo))
        if max(m.sheen_color) > 0:
            left = 1 - p.coat * dr.maximum(p.coat_kept, coat_albedo) if m.clearcoat > 0 else mi.Float(1)
            scale = left / dr.maximum(1, dr.maximum(p.sheen_kept, sheen_albedo))
            f += dr.select(above, p.sheen * (scale * sheen_lobe(p.wo, safe, p.sheen_alpha)), 0)
            pdf += dr.select(above, p.shares["sheen"] / (2 * math.pi), 0)
        if m.clearcoat > 0 and self.coat_rough:
            counts = above & (coat_wi.z > 0) & ~p.coat_is_smooth & (p.coat > 0)
            wi_ = dr.select(counts, coat_wi, mi.Vector3f(0, 0, 1))
            fresnel = lerp(COAT_F0, 1, schlick_weight(dr.dot(p.coat_wo, dr.normalize(p.coat_wo + wi_))))
            f += dr.select(counts, mi.Color3f(p.coat * fresnel * p.coat_lobe.eval(p.coat_wo, wi_)), 0)
            pdf += dr.select(counts, p.shares["coat"] * p.coat_lobe.pdf(p.coat_wo, wi_), 0)
        return f, pdf

    def eval(self, p, wi_world):
        wi = p.frame.to_local(wi_world)
        outwards = dr.dot(wi_world, p.ng)
        counts = ((wi.z > 0) & (outwards > 0)) | ((wi.z < 0) & (outwards < 0))
        f, pdf = self.eval_local(p, wi)
        return dr.select(counts, f * p.beer, 0), dr.select(counts, pdf, 0)

    # Sampling.

    def sample(self, p, u, v):
        """u chooses, v gives a direction: (wi in the world, weight, pdf, eta, delta, transmits)."""
        m = self.material
        lobes, rest, remaining = {}, mi.Float(u), mi.Bool(True)
        names = [name for name in ("coat", "sheen", "through", "diffuse", "interface") if name in p.shares]
        for name in names:
            share = p.shares[name]
            chosen = remaining & (rest < share) if name != names[-1] else remaining
            lobes[name] = chosen
            lobes[name + " u"] = dr.clip(rest / dr.maximum(share, 1e-30), 0, 0.9999999)
            remaining = remaining & ~chosen
            rest = rest - share
        h = p.lobe.normal(p.wo, v)
        h = dr.select(p.is_smooth, mi.Vector3f(0, 0, 1), h)
        cosine = dr.dot(p.wo, h)
        share = self.reflected_share(p, cosine)
        under = lobes["interface"] & (lobes["interface u"] >= share)
        wi = reflect(p.wo, h)
        if m.transmission > 0:
            thin = below(wi)
            if self.refracts:
                eta = dr.select(abs(p.eta - 1) < MIN_ETA_STEP, 1, p.eta)
                k = 1 - (1 - cosine * cosine) / (eta * eta)
                bent = dr.normalize((cosine / eta - dr.sqrt(dr.maximum(k, 0))) * h - p.wo / eta)
                thin = dr.select(p.refracts, bent, thin)
            wi = dr.select(under, thin, wi)
        flat = mi.warp.square_to_cosine_hemisphere(v)
        wi = dr.select(lobes["diffuse"], flat, wi)
        if m.diffuse_transmission > 0:
            wi, under = dr.select(lobes["through"], below(flat), wi), under | lobes["through"]
        if max(m.sheen_color) > 0:
            wi = dr.select(lobes["sheen"], mi.warp.square_to_uniform_hemisphere(v), wi)
        delta = lobes["interface"] & p.is_smooth
        if m.clearcoat > 0:
            coat_h = dr.select(p.coat_is_smooth, mi.Vector3f(0, 0, 1), p.coat_lobe.normal(p.coat_wo, v))
            coat_wi = p.frame.to_local(p.coat_frame.to_world(reflect(p.coat_wo, coat_h)))
            wi, delta = dr.select(lobes["coat"], coat_wi, wi), delta | (lobes["coat"] & p.coat_is_smooth)
        f, pdf = self.eval_local(p, wi)
        weight = dr.select(pdf > 0, f / dr.maximum(pdf, 1e-30), 0)
        f0 = self.fresnel(p, p.wo.z)
        certain = dr.maximum(p.shares["interface"] * share, 1e-30)
        sharp = f0 * (p.passed / certain)
        if m.transmission > 0:
            scale = dr.select(p.refracts, dr.square(p.eta), 1) if self.refracts else 1
            certain = dr.maximum(p.shares["interface"] * (1 - share) * scale, 1e-30)
            sharp = dr.select(under, p.transmitted * (1 - self.dielectric_fresnel(p, p.wo.z)) * (p.passed / certain), sharp)
        if m.clearcoat > 0:
            fresnel = lerp(COAT_F0, 1, schlick_weight(p.coat_wo.z))
            sharp = dr.select(lobes["coat"], mi.Color3f(p.coat * fresnel / dr.maximum(p.shares["coat"], 1e-30)), sharp)
        weight = dr.select(delta, sharp, weight)
        wi_world = p.frame.to_world(wi)
        outwards = dr.dot(wi_world, p.ng)
        valid = dr.select(under, (wi.z < 0) & (outwards < 0), ((wi.z > 0) | delta) & (outwards > 0))
        bends = under & (p.refracts | (lobes["through"] if m.solid else mi.Bool(False)))
        return (wi_world, dr.select(valid, weight * p.beer, 0), dr.select(delta, 1, pdf), dr.select(bends, p.eta, 1), delta, under)
