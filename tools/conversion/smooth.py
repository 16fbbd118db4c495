"""Normals of smoothing groups. trimesh drops the groups, so OBJ files that rely on them would look faceted."""

import math

from scene_makers.gltf_document import cross, subtract


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(v):
    length = math.sqrt(dot(v, v))
    return [x / length for x in v] if length > 0.0 else [0.0, 0.0, 1.0]


def face_normal(points):
    """Of a polygon that need not be flat (Newell's method; Sutherland, Sproull and Schumacker 1974)."""
    sums = [0.0, 0.0, 0.0]
    for p, q in zip(points, points[1:] + points[:1]):
        sums = [s + c for s, c in zip(sums, cross(p, q))]
    return unit(sums)


def angle(before, at, after):
    a, b = unit(subtract(before, at)), unit(subtract(after, at))
    return math.acos(max(-1.0, min(1.0, dot(a, b))))


def give_normals(obj):
    """Gives each corner a normal. Where the file has none it is the mean of those of the faces of one smoothing group at the vertex, by
    the angles there (Thürmer and Wüthrich 1998); outside a group it is the face's."""
    sums = {}
    own = [face_normal([obj.vertices[v] for v, _, _ in face.corners]) for face in obj.faces]
    for face, normal in zip(obj.faces, own):
        points = [obj.vertices[v] for v, _, _ in face.corners]
        for i, (vertex, _, given) in enumerate(face.corners):
            if given is None and face.smoothing:
                weight = angle(points[i - 1], points[i], points[(i + 1) % len(points)])
                at = sums.setdefault((vertex, face.smoothing), [0.0, 0.0, 0.0])
                sums[vertex, face.smoothing] = [s + weight * n for s, n in zip(at, normal)]
    indices = {}
    for key, total in sums.items():
        indices[key] = len(obj.normals)
        obj.normals.append(unit(total))
    for face, normal in zip(obj.faces, own):
        if any(given is None for _, _, given in face.corners) and not face.smoothing:
            obj.normals.append(normal)
        flat = len(obj.normals) - 1
        face.corners = [(v, uv, given if given is not None else indices.get((v, face.smoothing), flat))
                        for v, uv, given in face.corners]
