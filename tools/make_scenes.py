#!/usr/bin/env python3
"""Writes the scenes that glim renders.

Without options: scenes/*.gltf and scenes/refused/*, the same bytes every time.
"""

import argparse
import os
import sys

sys.dont_write_bytecode = True  # beside the sources it would look like a change to build
from whole_file import write_whole  # noqa: E402
from scene_makers.collada_document import to_collada  # noqa: E402
from scene_makers.large_scenes import BUNNY, LARGE_SCENES, cornell_bunny  # noqa: E402
from scene_makers.refused_scenes import REFUSED  # noqa: E402
from scene_makers.small_scenes import SMALL_SCENES  # noqa: E402

COLLADA = ("cornell", "cornell_spheres", "cornell_mirror_glass", "cornell_gems", "veach_mis")  # of materials that the course's profile has
SCENES = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "scenes")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--large", nargs=2, metavar=("NAME", "N"),
                        help="write one large scene instead: %s of N triangles, forest and grove of N trees, city of N houses, lamps of N lamps, menger of level N"
                        % ", ".join(n for n in LARGE_SCENES if n not in ("forest", "grove", "city", "lamps", "menger")))
    parser.add_argument("--collada", metavar="NAME", choices=COLLADA,
                        help="write a scene as Collada instead, with the profile of the courses CS 184 and 15-462: %s" % ", ".join(COLLADA))
    parser.add_argument("-o", "--output", metavar="FILE", help="where to write the large scene (.glb or .gltf) or the Collada file (.dae)")
    parser.add_argument("--fetch", action="store_true",
                        help="write scenes/cornell_bunny.glb from Debian's glmark2-data instead")
    arguments = parser.parse_args()
    if arguments.large:
        name, size = arguments.large
        if name not in LARGE_SCENES or not size.isdigit() or int(size) < 1:
            parser.error("--large %s %s: expected one of %s and a whole number from 1" %
                         (name, size, ", ".join(LARGE_SCENES)))
        if name == "menger" and int(size) > 5:
            parser.error("--large menger %s: expected at most level 5, which has 13 million triangles" % size)
    if sum(map(bool, (arguments.large, arguments.collada, arguments.fetch))) > 1:
        parser.error("--large, --collada and --fetch exclude each other")
    if bool(arguments.large or arguments.collada) != bool(arguments.output):
        parser.error("-o FILE belongs to --large and --collada, and they to it")
    endings = (".dae",) if arguments.collada else (".glb", ".gltf")
    if arguments.output and not arguments.output.endswith(endings):
        parser.error("-o %s: expected a name that ends in %s" % (arguments.output, " or ".join(endings)))
    return arguments


def main():
    arguments = parse_arguments()
    if arguments.large:
        name, size = arguments.large
        LARGE_SCENES[name](int(size)).write(arguments.output)
    elif arguments.collada:
        write_whole(arguments.output, to_collada(SMALL_SCENES[arguments.collada]()).text().encode())
    elif arguments.fetch:
        if not os.path.exists(BUNNY):
            sys.exit("make_scenes.py: %s is missing; install it with: apt install glmark2-data" % BUNNY)
        cornell_bunny().write(os.path.join(SCENES, "cornell_bunny.glb"))
    else:
        os.makedirs(os.path.join(SCENES, "refused"), exist_ok=True)
        for name, make in SMALL_SCENES.items():
            make().write(os.path.join(SCENES, name + ".gltf"))
        for name, make in REFUSED.items():
            write_whole(os.path.join(SCENES, "refused", name), make())


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        sys.exit("make_scenes.py: %s" % error)
