"""What the bundle's maker and its runner share."""

import os

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))  # of the sources

# Their films are compared bit by bit: diffuse, spheres, a lamp of no size, caustics, textures, every lobe, many lamps, an environment.
BITS_SCENES = ("cornell", "cornell_spheres", "light_point", "cornell_gems", "textures", "materials", "many_lights", "car_paint")
BITS_SIZE, BITS_SPP = 48, 64
GOLDEN_SIZE = 48


class CheckError(Exception):
    pass


def render_words(glim, scene, film, width, height, *more):
    return [glim, "render", scene, "-o", film, "--size", "%dx%d" % (width, height), "--progress", "none", *more]
