"""What the machine has: drivers, libraries, and the environment that the bundle's programs run in."""

import glob
import json
import os
import platform
import re
import shutil
import subprocess
import zipfile

ICD_FOLDERS = ("/etc/vulkan/icd.d", "/usr/local/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/usr/share/vulkan/icd.d",
               os.path.expanduser("~/.local/share/vulkan/icd.d"))
LIBRARY_FOLDERS = ("/usr/lib/x86_64-linux-gnu", "/lib/x86_64-linux-gnu", "/usr/lib64", "/usr/lib", "/usr/local/nvidia/lib64",
                   "/usr/local/lib", "/usr/local/cuda/compat")
ASKED_OF_NVIDIA = ("name", "driver_version", "memory.total", "clocks.max.sm", "pcie.link.gen.current", "pcie.link.width.current")
NVIDIA_DRIVERS = ("libGLX_nvidia.so.0", "libEGL_nvidia.so.0")


def first_line(path):
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            return file.readline().strip()
    except OSError:
        return None


def said_by(*words):
    try:
        return subprocess.run(words, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=5, check=False).stdout.strip()
    except (OSError, subprocess.TimeoutExpired):
        return None


def describe_machine():
    release = {}
    for line in said_by("cat", "/etc/os-release").splitlines():
        name, _, value = line.partition("=")
        release[name] = value.strip('"')
    processors = re.findall(r"^model name\s*: (.*)", said_by("cat", "/proc/cpuinfo"), re.MULTILINE)
    return {"system": release.get("PRETTY_NAME", platform.platform()), "kernel": platform.release(), "libc": " ".join(platform.libc_ver()),
            "python": platform.python_version(), "processors": os.cpu_count(),
            "processor": processors[0] if processors else platform.machine(),
            "nvidia": first_line("/proc/driver/nvidia/version"),
            "nvidia-smi": said_by("nvidia-smi", "--query-gpu=" + ",".join(ASKED_OF_NVIDIA), "--format=csv,noheader")}


def find_icds():
    return sorted(file for folder in ICD_FOLDERS for file in glob.glob(os.path.join(folder, "*.json")))


def find_library(name):
    folders = [*filter(None, os.environ.get("LD_LIBRARY_PATH", "").split(":")), *LIBRARY_FOLDERS]
    return next((os.path.join(folder, name) for folder in folders if os.path.exists(os.path.join(folder, name))), None)


def choose_drivers(driver, folder):
    """What VK_DRIVER_FILES should hold, or None to leave the choice to the loader; and a sentence on it. An NVIDIA driver without a
    description, as in containers that pass on the driver alone, gets one."""
    if driver:
        return os.path.abspath(driver), "given"
    for name in ("VK_DRIVER_FILES", "VK_ICD_FILENAMES"):
        if os.environ.get(name):
            return os.environ[name], "by " + name
    found, nvidia = find_icds(), next(filter(None, map(find_library, NVIDIA_DRIVERS)), None)
    if nvidia is None or any("nvidia" in os.path.basename(file) for file in found):
        return None, "found: " + (", ".join(found) or "none")
    path = os.path.join(folder, "nvidia_icd.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump({"file_format_version": "1.0.0", "ICD": {"library_path": nvidia, "api_version": "1.3.0"}}, file)
    return ":".join([path, *found]), "written, for " + nvidia


def version_of(path):
    return tuple(map(int, re.findall(r"\d+", os.path.basename(path).partition(".so.")[2])))


def machine_has(name, carried):
    """Whether the machine has the library, no older than the bundle's."""
    path = find_library(name)
    return path is not None and version_of(os.path.realpath(path)) >= version_of(carried)


def unpack_programs(bundle, folder):
    """The bundle's programs and libraries, where they can be executed. Returns the folder that has them."""
    programs = os.path.join(folder, "programs")
    shutil.rmtree(programs, ignore_errors=True)
    with zipfile.ZipFile(os.path.join(bundle, "programs.zip")) as archive:
        archive.extractall(programs)
    for program in glob.glob(os.path.join(programs, "bin", "*")):
        os.chmod(program, 0o755)
    return programs


def environment_for(bundle, programs, folder, drivers, layer):
    """Libraries of the bundle first, but for the compiler's own where the machine has newer ones; caches in `folder`."""
    fallback = os.path.join(folder, "lib")
    shutil.rmtree(fallback, ignore_errors=True)
    os.makedirs(fallback)
    for path in glob.glob(os.path.join(programs, "fallback", "*")):
        name = re.sub(r"(\.so\.\d+).*", r"\1", os.path.basename(path))
        if not machine_has(name, path):
            os.symlink(os.path.abspath(path), os.path.join(fallback, name))
    libraries = [os.path.join(programs, "lib"), fallback, *filter(None, [os.environ.get("LD_LIBRARY_PATH")])]
    environment = {**os.environ, "LD_LIBRARY_PATH": ":".join(libraries),
                   "GLIM_TEST_DATA": os.path.join(bundle, "tests"), **caches_in(os.path.join(folder, "cache"))}
    if drivers:
        environment.update(VK_DRIVER_FILES=drivers, VK_ICD_FILENAMES=drivers)
    if layer:
        environment["VK_LAYER_PATH"] = os.path.join(programs, "layer")
    return environment


def caches_in(folder):
    """Where glim and drivers keep compiled kernels: Mesa's and NVIDIA's."""
    return {"GLIM_CACHE_DIR": folder, "MESA_SHADER_CACHE_DIR": folder, "__GL_SHADER_DISK_CACHE_PATH": folder, "__GL_SHADER_DISK_CACHE": "1"}
