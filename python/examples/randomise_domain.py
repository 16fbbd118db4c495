#!/usr/bin/env python3
"""Draws a room many times, each time with another lamp, other materials and poses, and another camera, as networks are trained to see past.

OUT/settings.jsonl has a line of JSON for each picture: the options with which glim.render(SCENE, **options) draws OUT/0001.png again.
"""

import argparse
import json
import os
import sys

import glim
import numpy

SCENE = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "scenes", "cornell_mirror_glass.gltf")
RADII = {"mirror": .45, "glass": .36}  # of the balls, by their nodes


def light(lamp, random):
    """From reddish to bluish, of any power."""
    warmth = random.uniform(.4, 1)
    color = (1, (1 + warmth) / 2, warmth) if random.random() < .5 else (warmth, (1 + warmth) / 2, 1)
    lamp.emission = random.uniform(10, 40) * numpy.array(color)


def paint(materials, random):
    """Walls of any colour; the balls change from mirrors to rough metal and from clear to coloured glass."""
    for name in ("white", "red", "green"):
        materials[name].base_color = random.uniform(.1, .9, 3)
    for name in RADII:
        materials[name].base_color = random.uniform(.5, 1, 3)
    materials["mirror"].roughness = random.uniform(0, .5)
    materials["glass"].ior = random.uniform(1.3, 1.8)


def place(nodes, random):
    """The balls anywhere on the floor, apart from each other."""
    while True:
        places = {name: random.uniform(radius - 1, 1 - radius, 2) for name, radius in RADII.items()}
        if numpy.linalg.norm(places["mirror"] - places["glass"]) > sum(RADII.values()):
            break
    for name, (x, z) in places.items():
        nodes[name].translation = (x, RADII[name], z)


def camera(random):
    return glim.look_at(random.uniform((-.6, .5, 3.2), (.6, 1.5, 4)).tolist(), random.uniform((-.2, .6, -.2), (.2, 1, .2)).tolist())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="OUT")
    parser.add_argument("--pictures", type=int, default=100)
    parser.add_argument("--size", default="320x240")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--seed", type=int, default=0, help="others are other pictures")
    given = parser.parse_args()
    os.makedirs(given.folder, exist_ok=True)
    scene, random = glim.load(SCENE), numpy.random.default_rng(given.seed)
    with open(os.path.join(given.folder, "settings.jsonl"), "w", encoding="utf-8") as lines:
        for number in range(1, given.pictures + 1):
            name = "%04d.png" % number
            light(scene.materials["lamp"], random)
            paint(scene.materials, random)
            place(scene.nodes, random)
            options = {"size": given.size, "spp": given.spp, "seed": number, **camera(random)}
            scene.render(**options).save(os.path.join(given.folder, name))
            print(json.dumps({"file_name": name, "options": {**options, "set": scene.edits}}), file=lines)


if __name__ == "__main__":
    try:
        main()
    except (glim.InputError, OSError) as error:
        sys.exit("randomise_domain.py: %s" % error)
