"""Nodes, materials, images, lights and cameras of a scene's files. Each edit of them is a pointer of glTF's object model."""

import base64
import difflib
import json
import math
from typing import Any, Dict, Generic, Iterator, List, Optional, Sequence, Tuple, Type, TypeVar, Union

import numpy

from glim._camera import _numbers, _rows
from glim._errors import InputError, unusable
from glim._options import values_of
from glim._own_files import png_of

_LIGHTS = "/extensions/KHR_lights_punctual/lights"


class Element:
    """A part of a file, with the edits of its scene. `pointer`: where Scene.set finds it. `name`: None if it has none."""

    _list = ""

    def __init__(self, file: "SceneFile", index: int, name: Optional[str]):
        self._file, self.index, self.name = file, index, name

    @property
    def pointer(self) -> str:
        return self._file.prefix + self._place

    @property
    def _place(self):
        return "%s/%d" % (self._list, self.index)

    def _get(self, path, fallback):
        value = self._file.value(self)
        for step in path.split("/"):
            if step not in value:
                return fallback
            value = value[step]
        return value

    def _set(self, values):
        """values: by paths below the element."""
        self._file.edit(self, values)

    def __eq__(self, other) -> bool:
        return isinstance(other, Element) and self._file.scene is other._file.scene and self.pointer == other.pointer

    def __hash__(self) -> int:
        return hash(self.pointer)

    def __repr__(self) -> str:
        return "<glim %s %s%s>" % (type(self).__name__.lower(), self.pointer, "" if self.name is None else ' "%s"' % self.name)


Got = TypeVar("Got")
Given = TypeVar("Given")


class _Property(Generic[Got, Given]):
    """What is at a path below an element. `fallback`: of files without it."""

    def __init__(self, path: str, fallback: Optional[Got]):
        self._path, self._fallback = path, fallback

    def __set_name__(self, owner, name):
        self._name = name

    def __get__(self, element: Element, owner=None) -> Got:
        return self if element is None else element._get(self._path, self._fallback)  # type: ignore[return-value]

    def __set__(self, element: Element, value: Given) -> None:
        element._set({self._path: self._checked(value)})


class _Number(_Property[float, float]):
    def _checked(self, value):
        return finite(self._name, value)


class _Color(_Property[Tuple[float, float, float], Sequence[float]]):
    def __get__(self, element: Element, owner=None) -> Tuple[float, float, float]:
        return self if element is None else tuple(super().__get__(element))  # type: ignore[return-value]

    def _checked(self, value):
        return finite(self._name, value, (3,), "3 numbers")


class _Flag(_Property[bool, bool]):
    def _checked(self, value):
        if not isinstance(value, (bool, numpy.bool_)):
            raise unusable(self._name, value, "True or False")
        return bool(value)


class _Word(_Property[str, str]):
    def _checked(self, value):
        if not isinstance(value, str):
            raise unusable(self._name, value, "a text")
        return value


class Node(Element):
    """A node, relative to its parent. A node of the file with a matrix that shears has no translation, rotation and scale."""

    _list = "/nodes"

    #: also of what is below it
    visible = _Flag("extensions/KHR_node_visibility/visible", True)

    @property
    def translation(self) -> Tuple[float, float, float]:
        """Metres."""
        return self._part("translation", (0.0, 0.0, 0.0))

    @translation.setter
    def translation(self, value: Sequence[float]) -> None:
        self._set({"translation": finite("translation", value, (3,), "3 numbers")})

    @property
    def rotation(self) -> Tuple[float, float, float, float]:
        """A quaternion x, y, z, w, of any length but 0."""
        return self._part("rotation", (0.0, 0.0, 0.0, 1.0))

    @rotation.setter
    def rotation(self, value: Sequence[float]) -> None:
        numbers = finite("rotation", value, (4,), "a quaternion x, y, z, w")
        if not any(numbers):
            raise unusable("rotation", value, "a quaternion x, y, z, w other than 0", "degenerate")
        self._set({"rotation": numbers})

    @property
    def scale(self) -> Tuple[float, float, float]:
        return self._part("scale", (1.0, 1.0, 1.0))

    @scale.setter
    def scale(self, value: Sequence[float]) -> None:
        self._set({"scale": finite("scale", value, (3,), "3 numbers")})

    @property
    def matrix(self):
        """(4, 4) float64, node to parent, metres."""
        columns = self._get("matrix", None)
        if columns is not None:
            return numpy.array(columns, float).reshape(4, 4).T
        x, y, z, w = numpy.divide(self.rotation, math.hypot(*self.rotation))
        matrix = numpy.eye(4)
        matrix[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                          [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                          [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
        matrix[:3, :3] *= self.scale
        matrix[:3, 3] = self.translation
        return matrix

    @matrix.setter
    def matrix(self, value: Any) -> None:
        self._set({"matrix": columns_of("matrix", value)})

    def _part(self, name, fallback):
        value = self._file.value(self)
        if "matrix" in value and "translation" not in value:
            raise InputError("%s: %s has a matrix that shears, flattens or projects, expected an edit of its matrix" % (name, self.pointer),
                             "degenerate", place=self.pointer, expected="an edit of its matrix")
        return tuple(value.get(name, fallback))


class Material(Element):
    """A material of the metallic-roughness model. Where it has a texture, the texture is multiplied by these values. Colours are linear
    Rec.709."""

    _list = "/materials"

    metallic = _Number("pbrMetallicRoughness/metallicFactor", 1.0)
    roughness = _Number("pbrMetallicRoughness/roughnessFactor", 1.0)
    #: OPAQUE, MASK or BLEND
    alpha_mode = _Word("alphaMode", "OPAQUE")
    alpha_cutoff = _Number("alphaCutoff", 0.5)
    double_sided = _Flag("doubleSided", False)
    ior = _Number("extensions/KHR_materials_ior/ior", 1.5)
    specular = _Number("extensions/KHR_materials_specular/specularFactor", 1.0)
    specular_color = _Color("extensions/KHR_materials_specular/specularColorFactor", (1.0, 1.0, 1.0))
    transmission = _Number("extensions/KHR_materials_transmission/transmissionFactor", 0.0)
    #: metres; above 0 the surface bounds a solid
    thickness = _Number("extensions/KHR_materials_volume/thicknessFactor", 0.0)
    attenuation_color = _Color("extensions/KHR_materials_volume/attenuationColor", (1.0, 1.0, 1.0))
    #: metres
    attenuation_distance = _Number("extensions/KHR_materials_volume/attenuationDistance", math.inf)
    dispersion = _Number("extensions/KHR_materials_dispersion/dispersion", 0.0)
    clearcoat = _Number("extensions/KHR_materials_clearcoat/clearcoatFactor", 0.0)
    clearcoat_roughness = _Number("extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", 0.0)
    sheen_color = _Color("extensions/KHR_materials_sheen/sheenColorFactor", (0.0, 0.0, 0.0))
    sheen_roughness = _Number("extensions/KHR_materials_sheen/sheenRoughnessFactor", 0.0)
    anisotropy = _Number("extensions/KHR_materials_anisotropy/anisotropyStrength", 0.0)
    #: radians
    anisotropy_rotation = _Number("extensions/KHR_materials_anisotropy/anisotropyRotation", 0.0)
    iridescence = _Number("extensions/KHR_materials_iridescence/iridescenceFactor", 0.0)

    @property
    def base_color(self) -> Tuple[float, float, float, float]:
        """Red, green, blue and alpha. Three numbers leave alpha as it is."""
        return tuple(self._get("pbrMetallicRoughness/baseColorFactor", (1.0, 1.0, 1.0, 1.0)))

    @base_color.setter
    def base_color(self, value: Sequence[float]) -> None:
        numbers = finite("base_color", value, (3, 4), "3 or 4 numbers")
        self._set({"pbrMetallicRoughness/baseColorFactor": numbers if len(numbers) == 4 else numbers + [self.base_color[3]]})

    @property
    def emission(self) -> Tuple[float, float, float]:
        """Radiance, W/(sr m^2)."""
        strength = self._get("extensions/KHR_materials_emissive_strength/emissiveStrength", 1.0)
        return tuple(strength * number for number in self._get("emissiveFactor", (0.0, 0.0, 0.0)))

    @emission.setter
    def emission(self, value: Sequence[float]) -> None:
        self._set({"emissiveFactor": finite("emission", value, (3,), "3 numbers"),
                   "extensions/KHR_materials_emissive_strength/emissiveStrength": 1.0})

    @property
    def images(self) -> Dict[str, "Image"]:
        """Those of its textures, by glTF's names: baseColorTexture, normalTexture, clearcoatRoughnessTexture and others."""
        return dict(_images_in(self._file, self._file.value(self)))


def _images_in(file, value):
    for name, member in value.items():
        if name.endswith("Texture") and isinstance(member, dict):
            image = file.image_of(member["index"])
            if image is not None:
                yield name, image
        elif isinstance(member, dict):
            yield from _images_in(file, member)


class Image(Element):
    """An image of the file, which one or several textures draw."""

    _list = "/images"

    def replace(self, pixels: Any) -> None:
        """Draws others in its place. A texture may show a part of them, or repeat them, as the file has it.

        pixels: (height, width), (height, width, 3) or (height, width, 4), uint8 or uint16, of anything with the buffer protocol or
            __dlpack__. Row 0 is at v = 0. Encoded as the file's are: colours by sRGB, all else linear. Without a fourth channel alpha
            is 1."""
        self._set({"uri": "data:image/png;base64," + base64.b64encode(png_of(pixels)).decode()})

    def undo(self) -> None:
        """Draws the file's pixels again."""
        self._file.scene.set(self.pointer + "/uri", None)


class PunctualLight(Element):
    """A light of KHR_lights_punctual. Its nodes say where it is; it shines along their -z."""

    _list = _LIGHTS

    color = _Color("color", (1.0, 1.0, 1.0))
    #: W/sr; of a directional light W/m^2
    intensity = _Number("intensity", 1.0)
    #: metres
    range = _Number("range", math.inf)
    #: radians
    inner_cone_angle = _Number("spot/innerConeAngle", 0.0)
    #: radians
    outer_cone_angle = _Number("spot/outerConeAngle", math.pi / 4)

    @property
    def kind(self) -> str:
        """point, spot or directional"""
        return self._get("type", None)

    @property
    def nodes(self) -> List[Node]:
        return [node for node in self._file.nodes if node._get("extensions/KHR_lights_punctual/light", None) == self.index]


class FileCamera(Element):
    """A camera of the file. Its nodes say where it is; it looks along their -z."""

    _list = "/cameras"

    #: vertical, radians; None of an orthographic camera
    yfov = _Number("perspective/yfov", None)
    #: width over height; None if the picture's size says it
    aspect_ratio = _Number("perspective/aspectRatio", None)
    #: half of the width, metres; None of a perspective camera
    xmag = _Number("orthographic/xmag", None)
    #: half of the height, metres; None of a perspective camera
    ymag = _Number("orthographic/ymag", None)

    @property
    def kind(self) -> str:
        """perspective or orthographic"""
        return self._get("type", None)

    def options(self) -> Dict[str, Any]:
        """What it means as options of Scene.render."""
        names = [node.name or self.name for node in self.nodes]
        if not names or names[0] is None:
            raise unusable("camera", self, "a camera with a name and a node, or an index")
        return {"camera": names[0]}

    @property
    def nodes(self) -> List[Node]:
        return [node for node in self._file.nodes if node._get("camera", None) == self.index]


T = TypeVar("T", bound=Element)


class Elements(Generic[T]):
    """The elements of one kind, by index or by name: elements[0], elements["chair"], "chair" in elements, len(elements)."""

    def __init__(self, file: "SceneFile", kind: Type[T], what: str):
        self._file, self._kind, self._what = file, kind, what

    @property
    def names(self) -> List[Optional[str]]:
        """In the file's order; None of those without a name."""
        return [name or None for name in self._file.names(self._kind._list)]

    def __len__(self) -> int:
        return len(self.names)

    def __contains__(self, name) -> bool:
        return isinstance(name, str) and name in self.names

    def __iter__(self) -> Iterator[T]:
        return (self._kind(self._file, index, name) for index, name in enumerate(self.names))

    def __getitem__(self, key: Union[int, str]) -> T:
        names = self.names
        if isinstance(key, str):
            found = [index for index, name in enumerate(names) if name == key]
            if len(found) != 1:
                raise self._unknown(key, names, found)
            index = found[0]
        else:
            try:
                index = range(len(names))[key.__index__()]
            except AttributeError:
                raise unusable(self._what, key, "an index or a name") from None
            except IndexError:
                expected = "an index from 0 to %d, or a name" % (len(names) - 1) if names else "none, since there is none"
                raise unusable(self._what, key, expected, "dangling-index") from None
        return self._kind(self._file, index, names[index])

    def _unknown(self, key, names, found):
        if found:
            return unusable(self._what, key, "an index, as %d elements have this name: %s" % (len(found), _listed(map(str, found))),
                            "ambiguous-name")
        known = [name for name in names if name]
        near = difflib.get_close_matches(key, known) or known
        return unusable(self._what, key, "one of " + _listed('"%s"' % name for name in near) if near else "an index, since none has a name",
                        "unknown-name")

    def __repr__(self) -> str:
        return "<glim %s: %s>" % (self._what, _listed("%d" % i if name is None else '%d "%s"' % (i, name)
                                                      for i, name in enumerate(self.names)) or "none")


def _listed(texts, most=8):
    texts = list(texts)
    return ", ".join(texts[:most]) + (", and %d more" % (len(texts) - most) if len(texts) > most else "")


class SceneFile:
    """A file of a scene."""

    def __init__(self, scene, path: str, prefix: str = ""):
        self.scene, self.path, self.prefix = scene, path, prefix  # `prefix`: of its pointers in edits of the scene

    @property
    def nodes(self) -> Elements[Node]:
        return Elements(self, Node, "nodes")

    @property
    def materials(self) -> Elements[Material]:
        return Elements(self, Material, "materials")

    @property
    def lights(self) -> Elements[PunctualLight]:
        """Point, spot and directional lights."""
        return Elements(self, PunctualLight, "lights")

    @property
    def cameras(self) -> Elements[FileCamera]:
        return Elements(self, FileCamera, "cameras")

    @property
    def images(self) -> Elements[Image]:
        """Textures' pixels."""
        return Elements(self, Image, "images")

    def image_of(self, texture: int) -> Optional[Image]:
        with self.scene._reading(self.path) as read:
            index = read.image_of(texture)
        return None if index is None else self.images[index]

    def names(self, place) -> List[str]:
        with self.scene._reading(self.path) as read:
            return read.names(place)

    def value(self, element: Element, more: Dict[str, Any] = {}) -> Dict[str, Any]:
        """The members of an element after the edits of it, and then these."""
        edits = {pointer[len(self.prefix):]: value for pointer, value in self.scene.edits.items() if pointer.startswith(self.prefix)}
        places = [element._place + "/"]
        if element.name is not None:
            places.append("%s/%s/" % (element._list, element.name.replace("~", "~0").replace("/", "~1")))
        own = {pointer: value for pointer, value in edits.items() if pointer.startswith(tuple(places))}
        for path, value in more.items():
            own.pop("%s/%s" % (element._place, path), None)
            own["%s/%s" % (element._place, path)] = value
        with self.scene._reading(self.path) as read:
            return json.loads(read.value(element._place, values_of({"set": own})["set"]))

    def edit(self, element: Element, values: Dict[str, Any]) -> None:
        self.value(element, values)  # refuses what cannot be
        for path, value in values.items():
            self.scene.set("%s/%s" % (element.pointer, path), value)


class Addition(SceneFile):
    """A file that is added to a scene: its nodes, materials and lights."""

    def __repr__(self) -> str:
        return "<glim.Addition %s>" % self.path


def finite(name, value, counts=(), expected="a number"):
    """A finite number, or a list of as many as one of `counts` says."""
    numbers = _numbers(name, value if counts else [value], counts or (1,), expected)
    if isinstance(value, (bool, str)) or not all(map(math.isfinite, numbers)):
        raise unusable(name, value, expected if isinstance(value, (bool, str)) else "finite numbers")
    return numbers if counts else numbers[0]


def columns_of(name, value):
    """A 4x4 matrix, rows first, as the 16 numbers of glTF, columns first."""
    rows = _rows(name, value, [(4, 4)], "a 4x4 matrix")
    if not all(math.isfinite(number) for row in rows for number in row) or rows[3] != [0, 0, 0, 1]:
        raise unusable(name, value, "a 4x4 matrix of finite numbers whose last row is 0 0 0 1")
    return [rows[row][column] for column in range(4) for row in range(4)]
