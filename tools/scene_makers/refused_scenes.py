"""Broken files, one for each thing that the loader refuses. Each is broken in one way only.

scenes/README.md lists why they are refused, and a test compares that.
"""

import struct

from .gltf_document import Document, pack, to_glb, to_text


def triangle():
    document = Document()
    document.shape("triangle", [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [0, 1, 2], document.material("grey", (0.5, 0.5, 0.5)))
    return document


def edit(change):
    """Text of a triangle's document after `change` edited its JSON."""
    document = triangle().finish(embed=True)
    change(document)
    return to_text(document).encode()


def put(*path_and_value):
    *path, last, value = path_and_value

    def change(document):
        for key in path:
            document = document[key]
        document[last] = value
    return edit(change)


def drop(*path):
    *path, last = path

    def change(document):
        for key in path:
            document = document[key]
        del document[last]
    return edit(change)


def build(make):
    """Text of a triangle's Document after `make` added to it."""
    document = triangle()
    make(document)
    return to_text(document.finish(embed=True)).encode()


def with_vertex(value):
    document = triangle()
    document.data[4:8] = struct.pack("<f", value)
    return to_text(document.finish(embed=True)).encode()


def sparse(index, **more):
    def make(document):
        values = document.view(pack("f", [0.0, 0.0, 1.0]))
        document.json["accessors"][0]["sparse"] = {
            "count": 1, "indices": {"bufferView": document.view(pack("H", [index])), "componentType": 5123},
            "values": {"bufferView": values, **more}}
    return build(make)


def sphere(**node):
    def make(document):
        document.node("ball", extras={"sphere": {"radius": 1.0, "material": 0}}, **node)
    return build(make)


def camera(properties):
    return build(lambda document: document.node("eye", camera=document.append("cameras", properties)))


def light(properties):
    return build(lambda document: document.light("lamp", properties))


def glb(cut=0, magic=b"glTF", version=2):
    document = triangle()
    content = bytearray(to_glb(document.finish(embed=False), bytes(document.data)))
    content[0:4] = magic
    content[4:8] = struct.pack("<I", version)
    return bytes(content[:len(content) - cut])


def skin(joints=(0,), joint=0, matrices=0):
    """The triangle follows `joint` of the skin."""
    def make(document):
        accessor = lambda code, kind, values, component: document.append("accessors", {
            "bufferView": document.view(pack(code, values)), "componentType": component, "count": 3, "type": kind})
        document.json["meshes"][0]["primitives"][0]["attributes"].update(
            JOINTS_0=accessor("B", "VEC4", [joint, 0, 0, 0] * 3, 5121), WEIGHTS_0=accessor("f", "VEC4", [1, 0, 0, 0] * 3, 5126))
        document.json["skins"] = [{"joints": list(joints)}]
        document.json["nodes"][0]["skin"] = 0
        if matrices:
            identity = [float(i % 5 == 0) for i in range(16)]
            document.json["skins"][0]["inverseBindMatrices"] = document.append("accessors", {
                "bufferView": document.view(pack("f", identity * matrices)), "componentType": 5126, "count": matrices, "type": "MAT4"})
    return build(make)


def animation(times=(0.0, 1.0), channel=0):
    """Moves the triangle."""
    def make(document):
        numbers = lambda kind, values: document.append("accessors", {
            "bufferView": document.view(pack("f", values)), "componentType": 5126, "count": 2, "type": kind})
        document.json["animations"] = [{
            "samplers": [{"input": numbers("SCALAR", times), "output": numbers("VEC3", [0.0] * 6)}],
            "channels": [{"sampler": 0, "target": {"node": channel, "path": "translation"}}]}]
    return build(make)


def perspective(yfov, **more):
    return {"type": "perspective", "perspective": {"yfov": yfov, "znear": 0.1, **more}}


GLASS = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 0.5}}

REFUSED = {
    # the file
    "empty_file.gltf": lambda: b"",
    "not_json.gltf": lambda: b'{"asset": {"version": "2.0"},}\n',
    "deep_json.gltf": lambda: put("extras", 0).replace(b'"extras": 0', b'"extras": ' + b"[" * 300 + b"]" * 300),
    "huge_number.gltf": lambda: put("extras", 0).replace(b'"extras": 0', b'"extras": 1e999'),
    "wrong_magic.glb": lambda: glb(magic=b"GLTF"),
    "wrong_container_version.glb": lambda: glb(version=1),
    "truncated.glb": lambda: glb(cut=10),
    "no_asset.gltf": lambda: drop("asset"),
    "old_version.gltf": lambda: put("asset", "version", "1.0"),
    "required_extension.gltf": lambda: put("extensionsRequired", ["KHR_gaussian_splatting_compression_spz"]),
    # buffers and accessors
    "missing_buffer.gltf": lambda: put("buffers", 0, "uri", "nowhere.bin"),
    "absolute_buffer.gltf": lambda: put("buffers", 0, "uri", "https://example.org/a.bin"),
    "no_buffer_uri.gltf": lambda: drop("buffers", 0, "uri"),
    "truncated_buffer.gltf": lambda: put("buffers", 0, "byteLength", 64),
    "odd_data_uri.gltf": lambda: put("buffers", 0, "uri", "data:text/html"),
    "view_past_buffer.gltf": lambda: put("bufferViews", 0, "byteLength", 4096),
    "view_without_buffer.gltf": lambda: put("bufferViews", 0, "buffer", 7),
    "negative_offset.gltf": lambda: put("bufferViews", 0, "byteOffset", -12),
    "small_stride.gltf": lambda: put("bufferViews", 0, "byteStride", 8),
    "accessor_without_view.gltf": lambda: put("accessors", 0, "bufferView", 9),
    "accessor_past_view.gltf": lambda: put("accessors", 0, "count", 4),
    "missing_count.gltf": lambda: drop("accessors", 0, "count"),
    "fractional_count.gltf": lambda: put("accessors", 0, "count", 3.5),
    "vector_of_two.gltf": lambda: put("accessors", 0, "type", "VEC2"),
    "odd_component.gltf": lambda: put("accessors", 0, "componentType", 5124),
    "float_indices.gltf": lambda: put("accessors", 1, "componentType", 5126),
    "sparse_past_end.gltf": lambda: sparse(3),
    "sparse_far_away.gltf": lambda: sparse(0, byteOffset=4294967296),
    "nan_position.gltf": lambda: with_vertex(float("nan")),
    "infinite_position.gltf": lambda: with_vertex(float("inf")),
    # meshes and nodes
    "index_past_end.gltf": lambda: build(lambda d: d.data.__setitem__(slice(40, 42), struct.pack("<H", 3))),
    "no_such_accessor.gltf": lambda: put("meshes", 0, "primitives", 0, "attributes", "POSITION", 5),
    "no_such_material.gltf": lambda: put("meshes", 0, "primitives", 0, "material", 1),
    "half_triangle.gltf": lambda: put("accessors", 1, "count", 2),
    "too_few_normals.gltf": lambda: build(lambda d: d.json["meshes"][0]["primitives"][0]["attributes"].update(
        NORMAL=d.positions([[0, 0, 1], [0, 0, 1]]))),
    "mesh_is_a_string.gltf": lambda: put("nodes", 0, "mesh", "x"),
    "no_such_mesh.gltf": lambda: put("nodes", 0, "mesh", 3),
    "no_such_child.gltf": lambda: put("nodes", 0, "children", [8]),
    "no_such_root.gltf": lambda: put("scenes", 0, "nodes", [0, 4]),
    "root_twice.gltf": lambda: put("scenes", 0, "nodes", [0, 0]),
    "no_such_scene.gltf": lambda: put("scene", 2),
    "cyclic_nodes.gltf": lambda: edit(lambda d: d["nodes"].extend([{"children": [2]}, {"children": [1]}])),
    "two_parents.gltf": lambda: edit(lambda d: d["nodes"].extend([{}, {"children": [1]}, {"children": [1]}])),
    "projective_node.gltf": lambda: put("nodes", 0, "matrix", [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]),
    "zero_rotation.gltf": lambda: put("nodes", 0, "rotation", [0, 0, 0, 0]),
    "beyond_float.gltf": lambda: put("nodes", 0, "scale", [1e39, 1e39, 1e39]),
    "nothing_to_draw.gltf": lambda: put("scenes", 0, "nodes", []),
    "only_flat_triangles.gltf": lambda: build(lambda d: d.data.__setitem__(slice(36, 42), struct.pack("<3H", 0, 1, 1))),
    # skins, morph targets, animations
    "no_such_joint.gltf": lambda: skin(joints=(0, 5)),
    "joint_past_end.gltf": lambda: skin(joint=1),
    "few_bind_matrices.gltf": lambda: skin(joints=(0, 0), matrices=1),
    "weight_without_target.gltf": lambda: put("meshes", 0, "weights", [1]),
    "no_such_animated_node.gltf": lambda: animation(channel=2),
    "nan_time.gltf": lambda: animation(times=(0.0, float("nan"))),
    # spheres, materials, lights, cameras, environment
    "stretched_sphere.gltf": lambda: sphere(scale=[1, 2, 1]),
    "negative_radius.gltf": lambda: build(lambda d: d.sphere("ball", (0, 0, 0), -1.0, 0)),
    "sphere_without_radius.gltf": lambda: build(lambda d: d.node("ball", extras={"sphere": {"material": 0}})),
    "sphere_material.gltf": lambda: build(lambda d: d.sphere("ball", (0, 0, 0), 1.0, 6)),
    "negative_emission.gltf": lambda: put("materials", 0, "emissiveFactor", [1, -1, 0]),
    "bright_colour.gltf": lambda: put("materials", 0, "pbrMetallicRoughness", "baseColorFactor", [2, 1, 1, 1]),
    "low_ior.gltf": lambda: put("materials", 0, "extensions", GLASS),
    "no_such_light.gltf": lambda: put("nodes", 0, "extensions", {"KHR_lights_punctual": {"light": 0}}),
    "odd_light.gltf": lambda: light({"type": "laser"}),
    "negative_light.gltf": lambda: light({"type": "point", "intensity": -1}),
    "inverted_spot.gltf": lambda: light({"type": "spot", "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.25}}),
    "no_such_camera.gltf": lambda: put("nodes", 0, "camera", 0),
    "odd_camera.gltf": lambda: camera({"type": "fisheye"}),
    "flat_camera.gltf": lambda: camera(perspective(0)),
    "camera_aspect.gltf": lambda: camera(perspective(1, aspectRatio=-1)),
    "environment_map.gltf": lambda: put("scenes", 0, "extras", {"environment": {"file": "sky.exr", "strength": 1}}),
}
