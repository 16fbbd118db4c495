"""What the bundle's maker and its runner share."""

import os

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))  # of the sources

# Scenes whose films are compared by the persistent schedule too: its kernel takes long to compile.
PERSISTENT_SCENES = ("cornell", "cornell_spheres", "light_point", "textures", "many_lights")
BITS_SIZE, BITS_SPP = 48, 64
GOLDEN_SIZE = 48


def bits_words(scene):
    """By light groups, of which there are at most eight."""
    return ["--spp", str(BITS_SPP), "--light-group", "some=lamp 1*" if scene == "many_lights" else "each"]


class CheckError(Exception):
    pass


def render_words(glim, scene, film, width, height, *more):
    return [glim, "render", scene, "-o", film, "--size", "%dx%d" % (width, height), "--progress", "none", *more]
