"""What tools/farm does."""

import asyncio
import functools
import os
import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)  # while there is nothing to clean up
sys.dont_write_bytecode = True  # beside the sources it would look like a change to build
sys.path[0] = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))

from conversion.errors import ConversionError  # noqa: E402
from render_farm.arguments import parse_arguments  # noqa: E402
from render_farm.environment import DASHBOARD, ENVIRONMENT, JOBQUEUE  # noqa: E402
from render_farm.errors import FarmError, stop_signals  # noqa: E402
from render_farm.progress import Progress  # noqa: E402
from render_farm.security import check_network  # noqa: E402


async def render(picture, done, options, progress, stopped):
    from render_farm.cluster import connect
    from render_farm.driver import Driver
    driver = Driver(picture, done, options, progress, stopped)
    async with connect(options, driver.count_left) as client:
        await driver.run(client)


def place(options, devices, say):
    """One worker on each of the devices. What the driver renders itself is rendered on the first one."""
    options.devices = [str(device["index"]) for device in devices]
    options.local = len(devices)
    options.job["device"] = options.devices[0]
    for device in devices:
        say("a worker on device %d, %s" % (device["index"], device["name"]))


def farm(options, progress):
    """Returns the exit code."""
    from render_farm.animation import Animation
    from render_farm.bands import Bands
    from render_farm.driver import until_signal
    from render_farm.glim import Glim, find_glim
    from render_farm.job_folder import JobFolder, check_place
    from render_farm.picture import Picture
    for path in filter(None, (options.output, options.png)):
        check_place(path)
    glim = Glim(find_glim(), os.getcwd())
    if options.devices:
        place(options, glim.devices(options.devices), progress.say)
    kind = Animation if options.frames else Bands if options.bands else Picture
    picture = kind(options, glim, JobFolder(options.output), progress.say)
    done = picture.open()
    if not picture.finished:
        stopped = asyncio.run(until_signal(functools.partial(render, picture, done, options, progress)))
        if stopped is not None:
            progress.say("stopped; the same command goes on from %s" % picture.folder.path)
            return 128 + stopped
    print(picture.close(), flush=True)
    return 0


def stop(number, _frame):
    sys.exit(128 + number)


def main():
    options, progress = parse_arguments(sys.argv[1:]), Progress()
    for number in stop_signals():
        signal.signal(number, stop)
    try:
        is_safe = check_network(options)
        ENVIRONMENT.enter(progress.say)
        if not is_safe:
            progress.say("WARNING: without TLS anyone who reaches the scheduler can run programs on this machine and on the workers")
        if options.dashboard:
            progress.say("WARNING: Dask's dashboard asks for no password; every user of this machine can look at it")
            ENVIRONMENT.add(DASHBOARD, progress.say)
        if options.slurm:
            ENVIRONMENT.add(JOBQUEUE, progress.say)
        sys.exit(farm(options, progress))
    except FarmError as error:
        progress.say(str(error))
        sys.exit(error.code)
    except (ConversionError, OSError) as error:
        progress.say(str(error) if getattr(error, "filename", None) is None else "%s: %s" % (error.filename, error.strerror))
        sys.exit(1)


if __name__ == "__main__":
    main()
