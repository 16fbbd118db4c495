"""The command line of tools/farm."""

import argparse
import os
import re

from render_farm.film_error import FilmError

MOST_LOCAL = 1000  # workers; each is three processes
PAGE = 256  # samples: a render is the left fold of such pages (host/render/merge_films.hpp)

DESCRIPTION = """Renders one picture, or the frames of an animation, by many workers. The result has the bits of one render on one machine,
whatever dies meanwhile: the same command goes on. Options that are not listed here are those of `glim render`, such as --size 1920x1080."""
EPILOG = """\
Parts of the picture wait in OUT.exr.farm, which is removed when the picture is there. tools/farm.md says more.
Exit codes: 0 done, 1 bad input or a worker's failure, 2 usage, 3 device, 129, 130 or 143 stopped by
SIGHUP, SIGINT or SIGTERM."""

SPLITS = "the farm hands out samples itself; expected --spp"
STOPS = "the farm hands out whole pages of samples; expected --spp, and --target-rmse or --target-relmse to stop before"
KEEPS = "the farm keeps what is rendered in OUT.exr.farm, and the same command goes on"
ONE = "the farm renders one picture or --frames"
ONLY_FILMS = "the farm writes films and their PNGs only"
MERGES = "the farm merges films, and merged films do not know the two halves of their samples"
REFUSED = {
    "--samples": SPLITS, "--time": STOPS, "--adaptive": STOPS,
    "--checkpoint": KEEPS, "--resume": KEEPS, "--on-checkpoint": KEEPS, "--turntable": ONE, "--cameras": ONE,
    "--rows": "the farm cuts the picture itself; expected --bands", "--denoise": MERGES, "--denoised": MERGES, "--oidn": MERGES,
    "--stats": ONLY_FILMS, "--rates": ONLY_FILMS, "--layers": ONLY_FILMS, "--ids": ONLY_FILMS, "--surfaces": ONLY_FILMS,
    "--objects": ONLY_FILMS, "--movie": ONLY_FILMS, "--suspects": ONLY_FILMS, "--replay": ONLY_FILMS,
    "--progress": "the farm has a progress of its own",
}


def whole(text):
    if not re.fullmatch("[0-9]+", text) or not 1 <= int(text) <= 1 << 31:
        raise argparse.ArgumentTypeError("cannot use '%s', expected a whole number from 1 to 2147483648" % text)
    return int(text)


def bands(text):
    if not re.fullmatch("[0-9]{1,4}", text) or not 1 <= int(text) <= 1000:
        raise argparse.ArgumentTypeError("cannot use '%s', expected a whole number from 1 to 1000" % text)
    return int(text)


def devices(text):
    """"all", or indices of `glim devices`."""
    if text == "all":
        return text
    if not re.fullmatch("[0-9]{1,3}(,[0-9]{1,3})*", text) or text.count(",") >= MOST_LOCAL:
        raise argparse.ArgumentTypeError("cannot use '%s', expected all, or indices of `glim devices`, as in 0,1" % text)
    return [int(index) for index in text.split(",")]


def frames(text):
    match = re.fullmatch("([0-9]{1,9}):([0-9]{1,9})", text)
    if not match or int(match[1]) > int(match[2]):
        raise argparse.ArgumentTypeError("cannot use '%s', expected A:B, the first and the last frame" % text)
    return int(match[1]), int(match[2])


def bounds(text):
    match = re.fullmatch("([0-9]{1,6}):([0-9]{1,6})", text)
    if not match or not int(match[1]) <= int(match[2]) != 0:
        raise argparse.ArgumentTypeError("cannot use '%s', expected A:B, the fewest and the most workers" % text)
    return int(match[1]), int(match[2])


def walltime(text):
    """Seconds of Slurm's M, M:SS, H:MM:SS, D-H, D-H:MM or D-H:MM:SS, or 0."""
    days, dash, rest = text.rpartition("-")
    if not re.fullmatch(r"[0-9]{1,6}(:[0-9]{1,2}){0,2}", rest) or not re.fullmatch("[0-9]{1,4}" if dash else "", days):
        return 0
    numbers = [int(number) for number in rest.split(":")]
    first = 3600 if dash or len(numbers) == 3 else 60
    return int(days or 0) * 86400 + sum(number * unit for number, unit in zip(numbers, (first, first // 60, 1)))


def slurm(text):
    """Returns the `directives` of a job, and its `seconds`."""
    options = [word.partition("=") for word in text.split()]
    seconds = sum(walltime(value) for name, _, value in options if name == "time")
    if not all(re.fullmatch("[a-z][a-z-]*", name) for name, _, _ in options) or not seconds:
        raise argparse.ArgumentTypeError("cannot use '%s', expected options of sbatch as in 'partition=gpu gres=gpu:1 time=1:00:00', "
                                         "the time among them" % text)
    return argparse.Namespace(directives=["--" + "".join(option) for option in options], seconds=seconds)


def number(text, most, what):
    value = float(text) if re.fullmatch(r"[0-9]*\.?[0-9]+(e-?[0-9]{1,2})?", text) else 0.0
    if not 0 < value <= most:
        raise argparse.ArgumentTypeError("cannot use '%s', expected %s" % (text, what))
    return value


def exposure(text):
    """As it is: glim reads it, but only when all is rendered."""
    is_number = re.fullmatch(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)(e[+-]?[0-9]{1,2})?", text)
    if text != "auto" and not (is_number and abs(float(text)) <= 100):
        raise argparse.ArgumentTypeError("cannot use '%s', expected stops from -100 to 100, or auto" % text)
    return text


def share(text):
    what = "more than 0 and at most 1000 percent of the mean, as in 1%"
    if not text.endswith("%"):
        raise argparse.ArgumentTypeError("cannot use '%s', expected %s" % (text, what))
    return number(text[:-1], 1000, what) / 100


def error(text):
    return number(text, 1e6, "a number above 0")


def make_parser():
    parser = argparse.ArgumentParser(prog="tools/farm", usage="tools/farm SCENE -o OUT.exr --spp N [OPTIONS]", description=DESCRIPTION,
                                     epilog=EPILOG, allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("-o", "--output", metavar="OUT.exr", required=True, help="the film; with --frames a name with ####")
    add("--png", metavar="P.png", help="also write an sRGB picture")
    add("--exposure", metavar="EV", type=exposure, default="0", help="exposure of the PNG in stops [0]")
    add("--spp", metavar="N", type=whole, required=True, help="samples per pixel, at most with a target")
    add("--target-rmse", metavar="P%", type=share, help="stop when the estimated RMSE is this share of the mean, as in 1%%")
    add("--target-relmse", metavar="E", type=error, help="stop when the estimated relMSE is at most this")
    add("--bands", metavar="N", type=bands, help="cut the picture into N bands of rows, one task each, not into pages of samples")
    add("--frames", metavar="A:B", type=frames, help="frames A to B of the animation, one task each")
    add("--fps", metavar="F", help="frames per second [24]")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--local", metavar="N", type=whole, default=1, help="worker processes on this machine [1]")
    where.add_argument("--devices", metavar="all|A,B", type=devices,
                       help="one worker for each device of this machine, or for those of `glim devices` with these indices")
    where.add_argument("--slurm", metavar="'NAME=VALUE ...'", type=slurm, help="jobs of Slurm with these options of sbatch, time among them")
    where.add_argument("--scheduler", metavar="ADDRESS", help="use the workers of this scheduler of Dask, as in tls://head:8786")
    add("--workers", metavar="A:B", type=bounds, help="with --slurm: at least A workers, and at most B [0:40]")
    for name, what in (("ca", "authority"), ("cert", "own certificate"), ("key", "own key")):
        add("--tls-" + name, metavar="FILE.pem", help="TLS: the %s" % what)
    add("--insecure", action="store_true", help="with --scheduler: allow one without TLS")
    add("--dashboard", action="store_true", help="open Dask's dashboard on this machine; it asks nobody for a password")
    add("--any-device", action="store_true", help="mix devices that round differently: equal up to rounding")
    return parser


def parse_arguments(arguments):
    """Returns the options, among them `scene`, and `job`: the file and what `glim render` is asked for, by name. Exits with code 2."""
    parser = make_parser()
    if not arguments or arguments[0] in ("-h", "--help"):
        parser.parse_args(arguments)
    if arguments[0].startswith("-"):
        parser.error("the first argument is %s, expected the scene" % arguments[0])
    options, others = parser.parse_known_args(arguments[1:])
    options.scene = os.path.abspath(arguments[0])
    options.job = {"file": options.scene, **options_of(parser, others)}
    has_target = options.target_rmse or options.target_relmse
    options.target = FilmError(options.target_relmse, options.target_rmse) if has_target else None
    refuse_others(parser, options.job)
    refuse_combinations(parser, options)
    options.output = os.path.realpath(options.output)
    options.png = options.png and os.path.abspath(options.png)
    return options


def options_of(parser, words):
    """["--size", "96x96", "--seed=3", "--confine"] -> {"size": "96x96", "seed": "3", "confine": True}"""
    options, words = {}, list(words)
    while words:
        name, joined, value = words.pop(0).partition("=")
        if not re.fullmatch("--[a-z][a-z-]*", name) or name == "--file":
            parser.error("%s: expected an option, as in --size 1920x1080" % name)
        if not joined:
            value = words.pop(0) if words and not words[0].startswith("--") else True
        if name in ("--add", "--set"):  # those that may be repeated
            options.setdefault(name[2:], []).append(value)
        elif name[2:] in options:
            parser.error("%s: is given twice" % name)
        else:
            options[name[2:]] = value
    return options


def refuse_others(parser, job):
    for name, why in REFUSED.items():
        if name[2:] in job:
            parser.error("%s: %s" % (name, why))
    if job.get("camera") == "all":
        parser.error("--camera all: %s" % ONE)


def refuse_combinations(parser, options):
    for option, path, end in (("-o", options.output, ".exr"), ("--png", options.png, ".png")):
        if path is not None and not path.lower().endswith(end):
            parser.error("%s %s: expected a name that ends in %s" % (option, path, end))
        if path is not None and ("#" in os.path.basename(path)) != (options.frames is not None):
            parser.error("%s %s: expected --frames and a name with ####, or neither" % (option, path))
    if options.frames and options.target:
        parser.error("--target-rmse and --target-relmse: expected one picture, not --frames")
    if options.bands and (options.frames or options.target):
        parser.error("--bands: expected neither --frames nor a target; the error is known of whole pictures only")
    if "focus" in options.job and options.any_device:
        parser.error("--focus: devices that round differently may find different distances; expected --focal-distance")
    if options.fps is not None and options.frames is None:
        parser.error("--fps: expected --frames as well")
    if options.workers and not options.slurm:
        parser.error("--workers: expected --slurm as well; --local takes a number of workers")
    options.workers = options.workers or (0, 40)
    if options.insecure and not options.scheduler:
        parser.error("--insecure: expected --scheduler as well; workers that the farm starts always have TLS")
    if options.devices and "device" in options.job:
        parser.error("--devices: expected no --device, since each worker has its own")
    if options.dashboard and options.scheduler:
        parser.error("--dashboard: expected --local, --devices or --slurm; the scheduler decides on a dashboard of its own")
    if options.local > MOST_LOCAL:
        parser.error("--local %d: expected at most %d workers on one machine" % (options.local, MOST_LOCAL))
    tls = [options.tls_ca, options.tls_cert, options.tls_key]
    if any(tls) and not all(tls):
        parser.error("TLS takes --tls-ca, --tls-cert and --tls-key together")
    for path in [os.path.realpath(options.output), *filter(None, tls)] if options.slurm else []:
        if not re.fullmatch(r"[\w./+:,=@-]+", path, re.ASCII):
            parser.error("--slurm: a job's script cannot name %s; expected a path of letters, digits and . / + : , = @ - _" % path)
