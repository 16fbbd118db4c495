"""Materials of Collada: those of the course's profile, else the diffuse part of the common one."""

import math
import os
import urllib.parse

import collada
import numpy

from conversion.collada_xml import children, described, find, some_numbers, tag_of
from conversion.embed_images import ImageEmbedder
from conversion.errors import ConversionError

PROFILES = ("CGL", "CMU462")  # of Berkeley's CS 184 and of CMU's 15-462: the same elements
BSDFS = ("emission", "mirror", "glass", "refraction", "microfacet")
GREY = [0.5] * 3  # the course's, where a material says nothing


def course_technique(element):
    """The <technique> of the course's profile among an element's <extra>; None without one."""
    techniques = [technique for extra in children(element, "extra") for technique in children(extra, "technique")]
    return next((technique for technique in techniques if technique.get("profile") in PROFILES), None)


class ColladaMaterials:
    def __init__(self, path, root, dae, document, say):
        self.path, self.dae, self.document, self.say = path, dae, document, say
        self.effects = {e.get("id"): e for e in reversed(list(root.iter())) if tag_of(e) == "effect"}
        self.images = ImageEmbedder(document, say)
        self.written, self.radiances = {}, {}

    def numbers(self, element, tag, count, low=0.0, high=math.inf, default=None):
        """The numbers of a child element."""
        child = find(element, tag)
        place = "<%s> of %s" % (tag, self.place)
        if child is None:
            if default is None:
                raise ConversionError("%s: %s is missing; expected %s" % (self.path, place, "a number" if count == 1 else "three numbers"))
            return default
        values = some_numbers(self.path, place, child, count).tolist()
        if min(values) < low or max(values) > high:
            raise ConversionError("%s: %s is \"%s\"; expected numbers from %g%s"
                                  % (self.path, place, child.text.strip()[:80], low, "" if high == math.inf else " to %g" % high))
        return values

    def index_of(self, material):
        """In the document, of a <material>; of none, the course's grey."""
        key = None if material is None else material.get("id")
        if key not in self.written:
            self.written[key] = self.write(material)
        return self.written[key]

    def radiance_of(self, material):
        """What it emits by the course's profile; None if nothing."""
        self.index_of(material)
        return self.radiances.get(None if material is None else material.get("id"))

    def write(self, material):
        if material is None:
            return self.document.material("default", GREY, double_sided=True)
        self.place = described(material)
        instance = find(material, "instance_effect")
        if instance is None:
            raise ConversionError("%s: %s has no <instance_effect>; expected one" % (self.path, self.place))
        effect = self.effects[instance.get("url")[1:]]
        name = material.get("name") or material.get("id")
        technique = course_technique(effect)
        bsdfs = children(technique, *BSDFS) if technique is not None else []
        if bsdfs:
            return self.write_bsdf(material, name, bsdfs[-1])
        if technique is not None:
            self.say("%s: %s is drawn by its diffuse colour; expected one of %s in its profile %s"
                     % (self.path, self.place, ", ".join(BSDFS), technique.get("profile")))
        return self.write_common(name, self.dae.effects.get(effect.get("id")))

    def write_bsdf(self, material, name, bsdf):
        kind = tag_of(bsdf)
        if kind == "emission":
            radiance = self.numbers(bsdf, "radiance", 3)
            self.radiances[material.get("id")] = radiance
            return self.document.material(name, emission=radiance if any(radiance) else None)
        if kind == "mirror":
            color = self.numbers(bsdf, "reflectance", 3, high=1.0)
            return self.document.material(name, color, metallic=1.0, roughness=0.0, double_sided=True)
        if kind == "microfacet":
            # Of the course's Beckmann lobe glTF has the width: GGX of the same alpha, which is the roughness squared.
            alpha, = self.numbers(bsdf, "alpha", 1)
            eta, k = self.numbers(bsdf, "eta", 3), self.numbers(bsdf, "k", 3)
            # Fresnel's reflectance of a conductor at normal incidence; the rest of its curve is Schlick's in glTF.
            color = [((n - 1.0) ** 2 + x * x) / ((n + 1.0) ** 2 + x * x) for n, x in zip(eta, k)]
            return self.document.material(name, color, metallic=1.0, roughness=min(1.0, math.sqrt(alpha)), double_sided=True)
        ior, = self.numbers(bsdf, "ior", 1, low=1.0)
        extensions = {"transmission": {"transmissionFactor": 1.0}, "volume": {"thicknessFactor": 1.0}, "ior": {"ior": ior}}
        if kind == "refraction":  # without reflection, but where all light is reflected
            extensions["specular"] = {"specularFactor": 0.0}
        elif self.numbers(bsdf, "reflectance", 3, high=1.0, default=[1.0] * 3) != [1.0] * 3:
            self.say("%s: the <reflectance> of %s is left out: glass reflects all that it does not transmit" % (self.path, self.place))
        roughness, = self.numbers(bsdf, "roughness", 1, high=1.0, default=[0.0])
        color = self.numbers(bsdf, "transmittance", 3, high=1.0)
        return self.document.surface_material(name, color, roughness=roughness, extensions=extensions)

    def color(self, value, most, default):
        """Of a shader's parameter, from 0."""
        if not isinstance(value, (tuple, list)) or len(value) < 3 or not numpy.all(numpy.isfinite(value)):
            return default
        return [min(most, max(0.0, c)) for c in value[:3]]

    def alpha(self, effect):
        """A_ONE and RGB_ZERO of Collada 1.4.1, section 7 (<transparent>). Writers that leave 0 opacity mean opaque."""
        if not isinstance(effect.transparent, (tuple, list)) or len(effect.transparent) < 3:
            return 1.0
        share = effect.transparency if isinstance(effect.transparency, float) else 1.0
        red, green, blue, opacity = [*effect.transparent, 1.0][:4]
        alpha = opacity * share
        if effect.opaque_mode == collada.material.OPAQUE_MODE.RGB_ZERO:
            alpha = 1.0 - share * (0.212671 * red + 0.715160 * green + 0.072169 * blue)
        return min(1.0, alpha) if alpha > 0.0 else 1.0

    def write_common(self, name, effect):
        if effect is None:
            return self.document.material(name, GREY, double_sided=True)
        more, extensions = {"doubleSided": True}, {"specular": {"specularFactor": 0.0}}
        emission = self.color(effect.emission, math.inf, [0.0] * 3)
        if any(emission):
            more["emissiveFactor"] = [e / max(emission) for e in emission]
            extensions["emissive_strength"] = {"emissiveStrength": max(emission)}
        alpha = self.alpha(effect)
        if alpha < 1.0:
            more["alphaMode"] = "BLEND"
        base = self.texture(effect)
        color = [1.0] * 3 if base is not None else self.color(effect.diffuse, 1.0, GREY)
        return self.document.surface_material(name, color, roughness=1.0, alpha=alpha, base=base, extensions=extensions, **more)

    def texture(self, effect):
        textures = [e for e in effect.xmlnode.iter() if tag_of(e) == "texture"]
        if not isinstance(effect.diffuse, collada.material.Map):
            if textures:
                self.say("%s: the texture \"%s\" of %s is left out" % (self.path, textures[0].get("texture"), self.place))
            return None
        name = urllib.parse.unquote((effect.diffuse.sampler.surface.image.path or "").strip().removeprefix("file://")).replace("\\", "/")
        return self.images.texture(os.path.join(os.path.dirname(self.path), name), "the diffuse texture")
