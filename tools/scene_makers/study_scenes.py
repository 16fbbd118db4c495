"""What tools/study renders beside the committed scenes: bumpy meshes of any number of triangles, and a bright room."""

import math

from .gltf_document import Document
from .large_scenes import grey, sunlit
from .shapes import block
from .small_scenes import cornell_room


def factor(half):
    """(columns, rows) with columns * rows = half and a ratio below 2.5; None if there is none."""
    for rows in range(math.isqrt(half), 1, -1):
        if half % rows == 0:
            return (half // rows, rows) if half // rows < 2.5 * rows else None
    return None


def resolution(triangles):
    """(columns, rows) of a closed globe of 2 * columns * rows triangles: the count nearest to the number that has a good shape."""
    half = max(6, triangles // 2)
    for step in range(half):
        for candidate in (half - step, half + step):
            if candidate >= 6 and factor(candidate):
                return factor(candidate)
    raise ValueError("no globe of about %d triangles" % triangles)


def radius_towards(x, y, z):
    """Bumps from large to small, so that the surface is uneven at each number of triangles."""
    waves = ((2.0, 3.0, 1.0, 0.16), (5.0, -4.0, 6.0, 0.07), (11.0, 13.0, -9.0, 0.03), (31.0, -27.0, 23.0, 0.01))
    return 0.6 * (1.0 + sum(a * math.sin(u * x + v * y + 0.7) * math.cos(w * z - 0.3 * u * x) for u, v, w, a in waves))


def globe(triangles):
    """Points and indices, counter-clockwise from outside; two poles and rings of columns."""
    columns, rows = resolution(triangles)
    directions = [(0.0, 1.0, 0.0)]
    for i in range(1, rows + 1):
        polar = math.pi * i / (rows + 1)
        for k in range(columns):
            around = 2 * math.pi * k / columns
            directions.append((math.sin(polar) * math.cos(around), math.cos(polar), -math.sin(polar) * math.sin(around)))
    directions.append((0.0, -1.0, 0.0))
    points = [[c * r for c in d] for d in directions for r in (radius_towards(*d),)]
    indices, south = [], len(points) - 1
    for k in range(columns):
        following = (k + 1) % columns
        indices += [0, 1 + k, 1 + following, south, south - columns + following, south - columns + k]
        for row in range(rows - 1):
            a, b = 1 + row * columns + k, 1 + row * columns + following
            indices += [a, a + columns, b + columns, a, b + columns, b]
    return points, indices


def lone_blob(triangles):
    document = sunlit()
    document.camera("front", (0.9, 0.8, 2.1), (0.0, 0.0, 0.0), 37.4, 4.0 / 3.0)
    document.shape("blob", *globe(triangles), grey(document))
    return document


def blob_in_room(triangles):
    """A blob that stands for the bunny in the Cornell box. With the room's 12 triangles it has about as many as asked."""
    document = Document()
    cornell_room(document)
    points, indices = globe(triangles - 12)
    lowest = min(p[1] for p in points)
    points = [[p[0], p[1] - lowest + 0.001, p[2] - 0.1] for p in points]
    document.shape("blob", points, indices, document.material("clay", (0.7, 0.55, 0.42)))
    return document


def bright_furnace():
    """A closed room of albedo .9 that emits .1: radiance 1 - .9^(k + 1) everywhere after k bounces."""
    document = Document()
    wall = document.material("wall", (0.9, 0.9, 0.9), emission=(0.1, 0.1, 0.1))
    document.camera("inside", (0.1, 0.2, 0.7), (-0.3, 0.0, -1.0), 70.0, 4.0 / 3.0)
    points, indices = block((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))
    document.shape("room", points, [indices[i + k] for i in range(0, len(indices), 3) for k in (0, 2, 1)], wall)
    return document
