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
        self.left = list(range(len(points)))

    def area(self, a, b, c):
        """Twice that of the triangle of three corners; positive if they go round counter-clockwise."""
        (ax, ay), (bx, by), (cx, cy) = self.points[a], self.points[b], self.points[c]
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)

    def corner(self, i):
        """The corner at a place in what is left, between its neighbours."""
        return self.left[i - 1], self.left[i], self.left[(i + 1) % len(self.left)]

    def is_convex(self, i):
        return self.area(*self.corner(i)) > self.rounding

    def holds(self, a, b, c, p, slack):
        return min(self.area(a, b, p), self.area(b, c, p), self.area(c, a, p)) >= slack

    def is_ear(self, i, slack):
        a, b, c = self.corner(i)
        ends = (self.points[a], self.points[b], self.points[c])
        return self.is_convex(i) and not any(self.points[p] not in ends and self.holds(a, b, c, p, slack) for p in self.others)

    def find_ear(self):
        """A corner whose triangle holds no other one, else one that has them on its edges only, else any convex one, else any."""
        self.others = [p for i, p in enumerate(self.left) if not self.is_convex(i)]
        places = [(self.start + k) % len(self.left) for k in range(len(self.left))]
        for good in (lambda i: self.is_ear(i, -self.rounding), lambda i: self.is_ear(i, self.rounding), self.is_convex):
            found = next((i for i in places if good(i)), None)
            if found is not None:
                return found
        return places[0]

    def clip(self):
        self.start = 1
        while len(self.left) > 3:
            ear = self.find_ear()
            a, b, c = self.corner(ear)
            if self.area(a, b, c) > self.rounding:
                yield a, b, c
            del self.left[ear]
            self.start = ear % len(self.left)
        yield tuple(self.left)


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
