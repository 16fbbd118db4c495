"""Triangles of a polygon that may be concave, touch itself (as one that reaches a hole by a bridge does) and be a little off its plane."""

from conversion.smooth import dot, face_normal

ROUNDING = 1e-12  # of an area, relative to the square of the polygon's extent


def project(points):
    """Coordinates in the plane of the polygon's normal, which sees it counter-clockwise."""
    normal = face_normal(points)
    axis = min(range(3), key=lambda a: abs(normal[a]))
    across = [(1.0 if a == axis else 0.0) - normal[axis] * normal[a] for a in range(3)]
    up = [normal[(a + 1) % 3] * across[(a + 2) % 3] - normal[(a + 2) % 3] * across[(a + 1) % 3] for a in range(3)]
    return [(dot(p, across), dot(p, up)) for p in points]


class EarClipper:
    """Ear clipping (Meisters 1975): cuts off one corner after another whose triangle holds no other corner."""

    def __init__(self, points):
        self.points = project(points)
        extent = max(max(p[a] for p in self.points) - min(p[a] for p in self.points) for a in range(2))
        self.rounding = ROUNDING * extent * extent
        self.before = [i - 1 for i in range(len(points))]  # of what is left, the corner before each
        self.before[0] = len(points) - 1
        self.after = [*range(1, len(points)), 0]
        self.others = {i for i in range(len(points)) if not self.is_convex(i)}
        self.blockers = [{}, {}]  # by what counts as inside: what an ear was last seen to hold

    def area(self, a, b, c):
        """Twice that of the triangle of three corners; positive if they go round counter-clockwise."""
        (ax, ay), (bx, by), (cx, cy) = self.points[a], self.points[b], self.points[c]
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)

    def corner(self, i):
        """With its neighbours."""
        return self.before[i], i, self.after[i]

    def is_convex(self, i):
        return self.area(*self.corner(i)) > self.rounding

    def holds(self, a, b, c, p, slack):
        return self.area(a, b, p) >= slack and self.area(b, c, p) >= slack and self.area(c, a, p) >= slack

    def is_ear(self, i, on_edges):
        """Whether its triangle holds no other corner; `on_edges`: one may be on an edge."""
        if i in self.others:
            return False
        blockers, slack = self.blockers[on_edges], self.rounding if on_edges else -self.rounding
        if blockers.get(i) in self.others:
            return False
        a, b, c = self.corner(i)
        ends = (self.points[a], self.points[b], self.points[c])
        blockers[i] = next((p for p in self.others if self.points[p] not in ends and self.holds(a, b, c, p, slack)), None)
        return blockers[i] is None

    def find_ear(self, start, count):
        """A corner whose triangle holds no other one, else one that has them on its edges only, else any convex one, else any."""
        for good in (lambda i: self.is_ear(i, False), lambda i: self.is_ear(i, True), lambda i: i not in self.others):
            i = start
            for _ in range(count):
                if good(i):
                    return i
                i = self.after[i]
        return start

    def cut(self, i):
        before, after = self.before[i], self.after[i]
        self.after[before], self.before[after] = after, before
        self.others.discard(i)
        for neighbour in (before, after):
            (self.others.discard if self.is_convex(neighbour) else self.others.add)(neighbour)
            for blockers in self.blockers:
                blockers.pop(neighbour, None)
        return after

    def clip(self):
        at = 1
        for count in range(len(self.points), 3, -1):
            ear = self.find_ear(at, count)
            if self.area(*self.corner(ear)) > self.rounding:
                yield self.corner(ear)
            at = self.cut(ear)
        yield tuple(sorted((self.before[at], at, self.after[at])))


def is_convex(points):
    """Whether every corner turns to the left, and all of them once round."""
    plane = EarClipper(points)
    if not all(plane.is_convex(i) for i in range(len(points))):
        return False
    return all(plane.area(0, i, i + 1) > 0.0 for i in range(1, len(points) - 1))


def triangulate(points):
    """Triples of indices. Convex polygons are cut from their first corner."""
    if len(points) == 3 or is_convex(points):
        return [(0, i, i + 1) for i in range(1, len(points) - 1)]
    return list(EarClipper(points).clip())
