"""The command line of tools/against_mitsuba.py."""

import argparse
import os
import re

MIN_SEEDS = 8

DESCRIPTION = "Renders a scene with glim and with Mitsuba 3 on this machine, and says whether they agree and which is faster."
EPILOG = """\
Both take the same number of samples and bounces, and otherwise their defaults: glim's Sobol' points and Russian roulette,
Mitsuba's independent points and Russian roulette ('path'); neither choice changes the mean. The ratio of the means has a
95 % interval from the renders' scatter; z-tests of the means and of 8x8 blocks say whether it is noise, which is near enough
to normal only at many samples where there are caustics. relMSE is of one render, from the scatter alone, with
eps = .01 mean^2; time to equal error is relMSE times the median of seconds, Mitsuba's over glim's. Seconds are of
rendering; starting, loading and compiling are apart.
Mitsuba has no light that shines from both sides of a triangle: two sheets stand for it, of which Mitsuba's light sampling
tries one in vain. It has no Schlick's Fresnel, no spot with glTF's falloff and no material of glTF either: they are classes in
Python here, the material with the formulas that glim has and albedos of its own, by the quadrature of tests/oracle.
Coverage is Mitsuba's 'mask' under 'volpath'; maps, smooth glass and Lambert surfaces are its own. Where solids meet, where
something else or the camera is in one that absorbs, and for unlit surfaces, its parts make an integrator. Dispersion is refused.
Mitsuba: in any Python, pip install mitsuba numpy; then run this with that Python. For its fast variant llvm_ad_rgb also
apt-get install libllvm19 (LLVM 14, 15 and 16 fail); without, scalar_rgb is taken, which is slower.
Exit codes: 0 done, 1 bad input or a program that failed, 2 usage."""


class Parser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(2, "%s: %s; --help lists the options\n" % (self.prog, message))


def whole(least):
    def parse(text):
        if not text.isdecimal() or int(text) < least:
            raise argparse.ArgumentTypeError("%s: expected a whole number from %d" % (text, least))
        return int(text)
    return parse


def size(text):
    found = re.fullmatch(r"([1-9]\d{0,4})x([1-9]\d{0,4})", text)
    if not found:
        raise argparse.ArgumentTypeError("%s: expected WIDTHxHEIGHT" % text)
    return int(found[1]), int(found[2])


def environment(text):
    if os.path.isfile(text):
        return text
    if not re.fullmatch(r"\d*\.?\d+(,\d*\.?\d+){2}", text):
        raise argparse.ArgumentTypeError("%s: expected a map or R,G,B, each from 0" % text)
    return [float(part) for part in text.split(",")]


def parse_arguments(arguments=None):
    parser = Parser(prog="tools/against_mitsuba.py", description=DESCRIPTION, epilog=EPILOG, allow_abbrev=False,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", metavar="SCENE.gltf", help="of triangles and spheres, as those in scenes/")
    parser.add_argument("--size", type=size, metavar="WxH", help="pixels [128 high, width from the camera's aspect ratio]")
    parser.add_argument("--spp", type=whole(1), default=64, metavar="N", help="samples per pixel of each render [64]")
    parser.add_argument("--seeds", type=whole(MIN_SEEDS), default=MIN_SEEDS, metavar="N",
                        help="independent renders of each, at least %d [%d]" % (MIN_SEEDS, MIN_SEEDS))
    parser.add_argument("--bounces", type=whole(0), default=64, metavar="N",
                        help="most surface events between camera and light [64]")
    parser.add_argument("--environment", type=environment, metavar="E",
                        help=".hdr or .exr map, or constant radiance R,G,B, from everywhere [the file's]")
    parser.add_argument("--json", action="store_true", help="print JSON instead of a table")
    return parser.parse_args(arguments)
