#!/usr/bin/env python3
"""How different two pictures look: HDR-FLIP of a picture against a reference, 0 the same to 1 (Andersson et al., Visualizing
Errors in Rendered High Dynamic Range Images, Eurographics 2021)."""

import argparse
import os
import sys

MISSING = ("flip.py: FLIP is not installed for %s: run 'pip install flip-evaluator numpy' in a virtual environment and start this "
           "with its python" % sys.executable)


class Parser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(2, "%s: %s; --help lists the options\n" % (self.prog, message))


def parse_arguments():
    parser = Parser(prog="tools/flip.py", description=__doc__, allow_abbrev=False,
                    epilog="Seen at 67 pixels per degree, over exposures that FLIP chooses from the reference. Needs "
                    "flip-evaluator (pip). Exit codes: 0 done, 1 bad input or FLIP missing, 2 usage.")
    parser.add_argument("picture", metavar="A.exr", help="the picture")
    parser.add_argument("reference", metavar="B.exr", help="the reference, of the same size")
    arguments = parser.parse_args()
    for path in (arguments.picture, arguments.reference):
        if not path.endswith(".exr"):
            parser.error("%s: expected a name that ends in .exr" % path)
    return arguments


def read(flip, path):
    if not os.access(path, os.R_OK):
        sys.exit("flip.py: %s cannot be read" % path)
    return flip.load(path)


def main():
    arguments = parse_arguments()
    try:
        import flip_evaluator as flip
        import numpy as np
    except ImportError:
        sys.exit(MISSING)
    picture, reference = (read(flip, path) for path in (arguments.picture, arguments.reference))
    if picture.shape != reference.shape:
        sys.exit("flip.py: the pictures are %dx%d and %dx%d, expected equal sizes" % (
            picture.shape[1], picture.shape[0], reference.shape[1], reference.shape[0]))
    for path, values in ((arguments.picture, picture), (arguments.reference, reference)):
        if not np.isfinite(values).all():
            sys.exit("flip.py: %s has values that are not finite, expected none" % path)
    error, parameters = flip.evaluate(reference, picture, "HDR")[1:]
    print("FLIP %.5f   exposures 2^%.2f to 2^%.2f in %d steps" % (
        error, parameters["startExposure"], parameters["stopExposure"], parameters["numExposures"]))


if __name__ == "__main__":
    main()
