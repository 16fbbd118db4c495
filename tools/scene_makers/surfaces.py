"""Meshes with normals and texture coordinates."""

import math

from .gltf_document import cross, normalize, subtract


class Surface:
    def __init__(self, points, normals, uvs, indices):
        self.points, self.normals, self.uvs, self.indices = points, normals, uvs, indices
        self.more = {}  # further attributes: a name and a list of tuples

    def attribute(self, name, values):
        self.more[name] = list(values)
        return self

    def placed(self, place=(0.0, 0.0, 0.0), scale=1.0, matrix=None):
        """Scaled, turned by the rows of a rotation, moved."""
        rows = matrix or ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
        turned = [[sum(r * c for r, c in zip(row, p)) for row in rows] for p in self.points]
        normals = [[sum(r * c for r, c in zip(row, n)) for row in rows] for n in self.normals]
        result = Surface([[scale * c + d for c, d in zip(p, place)] for p in turned], normals, self.uvs, self.indices)
        result.more = dict(self.more)
        return result


def rotation(axis, degrees):
    """Rows of the rotation about a unit axis."""
    (x, y, z), c, s = axis, math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    t = 1.0 - c
    return ((t * x * x + c, t * x * y - s * z, t * x * z + s * y), (t * x * y + s * z, t * y * y + c, t * y * z - s * x),
            (t * x * z - s * y, t * y * z + s * x, t * z * z + c))


def joined(surfaces):
    points, normals, uvs, indices = [], [], [], []
    for s in surfaces:
        indices += [i + len(points) for i in s.indices]
        points += s.points
        normals += s.normals
        uvs += s.uvs
    return Surface(points, normals, uvs, indices)


def patch(point, columns, rows, normal=None):
    """point(s, t) over the unit square, uv (s, 1 - t). The front shows s to the right and t upwards. Normals by differences, or given."""
    at = [(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    h = 1e-4
    def by_differences(s, t):
        t = min(max(t, 2.0 * h), 1.0 - 2.0 * h)  # poles have no tangents
        return normalize(cross(subtract(point(s + h, t), point(s - h, t)), subtract(point(s, t + h), point(s, t - h))))
    indices = []
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            for corners in ((a, b, c), (a, c, d)):
                if len({tuple(round(x, 9) for x in point(*at[k])) for k in corners}) == 3:
                    indices += corners
    return Surface([list(point(s, t)) for s, t in at], [list((normal or by_differences)(s, t)) for s, t in at],
                   [(s, 1.0 - t) for s, t in at], indices)


def ball(radius=1.0, columns=32, rows=16):
    """A sphere; s turns about y from -z over -x, t climbs from the south pole."""
    def direction(s, t):
        a, e = 2.0 * math.pi * s, math.pi * (t - 0.5)
        ring = math.cos(e) if 0.0 < t < 1.0 else 0.0
        return (-math.sin(a) * ring, math.sin(e), -math.cos(a) * ring)
    return patch(lambda s, t: [radius * c for c in direction(s, t)], columns, rows, direction)


def torus(radius, thickness, columns=48, rows=20):
    """Lies in the plane y = 0."""
    def turned(s, t, r, h):
        a, b = 2.0 * math.pi * s, 2.0 * math.pi * t
        ring = r + h * math.cos(b)
        return (-math.sin(a) * ring, h * math.sin(b), -math.cos(a) * ring)
    return patch(lambda s, t: turned(s, t, radius, thickness), columns, rows, lambda s, t: turned(s, t, 0.0, 1.0))


def lathe(profile, columns=40):
    """Turns a profile of (radius, y) about the vertical axis; its right side as it climbs is outside. A point given twice is an edge."""
    runs, run = [], [profile[0]]
    for p in profile[1:]:
        if p == run[-1]:
            runs.append(run)
            run = []
        run.append(p)
    runs.append(run)
    lengths = [0.0]
    for a, b in zip(profile, profile[1:]):
        lengths.append(lengths[-1] + math.dist(a, b))
    surfaces, first = [], 0
    for run in runs:
        def outward(k, run=run):
            a, b = run[max(k - 1, 0)], run[min(k + 1, len(run) - 1)]
            return normalize((b[1] - a[1], a[0] - b[0], 0.0))
        normals = [outward(k) for k in range(len(run))]
        last = len(run) - 1
        def on(values, s, t, last=last):
            r, y = values[int(t * last + 0.5)][:2]
            a = 2.0 * math.pi * s
            return (-math.sin(a) * r, y, -math.cos(a) * r)
        surface = patch(lambda s, t, run=run: on(run, s, t), columns, last, lambda s, t, normals=normals: on(normals, s, t))
        surface.uvs = [(u, 1.0 - lengths[first + k // (columns + 1)] / lengths[-1]) for k, (u, _) in enumerate(surface.uvs)]
        surfaces.append(surface)
        first += len(run)
    return joined(surfaces)


def rectangle(corner, s_edge, t_edge, columns=1, rows=1):
    """Its front shows the s edge to the right and the t edge upwards."""
    return patch(lambda s, t: [c + s * a + t * b for c, a, b in zip(corner, s_edge, t_edge)], columns, rows)


def box(low, high):
    """Each side has the whole texture."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    w, h, d = x1 - x0, y1 - y0, z1 - z0
    return joined([rectangle((x0, y0, z1), (w, 0, 0), (0, h, 0)), rectangle((x1, y0, z0), (-w, 0, 0), (0, h, 0)),
                   rectangle((x1, y0, z1), (0, 0, -d), (0, h, 0)), rectangle((x0, y0, z0), (0, 0, d), (0, h, 0)),
                   rectangle((x0, y1, z1), (w, 0, 0), (0, 0, -d)), rectangle((x0, y0, z0), (w, 0, 0), (0, 0, d))])


def smooth_curve(points, steps):
    """Catmull-Rom through the points, `steps` to each span."""
    result = []
    for i in range(len(points) - 1):
        p = [points[max(i - 1, 0)], points[i], points[i + 1], points[min(i + 2, len(points) - 1)]]
        for k in range(steps):
            t = k / steps
            result.append(tuple(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t * t * t)
                                for a, b, c, d in zip(*p)))
    return result + [tuple(points[-1])]
