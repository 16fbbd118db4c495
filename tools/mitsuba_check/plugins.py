"""What glTF has and Mitsuba does not have: a mirror with Schlick's Fresnel, and a spot with the falloff of KHR_lights_punctual. These
classes can be defined only after a variant of Mitsuba is chosen."""

from functools import lru_cache

import mitsuba as mi


def make_mirror():
    class SchlickMirror(mi.BSDF):
        """Reflects color + (1 - color) (1 - cosine)^5, on both sides (Schlick 1994)."""

        def __init__(self, properties):
            super().__init__(properties)
            self.color = mi.Color3f(properties["r"], properties["g"], properties["b"])
            self.m_components = [mi.BSDFFlags.DeltaReflection | mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide]
            self.m_flags = self.m_components[0]

        def sample(self, _context, si, _sample1, _sample2, active):
            missing = 1 - abs(mi.Frame3f.cos_theta(si.wi))
            sample = mi.BSDFSample3f()
            sample.wo = mi.reflect(si.wi)
            sample.pdf, sample.eta = 1, 1
            sample.sampled_type, sample.sampled_component = +mi.BSDFFlags.DeltaReflection, 0
            return sample, (self.color + (1 - self.color) * missing ** 5) & active

        def eval(self, _context, _si, _wo, _active):
            return mi.Color3f(0)

        def pdf(self, _context, _si, _wo, _active):
            return mi.Float(0)

        def eval_pdf(self, _context, _si, _wo, _active):
            return mi.Color3f(0), mi.Float(0)
    return SchlickMirror


def make_spot():
    import drjit as dr  # comes with mitsuba

    class Spot(mi.Emitter):
        """Intensity times the square of a ramp in the cosine, 0 at the outer cone and 1 at the inner one."""

        def __init__(self, properties):
            super().__init__(properties)
            self.position, self.axis = mi.Point3f(properties["position"]), mi.Vector3f(properties["axis"])
            self.intensity = mi.Color3f(properties["r"], properties["g"], properties["b"])
            self.inner, self.outer = properties["cos_inner"], properties["cos_outer"]
            self.place = mi.ScalarPoint3f(properties["position"])
            self.m_flags = +mi.EmitterFlags.DeltaPosition

        def sample_direction(self, it, _sample, active):
            away = self.position - it.p
            sample = mi.DirectionSample3f()
            sample.p, sample.n, sample.uv, sample.time = self.position, 0, 0, it.time
            sample.pdf, sample.delta, sample.dist = 1, True, dr.norm(away)
            sample.d = away / sample.dist
            sample.emitter = self if mi.variant().startswith("scalar") else mi.EmitterPtr(self)
            ramp = dr.clip((-dr.dot(sample.d, self.axis) - self.outer) / (self.inner - self.outer), 0, 1)
            return sample, (self.intensity * dr.square(ramp / sample.dist)) & active

        def pdf_direction(self, _it, _sample, _active):
            return mi.Float(0)

        def eval_direction(self, _it, _sample, _active):
            return mi.Color3f(0)

        def eval(self, _si, _active):
            return mi.Color3f(0)

        def bbox(self):
            return mi.ScalarBoundingBox3f(self.place)
    return Spot


@lru_cache(maxsize=None)
def register_plugins():
    mi.register_bsdf("schlick_mirror", lambda properties: make_mirror()(properties))
    mi.register_emitter("ramped_spot", lambda properties: make_spot()(properties))
