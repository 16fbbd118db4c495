"""Points and triangle indices of simple solids, counter-clockwise seen from outside."""

import math

from .gltf_document import cross, normalize, subtract


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def outward(points, indices):
    """The same convex solid with every triangle counter-clockwise from outside."""
    middle = [sum(p[k] for p in points) / len(points) for k in range(3)]
    turned = []
    for i in range(0, len(indices), 3):
        a, b, c = indices[i:i + 3]
        normal = cross(subtract(points[b], points[a]), subtract(points[c], points[a]))
        turned += [a, b, c] if dot(normal, subtract(points[a], middle)) > 0 else [a, c, b]
    return points, turned


def block(low, high):
    """An axis-aligned box."""
    points = [[(low, high)[i >> 2 & 1][0], (low, high)[i >> 1 & 1][1], (low, high)[i & 1][2]] for i in range(8)]
    return outward(points, [i for a, b, c, d in ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4),
                                                 (1, 5, 7, 3)) for i in (a, b, c, a, c, d)])


def turn(points, degrees, center):
    """Turned about the vertical axis through the origin, then moved."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [[c * x + s * z + center[0], y + center[1], -s * x + c * z + center[2]] for x, y, z in points]


def brilliant(sides):
    """A cut stone of radius 1: table, crown, girdle and pavilion."""
    rings = [(0.56, 0.34, 0.0), (1.0, 0.03, 0.5), (1.0, -0.03, 0.5)]  # radius, height, half steps turned
    points = [[r * math.cos(2 * math.pi * (i + h) / sides), y, r * math.sin(2 * math.pi * (i + h) / sides)]
              for r, y, h in rings for i in range(sides)]
    points += [[0.0, -0.86, 0.0]]
    table, crown, belt, culet = 0, sides, 2 * sides, 3 * sides
    indices = [i for k in range(1, sides - 1) for i in (table, table + k, table + k + 1)]
    for i in range(sides):
        j, k = (i + 1) % sides, (i - 1) % sides
        indices += [table + i, crown + i, crown + k, table + i, table + j, crown + i]
        indices += [crown + i, belt + i, crown + k, crown + k, belt + i, belt + k]
    for i in range(sides):
        indices += [culet, belt + (i - 1) % sides, belt + i]
    return outward(points, indices)


def icosahedron():
    g = (1 + math.sqrt(5)) / 2
    points = [normalize(p) for p in (
        (-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g), (g, 0, -1),
        (g, 0, 1), (-g, 0, -1), (-g, 0, 1))]
    return outward(points, [0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6, 7, 1, 8,
                            3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9, 8, 1])


def bulb(times):
    """A sphere of radius 1 of 20 * 4^times triangles: an icosahedron whose triangles are each cut into four, `times` times."""
    points, indices = icosahedron()
    for _ in range(times):
        middles, finer = {}, []
        for i in range(0, len(indices), 3):
            corners = indices[i:i + 3]
            mid = []
            for a, b in zip(corners, corners[1:] + corners[:1]):
                side = (min(a, b), max(a, b))
                if side not in middles:
                    middles[side] = len(points)
                    points.append(normalize([x + y for x, y in zip(points[a], points[b])]))
                mid.append(middles[side])
            finer += [k for a, b, c in zip(corners, mid, mid[2:] + mid[:2]) for k in (a, b, c)] + mid
        indices = finer
    return points, indices


def rest_on_face(points, indices, triangle, gap):
    """Turns the solid so that one triangle (negative: from the end) faces straight down, `gap` above y = 0, its centre over the origin."""
    first = 3 * triangle % len(indices)
    a, b, c = (points[i] for i in indices[first:first + 3])
    y = [-n for n in normalize(cross(subtract(b, a), subtract(c, a)))]
    x = normalize(subtract(b, a))
    z = cross(x, y)
    turned = [[dot(p, x), dot(p, y), dot(p, z)] for p in points]
    lowest = min(p[1] for p in turned)
    middle = [sum(p[k] for p in turned) / len(turned) for k in (0, 2)]
    return [[p[0] - middle[0], p[1] - lowest + gap, p[2] - middle[1]] for p in turned]
