"""Generators whose scenes are too large to commit. Each takes a size and returns a Document."""

import math
import random

from .gltf_document import Document
from .shapes import block, icosahedron, turn
from .small_scenes import cornell_room

BUNNY = "/usr/share/glmark2/models/bunny.obj"


def grey(document):
    return document.material("grey", (0.6, 0.6, 0.6))


def sunlit():
    document = Document()
    document.light("sun", {"type": "directional", "intensity": 3.0}, rotation=[-0.5, 0.2, 0.1, 0.8366600265340756])
    return document


def terrain(count):
    """A height field of at least `count` triangles."""
    document, n = sunlit(), max(1, math.isqrt(max(1, count - 1) // 2) + 1)
    waves = [(1.9, 2.3, 0.12), (5.1, -3.7, 0.05), (-11.0, 13.0, 0.02), (37.0, 29.0, 0.006)]
    points = []
    for i in range((n + 1) * (n + 1)):
        x, z = 2.0 * (i % (n + 1)) / n - 1.0, 2.0 * (i // (n + 1)) / n - 1.0
        points.append([x, sum(a * math.sin(u * x + w * z) * math.cos(w * x - u * z) for u, w, a in waves), z])
    indices = []
    for row in range(n):
        for a in range(row * (n + 1), row * (n + 1) + n):
            indices += [a, a + n + 1, a + n + 2, a, a + n + 2, a + 1]
    document.shape("terrain", points, indices, grey(document))
    return document


def menger(level):
    """Menger's sponge: only the faces between solid and void, so that the surface is closed."""
    document, n = sunlit(), 3 ** level

    def solid(cell):
        if min(cell) < 0 or max(cell) >= n:
            return False
        for _ in range(level):
            if sum(c % 3 == 1 for c in cell) >= 2:
                return False
            cell = [c // 3 for c in cell]
        return True

    points, indices, seen = [], [], {}

    def corner(cell):
        if cell not in seen:
            seen[cell] = len(points)
            points.append([2.0 * c / n - 1.0 for c in cell])
        return seen[cell]

    cells = (cell for cell in ((i % n, i // n % n, i // (n * n)) for i in range(n ** 3)) if solid(cell))
    for cell in cells:
        for axis in range(3):
            u, v = [tuple(int(k == (axis + s) % 3) for k in range(3)) for s in (1, 2)]
            for side in (0, 1):
                step = tuple((2 * side - 1) * int(k == axis) for k in range(3))
                if solid([c + s for c, s in zip(cell, step)]):
                    continue
                base = tuple(c + side * int(k == axis) for k, c in enumerate(cell))
                quad = [corner(tuple(b + i * x + j * y for b, x, y in zip(base, u, v)))
                        for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
                a, b, c, d = quad if side else quad[::-1]
                indices += [a, b, c, a, c, d]
    document.shape("sponge", points, indices, grey(document))
    return document


def slivers(count):
    """Needles through the unit cube, 1e-4 wide: boxes that all overlap."""
    document, source = sunlit(), random.Random(1)
    points = []
    for _ in range(count):
        a, b = ([source.uniform(-1.0, 1.0) for _ in range(3)] for _ in range(2))
        points += [a, b, [c + 1e-4 for c in b]]
    document.shape("slivers", points, list(range(3 * count)), grey(document))
    return document


def coincident(count):
    """One triangle, `count` times: no split plane helps."""
    document = sunlit()
    document.shape("pile", [[-1, 0, 0], [1, 0, 0], [0, 1, 0]], [0, 1, 2] * count, grey(document))
    return document


def growing(count):
    """Triangles from a millimetre to a million kilometres on both sides of the origin: binning by centroid puts all but
    the last few in one bin, over and over."""
    document, points = sunlit(), []
    ratio = 1e12 ** (1.0 / max(1, count - 1))
    for i in range(count):
        size = 1e-3 * ratio ** i * (1 - 2 * (i % 2))
        points += [[size, -size, 0.0], [2.0 * size, -size, 0.0], [1.5 * size, size, 0.0]]
    document.shape("line", points, list(range(3 * count)), grey(document))
    return document


def forest(count):
    """`count` meshes, each a tree of its own: many nodes, many primitives."""
    document, source = sunlit(), random.Random(2)
    bark, leaf = document.material("bark", (0.3, 0.2, 0.12)), document.material("leaf", (0.12, 0.35, 0.1))
    side = math.sqrt(count)
    document.quad("ground", [[-side, 0, side], [side, 0, side], [side, 0, -side], [-side, 0, -side]],
                  document.material("ground", (0.35, 0.3, 0.2)))
    for i in range(count):
        sides, height = source.randrange(5, 12), source.uniform(0.8, 2.0)
        mesh = document.mesh(document.primitive(*cone(sides, 0.45, 0.25 * height, height), leaf),
                             document.primitive(*cone(sides, 0.08, 0.0, 0.4 * height), bark))
        document.node("tree %d" % i, mesh=mesh, translation=[source.uniform(-side, side), 0.0,
                                                             source.uniform(-side, side)])
    return document


def cone(sides, radius, bottom, top):
    points = [[radius * math.cos(2 * math.pi * i / sides), bottom, -radius * math.sin(2 * math.pi * i / sides)]
              for i in range(sides)] + [[0.0, top, 0.0], [0.0, bottom, 0.0]]
    indices = []
    for i in range(sides):
        j = (i + 1) % sides
        indices += [i, j, sides, j, i, sides + 1]
    return points, indices


def lamps(count):
    """The Cornell box, lit by `count` icosahedra of 20 triangles, of 16 brightnesses from 1 to 8."""
    document, source = Document(), random.Random(4)
    white = cornell_room(document, light=0)
    solid, faces = block((-0.3, 0.0, -0.3), (0.3, 0.6, 0.3))
    document.shape("block", turn(solid, -17.0, (0.0, 0.0, 0.0)), faces, white)
    points, indices = icosahedron()
    shades = [document.material("lamp %d" % i, emission=[2.0 ** (i / 5.0) * c for c in (1.0, 0.8, 0.6)]) for i in range(16)]
    size = 0.25 * count ** (-1.0 / 3.0)
    meshes = [document.mesh(document.primitive([[size * c for c in p] for p in points], indices, shade)) for shade in shades]
    for i in range(count):
        place = [source.uniform(-0.9, 0.9), source.uniform(0.7, 1.9), source.uniform(-0.9, 0.9)]
        document.node("lamp %d" % i, mesh=meshes[source.randrange(16)], translation=place)
    return document


def cornell_bunny():
    """The Stanford bunny of Debian's glmark2-data, standing in the Cornell box."""
    points, indices = [], []
    with open(BUNNY, encoding="ascii") as file:
        for line in file:
            kind, *fields = line.split() or [""]
            if kind == "v":
                points.append([float(f) for f in fields[:3]])
            elif kind == "f":
                corners = [int(f.split("/")[0]) - 1 for f in fields]
                for k in range(1, len(corners) - 1):
                    indices += [corners[0], corners[k], corners[k + 1]]
    low, high = ([f(p[k] for p in points) for k in range(3)] for f in (min, max))
    scale = 1.25 / max(h - l for l, h in zip(low, high))
    points = [[scale * (p[0] - 0.5 * (low[0] + high[0])), scale * (p[1] - low[1]) + 0.001,
               scale * (p[2] - 0.5 * (low[2] + high[2]))] for p in points]
    document = Document()
    cornell_room(document)
    document.shape("bunny", points, indices, document.material("clay", (0.7, 0.55, 0.42)))
    return document


LARGE_SCENES = {function.__name__: function for function in (terrain, menger, slivers, coincident, growing, forest, lamps)}
