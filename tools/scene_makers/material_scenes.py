"""Scenes of materials, textures, alpha and media; scenes/README.md says what each proves."""

import math

from .gltf_document import Document, look_at
from .made_images import (GREY, PALETTE, RGB, RGBA, hash01, mix, normal_map, png, radiance_map, ramp, sample, smooth_step, softboxes,
                          turbulence)
from .shapes import brilliant, rest_on_face, turn
from .showcase import drape, leaf_picture, tumbler
from .surfaces import ball, joined, lathe, patch, rectangle, rotation, torus

GOLD, COPPER = (1.0, 0.766, 0.336), (0.955, 0.638, 0.538)


def light_by_softboxes(document):
    """The one map of these scenes; the built-in studio may change."""
    boxes = ((130.0, 42.0, 28.0, 22.0, (4.0, 3.9, 3.6)), (-110.0, 20.0, 16.0, 30.0, (1.2, 1.4, 1.7)),
             (-30.0, 40.0, 30.0, 14.0, (2.0, 2.0, 2.2)))
    def ambient(azimuth, elevation):
        return (0.15 + 0.25 * smooth_step(-30.0, 90.0, elevation),) * 3
    document.environment("softboxes.hdr", radiance_map(64, 32, softboxes(boxes, ambient)))


def checker(document, light=188, dark=90):
    return document.texture(png([[light, dark], [dark, light]], GREY), nearest=True)


def checkered(document, name, squares, texture=None, **more):
    """A rough material whose texture is a board of squares."""
    texture = checker(document) if texture is None else texture
    return document.surface_material(name, roughness=0.9, base=document.use(texture, transform={
        "scale": [squares / 2.0, squares / 2.0]}), **more)


def solid(ior=1.5, attenuation=None, distance=1.0, **more):
    """Extensions of a transmissive solid."""
    volume = {"thicknessFactor": 1.0}
    if attenuation:
        volume.update(attenuationDistance=distance, attenuationColor=list(attenuation))
    return {"transmission": {"transmissionFactor": 1.0}, "volume": volume, "ior": {"ior": ior}, **more}


def materials():
    document = Document()
    document.camera("front", (0.0, 0.0, 16.0), (0.0, 0.0, 0.0), 22.6, 1.0)
    light_by_softboxes(document)
    document.surface("wall", rectangle((-3.4, -3.4, -1.0), (6.8, 0.0, 0.0), (0.0, 6.8, 0.0)), checkered(document, "wall", 34))

    def make(name, *values, **more):
        return document.surface_material(name, *values, **more)

    steps = (0.0, 0.15, 0.3, 0.5, 0.75, 1.0)
    grid = [[make("plastic %g" % r, (0.6, 0.05, 0.04), 0.0, r) for r in steps],
            [make("gold %g" % r, GOLD, 1.0, r) for r in steps],
            [make("copper %g" % r, COPPER, 1.0, r) for r in steps]]
    striped = {"anisotropyStrength": 0.9}
    grid.append([
        make("clearcoat", (0.05, 0.25, 0.06), 0.0, 0.7, extensions={"clearcoat": {"clearcoatFactor": 1.0}}),
        make("rough clearcoat", (0.6, 0.2, 0.05), 1.0, 0.5, extensions={
            "clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.3}}),
        make("sheen", (0.05, 0.02, 0.1), 0.0, 1.0, extensions={
            "sheen": {"sheenColorFactor": [0.9, 0.7, 1.0], "sheenRoughnessFactor": 0.4}}),
        make("anisotropy", (0.8, 0.8, 0.8), 1.0, 0.35, extensions={"anisotropy": striped}),
        make("turned anisotropy", (0.8, 0.8, 0.8), 1.0, 0.35, extensions={
            "anisotropy": {**striped, "anisotropyRotation": math.pi / 2}}),
        make("iridescence", (0.9, 0.9, 0.9), 1.0, 0.1, extensions={"iridescence": {
            "iridescenceFactor": 1.0, "iridescenceIor": 1.4, "iridescenceThicknessMaximum": 450.0}})])
    grid.append([
        make("thin wall", (0.6, 0.9, 0.95), 0.0, 0.0, extensions={"transmission": {"transmissionFactor": 1.0}}),
        make("rough glass", (1.0, 1.0, 1.0), 0.0, 0.25, extensions=solid()),
        make("dispersion", (1.0, 1.0, 1.0), 0.0, 0.0, extensions=solid(1.7, dispersion={"dispersion": 2.0})),
        make("volume", (1.0, 1.0, 1.0), 0.0, 0.0, extensions=solid(1.33, (0.1, 0.6, 0.9), 0.5)),
        make("diffuse transmission", (0.5, 0.5, 0.5), 0.0, 0.6, extensions={"diffuse_transmission": {
            "diffuseTransmissionFactor": 0.7, "diffuseTransmissionColorFactor": [0.9, 0.5, 0.2]}}),
        make("half transmission", (0.9, 0.8, 0.2), 0.0, 0.4, extensions={"transmission": {"transmissionFactor": 0.5}})])
    grid.append([
        make("unlit", (0.2, 0.5, 0.8), extensions={"unlit": {}}),
        make("specular-glossiness", extensions={"pbrSpecularGlossiness": {
            "diffuseFactor": [0.05, 0.1, 0.3, 1.0], "specularFactor": [0.4, 0.3, 0.1], "glossinessFactor": 0.8}}),
        make("no specular", (0.5, 0.5, 0.5), 0.0, 0.3, extensions={"specular": {"specularFactor": 0.0}}),
        make("tinted specular", (0.02, 0.02, 0.02), 0.0, 0.2, extensions={
            "specular": {"specularColorFactor": [2.0, 0.6, 0.2]}, "ior": {"ior": 1.8}}),
        make("half metal", COPPER, 0.5, 0.3),
        make("blended", (0.7, 0.1, 0.5), 0.0, 0.3, 0.4, alphaMode="BLEND")])
    mesh = None
    for j, row in enumerate(grid):
        for i, material in enumerate(row):
            name, center = document.json["materials"][material]["name"], (i - 2.5, 2.5 - j, 0.0)
            if "anisotropy" in name and mesh is None:
                mesh = document.small_surface(name, ball(0.42, 28, 14).placed(center), material)
            elif "anisotropy" in name:
                document.copy(name, mesh, material, center)
            else:
                document.sphere(name, center, 0.42, material)
    return document


def textures():
    """Sixteen unlit squares, 90 cm wide, and a pair of half squares that are lit."""
    document = Document()
    document.camera("front", (0.0, 0.0, 12.0), (0.0, 0.0, 0.0), 20.0, 1.0)
    light_by_softboxes(document)
    arrow = [(40, 60, 160), (200, 60, 40), (230, 200, 60), (240, 240, 240)]  # no turn or mirror image of it is the same
    picture = png([[0, 0, 1, 2], [0, 3, 1, 1], [0, 3, 3, 0], [2, 0, 0, 0]], PALETTE, 2, arrow)
    first = document.texture(picture)

    def unlit(name, texture, uv_set=0, transform=None):
        return document.surface_material(name, base=document.use(texture, uv_set, transform), extensions={"unlit": {}})

    def square(index, material, low=0.0, high=1.0, part=(0.0, 1.0), uv1=False, **attributes):
        """A square of the grid, or a part of its width; texture coordinates from `low` to `high`."""
        x, y = index % 4 - 1.95, 1.05 - index // 4
        surface = rectangle((x + 0.9 * part[0], y, 0.0), (0.9 * (part[1] - part[0]), 0.0, 0.0), (0.0, 0.9, 0.0))
        surface.uvs = [tuple(low + (high - low) * c for c in uv) for uv in surface.uvs]
        if uv1:
            surface.attribute("TEXCOORD_1", surface.uvs)
            surface.uvs = [(0.1, 0.1)] * 4
        for name, values in attributes.items():
            surface.attribute(name, values)
        document.surface(document.json["materials"][material]["name"], surface, material)

    wraps = (("repeat", "repeat"), ("mirror", "mirror"), ("clamp", "clamp"), ("repeat", "mirror"))
    for k, nearest in enumerate((True, False)):
        for i, wrap in enumerate(wraps):
            name = "%s %s %s" % (*wrap, "nearest" if nearest else "linear")
            square(4 * k + i, unlit(name, document.texture(first, wrap, nearest)), -0.75, 1.75)
    plain = document.texture(first, nearest=True)
    square(8, unlit("uv set 1", plain, 1), uv1=True)
    square(9, unlit("offset and scale", plain, 0, {"offset": [0.25, 0.5], "scale": [2.0, 1.0]}))
    square(10, unlit("rotation", plain, 0, {"offset": [0.0, 1.0], "rotation": math.pi / 2}))
    square(11, unlit("the transform's uv set", plain, 0, {"texCoord": 1, "scale": [-1.0, 1.0]}), uv1=True)

    fine = document.texture(png([[round(65535 * (x + 0.5) / 16) for x in range(16)]], GREY, 16), ("clamp", "clamp"))
    square(12, unlit("16 bits", fine))
    # sRGB 188 is .502886: the halves look the same.
    grey = document.texture(png([[(188, 188, 188)]], RGB))
    square(13, unlit("sRGB 188", grey), part=(0.0, 0.5))
    half = document.surface_material("linear .502886", (0.502886, 0.502886, 0.502886), extensions={"unlit": {}})
    square(13, half, part=(0.5, 1.0))
    corners = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 1.0, 1.0)]
    square(14, document.surface_material("vertex colours", extensions={"unlit": {}}), COLOR_0=corners)
    # Data is linear: a byte of 128 is 128 / 255. Green is the roughness, blue the metallic factor.
    data = document.texture(png([[(0, 128, 255)]], RGB))
    square(15, document.surface_material("roughness by texture", GOLD, 1.0, 1.0, metal_rough=data), part=(0.0, 0.5))
    square(15, document.surface_material("roughness by factor", GOLD, 1.0, 128.0 / 255.0), part=(0.5, 1.0))
    return document


def normal_map_scene():
    """Two rows of four panels with the same domes: a mirror above, a rough plane below."""
    document = Document()
    document.camera("front", (0.0, 0.0, 9.0), (0.0, 0.0, 0.0), 26.0, 1.0)
    light_by_softboxes(document)
    def dome(u, v):
        x, y = (u * 2.0) % 1.0 - 0.5, (v * 2.0) % 1.0 - 0.5
        return math.sqrt(max(0.16 - x * x - y * y, 0.0))
    domes = document.texture(normal_map(48, 48, dome, 0.25))
    for row, (name, metallic, roughness) in enumerate((("mirror", 1.0, 0.05), ("rough", 0.0, 0.8))):
        material = document.surface_material(name, (0.75, 0.75, 0.75), metallic, roughness, normal=domes)
        for column in range(4):
            panel = rectangle((column - 1.95, 0.05 - 2.0 * row, 0.0), (0.9, 0.0, 0.0), (0.0, 1.9, 0.0), 2, 1)
            panel.uvs = [(u, 2.0 * v) for u, v in panel.uvs]
            kind = ("made tangents", "tangents of the file", "mirrored", "half mirrored")[column]
            if column == 1:
                panel.attribute("TANGENT", [(1.0, 0.0, 0.0, 1.0)] * len(panel.points))
            elif column == 2:
                panel.uvs = [(1.0 - u, v) for u, v in panel.uvs]
                panel.attribute("TANGENT", [(-1.0, 0.0, 0.0, -1.0)] * len(panel.points))
            elif column == 3:
                panel.uvs = [(min(u, 1.0 - u), v) for u, v in panel.uvs]  # the middle's vertices belong to both halves
            document.surface("%s, %s" % (name, kind), panel, material)
    return document


def alpha():
    document = Document()
    document.camera("front", (0.0, 1.5, 5.2), (0.0, 0.62, 0.0), 30.0, 1.0)
    floor = document.surface_material("floor", (0.5, 0.5, 0.5), 0.0, 1.0, extensions={"specular": {"specularFactor": 0.0}})
    document.surface("floor", rectangle((-3.0, 0.0, 2.0), (6.0, 0.0, 0.0), (0.0, 0.0, -4.5)), floor, uv=False)
    document.surface("wall", rectangle((-3.0, 0.0, -2.5), (6.0, 0.0, 0.0), (0.0, 3.5, 0.0)), checkered(document, "wall", 16))

    ring = png(sample(32, 32, lambda u, v: 1 + int(255 * v) // 20 if 0.22 < math.hypot(u - 0.5, v - 0.5) < 0.48 else 0), PALETTE, 4,
               [(0, 0, 0)] + ramp(((0.0, (0.9, 0.5, 0.1)), (1.0, (0.5, 0.05, 0.1))), 13), [0])
    fade = png([[(40, 90, 200, round(255 * (x + 0.5) / 16)) for x in range(16)]], RGBA)

    def card(name, corner, width, height, material, **attributes):
        surface = rectangle(corner, (width, 0.0, 0.0), (0.0, height, 0.0))
        for key, values in attributes.items():
            surface.attribute(key, values)
        document.surface(name, surface, material)

    def material(name, mode, **more):
        return document.surface_material(name, roughness=0.6, alphaMode=mode, doubleSided=True, **more)

    cut = material("cut-out", "MASK", base=document.texture(ring, ("clamp", "clamp")))
    fading = material("fading", "BLEND", base=document.texture(fade, ("clamp", "clamp")))
    card("ring behind", (-1.15, 0.1, -0.6), 1.1, 1.1, cut)
    card("fading, in front", (-1.25, 0.02, 0.1), 1.3, 0.75, fading)
    card("half", (0.1, 0.02, -0.3), 0.9, 1.0, document.surface_material("half", (0.8, 0.15, 0.1), 0.0, 0.6, 0.5, alphaMode="BLEND",
                                                                      doubleSided=True))
    card("ring in front", (0.45, 0.05, 0.25), 0.7, 0.7, cut)
    card("half by its corners", (0.95, 0.3, -0.8), 0.6, 1.3, material("of corners", "BLEND"),
         COLOR_0=[(0.2, 0.7, 0.2, 1.0), (0.2, 0.7, 0.2, 0.0), (0.9, 0.9, 0.1, 1.0), (0.9, 0.9, 0.1, 0.0)])
    leaf = document.surface_material("leaf", roughness=0.5, base=document.texture(leaf_picture(), ("clamp", "clamp")), alphaMode="MASK",
                                     doubleSided=True, extensions={"diffuse_transmission": {
                                         "diffuseTransmissionFactor": 0.4, "diffuseTransmissionColorFactor": [0.4, 0.7, 0.1]}})
    card("leaf", (-0.35, 0.02, 0.75), 0.5, 0.7, leaf)
    document.light("sun", {"type": "directional", "color": [1.0, 0.95, 0.9], "intensity": 3.0},
                   matrix=look_at((1.5, 4.0, 2.5), (0.0, 0.0, 0.0)))
    document.sphere("lamp", (-2.0, 3.2, 2.0), 0.25, document.material("lamp", emission=(20.0, 22.0, 26.0)))
    return document


def liquid():
    document = Document()
    document.camera("front", (0.0, 1.35, 5.0), (0.0, 0.5, 0.0), 24.0, 1.0)
    light_by_softboxes(document)
    document.surface("floor", rectangle((-2.0, 0.0, 1.5), (4.0, 0.0, 0.0), (0.0, 0.0, -4.0)), checkered(document, "floor", 16))
    glass = document.surface_material("glass", roughness=0.0, extensions=solid())
    wine = document.surface_material("wine", roughness=0.0, extensions=solid(1.34, (0.75, 0.05, 0.08), 0.12))
    ink = document.surface_material("ink", roughness=0.0, extensions=solid(1.33, (0.1, 0.5, 0.9), 0.3))
    air = document.surface_material("air", roughness=0.0, extensions=solid(1.0))
    cup, drink = tumbler(0.42, 0.9)
    document.small_surface("tumbler", cup.placed((-0.48, 0.001, 0.0)), glass, uv=False)
    document.small_surface("wine", drink.placed((-0.48, 0.001, 0.0)), wine, uv=False)
    document.sphere("globe", (0.5, 0.401, 0.1), 0.4, glass)
    document.sphere("ink in the globe", (0.5, 0.401, 0.1), 0.33, ink)
    document.sphere("bubble in the ink", (0.5, 0.5, 0.1), 0.12, air)
    document.sphere("half in the globe", (0.76, 0.66, 0.28), 0.14, wine)  # a part in the globe, a part in the air
    return document


def light_by_sun(document):
    """A sky whose sun is one texel, half a degree wide."""
    side, azimuth, elevation = 0.5, 40.25, 50.25
    def sky(a, e):
        if abs(a - azimuth) < 0.5 * side and abs(e - elevation) < 0.5 * side:
            return (76000.0, 71000.0, 62000.0)  # 3.7 W/m^2 across its light
        return mix((0.25, 0.24, 0.22), (0.12, 0.2, 0.4), smooth_step(-5.0, 60.0, e))
    document.environment("sun.hdr", radiance_map(720, 360, sky, packed=True))


def sun_glass():
    """What a globe and a gem in the light of a small sun throw on floor and wall. Camera 0 does not see them."""
    document = Document()
    document.camera("light", (0.0, 0.6, 2.6), (-0.45, 0.0, -0.3), 26.0, 1.0)
    document.camera("front", (0.0, 1.5, 4.2), (0.0, 0.6, -0.2), 36.0, 1.0)
    light_by_sun(document)
    grey = document.material("grey", (0.6, 0.58, 0.55))
    document.quad("floor", [[-3, 0, 2], [3, 0, 2], [3, 0, -1.6], [-3, 0, -1.6]], grey)
    document.quad("wall", [[-3, 0, -1.6], [3, 0, -1.6], [3, 2.5, -1.6], [-3, 2.5, -1.6]], grey)
    document.sphere("globe", (0.5, 1.15, 0.5), 0.4, document.material("glass", (1.0, 1.0, 1.0), ior=1.5))
    points, indices = brilliant(8)
    resting = rest_on_face([[0.4 * c for c in p] for p in points], indices, -1, 0.8)
    document.shape("gem", turn(resting, -12.0, (-0.35, 0.0, 0.5)), indices, document.material("sapphire", (0.6, 0.75, 0.97), ior=1.77))
    return document


def pool(document, **volume):
    """Filled with water, with a ball in it."""
    tiles = document.material("tiles", (0.55, 0.65, 0.68), double_sided=True)
    h, depth, w = 1.5, 1.2, 1.51  # the water ends within the walls
    corners = [[x, y, z] for y in (-depth, 0.1) for x, z in ((-h, h), (h, h), (h, -h), (-h, -h))]
    document.shape("pool", corners,
                   [0, 1, 2, 0, 2, 3, 3, 2, 6, 3, 6, 7, 0, 3, 7, 0, 7, 4, 2, 1, 5, 2, 5, 6, 1, 0, 4, 1, 4, 5], tiles)
    document.sphere("ball", (0.3, -0.95, -0.5), 0.25, document.material("rubber", (0.75, 0.3, 0.15)))
    water = document.surface_material("water", roughness=0.0, extensions=solid(1.33, **volume))
    def wave(s, t):
        x, z = 2.0 * w * (s - 0.5), 2.0 * w * (0.5 - t)
        return [x, 0.012 * math.sin(7.1 * x + 2.3 * z) + 0.01 * math.sin(3.7 * x - 8.9 * z + 1.0) + 0.006 * math.sin(13.0 * z + 4.0 * x), z]
    top = patch(wave, 40, 40)
    low = -depth - 0.01
    def side(a, b):  # from wave(*a) to wave(*b), and down
        def point(s, t):
            x, y, z = wave(a[0] + (b[0] - a[0]) * s, a[1] + (b[1] - a[1]) * s)
            return [x, low + (y - low) * t, z]
        return patch(point, 40, 1)
    bottom = rectangle((-w, low, -w), (2.0 * w, 0.0, 0.0), (0.0, 0.0, 2.0 * w))
    sides = [side((0.0, 0.0), (1.0, 0.0)), side((1.0, 0.0), (1.0, 1.0)), side((1.0, 1.0), (0.0, 1.0)), side((0.0, 1.0), (0.0, 0.0))]
    document.small_surface("water", joined([top, bottom, *sides]), water, uv=False)


def sun_water():
    """The inside of a pool under a small sun. The camera is in the water and does not see its surface."""
    document = Document()
    document.camera("diver", (0.0, -0.35, 1.2), (0.0, -1.2, -0.5), 50.0, 1.0)
    light_by_sun(document)
    pool(document, attenuation=(0.6, 0.85, 0.9), distance=3.0)
    return document


def lamp_water():
    """The same pool of clear water under a lamp, seen from above. It is not committed: tests/bench/guiding_peers.py renders it."""
    document = Document()
    document.camera("edge", (0.0, 1.3, 1.9), (0.0, -0.9, -0.3), 50.0, 1.0)
    h = 0.25
    document.quad("lamp", [[-h, 2.0, -h], [h, 2.0, -h], [h, 2.0, h], [-h, 2.0, h]], document.material("lamp", emission=(60.0, 55.0, 45.0)))
    pool(document)
    return document


def wax():
    """A candle, a glass of milk and a ring of jade: each lets light in otherwise, and names its scattering by another extension."""
    document = Document()
    document.camera("front", (0.0, 1.35, 5.0), (0.0, 0.47, 0.0), 24.0, 1.0)
    light_by_softboxes(document)
    document.surface("floor", rectangle((-2.0, 0.0, 1.5), (4.0, 0.0, 0.0), (0.0, 0.0, -4.0)), checkered(document, "floor", 16))
    candle = document.surface_material("candle", roughness=0.45, extensions=solid(1.45, (0.5, 0.4, 0.3), 0.02, scatter={
        "scatterStrengthFactor": 1.0, "multiscatterColorFactor": [0.93, 0.8, 0.55], "scatterAnisotropy": 0.3}))
    milk = document.surface_material("milk", roughness=0.0, extensions=solid(1.34, (0.4, 0.4, 0.4), 0.03, volume_scatter={
        "multiscatterColor": [0.95, 0.93, 0.87], "scatterAnisotropy": 0.7}))
    jade = document.surface_material("jade", roughness=0.2, extensions={
        "diffuse_transmission": {"diffuseTransmissionFactor": 1.0},
        "volume": {"thicknessFactor": 1.0, "attenuationDistance": 0.15, "attenuationColor": [0.35, 0.8, 0.45]},
        "subsurface": {"scatterColor": [0.3, 0.3, 0.3], "scatterDistance": 0.05}})
    glass = document.surface_material("glass", roughness=0.0, extensions=solid())
    cup, drink = tumbler(0.3, 0.7)
    document.small_surface("tumbler", cup.placed((0.02, 0.001, 0.35)), glass, uv=False)
    document.small_surface("milk", drink.placed((0.02, 0.001, 0.35)), milk, uv=False)
    outline = [(0.0, 0.0), (0.28, 0.0), (0.28, 0.0), (0.27, 0.5), (0.28, 0.95), (0.25, 1.0), (0.18, 0.96), (0.0, 0.93)]
    document.small_surface("candle", lathe(outline).placed((-0.62, 0.001, -0.1)), candle, uv=False)
    ring = torus(0.24, 0.09).placed(matrix=rotation((1.0, 0.0, 0.0), 80.0))
    document.small_surface("ring", ring.placed((0.68, 0.34, 0.0)), jade, uv=False)
    return document


def product():
    """A vase, a glass and a ball, which slides away within a second, on a table that is there for its shadows and reflections alone."""
    document = Document()
    document.camera("front", (0.0, 1.3, 3.9), (0.05, 0.38, 0.0), 24.0, 1.5)
    light_by_softboxes(document)
    table = document.surface_material("table", (0.6, 0.55, 0.5), 0.0, 0.25, extras={"shadowCatcher": True})
    document.surface("table", rectangle((-4.0, 0.0, 3.0), (8.0, 0.0, 0.0), (0.0, 0.0, -8.0)), table, uv=False)
    copper = document.surface_material("copper", COPPER, 1.0, 0.2)
    outline = [(0.0, 0.0), (0.18, 0.0), (0.27, 0.12), (0.31, 0.28), (0.25, 0.46), (0.14, 0.62), (0.1, 0.74), (0.16, 0.9), (0.13, 0.9), (0.0, 0.6)]
    document.small_surface("vase", lathe(outline).placed((-0.55, 0.001, -0.1)), copper, uv=False)
    glass = document.surface_material("glass", roughness=0.0, extensions=solid())
    document.small_surface("tumbler", tumbler(0.28, 0.6)[0].placed((0.12, 0.001, 0.3)), glass, uv=False)
    paint = document.surface_material("paint", (0.5, 0.03, 0.05), 0.0, 0.35, extensions={"clearcoat": {"clearcoatFactor": 1.0}})
    slider = document.small_surface("ball", ball(0.32, 40, 20).placed((0.7, 0.32, -0.15)), paint, uv=False)
    x, y, z = document.json["nodes"][slider]["translation"]
    document.append("animations", {"name": "slide", "samplers": [{
        "input": document.seconds([0.0, 1.0]), "output": document.vectors([(x, y, z), (x + 0.6, y, z - 0.4)])}], "channels": [{
            "sampler": 0, "target": {"node": slider, "path": "translation"}}]})
    return document


def car_paint():
    """Three balls: paint and coat, paint alone, and a coat like orange peel."""
    document = Document()
    document.camera("front", (0.0, 1.2, 4.6), (0.0, 0.62, 0.0), 26.0, 1.0)
    light_by_softboxes(document)
    document.surface("floor", rectangle((-2.0, 0.0, 1.5), (4.0, 0.0, 0.0), (0.0, 0.0, -4.0)), checkered(document, "floor", 16))
    def flake(u, v):  # flat flakes, each tilted by itself
        i, j = int(u * 32), int(v * 32)
        n = (0.5 * hash01(i, j, 4) - 0.25, 0.5 * hash01(i, j, 5) - 0.25, 1.0)
        length = math.sqrt(sum(c * c for c in n))
        return tuple(int((c / length * 0.5 + 0.5) * 255.0 + 0.5) for c in n)
    tilts = document.use(document.texture(png(sample(32, 32, flake)), nearest=True), transform={"scale": [6.0, 3.0]})
    peel = document.use(document.texture(normal_map(32, 32, lambda u, v: turbulence(u, v, 6, 6, 1), 0.02)), transform={"scale": [4.0, 2.0]})
    coat = {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.0}
    mesh = None
    for name, place, extensions in (("smooth coat", (-0.45, 0.42, 0.0), {"clearcoat": coat}), ("no coat", (0.47, 0.42, 0.05), None),
                                    ("orange peel", (0.02, 1.04, -0.35), {"clearcoat": {
                                        **coat, "clearcoatRoughnessFactor": 0.05, "clearcoatNormalTexture": peel}})):
        paint = document.surface_material(name, (0.55, 0.02, 0.02), 0.9, 0.4, normal=tilts, extensions=extensions)
        if mesh is None:
            mesh = document.small_surface(name, ball(0.42, 40, 20).placed(place), paint)
        else:
            document.copy(name, mesh, paint, place)
    return document


def cloth():
    document = Document()
    document.camera("front", (0.0, 1.3, 4.6), (0.0, 0.48, 0.0), 24.0, 1.0)
    light_by_softboxes(document)
    document.surface("floor", rectangle((-2.0, 0.0, 1.5), (4.0, 0.0, 0.0), (0.0, 0.0, -4.0)), checkered(document, "floor", 16))
    stripes = document.texture(png([[(255, 60, 60)] * 2 + [(70, 110, 255)] * 2], RGB), nearest=True)
    velvet = document.surface_material("velvet", (0.03, 0.02, 0.05), roughness=1.0, doubleSided=True, extensions={"sheen": {
        "sheenColorFactor": [0.9, 0.9, 0.9], "sheenRoughnessFactor": 0.35,
        "sheenColorTexture": document.use(stripes, transform={"scale": [12.0, 1.0]})}})
    document.small_surface("drape", drape(0.36, 0.62, 0.55).placed((-0.42, 0.0, -0.2)), velvet)
    for name, x, roughness in (("silk", 0.3, 0.15), ("felt", 0.71, 0.9)):
        sheen = {"sheenColorFactor": [0.8, 0.75, 0.6], "sheenRoughnessFactor": roughness}
        material = document.surface_material(name, (0.2, 0.06, 0.02), roughness=0.9, extensions={"sheen": sheen})
        document.sphere(name, (x, 0.2, 0.45), 0.19, material)
    plain = document.surface_material("no sheen", (0.2, 0.06, 0.02), roughness=0.9)
    document.sphere("no sheen", (0.5, 0.2, -0.2), 0.19, plain)
    return document


MATERIAL_SCENES = {"materials": materials, "textures": textures, "normal_map": normal_map_scene, "alpha": alpha, "liquid": liquid,
                   "wax": wax, "sun_glass": sun_glass, "sun_water": sun_water,
                   "product": product, "car_paint": car_paint, "cloth": cloth}
