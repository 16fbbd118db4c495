#!/usr/bin/env python3
"""Checks glim against an independent renderer: both render the same scene on the same machine. --help says what is printed."""

import sys
import tempfile

sys.dont_write_bytecode = True  # beside the sources it would look like a change to build

from mitsuba_check.arguments import parse_arguments  # noqa: E402
from mitsuba_check.errors import CheckError  # noqa: E402


def say(text):
    print("against_mitsuba.py: %s" % text, file=sys.stderr)


def check(options):
    # Only now: --help and a refusal need neither NumPy nor Mitsuba.
    from mitsuba_check.renderers import Glim, Mitsuba, Renders, build_glim, import_mitsuba
    import_mitsuba()
    from mitsuba_check.report import collect, to_json, to_table, warn_of_size
    from mitsuba_check.scene import read_scene, require_light, size_of
    scene = read_scene(options.scene)
    if options.environment is None:
        require_light(scene, ": name an --environment")
    options.size = options.size or size_of(scene, 128)
    warning = warn_of_size(*scene.bounds())
    if warning:
        say(warning)
    mitsuba, renders = Mitsuba(scene, options), (Renders(), Renders())
    say(mitsuba.explanation)
    with tempfile.TemporaryDirectory(prefix="glim-against-mitsuba-") as folder:
        glim = Glim(options, folder, build_glim())
        for seed in range(options.seeds):
            # By turns, so that a change of the machine's speed affects both.
            glim.add_render(seed, renders[0])
            mitsuba.add_render(seed, renders[1])
            say("%d of %d renders of each" % (seed + 1, options.seeds))
    found = collect(options, glim, mitsuba, renders)
    print(to_json(found) if options.json else to_table(found))


def main():
    options = parse_arguments()
    try:
        check(options)
    except (CheckError, OSError) as error:
        sys.exit("against_mitsuba.py: %s" % error)
    except ModuleNotFoundError as error:
        sys.exit("against_mitsuba.py: %s; run 'pip install numpy'" % error)
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
