"""A scene as plain values in world coordinates, read from glTF as glim reads it (scenes/README.md)."""

import math
import os
from dataclasses import dataclass, field, replace

import numpy as np

from .gltf_file import BROKEN, GltfFile
from .materials import read_material
from .tangents import corner_tangents, unit_rows


@dataclass
class Mesh:
    material: int
    positions: np.ndarray  # n x 3
    triangles: np.ndarray  # n x 3, counter-clockwise seen from the front
    normals: np.ndarray = None  # as many as positions; without, triangles are flat
    uvs: list = field(default_factory=list)  # of set 0 and set 1, n x 2 or None; empty: there are none
    colors: np.ndarray = None  # n x 4
    tangents: np.ndarray = None  # n x 4, the last column the sign of the bitangent


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
class Environment:
    path: str
    strength: float = 1.0


@dataclass
class Scene:
    file: GltfFile = None
    materials: list = field(default_factory=list)
    meshes: list = field(default_factory=list)
    spheres: list = field(default_factory=list)
    lights: list = field(default_factory=list)
    camera: Camera = None
    environment: Environment = None

    def bounds(self):
        """Centre and half diagonal of the box around everything that rays can meet."""
        corners = [mesh.positions[mesh.triangles.ravel()] for mesh in self.meshes]
        corners += [[sphere.center - sphere.radius, sphere.center + sphere.radius] for sphere in self.spheres]
        points = np.concatenate(corners)
        low, high = points.min(axis=0), points.max(axis=0)
        return (low + high) / 2, float(np.linalg.norm(high - low) / 2)


def unit(vector):
    return vector / np.linalg.norm(vector)


def has_light(scene):
    """Else glim lights it by its studio. A lamp with a texture does not count, as there."""
    used = {shape.material for shape in scene.meshes + scene.spheres}
    lamps = [scene.materials[i] for i in used if scene.materials[i].emits and "emissiveTexture" not in scene.materials[i].textures]
    return bool(lamps or scene.lights or scene.environment)


def require_light(scene, remedy=""):
    if not has_light(scene):
        scene.file.refuse("has no light, and Mitsuba does not have glim's studio" + remedy)


def size_of(scene, height):
    """Pixels of that height by the camera's aspect ratio."""
    return max(1, round(height * scene.camera.aspect)), height


def boxes_of_shapes(scene):
    """Material and box of everything that is drawn."""
    for mesh in scene.meshes:
        yield mesh.material, mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    for sphere in scene.spheres:
        yield sphere.material, sphere.center - sphere.radius, sphere.center + sphere.radius


def solids_meet(scene):
    """Whether paths within a solid may end elsewhere than at its boundary, or begin there: boxes of solids of different media overlap, or
    one that absorbs has something else or the camera in its box."""
    shapes, eye = [], scene.camera.position
    for index, low, high in boxes_of_shapes(scene):
        material = scene.materials[index]
        shapes.append(((material.ior, *material.absorption) if material.solid else None, max(material.absorption), low, high))
    if any(absorbs and np.all(low < eye) and np.all(eye < high) for _, absorbs, low, high in shapes):
        return True
    return any(a[0] != b[0] and (a[0] and b[0] or a[1] or b[1]) and np.all(a[2] < b[3]) and np.all(b[2] < a[3])
               for i, a in enumerate(shapes) for b in shapes[:i])


class Reader:
    def __init__(self, path):
        self.file = GltfFile(path)
        self.scene = Scene(self.file)
        self.scene.materials = [read_material(self.file.json, entry) for entry in self.file.json.get("materials", ())]
        self.default_material = len(self.scene.materials)
        self.scene.materials.append(read_material(self.file.json, {}))

    def read(self):
        if "environment" in self.file.scene().get("extras", {}):
            self.add_environment(self.file.scene()["extras"]["environment"])
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
        self.check_materials()
        return self.scene

    def add_environment(self, entry):
        path = self.file.path_of(entry["file"])
        if not os.path.exists(path):
            self.file.refuse("has an environment map, %s, which cannot be read" % entry["file"])
        self.scene.environment = Environment(path, entry.get("strength", 1.0))

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
        mesh = Mesh(material, points, triangles[:, ::-1] if mirrored else triangles, normals, self.uvs_of(attributes),
                    self.colors_of(attributes))
        if "TANGENT" in attributes:
            given = self.file.array(attributes["TANGENT"], "TANGENT")
            sign = -given[:, 3:] if mirrored else given[:, 3:]
            mesh.tangents = np.concatenate([unit_rows(given[:, :3] @ linear.T), sign], axis=1)
        self.scene.meshes.append(self.with_tangents(mesh))

    def uvs_of(self, attributes):
        sets = [self.file.array(attributes[name], name) if name in attributes else None for name in ("TEXCOORD_0", "TEXCOORD_1")]
        return sets if any(uv is not None for uv in sets) else []

    def colors_of(self, attributes):
        if "COLOR_0" not in attributes:
            return None
        colors = np.clip(self.file.array(attributes["COLOR_0"], "COLOR_0"), 0, 1)
        return colors if colors.shape[1] == 4 else np.concatenate([colors, np.ones((len(colors), 1))], axis=1)

    def with_tangents(self, mesh):
        """The mesh by corners, if its material needs tangents that it has not; flat triangles have those of their faces."""
        uv_set = self.scene.materials[mesh.material].tangent_set()
        if uv_set is None or (mesh.tangents is not None and mesh.normals is not None):
            return mesh
        if not mesh.uvs or mesh.uvs[uv_set] is None:
            return replace(mesh, tangents=None)
        corners = mesh.triangles.ravel()

        def by_corner(rows):
            return None if rows is None else rows[corners]
        positions, uv = mesh.positions[mesh.triangles], mesh.uvs[uv_set][mesh.triangles].astype(float)
        if mesh.normals is None:
            normals = unit_rows(np.cross(positions[:, 1] - positions[:, 0], positions[:, 2] - positions[:, 0]))[:, None, :]
            normals = np.repeat(normals, 3, axis=1)
        else:
            normals = mesh.normals[mesh.triangles]
        return Mesh(mesh.material, mesh.positions[corners], np.arange(len(corners), dtype=np.uint32).reshape(-1, 3),
                    by_corner(mesh.normals), [by_corner(uv_) for uv_ in mesh.uvs], by_corner(mesh.colors),
                    corner_tangents(positions, normals, uv).reshape(-1, 4))

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
            if material.emits and material.transmission > 0:
                self.file.refuse("has glass that emits light, which is not exported")
            if material.emits and material.clearcoat > 0:
                self.file.refuse("has a lamp under a clearcoat, which is not exported")
        inner = [mesh.positions for mesh in self.scene.meshes] + [self.scene.camera.position[None]]
        inner += [sphere.center[None] for sphere in self.scene.spheres] + [light.position[None] for light in self.scene.lights]
        points = np.concatenate(inner)
        for sphere in self.scene.spheres:
            material = self.scene.materials[sphere.material]
            distances = np.linalg.norm(points - sphere.center, axis=1)
            if material.emits and material.double_sided and np.count_nonzero(distances < sphere.radius) > 1:
                self.file.refuse("has something within a sphere that emits inwards, which is not exported")

    def check_materials(self):
        used = {shape.material for shape in self.scene.meshes + self.scene.spheres}
        for name in sorted({name for index in used for name in self.scene.materials[index].unknown}):
            self.file.refuse("uses %s, which is not exported" % name)


def read_scene(path):
    reader = Reader(path)
    try:
        return reader.read()
    except BROKEN as error:
        return reader.file.refuse("is not glTF 2.0 (%s: %s)" % (type(error).__name__, error))
