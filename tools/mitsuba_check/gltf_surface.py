"""What glTF's material and a shape of Mitsuba have at a hit: textures, colours of vertices, normals, coverage, emission."""

import math
from types import SimpleNamespace

import drjit as dr
import mitsuba as mi
import numpy as np

from .images import padded, wrapped


def lerp(a, b, t):
    return a + (b - a) * t


def reflect(wo, h):
    return 2 * dr.dot(wo, h) * h - wo


def greatest(v):
    return dr.maximum(v.x, dr.maximum(v.y, v.z))


class Lookup:
    """A texture in linear numbers at coordinates of the hit."""

    def __init__(self, texture, pixels):
        self.texture, self.size = texture, (pixels.shape[1], pixels.shape[0])
        tensor = mi.TensorXf(np.ascontiguousarray(padded(pixels, texture.wraps), dtype=np.float32))
        mode = dr.FilterMode.Nearest if texture.nearest else dr.FilterMode.Linear
        self.image = mi.Texture2f(tensor, filter_mode=mode, wrap_mode=dr.WrapMode.Clamp)

    def at(self, uvs):
        u, v = uvs[self.texture.uv_set]
        place = [wrapped(row[0] * u + row[1] * v + row[2], size, wrap, dr.floor)
                 for row, size, wrap in zip(self.texture.transform, self.size, self.texture.wraps)]
        return self.image.eval(mi.Point2f(*place))


def lat_long(w):
    """Texture coordinates on spheres; u grows towards +x around y, (.5, .5) is -z."""
    return 0.5 + dr.atan2(w.x, -w.z) / (2 * math.pi), dr.atan2(dr.sqrt(w.x * w.x + w.z * w.z), w.y) / math.pi


class Surface:
    """What material and shape have at a hit: textures, colours of vertices, normals."""

    def __init__(self, material, pixels, on_sphere, attributes):
        """pixels: linear RGBA by the texture's name; attributes: names of those that the mesh has."""
        self.material, self.on_sphere, self.attributes = material, on_sphere, attributes
        self.lookups = {name: Lookup(texture, pixels[name]) for name, texture in material.textures.items() if name in pixels}

    def coordinates(self, si, active):
        if self.on_sphere:
            return [lat_long(si.n)] * 2
        first = (si.uv.x, si.uv.y)
        if "vertex_uv1" not in self.attributes:
            return first, first if "uv" in self.attributes else (mi.Float(0), mi.Float(0))
        second = si.shape.eval_attribute_3("vertex_uv1", si, active)
        return first, (second.x, second.y)

    def sampled(self, name, uvs):
        """RGBA; white if there is no such texture."""
        if name not in self.lookups:
            return [1.0] * 4
        return self.lookups[name].at(uvs)

    def rgb(self, name, uvs):
        return mi.Color3f(*self.sampled(name, uvs)[:3])

    def alpha(self, si, active):
        """Coverage."""
        m = self.material
        value = mi.Float(m.alpha) * self.sampled("baseColorTexture", self.coordinates(si, active))[3]
        if "vertex_alpha" in self.attributes:
            value *= si.shape.eval_attribute_1("vertex_alpha", si, active)
        return dr.select(value >= m.alpha_cutoff, mi.Float(1), 0) if m.alpha_mode == "MASK" else value

    def emission(self, si, active):
        value = mi.Color3f(self.material.emission) * self.rgb("emissiveTexture", self.coordinates(si, active))
        return value * self.alpha(si, active) if self.material.transparent else value

    def unlit(self, si, active):
        color = mi.Color3f(self.material.base_color) * self.rgb("baseColorTexture", self.coordinates(si, active))
        return color * si.shape.eval_attribute_3("vertex_color", si, active) if "vertex_color" in self.attributes else color

    def tangent(self, si, active):
        """xyz and the sign of the bitangent."""
        if self.on_sphere:
            n = si.n
            return dr.select((n.x == 0) & (n.z == 0), mi.Vector3f(1, 0, 0), mi.Vector3f(-n.z, 0, n.x)), mi.Float(1)
        if "vertex_tangent" not in self.attributes:
            return mi.Vector3f(0), mi.Float(1)
        t = si.shape.eval_attribute_3("vertex_tangent", si, active)
        sign = si.shape.eval_attribute_1("vertex_handedness", si, active)
        return mi.Vector3f(t.x, t.y, t.z), dr.select(sign < 0, mi.Float(-1), 1)

    def mapped_normal(self, g, si, uvs, name, scale, active):
        """glTF 2.0, section 3.9.3, by neither normal nor tangent of unit length; turned with the side of the viewer."""
        tangent, sign = self.tangent(si, active)
        n = mi.Vector3f(si.n)
        if "vertex_raw_normal" in self.attributes:
            raw = si.shape.eval_attribute_3("vertex_raw_normal", si, active)
            n = mi.Vector3f(raw.x, raw.y, raw.z)
        x, y, z = [2 * c - 1 for c in self.sampled(name, uvs)[:3]]
        mapped = tangent * (x * scale) + dr.cross(n, tangent) * (sign * y * scale) + n * z
        usable = (dr.squared_norm(mapped) > 0) & (dr.squared_norm(tangent) > 0)
        return dr.select(usable, g.side * dr.normalize(mapped), g.ns)

    def at(self, si, active):
        m, g = self.material, SimpleNamespace()
        g.wo = si.to_world(si.wi)
        g.front = dr.dot(si.n, g.wo) > 0
        g.side = dr.select(g.front, mi.Float(1), -1)
        g.ng, g.ns = g.side * mi.Vector3f(si.n), g.side * mi.Vector3f(si.sh_frame.n)
        g.coat_normal = g.ns
        uvs = self.coordinates(si, active)
        self.read_base(g, si, uvs, active)
        self.read_layers(g, uvs)
        if "clearcoatNormalTexture" in self.lookups:
            g.coat_normal = self.mapped_normal(g, si, uvs, "clearcoatNormalTexture", m.clearcoat_normal_scale, active)
        if "normalTexture" in self.lookups:
            g.ns = self.mapped_normal(g, si, uvs, "normalTexture", m.normal_scale, active)
        if m.anisotropy > 0:
            tangent, sign = self.tangent(si, active)
            bitangent = dr.cross(g.side * g.ns, tangent) * sign
            g.tangent = tangent * g.turn[0] + bitangent * g.turn[1]
        # Where solids meet, the integrator knows the index, and absorbs (integrator.py).
        alone = dr.select(g.front, m.ior, 1 / m.ior) if m.solid else mi.Float(1)
        g.eta, g.beer = dr.select(si.time > 0, si.time, alone), mi.Color3f(1)
        if max(m.absorption) > 0:
            depth = dr.select(g.front | (si.time > 0), 0, si.t)
            g.beer = dr.exp(-mi.Color3f(m.absorption) * depth)
        return g

    def read_base(self, g, si, uvs, active):
        m = self.material
        rough, tint = self.sampled("metallicRoughnessTexture", uvs), self.sampled("specularColorTexture", uvs)
        g.base = mi.Color3f(m.base_color) * self.rgb("baseColorTexture", uvs)
        if "vertex_color" in self.attributes:
            g.base *= si.shape.eval_attribute_3("vertex_color", si, active)
        g.metallic, g.roughness = mi.Float(m.metallic) * rough[2], mi.Float(m.roughness) * rough[1]
        g.specular = mi.Float(m.specular) * self.sampled("specularTexture", uvs)[3]
        g.specular_color = mi.Color3f(m.specular_color) * mi.Color3f(*tint[:3])
        if m.glossy:
            g.roughness = 1 - g.roughness * tint[3]
            g.base *= 1 - dr.clip(greatest(g.specular_color), 0, 1)

    def read_layers(self, g, uvs):
        m = self.material
        g.transmission = mi.Float(m.transmission) * self.sampled("transmissionTexture", uvs)[0]
        g.diffuse_transmission = mi.Float(m.diffuse_transmission) * self.sampled("diffuseTransmissionTexture", uvs)[3]
        g.far_color = mi.Color3f(m.diffuse_transmission_color) * self.rgb("diffuseTransmissionColorTexture", uvs)
        g.coat = mi.Float(m.clearcoat) * self.sampled("clearcoatTexture", uvs)[0]
        g.coat_roughness = mi.Float(m.clearcoat_roughness) * self.sampled("clearcoatRoughnessTexture", uvs)[1]
        g.sheen = mi.Color3f(m.sheen_color) * self.rgb("sheenColorTexture", uvs)
        g.sheen_roughness = mi.Float(m.sheen_roughness) * self.sampled("sheenRoughnessTexture", uvs)[3]
        g.film = mi.Float(m.iridescence) * self.sampled("iridescenceTexture", uvs)[0]
        thin, thick = m.iridescence_thickness
        g.thickness = lerp(mi.Float(thin), thick, self.sampled("iridescenceThicknessTexture", uvs)[1])
        g.anisotropy, turn = mi.Float(m.anisotropy), (math.cos(m.anisotropy_rotation), math.sin(m.anisotropy_rotation))
        g.turn = turn
        if "anisotropyTexture" in self.lookups:
            a = self.sampled("anisotropyTexture", uvs)
            x, y = 2 * a[0] - 1, 2 * a[1] - 1
            size = dr.sqrt(x * x + y * y)
            x, y = dr.select(size > 0, x / size, 1), dr.select(size > 0, y / size, 0)
            g.anisotropy *= a[2]
            g.turn = turn[0] * x - turn[1] * y, turn[1] * x + turn[0] * y


def visible_normal(g):
    """The shading normal on the viewer's side, bent until a mirror would reflect outwards."""
    ns = dr.select(dr.dot(g.ns, g.wo) > 0, g.ns, g.ng)
    mirrored = reflect(g.wo, ns)
    least, outwards = dr.minimum(0.9 * dr.dot(g.ng, g.wo), 0.01), dr.dot(mirrored, g.ng)
    bent = dr.normalize(g.wo + dr.normalize(mirrored + g.ng * (least - outwards)))
    return dr.select(outwards >= least, ns, bent)


def frame_along(n, tangent):
    x = tangent - n * dr.dot(n, tangent)
    square = dr.squared_norm(x)
    usable = square > 1e-12 * dr.squared_norm(tangent)
    plain = mi.Frame3f(n)
    x = dr.select(usable, x / dr.sqrt(dr.select(usable, square, 1)), plain.s)
    return mi.Frame3f(x, dr.cross(n, x), n)
