#!/usr/bin/env python3
"""The harness for tests of kernels (tests/harness), used by its example as a project outside the tree, with a copy of the files that it says
it needs and no others: it passes on the driver of the tests, on a second one (GLIM_SECOND_DRIVER) and under adverse arithmetic; mistakes
that are planted in its kernels fail where they should."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
PATIENCE = 1200  # s; a build on a machine that does much else


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


class HarnessTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.example, cls.build = (os.path.join(folder.name, name) for name in ("an example", "build"))
        cls.harness = os.path.join(folder.name, "taken", "tests", "harness")
        shutil.copytree(os.path.join(ROOT, "tests", "harness"), cls.harness, ignore=shutil.ignore_patterns("example"))
        shutil.copytree(os.path.join(ROOT, "tests", "harness", "example"), cls.example)
        for path in re.findall(r"[\w/]+\.\w+", re.sub(r"#.*", "", read(os.path.join(cls.harness, "files.cmake")))):
            target = os.path.join(folder.name, "taken", path)
            os.makedirs(os.path.dirname(target), exist_ok=True)
            shutil.copy(os.path.join(ROOT, path), target)
        cls.environment = {name: value for name, value in os.environ.items() if not name.startswith("GLIM_")}
        result = cls.run_program("cmake", "-G", "Ninja", "-S", cls.example, "-B", cls.build, "-DKERNEL_HARNESS_DIR=" + cls.harness)
        if result.returncode != 0:
            raise AssertionError(result.stdout)

    @classmethod
    def run_program(cls, *words, **environment):
        return subprocess.run(words, env={**cls.environment, **environment}, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=PATIENCE, check=False)

    def build_example(self):
        return self.run_program("cmake", "--build", self.build)

    def run_tests(self, **environment):
        built = self.build_example()
        self.assertEqual(built.returncode, 0, built.stdout)
        return self.run_program(os.path.join(self.build, "example_tests"), **environment)

    def expect_pass(self, **environment):
        result = self.run_tests(**environment)
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertRegex(result.stdout, r"\[  PASSED  \] 2 tests")

    def expect_failure(self, *said, **environment):
        result = self.run_tests(**environment)
        self.assertEqual(result.returncode, 1, result.stdout)
        for pattern in said:
            self.assertRegex(result.stdout, pattern)

    def plant(self, file, good, bad):
        """A mistake, until the test ends."""
        path = os.path.join(self.example, file)
        text = read(path)
        self.assertEqual(text.count(good), 1, "%s has '%s' once" % (file, good))
        write(path, text.replace(good, bad))
        self.addCleanup(write, path, text)

    def line_of(self, file, text):
        """What gtest says of a failure at the first line that has this text."""
        path = os.path.join(self.example, file)
        number = 1 + [text in line for line in read(path).splitlines()].index(True)
        return re.escape("%s:%d: Failure\nFailed\n" % (path, number))

    def test_passes(self):
        self.expect_pass()
        result = self.run_program("ctest", "--test-dir", self.build)
        self.assertRegex(result.stdout, "100% tests passed, 0 tests failed out of 1")

    def test_passes_on_the_second_driver(self):
        driver = os.environ.get("GLIM_SECOND_DRIVER", "none")
        if not os.path.exists(driver):
            self.skipTest("GLIM_SECOND_DRIVER is '%s', expected a driver's file; tools/test --ci fetches one" % driver)
        self.expect_pass(VK_DRIVER_FILES=driver, VK_ICD_FILENAMES=driver)
        self.expect_pass(VK_DRIVER_FILES=driver, VK_ICD_FILENAMES=driver, GLIM_DEVICE="SwiftShader")

    def test_passes_under_adverse_arithmetic(self):
        for seed in ("0", "1"):
            self.expect_pass(GLIM_ARITHMETIC="native,adverse:" + seed)

    def test_adverse_arithmetic_finds_what_leans_on_a_division(self):
        self.plant("shaders/random_number.glsl", "* 5.9604644775390625e-8", "/ 16777216.0")
        self.expect_pass()
        kernel = "tests/random_number_test.comp"
        self.expect_failure(self.line_of(kernel, "EXPECT_EQUAL"), GLIM_ARITHMETIC="native,adverse:1")

    def test_a_device_is_chosen(self):
        self.expect_pass(GLIM_DEVICE="0")
        self.expect_failure('GLIM_DEVICE=no such: no such device; there are: 0 "', GLIM_DEVICE="no such")

    def test_a_failed_check_is_at_the_line_of_the_kernel(self):
        kernel = "tests/random_number_test.comp"
        self.plant("shaders/random_number.glsl", ">> 8u)", ">> 7u)")
        self.expect_failure(self.line_of(kernel, "EXPECT_NEAR") + r"case \d+: \S+, expected 0.5 within 0.5", r"1 FAILED TEST")

    def test_a_wrong_result_fails_on_the_host(self):
        self.plant("shaders/prefix_sum.glsl", "step *= 2u", "step *= 4u")
        self.expect_failure(r"prefix_sum_test.cpp:\d+: Failure", r"1 FAILED TEST")

    def test_what_is_not_uniform_fails(self):
        self.plant("shaders/random_number.glsl", "(state >> 28u) + 4u", "28u + (state >> 28u)")
        self.expect_failure(r"cells: chi-square .* p = 0\n", "mean: mean")

    def test_a_write_beyond_a_buffer_is_noticed(self):
        kernel = "tests/prefix_sum_test.comp"
        self.plant(kernel, "results[TEST_THREAD] = sum", "results[TEST_THREAD + 1u] = sum")
        self.expect_failure(self.line_of(kernel, "kBindResults") + "the kernel has written beyond the results: 0 bytes behind their end")

    def test_a_check_that_never_runs_fails(self):
        kernel = "tests/random_number_test.comp"
        self.plant(kernel, "if (isTestThread())", "if (TEST_THREAD >= TEST_COUNT)")
        self.expect_failure(self.line_of(kernel, "EXPECT_NEAR") + "this check never ran")

    def test_threads_that_do_not_end_fail(self):
        kernel = "tests/random_number_test.comp"
        self.plant(kernel, "    endTest();", "    if (TEST_THREAD != 5u) { endTest(); }")
        self.expect_failure("threads that ran to the end")

    def test_a_kernel_that_does_not_compile_ends_the_build(self):
        self.plant("shaders/prefix_sum.glsl", "uint own =", "uint owm =")
        result = self.build_example()
        self.assertNotEqual(result.returncode, 0)
        self.assertRegex(result.stdout, r"shaders/prefix_sum.glsl:\d+: 'own' : undeclared identifier")

    def test_the_page_shows_the_example(self):
        page = read(os.path.join(self.harness, "README.md"))
        for file in ("CMakeLists.txt", "shaders/random_number.glsl", "tests/random_number_test.comp", "tests/random_number_test.cpp"):
            self.assertIn(read(os.path.join(self.example, file)) + "```\n", page, file)


if __name__ == "__main__":
    unittest.main()
