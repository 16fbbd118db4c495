"""Cameras by their numbers: intrinsics, distortion and pose."""

import json
from typing import Any, Dict, Optional, Sequence, Tuple

from glim._errors import InputError, unusable

_AXES = ("gltf", "opencv")
_ORIGINS = ("corner", "center")


def _chosen(name, value, choices, given):
    if value not in choices:
        raise InputError("%s: cannot use %r, expected %s, since %s is given" % (name, value, " or ".join(choices), given),
                         "missing" if value is None else "unknown-name", place=name, value=None if value is None else repr(value),
                         expected=" or ".join(choices))
    return value


def _rows(name, value, shapes, expected):
    """Nested sequences or an array as lists of floats, of one of the shapes (rows, columns)."""
    try:
        rows = [[float(number) for number in row] for row in value]
    except (TypeError, ValueError):
        raise unusable(name, value, expected) from None
    if (len(rows), len(rows[0]) if rows else 0) not in shapes or any(len(row) != len(rows[0]) for row in rows):
        raise unusable(name, value, expected)
    return rows


def _numbers(name, value, counts, expected):
    try:
        numbers = [float(number) for number in (value.ravel() if hasattr(value, "ravel") else value)]
    except (TypeError, ValueError):
        raise unusable(name, value, expected) from None
    if len(numbers) not in counts:
        raise unusable(name, value, expected)
    return numbers


def _flipped(pose):
    """Of OpenCV's axes (y down, looks along +z) those of glTF (y up, looks along -z), and back."""
    return [[row[0], -row[1], -row[2], row[3]] for row in pose[:3]] + [list(pose[3])]


class Camera:
    """A camera for Scene.render(camera=...) that need not be in the scene's file.

    K, origin: 3x3 matrix of intrinsics in pixels of a picture of `size`. origin says where its pixel coordinates are 0: "corner", the upper
        left corner of the first pixel, or "center", the middle of that pixel, as OpenCV has it.
    distortion: 4, 5 or 8 numbers as OpenCV orders them: k1, k2, p1, p2, k3, k4, k5, k6. fisheye: the four of cv2.fisheye.
    pose, axes: 3x4 or 4x4 matrix, camera to world, metres. axes says which way the camera looks: "gltf", along -z with +y up, or "opencv",
        along +z with +y down. Without a pose the camera stands where the file's stands.
    shift: of the picture to the right and up, in units of its longer side.
    equirectangular: all directions; the middle of the picture is ahead.
    name: the camera of the file that it replaces.

    Raises InputError for numbers that are no camera's; the picture's size and what else must fit is checked by the render."""

    def __init__(self, K: Any = None, *, origin: Optional[str] = None, distortion: Optional[Sequence[float]] = None,
                 fisheye: Optional[Sequence[float]] = None, pose: Any = None, axes: Optional[str] = None,
                 shift: Optional[Tuple[float, float]] = None, equirectangular: bool = False, size: Optional[Tuple[int, int]] = None,
                 name: Optional[str] = None):
        self._K = self._pose = None
        if K is not None:
            K = _rows("K", K, [(3, 3)], "a 3x3 matrix")
            if K[0][1] != 0 or K[1][0] != 0 or K[2] != [0, 0, 1]:
                raise InputError("K: cannot use %r, expected [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]" % (K,), "unsupported", place="K",
                                 value=repr(K), expected="[[fx, 0, cx], [0, fy, cy], [0, 0, 1]]")
            half = 0.5 if _chosen("origin", origin, _ORIGINS, "K") == "center" else 0.0
            self._K = (K[0][0], K[1][1], K[0][2] + half, K[1][2] + half)
        if pose is not None:
            rows = _rows("pose", pose, [(3, 4), (4, 4)], "a 3x4 or 4x4 matrix")
            rows = rows if len(rows) == 4 else rows + [[0.0, 0.0, 0.0, 1.0]]
            self._pose = rows if _chosen("axes", axes, _AXES, "pose") == "gltf" else _flipped(rows)
        self.distortion = None if distortion is None else _numbers("distortion", distortion, (4, 5, 8), "4, 5 or 8 numbers")
        self.fisheye = None if fisheye is None else _numbers("fisheye", fisheye, (4,), "4 numbers")
        self.shift = None if shift is None else tuple(_numbers("shift", shift, (2,), "2 numbers"))
        self.equirectangular, self.size, self.name = bool(equirectangular), size, name

    @classmethod
    def _of_film(cls, text):
        """Of the description in a film, and its time; (None, None) if it has none."""
        if not text:
            return None, None
        known = json.loads(text)
        camera = cls(known.get("K"), origin="corner", distortion=known.get("distortion"), fisheye=known.get("fisheye"),
                     pose=known["pose"], axes="gltf", equirectangular=known["kind"] == "equirectangular")
        return camera, known.get("time")

    def K(self, origin: str):
        """3x3 list, pixels, or None if the camera has none. origin: as in the constructor."""
        _chosen("origin", origin, _ORIGINS, "K")
        if self._K is None:
            return None
        fx, fy, cx, cy = self._K
        half = 0.5 if origin == "center" else 0.0
        return [[fx, 0.0, cx - half], [0.0, fy, cy - half], [0.0, 0.0, 1.0]]

    def pose(self, axes: str):
        """4x4 list, camera to world, or None if it is the file's. axes: as in the constructor."""
        _chosen("axes", axes, _AXES, "pose")
        return None if self._pose is None else [list(row) for row in (self._pose if axes == "gltf" else _flipped(self._pose))]

    def options(self) -> Dict[str, Any]:
        """What it means as options of Scene.render."""
        options: Dict[str, Any] = {"camera": self.name, "size": self.size, "intrinsics": self._K, "distortion": self.distortion,
                                   "fisheye": self.fisheye, "shift": self.shift}
        if self._pose is not None:
            options["pose_gltf"] = [number for row in self._pose for number in row]
        if self.equirectangular:
            options["projection"] = "equirectangular"
        return {name: value for name, value in options.items() if value is not None}

    def __repr__(self) -> str:
        return "glim.Camera(%s)" % ", ".join("%s=%r" % item for item in self.options().items())
