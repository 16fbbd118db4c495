#!/usr/bin/env python3
"""The laboratory for shaders (tests/laboratory.md), in copies of the project: laboratory_test.py NewTest | LaboratoryTest

NewTest: what tools/new makes and what it refuses, without a build. LaboratoryTest: each kind of new test is built and passes; then
tools/test --watch runs one again after each save."""

import os
import queue
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
KINDS = {"kernel": "", "lobe": "shaders/lib/bsdf/%s.glsl", "light": "shaders/lib/%s.glsl"}
GOES_ON = 600  # s; a build on a machine that does much else


def list_files(folder):
    return {os.path.relpath(os.path.join(path, name), folder) for path, _, names in os.walk(folder) for name in names}


class Project(unittest.TestCase):
    """A copy of the project in a folder whose name has a space."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = os.path.join(folder.name, "a copy")
        ignore = shutil.ignore_patterns("build", "build-*", ".git", "__pycache__", "golden", "corpus")
        shutil.copytree(ROOT, cls.root, ignore=ignore)
        # Without what tools/test --ci asks of its own tests; debug compiles fastest.
        cls.environment = {name: value for name, value in os.environ.items() if not name.startswith("GLIM_")} | {"GLIM_PRESET": "debug"}

    def path(self, name):
        return os.path.join(self.root, name)

    def read(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return file.read()

    def write(self, name, text):
        """As editors do that replace files."""
        with open(self.path(".saved"), "w", encoding="utf-8") as file:
            file.write(text)
        os.rename(self.path(".saved"), self.path(name))

    def run_tool(self, *words):
        return subprocess.run([self.path("tools/" + words[0]), *words[1:]], env=self.environment, stdin=subprocess.DEVNULL, text=True,
                              capture_output=True, timeout=3 * GOES_ON, check=False)

    def make(self, kind, name):
        """Runs tools/new, and returns the files it has made."""
        before = list_files(self.root)
        result = self.run_tool("new", kind, name)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return sorted(list_files(self.root) - before)


class NewTest(Project):
    def test_each_kind_makes_files_that_compile(self):
        for kind, shader in KINDS.items():
            name = "new_" + kind
            files = self.make(kind, name)
            expected = ["tests/kernels/%s_test.%s" % (name, ending) for ending in ("comp", "cpp")] + ([shader % name] if shader else [])
            self.assertEqual(files, sorted(expected))
            for file in files:
                self.assertNotRegex(self.read(file), "(?i)template_?" + kind)
                self.assertLessEqual(max(map(len, self.read(file).splitlines())), 140)
            subprocess.run(["glslangValidator", "--quiet", "-V", "--target-env", "vulkan1.2", "-I" + self.path("shaders"),
                            "-I" + self.path("tests/support"), "-I" + self.path("tests"), "-o", os.devnull, self.path(expected[0])], check=True)

    def expect_refusal(self, said, *words):
        before = list_files(self.root)
        result = self.run_tool(*words)
        self.assertNotEqual(result.returncode, 0)
        self.assertEqual(result.stdout, "")
        self.assertRegex(result.stderr, said)
        self.assertEqual(list_files(self.root), before)

    def test_names_that_are_refused(self):
        for name in ("", "Sheen", "two words", "a__b", "_a", "a_", "../a", "a2"):
            self.expect_refusal("^tools/new: '%s' is no name for a test; expected small letters, [^\n]*\n$" % name, "new", "lobe", name)
        for kind, name, said in (("kernel", "warp", "tests/kernels/warp_test.comp exists"),
                                 ("kernel", "golden", "tests/renders/golden_test.cpp has GoldenTest"),
                                 ("lobe", "bsdf_sample", "shaders/lib/bsdf/bsdf_sample.glsl exists"),
                                 ("lobe", "disk", "shaders/lib/warp.glsl has sampleDisk"),
                                 ("light", "guide", "shaders/lib/guide.glsl exists|tests/kernels/guide_test.comp exists")):
            self.expect_refusal("^tools/new: (%s); expected a name that is new\n$" % said, "new", kind, name)
        self.expect_refusal("invalid choice: 'camera'", "new", "camera", "pinhole")

    def test_nothing_is_half_written(self):
        os.rename(self.path("shaders/lib/bsdf"), self.path("bsdf"))
        self.addCleanup(os.rename, self.path("bsdf"), self.path("shaders/lib/bsdf"))
        self.expect_refusal("^tools/new: cannot write shaders/lib/bsdf/half.glsl: No such file or directory\n$", "new", "lobe", "half")

    def test_what_cannot_be_watched_is_refused(self):
        self.expect_refusal("^tools/test: --watch: tests/kernels has no test 'NoSuchTest', expected a suite's or a file's name", "test",
                            "--watch", "NoSuchTest")
        self.expect_refusal("^tools/test: --watch: expected the name of a test of a kernel", "test", "--watch")
        self.expect_refusal("^tools/test: --watch: tests/kernels/accumulate_test.cpp has no kernel of its own, ", "test", "--watch",
                            "accumulate_test")
        self.expect_refusal("^tools/test: --watch: runs one test alone", "test", "--quick", "--watch", "WarpTest")


class LaboratoryTest(Project):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        used = set()  # by what all tests share
        for name in os.listdir(os.path.join(cls.root, "tests/support")):
            with open(os.path.join(cls.root, "tests/support", name), encoding="utf-8") as file:
                used.update(re.findall(r"test_kernels::(\w+)", file.read()))
        folder = os.path.join(cls.root, "tests/kernels")
        for name in os.listdir(folder):  # which would be compiled as well
            if not name.startswith("template_") and name.removesuffix(".comp") not in used:
                os.unlink(os.path.join(folder, name))

    def expect(self, pattern):
        """Waits for a line that matches from the tool that watches. Returns the seconds that took, and all it has said."""
        start, said = time.monotonic(), ""
        while True:
            try:
                line = self.said.get(timeout=GOES_ON)
            except queue.Empty:
                line = ""
            self.assertNotEqual(line, "", "no line matches %s:\n%s" % (pattern, said))
            said += line
            if re.search(pattern, line):
                return time.monotonic() - start, said

    def read_lines(self, file):
        with file:
            for line in file:
                self.said.put(line)
        self.said.put("")

    def start_watching(self, name):
        self.said = queue.Queue()
        self.watch = subprocess.Popen([self.path("tools/test"), "--watch", name], env=self.environment, stdin=subprocess.DEVNULL,
                                      stdout=subprocess.PIPE, text=True)
        self.addCleanup(self.watch.wait)
        self.addCleanup(self.watch.terminate)
        threading.Thread(target=self.read_lines, args=(self.watch.stdout,), daemon=True).start()

    def test_new_tests_pass_and_are_watched(self):
        for kind in KINDS:
            self.make(kind, "new_" + kind)
        for kind in KINDS:
            result = self.run_tool("test", "--filter", "New%sTest" % kind.capitalize())
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            self.assertRegex(result.stdout, "100% tests passed, 0 tests failed out of 1")

        self.start_watching("NewLobeTest")
        self.expect("^glim: new_lobe_test.cpp passes")
        shader, kernel, source = "shaders/lib/bsdf/new_lobe.glsl", "tests/kernels/new_lobe_test.comp", "tests/kernels/new_lobe_test.cpp"
        good = {name: self.read(name) for name in (shader, kernel, source)}
        line = good[shader][:good[shader].index("vec3 mirrorNewLobe")].count("\n") + 1

        self.write(shader, good[shader].replace("vec3 mirrorNewLobe(vec3 wo)", "vec3 mirrorNewLobe(vec4 no such)"))
        self.expect("^%s:%d: error: " % (shader, line))
        self.expect("^glim: new_lobe_test.comp does not compile$")
        self.write(shader, good[shader])
        seconds, _ = self.expect("^glim: new_lobe_test.cpp passes")
        print("%.2f s from a saved shader to the result of its test" % seconds)

        self.write(shader, good[shader].replace("return albedo * (", "return 2.0 * albedo * ("))
        _, said = self.expect("^glim: new_lobe_test.cpp fails")
        self.assertRegex(said, r"(?m)^tests/kernels/new_lobe_test.cpp:\d+: Failure$")
        with open(self.path(shader), "w", encoding="utf-8") as file:  # as other editors do
            file.write(good[shader])
        self.expect("^glim: new_lobe_test.cpp passes")

        self.write(kernel, good[kernel].replace("EXPECT_NEAR(dot(s.wi, s.wi), 1.0", "EXPECT_NEAR(dot(s.wi, s.wi), 2.0"))
        _, said = self.expect("^glim: new_lobe_test.cpp fails")
        self.assertRegex(said, r"(?m)^tests/kernels/new_lobe_test.comp:\d+: Failure$")
        self.write(kernel, good[kernel])
        self.expect("^glim: new_lobe_test.cpp passes")

        self.write(source, good[source].replace("EXPECT_NEAR(density, 1.0", "EXPECT_NEAR(density, 2.0"))
        self.expect("^glim: new_lobe_test.cpp fails")
        self.write(source, good[source])
        self.expect("^glim: new_lobe_test.cpp passes")

        self.write("shaders/lib/bsdf/new_neighbour.glsl", "")
        with self.assertRaises(queue.Empty):
            self.said.get(timeout=2)
        self.watch.send_signal(signal.SIGINT)
        self.assertEqual(self.watch.wait(GOES_ON), 130)
        self.assertEqual([name for name in os.listdir(self.path("build-debug")) if name.startswith("watch.")], [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], defaultTest=sys.argv[1:2])
