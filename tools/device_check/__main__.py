"""Checks glim on a machine that has a Vulkan driver and Python, but neither network nor packages.

bundle makes a folder of at most 64 MiB with all that glim needs. run tells what the device of the machine makes of it, in at most eight
minutes on a GPU: precision and tests of kernels, bits, golden pictures, speed. It writes result.json and table.md after each step. Its exit
code is 1 if a picture is wrong or a film has other bits than Mesa's, 2 if there is no bundle or an option is wrong, 3 if there is no
device, and else 0, whatever else fails."""

import argparse
import json
import os
import sys

from places import ROOT, CheckError


def say(text):
    print("gpu_check: %s" % text, file=sys.stderr, flush=True)


def parse_arguments():
    parser = argparse.ArgumentParser(prog="gpu_check", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    bundle = commands.add_parser("bundle", help="make the folder")
    bundle.add_argument("folder", help="where; a new folder")
    bundle.add_argument("--build", default=os.path.join(ROOT, "build"), help="where glim and glim_tests were built [build]")
    run = commands.add_parser("run", help="check a device")
    run.add_argument("bundle", nargs="?", default=os.path.dirname(os.path.dirname(os.path.abspath(__file__))), help="the folder [this one]")
    run.add_argument("-o", "--output", default="gpu_check.out", metavar="FOLDER", help="where results go [gpu_check.out]")
    run.add_argument("--device", help="index or part of a name from `glim devices` [the first usable one]")
    run.add_argument("--driver", metavar="ICD.json", help="the Vulkan driver that this file describes")
    run.add_argument("--path-capacity", type=int, metavar="N",
                     help="paths in flight, for devices with small buffers [glim's]")
    run.add_argument("--patience", type=float, default=1.0, metavar="F",
                     help="multiplies the time limit of each step, for slow devices [1]")
    run.add_argument("--steps", metavar="A,B", help="only these [all of device,kernels,bits,golden,speed,copies,validation]")
    return parser.parse_args()


def run_checks(options):
    from machine import choose_drivers, describe_machine, environment_for, unpack_programs
    from runner import Runner
    from steps import Check
    try:
        with open(os.path.join(options.bundle, "manifest.json"), encoding="utf-8") as file:
            manifest = json.load(file)
    except (OSError, ValueError) as error:
        raise CheckError("%s is no bundle: %s" % (options.bundle, error)) from error
    folder = os.path.abspath(options.output)
    os.makedirs(folder, exist_ok=True)
    drivers, how = choose_drivers(options.driver, folder)
    bundle = os.path.abspath(options.bundle)
    programs = unpack_programs(bundle, folder)
    check = Check(bundle, programs, manifest, options.device, options.path_capacity)
    runner = Runner(folder, environment_for(bundle, programs, folder, drivers, manifest["layer"]), options.patience)
    runner.results.update(machine=describe_machine(), drivers={"files": drivers, "how": how},
                          bundle={name: manifest[name] for name in ("glim", "films", "glibc")})
    # Seconds, and the largest share of them for one program: where programs run one after the other, it is smaller.
    steps = [("device", 10, 1, check.find_device), ("kernels", 60, 1 / 3, check.test_kernels), ("bits", 60, 1 / 3, check.compare_bits),
             ("golden", 60, 1 / 3, check.compare_golden), ("speed", 180, 1 / 6, check.measure_speed),
             ("copies", 40, 1 / 4, check.measure_copies)]
    if manifest["layer"]:
        steps.append(("validation", 40, 1 / 4, check.validate))
    names = [step[0] for step in steps]
    wanted = {"device", *(options.steps.split(",") if options.steps else names)}
    unknown = wanted.difference(names)
    if unknown:
        raise CheckError("--steps %s: the bundle has no such step; expected some of %s" % (",".join(sorted(unknown)), ",".join(names)))
    for name, seconds, share, function in steps:
        if name in wanted:
            say("%s, at most %g s" % (name, seconds * options.patience))
            runner.step(name, seconds, share, function)
            if name == "device" and "device" not in runner.results["steps"]["device"]:
                break
    with open(runner.path("table.md"), encoding="utf-8") as file:
        print(file.read())
    say("wrote %s" % folder)
    if "device" not in runner.results["steps"]["device"]:
        say("there is no device to check: %s" % runner.results["steps"]["device"]["state"])
        return 3
    return 1 if runner.results["wrong"] else 0


def main():
    options = parse_arguments()
    try:
        if options.command == "bundle":
            from bundle import make_bundle
            make_bundle(options.folder, options.build, say)
            return 0
        return run_checks(options)
    except CheckError as error:
        say(str(error))
        return 2


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    sys.exit(main())
