#!/usr/bin/env python3
"""Makes a data set: pictures of a room in which the camera and two boxes move, or of --scene, boxes and masks as COCO has them, depth,
optical flow.

OUT/annotations.json is about all pictures. OUT/0001.npz goes with OUT/0001.png and has, for the centre of each pixel:

    depth                         (height, width) float32: metres along the camera's axis, infinite where nothing is
    forward_flow, backward_flow   (height, width, 2) float32: pixels to the right and down, to where the same point is in the next and in
                                  the previous picture. NaN where nothing is, or where no picture shows it then
    instance                      (height, width) uint32: numbers of the objects, the same in all pictures; 4294967295 is nothing
    K, pose                       3x3, pixel centres at whole numbers, and 4x4, camera to world, metres: both as OpenCV has them
"""

import argparse
import base64
import json
import os
import sys

import glim
import numpy

SCENES = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "scenes")
RATE = 24  # pictures a second


def swing(random, count, size):
    """(count, 3) metres around 0: a smooth way of each coordinate, at most its `size` long."""
    times = numpy.arange(count)[:, None] / RATE
    return size * numpy.sin(random.uniform(1, 3, 3) * times + random.uniform(0, 2 * numpy.pi, 3))


def towards(ways):
    """(count, 4): the quaternions of cameras that look along each of the (count, 3) ways, upright."""
    x, y, z = ways.T
    yaw, pitch = numpy.arctan2(-x, -z) / 2, numpy.arctan2(y, numpy.hypot(x, z)) / 2
    return numpy.stack([numpy.cos(yaw) * numpy.sin(pitch), numpy.sin(yaw) * numpy.cos(pitch),
                        -numpy.sin(yaw) * numpy.sin(pitch), numpy.cos(yaw) * numpy.cos(pitch)], axis=1)


def moving_room(pictures, seed):
    """The Cornell box as a glTF document whose animation has a key for each picture, one before them and one after them."""
    with open(os.path.join(SCENES, "cornell.gltf"), encoding="utf-8") as file:
        document = json.load(file)
    numbers = {node["name"]: number for number, node in enumerate(document["nodes"])}
    random, count = numpy.random.default_rng(seed), pictures + 2
    eyes = (0, 1, 3.2) + swing(random, count, (.6, .4, .4))
    animate(document, {(numbers["front"], "translation"): eyes,
                       (numbers["front"], "rotation"): towards((0, .8, 0) - eyes),
                       (numbers["tall box"], "translation"): swing(random, count, (.15, 0, .15)),
                       (numbers["short box"], "translation"): numpy.abs(swing(random, count, (0, .4, 0)))})
    return document


def animate(document, tracks):
    """Adds an animation to a glTF document. tracks: values of all keys, by node and path."""
    samplers, channels = [], []
    times = add_numbers(document, numpy.arange(len(next(iter(tracks.values())))) / RATE)
    for (node, path), values in tracks.items():
        document["nodes"][node].pop("matrix", None)  # which an animation cannot change
        channels.append({"sampler": len(samplers), "target": {"node": node, "path": path}})
        samplers.append({"input": times, "output": add_numbers(document, values)})
    document["animations"] = [{"samplers": samplers, "channels": channels}]


def add_numbers(document, values):
    """The index of a new accessor."""
    values = numpy.asarray(values, "<f4")
    buffer = {"byteLength": values.nbytes, "uri": "data:application/octet-stream;base64," + base64.b64encode(values.tobytes()).decode()}
    document["buffers"].append(buffer)
    document["bufferViews"].append({"buffer": len(document["buffers"]) - 1, "byteLength": values.nbytes})
    accessor = {"bufferView": len(document["bufferViews"]) - 1, "componentType": 5126, "count": len(values),
                "type": "SCALAR" if values.ndim == 1 else "VEC%d" % values.shape[1],
                "min": values.min(axis=0, keepdims=True).ravel().tolist(), "max": values.max(axis=0, keepdims=True).ravel().tolist()}
    document["accessors"].append(accessor)
    return len(document["accessors"]) - 1


def annotate(coco, objects, name):
    """Adds what COCO knows of a picture, with ids that no other picture has."""
    image = {**objects["images"][0], "id": len(coco["images"]) + 1, "file_name": name}
    coco["images"].append(image)
    for annotation in objects["annotations"]:
        coco["annotations"].append({**annotation, "id": len(coco["annotations"]) + 1, "image_id": image["id"]})
    coco["categories"] = objects["categories"]


def geometry_of(film):
    """What the page at the top says of the arrays."""
    pose, surfaces = numpy.array(film.camera.pose("opencv")), film.surfaces
    depth = (surfaces["position"] - pose[:3, 3]) @ pose[:3, 2]
    return {"depth": numpy.where(numpy.isnan(depth), numpy.inf, depth).astype(numpy.float32), "K": film.camera.K("center"), "pose": pose,
            **{name: surfaces[name] for name in ("forward_flow", "backward_flow", "instance")}}


def make_set(folder, pictures, size, spp, seed, path=None):
    os.makedirs(folder, exist_ok=True)
    if path is None:
        path = os.path.join(folder, "room.gltf")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(moving_room(pictures, seed), file)
    scene, coco = glim.load(path, size=size, spp=spp), {"images": [], "annotations": []}
    for number in range(1, pictures + 1):
        film = scene.render(at=number / RATE, seed=number, surfaces=True, flow=1 / RATE, objects=True)
        name = "%04d" % number
        film.save(os.path.join(folder, name + ".png"))
        numpy.savez(os.path.join(folder, name + ".npz"), **geometry_of(film))
        annotate(coco, film.objects, name + ".png")
    with open(os.path.join(folder, "annotations.json"), "w", encoding="utf-8") as file:
        json.dump(coco, file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="OUT")
    parser.add_argument("--pictures", type=int, default=100)
    parser.add_argument("--size", default="320x240")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--seed", type=int, default=0, help="other ways of the camera and the boxes")
    parser.add_argument("--scene", metavar="FILE", help="a glTF file with an animation instead of the room, 24 pictures a second")
    options = parser.parse_args()
    make_set(options.folder, options.pictures, options.size, options.spp, options.seed, options.scene)


if __name__ == "__main__":
    try:
        main()
    except (glim.InputError, OSError) as error:
        sys.exit("make_coco_set.py: %s" % error)
