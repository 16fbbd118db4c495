"""The options of a render, for editors and type checkers. Written by python/write_options.py, which a test compares."""

import os
from typing import Any, Dict, Literal, Sequence, Tuple, TypedDict, Union

from glim._camera import Camera
from glim._elements import FileCamera


class RenderOptions(TypedDict, total=False):
    """Keyword arguments of glim.load, glim.render and Scene.render; `glim render --help-all` lists them."""

    edits: Union[str, "os.PathLike[str]"]
    """Options of scene, camera, time and look from a file; those given here come first"""

    scene: int
    """Scene of the file, 0 to 4294967295 [the file's default scene]"""

    variant: str
    """Variant of the file's materials [the file's own materials]"""

    at: float
    """Time of the file's animation, 0 to 1e+09 [the file's rest pose]"""

    animation: Union[str, int]
    """Animation that is played [0]"""

    environment: Union[str, "os.PathLike[str]", Sequence[float], Any]
    """.hdr or .exr map, radiance R,G,B, studio or none [the file's, else studio if unlit]"""

    environment_rotation: float
    """Rotation of the map about the vertical axis, -360 to 360 [0]"""

    environment_strength: float
    """Multiplies the radiance of the environment, 0 to 1e+06 [1]"""

    environment_background: Union[bool, Literal["off", "on"]]
    """Whether the camera sees the environment: on or off [on]"""

    sun: Tuple[float, float, float]
    """A directional light: degrees right of -z, degrees up, W/m^2"""

    back_faces: Literal["culled", "shown"]
    """Back faces of single-sided opaque surfaces: culled or shown [culled]"""

    point_radius: float
    """Radius of points, in metres, 1e-09 to 1e+09 [by the file]"""

    line_radius: float
    """Radius of lines, in metres, 1e-09 to 1e+09 [by the file]"""

    floor: Union[str, float]
    """A floor at the height Y, in metres, or at the lowest point of the scene"""

    floor_color: Sequence[float]
    """Its colour, linear Rec.709 [0.8,0.8,0.8]"""

    floor_roughness: float
    """Its roughness; smooth below 0.03, 0 to 1 [matte]"""

    backdrop: float
    """A floor that curves up into a wall at DEG right of -z, -360 to 360 [no wall]"""

    catcher_reflections: Union[bool, Literal["off", "on"]]
    """Whether catchers reflect objects and their light: on or off [on]"""

    catcher: Union[str, Sequence[str]]
    """Material that catches shadows on transparency, as floor; repeatable"""

    light_group: Union[str, Sequence[str], Dict[str, Union[str, Sequence[str]]]]
    """Lights kept apart in the film, by name of light or material; repeatable"""

    set: Dict[str, Any]
    """Set the value at a glTF pointer, as in /materials/paint/alphaCutoff=0.5; repeatable"""

    add: Union[Dict[str, Sequence[float]], Sequence[str], str]
    """Another file's shapes and lights, moved by metres or a matrix; repeatable"""

    missing_textures: Literal["refuse", "grey"]
    """Images that cannot be read: refuse the scene, or grey in their place [refuse]"""

    max_texture: int
    """Scale larger images down to N pixels a side or less, 1 to 16384 [16384]"""

    confine: bool
    """Refuse files that the scene names outside of its folder"""

    size: Tuple[int, int]
    """Pixels, each side 1 to 65535 [512 high, width by the camera's aspect ratio]"""

    shutter: Tuple[float, float]
    """Motion blur: when the shutter opens and closes, in seconds from the frame [off]"""

    view: Literal["shaded", "normal", "depth", "albedo", "bvh-steps", "guide"]
    """Picture of: shaded, normal, depth, albedo, bvh-steps or guide [shaded]"""

    rows: Tuple[int, int]
    """Only rows BEGIN to END - 1 of the picture, for `glim merge`, 0 at the top [all]"""

    camera: Union[str, int, Camera, FileCamera]
    """Camera of the file, or framed: one that sees the whole scene, or all [0]"""

    look_from: Sequence[float]
    """Place the camera here instead, in world coordinates"""

    look_at: Sequence[float]
    """Point in the middle of the picture"""

    look_up: Sequence[float]
    """Direction that points upwards in the picture [0,1,0]"""

    fov: float
    """Vertical field of view in degrees, 0.01 to 179 [the camera's]"""

    zoom: float
    """Magnification, 1e-06 to 1e+06 [1]"""

    lens_radius: float
    """Radius of a thin lens in metres, 0 to 1e+06 [0, a pinhole]"""

    focal_distance: float
    """Distance of the plane in focus, in metres, 1e-06 to 1e+09 [none]"""

    focus: Tuple[int, int]
    """Focus on what this pixel shows, 0,0 at the upper left, instead of focal_distance"""

    pose_gltf: Sequence[float]
    """The camera's 3x4 or 4x4 matrix to world, row by row; it looks along -z, up is +y"""

    pose_opencv: Sequence[float]
    """The same of a camera with OpenCV's axes: it looks along +z, down is +y"""

    intrinsics: Sequence[float]
    """Focal lengths and principal point in pixels; the picture's corner is 0,0"""

    intrinsics_opencv: Sequence[float]
    """The same as OpenCV has them: the middle of the first pixel is 0,0"""

    distortion: Sequence[float]
    """Distortion of the lens, as OpenCV's distCoeffs"""

    fisheye: Sequence[float]
    """A fisheye lens, as of OpenCV's cv::fisheye"""

    shift: Tuple[float, float]
    """Shift of the picture to the right and up, in units of its longer side [0,0]"""

    projection: Literal["camera", "equirectangular"]
    """camera, as the file says, or equirectangular: 360 degrees [camera]"""

    crop: Tuple[int, int, int, int]
    """Render only W x H pixels of the picture, from column X and row Y on [all]"""

    spp: int
    """Samples per pixel, 1 to 2147483648 [64; 4 with a view other than shaded]"""

    samples: Tuple[int, int]
    """Sample indices BEGIN to END - 1, for `glim merge`, 0 to 2147483648 [0:64]"""

    time: Union[float, str]
    """Stop after this time, at the end of a pass, as in 90s, 5m or 1h [off]"""

    target_rmse: float
    """Stop when the estimated RMSE is this share of the picture's mean, as in 1% [off]"""

    target_relmse: float
    """Stop when the estimated relMSE is at most this, 1e-12 to 1e+06 [off]"""

    denoised: bool
    """Apply the targets to the denoised picture, made anew at each check of the error"""

    adaptive: Literal["off", "course", "course:literal", "neighbours", "neighbours:absolute"]
    """Adaptive sampling: off, neighbours or neighbours:absolute [off]"""

    seed: int
    """Seed of the random numbers, 0 to 4294967295 [0]"""

    sampler: Literal["sobol", "independent"]
    """sobol (Owen-scrambled) or independent [sobol; independent with adaptive course]"""

    bounces: int
    """Maximum surfaces between camera and light (0: emission alone), 0 to 1000000 [64]"""

    paths: Literal["all", "emission", "direct", "indirect"]
    """Part of the light: all, emission, direct or indirect [all]"""

    clamp_indirect: float
    """Clamp indirect light to this radiance (biased), 1e-30 to 1e+30 [off]"""

    caustics: Union[bool, Literal["off", "on", "auto"]]
    """Caustics by light paths: on, off or auto, where they have less noise [auto]"""

    guiding: Union[bool, Literal["off", "on", "auto"]]
    """Path guiding, learned before the picture: on, off or auto, where it pays [off]"""

    direct: Literal["mis", "lights", "hemisphere", "bsdf"]
    """Direct light: mis, lights, hemisphere or bsdf [mis]"""

    light_samples: int
    """Samples per light (direct lights) or per vertex (hemisphere), 1 to 65536 [1]"""

    roulette: str
    """Russian roulette: throughput, none, or fixed:P, a survival probability [throughput]"""

    tolerance: float
    """Relative error at which adaptive course stops a pixel, 1e-30 to 1e+06 [0.05]"""

    batch: int
    """Samples between convergence tests of adaptive course, 2 to 1048576 [32]"""

    max_spp: int
    """Maximum samples per pixel of adaptive course, 2 to 2147483648 [2048]"""

    device: Union[str, int]
    """Index or part of a name from `glim devices` [the first usable one]"""

    schedule: Literal["auto", "wavefront", "persistent"]
    """Kernel schedule: wavefront, persistent or auto, the faster one; same picture [auto]"""

    path_capacity: int
    """Paths in flight; same picture, 128 to 16777216 [as suits the device]"""

    accelerator: Literal["bvh", "none"]
    """Acceleration structure: bvh, or none (brute force) [bvh]"""

    split: Literal["sah", "mean", "median"]
    """Split of BVH nodes: sah, mean or median [sah]"""

    intersector: Literal["watertight", "moller-trumbore"]
    """Triangle test: watertight or moller-trumbore [watertight]"""

    exposure: Union[float, str]
    """Exposure of the picture in stops, -100 to 100 or auto; not the EXR's [0]"""

    tone: Literal["none", "neutral", "agx"]
    """Tone mapping: none, neutral or agx [none; neutral in the built-in studio]"""

    denoise: bool
    """Also write a denoised picture and its measured error; the PNG shows it"""

    no_denoise: bool
    """Leave a picture noisy that is written without its film"""

    oidn: Union[str, "os.PathLike[str]"]
    """Library of Open Image Denoise that denoises instead, or its folder [glim's own]"""
