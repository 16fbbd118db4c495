"""Makes the bundle: programs, their libraries, scenes, and the pictures to compare with, in one folder."""

import json
import os
import re
import shutil
import subprocess
import sys
import zipfile

from places import BITS_SIZE, BITS_SPP, GOLDEN_SIZE, ROOT, CheckError, group_words, render_words

MOST_BYTES = 64 << 20
LAYER = "VK_LAYER_KHRONOS_validation"
LAYER_FOLDER = "/usr/share/vulkan/explicit_layer.d"
# The machine's own: they fit its kernel and its drivers.
OF_THE_MACHINE = re.compile(r"(linux-vdso|ld-linux[-\w]*|libc|libm|libdl|libpthread|librt)\.so")
# A newer one of the machine is taken instead, since drivers may need it.
FALLBACKS = ("libstdc++.so.6", "libgcc_s.so.1")
# What libGLX_nvidia.so.0 needs besides. Without a display it asks libEGL.so.1; where that is missing, it says that it is no Vulkan driver.
OF_NVIDIA = ("libXext.so.6", "libEGL.so.1")


def run(*words):
    done = subprocess.run(words, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, errors="replace")
    if done.returncode != 0:
        last = done.stderr.strip().rpartition("\n")[2]
        raise CheckError("%s: exit code %d%s" % (words[0], done.returncode, last and ": " + last))
    return done.stdout


def libraries_of(program):
    """The paths of the libraries that it loads, by name."""
    found = dict(re.findall(r"^\s*(\S+) => (/\S+)", run("ldd", program), re.MULTILINE))
    return {name: path for name, path in found.items() if not OF_THE_MACHINE.match(name)}


def library_path(name):
    paths = re.findall(r"^\s*%s .*x86-64.* => (\S+)" % re.escape(name), run("/sbin/ldconfig", "-p"), re.MULTILINE)
    return paths[0] if paths else None


def newest_glibc(files):
    """The newest version of glibc that one of the files asks for."""
    versions = [(0, 0)]
    for file in files:
        versions += [tuple(map(int, v.split("."))) for v in re.findall(r"GLIBC_(\d+\.\d+)", run("objdump", "-T", file))]
    return "%d.%d" % max(versions)


def copy_program(source, target):
    shutil.copy(source, target)
    run("strip", "--strip-all", target)


def copy_libraries(folder, programs):
    libraries = {}
    for program in programs:
        libraries.update(libraries_of(program))
    for name in OF_NVIDIA:
        path = library_path(name)
        if path:
            libraries.update({name: path, **libraries_of(path)})
    for name, path in libraries.items():
        kind = "fallback" if name in FALLBACKS else "lib"
        os.makedirs(os.path.join(folder, kind), exist_ok=True)
        # With its version in its name, by which the newer of two is told.
        target = os.path.basename(os.path.realpath(path)) if kind == "fallback" else name
        copy_program(os.path.realpath(path), os.path.join(folder, kind, target))


def copy_layer(folder):
    """True if the validation layer is installed here."""
    description = os.path.join(LAYER_FOLDER, "VkLayer_khronos_validation.json")
    if not os.path.exists(description):
        return False
    with open(description, encoding="utf-8") as file:
        document = json.load(file)
    library = library_path(os.path.basename(document["layer"]["library_path"])) or document["layer"]["library_path"]
    target = os.path.join(folder, "layer")
    os.makedirs(target)
    copy_program(library, os.path.join(target, os.path.basename(library)))
    document["layer"]["library_path"] = "./" + os.path.basename(library)
    with open(os.path.join(target, "VkLayer_khronos_validation.json"), "w", encoding="utf-8") as file:
        json.dump(document, file)
    return True


def files_in(folder):
    return [os.path.join(root, name) for root, _, names in os.walk(folder) for name in sorted(names)]


def pack(folder, archive):
    """The folder as one compressed file in its place: a third of its size."""
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as file:
        for path in files_in(folder):
            file.write(path, os.path.relpath(path, folder))
    shutil.rmtree(folder)


def kernel_suites():
    """The suites of tests/kernels, those that tell most about a device first."""
    folder, suites = os.path.join(ROOT, "tests", "kernels"), set()
    for name in os.listdir(folder):
        if name.endswith("_test.cpp"):
            with open(os.path.join(folder, name), encoding="utf-8") as file:
                suites.update(re.findall(r"^TEST(?:_F|_P)?\((\w+),", file.read(), re.MULTILINE))
    first = ["DriverPrecisionTest", "ProbeArithmeticTest"]
    return first + sorted(suites.difference(first))


def golden_pictures():
    """The scene, whether 8x8 blocks are normal enough, and the samples of each, as tests/renders/golden_test.cpp has them."""
    with open(os.path.join(ROOT, "tests", "renders", "golden_test.cpp"), encoding="utf-8") as file:
        text = file.read()
    usual = int(re.search(r"kTestSamples = (\d+)", text).group(1))
    found = re.findall(r'Golden\{"(\w+)", (true|false)(?:, (\d+))?\}', text)
    return [{"scene": scene, "blocks": blocks == "true", "samples": int(samples or usual)} for scene, blocks, samples in found]


def all_scenes():
    """Those of the repository, whose films are compared bit by bit."""
    return sorted(name[:-5] for name in os.listdir(os.path.join(ROOT, "scenes")) if name.endswith(".gltf"))


def copy_data(folder, build):
    """Scenes with their images, golden pictures, and what the kernels' tests read."""
    scenes = os.path.join(folder, "scenes")
    os.makedirs(scenes)
    for name in all_scenes():
        shutil.copy(os.path.join(ROOT, "scenes", name + ".gltf"), scenes)
    for name in os.listdir(os.path.join(ROOT, "scenes")):
        if name.endswith(".hdr"):
            shutil.copy(os.path.join(ROOT, "scenes", name), scenes)
    run(sys.executable, "-B", os.path.join(ROOT, "tools", "make_scenes.py"), "--large", "terrain", "200000", "-o",
        os.path.join(scenes, "hills.glb"))
    shutil.copytree(os.path.join(ROOT, "tests", "renders", "golden"), os.path.join(folder, "golden"))
    tests = os.path.join(folder, "tests")
    os.makedirs(os.path.join(tests, "kernels"))
    for name in os.listdir(os.path.join(ROOT, "tests", "kernels")):
        if name.endswith(".comp"):
            shutil.copy(os.path.join(ROOT, "tests", "kernels", name), os.path.join(tests, "kernels"))
    os.makedirs(os.path.join(tests, "oracle"))
    for name in os.listdir(os.path.join(build, "tests", "oracle")):
        if name.endswith(".bin"):
            shutil.copy(os.path.join(build, "tests", "oracle", name), os.path.join(tests, "oracle"))


def draw_films(folder, glim):
    """The films that other devices are compared with, by the software driver here."""
    films = os.path.join(folder, "films")
    os.makedirs(films)
    for scene in all_scenes():
        path, film = os.path.join(folder, "scenes", scene + ".gltf"), os.path.join(films, scene + ".exr")
        words = render_words(glim, path, film, BITS_SIZE, BITS_SIZE)
        run(*words, "--spp", str(BITS_SPP), *group_words(scene), "--device", "llvmpipe")
    devices = json.loads(run(glim, "devices", "--json"))
    return next("%s, %s" % (d["name"], d["driver"]) for d in devices if "llvmpipe" in d["name"])


def make_bundle(folder, build, say):
    if os.path.exists(folder) and os.listdir(folder):
        raise CheckError("%s is there already and not empty; expected a new folder" % folder)
    try:
        fill_bundle(folder, build, say)
    except BaseException as error:
        shutil.rmtree(folder, ignore_errors=True)
        if isinstance(error, OSError):
            raise CheckError("%s: %s" % (error.filename, error.strerror)) from error
        raise


def fill_bundle(folder, build, say):
    glim, tests = os.path.join(build, "glim"), os.path.join(build, "tests", "glim_tests")
    programs = os.path.join(folder, "programs")
    os.makedirs(os.path.join(programs, "bin"))
    say("copying programs and libraries")
    for program in (glim, tests):
        copy_program(program, os.path.join(programs, "bin", os.path.basename(program)))
    copy_libraries(programs, (glim, tests))
    layer = copy_layer(programs)
    glibc = newest_glibc(path for kind in ("bin", "lib") for path in files_in(os.path.join(programs, kind)))
    pack(programs, os.path.join(folder, "programs.zip"))
    golden = golden_pictures()
    copy_data(folder, build)
    here = os.path.dirname(os.path.abspath(__file__))
    shutil.copytree(here, os.path.join(folder, "gpu_check"), ignore=shutil.ignore_patterns("__pycache__"))
    say("drawing the films to compare with")
    manifest = {"gpu_check": 1, "glim": run(glim, "--version").strip(), "films": draw_films(folder, glim), "golden": golden,
                "goldenSize": GOLDEN_SIZE, "kernelSuites": kernel_suites(), "layer": layer, "glibc": glibc}
    with open(os.path.join(folder, "manifest.json"), "w", encoding="utf-8") as file:
        json.dump(manifest, file, indent=1)
    size = sum(os.path.getsize(path) for path in files_in(folder))
    if size > MOST_BYTES:
        raise CheckError("%s has %d bytes; expected at most %d" % (folder, size, MOST_BYTES))
    say("%s is made: %.1f MiB, for glibc %s or newer, %s the validation layer; on the other machine, run: python3 %s/gpu_check run"
        % (folder, size / 2**20, glibc, "with" if layer else "without", os.path.basename(folder)))
