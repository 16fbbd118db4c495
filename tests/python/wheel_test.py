"""The wheel that tools/package makes: what is in it, and what it does where nothing but it is installed.

Usage: wheel_test.py GLIM"""

import base64
import glob
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
import zipfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
GLIM = os.path.abspath(sys.argv.pop())
CORNELL = os.path.join(ROOT, "scenes", "cornell.gltf")
# Beside what the wheel brings: Vulkan's loader, what its drivers on Linux need too, and what every Linux with Python has.
OF_THE_SYSTEM = {"libvulkan.so.1", "libX11.so.6", "libz.so.1", "libstdc++.so.6", "libgcc_s.so.1", "libc.so.6", "libm.so.6", "libdl.so.2",
                 "libpthread.so.0", "ld-linux-x86-64.so.2"}


def run(command, **environment):
    return subprocess.run(command, env={**os.environ, **environment}, text=True, capture_output=True, check=False)


class WheelTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory(prefix="glim-wheel-")
        cls.addClassCleanup(scratch.cleanup)
        cls.scratch = scratch.name
        cls.make()
        cls.wheel, = glob.glob(cls.path("*.whl"))
        cls.package = cls.path("installed")
        subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target", cls.package, cls.wheel], check=True)
        with zipfile.ZipFile(cls.wheel) as file:
            cls.files = {entry.filename: entry for entry in file.infolist()}
            cls.content = {name: file.read(name) for name in cls.files}
        cls.info, = (name[:-len("/RECORD")] for name in cls.files if name.endswith(".dist-info/RECORD"))
        cls.libraries = {name.split("/")[1] for name in cls.files if name.startswith("glim.libs/")}

    @classmethod
    def path(cls, name):
        return os.path.join(cls.scratch, name)

    @classmethod
    def make(cls):
        subprocess.run([sys.executable, "-B", os.path.join(ROOT, "tools", "make_wheel.py"), os.path.dirname(GLIM), cls.scratch], check=True,
                       stdout=subprocess.DEVNULL)

    def notices(self):
        """Of each package, by its name."""
        start = self.info + "/licenses/"
        return {name[len(start):]: self.content[name].decode() for name in self.files if name.startswith(start)}

    def test_name_and_size(self):
        minor = int(os.confstr("CS_GNU_LIBC_VERSION").split(".")[1])
        name = re.fullmatch(r"glim-[0-9.]+-cp310-abi3-manylinux_2_(\d+)_x86_64\.whl", os.path.basename(self.wheel))
        self.assertTrue(name, self.wheel)
        self.assertLessEqual(int(name.group(1)), minor)
        self.assertLess(os.path.getsize(self.wheel), 30e6)

    def test_record(self):
        lines = [line.rsplit(",", 2) for line in self.content[self.info + "/RECORD"].decode().splitlines()]
        self.assertEqual(sorted(name for name, _, _ in lines), sorted(self.files))
        for name, digest, size in lines:
            if not name.endswith("/RECORD"):
                content = self.content[name]
                expected = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
                self.assertEqual((digest, size), ("sha256=" + expected, str(len(content))), name)

    def test_has_nothing_else(self):
        modules = {"glim/" + name for name in os.listdir(os.path.join(ROOT, "python", "src", "glim")) if name.endswith((".py", ".typed"))}
        script = self.info.replace(".dist-info", ".data/scripts/glim")
        kinds = r"glim\.libs/lib[\w.-]+\.so[.\d]*|%s/(METADATA|WHEEL|RECORD|licenses/.+|sboms/[^/]+\.json)" % re.escape(self.info)
        self.assertEqual({name for name in self.files if not re.fullmatch(kinds, name)},
                         modules | {script, "glim/_version.py", "glim/_glim.abi3.so", "glim/bin/glim"})
        for name in (script, "glim/bin/glim"):
            self.assertEqual(self.files[name].external_attr >> 16 & 0o111, 0o111, name)

    def test_libraries_are_in_it(self):
        needed = set()
        for name in ("glim/bin/glim", "glim/_glim.abi3.so", *("glim.libs/" + library for library in self.libraries)):
            said = run(["readelf", "--dynamic", "--section-headers", os.path.join(self.package, name)]).stdout
            self.assertFalse(".symtab" in said, name + " is not stripped")
            needed |= set(re.findall(r"\(NEEDED\).*\[(.*)\]", said))
        self.assertEqual(needed - OF_THE_SYSTEM, self.libraries)

    def test_notices(self):
        notices = self.notices()
        for library in self.libraries:
            texts = [text for text in notices.values() if library in text.splitlines()[0]]
            self.assertEqual(len(texts), 1, library)
        with open(os.path.join(ROOT, "tools", "debian", "compiled_in"), encoding="ascii") as file:
            self.assertLessEqual({"glim", "nanobind", *file.read().split()}, set(notices))
        for name, text in notices.items():
            self.assertRegex(text, "(?i)copyright", name)
            self.assertLessEqual(set(re.findall(r"(?<=/usr/share/)common-licenses/[\w.+-]*\w", text)), set(notices), name)

    def glim(self, *words, **environment):
        return run([sys.executable, os.path.join(self.package, "bin", "glim"), *words], PYTHONPATH=self.package, **environment)

    def test_draws_the_bits_of_the_build(self):
        options = ("render", CORNELL, "--size", "16x16", "--spp", "4", "-o")
        self.assertEqual(run([GLIM, *options, self.path("built.exr")]).returncode, 0)
        done = self.glim(*options, self.path("command.exr"))
        self.assertEqual((done.returncode, done.stdout[:len(self.path("command.exr"))]), (0, self.path("command.exr")), done.stderr)
        code = """
import glim
assert glim.__file__.startswith(%r), glim.__file__
digests = [glim.read(%r + name).pixels_digest for name in ("built.exr", "command.exr")]
digests.append(glim.render(%r, size=(16, 16), spp=4).pixels_digest)
print(len(set(digests)))
""" % (self.package, self.path(""), CORNELL)
        done = run([sys.executable, "-c", code], PYTHONPATH=self.package)
        self.assertEqual((done.stdout, done.returncode), ("1\n", 0), done.stderr)

    def test_without_a_library_of_the_system(self):
        for library in ("libvulkan.so.1", "libX11.so.6"):
            folder = self.path("without-" + library)
            os.mkdir(folder)
            with open(os.path.join(folder, library), "w", encoding="ascii") as file:
                file.write("no library")
            done = self.glim("render", CORNELL, "-o", self.path("none.png"), LD_LIBRARY_PATH=folder)
            self.assertEqual((done.returncode, done.stdout), (3, ""))
            self.assertRegex(done.stderr, r"^glim: [^\n]*%s[^\n]*: apt-get install libvulkan1 mesa-vulkan-drivers\n$" % re.escape(library))
            done = self.glim("render", CORNELL, "-o", self.path("none.png"), LD_LIBRARY_PATH=folder, GLIM_MESSAGES="json")
            message = json.loads(done.stderr)
            self.assertEqual((done.returncode, message["severity"], message["id"]), (3, "error", "library-missing"))

    def test_the_command_hands_on_what_it_gets(self):
        program = self.path("stand-in/glim/bin/glim")
        os.makedirs(os.path.dirname(program))
        with open(self.path("stand-in/glim/__init__.py"), "w", encoding="ascii") as file:
            file.write("raise ImportError('the command imports nothing of this')\n")
        with open(program, "w", encoding="ascii") as file:
            file.write('#!/bin/sh\nprintf "%s\\n" "$@"\ngrep SigIgn /proc/$$/status\nexit 4\n')
        os.chmod(program, 0o755)
        done = run([sys.executable, os.path.join(self.package, "bin", "glim"), "a b", "--c"], PYTHONPATH=self.path("stand-in"))
        self.assertEqual((done.returncode, done.stderr), (4, ""))
        self.assertEqual(done.stdout.split("\n")[:2], ["a b", "--c"])
        self.assertEqual(int(done.stdout.split()[-1], 16), 0, "signals are ignored")


if __name__ == "__main__":
    unittest.main()
