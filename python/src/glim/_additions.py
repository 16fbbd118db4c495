"""Lights and floors that are added to a scene."""

import base64
import json
import math
import struct
from typing import Optional, Sequence, Tuple, Union

from glim._elements import finite
from glim._errors import unusable


class Light:
    """A light for Scene.add.

    kind: "point", "spot" or "directional".
    intensity: W/sr; of a directional light W/m^2 on a surface that faces it. color: linear Rec.709.
    position: metres. direction: along which a spot or a directional light shines.
    range: metres, beyond which it does not shine. cone: inner and outer angle of a spot from its axis, radians.

    Raises InputError."""

    def __init__(self, kind: str = "point", *, intensity: float = 1.0, color: Sequence[float] = (1, 1, 1),
                 position: Sequence[float] = (0, 0, 0), direction: Sequence[float] = (0, -1, 0), range: Optional[float] = None,
                 cone: Tuple[float, float] = (0.0, math.pi / 4), name: str = "light"):
        if kind not in ("point", "spot", "directional"):
            raise unusable("kind", kind, "point, spot or directional", "unknown-name")
        light = {"type": kind, "name": name, "intensity": finite("intensity", intensity),
                 "color": finite("color", color, (3,), "3 numbers")}
        if range is not None:
            light["range"] = finite("range", range)
        if kind == "spot":
            inner, outer = finite("cone", cone, (2,), "2 angles in radians")
            light["spot"] = {"innerConeAngle": inner, "outerConeAngle": outer}
        node = {"name": name, "translation": finite("position", position, (3,), "3 numbers"), "rotation": _towards(direction),
                "extensions": {"KHR_lights_punctual": {"light": 0}}}
        self._document = {"extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": [light]}},
                          "nodes": [node]}


def _towards(direction):
    """The quaternion that turns -z to a direction."""
    numbers = finite("direction", direction, (3,), "3 numbers")
    length = math.hypot(*numbers)
    if not length > 0:
        raise unusable("direction", direction, "3 numbers other than 0", "degenerate")
    x, y, z = (number / length for number in numbers)
    if z > 1 - 1e-12:
        return [0.0, 1.0, 0.0, 0.0]
    # Half of the way from -z: 1 + cos and the cross product, of (0, 0, -1) and the direction.
    quaternion = [y, -x, 0.0, 1 - z]
    norm = math.hypot(*quaternion)
    return [number / norm for number in quaternion]


class Plane:
    """A floor for Scene.add: a rectangle of one colour, seen from both sides. Its node turns and moves it.

    size: along x and z, metres. position: of its middle, metres. color: linear Rec.709. roughness, metallic: as of materials.

    Raises InputError."""

    def __init__(self, size: Tuple[float, float] = (10, 10), *, position: Sequence[float] = (0, 0, 0),
                 color: Sequence[float] = (0.5, 0.5, 0.5), roughness: float = 1.0, metallic: float = 0.0, name: str = "plane"):
        x, z = (0.5 * side for side in finite("size", size, (2,), "2 lengths"))
        if not min(x, z) > 0:
            raise unusable("size", size, "2 lengths above 0", "out-of-range")
        corners = struct.pack("<12f", -x, 0, z, x, 0, z, x, 0, -z, -x, 0, -z) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
        factors = {"baseColorFactor": finite("color", color, (3,), "3 numbers") + [1.0],
                   "roughnessFactor": finite("roughness", roughness),
                   "metallicFactor": finite("metallic", metallic)}
        self._document = {
            "buffers": [{"byteLength": len(corners), "uri": "data:application/octet-stream;base64," + base64.b64encode(corners).decode()}],
            "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-x, 0, -z], "max": [x, 0, z]},
                          {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
            "materials": [{"name": name, "pbrMetallicRoughness": factors, "doubleSided": True}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
            "nodes": [{"name": name, "mesh": 0, "translation": finite("position", position, (3,), "3 numbers")}]}


def written(thing: Union[Light, Plane]) -> bytes:
    """As a glTF file."""
    return json.dumps({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], **thing._document}).encode()
