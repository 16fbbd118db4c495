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


def bumpy_ball(subdivisions):
    """20 * 4^subdivisions triangles around the origin, 3.2 high."""
    points, indices = icosahedron()
    points = [tuple(c / math.sqrt(sum(k * k for k in p)) for c in p) for p in points]
    for _ in range(subdivisions):
        halves, finer = {}, []

        def half(a, b):
            if (min(a, b), max(a, b)) not in halves:
                middle = [points[a][k] + points[b][k] for k in range(3)]
                length = math.sqrt(sum(c * c for c in middle))
                halves[min(a, b), max(a, b)] = len(points)
                points.append(tuple(c / length for c in middle))
            return halves[min(a, b), max(a, b)]

        for a, b, c in zip(indices[::3], indices[1::3], indices[2::3]):
            x, y, z = half(a, b), half(b, c), half(c, a)
            finer += [a, x, z, b, y, x, c, z, y, x, y, z]
        indices = finer
    waves = [1 + 0.25 * math.sin(7 * x) * math.sin(6 * y + 1) * math.sin(5 * z + 2) for x, y, z in points]
    return [[w * x, 1.6 * w * y, w * z] for w, (x, y, z) in zip(waves, points)], indices


def grove(count):
    """`count` instances of one tree of 20,480 triangles, which overlap."""
    document, source = sunlit(), random.Random(5)
    side = 1.5 * math.sqrt(count)
    document.quad("ground", [[-side, 0, side], [side, 0, side], [side, 0, -side], [-side, 0, -side]],
                  document.material("ground", (0.4, 0.35, 0.3)))
    tree = document.mesh(document.primitive(*bumpy_ball(5), document.material("leaf", (0.25, 0.45, 0.15))))
    for i in range(count):
        size, angle = source.uniform(0.6, 1.3), source.uniform(0, math.pi)
        document.node("tree %d" % i, mesh=tree, rotation=[0, math.sin(angle), 0, math.cos(angle)],
                      translation=[source.uniform(-side, side), 1.6 * size, source.uniform(-side, side)],
                      scale=[size, size * source.uniform(0.8, 1.4), size])
    return document


def city(count):
    """`count` instances of a fifth as many houses, of 432 to 6,912 triangles, in streets."""
    document, source = sunlit(), random.Random(6)
    rows = math.ceil(math.sqrt(count))
    document.quad("ground", [[-2.0 * rows, 0, 2.0 * rows], [2.0 * rows, 0, 2.0 * rows], [2.0 * rows, 0, -2.0 * rows],
                             [-2.0 * rows, 0, -2.0 * rows]], document.material("ground", (0.4, 0.4, 0.4)))
    plaster = [document.material("plaster %d" % i, color) for i, color in
               enumerate([(0.7, 0.65, 0.55), (0.6, 0.6, 0.62), (0.5, 0.3, 0.2)])]
    houses = [document.mesh(document.primitive(*house(source.choice([6, 8, 12, 16, 24]), i), plaster[i % 3]))
              for i in range(max(1, count // 5))]
    for i in range(count):
        height = source.uniform(0.6, 4)
        document.node("house %d" % i, mesh=houses[i % len(houses)], scale=[1.2, height, 1.2],
                      translation=[3.2 * (i % rows - rows / 2), height, 3.2 * (i // rows - rows / 2)])
    return document


def house(cells, style):
    """[-1, 1]^3 with uneven sides of cells x cells squares."""
    points, indices = [], []
    for axis, sign in [(axis, sign) for axis in range(3) for sign in (-1, 1)]:
        first = len(points)
        for u, v in [(2 * i / cells - 1, 2 * j / cells - 1) for i in range(cells + 1) for j in range(cells + 1)]:
            point = [0.0, 0.0, 0.0]
            point[axis] = sign * (1 + 0.06 * math.sin(9 * u + style) * math.sin(8 * v))
            point[(axis + 1) % 3], point[(axis + 2) % 3] = u, v
            points.append(point)
        for i in range(cells):
            for j in range(cells):
                a = first + i * (cells + 1) + j
                square = [a, a + cells + 1, a + cells + 2, a + 1][::sign]
                indices += [square[k] for k in (0, 1, 2, 0, 2, 3)]
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


LARGE_SCENES = {function.__name__: function for function in (terrain, menger, slivers, coincident, growing, forest, grove, city,
                                                                lamps)}
