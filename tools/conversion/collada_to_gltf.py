"""A Collada file as a glTF document: a node for each instance, in world space, y up. One with something of the course's profile is read as
the programs of the course read it, any other one as Collada 1.4.1 says; main.py lists the differences."""

import os

import numpy

from conversion.collada_cameras import write_camera
from conversion.collada_lights import ColladaLights
from conversion.collada_materials import course_technique
from conversion.collada_meshes import parts_of
from conversion.collada_scene import ColladaScene, Instance, Shape, box_of
from conversion.collada_transforms import apply, from_rows, matrix_of, to_gltf
from conversion.collada_xml import children, described, find, some_numbers, tag_of
from conversion.read_collada import read_collada

# Nodes that instance others, which do so too, may be many more than the file has bytes.
FEW_NODES, BYTES_PER_NODE = 10000, 4
MOST_LEVELS = 200
LARGEST = float(numpy.finfo(numpy.float32).max)
# Turns of the up axis to y, as rows: Collada 1.4.1, section 5 (<up_axis>), and the course's.
TURNS = {"Y_UP": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "X_UP": [[0, -1, 0], [1, 0, 0], [0, 0, 1]], "Z_UP": [[1, 0, 0], [0, 0, 1], [0, -1, 0]]}
COURSE_TURNS = {"Y_UP": TURNS["Y_UP"], "X_UP": [[0, 1, 0], [1, 0, 0], [0, 0, -1]], "Z_UP": [[-1, 0, 0], [0, 0, 1], [0, 1, 0]]}


class ColladaConverter:
    def __init__(self, scene):
        self.scene, self.document = scene, scene.document
        self.ids = {element.get("id"): element for element in reversed(list(scene.root.iter())) if element.get("id") is not None}
        self.geometries, self.cameras, self.lights = [], [], []
        self.parts, self.primitives, self.meshes, self.matrices = {}, {}, {}, {}
        self.visited, self.most_nodes = 0, FEW_NODES + os.path.getsize(scene.path) // BYTES_PER_NODE

    def convert(self):
        root = self.ids[find(self.scene.root, "scene/instance_visual_scene").get("url")[1:]]
        turn = self.turn()
        for node in children(root, "node"):
            self.visit(node, turn, 0)
        nodes = [self.shape_node(instance) for instance in self.geometries]
        for instance in self.cameras:
            write_camera(self.scene, instance)
        for instance, properties in zip(self.geometries, nodes):
            if properties is not None:
                self.document.node(instance.name, **properties)
        ColladaLights(self.scene).write(self.lights)
        if not self.document.json["nodes"]:
            self.scene.refuse("its scene is empty; expected a geometry, a light or a camera")
        return self.document

    def turn(self):
        element = find(self.scene.root, "asset/up_axis")
        name = (element.text or "").strip() if element is not None else "Y_UP"
        if name not in TURNS:
            self.scene.refuse("<up_axis> is \"%s\"; expected X_UP, Y_UP or Z_UP" % name[:40])
        return from_rows(self.scene.unit * numpy.array((COURSE_TURNS if self.scene.is_course else TURNS)[name], dtype=float))

    def visit(self, node, matrix, level):
        self.visited += 1
        if self.visited > self.most_nodes or level > MOST_LEVELS:
            limit = "%d levels of nodes" % MOST_LEVELS if level > MOST_LEVELS else "%d nodes" % self.most_nodes
            self.scene.refuse("its scene has more than %s at %s; expected fewer in a file of this size, and no node that instances itself"
                              % (limit, described(node)))
        if node not in self.matrices:
            self.matrices[node] = matrix_of(self.scene.path, node)
        matrix = matrix @ self.matrices[node]
        if not numpy.all(numpy.abs(matrix) <= LARGEST):
            self.scene.refuse("the matrix of %s and of those above it is not finite in float32" % described(node))
        name = node.get("name") or node.get("id") or "node"
        for element in node:
            tag, target = tag_of(element), self.ids.get(element.get("url", "#")[1:])
            if tag == "node":
                self.visit(element, matrix, level + 1)
            elif tag == "instance_node":
                self.visit(target, matrix, level + 1)
            elif tag == "instance_geometry":
                self.geometries.append(Instance(name, target, matrix, self.bindings(element)))
            elif tag == "instance_camera":
                self.cameras.append(Instance(name, target, matrix))
            elif tag == "instance_light":
                self.lights.append(Instance(name, target, matrix))
            elif tag == "instance_controller":
                self.visit_controller(name, element, target, matrix)

    def visit_controller(self, name, element, controller, matrix):
        """The mesh of a skin as it was bound, that of morph targets as it is without them."""
        kind = next(iter(children(controller, "skin", "morph")), None)
        target = self.ids.get(kind.get("source", "#")[1:]) if kind is not None else None
        if target is None or tag_of(target) != "geometry":
            self.scene.warn("%s of the node \"%s\" is left out, with its mesh" % (described(controller), name))
            return
        self.scene.warn("%s of the node \"%s\" is left out: the mesh keeps its shape" % (described(controller), name))
        bind = find(kind, "bind_shape_matrix")
        if bind is not None:
            place = "<bind_shape_matrix> of %s" % described(controller)
            matrix = matrix @ some_numbers(self.scene.path, place, bind, 16).reshape(4, 4)
        self.geometries.append(Instance(name, target, matrix, self.bindings(element)))

    def bindings(self, element):
        common = find(element, "bind_material/technique_common")
        bound = children(common, "instance_material") if common is not None else []
        return {instance.get("symbol"): self.ids[instance.get("target")[1:]] for instance in bound}

    def material_of(self, instance, symbol):
        """One material alone is meant whatever its symbol, as in the course's programs."""
        bound = instance.materials
        return bound.get(symbol) if symbol in bound or len(bound) != 1 else next(iter(bound.values()))

    def shape_node(self, instance):
        """The properties of its node; None if there is nothing to draw."""
        technique = course_technique(instance.element)
        sphere = find(technique, "sphere") if technique is not None else None
        return self.mesh_node(instance) if sphere is None else self.sphere_node(instance, sphere)

    def sphere_node(self, instance, sphere):
        radius = self.scene.number(sphere, "radius", instance.element, 0.0)
        if radius is None:
            self.scene.refuse("the <sphere> of %s has no <radius>; expected one" % described(instance.element))
        axes, center = instance.matrix[:3, :3], instance.matrix[:3, 3]
        scale = numpy.linalg.norm(axes[:, 0])
        if not numpy.allclose(axes.T @ axes, scale * scale * numpy.identity(3), rtol=0.0, atol=1e-4 * scale * scale):
            self.scene.refuse("the node \"%s\" stretches a sphere; expected one scale for all axes" % instance.name)
        material, radius = self.material_of(instance, None), float(radius * scale)
        index = self.scene.materials.index_of(material)
        self.scene.shapes.append(Shape(numpy.array([center - radius, center + radius]), [self.scene.materials.radiance_of(material)]))
        return {"translation": center.tolist(), "extras": {"sphere": {"radius": radius, "material": index}}}

    def mesh_node(self, instance):
        key = instance.element.get("id")
        if key not in self.parts:
            geometry = self.scene.dae.geometries.get(key)
            if geometry is None:
                self.scene.warn("%s is left out: it has no <mesh>" % described(instance.element))
            self.parts[key] = parts_of(geometry, self.scene.is_course, self.scene.warn) if geometry is not None else []
        parts = self.parts[key]
        if not parts:
            return None
        materials = [self.material_of(instance, part.symbol) for part in parts]
        indices = [self.scene.materials.index_of(material) for material in materials]
        box = box_of(apply(instance.matrix, numpy.concatenate([part.points for part in parts])))
        self.scene.shapes.append(Shape(box, map(self.scene.materials.radiance_of, materials)))
        if (key, *indices) not in self.meshes:
            primitives = [{**self.primitive(part), "material": material} for part, material in zip(parts, indices)]
            self.meshes[key, *indices] = self.document.mesh(*primitives)
        return {"mesh": self.meshes[key, *indices], "matrix": to_gltf(instance.matrix)}

    def primitive(self, part):
        """One part's, whatever its material: they share the data."""
        if part not in self.primitives:
            self.primitives[part] = self.document.primitive(part.points.tolist(), part.indices.tolist(), 0, **part.attributes)
        return self.primitives[part]


def collada_to_gltf(path, course, say):
    with numpy.errstate(all="ignore"):  # what is not finite is refused, or has no direction
        return ColladaConverter(ColladaScene(path, *read_collada(path, say), course, say)).convert()
