"""A path tracer out of Mitsuba's parts for what its own ones have not: solids within or across each other, whose index of refraction a
path has to remember, and surfaces that only the camera sees. The class can be defined only after a variant of Mitsuba is chosen."""

from functools import lru_cache

import drjit as dr
import mitsuba as mi
import numpy as np

ENTRY_BITS = 7
ENTRIES = 4
ENTRY, ALL = (1 << ENTRY_BITS) - 1, (1 << ENTRY_BITS * ENTRIES) - 1


def innermost(stack):
    return stack & ENTRY


def entered(stack, medium):
    """The media that a path is in are numbers in one word, the innermost lowest; the outermost is forgotten when it is full."""
    return ((stack << ENTRY_BITS) | medium) & ALL


def left(stack, medium, choose):
    """Without the innermost entry of that medium; `choose` is select() of the numbers at hand."""
    result, found = stack, medium != medium
    for place in range(ENTRIES):
        low = (1 << ENTRY_BITS * place) - 1
        here = (((stack >> (ENTRY_BITS * place)) & ENTRY) == medium) & (medium != 0) & (found == (medium != medium))
        result = choose(here, ((stack >> ENTRY_BITS) & (ALL - low)) | (stack & low), result)
        found = found | here
    return result


class Media:
    """The scene's solids that transmit: `numbers` by the shape's name, from 1; index and absorption by number."""

    def __init__(self, numbers, iors, absorptions):
        self.numbers = numbers
        self.iors = mi.Float(np.array([1.0] + list(iors), np.float32))
        self.absorptions = [mi.Float(np.array([0.0] + [a[c] for a in absorptions], np.float32)) for c in range(3)]

    def table(self, scene):
        """Numbers by the shape's place in Dr.Jit's registry."""
        shapes = scene.shapes()
        places = np.array(dr.reinterpret_array(mi.UInt32, scene.shapes_dr()))
        table = np.zeros(places.max() + 1, np.uint32)
        for place, shape in zip(places, shapes):
            table[place] = self.numbers.get(shape.id(), 0)
        return mi.UInt32(table)

    def around(self, scene, table, point):
        """The media at a point, by a ray from there: of the solids that it leaves without having entered them."""
        direction, entries, around = mi.Vector3f(0.36, 0.48, 0.8), [], []
        si = scene.ray_intersect(mi.Ray3f(mi.Point3f(point), direction))
        while si.is_valid()[0]:
            number = dr.gather(mi.UInt32, table, dr.reinterpret_array(mi.UInt32, si.shape))[0]
            if number and dr.dot(si.n, direction)[0] < 0:
                entries.append(number)
            elif number in entries:
                entries.remove(number)
            elif number:
                around.append(number)
            si = scene.ray_intersect(si.spawn_ray(direction))
        stack = 0
        for number in reversed(around):  # the outermost is left last
            stack = entered(stack, number)
        return stack

    def transmittance(self, stack, distance):
        medium = innermost(stack)
        return mi.Color3f(*(dr.select(a > 0, dr.exp(-a * dr.minimum(distance, 1e30)), 1)
                            for a in (dr.gather(mi.Float, channel, medium) for channel in self.absorptions)))


@lru_cache(maxsize=None)
def integrator_class(_variant):
    class MediaPath(mi.SamplingIntegrator):
        """The integrand of Mitsuba's `path`. A BSDF finds its relative index in the interaction's time, which nothing else uses."""

        def __init__(self, max_depth, media, eye):
            super().__init__(mi.Properties())
            self.max_depth, self.media, self.eye, self.table = max_depth, media, eye, None

        @dr.syntax
        def sample(self, scene, sampler, ray, medium=None, active=True):
            if self.table is None:
                self.table = self.media.table(scene)
                self.around = self.media.around(scene, self.table, self.eye)
            ray, depth, eta = mi.Ray3f(ray), mi.UInt32(0), mi.Float(1)
            throughput, result, stack = mi.Color3f(1), mi.Color3f(0), mi.UInt32(self.around)
            previous, pdf, delta = dr.zeros(mi.Interaction3f), mi.Float(1), mi.Bool(True)
            active, context = mi.Bool(active), mi.BSDFContext()
            while active:
                si = scene.ray_intersect(ray, mi.RayFlags.All, True, active)
                throughput *= self.media.transmittance(stack, si.t)
                light = mi.DirectionSample3f(scene, si, previous)
                light_pdf = dr.select(delta, 0, scene.pdf_emitter_direction(previous, light, active & ~delta))
                emitted = light.emitter.eval(si, active & (light.emitter != None))  # noqa: E711
                result += dr.select(active, throughput * emitted * mis(pdf, light_pdf), 0)
                going = active & si.is_valid() & (depth + 1 < self.max_depth)
                number = dr.gather(mi.UInt32, self.table, dr.reinterpret_array(mi.UInt32, si.shape), going)
                wo_front = dr.dot(si.n, ray.d) < 0
                inner = left(stack, number, dr.select)
                beyond = dr.select(wo_front, entered(stack, number), inner)
                here = dr.select(wo_front | (inner != stack), innermost(stack), number)
                before = dr.gather(mi.Float, self.media.iors, here)
                after = dr.gather(mi.Float, self.media.iors, innermost(beyond))
                si.time = dr.select(number > 0, after / before, 0)
                bsdf = si.bsdf(ray)
                # Light by sampling emitters.
                lit = going & mi.has_flag(bsdf.flags(), mi.BSDFFlags.Smooth)
                chosen, radiance = scene.sample_emitter_direction(si, sampler.next_2d(), True, lit)
                lit &= chosen.pdf > 0
                f, f_pdf = bsdf.eval_pdf(context, si, si.to_local(chosen.d), lit)
                ng = dr.select(wo_front, si.n, -si.n)
                along = dr.select((number > 0) & (dr.dot(chosen.d, ng) < 0), beyond, stack)
                weight = dr.select(chosen.delta, 1, mis(chosen.pdf, f_pdf)) * self.media.transmittance(along, chosen.dist)
                result += dr.select(lit, throughput * f * radiance * weight, 0)
                # The next ray.
                scattered, weight = bsdf.sample(context, si, sampler.next_1d(), sampler.next_2d(), going)
                away = si.to_world(scattered.wo)
                ray = si.spawn_ray(away)
                stack = dr.select((number > 0) & (dr.dot(away, ng) < 0), beyond, stack)
                throughput *= weight
                eta *= scattered.eta
                previous, pdf = mi.Interaction3f(si), scattered.pdf
                delta = mi.has_flag(scattered.sampled_type, mi.BSDFFlags.Delta)
                depth += 1
                largest = dr.max(throughput)
                goes_on = dr.minimum(largest * eta * eta, 0.95)
                plays = depth >= 5
                survives = ~plays | (sampler.next_1d() < goes_on)
                throughput = dr.select(plays & (goes_on > 0), throughput / dr.maximum(goes_on, 1e-30), throughput)
                active = going & survives & (largest > 0)
            return result, mi.Bool(True), []

        def aov_names(self):
            return []
    return MediaPath


def mis(a, b):
    """The power heuristic."""
    return dr.select(a > 0, dr.square(a) / (dr.square(a) + dr.square(b)), 0)


@lru_cache(maxsize=None)
def unlit_class(_variant):
    class WithUnlit(mi.SamplingIntegrator):
        """What the camera sees of surfaces that are not there for other rays, over what another integrator gives."""

        def __init__(self, inner, unlit):
            super().__init__(mi.Properties())
            self.inner, self.unlit = inner, unlit

        def sample(self, scene, sampler, ray, medium=None, active=True):
            si = self.unlit.ray_intersect(ray, mi.RayFlags.All, True, active)
            behind = scene.ray_intersect_preliminary(ray, True, active)
            seen = si.is_valid() & (si.t < dr.select(behind.is_valid(), behind.t, dr.inf))
            si.wi.z = abs(si.wi.z)
            color = dr.select(seen, si.emitter(self.unlit).eval(si, seen), 0)
            light, _, _ = self.inner.sample(scene, sampler, ray, medium, active & ~seen)
            return dr.select(seen, color, light), mi.Bool(True), []

        def aov_names(self):
            return []
    return WithUnlit
