"""glim renders glTF scenes by Vulkan, with the bits of its command line, and says how wrong the pictures are.

    film = glim.render("scene.glb", spp=256, size=(640, 480))
    film.rgb         # (480, 640, 3) float32, linear Rec.709 radiance in W/(sr m^2)
    film.error.rmse  # estimated RMSE, as a share of the picture's mean radiance
    film.save("scene.exr")
"""

import contextlib
import io
import json
import logging
import math
import os
import sys
import tempfile
import threading
import time
import warnings
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterable, Iterator, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy

from glim._additions import Light, Plane, written
from glim._camera import Camera
from glim._elements import Addition, Elements, FileCamera, Image, Material, Node, PunctualLight, SceneFile, columns_of
from glim._errors import DeviceError, GlimWarning, InputError, library_missing, unusable
from glim._options import additions_of, in_python, path_of, values_of
from glim._own_files import OwnFile, texels_of
from glim._version import __version__

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from glim._render_options import RenderOptions

__all__ = ["Addition", "Camera", "DeviceError", "Error", "Film", "GlimWarning", "InputError", "Light", "Plane", "Scene", "__version__",
           "devices", "load", "look_at", "merge", "read", "render"]

Path = Union[str, "os.PathLike[str]"]
Progress = Callable[[int, int, float], Any]

_log = logging.getLogger("glim")
_heard = threading.local()  # what the C++ side has said during a call of this thread


def _native():
    """The C++ side, which needs Vulkan's loader: hence not before something is rendered or read."""
    try:
        from glim import _glim
    except ImportError as error:
        if "libvulkan" in str(error):
            raise library_missing(error) from error
        raise
    if not _native.listens:
        _glim.listen(_hear)
        _native.listens = True
    return _glim


_native.listens = False


def _warn(warning):
    """Names the line that called glim."""
    level, frame = 1, sys._getframe()
    while frame.f_back and frame.f_code.co_filename in (__file__, contextlib.__file__):
        level, frame = level + 1, frame.f_back
    warnings.warn(warning, stacklevel=level)


def _hear(message, is_warning):
    if getattr(_heard, "messages", None) is not None:
        _heard.messages.append((message, is_warning))


def _in_python(message):
    is_option = message.place and message.place.startswith("--")
    place = in_python(message.place) if is_option else message.place
    return type(message)(in_python(str(message)), message.id, message.file, place, message.value, message.expected)


@contextlib.contextmanager
def _call():
    """Around a call of the C++ side: its messages become warnings and lines of the log "glim", its errors name keyword arguments."""
    outer, _heard.messages = getattr(_heard, "messages", None), []  # `progress` may call, too
    try:
        yield _native()
    except (InputError, DeviceError) as error:
        raise _in_python(error) from None
    finally:
        messages, _heard.messages = _heard.messages, outer
        for message, is_warning in messages:
            if is_warning:
                _warn(_in_python(message))
            else:
                _log.info(in_python(str(message)))


class Error(NamedTuple):
    """The estimated error of a film against the truth, from its own blocks of samples, with 95 % intervals. Biases (clamp_indirect) are
    not in it. host/measure/error_estimate.hpp says how it is estimated."""

    rmse: float  #: root of the mean square error, as a share of the picture's mean radiance
    rmse_low: float
    rmse_high: float
    rel_mse: float  #: mean of (x - truth)^2 / (truth^2 + .01 mean^2)
    rel_mse_low: Optional[float]  #: None of a denoised picture
    rel_mse_high: Optional[float]
    mse: float  #: (W/(sr m^2))^2, mean over pixels and channels
    mean: float  #: mean radiance over pixels and channels, W/(sr m^2)
    is_of_few: bool  #: half of the MSE is in fewer than ten pixels, so that the intervals are unreliable


def _stops(exposure):
    try:
        stops = float(exposure)
    except (TypeError, ValueError, OverflowError):
        stops = math.nan
    if isinstance(exposure, (bool, str, bytes)) or not -100 <= stops <= 100:
        raise unusable("exposure", exposure, "stops from -100 to 100, or \"auto\"",
                       "out-of-range" if isinstance(exposure, (int, float)) and not isinstance(exposure, bool) else "wrong-type")
    return stops


def _native_film(film, what):
    if not isinstance(film, Film):
        raise unusable(what, film, "a glim.Film")
    return film._native


class Film:
    """A picture, what it shows, and what is known of its error. It never changes. The layers are views into it without a copy, read-only
    and with gaps between their pixels: what needs dense arrays, as torch does, gets them by numpy.ascontiguousarray(film.rgb)."""

    exact: Optional[bool] = None  #: of a merged film: whether it has the bits of a single render

    def __init__(self, native, again=None):
        self._native, self._again = native, again

    @property
    def width(self) -> int:
        return self._native.width

    @property
    def height(self) -> int:
        return self._native.height

    @property
    def rgb(self):
        """(height, width, 3) float32: mean radiance, linear Rec.709, W/(sr m^2). Row 0 is at the top."""
        return self._native.rgb

    @property
    def alpha(self):
        """(height, width) float32: the share of samples that met a surface."""
        return self._native.alpha

    @property
    def composite(self):
        """(height, width, 4) float32: of scenes with shadow catchers the picture without them but with their shadows, premultiplied RGBA;
        None of other scenes. rgb and alpha are those of the picture with the catchers."""
        return self._native.composite

    @property
    def alpha_rmse(self) -> Optional[float]:
        """The RMSE of the shadows' alpha in `composite`, estimated; None if it is not known."""
        return self._native.alpha_rmse

    @property
    def lights(self) -> Dict[str, Any]:
        """Of a film rendered with light_group=...: for each group of lights a (height, width, 3) float32 of its light. Together they are
        rgb, up to rounding. A copy."""
        return self._native.lights

    def light_covariance(self, group: str, other: str):
        """(height, width, 3) float32: the covariance of the light of two groups, or the variance of one; as `variance`. A copy."""
        return self._native.light_covariance(self._group(group), self._group(other))

    def regroup(self, factors: Optional[Dict[str, Any]] = None, **more: Any) -> "Film":
        """The film with the light of each group times a factor, a number or R, G, B; of groups that are not named 1. The error of any
        such film is known, as that of a render with these lights. It has no groups, and is neither resumed nor merged."""
        weights = []
        for name, factor in {**(factors or {}), **more}.items():
            self._group(name)
            rgb = [float(value) for value in numpy.broadcast_to(numpy.asarray(factor, dtype=float), (3,))]
            if not all(0 <= value < float("inf") for value in rgb):
                raise InputError("light group %r: its factor is %r, expected a number or R, G, B, finite and 0 or more." % (name, factor),
                                 "out-of-range", place=name, value=str(factor))
            weights.append((name, rgb))
        return Film(self._native.regroup(weights))

    def _group(self, name):
        groups = self._native.light_groups
        if name not in groups:
            raise InputError("the film has no light group %r; expected %s." % (name, " or ".join(map(repr, groups)) if groups else
                                                                        "a film rendered with light_group=..."), "unknown-name", place=name)
        return groups.index(name)

    def mix(self):
        """In a notebook: the picture above a slider for each light group (needs ipywidgets). The widget's `film` is what it shows."""
        import ipywidgets
        picture = ipywidgets.Image(format="png")
        box = ipywidgets.VBox([picture])
        sliders = {name: ipywidgets.FloatSlider(1.0, min=0.0, max=4.0, step=0.05, description=name) for name in self._native.light_groups}

        def show(_=None):
            box.film = self.regroup({name: slider.value for name, slider in sliders.items()})
            picture.value = box.film._repr_png_()
        for slider in sliders.values():
            slider.observe(show, "value")
        box.children = [picture, *sliders.values()]
        show()
        return box

    @property
    def albedo(self):
        """(height, width, 3) float32: mean base colour at the camera rays' hits; a miss counts as 0."""
        return self._native.albedo

    @property
    def normal(self):
        """(height, width, 3) float32: mean shading normal, world axes, towards the camera; a miss counts as 0."""
        return self._native.normal

    @property
    def depth(self):
        """(height, width) float32: nearest hit, metres along the view axis (of a fisheye and of 360 degrees: from the camera); infinite where
        all samples missed."""
        return self._native.depth

    @property
    def count(self):
        """(height, width) uint32: samples."""
        return self._native.count

    @property
    def variance(self):
        """(height, width, 3) float32: variance of rgb, from the means of blocks of samples; NaN where there are fewer than two blocks.
        A copy."""
        return self._native.variance

    @property
    def ids(self) -> Optional[Dict[str, Any]]:
        """Of a film rendered with ids=True: for "node", "mesh" and "material" a (height, width) uint32 of indices in the scene's file, of
        what covers most of the pixel; 4294967295 where that is nothing, or nothing of the file. Else None."""
        return self._native.ids

    @property
    def surfaces(self) -> Optional[Dict[str, Any]]:
        """Of a film rendered with surfaces=True, else None: what the ray through the centre of each pixel meets first. float32 arrays
        (height, width, ...): "position" (3: world, metres), "uv" (2), "distance" (metres along the ray); with flow=SECONDS
        "forward_flow" and "backward_flow" (2: pixels, right and down, to that much later and earlier). NaN where there is none, infinite
        distances where nothing is met. "instance": uint32, the place in `names`; 4294967295 of nothing."""
        return self._native.surfaces

    @property
    def objects(self) -> Optional[Dict[str, Any]]:
        """Of a film rendered with objects=True, else None: instances with boxes, pixels and visible shares, and COCO's images, categories
        and annotations with masks. host/render/seen_instances.hpp says what each member is."""
        return json.loads(self._native.objects) if self._native.objects else None

    @property
    def names(self) -> Optional[List[str]]:
        """Of a film rendered with objects=True: the names of the instances, by surfaces["instance"]."""
        return [instance["name"] for instance in self.objects["instances"]] if self._native.objects else None

    @property
    def boxes(self) -> Optional[Dict[str, Tuple[int, int, int, int]]]:
        """Of a film rendered with objects=True: column, row, width and height of each instance that is seen, by its name."""
        if not self._native.objects:
            return None
        return {instance["name"]: tuple(instance["bbox"]) for instance in self.objects["instances"] if instance["bbox"]}

    @property
    def crop(self) -> Optional[Tuple[int, int, int, int]]:
        """Column, row, width and height in the whole picture, if it was rendered with crop=..."""
        known = json.loads(self._native.camera) if self._native.camera else {}
        return tuple(known["crop"]) if "crop" in known else None

    @property
    def error(self) -> Optional[Error]:
        """The estimated error, or None if no pixel has two blocks of samples (65 samples or more)."""
        estimate = self._native.estimate
        return Error(*estimate) if estimate else None

    @property
    def denoised(self):
        """(height, width, 3) float32: the denoised picture of a film that was rendered with denoise=True, else None. W/(sr m^2). A copy."""
        return self._native.denoised

    @property
    def denoised_error(self) -> Optional[Error]:
        """The measured error of the denoised picture, its bias included, or None without one. rel_mse is relative to the noisy radiance,
        not to the true one, and has no interval."""
        measured = self._native.measured
        return Error(*measured) if measured else None

    @property
    def samples(self) -> List[Tuple[int, int]]:
        """Indices of its samples, [begin, end)."""
        return self._native.samples

    @property
    def complete(self) -> bool:
        """Whether no sample of these is missing: a render that was stopped leaves some out."""
        return self._native.complete

    @property
    def seconds(self) -> float:
        """Time spent sampling, also by earlier runs."""
        return self._native.seconds

    @property
    def device(self) -> str:
        return self._native.device

    @property
    def settings(self) -> str:
        """The options that decide a sample, as in "seed=0 bounces=64 sampler=sobol"."""
        return self._native.settings

    @property
    def camera(self) -> Optional[Camera]:
        """The camera, with the K and the pose that it had, or None of films of earlier versions. Scene.render(camera=film.camera,
        size=(film.width, film.height)) draws the same view, unless it is orthographic."""
        return Camera._of_film(self._native.camera)[0]

    @property
    def time(self) -> Optional[float]:
        """Seconds of the file's animation; None in its rest pose."""
        return Camera._of_film(self._native.camera)[1]

    @property
    def digest(self) -> str:
        """SHA-256 of what makes the film. Equal digests are equal bits."""
        return self._native.digest

    @property
    def pixels_digest(self) -> str:
        """SHA-256 of the pixels alone. Films with the same bits have the same one, whatever kernels and device made them."""
        return self._native.pixels_digest

    def resume(self, progress: Optional[Progress] = None, **options: "Unpack[RenderOptions]") -> "Film":
        """Renders more samples, as in film.resume(spp=1024), and returns the film of all, with the bits of one render. Options are those
        of the film but for the ones that are given. For films that this process has rendered; Scene.render(resume=film) takes others."""
        if self._again is None:
            raise InputError("the film was not rendered here; expected Scene.render(resume=film)", "unsupported",
                             expected="Scene.render(resume=film)")
        scene, before = self._again
        return scene.render(progress=progress, resume=self, **{**before, **options})

    def save(self, path: Path, *, exposure: Union[float, str] = 0.0, tone: str = "none", half: bool = False) -> None:
        """Writes an EXR with all layers (.exr), which glim.read and `glim merge` read, or with half=True one of RGBA, albedo and normal as
        half floats, and depth, which they do not; an sRGB picture (.png, .jpg, .jpeg or .webp); or the
        arrays of `arrays()` for numpy.load (.npz). A picture's exposure is in stops or "auto", its tone mapping "none", "neutral" or "agx".
        PNG and WebP have alpha if environment_background was off or the scene has shadow catchers."""
        name = path_of(path, "path")
        stops = None if isinstance(exposure, str) and exposure == "auto" else _stops(exposure)
        if not isinstance(tone, str):
            raise unusable("tone", tone, "none, neutral or agx")
        ending = os.path.splitext(name)[1].lower()
        with _call() as native:
            if ending in (".png", ".jpg", ".jpeg", ".webp"):
                self._native.save_picture(name, stops, tone, None)
            elif ending == ".exr":
                (self._native.save_layers if half else self._native.save)(name)
            elif ending == ".npz":
                content = io.BytesIO()
                numpy.savez(content, **self.arrays())
                native.write_file(name, content.getvalue())
            else:
                raise InputError("%s: cannot be written: its name does not end in .exr, .npz, .png, .jpg, .jpeg or .webp." % name,
                                 "unknown-format", file=name, expected=".exr, .npz, .png, .jpg, .jpeg or .webp")

    def arrays(self) -> Dict[str, Any]:
        """Dense copies of all layers, by name: rgb, alpha, albedo, normal, depth, count and variance, as the properties describe them;
        composite, denoised, lights.NAME, ids.node, ids.mesh and ids.material, and those of `surfaces`, if the film has them; of its camera K (3x3, pixel corners at whole numbers) and pose
        (4x4, camera to world, glTF's axes)."""
        layers = {name: getattr(self, name) for name in ("rgb", "alpha", "albedo", "normal", "depth", "count", "variance", "composite",
                                                    "denoised")}
        layers.update({"lights." + name: values for name, values in self.lights.items()})
        layers.update(self.surfaces or {})
        layers.update({"ids." + name: values for name, values in (self.ids or {}).items()})
        camera = self.camera
        if camera is not None:
            layers.update(K=camera.K("corner"), pose=camera.pose("gltf"))
        return {name: numpy.array(values) for name, values in layers.items() if values is not None}

    def __reduce__(self):
        """Pickled as its EXR: a copy has all but ids, surfaces, objects and denoised, and is resumed by Scene.render(resume=film)."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "film.exr")
            self._native.save(path)
            with open(path, "rb") as file:
                return _of_bytes, (file.read(),)

    def _repr_png_(self) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "film.png")
            self._native.save_picture(path, 0.0, "none", 1024)
            with open(path, "rb") as file:
                return file.read()

    def __repr__(self) -> str:
        count = sum(end - begin for begin, end in self.samples)
        error = self.error
        known = ", estimated RMSE %.3g %% of the mean [%.3g, %.3g]" % tuple(100 * value for value in error[:3]) if error else ""
        return "<glim.Film %dx%d, %d samples per pixel%s%s>" % (self.width, self.height, count, "" if self.complete else " at most", known)


def _of_bytes(exr):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "film.exr")
        with open(path, "wb") as file:
            file.write(exr)
        return read(path)


class Scene:
    """A scene that stays on the device. It is read when it is first rendered, and again when one of its files has changed."""

    def __init__(self, path: Path, **options: "Unpack[RenderOptions]"):
        self.path = path
        path_of(path, "scene")
        self._read_files = {}  # by path
        self._own_files, self._map = [], None
        self._options = self._original = self._resolved(options)
        values_of(self._options)
        self._native = None
        self._lock = threading.Lock()
        self._last = None

    @property
    def last_film(self) -> Optional[Film]:
        """The film of the last render, also if Ctrl-C or `progress` has stopped it. None if there is none."""
        return self._film(*self._last) if self._last else None

    @property
    def nodes(self) -> Elements[Node]:
        """Of the scene's own file, by index or name: scene.nodes["chair"].visible = False. What is set holds for the renders that follow;
        the file stays as it is."""
        return self._file().nodes

    @property
    def materials(self) -> Elements[Material]:
        return self._file().materials

    @property
    def images(self) -> Elements[Image]:
        """Textures' pixels, of the scene's own file: scene.images["wood"].replace(pixels). Materials name theirs (Material.images)."""
        return self._file().images

    @property
    def lights(self) -> Elements[PunctualLight]:
        """Point, spot and directional lights of the scene's own file."""
        return self._file().lights

    @property
    def cameras(self) -> Elements[FileCamera]:
        return self._file().cameras

    @property
    def edits(self) -> Dict[str, Any]:
        """What was set, by pointers of the glTF object model. A copy."""
        edits = self._options.get("set") or {}
        if not isinstance(edits, dict):
            raise InputError("set: cannot use %r with Scene.set, expected a dict of pointers and values" % (edits,), "wrong-type",
                             place="set", value=repr(edits), expected="a dict of pointers and values")
        return dict(edits)

    def set(self, pointer: str, value) -> None:
        """Sets a value of the scene for the renders that follow; the file stays as it is.

        pointer: of the glTF object model, as in "/materials/paint/pbrMetallicRoughness/baseColorFactor". The name of an element may
            replace its index.
        value: a number, a sequence of numbers, a bool or a text. None undoes the change.
        Films that were rendered with different changes cannot be merged."""
        edits = self.edits
        edits.pop(pointer, None)
        options = {**self._options, "set": edits if value is None else {**edits, pointer: value}}
        values_of(options)
        self._options = options

    def add(self, thing: Union[Path, Light, Plane], matrix: Any = None) -> Addition:
        """Adds another file's shapes and lights, a glim.Light or a glim.Plane. A file can be added several times.

        matrix: 4x4, of the added file to world, metres.
        The scene is read anew at its next render: what moves then is better moved by the nodes of what this returns."""
        columns = columns_of("matrix", numpy.eye(4) if matrix is None else matrix)
        if isinstance(thing, (Light, Plane)):
            self._own_files.append(OwnFile(type(thing).__name__.lower() + ".gltf"))
            path = os.fspath(self._own_files[-1])
            with open(path, "wb") as file:
                file.write(written(thing))
        else:
            path = os.path.abspath(path_of(thing, "thing"))
        before = additions_of(self._options.get("add"))
        while any(other == path or other.startswith(path + "@") for other in before):
            # Another spelling, by which edits tell one from the other.
            path = os.path.join(os.path.dirname(path), ".", os.path.basename(path))
        added = Addition(self, path, path + "#")
        added.names("/nodes")  # refuses what is no glTF file
        options = {**self._options, "add": [*before, "%s@%s" % (path, ",".join(map(repr, columns)))]}
        values_of(options)
        self._options = options
        return added

    def reset(self) -> None:
        """Undoes all edits and additions since the scene was loaded."""
        self._options = self._original

    def render(self, *, resume: Optional[Film] = None, ids: bool = False, surfaces: bool = False, flow: Optional[float] = None,
               objects: bool = False, progress: Optional[Progress] = None, **options: "Unpack[RenderOptions]") -> Film:
        """Renders a picture.

        resume: a film of the same picture with fewer samples, to go on from; with denoise=True one that was rendered with it, which keeps
            the halves of its samples but not in files or copies.
        ids, surfaces, objects: whether these of the film are to be known, which traces camera rays again.
        flow: seconds between the pictures of film.surfaces' flow; needs at=, the time of the animation.
        progress: called several times a second with samples so far and in all, over all pixels, and seconds. What it raises ends the
            render, as Ctrl-C does: the film so far is last_film, and the exception's `film`.
        options: those of `glim render --help-all`, with underscores: spp=256, size=(640, 480), camera="top", **look_at(...), seed=1,
            target_rmse=.01 (a share of the mean), environment="sky.hdr" or an array of (height, width, 3), device="llvmpipe". They come on
            top of those of the scene.

        Other threads may run meanwhile; one picture is rendered at a time. Raises InputError and DeviceError."""
        asked = {**self._options, **self._resolved(options)}
        before = None if resume is None else _native_film(resume, "resume")
        wanted = self._wanted(asked, bool(ids), bool(surfaces), bool(objects), flow)
        if progress is not None and not callable(progress):
            raise unusable("progress", progress, "a function")
        with self._rendering(asked) as (scene, values):
            try:
                rendered = scene.render(values, before, _native().Wanted(*wanted), progress)
            except (InputError, DeviceError):
                raise
            except BaseException as stop:
                stop.film = self._keep(asked, scene.last_film)
                raise
            return self._keep(asked, rendered)

    def render_many(self, *, at: Optional[Iterable[float]] = None, turntable: Optional[int] = None,
                    cameras: Optional[Iterable[Union[Camera, FileCamera, str, int, Dict[str, Any]]]] = None, ids: bool = False,
                    surfaces: bool = False, flow: Optional[float] = None, objects: bool = False,
                    progress: Optional[Callable[[float, int, float], Any]] = None, **options: "Unpack[RenderOptions]") -> Iterator[Film]:
        """Renders one picture after another, each when it is asked for: for film in scene.render_many(turntable=36, spp=64). Edits hold for
        the pictures that follow them.

        at: seconds of the file's animation.
        turntable: how many pictures from a circle around the scene, counter-clockwise seen from above.
        cameras: glim.Camera, names or indices of cameras of the file, or dicts of options, as look_at returns them.
        progress: called several times a second with pictures so far, which need not be whole, pictures in all, and seconds. What it raises
            ends the render.
        ids, surfaces, objects, flow, options: as of render."""
        lists = {"at": at, "turntable": turntable, "cameras": cameras}
        given = [name for name, value in lists.items() if value is not None]
        if len(given) != 1:
            raise InputError("render_many: cannot use %s, expected one of at, turntable and cameras" % (" and ".join(given) or "none"),
                             "conflict" if given else "missing", expected="one of at, turntable and cameras")
        if progress is not None and not callable(progress):
            raise unusable("progress", progress, "a function")
        options = self._resolved(options)
        if turntable is None:
            name = given[0]
            if isinstance(lists[name], (str, bytes, dict)) or not isinstance(lists[name], Iterable):
                raise unusable(name, lists[name], "a sequence")
            pictures = [one if isinstance(one, dict) else {name.rstrip("s"): one} for one in lists[name]]
        else:
            pictures = self._turntable(turntable, options)
        for picture in pictures:
            values_of({**options, **picture})
        return self._render_each(pictures, progress, {**options, "ids": ids, "surfaces": surfaces, "flow": flow, "objects": objects})

    @staticmethod
    def _wanted(asked, ids, surfaces, objects, flow):
        if flow is None:
            return ids, surfaces, objects, None
        if isinstance(flow, bool) or not isinstance(flow, (int, float)) or not 1e-9 <= flow <= 1e6:
            raise unusable("flow", flow, "seconds, 1e-9 to 1e6", "out-of-range")
        if not surfaces or asked.get("at") is None:
            raise InputError("flow: needs surfaces=True and at=SECONDS", "requires", place="flow", value=repr(flow),
                             expected="surfaces=True and at=SECONDS")
        return ids, surfaces, objects, float(flow)

    def _file(self):
        """Its own; not kept, since it refers to the scene: a cycle would keep the device."""
        return SceneFile(self, os.path.abspath(path_of(self.path, "scene")))

    @contextlib.contextmanager
    def _reading(self, path):
        """What edits can change in a file, read again if it has changed."""
        try:
            status = os.stat(path)
            stamp = (status.st_mtime_ns, status.st_size)
        except OSError:
            stamp = None
        read, before = self._read_files.get(path, (None, None))
        with _call() as native:
            if read is None or stamp != before:
                read = native.EditableFile(os.fsencode(path))
                self._read_files[path] = read, stamp
            yield read

    def _turntable(self, count, options):
        asked = {**self._options, **options, "turntable": count}
        with self._rendering(asked) as (scene, values):
            poses = scene.turntable(values)
        return [{"camera": "framed", "look_from": tuple(origin), "look_at": tuple(target), "look_up": tuple(up)}
                for origin, target, up in poses]

    def _render_each(self, pictures, progress, options):
        begin = time.monotonic()

        def tell(done, total, _seconds):
            progress(index + done / total, len(pictures), time.monotonic() - begin)
        for index, picture in enumerate(pictures):
            yield self.render(progress=progress and tell, **{**options, **picture})

    def _resolved(self, options):
        """Options with names of files in place of arrays."""
        texels = texels_of(options.get("environment"))
        if texels is None:
            return options
        if self._map is None or not numpy.array_equal(self._map[0], texels):
            self._map = (texels, OwnFile("environment.exr"))
            with _call() as native:
                native.write_map(os.fspath(self._map[1]), texels)
        return {**options, "environment": self._map[1]}

    @contextlib.contextmanager
    def _rendering(self, asked):
        """The native scene and the values of these options."""
        values = {"file": os.fsencode(path_of(self.path, "scene")), **values_of(asked)}
        if getattr(_heard, "messages", None) is not None:
            raise RuntimeError("glim: `progress` cannot render, as one picture is rendered at a time")
        with self._lock, _call() as native:
            self._native = self._native or native.Scene()
            yield self._native, values

    def _keep(self, asked, rendered):
        self._last = (rendered, asked) if rendered else None  # not the Film, which refers to the scene
        return self.last_film

    def _film(self, rendered, asked):
        return Film(rendered, (self, asked))

    def __repr__(self) -> str:
        return "<glim.Scene %s>" % path_of(self.path, "scene")


def load(scene: Path, **options: "Unpack[RenderOptions]") -> Scene:
    """A scene for many pictures. options: defaults of its Scene.render."""
    return Scene(scene, **options)


def render(scene: Path, *, resume: Optional[Film] = None, ids: bool = False, surfaces: bool = False, flow: Optional[float] = None,
           objects: bool = False, progress: Optional[Progress] = None, **options: "Unpack[RenderOptions]") -> Film:
    """Renders one picture of a scene. The arguments are those of Scene.render."""
    return Scene(scene).render(resume=resume, ids=ids, surfaces=surfaces, flow=flow, objects=objects, progress=progress, **options)


def look_at(origin: Sequence[float], target: Sequence[float], up: Sequence[float] = (0, 1, 0), zoom: float = 1.0) -> Dict[str, Any]:
    """Options of a camera at `origin` that sees `target` in the middle of the picture: scene.render(**glim.look_at((0, 1, 3), (0, 1, 0))).
    World coordinates, metres. zoom: magnification of the scene's own camera."""
    return {"look_from": _point("origin", origin), "look_at": _point("target", target), "look_up": _point("up", up), "zoom": zoom}


def _point(name, value):
    try:
        return tuple(value)
    except TypeError:
        raise unusable(name, value, "three numbers") from None


def read(path: Path) -> Film:
    """A film that glim has written."""
    name = path_of(path, "path")
    with _call() as native:
        return Film(native.read(name))


def merge(films: Iterable[Film]) -> Film:
    """One film of films of the same picture with different samples, or of adjacent rows. `exact` says whether it has the bits of a single
    render; else it equals one up to rounding."""
    if isinstance(films, (str, bytes)) or not isinstance(films, Iterable):
        raise unusable("films", films, "a sequence of glim.Film")
    natives = [_native_film(film, "films") for film in films]
    with _call() as native:
        merged, exact = native.merge(natives)
        film = Film(merged)
        film.exact = exact
        return film


def devices() -> List[Dict[str, Any]]:
    """Vulkan's devices, the one that is used by default first: name, driver, kind, memory in bytes, usable, missing."""
    with _call() as native:
        return native.devices()
