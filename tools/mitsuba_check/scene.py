"""A scene as plain values in world coordinates, read from glTF as glim reads it (scenes/README.md)."""

import math
from dataclasses import dataclass, field

import numpy as np

from .gltf_file import BROKEN, GltfFile


@dataclass
class Material:
    kind: str  # lambert, mirror or glass
    color: list
    emission: list
    ior: float = 1.5
    double_sided: bool = False

    @property
    def emits(self):
        return max(self.emission) > 0


@dataclass
class Mesh:
    material: int
    positions: np.ndarray  # n x 3
    triangles: np.ndarray  # n x 3, counter-clockwise seen from the front
    normals: np.ndarray = None  # as many as positions; without, triangles are flat


@dataclass
class Sphere:
    material: int
    center: np.ndarray
    radius: float


@dataclass
class Light:
    kind: str  # point, spot or directional
    intensity: np.ndarray  # W/sr; directional: W/m^2
    position: np.ndarray
    direction: np.ndarray  # unit, the way light travels
    cosines: tuple = (1.0, 0.0)  # spot: inner, outer


@dataclass
class Camera:
    position: np.ndarray
    forward: np.ndarray
    up: np.ndarray
    yfov: float = None  # radians; None: orthographic
    half_height: float = None
    aspect: float = 1.0


@dataclass
class Scene:
    materials: list = field(default_factory=list)
    meshes: list = field(default_factory=list)
    spheres: list = field(default_factory=list)
    lights: list = field(default_factory=list)
    camera: Camera = None

    def bounds(self):
        """Centre and half diagonal of the box around everything that rays can meet."""
        corners = [mesh.positions[mesh.triangles.ravel()] for mesh in self.meshes]
        corners += [[sphere.center - sphere.radius, sphere.center + sphere.radius] for sphere in self.spheres]
        points = np.concatenate(corners)
        low, high = points.min(axis=0), points.max(axis=0)
        return (low + high) / 2, float(np.linalg.norm(high - low) / 2)


def unit(vector):
    return vector / np.linalg.norm(vector)


def read_material(entry):
    extensions, pbr = entry.get("extensions", {}), entry.get("pbrMetallicRoughness", {})

    def value(extension, name, otherwise):
        return extensions.get("KHR_materials_" + extension, {}).get(name, otherwise)
    metal = pbr.get("metallicFactor", 1) > 0.5 and pbr.get("roughnessFactor", 1) < 0.2
    kind = "glass" if value("transmission", "transmissionFactor", 0) > 0 else "mirror" if metal else "lambert"
    strength = value("emissive_strength", "emissiveStrength", 1)
    return Material(kind, pbr.get("baseColorFactor", [1, 1, 1, 1])[:3],
                    [strength * e for e in entry.get("emissiveFactor", (0, 0, 0))], value("ior", "ior", 1.5),
                    entry.get("doubleSided", False))


class Reader:
    def __init__(self, path):
        self.file, self.scene = GltfFile(path), Scene()
        self.scene.materials = [read_material(entry) for entry in self.file.json.get("materials", ())]
        self.default_material = len(self.scene.materials)
        self.scene.materials.append(read_material({}))

    def read(self):
        if "environment" in self.file.scene().get("extras", {}):
            self.file.refuse("has an environment map, which is not exported")
        for node, matrix in self.file.placed_nodes():
            for primitive in self.file.json["meshes"][node["mesh"]]["primitives"] if "mesh" in node else ():
                self.add_mesh(primitive, matrix)
            if "sphere" in node.get("extras", {}):
                self.add_sphere(node["extras"]["sphere"], matrix)
            if "KHR_lights_punctual" in node.get("extensions", {}):
                self.add_light(node["extensions"]["KHR_lights_punctual"]["light"], matrix)
            if "camera" in node and self.scene.camera is None:
                self.add_camera(self.file.json["cameras"][node["camera"]], matrix)
        if self.scene.camera is None:
            self.file.refuse("has no camera, expected one to render from")
        if not self.scene.meshes and not self.scene.spheres:
            self.file.refuse("has no triangle and no sphere, expected something to draw")
        self.check_lamps()
        return self.scene

    def add_mesh(self, primitive, matrix):
        if primitive.get("mode", 4) != 4:
            self.file.refuse("has a primitive of mode %d, expected triangles (4)" % primitive["mode"])
        attributes, linear = primitive["attributes"], matrix[:3, :3]
        points = self.file.array(attributes["POSITION"], "POSITION") @ linear.T + matrix[:3, 3]
        triangles = (self.file.array(primitive["indices"], "indices").astype(np.uint32) if "indices" in primitive
                     else np.arange(len(points), dtype=np.uint32)).reshape(-1, 3)
        mirrored, normals = np.linalg.det(linear) < 0, None
        if "NORMAL" in attributes:
            normals = self.file.array(attributes["NORMAL"], "NORMAL") @ np.linalg.inv(linear)
            normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
        material = primitive.get("material", self.default_material)
        self.scene.meshes.append(Mesh(material, points, triangles[:, ::-1] if mirrored else triangles, normals))

    def add_sphere(self, sphere, matrix):
        scales = np.linalg.norm(matrix[:3, :3], axis=0)
        if scales.max() - scales.min() > 1e-4 * scales.max():
            self.file.refuse("scales a sphere by %g %g %g, expected a uniform scale" % tuple(scales))
        material = sphere.get("material", self.default_material)
        self.scene.spheres.append(Sphere(material, matrix[:3, 3], sphere["radius"] * scales.mean()))

    def add_light(self, index, matrix):
        entry = self.file.json["extensions"]["KHR_lights_punctual"]["lights"][index]
        spot = entry.get("spot", {})
        cosines = math.cos(spot.get("innerConeAngle", 0)), math.cos(spot.get("outerConeAngle", math.pi / 4))
        intensity = entry.get("intensity", 1) * np.array(entry.get("color", (1, 1, 1)), float)
        self.scene.lights.append(Light(entry["type"], intensity, matrix[:3, 3], -unit(matrix[:3, 2]), cosines))

    def add_camera(self, entry, matrix):
        camera = Camera(matrix[:3, 3], -unit(matrix[:3, 2]), matrix[:3, 1])
        if entry["type"] == "perspective":
            camera.yfov, camera.aspect = entry["perspective"]["yfov"], entry["perspective"].get("aspectRatio", 1.0)
        else:
            camera.half_height = entry["orthographic"]["ymag"]
            camera.aspect = entry["orthographic"]["xmag"] / camera.half_height
        self.scene.camera = camera

    def check_lamps(self):
        """Mitsuba's emitters shine from one side. A sphere seen only from outside needs no other; glass that emits does."""
        for shape in self.scene.meshes + self.scene.spheres:
            material = self.scene.materials[shape.material]
            if material.emits and material.kind == "glass":
                self.file.refuse("has glass that emits light, which is not exported")
        inner = [mesh.positions for mesh in self.scene.meshes] + [self.scene.camera.position[None]]
        inner += [sphere.center[None] for sphere in self.scene.spheres] + [light.position[None] for light in self.scene.lights]
        points = np.concatenate(inner)
        for sphere in self.scene.spheres:
            material = self.scene.materials[sphere.material]
            distances = np.linalg.norm(points - sphere.center, axis=1)
            if material.emits and material.double_sided and np.count_nonzero(distances < sphere.radius) > 1:
                self.file.refuse("has something within a sphere that emits inwards, which is not exported")


def read_scene(path):
    reader = Reader(path)
    try:
        return reader.read()
    except BROKEN as error:
        return reader.file.refuse("is not glTF 2.0 (%s: %s)" % (type(error).__name__, error))
