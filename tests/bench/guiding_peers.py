#!/usr/bin/env python3
"""Error at equal CPU time where light is hard to find: glim with and without --guiding on, Mitsuba's path, and Cycles with and without path
guiding, all of them on the CPU. Run it by a Python that has mitsuba, bpy and numpy of PyPI, while the machine does nothing else.

Each renderer takes as many samples as fit into --seconds of CPU time, user and system of all threads. Loading, starting and compiling do not
count: a render of one sample without a guide is subtracted. Learning a guide counts. relMSE is that of a render, from the scatter of the seeds
(of two, half of their squared difference), over the squared mean of 5x5 pixels of the picture that has least of it. Brackets hold 95 % of draws
of seeds and tiles of 16x16 pixels; a renderer that rarely finds a light may have them too low. The efficiency is 1 / (relMSE x CPU seconds).
Means are relative to those of the same picture. Cycles gets diffuse, mirror and smooth glass surfaces of its own, and no limit that would make
it biased; --bounces is for all. No test runs this."""

import argparse
import json
import multiprocessing
import os
import resource
import sys
import tempfile
from types import SimpleNamespace

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tools"))
sys.dont_write_bytecode = True
from mitsuba_check.arguments import size, whole  # noqa: E402
from mitsuba_check.renderers import Glim, Mitsuba, read_picture  # noqa: E402
from mitsuba_check.report import with_interval  # noqa: E402
from mitsuba_check.scene import read_scene  # noqa: E402
from peer_efficiency.estimates import relmse_of, weights_around  # noqa: E402
from scene_makers.material_scenes import lamp_water  # noqa: E402

SCENES = ("cornell", "closed_room", "door_ajar", "shaded_lamp", "lamp_water", "mirror_room")
FEW, MORE = 4, 20  # samples of renders that tell how many fit
NO_STUDIO = ["--environment", "none"]  # of glim's own, which joins lamps that seem to show little


class GlimByTurns:
    who = resource.RUSAGE_CHILDREN

    def __init__(self, options, guided):
        self.guided, self.glim = guided, Glim(options, options.folder, options.glim)

    def render(self, spp, seed):
        self.glim.more = NO_STUDIO + (["--guiding", "on"] if self.guided else [])
        return self.glim.render(seed, spp)

    read = staticmethod(read_picture)

    def start(self):
        self.glim.more = NO_STUDIO
        self.glim.render(0, 1)


class MitsubaByTurns:
    who = resource.RUSAGE_SELF

    def __init__(self, options, _guided):
        self.mitsuba = Mitsuba(read_scene(options.scene), options)

    def render(self, spp, seed):
        return self.mitsuba.render(seed, spp)

    read = staticmethod(np.asarray)

    def start(self):
        self.mitsuba.render(0, 1)


class Cycles:
    """The plain scene in Blender, whose world has y up as the file has it: nothing there depends on which way is up."""

    who = resource.RUSAGE_SELF

    def __init__(self, options, guided):
        import bpy
        self.bpy, self.guided, self.size = bpy, guided, options.size
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.made = bpy.context.scene
        self.plain = read_scene(options.scene)
        if self.plain.lights or self.plain.environment:
            self.plain.file.refuse("has lights that are no surfaces, which Cycles does not get here")
        self.set_up(options)
        materials = {}
        for shape in self.plain.meshes + self.plain.spheres:
            if shape.material not in materials:
                materials[shape.material] = self.material(self.plain.materials[shape.material])
            mesh = self.mesh(shape) if hasattr(shape, "triangles") else self.ball(shape)
            mesh.materials.append(materials[shape.material])
            self.add(mesh)
        self.look()

    def set_up(self, options):
        render, cycles = self.made.render, self.made.cycles
        render.engine = "CYCLES"
        render.resolution_x, render.resolution_y = options.size
        render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
        render.filepath = os.path.join(options.folder, "cycles.exr")
        cycles.device, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", False, False
        cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = options.bounces
        cycles.sample_clamp_indirect, cycles.blur_glossy, cycles.light_sampling_threshold = 0, 0, 0
        cycles.pixel_filter_type, cycles.filter_width = "BOX", 1

    def add(self, data):
        thing = self.bpy.data.objects.new("", data)
        self.made.collection.objects.link(thing)
        return thing

    def mesh(self, shape):
        mesh = self.bpy.data.meshes.new("")
        mesh.from_pydata(shape.positions.tolist(), [], shape.triangles.tolist())
        if shape.normals is not None:
            mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
            mesh.normals_split_custom_set_from_vertices(shape.normals.tolist())
        return mesh

    def ball(self, shape):
        import bmesh
        from mathutils import Matrix
        made, mesh = bmesh.new(), self.bpy.data.meshes.new("")
        bmesh.ops.create_icosphere(made, subdivisions=6, radius=shape.radius, matrix=Matrix.Translation(shape.center.tolist()))
        made.to_mesh(mesh)
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
        return mesh

    def material(self, plain):
        made = self.bpy.data.materials.new("")
        made.use_nodes = True
        tree, color = made.node_tree, [*map(float, plain.base_color), 1.0]
        tree.nodes.clear()
        kind = plain.kind()
        if kind == "principled":
            self.plain.file.refuse("has a material that Cycles does not get here")
        surface = tree.nodes.new({"lambert": "ShaderNodeBsdfDiffuse", "mirror": "ShaderNodeBsdfGlossy", "glass": "ShaderNodeBsdfGlass"}[kind])
        surface.inputs["Color"].default_value, surface.inputs["Roughness"].default_value = color, 0.0
        if kind == "glass":
            surface.inputs["IOR"].default_value = plain.ior
        end = surface.outputs[0]
        if plain.emits:
            emission = tree.nodes.new("ShaderNodeEmission")
            emission.inputs["Color"].default_value = [*map(float, plain.emission), 1.0]
            end = emission.outputs[0]  # of a black surface, as all lamps here are
        if not plain.double_sided and kind != "glass":
            side, clear, mix = (tree.nodes.new("ShaderNode" + name) for name in ("NewGeometry", "BsdfTransparent", "MixShader"))
            tree.links.new(side.outputs["Backfacing"], mix.inputs[0])
            tree.links.new(end, mix.inputs[1])
            tree.links.new(clear.outputs[0], mix.inputs[2])
            end = mix.outputs[0]
            if not plain.emits:
                end = surface.outputs[0]  # as glim with --back-faces shown, and Mitsuba
        tree.links.new(end, tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
        if plain.emits:
            made.cycles.emission_sampling = "FRONT"
        return made

    def look(self):
        from mathutils import Matrix
        camera, eye = self.bpy.data.cameras.new(""), self.plain.camera
        camera.sensor_fit, camera.angle = "VERTICAL", eye.yfov
        camera.clip_start, camera.clip_end = 1e-3, 1e4
        right = np.cross(eye.forward, eye.up)
        pose = np.eye(4)
        pose[:3] = np.column_stack([right, eye.up, -eye.forward, eye.position])
        self.made.camera = self.add(camera)
        self.made.camera.matrix_world = Matrix(pose.tolist())

    def render_it(self, spp, seed, guided):
        cycles = self.made.cycles
        cycles.samples, cycles.seed, cycles.use_guiding = spp, seed, guided
        self.bpy.ops.render.render(write_still=True)

    def render(self, spp, seed):
        self.render_it(spp, seed, self.guided)
        return self.made.render.filepath

    def read(self, path):
        image = self.bpy.data.images.load(path)
        pixels = np.array(image.pixels, float).reshape(self.size[1], self.size[0], 4)[::-1, :, :3]
        self.bpy.data.images.remove(image)
        return pixels

    def start(self):
        self.render_it(1, 0, False)


RENDERERS = {"glim": (GlimByTurns, False), "glim, guided": (GlimByTurns, True), "Mitsuba": (MitsubaByTurns, False),
             "Cycles": (Cycles, False), "Cycles, guided": (Cycles, True)}


def cpu_seconds(who):
    used = resource.getrusage(who)
    return used.ru_utime + used.ru_stime


# A process for each renderer: libraries of two do not get along, and their seconds stay apart.
def serve(name, options, pipe):
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # Blender prints to it
    kind, guided = RENDERERS[name]
    renderer = kind(options, guided)
    renderer.start()
    while True:
        spp, seed = pipe.recv()
        began = cpu_seconds(renderer.who)
        result = renderer.render(spp, seed) if spp else renderer.start()
        seconds = cpu_seconds(renderer.who) - began
        pipe.send((np.array(renderer.read(result)) if spp else None, seconds))


class Side:
    """A renderer that renders by turns with others."""

    def __init__(self, name, options):
        self.name, self.pictures, self.seconds = name, [], []
        self.pipe, others = multiprocessing.Pipe()
        self.process = multiprocessing.get_context("spawn").Process(target=serve, args=(name, options, others), daemon=True)
        self.process.start()
        others.close()  # so that its end is seen here
        self.start = min(self.run(0)[1] for _ in range(2))
        self.run(FEW)  # compiles what a guide needs
        few, more = self.run(FEW)[1] - self.start, MORE
        for _ in range(2):
            each = max((self.run(more)[1] - self.start - few) / (more - FEW), 1e-6)
            self.spp = min(64 * more, max(FEW, FEW + int((options.seconds - few) / each)))
            more = max(MORE, self.spp // 4)

    def run(self, spp, seed=0):
        """The picture, none if spp is 0, and the CPU seconds."""
        self.pipe.send((spp, seed))
        return self.pipe.recv()

    def add(self, seed):
        picture, seconds = self.run(self.spp, seed)
        self.pictures.append(picture)
        self.seconds.append(seconds - self.start)


def rows_of(scene, sides):
    """Errors relative to one picture: that of the renderer which has least of them by its own."""
    renders = {side.name: np.array(side.pictures) for side in sides}
    own = {name: relmse_of(seeds, weights_around(seeds.mean(axis=0)))["value"] for name, seeds in renders.items()}
    best = renders[min(own, key=own.get)].mean(axis=0)
    rows = []
    for side in sides:
        error, seconds = relmse_of(renders[side.name], weights_around(best)), float(np.median(side.seconds))
        rows.append({"scene": scene, "renderer": side.name, "spp": side.spp, "cpu": seconds, "relmse": error,
                     "mean": float(renders[side.name].mean() / best.mean()),
                     "efficiency": {"value": 1 / (error["value"] * seconds), "low": 1 / (error["high"] * seconds),
                                    "high": 1 / (error["low"] * seconds)}})
    return rows


def measure(scene, options):
    path = os.path.join(options.folder, "lamp_water.gltf")
    if scene == "lamp_water":
        lamp_water().write(path)
    else:
        path = os.path.join(ROOT, "scenes", scene + ".gltf")
    options = SimpleNamespace(**{**vars(options), "scene": path, "environment": None, "spp": MORE})
    sides = [Side(name, options) for name in options.renderers]
    for seed in range(1, options.seeds + 1):
        for side in sides:
            side.add(seed)
        print("%s: %d of %d rounds" % (scene, seed, options.seeds), file=sys.stderr, flush=True)
    for side in sides:
        side.process.kill()  # Blender's and Mitsuba's threads may keep it from its end
    return rows_of(scene, sides)


def line_of(row):
    cells = ["`%s`" % row["scene"], row["renderer"], "%d" % row["spp"], "%.3g" % row["cpu"], with_interval(row["relmse"], "value", "%.3g"),
             with_interval(row["efficiency"], "value", "%.3g"), "%.3f" % row["mean"]]
    return "| %s |" % " | ".join(cells)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("glim", help="the program")
    parser.add_argument("--scenes", nargs="+", default=SCENES, choices=SCENES, metavar="SCENE", help="[%s]" % " ".join(SCENES))
    parser.add_argument("--renderers", nargs="+", default=list(RENDERERS), choices=RENDERERS, metavar="NAME", help="[all]")
    parser.add_argument("--size", type=size, default=(96, 96), metavar="WxH", help="pixels [96x96]")
    parser.add_argument("--seconds", type=float, default=30, help="CPU seconds of each render [30]")
    parser.add_argument("--seeds", type=whole(2), default=4, help="renders by each [4]")
    parser.add_argument("--bounces", type=whole(0), default=64, help="most surface events between camera and light [64]")
    parser.add_argument("--json", help="write the figures as JSON, too, after each scene")
    return parser.parse_args()


def main():
    options, rows = parse_arguments(), []
    print("| scene | renderer | samples | CPU s | relMSE | efficiency | mean |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory(prefix="glim-guiding-") as options.folder:
        for scene in options.scenes:
            rows += measure(scene, options)
            print("\n".join(line_of(row) for row in rows if row["scene"] == scene), flush=True)
            if options.json:
                with open(options.json, "w", encoding="utf-8") as file:
                    json.dump(rows, file, indent=2)


if __name__ == "__main__":
    main()
