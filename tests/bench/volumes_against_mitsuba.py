#!/usr/bin/env python3
"""Scattering volumes by glim and by Mitsuba's volpathmis, side by side: the means and the blocks of three pictures.

Usage: volumes_against_mitsuba.py GLIM [SEEDS]

Needs mitsuba and numpy of PyPI. No test runs it; tests/MEASUREMENTS.md has what it printed.
"""
import json
import math
import subprocess
import sys
import tempfile
from base64 import b64encode
from pathlib import Path

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
SIDE, BLOCK, SAMPLES = 32, 8, 256
EYE, TARGET, FOV = (0.0, 1.6, 7.0), (0.0, 0.9, 0.0), 30.0
LAMP, GREY = 12.0, 0.5
# Name, shape, index, extinction per metre, colour of a thick body, anisotropy.
SCENES = (("ball without a boundary", "ball", 1.0, (0.8, 2.0, 6.0), (0.9, 0.6, 0.3), 0.6),
          ("ball of index 1.4", "ball", 1.4, (3.0, 3.0, 3.0), (0.7, 0.5, 1.0), 0.0),
          ("cube of index 1.25", "cube", 1.25, (1.0, 4.0, 10.0), (0.6, 0.8, 0.9), -0.4))
FLOOR = ([[-4, 0, 4], [4, 0, 4], [4, 0, -4], [-4, 0, -4]], [0, 1, 2, 0, 2, 3])
SQUARE = ([[-1, 4, -1], [1, 4, -1], [1, 4, 1], [-1, 4, 1]], [0, 1, 2, 0, 2, 3])
CUBE = ([[0.7 * x, 1 + 0.7 * y, 0.7 * z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)],
        [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3])
BALL = ((0.0, 1.0, 0.0), 0.9)


def single_scattering_albedo(color, g):
    """Kulla and Conty, 2017, with the anisotropy as KHR_materials_scatter has it."""
    color = np.array(color)
    s = np.clip(4.09712 + 4.20863 * color - np.sqrt(9.59217 + 41.6808 * color + 17.7126 * color**2), 0, 1)
    return (1 - s * s) / (1 - g * s * s)


class GltfFile:
    def __init__(self):
        self.data, self.views, self.accessors, self.meshes = b"", [], [], []

    def accessor(self, values, kind, component, **more):
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": values.nbytes})
        self.data += values.tobytes() + b"\0" * (-values.nbytes % 4)
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": component, "count": len(values), "type": kind, **more})
        return len(self.accessors) - 1

    def mesh(self, shape, material):
        points = np.array(shape[0], np.float32)
        bounds = {"min": points.min(0).tolist(), "max": points.max(0).tolist()}
        self.meshes.append({"primitives": [{"attributes": {"POSITION": self.accessor(points, "VEC3", 5126, **bounds)},
                                            "indices": self.accessor(np.array(shape[1], np.uint16), "SCALAR", 5123), "material": material}]})
        return {"mesh": len(self.meshes) - 1}

    def write(self, path, nodes, materials):
        uri = "data:application/octet-stream;base64," + b64encode(self.data).decode()
        path.write_text(json.dumps({
            "asset": {"version": "2.0"}, "materials": materials, "meshes": self.meshes, "accessors": self.accessors, "nodes": nodes,
            "bufferViews": self.views, "buffers": [{"byteLength": len(self.data), "uri": uri}], "scenes": [{"nodes": [*range(len(nodes))]}],
            "scene": 0, "extensionsUsed": sorted({name for m in materials for name in m["extensions"]})}))


def write_gltf(path, shape, index, extinction, color, g):
    matte = {"KHR_materials_specular": {"specularFactor": 0}}
    smooth = {"metallicFactor": 0, "roughnessFactor": 0}
    materials = [
        {"pbrMetallicRoughness": smooth, "extensions": {
            "KHR_materials_ior": {"ior": index}, "KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 0.1,
                                     "attenuationColor": np.exp(-0.1 * np.array(extinction)).tolist()},
            "KHR_materials_scatter": {"scatterStrengthFactor": 1, "multiscatterColorFactor": color, "scatterAnisotropy": g}}},
        {"pbrMetallicRoughness": {**smooth, "baseColorFactor": [GREY] * 3 + [1]}, "extensions": matte},
        {"pbrMetallicRoughness": {**smooth, "baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [1, 1, 1],
         "extensions": {**matte, "KHR_materials_emissive_strength": {"emissiveStrength": LAMP}}}]
    file = GltfFile()
    body = {"translation": BALL[0], "extras": {"sphere": {"radius": BALL[1], "material": 0}}} if shape == "ball" else file.mesh(CUBE, 0)
    file.write(path, [body, file.mesh(FLOOR, 1), file.mesh(SQUARE, 2)], materials)


def glim_picture(glim, scene, folder, seed):
    out = folder / "glim.exr"
    place = [",".join(map(str, p)) for p in (EYE, TARGET)]
    subprocess.run([glim, "render", scene, "-o", out, "--size", f"{SIDE}x{SIDE}", "--spp", str(SAMPLES), "--seed", str(seed), "--bounces", "1000",
                    "--look-from", place[0], "--look-at", place[1], "--fov", str(FOV), "--environment", "none"],
                   check=True, capture_output=True)
    radiance = dict(mi.Bitmap(str(out)).split())["<root>"]
    return np.array(radiance.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))


def mitsuba_mesh(shape, bsdf, **more):
    points, indices = np.array(shape[0], np.float32), np.array(shape[1], np.uint32)
    properties = mi.Properties()
    for name, value in {"bsdf": mi.load_dict(bsdf), **{name: mi.load_dict(value) for name, value in more.items()}}.items():
        properties[name] = value
    mesh = mi.Mesh("mesh", len(points), len(indices) // 3, props=properties)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"], parameters["faces"] = points.ravel(), indices
    parameters.update()
    return mesh


def mitsuba_scene(shape, index, extinction, color, g):
    def rgb(value):
        return {"type": "rgb", "value": [float(v) for v in value]}
    medium = {"type": "homogeneous", "sigma_t": rgb(np.divide(extinction, max(extinction))), "scale": max(extinction), "albedo": rgb(single_scattering_albedo(color, g)),
              "phase": {"type": "hg", "g": g}}
    bsdf = {"type": "null"} if index == 1 else {"type": "dielectric", "int_ior": index, "ext_ior": 1.0}
    body = ({"type": "sphere", "center": BALL[0], "radius": BALL[1], "bsdf": bsdf, "interior": medium} if shape == "ball" else
            mitsuba_mesh(CUBE, bsdf, interior=medium))
    def matte(value):
        return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": rgb([value] * 3)}}
    T = mi.ScalarTransform4f
    return mi.load_dict({
        "type": "scene", "integrator": {"type": "volpathmis", "max_depth": -1, "rr_depth": 50}, "body": body,
        "floor": mitsuba_mesh(FLOOR, matte(GREY)),
        "lamp": mitsuba_mesh(SQUARE, {"type": "diffuse", "reflectance": rgb([0] * 3)}, emitter={"type": "area", "radiance": rgb([LAMP] * 3)}),
        "sensor": {"type": "perspective", "fov": FOV, "to_world": T().look_at(EYE, TARGET, (0, 1, 0)),
                   "film": {"type": "hdrfilm", "width": SIDE, "height": SIDE, "rfilter": {"type": "box"}, "pixel_format": "rgb"},
                   "sampler": {"type": "independent", "sample_count": SAMPLES}}})


def blocks_of(picture):
    return picture.reshape(SIDE // BLOCK, BLOCK, SIDE // BLOCK, BLOCK, 3).mean((1, 3))


def compare(name, ours, theirs):
    """Pictures of several seeds each, (seeds, blocks, blocks, 3)."""
    error = np.sqrt((ours.var(0, ddof=1) + theirs.var(0, ddof=1)) / len(ours))
    z = (ours.mean(0) - theirs.mean(0)) / np.maximum(error, 1e-12)
    means = [pictures.mean((1, 2, 3)) for pictures in (ours, theirs)]
    ratio = means[0].mean() / means[1].mean() - 1
    noise = math.hypot(*(m.std(ddof=1) / math.sqrt(len(m)) / m.mean() for m in means))
    print(f"| {name} | {means[0].mean():.5f} | {means[1].mean():.5f} | {100 * ratio:+.2f} % +- {100 * noise:.2f} % | {np.abs(z).max():.2f} |", flush=True)


def main():
    glim, seeds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 16
    print("| scene | glim | Mitsuba | ratio of means - 1 | largest of 48 z |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for name, *medium in SCENES:
            write_gltf(folder / "scene.gltf", *medium)
            scene = mitsuba_scene(*medium)
            ours = np.array([blocks_of(glim_picture(glim, folder / "scene.gltf", folder, seed)) for seed in range(seeds)])
            theirs = np.array([blocks_of(np.array(mi.render(scene, seed=seed))) for seed in range(seeds)])
            compare(name, ours, theirs)


if __name__ == "__main__":
    main()
