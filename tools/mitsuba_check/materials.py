"""glTF's materials as plain values, with the defaults of the specification and its extensions."""

import math
from dataclasses import dataclass, field, replace

import numpy as np

SMOOTH_ALPHA = 1e-3  # of roughness squared: below, glim takes a lobe as a delta lobe
MIN_ATTENUATION = 1e-6  # of a channel of the colour: black would have an infinite coefficient
REPEAT, CLAMP, MIRRORED = "repeat", "clamp", "mirrored"
WRAPS = {10497: REPEAT, 33071: CLAMP, 33648: MIRRORED}
NEAREST = {9728, 9984, 9986}  # filters that take one texel of a level


@dataclass(frozen=True)
class Texture:
    image: int
    uv_set: int = 0
    wraps: tuple = (REPEAT, REPEAT)
    nearest: bool = False
    transform: tuple = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))  # rows for u and v


@dataclass
class Material:
    base_color: list = field(default_factory=lambda: [1.0] * 3)
    emission: list = field(default_factory=lambda: [0.0] * 3)
    double_sided: bool = False
    alpha_mode: str = "OPAQUE"
    alpha: float = 1.0
    alpha_cutoff: float = 0.5
    metallic: float = 1.0
    roughness: float = 1.0  # glossiness, if glossy
    glossy: bool = False  # KHR_materials_pbrSpecularGlossiness, with a texture of both
    normal_scale: float = 1.0
    ior: float = 1.5
    specular: float = 1.0
    specular_color: list = field(default_factory=lambda: [1.0] * 3)
    transmission: float = 0.0
    diffuse_transmission: float = 0.0
    diffuse_transmission_color: list = field(default_factory=lambda: [1.0] * 3)
    solid: bool = False
    absorption: list = field(default_factory=lambda: [0.0] * 3)  # 1/m
    clearcoat: float = 0.0
    clearcoat_roughness: float = 0.0
    clearcoat_normal_scale: float = 1.0
    sheen_color: list = field(default_factory=lambda: [0.0] * 3)
    sheen_roughness: float = 0.0
    anisotropy: float = 0.0
    anisotropy_rotation: float = 0.0  # radians
    iridescence: float = 0.0
    iridescence_ior: float = 1.3
    iridescence_thickness: tuple = (100.0, 400.0)  # nm
    textures: dict = field(default_factory=dict)  # by the glTF name, "diffuseTexture" as "baseColorTexture"
    unlit: bool = False  # only the camera sees it, and nothing but its base colour
    unknown: list = field(default_factory=list)  # what is not exported

    @property
    def emits(self):
        return max(self.emission) > 0

    @property
    def layered(self):
        return (self.transmission > 0 or self.diffuse_transmission > 0 or self.clearcoat > 0 or max(self.sheen_color) > 0 or
                self.anisotropy > 0 or self.iridescence > 0)

    @property
    def transparent(self):
        return self.alpha_mode != "OPAQUE"

    @property
    def smooth(self):
        return self.roughness ** 2 < SMOOTH_ALPHA and "metallicRoughnessTexture" not in self.textures and not self.glossy

    @property
    def passes_straight(self):
        """A smooth thin wall, which refracts nothing: by its geometric normal alone."""
        return (self.transmission > 0 and not self.solid and self.metallic < 1 and self.smooth and
                not self.specular_textures and not (replace(self, transmission=0.0, diffuse_transmission=0.0).layered))

    @property
    def lets_through(self):
        """Whether light may go on behind it as if it were not there."""
        return self.transparent or self.passes_straight

    @property
    def specular_textures(self):
        return bool({"specularTexture", "specularColorTexture"} & set(self.textures))

    @property
    def smooth_glass(self):
        """A smooth solid dielectric tinted by the base colour, and nothing else."""
        plain = not replace(self, transmission=0.0).layered and "transmissionTexture" not in self.textures
        return (self.solid and self.transmission == 1 and self.metallic == 0 and self.specular == 1 and
                self.specular_color == [1, 1, 1] and self.smooth and plain and not self.specular_textures)

    def kind(self, colored=False):
        """lambert, mirror and glass are those that plugins of Mitsuba's own or a mirror stand for; all else is principled."""
        if self.textures.keys() - {"emissiveTexture"} or colored:
            return "principled"
        if self.smooth_glass:
            return "principled" if max(self.absorption) > 0 else "glass"
        if self.layered:
            return "principled"
        if self.metallic == 0 and self.specular == 0:
            return "lambert"
        return "mirror" if self.metallic == 1 and self.smooth else "principled"

    def tangent_set(self):
        """The texture coordinates that tangents follow, or None if it needs none."""
        for name in ("normalTexture", "clearcoatNormalTexture", "anisotropyTexture"):
            if name in self.textures:
                return self.textures[name].uv_set
        return 0 if self.anisotropy > 0 else None


def read_transform(entry):
    """KHR_texture_transform: translation * rotation * scale, counter-clockwise in a uv plane whose v points down."""
    (sx, sy), (tx, ty), turn = entry.get("scale", (1, 1)), entry.get("offset", (0, 0)), entry.get("rotation", 0)
    c, s = math.cos(turn), math.sin(turn)
    return (c * sx, s * sy, tx), (-s * sx, c * sy, ty)


def read_texture(json, info):
    """None if the texture names no image."""
    texture = json["textures"][info["index"]]
    source = texture.get("source")
    if source is None:
        return None
    sampler = json["samplers"][texture["sampler"]] if "sampler" in texture else {}
    moved = info.get("extensions", {}).get("KHR_texture_transform", {})
    wraps = tuple(WRAPS[sampler.get(key, 10497)] for key in ("wrapS", "wrapT"))
    nearest = sampler.get("magFilter", sampler.get("minFilter", 0)) in NEAREST
    return Texture(source, moved.get("texCoord", info.get("texCoord", 0)), wraps, nearest, read_transform(moved))


class MaterialReader:
    FACTORS = {  # field: extension, property
        "ior": ("ior", "ior"), "specular": ("specular", "specularFactor"),
        "specular_color": ("specular", "specularColorFactor"), "transmission": ("transmission", "transmissionFactor"),
        "diffuse_transmission": ("diffuse_transmission", "diffuseTransmissionFactor"),
        "diffuse_transmission_color": ("diffuse_transmission", "diffuseTransmissionColorFactor"),
        "clearcoat": ("clearcoat", "clearcoatFactor"), "clearcoat_roughness": ("clearcoat", "clearcoatRoughnessFactor"),
        "sheen_color": ("sheen", "sheenColorFactor"), "sheen_roughness": ("sheen", "sheenRoughnessFactor"),
        "anisotropy": ("anisotropy", "anisotropyStrength"), "anisotropy_rotation": ("anisotropy", "anisotropyRotation"),
        "iridescence": ("iridescence", "iridescenceFactor"), "iridescence_ior": ("iridescence", "iridescenceIor"),
    }
    # The texture is absent where this factor is 0.
    LAYERS = {"clearcoat": "clearcoat", "sheen": "sheen_color", "anisotropy": "anisotropy", "iridescence": "iridescence",
              "transmission": "transmission", "diffuseTransmission": "diffuse_transmission"}

    def __init__(self, json, entry):
        self.json, self.entry = json, entry
        self.extensions = entry.get("extensions", {})
        self.material = Material()

    def value(self, extension, name, otherwise):
        return self.extensions.get("KHR_materials_" + extension, {}).get(name, otherwise)

    def read(self):
        m, entry, pbr = self.material, self.entry, self.entry.get("pbrMetallicRoughness", {})
        for key, (extension, name) in self.FACTORS.items():
            setattr(m, key, self.value(extension, name, getattr(m, key)))
        color = pbr.get("baseColorFactor", [1, 1, 1, 1])
        m.base_color, m.alpha = color[:3], color[3]
        m.metallic, m.roughness = pbr.get("metallicFactor", 1), pbr.get("roughnessFactor", 1)
        strength = self.value("emissive_strength", "emissiveStrength", 1)
        m.emission = [strength * e for e in entry.get("emissiveFactor", (0, 0, 0))]
        m.double_sided = entry.get("doubleSided", False)
        m.alpha_mode, m.alpha_cutoff = entry.get("alphaMode", "OPAQUE"), entry.get("alphaCutoff", 0.5)
        m.iridescence_thickness = (self.value("iridescence", "iridescenceThicknessMinimum", 100),
                                   self.value("iridescence", "iridescenceThicknessMaximum", 400))
        self.read_textures(pbr)
        self.read_volume()
        self.read_glossiness()
        for prefix, factor in self.LAYERS.items():
            if np.max(getattr(m, factor)) == 0:
                m.textures = {name: texture for name, texture in m.textures.items() if not name.startswith(prefix)}
        m.unlit = "KHR_materials_unlit" in self.extensions
        if m.unlit:
            m.emission = [0.0] * 3
            if m.transparent:
                m.unknown.append("transparent unlit surfaces")
        if m.solid and self.value("dispersion", "dispersion", 0) > 0:
            m.unknown.append("KHR_materials_dispersion")
        return m

    def read_textures(self, pbr):
        places = [pbr, self.entry] + [entry for name, entry in self.extensions.items() if not name.endswith("Glossiness")]
        for place in places:
            for name, info in place.items():
                if name.endswith("Texture") and name not in ("occlusionTexture", "thicknessTexture"):
                    self.add_texture(name, info)
        self.material.normal_scale = self.entry.get("normalTexture", {}).get("scale", 1.0)
        self.material.clearcoat_normal_scale = self.value("clearcoat", "clearcoatNormalTexture", {}).get("scale", 1.0)

    def add_texture(self, name, info):
        texture = read_texture(self.json, info)
        if texture is not None:
            self.material.textures[name] = texture

    def read_volume(self):
        m = self.material
        m.solid = (m.transmission > 0 or m.diffuse_transmission > 0) and self.value("volume", "thicknessFactor", 0) > 0
        distance = self.value("volume", "attenuationDistance", math.inf)
        color = self.value("volume", "attenuationColor", [1, 1, 1])
        if m.solid:
            m.absorption = [-math.log(max(c, MIN_ATTENUATION)) / distance for c in color]

    def read_glossiness(self):
        """The archived extension gives the same lobes as metal and roughness, with F0 alone."""
        entry, m = self.extensions.get("KHR_materials_pbrSpecularGlossiness"), self.material
        if entry is None:
            return
        for name in ("baseColorTexture", "metallicRoughnessTexture", "specularTexture", "specularColorTexture"):
            m.textures.pop(name, None)
        color = entry.get("diffuseFactor", [1, 1, 1, 1])
        m.base_color, m.alpha, m.metallic, m.ior, m.specular = color[:3], color[3], 0.0, 0.0, 1.0
        m.specular_color, m.roughness = entry.get("specularFactor", [1, 1, 1]), entry.get("glossinessFactor", 1.0)
        m.glossy = True
        for name, ours in (("diffuseTexture", "baseColorTexture"), ("specularGlossinessTexture", "specularColorTexture")):
            if name in entry:
                self.add_texture(ours, entry[name])


def read_material(json, entry):
    return MaterialReader(json, entry).read()
