"""The command line of tools/study."""

import argparse
import os

from .profiles import FULL, QUICK

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

DESCRIPTION = "Measures what each idea of the course's path tracer costs and what it buys, and writes one page about it."
EPILOG = """\
Writes OUT/index.html, which holds its pictures and plots and needs no network, OUT/study.json with the same numbers,
and OUT/pictures. The full study takes about 45 minutes on 2 cores without a GPU, --quick under 5. Progress goes to
stderr; at the end the headline numbers go to stdout as a Markdown table.
The course's scenes are not part of the repository; without them scenes of ours of the same make are used, and the page
says so. tools/to_gltf --course makes them of the course's .dae files.
GLIM_BINARY names another build of glim to measure instead of build/glim.
Exit codes: 0 done, 1 a scene or a run of glim failed, 2 usage, 130 or 143 stopped by SIGINT or SIGTERM (no page)."""


class Parser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(2, "%s: %s; --help lists the options\n" % (self.prog, message))


def default_scenes():
    shared = os.environ.get("GLIM_SHARED") or os.path.join(os.path.dirname(ROOT), "shared")
    return os.path.join(shared, "scenes", "seed")


def parse_arguments(arguments=None):
    parser = Parser(prog="tools/study", description=DESCRIPTION, epilog=EPILOG, allow_abbrev=False,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", metavar="DIR", help="folder with the course's scenes "
                        "[shared/scenes/seed beside the repository, or scenes/seed in $GLIM_SHARED]")
    parser.add_argument("--out", metavar="OUT", default="study", help="folder to write to, made if missing [study]")
    parser.add_argument("--quick", action="store_true", help="smaller pictures and fewer samples, for a first look")
    options = parser.parse_args(arguments)
    if options.scenes is not None and not os.path.isdir(options.scenes):
        parser.error("--scenes %s: expected a folder" % options.scenes)
    if os.path.exists(options.out) and not os.path.isdir(options.out):
        parser.error("--out %s: expected a folder" % options.out)
    options.profile = QUICK if options.quick else FULL
    options.scenes = options.scenes or default_scenes()
    return options
