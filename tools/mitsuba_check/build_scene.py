"""Makes a Mitsuba scene from the plain one, of objects in memory: no file is written."""

import math

import mitsuba as mi
import numpy as np

from .images import SRGB, rows_for_mitsuba, to_linear
from .meshes import join, two_sheets
from .scene import Environment, solids_meet

# Mitsuba's max_depth counts the camera's segment as well.
FIRST_SEGMENT = 1


def color(value):
    return {"type": "rgb", "value": [float(v) for v in value]}


def stock_bsdf(kind, material):
    if kind == "glass":
        return {"type": "dielectric", "int_ior": float(material.ior), "ext_ior": 1.0,
                "specular_transmittance": color(material.base_color)}
    if kind == "mirror":
        return {"type": "schlick_mirror", **dict(zip("rgb", map(float, material.base_color)))}
    return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": color(material.base_color)}}


class Images:
    """The file's images, decoded once for each use."""

    def __init__(self, file):
        self.file, self.found = file, {}

    def pixels(self, texture, name):
        key = texture.image, name in SRGB
        if key not in self.found:
            stream = mi.MemoryStream()
            stream.write(self.file.image(texture.image))
            stream.seek(0)
            self.found[key] = to_linear(np.array(mi.Bitmap(stream)), name)
        return self.found[key]

    def of(self, material):
        return {name: self.pixels(texture, name) for name, texture in material.textures.items()}


class Appearance:
    """What a shape of some material is given: its BSDF and emitter."""

    def __init__(self, material, images, on_sphere=False, attributes=(), meets=False):
        """meets: solids of the scene meet, so that glass does not always end at air."""
        self.material = material
        kind = material.kind("vertex_color" in attributes)
        kind = "principled" if meets and kind == "glass" else kind
        self.surface, self.lobes = None, None
        if kind == "principled" or material.transparent or material.unlit or "emissiveTexture" in material.textures:
            from .gltf_lobes import Lobes
            from .gltf_surface import Surface
            pixels = images.of(material)
            self.surface = Surface(material, pixels, on_sphere, attributes)
            self.lobes = Lobes(material, pixels) if kind == "principled" and not (material.smooth_glass or material.unlit) else None
        self.kind = kind

    def bsdf(self):
        if self.kind == "principled" and not self.material.unlit:
            from .gltf_bsdf import bsdf_class
            scattering = bsdf_class(mi.variant())(self.surface, self.lobes)
        else:
            scattering = stock_bsdf("lambert" if self.material.unlit else self.kind, self.material)
        if not self.material.transparent:
            return scattering
        return {"type": "mask", "opacity": self.texture(self.surface.alpha), "bsdf": scattering}

    def texture(self, value):
        from .gltf_bsdf import texture_class
        return texture_class(mi.variant())(value)

    def emitter(self):
        if self.material.unlit:
            return {"emitter": {"type": "area", "radiance": self.texture(self.surface.unlit)}}
        if not self.material.emits:
            return {}
        textured = self.surface is not None and ("emissiveTexture" in self.material.textures or self.material.transparent)
        radiance = self.texture(self.surface.emission) if textured else color(self.material.emission)
        return {"emitter": {"type": "area", "radiance": radiance}}


def attributes_of(mesh):
    """What BSDFs read of a mesh, by name: rows of 1 or 3 columns."""
    found = {}
    if mesh.uvs and mesh.uvs[1] is not None:
        found["vertex_uv1"] = np.concatenate([mesh.uvs[1], np.zeros((len(mesh.positions), 1))], axis=1)
    if mesh.colors is not None:
        found["vertex_color"], found["vertex_alpha"] = mesh.colors[:, :3], mesh.colors[:, 3:]
    if mesh.tangents is not None:
        found["vertex_tangent"], found["vertex_handedness"] = mesh.tangents[:, :3], mesh.tangents[:, 3:]
        if mesh.normals is not None:
            found["vertex_raw_normal"] = mesh.normals
    return found


def make_mesh(name, mesh, material, images, meets):
    """Flat triangles unless there are normals."""
    attributes, properties = attributes_of(mesh), mi.Properties()
    uv = mesh.uvs[0] if mesh.uvs else None
    look = Appearance(material, images, attributes=set(attributes) | ({"uv"} if uv is not None else set()), meets=meets)
    for key, entry in {"bsdf": look.bsdf(), **look.emitter()}.items():
        properties[key] = mi.load_dict(entry) if isinstance(entry, dict) else entry
    made = mi.Mesh(name, vertex_count=len(mesh.positions), face_count=len(mesh.triangles),
                   has_vertex_normals=mesh.normals is not None, has_vertex_texcoords=uv is not None, props=properties)
    for key, rows in attributes.items():
        made.add_attribute(key, rows.shape[1], np.ravel(rows).astype(np.float32))
    values = mi.traverse(made)
    values["vertex_positions"] = np.ravel(mesh.positions).astype(np.float32)
    values["faces"] = np.ravel(mesh.triangles).astype(np.uint32)
    if mesh.normals is not None:
        values["vertex_normals"] = np.ravel(mesh.normals).astype(np.float32)
    if uv is not None:
        values["vertex_texcoords"] = np.ravel(uv).astype(np.float32)
    values.update()
    return made


def groups_of(scene):
    """Lists of meshes to join: all of one material and the same attributes, but each lamp alone, since Mitsuba gives each emitter the
    same share of samples."""
    groups = {}
    for index, mesh in enumerate(scene.meshes):
        lamp = index if scene.materials[mesh.material].emits else None
        has = tuple(rows is not None for rows in (mesh.normals, mesh.colors, mesh.tangents, *(mesh.uvs or (None, None))))
        groups.setdefault((mesh.material, has, lamp), []).append(mesh)
    return groups


class Shapes:
    """Those that all rays see, those that only the camera sees, and the numbers of media by the shape's name."""

    def __init__(self, scene):
        self.meet, self.images = solids_meet(scene), Images(scene.file)
        self.eye = list(map(float, scene.camera.position))
        self.plain, self.unlit, self.numbers, self.media = {}, {}, {}, []
        used = {shape.material for shape in scene.meshes + scene.spheres}
        self.lets_through = any(scene.materials[i].lets_through for i in used)
        for (index, _has, _lamp), same in groups_of(scene).items():
            material, mesh = scene.materials[index], join(same)
            if material.emits and material.double_sided:
                mesh = two_sheets(mesh)
            name = "mesh_%d" % (len(self.plain) + len(self.unlit))
            self.add(name, material, make_mesh(name, mesh, material, self.images, self.meet))
        for i, sphere in enumerate(scene.spheres):
            material = scene.materials[sphere.material]
            look = Appearance(material, self.images, on_sphere=True, meets=self.meet)
            self.add("sphere_%d" % i, material,
                     {"type": "sphere", "center": list(map(float, sphere.center)), "radius": float(sphere.radius),
                      "bsdf": look.bsdf(), **look.emitter()})

    def add(self, name, material, shape):
        (self.unlit if material.unlit else self.plain)[name] = shape
        if material.solid:
            medium = material.ior, tuple(material.absorption)
            if medium not in self.media:
                self.media.append(medium)
            self.numbers[name] = self.media.index(medium) + 1

    def integrator(self, bounces):
        depth = bounces + FIRST_SEGMENT
        if self.meet:
            from .integrator import Media, integrator_class
            media = Media(self.numbers, [ior for ior, _ in self.media], [absorption for _, absorption in self.media])
            found = integrator_class(mi.variant())(depth, media, self.eye)
        else:
            # Of the two, `volpath` alone lets what surfaces pass straight through to its light samples.
            found = {"type": "volpath" if self.lets_through else "path", "max_depth": depth}
        if self.unlit:
            from .integrator import unlit_class
            inner = mi.load_dict(found) if isinstance(found, dict) else found
            found = unlit_class(mi.variant())(inner, mi.load_dict({"type": "scene", **self.unlit}))
        return found


def light_entry(light):
    position, direction = [list(map(float, v)) for v in (light.position, light.direction)]
    if light.kind == "point":
        return {"type": "point", "position": position, "intensity": color(light.intensity)}
    if light.kind == "directional":
        return {"type": "directional", "direction": direction, "irradiance": color(light.intensity)}
    return {"type": "ramped_spot", "position": position, "axis": direction, **dict(zip("rgb", map(float, light.intensity))),
            "cos_inner": light.cosines[0], "cos_outer": light.cosines[1]}


def sensor_of(scene, size):
    camera = scene.camera
    center, radius = scene.bounds()
    reach = radius + float(np.linalg.norm(camera.position - center))
    turn = mi.ScalarTransform4f().look_at(origin=list(map(float, camera.position)), up=list(map(float, camera.up)),
                                          target=list(map(float, camera.position + camera.forward)))
    film = {"type": "hdrfilm", "width": size[0], "height": size[1], "pixel_format": "rgb", "component_format": "float32",
            "rfilter": {"type": "box"}}
    common = {"film": film, "sampler": {"type": "independent"}, "near_clip": 1e-4 * reach, "far_clip": 1e2 * reach}
    if camera.yfov is not None:
        return {"type": "perspective", "fov": math.degrees(camera.yfov), "fov_axis": "y", "to_world": turn, **common}
    half_width = camera.half_height * size[0] / size[1]
    return {"type": "orthographic", "to_world": turn @ mi.ScalarTransform4f().scale([half_width, half_width, 1]), **common}


def environment_map(environment):
    """Mitsuba's own map, turned to where glim has it."""
    pixels = np.array(mi.Bitmap(environment.path).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False), float)
    pixels = environment.strength * rows_for_mitsuba(pixels)
    turn = mi.ScalarTransform4f().rotate([0, 1, 0], 180)
    return {"type": "envmap", "bitmap": mi.Bitmap(pixels.astype(np.float32)), "to_world": turn}


def build_scene(scene, size, bounces, environment=None):
    shapes = Shapes(scene)
    entries = {"type": "scene", "integrator": shapes.integrator(bounces), "sensor": sensor_of(scene, size), **shapes.plain}
    for i, light in enumerate(scene.lights):
        entries["light_%d" % i] = light_entry(light)
    if isinstance(environment, str):
        entries["environment"] = environment_map(Environment(environment))
    elif environment is not None:
        entries["environment"] = {"type": "constant", "radiance": color(environment)}
    elif scene.environment is not None:
        entries["environment"] = environment_map(scene.environment)
    return mi.load_dict(entries)
