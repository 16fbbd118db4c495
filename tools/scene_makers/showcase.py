"""The picture of the first page: a still life under a made sky of softboxes."""

import math

from .gltf_document import Document
from .made_images import (PALETTE, hash01, mix, normal_map, png, radiance_map, ramp, sample, shades, smooth_step, softboxes, turbulence)
from .surfaces import box, joined, lathe, patch, rectangle, rotation, smooth_curve, torus


# Azimuth (0 is towards the camera, 90 to the right), elevation, half width, half height in degrees; radiance.
SOFTBOXES = ((-68.0, 42.0, 36.0, 27.0, (5.0, 4.15, 3.05)), (112.0, 34.0, 20.0, 28.0, (2.2, 3.0, 4.2)),
             (-128.0, 30.0, 10.0, 28.0, (1.5, 1.4, 1.3)), (20.0, 78.0, 50.0, 9.0, (1.5, 1.5, 1.55)))


def ambient(azimuth, elevation):
    """Around the camera a dim room, behind the table a backdrop with a glow, below it nothing: light there would only cost samples."""
    away = math.hypot((azimuth % 360.0 - 180.0) / 17.0, (elevation + 7.0) / 11.0)
    glow = math.exp(-0.5 * away * away)
    backdrop = mix((0.020, 0.033, 0.038), (0.15, 0.235, 0.25), glow)
    room = mix((0.17, 0.18, 0.21), (0.28, 0.31, 0.37), smooth_step(0.0, 70.0, elevation))
    behind = smooth_step(70.0, 110.0, abs((azimuth + 180.0) % 360.0 - 180.0))
    seen = smooth_step(-4.0, 4.0, elevation) * (1.0 - behind) * 0.9 + 0.1 * smooth_step(0.0, 20.0, elevation)
    shown = behind * smooth_step(-40.0, -20.0, elevation)
    return tuple(max(seen * r + shown * b, 1e-3) for r, b in zip(room, backdrop))


def wood(u, v):
    """Boards along u: four across the texture."""
    board = int(v * 4.0)
    shifted = u + 0.37 * board
    grain = turbulence(shifted, v, 2, 24, 3, 7)
    rings = 0.5 + 0.5 * math.sin(2.0 * math.pi * (6.0 * v + 2.2 * turbulence(shifted, v, 1, 6, 3, 3)))
    seam = smooth_step(0.0, 0.02, min(v * 4.0 - board, board + 1.0 - v * 4.0))
    return (0.18 + 0.42 * grain + 0.22 * rings + 0.14 * hash01(board, 5)) * (0.25 + 0.75 * seam)


WOOD = ramp(((0.0, (0.10, 0.05, 0.03)), (0.35, (0.33, 0.19, 0.11)), (0.7, (0.52, 0.32, 0.19)), (1.0, (0.68, 0.46, 0.29))), 16)


def marble(u, v):
    bent = turbulence(u, v, 3, 3, 5, 1)
    vein = abs(math.sin(math.pi * (2.0 * (u + v) + 3.0 * bent)))
    fine = abs(math.sin(math.pi * (3.0 * (u - v) + 4.0 * turbulence(u, v, 4, 4, 4, 9))))
    return 1.0 - 0.95 * smooth_step(0.22, 0.0, vein) - 0.5 * smooth_step(0.12, 0.0, fine) - 0.15 * bent


MARBLE = ramp(((0.0, (0.22, 0.24, 0.27)), (0.6, (0.80, 0.80, 0.80)), (1.0, (0.95, 0.94, 0.92))), 16)


def dents(u, v):
    """A hammered sheet: the distance from the nearest blow of a jittered, repeating grid."""
    n, nearest = 6, 9.0
    x, y = u * n, v * n
    for i in range(math.floor(x) - 1, math.floor(x) + 2):
        for j in range(math.floor(y) - 1, math.floor(y) + 2):
            cx, cy = i + hash01(i % n, j % n, 1), j + hash01(i % n, j % n, 2)
            nearest = min(nearest, (x - cx) ** 2 + (y - cy) ** 2)
    return min(nearest, 0.6)


def leaf_picture():
    """A leaf along v, its stalk at the bottom. The palette's first colour is nothing; the others grow from the vein to the rim."""
    def pixel(u, v):
        x, y = 2.0 * u - 1.0, 1.0 - v
        width = 0.92 * math.sin(math.pi * min(max((y - 0.08) / 0.92, 0.0), 1.0) ** 0.72) ** 0.9
        if abs(x) >= width and not (abs(x) < 0.05 and y < 0.2):
            return 0
        rib = abs(math.sin(9.0 * math.pi * (y - 0.35 * abs(x))))
        shade = smooth_step(0.0, 0.09, abs(x)) * (0.45 + 0.55 * smooth_step(0.0, 0.35, rib))
        return 1 + int(14.0 * shade + 0.5)
    greens = ramp(((0.0, (0.66, 0.74, 0.42)), (1.0, (0.25, 0.43, 0.16))), 15)
    return png(sample(64, 64, pixel), PALETTE, 4, [(40, 70, 26)] + greens, [0])


def vase():
    outside = smooth_curve([(0.20, 0.0), (0.34, 0.12), (0.43, 0.42), (0.33, 0.74), (0.17, 0.98), (0.16, 1.08), (0.22, 1.18)], 3)
    inside = [(0.205, 1.182), (0.145, 1.08), (0.155, 0.98), (0.3, 0.74)]
    return lathe([(0.0, 0.0), (0.2, 0.0)] + outside + inside, 36)


def tumbler(radius, height):
    """Glass, and what it holds. The liquid reaches into the glass, so that no two faces coincide."""
    wall, bottom = 0.07 * height, 0.14 * height
    glass = [(0.0, 0.0), (radius * 0.88, 0.0), (radius * 0.93, 0.012), (radius * 0.95, 0.04)]
    glass += [(radius * (0.95 + 0.05 * k / 4), height * k / 4) for k in range(1, 4)]
    for k in range(7):
        a = math.pi * k / 6
        glass.append((radius - wall / 2 + wall / 2 * math.cos(a), height + wall / 2 * math.sin(a)))
    glass += [(radius * (0.95 + 0.05 * k / 4) - wall, height * k / 4) for k in (3, 2)]
    glass += [(radius * 0.96 - wall, bottom + 0.05), (radius * 0.92 - wall, bottom + 0.01), (radius * 0.84 - wall, bottom), (0.0, bottom)]
    reach, level = 0.4 * wall, 0.55 * height
    side = radius * 0.975 - wall + reach
    liquid = [(0.0, bottom - reach), (radius * 0.84 - wall, bottom - reach),
              (radius * 0.92 - wall + 0.7 * reach, bottom + 0.01 - 0.7 * reach), (radius * 0.96 - wall + reach, bottom + 0.05),
              (side, level), (side, level), (0.0, level)]
    return lathe(glass, 36), lathe(liquid, 36)


def drape(radius, height, hem):
    """A cloth over a round stand: flat on top, in folds that widen downwards."""
    def point(s, t):
        a = 2.0 * math.pi * s
        down = smooth_step(0.0, 1.0, (0.62 - t) / 0.62)
        fold = math.cos(9.0 * a + 0.8 * math.sin(2.0 * a)) + 0.45 * math.cos(14.0 * a + 1.0)
        if t > 0.62:
            turn = (1.0 - t) / 0.38  # from the middle of the top to the rim
            r, y = radius * turn, height - 0.05 * max(turn - 0.8, 0.0) ** 2 / 0.04
            return (-math.sin(a) * r, y, -math.cos(a) * r)
        r = radius + (hem - radius) * down + 0.055 * down ** 0.7 * fold
        y = (height - 0.05) * t / 0.62
        y += 0.012 * down * (1.0 + math.cos(5.0 * a))
        return (-math.sin(a) * r, y + 0.003, -math.cos(a) * r)
    return patch(point, 84, 14)


def branch(start, end, rise, leaves, size, seed):
    """A stem and its leaves, as two surfaces."""
    def at(t):
        return [a + (b - a) * t + (rise * math.sin(math.pi * t) if k == 1 else 0.0) for k, (a, b) in enumerate(zip(start, end))]
    def stem(s, t):
        a, r = 2.0 * math.pi * s, 0.012 * (1.1 - t)
        x, y, z = at(t)
        return (x - math.sin(a) * r, y, z - math.cos(a) * r)
    cards, tints = [], []
    for k in range(leaves):
        t = 0.42 + 0.58 * (k + 0.4) / leaves
        heading = 137.5 * k + 60.0 * hash01(k, seed)
        long = size * (0.8 + 0.4 * hash01(k, seed, 1))
        wide = 0.3 * long
        def card(s, u, long=long, wide=wide):
            x = (2.0 * s - 1.0) * wide
            return (x, 0.3 * abs(x) - 0.22 * long * u * u, long * u)
        tilt = -38.0 + 50.0 * hash01(k, seed, 2)
        one = patch(card, 2, 3).placed(matrix=rotation((1.0, 0.0, 0.0), tilt)).placed(at(t), matrix=rotation((0.0, 1.0, 0.0), heading))
        cards.append(one)
        young = hash01(k, seed, 3)
        tints += [mix((0.75, 0.85, 0.55), (1.0, 1.0, 0.75), young)] * len(one.points)
    return patch(stem, 6, 8), joined(cards), tints


def showcase():
    document = Document()
    document.camera("front", (0.1, 1.5, 5.4), (0.02, 0.72, 0.0), 25.4, 1.5)
    document.environment("showcase.hdr", radiance_map(128, 64, softboxes(SOFTBOXES, ambient)))

    boards = document.texture(shades(128, 128, wood, WOOD))
    table = document.surface_material("table", roughness=0.32, base=boards)
    def on_table(s, t):
        a, r = 2.0 * math.pi * s, 3.4 * (1.0 - t)
        return (-math.sin(a) * r, 0.0, 1.0 - math.cos(a) * r)
    top = patch(on_table, 96, 1, lambda s, t: (0.0, 1.0, 0.0))
    top.uvs = [(p[0] / 3.0 + 0.5, p[2] / 1.5) for p in top.points]
    document.surface("table", top, table)

    stone = document.surface_material("marble", roughness=0.12, base=document.texture(shades(96, 96, marble, MARBLE)))
    slab = box((-0.55, 0.001, -0.5), (0.55, 0.11, 0.5)).placed((-0.98, 0.0, -0.45), matrix=rotation((0.0, 1.0, 0.0), 14.0))
    document.surface("slab", slab, stone)

    blows = document.texture(normal_map(48, 48, dents, 0.06))
    copper = document.surface_material("hammered copper", (0.94, 0.50, 0.33), 1.0, 0.27,
                                       normal=document.use(blows, transform={"scale": [4.0, 3.0]}), doubleSided=True)
    document.small_surface("vase", vase().placed((-0.98, 0.112, -0.45)), copper)

    stems, leaves, tints = zip(*(branch((-0.98, 1.0, -0.45), end, rise, count, size, seed) for end, rise, count, size, seed in (
        ((-1.62, 1.78, -0.35), 0.14, 9, 0.32, 1), ((-0.9, 1.96, -0.75), 0.05, 9, 0.34, 2), ((-0.34, 1.72, -0.2), 0.16, 9, 0.32, 3))))
    bark = document.surface_material("bark", (0.16, 0.1, 0.06), roughness=0.7)
    document.small_surface("stems", joined(stems), bark, uv=False)
    green = document.surface_material("leaf", roughness=0.42, base=document.texture(leaf_picture(), ("clamp", "clamp")),
                                      alphaMode="MASK", doubleSided=True, extensions={"diffuse_transmission": {
                                          "diffuseTransmissionFactor": 0.35, "diffuseTransmissionColorFactor": [0.35, 0.6, 0.12]}})
    document.small_surface("leaves", joined(leaves).attribute("COLOR_0", [tint for part in tints for tint in part]), green)

    bands = [[1 if k in (56, 57, 58, 60) else 0] for k in range(64)]
    hem = document.texture(png(bands, PALETTE, 1, [(28, 48, 104), (226, 176, 84)]))
    velvet = document.surface_material("velvet", roughness=0.95, base=hem, doubleSided=True, extensions={
        "sheen": {"sheenColorFactor": [0.45, 0.6, 0.95], "sheenRoughnessFactor": 0.35}})
    document.small_surface("drape", drape(0.42, 0.5, 0.6).placed((1.02, 0.0, -0.5)), velvet)
    paint = document.surface_material("car paint", (0.62, 0.018, 0.02), 0.85, 0.42, extensions={
        "clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.0}})
    document.sphere("ball", (1.02, 0.505 + 0.43, -0.5), 0.43, paint)

    glass = document.surface_material("glass", roughness=0.0, extensions={
        "transmission": {"transmissionFactor": 1.0}, "volume": {"thicknessFactor": 1.0}, "ior": {"ior": 1.5}})
    whisky = document.surface_material("whisky", roughness=0.0, extensions={
        "transmission": {"transmissionFactor": 1.0}, "ior": {"ior": 1.36},
        "volume": {"thicknessFactor": 1.0, "attenuationDistance": 0.22, "attenuationColor": [0.93, 0.5, 0.09]}})
    cup, drink = tumbler(0.28, 0.56)
    document.small_surface("tumbler", cup.placed((0.2, 0.001, 0.35)), glass, uv=False)
    document.small_surface("whisky", drink.placed((0.2, 0.001, 0.35)), whisky, uv=False)

    egg = lathe(smooth_curve([(0.0, 0.0), (0.085, 0.022), (0.15, 0.12), (0.125, 0.26), (0.06, 0.36), (0.0, 0.385)], 3), 28)
    document.small_surface("egg", egg.placed((0.83, 0.001, 0.72), matrix=rotation((0.0, 1.0, 0.0), 40.0)), stone)

    gold = document.surface_material("gold", (1.0, 0.766, 0.336), 1.0, 0.22)
    document.small_surface("ring", torus(0.26, 0.068, 44, 14).placed((-0.5, 0.068, 0.78)), gold, uv=False)
    film = document.surface_material("film on metal", (0.3, 0.3, 0.32), 1.0, 0.2, extensions={
        "iridescence": {"iridescenceFactor": 1.0, "iridescenceIor": 1.8, "iridescenceThicknessMaximum": 310.0}})
    document.sphere("bead", (-0.5, 0.15, 0.78), 0.15, film)
    return document
