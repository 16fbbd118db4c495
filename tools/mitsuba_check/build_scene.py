"""Makes a Mitsuba scene from the plain one, of objects in memory: no file is written."""

import math

import mitsuba as mi
import numpy as np

from .meshes import join, two_sheets

# Mitsuba's max_depth counts the camera's segment as well.
FIRST_SEGMENT = 1


def color(value):
    return {"type": "rgb", "value": [float(v) for v in value]}


def bsdf(material):
    if material.kind == "glass":
        return {"type": "dielectric", "int_ior": float(material.ior), "ext_ior": 1.0,
                "specular_transmittance": color(material.color)}
    if material.kind == "mirror":
        return {"type": "schlick_mirror", **dict(zip("rgb", map(float, material.color)))}
    return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": color(material.color)}}


def emitter(material):
    return {"emitter": {"type": "area", "radiance": color(material.emission)}} if material.emits else {}


def make_mesh(name, material, positions, triangles, normals):
    """Flat triangles unless there are normals."""
    properties = mi.Properties()
    for key, entry in {"bsdf": bsdf(material), **emitter(material)}.items():
        properties[key] = mi.load_dict(entry)
    mesh = mi.Mesh(name, vertex_count=len(positions), face_count=len(triangles), has_vertex_normals=normals is not None,
                   props=properties)
    values = mi.traverse(mesh)
    values["vertex_positions"] = np.ravel(positions).astype(np.float32)
    values["faces"] = np.ravel(triangles).astype(np.uint32)
    if normals is not None:
        values["vertex_normals"] = np.ravel(normals).astype(np.float32)
    values.update()
    return mesh


def groups_of(scene):
    """Lists of meshes to join: all of one material, but each lamp alone, since Mitsuba gives each emitter the same share of samples."""
    groups = {}
    for index, mesh in enumerate(scene.meshes):
        lamp = index if scene.materials[mesh.material].emits else None
        groups.setdefault((mesh.material, mesh.normals is not None, lamp), []).append(mesh)
    return groups


def meshes_of(scene):
    shapes = {}
    for (index, smooth, _lamp), same in groups_of(scene).items():
        material, (positions, triangles) = scene.materials[index], join(same)
        normals = np.concatenate([mesh.normals for mesh in same]) if smooth else None
        if material.emits and material.double_sided:
            (positions, triangles), normals = two_sheets(positions, triangles), None
        name = "mesh_%d" % len(shapes)
        shapes[name] = make_mesh(name, material, positions, triangles, normals)
    return shapes


def spheres_of(scene):
    return {"sphere_%d" % i: {"type": "sphere", "center": list(map(float, sphere.center)), "radius": float(sphere.radius),
                              "bsdf": bsdf(scene.materials[sphere.material]), **emitter(scene.materials[sphere.material])}
            for i, sphere in enumerate(scene.spheres)}


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


def build_scene(scene, size, bounces, environment=None):
    entries = {"type": "scene", "integrator": {"type": "path", "max_depth": bounces + FIRST_SEGMENT},
               "sensor": sensor_of(scene, size), **meshes_of(scene), **spheres_of(scene)}
    for i, light in enumerate(scene.lights):
        entries["light_%d" % i] = light_entry(light)
    if environment is not None:
        entries["environment"] = {"type": "constant", "radiance": color(environment)}
    return mi.load_dict(entries)
