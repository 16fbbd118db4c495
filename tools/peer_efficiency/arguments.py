"""The command line of tools/efficiency."""

import argparse
import os

from mitsuba_check.arguments import Parser, size, whole

# Fewer have no scatter to resample.
MIN_SEEDS = 3

DESCRIPTION = "Measures 1 / (relMSE x CPU seconds) of glim and of Mitsuba 3 on this machine, by turns, and prints Markdown tables."
EPILOG = """\
Each row is a scene, each table a Vulkan driver. relMSE x spp is K: the variance between seeds, relative to the square of the
mean plus .01, times the samples of a render. CPU is user and system time of all threads. A sample's is that of a render minus that of
one with a sixteenth of the samples, divided by the other samples: what does not grow with them cancels, such as starting, loading and
compiling. The first round of renders is not counted.
The ratios are such that glim is better above 1, but for that of time:
  samples     those that Mitsuba needs for the same relMSE, over glim's
  time        CPU seconds of a sample, glim's over Mitsuba's: the median of the rounds and their extremes
  efficiency  the first over the second
Square brackets after K, samples and efficiency hold 95 % of draws of seeds, rounds and tiles of 16x16 pixels.
Mitsuba gets the scenes as in tools/against_mitsuba.py, whose --help says what it needs, and which materials and lights are classes
in Python here. Both renderers have their defaults. Run this while the machine does nothing else.
Exit codes: 0 done, 1 bad input or a program that failed (the tables have the scenes before it), 2 usage."""


def existing(test, expected):
    def parse(text):
        if not test(text):
            raise argparse.ArgumentTypeError("cannot use '%s', expected %s" % (text, expected))
        return text
    return parse


def is_readable_file(path):
    return os.path.isfile(path) and os.access(path, os.R_OK)


def is_program(path):
    return os.path.isfile(path) and os.access(path, os.X_OK)


def can_be_written(path):
    folder = os.path.dirname(path) or "."
    return bool(path) and not os.path.isdir(path) and os.access(path if os.path.exists(path) else folder, os.W_OK)


def parse_arguments(arguments=None):
    parser = Parser(prog="tools/efficiency", description=DESCRIPTION, epilog=EPILOG, allow_abbrev=False,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", metavar="SCENE", nargs="+", help="glTF files with light of their own")
    parser.add_argument("--size", type=size, metavar="WxH", help="pixels [256 high, width from the camera's aspect ratio]")
    parser.add_argument("--spp", type=whole(2), default=64, metavar="N", help="samples per pixel of each render [64]")
    parser.add_argument("--seeds", type=whole(MIN_SEEDS), default=8, metavar="N",
                        help="renders by each, at least %d [8]" % MIN_SEEDS)
    parser.add_argument("--bounces", type=whole(0), default=64, metavar="N",
                        help="most surface events between camera and light [64]")
    parser.add_argument("--driver", dest="drivers", action="append", metavar="ICD.json",
                        type=existing(is_readable_file, "a Vulkan driver's ICD file"),
                        help="run glim on the Vulkan driver that this file describes; several give a table each [the system's]")
    parser.add_argument("--program", dest="programs", action="append", default=[], metavar="PATH",
                        type=existing(is_program, "another build's glim"),
                        help="measure this build of glim as well; several give a row each")
    parser.add_argument("--references", metavar="FOLDER", type=existing(os.path.isdir, "a folder"),
                        help="long renders that errors are relative to, NAME.exr or NAME_256_d12.exr (pixels and path segments) for "
                        "NAME.gltf [the mean of the renders]")
    parser.add_argument("--json", metavar="FILE", type=existing(can_be_written, "a file to write"),
                        help="write the figures as JSON, too, after each scene")
    options = parser.parse_args(arguments)
    options.drivers = [os.path.abspath(path) for path in options.drivers] if options.drivers else [None]
    return options
