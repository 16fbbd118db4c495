#!/usr/bin/env python3
"""Pictures a second at equal noise: views of one scene, as of a data set, by one renderer in the Python that has it.

    pictures.py glim VIEWS.json SCENE.glb           writes the views, and measures
    pictures.py mitsuba|bpy|pyrender VIEWS.json SCENE.glb

Light of 1 W/(sr m^2) comes from everywhere. Each renderer keeps the scene and moves the camera. The seconds of a picture are those of all
views but the first, at two numbers of samples, from which the seconds at any number follow. Noise is from pairs of seeds. tests/bench/README.md
has the table."""

import argparse
import json
import os
import struct
import sys
import tempfile
import time

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
SIZE, VIEWS, NOISE = 256, 12, .02  # NOISE: RMSE as a share of the picture's mean
BOUNCES = 12


class Glim:
    def __init__(self, scene):
        import glim
        self.scene = glim.load(scene, size=(SIZE, SIZE), environment=(1, 1, 1), bounces=BOUNCES)

    def views(self):
        films = self.scene.render_many(turntable=VIEWS, spp=1)
        return [{"K": np.array(film.camera.K("corner")).tolist(), "pose": np.array(film.camera.pose("gltf")).tolist()} for film in films]

    def render(self, view, spp, seed):
        import glim
        camera = glim.Camera(view["K"], origin="corner", pose=view["pose"], axes="gltf", size=(SIZE, SIZE))
        return np.array(self.scene.render(camera=camera, spp=spp, seed=seed).rgb)


def with_camera(scene):
    """A copy of a .glb in which a camera is the first node; the reader for Mitsuba wants one."""
    with open(scene, "rb") as file:
        content = file.read()
    length = struct.unpack_from("<I", content, 12)[0]
    document, rest = json.loads(content[20:20 + length]), content[20 + length:]
    document["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": .01}}]
    document["nodes"].append({"camera": 0, "translation": [0, 0, 5]})
    document["scenes"][document.get("scene", 0)]["nodes"].append(len(document["nodes"]) - 1)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    path = os.path.join(tempfile.mkdtemp(), "camera.glb")
    with open(path, "wb") as file:
        file.write(struct.pack("<4s3I4s", b"glTF", 2, 20 + len(text) + len(rest), len(text), b"JSON") + text + rest)
    return path


class Mitsuba:
    def __init__(self, scene):
        sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(HERE)), "tools"))
        import mitsuba as mi
        from mitsuba_check.renderers import choose_variant
        mi.set_variant(choose_variant())
        mi.set_log_level(mi.LogLevel.Error)
        from mitsuba_check.build_scene import build_scene
        from mitsuba_check.plugins import register_plugins
        from mitsuba_check.scene import read_scene
        register_plugins()
        read = read_scene(with_camera(scene))
        self.mi, self.scene = mi, build_scene(read, (SIZE, SIZE), BOUNCES, [1.0, 1.0, 1.0])
        self.sensor = mi.traverse(self.scene.sensors()[0])

    def render(self, view, spp, seed):
        flip = np.diag([-1.0, 1, -1, 1])  # Mitsuba's cameras look along +z, and x is to the left
        self.sensor["x_fov"] = 2 * np.degrees(np.arctan(SIZE / 2 / view["K"][0][0]))
        self.sensor["to_world"] = self.mi.Transform4f(np.array(view["pose"]) @ flip)
        self.sensor.update()
        return np.array(self.mi.render(self.scene, seed=seed, spp=spp))[..., :3]


class Cycles:
    def __init__(self, scene):
        import bpy
        self.bpy = bpy
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.import_scene.gltf(filepath=os.path.abspath(scene))
        made = bpy.context.scene
        made.world = bpy.data.worlds.new("white")
        made.world.use_nodes = True
        made.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)
        made.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        made.collection.objects.link(made.camera)
        render, cycles = made.render, made.cycles
        render.engine, render.use_persistent_data = "CYCLES", True
        render.resolution_x = render.resolution_y = SIZE
        render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
        cycles.device, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", False, False
        cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = BOUNCES
        cycles.sample_clamp_indirect, cycles.blur_glossy = 0, 0
        self.path = os.path.join(tempfile.mkdtemp(), "view.exr")
        render.filepath = self.path

    def render(self, view, spp, seed):
        import mathutils
        made = self.bpy.context.scene
        made.cycles.samples, made.cycles.seed = spp, seed
        made.camera.data.sensor_fit, made.camera.data.angle = "HORIZONTAL", 2 * np.arctan(SIZE / 2 / view["K"][0][0])
        made.camera.data.clip_start, made.camera.data.clip_end = 1e-3, 1e4
        upright = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])  # Blender's up is z
        made.camera.matrix_world = mathutils.Matrix((upright @ np.array(view["pose"])).tolist())
        self.bpy.ops.render.render(write_still=True)
        image = self.bpy.data.images.load(self.path)
        pixels = np.array(image.pixels).reshape(SIZE, SIZE, 4)[::-1, :, :3]
        self.bpy.data.images.remove(image)
        return pixels


class Pyrender:
    """Rasterizes: no shadows, no light between surfaces, no noise."""

    def __init__(self, scene):
        os.environ.setdefault("PYOPENGL_PLATFORM", "egl")
        import pyrender
        import trimesh
        self.scene = pyrender.Scene.from_trimesh_scene(trimesh.load(scene, force="scene"))
        self.scene.ambient_light = (1.0, 1.0, 1.0)
        self.renderer = pyrender.OffscreenRenderer(SIZE, SIZE)
        self.camera = self.scene.add(pyrender.PerspectiveCamera(yfov=1.0))

    def render(self, view, spp, seed):
        self.camera.camera.yfov = 2 * np.arctan(SIZE / 2 / view["K"][1][1])
        self.scene.set_pose(self.camera, np.array(view["pose"]))
        return np.array(self.renderer.render(self.scene)[0], float)


def measure(renderer, views):
    fewest, most = 4, 64
    renderer.render(views[0], most, 0)
    seconds = {}
    for spp in (fewest, most):
        begin = time.perf_counter()
        pictures = [renderer.render(view, spp, 1) for view in views]
        seconds[spp] = (time.perf_counter() - begin) / len(views)
    slope = (seconds[most] - seconds[fewest]) / (most - fewest)
    others = [renderer.render(view, most, 2) for view in views[:4]]
    noise = np.mean([np.mean((one - other) ** 2) / 2 / np.mean((one + other) / 2) ** 2 for one, other in zip(pictures, others)])
    spp = max(1, int(np.ceil(noise * most / NOISE ** 2)))
    return {"mean": float(np.mean(pictures)), "seconds at %d" % fewest: seconds[fewest], "seconds at %d" % most: seconds[most],
            "RMSE at %d" % most: float(np.sqrt(noise)), "samples": spp,
            "pictures a second": 1 / (seconds[fewest] + (spp - fewest) * slope)}


def main():
    kinds = {"glim": Glim, "mitsuba": Mitsuba, "bpy": Cycles, "pyrender": Pyrender}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("renderer", choices=kinds)
    parser.add_argument("views")
    parser.add_argument("scene")
    options = parser.parse_args()
    renderer = kinds[options.renderer](options.scene)
    if options.renderer == "glim":
        with open(options.views, "w", encoding="utf-8") as file:
            json.dump(renderer.views(), file)
    with open(options.views, encoding="utf-8") as file:
        views = json.load(file)
    print(options.renderer, json.dumps(measure(renderer, views)))


if __name__ == "__main__":
    main()
