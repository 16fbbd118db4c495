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
--serve prints the address of a page on this machine instead, which renders the experiments when asked. Its random part
is for you alone: it keeps other users of the machine and other pages out.
GLIM_BINARY names another build of glim to measure instead of build/glim.
Exit codes: 0 done, 1 a scene or a run of glim failed, 2 usage, 129, 130 or 143 stopped by SIGHUP, SIGINT or SIGTERM
(no page)."""
LEAST_PORT, MOST_PORT = 1024, 65535


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
    parser.add_argument("--out", metavar="OUT", help="folder to write to, made if missing [study]")
    parser.add_argument("--quick", action="store_true", help="smaller pictures and fewer samples, for a first look")
    parser.add_argument("--serve", action="store_true", help="serve a page on 127.0.0.1 that renders what is chosen on it")
    parser.add_argument("--port", metavar="N", type=int, help="port of --serve, %d to %d [a free one]" % (LEAST_PORT, MOST_PORT))
    options = parser.parse_args(arguments)
    if options.serve and (options.out is not None or options.quick):
        parser.error("--serve: writes no study; expected neither --out nor --quick")
    if options.port is not None and not options.serve:
        parser.error("--port: expected --serve")
    if options.port is not None and not LEAST_PORT <= options.port <= MOST_PORT:
        parser.error("--port %d: expected %d to %d" % (options.port, LEAST_PORT, MOST_PORT))
    options.port = options.port or 0
    options.out = options.out if options.out is not None else "study"
    if options.scenes is not None and not os.path.isdir(options.scenes):
        parser.error("--scenes %s: expected a folder" % options.scenes)
    if not options.serve and os.path.exists(options.out) and not os.path.isdir(options.out):
        parser.error("--out %s: expected a folder" % options.out)
    options.profile = QUICK if options.quick else FULL
    options.scenes = options.scenes or default_scenes()
    return options
