"""glTF's material as a BSDF of Mitsuba. The classes can be defined only after a variant of Mitsuba is chosen."""

from functools import lru_cache

import drjit as dr
import mitsuba as mi

from .gltf_lobes import dielectric, mean, schlick_weight
from .gltf_surface import lerp, reflect


@lru_cache(maxsize=None)
def bsdf_class(_variant):
    flags = mi.BSDFFlags
    sides = flags.FrontSide | flags.BackSide

    class GltfBsdf(mi.BSDF):
        def __init__(self, surface, lobes):
            super().__init__(mi.Properties())
            self.surface, self.lobes, m = surface, lobes, surface.material
            kinds = [] if m.smooth_glass else [flags.GlossyReflection | sides]
            if m.transmission > 0 or m.diffuse_transmission > 0:
                kinds.append((flags.DeltaTransmission if m.smooth_glass else flags.GlossyTransmission) | sides)
            if m.passes_straight:
                kinds.append(flags.Null | sides)
            if m.smooth_glass or lobes.delta:
                kinds.append(flags.DeltaReflection | sides)
            self.m_components, self.m_flags = kinds, 0
            for kind in kinds:
                self.m_flags |= kind

        def point(self, si, active):
            g = self.surface.at(si, active)
            g.wo_world = g.wo
            return self.lobes.at(g)

        def sample(self, _context, si, sample1, sample2, active):
            if self.surface.material.smooth_glass:
                return self.sample_glass(si, sample1, active)
            u, passes, straight = mi.Float(sample1), mi.Bool(False), mi.Color3f(0)
            p = self.point(si, active)
            if self.surface.material.passes_straight:
                straight = self.straight(p)
                share = mean(straight)
                passes = u < share
                u = dr.select(passes, u / dr.maximum(share, 1e-30), (u - share) / dr.maximum(1 - share, 1e-30))
            wi, weight, pdf, eta, delta, under = self.lobes.sample(p, dr.clip(u, 0, 0.9999999), sample2)
            if self.surface.material.passes_straight:
                wi, under, delta = dr.select(passes, -p.wo_world, wi), under | passes, delta | passes
                weight = dr.select(passes, straight / dr.maximum(share, 1e-30), weight / dr.maximum(1 - share, 1e-30))
                pdf *= dr.select(passes | delta, 1, 1 - share)
            kind = dr.select(delta, dr.select(under, +flags.DeltaTransmission, +flags.DeltaReflection),
                             dr.select(under, +flags.GlossyTransmission, +flags.GlossyReflection))
            kind = dr.select(passes, +flags.Null, kind)
            return self.result(si, wi, pdf, eta, kind), weight & active

        def eval_null_transmission(self, si, active=True):
            if not self.surface.material.passes_straight:
                return mi.Color3f(0)
            return self.straight(self.point(si, active)) & active

        def result(self, si, wi, pdf, eta, kind):
            sample = mi.BSDFSample3f()
            sample.wo, sample.pdf, sample.eta = si.to_local(wi), pdf, eta
            sample.sampled_type, sample.sampled_component = mi.UInt32(kind), mi.UInt32(0)
            return sample

        def straight(self, p):
            """What a smooth thin wall lets through, by its geometric normal."""
            transmitted = p.base * (p.transmission * (1 - p.metallic))
            return transmitted * (1 - lerp(p.dielectric_f0, mi.Color3f(p.specular), schlick_weight(dr.dot(p.ng, p.wo_world))))

        def sample_glass(self, si, u, active):
            """The side of the viewer by the shading normal, whatever the geometric one says: as glim's smooth glass has it."""
            g = self.surface.at(si, active)
            behind = dr.dot(g.ns, g.wo) < 0
            n = dr.select(behind, -g.ns, g.ns)
            eta = dr.select(behind, 1 / g.eta, g.eta)
            cosine = dr.dot(n, g.wo)
            reflected = dielectric(cosine, eta)
            under = u >= reflected
            k = 1 - (1 - cosine * cosine) / (eta * eta)
            bent = dr.normalize((cosine / eta - dr.sqrt(dr.maximum(k, 0))) * n - g.wo / eta)
            kind = dr.select(under, +flags.DeltaTransmission, +flags.DeltaReflection)
            weight = g.beer * dr.select(under, g.base / (eta * eta), mi.Color3f(1))
            return (self.result(si, dr.select(under, bent, reflect(g.wo, n)), mi.Float(1), dr.select(under, eta, 1), kind),
                    weight & active)

        def eval_pdf(self, _context, si, wo, active):
            if self.surface.material.smooth_glass:
                return mi.Color3f(0), mi.Float(0)
            p = self.point(si, active)
            f, pdf = self.lobes.eval(p, si.to_world(wo))
            if self.surface.material.passes_straight:
                pdf *= 1 - mean(self.straight(p))
            return f & active, pdf & active

        def eval(self, context, si, wo, active):
            return self.eval_pdf(context, si, wo, active)[0]

        def pdf(self, context, si, wo, active):
            return self.eval_pdf(context, si, wo, active)[1]

        def traverse(self, _callback):
            pass

        def to_string(self):
            return "GltfBsdf[]"
    return GltfBsdf


@lru_cache(maxsize=None)
def texture_class(_variant):
    class SurfaceTexture(mi.Texture):
        """Coverage or emission of a surface."""

        def __init__(self, value):
            super().__init__(mi.Properties())
            self.value = value

        def eval(self, si, active=True):
            return mi.Color3f(self.value(si, active))

        def eval_3(self, si, active=True):
            return mi.Color3f(self.value(si, active))

        def eval_1(self, si, active=True):
            return self.value(si, active)

        def is_spatially_varying(self):
            return False  # otherwise lamps would sample it by texture coordinates

        def mean(self):
            return mi.Float(1)

        def max(self):
            return 1.0

        def traverse(self, _callback):
            pass

        def to_string(self):
            return "SurfaceTexture[]"
    return SurfaceTexture
