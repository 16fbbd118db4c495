#!/usr/bin/env python3
"""Every program in tools prints its help without installing, building or writing anything, on a machine that has bash and python3."""

import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
GLIM = os.path.abspath(sys.argv[1])
TOOLS = sorted(entry.name for entry in os.scandir(os.path.join(ROOT, "tools")) if entry.is_file() and os.access(entry.path, os.X_OK))
FOUND = ("bash", "cat", "dirname", "env", "find", "git", "readlink", "sed")  # what a minimal system has and a tool may use for its help
INSTALLERS = ("apt-get", "sudo", "pip", "pip3", "cmake", "ninja")


def list_files(folder):
    return sorted(os.path.join(path, name) for path, folders, names in os.walk(folder) for name in folders + names)


class HelpTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root, self.programs, self.calls = (os.path.join(folder.name, name) for name in ("root", "programs", "calls"))
        for name in ("tools", "host/cli"):
            shutil.copytree(os.path.join(ROOT, name), os.path.join(self.root, name), ignore=shutil.ignore_patterns("__pycache__"))
        os.mkdir(self.programs)
        for name in FOUND:
            os.symlink(shutil.which(name), os.path.join(self.programs, name))
        record = 'echo "$0 $*" >>%s\nexit 1\n' % self.calls
        for name in INSTALLERS:
            self.add_program(name, record)
        # Without the packages that this machine has.
        self.add_program("python3", 'case " $* " in *" -m venv "* | *" -m ensurepip "* | *" -m pip "*)\n%sesac\nexec %s -S "$@"\n'
                         % (record.replace("exit 1\n", "exit 1 ;;\n"), os.path.realpath(sys.executable)))

    def add_program(self, name, script):
        path = os.path.join(self.programs, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\n" + script)
        os.chmod(path, 0o755)

    def run_tool(self, name, *arguments):
        return subprocess.run([os.path.join(self.root, "tools", name), *arguments], cwd=self.root, stdin=subprocess.DEVNULL,
                              env={"PATH": self.programs, "HOME": self.root}, text=True, capture_output=True, timeout=60, check=False)

    def expect_help(self, name, *arguments):
        before = list_files(self.root)
        with contextlib.suppress(FileNotFoundError):
            os.remove(self.calls)
        result = self.run_tool(name, *arguments)
        with self.subTest(tool=name, arguments=arguments):
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertRegex(result.stdout, "[Uu]sage:.*" + name.removesuffix(".py"))
            self.assertLessEqual(max(map(len, result.stdout.splitlines())), 140)
            self.assertFalse(os.path.exists(self.calls))
            self.assertEqual(list_files(self.root), before)
        return result.stdout

    def test_every_tool(self):
        self.assertIn("glim", TOOLS)
        for name in TOOLS:
            self.assertEqual(self.expect_help(name, "--help"), self.expect_help(name, "-h"))

    def test_commands_of_tools(self):
        for command in ("bundle", "run"):
            self.expect_help("gpu_check", command, "--help")
        for options in (("render", "--help"), ("render", "scene.gltf", "--help-all"), ("view", "-h")):
            self.expect_help("glim", *options)

    def test_packages_of_other_kinds(self):
        result = self.run_tool("package", "rpm")
        self.assertEqual((result.returncode, result.stdout), (2, ""))
        self.assertRegex(result.stderr, "^tools/package: unknown option 'rpm'\nusage: tools/package \\[deb")

    def test_packages_are_tried_where_that_can_be(self):
        def expect(code, said, *arguments):
            result = self.run_tool("try_package", *arguments)
            self.assertEqual((result.returncode, result.stdout), (code, ""))
            self.assertRegex(result.stderr, said)
        expect(2, "^usage: tools/try_package")
        expect(1, "^glim: none.whl is not there; tools/package makes packages\n$", "none.whl")
        self.add_program("id", "echo 1000\n")
        expect(1, "^glim: tools/try_package needs root, as debootstrap and chroot do\n$", "host/cli/README.md")
        self.add_program("id", "echo 0\n")
        expect(1, "^glim: no debootstrap was found, which makes minimal systems; please install [^\n]*\n$", "host/cli/README.md")

    def test_without_python(self):
        os.remove(os.path.join(self.programs, "python3"))
        for name in ("farm", "gpu_check", "plot_bench", "study", "to_gltf"):
            result = self.run_tool(name, "--help")
            self.assertEqual((result.returncode, result.stdout), (1, ""))
            self.assertEqual(result.stderr, "glim: no python3 was found, which prints this help; please install what Debian calls python3, "
                             "then run this again\n")
            self.assertFalse(os.path.exists(self.calls))

    def test_glim_that_is_not_built_lists_the_commands_of_the_built_one(self):
        def commands(text):
            return sorted(text.split("Commands:\n")[1].split("\n\n")[0].splitlines())
        built = subprocess.run([GLIM, "--help"], text=True, capture_output=True, check=True).stdout
        self.assertEqual(commands(self.expect_help("glim", "--help")), commands(built))
        alone = self.run_tool("glim")
        self.assertEqual((alone.returncode, alone.stdout), (2, ""))
        self.assertEqual(commands(alone.stderr), commands(built))

    def test_glim_that_is_built_prints_its_own(self):
        for name in ("CMakeLists.txt", "CMakePresets.json", "python", "shaders", "tests"):
            os.symlink(os.path.join(ROOT, name), os.path.join(self.root, name))
        os.mkdir(os.path.join(self.root, "build"))
        os.symlink(GLIM, os.path.join(self.root, "build", "glim"))  # last: no link to a source is newer
        built = subprocess.run([GLIM, "render", "--help"], text=True, capture_output=True, check=True).stdout
        self.assertEqual(self.expect_help("glim", "render", "--help"), built)
        newer = os.stat(os.path.join(self.root, "build", "glim"), follow_symlinks=False).st_mtime + 10
        os.utime(os.path.join(self.root, "host", "cli", "render.cpp"), (newer, newer))
        result = self.run_tool("glim", "render", "--help")
        self.assertEqual((result.returncode, result.stdout), (0, built))
        self.assertEqual(result.stderr, "glim: the sources have changed since this glim was built\n")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
