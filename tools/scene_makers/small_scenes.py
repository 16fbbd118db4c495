"""The scenes that are committed; scenes/README.md says what each proves."""

import colorsys
import math

from .gltf_document import Document, look_at
from .material_scenes import MATERIAL_SCENES
from .shapes import block, brilliant, bulb, icosahedron, rest_on_face, turn
from .showcase import showcase

WHITE, RED, GREEN = (0.73, 0.73, 0.71), (0.63, 0.065, 0.05), (0.14, 0.45, 0.091)


def cornell_room(document, light=0.5, radiance=(22.0, 19.0, 14.0)):
    """Two metres wide, open to the camera; the light hangs 1 cm below the ceiling and shines down. light=0: without it."""
    white, red, green = (document.material(*m) for m in (("white", WHITE), ("red", RED), ("green", GREEN)))
    document.camera("front", (0.0, 1.0, 3.95), (0.0, 1.0, 0.0), 37.4, 1.0)
    document.quad("floor", [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], white)
    document.quad("ceiling", [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]], white)
    document.quad("back", [[-1, 0, -1], [1, 0, -1], [1, 2, -1], [-1, 2, -1]], white)
    document.quad("left", [[-1, 0, 1], [-1, 0, -1], [-1, 2, -1], [-1, 2, 1]], red)
    document.quad("right", [[1, 0, -1], [1, 0, 1], [1, 2, 1], [1, 2, -1]], green)
    if light > 0:
        lamp, h = document.material("lamp", emission=radiance), light / 2
        document.quad("lamp", [[-h, 1.99, -h], [h, 1.99, -h], [h, 1.99, h], [-h, 1.99, h]], lamp)
    return white


def cornell():
    document = Document()
    white = cornell_room(document)
    points, indices = block((-0.3, 0.0, -0.3), (0.3, 1.2, 0.3))
    document.shape("tall box", turn(points, 18.0, (-0.35, 0.0, -0.35)), indices, white)
    points, indices = block((-0.3, 0.0, -0.3), (0.3, 0.6, 0.3))
    document.shape("short box", turn(points, -17.0, (0.35, 0.0, 0.35)), indices, white)
    return document


def cornell_spheres():
    document = Document()
    cornell_room(document)
    document.sphere("left", (-0.42, 0.45, -0.32), 0.45, document.material("chalk", (0.78, 0.78, 0.78)))
    document.sphere("right", (0.45, 0.33, 0.35), 0.33, document.material("ochre", (0.75, 0.52, 0.16)))
    return document


def cornell_mirror_glass():
    document = Document()
    cornell_room(document)
    mirror = document.material("mirror", (0.95, 0.95, 0.95), metallic=1.0, roughness=0.0)
    document.sphere("mirror", (-0.42, 0.45, -0.32), 0.45, mirror)
    document.sphere("glass", (0.45, 0.36, 0.35), 0.35, document.material("glass", (1.0, 1.0, 1.0), ior=1.5))
    return document


def cornell_gems():
    document = Document()
    cornell_room(document, light=0.7, radiance=(12.0, 11.0, 9.5))
    stones = (("diamond", brilliant(8), -1, 0.46, -12.0, (-0.4, 0.0, -0.1), (0.98, 0.98, 0.98), 2.4),
              ("sapphire", icosahedron(), 0, 0.33, 25.0, (0.46, 0.0, -0.3), (0.45, 0.62, 0.95), 1.77),
              ("emerald", brilliant(6), -1, 0.3, 40.0, (0.32, 0.0, 0.5), (0.5, 0.92, 0.62), 1.58))
    for name, (points, indices), face, size, degrees, center, tint, ior in stones:
        # A millimetre above the floor: if faces coincided, one could not tell which of them a ray met.
        resting = rest_on_face([[size * c for c in p] for p in points], indices, face, 0.001)
        document.shape(name, turn(resting, degrees, center), indices, document.material(name, tint, ior=ior))
    return document


def lit_floor(name, light, **placement):
    """A floor of albedo .5 and a white sphere; the camera of index 1 looks straight down on one metre of the floor."""
    document = Document()
    document.camera("front", (0.0, 1.6, 4.2), (0.0, 0.45, 0.0), 36.0, 4.0 / 3.0)
    straight_down = document.append("cameras", {"name": "above", "type": "orthographic", "orthographic": {
        "xmag": 0.05, "ymag": 0.05, "znear": 0.01, "zfar": 10.0}})
    document.node("above", camera=straight_down, matrix=look_at((-0.5, 1.5, 0.0), (-0.5, 0.0, 0.0), (0.0, 0.0, -1.0)))
    document.quad("floor", [[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]], document.material("grey", (0.5, 0.5, 0.5)))
    document.sphere("ball", (0.55, 0.4, 0.0), 0.4, document.material("white", WHITE))
    document.light(name, light, **placement)
    return document


def light_point():
    return lit_floor("bulb", {"type": "point", "color": [1.0, 0.85, 0.65], "intensity": 8.0},
                     translation=[-0.5, 2.0, 0.0])


def light_spot():
    cone = {"innerConeAngle": math.radians(18.0), "outerConeAngle": math.radians(28.0)}
    return lit_floor("stage light", {"type": "spot", "color": [1.0, 1.0, 1.0], "intensity": 20.0, "spot": cone},
                     matrix=look_at((-0.5, 2.5, 0.0), (-0.5, 0.0, 0.0), (0.0, 0.0, -1.0)))


def light_directional():
    return lit_floor("sun", {"type": "directional", "color": [1.0, 0.95, 0.9], "intensity": 3.0},
                     matrix=look_at((-3.0, 4.0, 0.0), (0.0, 0.0, 0.0)))


def inside(points, indices):
    """A room, of a solid's faces seen from within."""
    return points, [indices[i + k] for i in range(0, len(indices), 3) for k in (0, 2, 1)]


def furnace():
    document = Document()
    wall = document.material("wall", (0.5, 0.5, 0.5), emission=(0.5, 0.5, 0.5))
    document.camera("inside", (0.1, 0.2, 0.7), (-0.3, 0.0, -1.0), 70.0, 1.0)
    document.shape("room", *inside(*block((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))), wall)
    return document


def living_room(document):
    """Closed on all sides, 4.4 m wide, 2.6 m high and 5 m long, with the camera in a corner, a table and a cupboard."""
    names = ("plaster", (0.75, 0.74, 0.72)), ("oak", (0.52, 0.37, 0.23)), ("ochre", (0.66, 0.45, 0.18)), ("teal", (0.16, 0.4, 0.42))
    plaster, oak, ochre, teal = (document.material(*name) for name in names)
    document.camera("corner", (1.9, 1.5, 2.2), (-0.5, 0.95, -0.9), 62.0, 1.0)
    x, y, z = 2.2, 2.6, 2.5
    document.quad("floor", [[-x, 0, z], [x, 0, z], [x, 0, -z], [-x, 0, -z]], oak)
    document.quad("ceiling", [[-x, y, -z], [x, y, -z], [x, y, z], [-x, y, z]], plaster)
    document.quad("back", [[-x, 0, -z], [x, 0, -z], [x, y, -z], [-x, y, -z]], plaster)
    document.quad("front", [[x, 0, z], [-x, 0, z], [-x, y, z], [x, y, z]], plaster)
    document.quad("left", [[-x, 0, z], [-x, 0, -z], [-x, y, -z], [-x, y, z]], ochre)
    document.quad("right", [[x, 0, -z], [x, 0, z], [x, y, z], [x, y, -z]], plaster)
    points, indices = block((-0.6, 0.0, -0.4), (0.6, 0.7, 0.4))
    document.shape("table", turn(points, 12.0, (-0.6, 0.0, -0.9)), indices, teal)
    document.shape("cupboard", *block((-2.15, 0.0, 0.2), (-1.6, 1.8, 1.4)), plaster)


def closed_room():
    document = Document()
    living_room(document)
    lamp, h = document.material("lamp", emission=(9.0, 8.4, 7.2)), 0.35
    document.quad("lamp", [[-h, 2.59, -h], [h, 2.59, -h], [h, 2.59, h], [-h, 2.59, h]], lamp)
    return document


def shaded_lamp():
    """In the same room, above the table: a bulb of 1,280 triangles in a shade that is open at both ends."""
    document = Document()
    living_room(document)
    points, indices = bulb(3)
    x, y, z, r = -0.6, 1.65, -0.9, 0.06
    document.shape("bulb", [[x + r * a, y + r * b, z + r * c] for a, b, c in points], indices,
                   document.material("bulb", emission=(220.0, 190.0, 140.0)))
    sides = 24
    rims = [[x + radius * math.cos(2.0 * math.pi * i / sides), height, z + radius * math.sin(2.0 * math.pi * i / sides)]
            for radius, height in ((0.36, 1.6), (0.16, 1.84)) for i in range(sides)]
    shade = [k for i in range(sides) for j in [(i + 1) % sides] for k in (i, sides + i, j, j, sides + i, sides + j)]
    document.shape("shade", rims, shade, document.material("felt", (0.35, 0.3, 0.25), double_sided=True))
    return document


def door_ajar():
    """Two rooms of 4 x 3 x 4 m. The wall between them has a slit of 12 cm, 2 m high; the lamp is in the one, the camera in the other."""
    document = Document()
    grey, h = document.material("grey", (0.7, 0.7, 0.7)), 0.06
    document.camera("dark room", (0.4, 1.5, 0.4), (3.2, 1.0, 3.2), math.degrees(1.2), 1.0)
    document.shape("rooms", *inside(*block((0.0, 0.0, 0.0), (8.1, 3.0, 4.0))), grey)
    for name, low, high in (("wall", (4.0, 0.0, 0.0), (4.1, 3.0, 2.0 - h)), ("door", (4.0, 0.0, 2.0 + h), (4.1, 3.0, 4.0)),
                            ("lintel", (4.0, 2.0, 2.0 - h), (4.1, 3.0, 2.0 + h)), ("box", (1.2, 0.0, 2.4), (2.0, 0.8, 3.2))):
        document.shape(name, *block(low, high), grey)
    document.quad("lamp", [[5.6, 2.95, 1.5], [6.6, 2.95, 1.5], [6.6, 2.95, 2.5], [5.6, 2.95, 2.5]],
                  document.material("lamp", emission=(10.0, 10.0, 10.0)))
    return document


def mirror_room():
    """A closed room. Its lamp, in a tube, shines on a mirror alone, which lights what the camera sees."""
    document = Document()
    white, ochre = document.material("white", WHITE), document.material("ochre", (0.75, 0.52, 0.16))
    document.camera("corner", (-1.7, 1.5, -1.6), (0.3, 0.6, 1.6), 62.0, 1.0)
    document.shape("room", *inside(*block((-2.0, 0.0, -2.2), (2.0, 2.6, 2.2))), white)
    document.quad("mirror", [[-1.3, 0.2, -2.19], [1.3, 0.2, -2.19], [1.3, 2.4, -2.19], [-1.3, 2.4, -2.19]],
                  document.material("mirror", (0.9, 0.9, 0.9), metallic=1.0, roughness=0.0))
    place, r, length, h = look_at((0.0, 2.35, 0.9), (0.0, 1.3, -2.19)), 0.2, 1.2, 0.18
    tube = [[x, y, z] for z in (0.02, -length) for x, y in ((-r, -r), (r, -r), (r, r), (-r, r))]
    faces = [(0, 1, 2, 3)] + [(i, 4 + i, 4 + (i + 1) % 4, (i + 1) % 4) for i in range(4)]
    document.shape("tube", tube, [k for a, b, c, d in faces for k in (a, b, c, a, c, d)],
                   document.material("black", double_sided=True), matrix=place)
    document.shape("lamp", [[-h, -h, 0.0], [-h, h, 0.0], [h, h, 0.0], [h, -h, 0.0]], [0, 1, 2, 0, 2, 3],
                   document.material("lamp", emission=(1200.0, 1050.0, 850.0)), matrix=place)
    points, indices = block((-0.3, 0.0, -0.3), (0.3, 0.7, 0.3))
    document.shape("box", turn(points, 25.0, (0.9, 0.0, 1.3)), indices, ochre)
    document.sphere("ball", (-0.3, 0.35, 1.5), 0.35, white)
    return document


def veach_mis():
    """Eric Veach and Leonidas Guibas, Optimally Combining Sampling Techniques, 1995, figure 2, as commonly copied."""
    document = Document()
    document.camera("front", (0.0, 2.0, 15.0), (0.0, -2.0, 2.5), 28.0, 4.0 / 3.0)
    plates = ((0.005, -2.70651, 0.25609, -2.08375, -0.526323), (0.02, -3.28825, 1.36972, -2.83856, 0.476536),
              (0.05, -3.73096, 2.70046, -3.43378, 1.74564), (0.1, -3.99615, 4.0667, -3.82069, 3.08221))
    for alpha, front_y, front_z, back_y, back_z in plates:
        metal = document.material("plate %g" % alpha, (0.35, 0.4, 0.45), metallic=1.0, roughness=math.sqrt(alpha),
                                  double_sided=True)  # their shadows
        document.quad("plate %g" % alpha, [[-4, front_y, front_z], [4, front_y, front_z], [4, back_y, back_z],
                                           [-4, back_y, back_z]], metal)
    room = document.material("room", (0.4, 0.4, 0.4))
    document.quad("floor", [[-10, -4.14615, 10], [10, -4.14615, 10], [10, -4.14615, -10], [-10, -4.14615, -10]], room)
    document.quad("back", [[-10, -10, -2], [10, -10, -2], [10, 10, -2], [-10, 10, -2]], room)
    lamps = ((-3.75, 1.0 / 30.0, 901.803), (-1.25, 0.1, 100.0), (1.25, 0.3, 100.0 / 9.0), (3.75, 0.9, 100.0 / 81.0))
    for x, radius, radiance in lamps:
        material = document.material("lamp %g" % radius, emission=[radiance] * 3)
        document.sphere("lamp %g" % radius, (x, 0.0, 0.0), radius, material)
    document.sphere("fill", (10.0, 10.0, 4.0), 0.5, document.material("fill", emission=[800.0] * 3))
    return document


def many_lights():
    """32 x 32 emitters over a floor: three quads for each sphere, sixteen colours."""
    document = Document()
    document.camera("front", (0.0, 3.4, 9.0), (0.0, 0.7, 0.0), 34.0, 4.0 / 3.0)
    document.quad("floor", [[-6, 0, 6], [6, 0, 6], [6, 0, -6], [-6, 0, -6]], document.material("floor", WHITE))
    stone = document.material("stone", (0.55, 0.53, 0.5))
    for i in range(9):
        points, indices = block((-0.3, 0.0, -0.3), (0.3, 0.3 + 0.13 * (i * 4 % 9), 0.3))
        place = (1.7 * (i % 3 - 1), 0.0, 1.7 * (i // 3 - 1))
        document.shape("block %d" % i, turn(points, 20.0 * i, place), indices, stone)
    colors = [colorsys.hsv_to_rgb(i / 16.0, 0.65, 1.0) for i in range(16)]
    lamps = [document.material("lamp %d" % i, emission=[15.0 * c for c in color], double_sided=True)
             for i, color in enumerate(colors)]
    h = 0.025
    square = [[-h, 0, -h], [h, 0, -h], [h, 0, h], [-h, 0, h]]
    squares = [document.mesh(document.primitive(square, [0, 1, 2, 0, 2, 3], lamp)) for lamp in lamps]
    for i in range(1024):
        x, z = 0.24 * (i % 32 - 15.5), 0.24 * (i // 32 - 15.5)
        place = [round(x, 4), round(1.75 + 0.25 * math.sin(1.3 * x) * math.cos(1.1 * z), 4), round(z, 4)]
        color = int(8.0 * (2.0 + math.atan2(z, x) / math.pi)) % 16
        if i % 4 == 3:
            document.sphere("l%d" % i, place, h, lamps[color])
        else:
            document.node("l%d" % i, mesh=squares[color], translation=place)
    return document


SMALL_SCENES = {**MATERIAL_SCENES, **{function.__name__: function for function in (
    cornell, cornell_spheres, cornell_mirror_glass, cornell_gems, light_point, light_spot, light_directional, furnace,
    closed_room, shaded_lamp, door_ajar, mirror_room, veach_mis, many_lights, showcase)}}
