"""What the bundle's maker and its runner share."""

import os

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))  # of the sources

# Scenes whose films are compared by the persistent schedule too: its kernel takes long to compile.
PERSISTENT_SCENES = ("cornell", "cornell_spheres", "light_point", "textures", "many_lights")
BITS_SIZE, BITS_SPP = 48, 64
GOLDEN_SIZE = 48


# Of scenes with more lights than a film has groups.
LIGHT_GROUPS = {"many_lights": "some=lamp 1*", "textures": "some=repeat*"}


def group_words(scene):
    return ["--light-group", LIGHT_GROUPS.get(scene, "each")]


class CheckError(Exception):
    pass


def render_words(glim, scene, film, width, height, *more):
    return [glim, "render", scene, "-o", film, "--size", "%dx%d" % (width, height), "--progress", "none", *more]
