#!/usr/bin/env python3
"""The workflow for CI that README.md shows: its form, and its steps from the first one that renders, run as a worker's shell does. README's
recipes, each run with fewer pixels, samples and pictures. And the project's own workflows: their form, and that pages show the commands of
their steps."""

import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import yaml

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
GLIM = os.path.abspath(sys.argv[1])


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def read_workflow():
    blocks = read(os.path.join(ROOT, "README.md")).split("```yaml\n")[1:]
    assert len(blocks) == 1, "README.md should show one workflow"
    return yaml.safe_load(blocks[0].split("```\n")[0])


def fill(folder):
    """Makes it look like the project's root, with glim as it is built."""
    os.mkdir(os.path.join(folder, "tools"))
    os.symlink(GLIM, os.path.join(folder, "tools", "glim"))
    for name in ("scenes", "tests"):
        os.symlink(os.path.join(ROOT, name), os.path.join(folder, name))


class WorkflowTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.job, = read_workflow()["jobs"].values()
        runs = [step.get("run", "") for step in cls.job["steps"]]
        cls.renders = runs[next(i for i, run in enumerate(runs) if run.startswith("tools/glim")):]

    def run_steps(self, steps):
        """The exit codes up to the first that is not 0."""
        codes = []
        with tempfile.TemporaryDirectory() as folder:
            fill(folder)
            for step in steps:
                codes.append(subprocess.run(["sh", "-e", "-c", step], cwd=folder, capture_output=True).returncode)
                if codes[-1] != 0:
                    break
        return codes

    def test_form(self):
        self.assertEqual(set(self.job), {"runs-on", "container", "steps"})
        for step in self.job["steps"]:
            self.assertEqual(len(step), 1, step)
            self.assertTrue(set(step) <= {"run", "uses"}, step)

    def test_steps_pass(self):
        self.assertEqual(self.run_steps(self.renders), [0] * len(self.renders))

    def test_another_picture_is_refused(self):
        steps = [step.replace("scenes/cornell.gltf", "scenes/cornell_spheres.gltf") for step in self.renders]
        self.assertEqual(self.run_steps(steps), [0] * (len(steps) - 1) + [4])


class RecipesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.path = os.environ["PATH"]
        fill(self.folder)

    def stand_in(self, program, text):
        path = os.path.join(self.folder, "bin", program)
        os.mkdir(os.path.dirname(path))
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(path, 0o755)
        self.path += ":" + os.path.dirname(path)

    def run_recipe(self, part):
        """Runs the one that has this part, and returns what it prints."""
        section = read(os.path.join(ROOT, "README.md")).split("\n## Recipes\n")[1].split("\n## ")[0]
        lines = re.search(r"```sh\n(.*?)```", section, re.DOTALL).group(1).splitlines()
        command, = (line for line in lines if part in line and not line.startswith("#"))
        for large, small in ((r"--size \d+x\d+", "--size 64x36"), (r"--spp \d+", "--spp 4"), (r"--turntable \d+", "--turntable 3"),
                             (r"--target-rmse \.5%", "--target-rmse 25%")):
            command = re.sub(large, small, command)
        if "glim" in command and "--size" not in command:
            command += " --size 64x36"
        result = subprocess.run(["bash", "-c", command], cwd=self.folder, stdin=subprocess.DEVNULL, text=True, capture_output=True,
                                env={**os.environ, "PATH": self.path}, check=False)
        self.assertEqual(result.returncode, 0, command + "\n" + result.stderr)
        return result.stdout

    def read_start(self, name):
        with open(os.path.join(self.folder, name), "rb") as file:
            return file.read(65536)

    def test_transparent(self):
        self.run_recipe("--environment-background off")
        start = self.read_start("product.png")
        self.assertEqual((start[1:4], start[25]), (b"PNG", 6), "colours with alpha")

    def test_turntable(self):
        if not shutil.which("ffmpeg"):
            self.stand_in("ffmpeg", "#!/bin/sh\ncat > /dev/null\nprintf '\\0\\0\\0\\030ftyp' > /proc/self/fd/3\n")
        self.run_recipe("--movie turn.mp4")
        self.assertEqual(sorted(glob.glob("turn.*", root_dir=self.folder)), ["turn.%03d.png" % i for i in range(3)] + ["turn.mp4"])
        self.assertEqual(self.read_start("turn.mp4")[4:8], b"ftyp")

    def test_4k(self):
        self.run_recipe("--size 3840x2160")
        digest = self.read_start("large.exr")
        self.run_recipe("--size 3840x2160")
        self.assertEqual(self.read_start("large.exr"), digest)
        self.assertEqual(self.read_start("large.png")[1:4], b"PNG")

    def test_data_set(self):
        self.run_recipe("view.####.exr")
        for i in range(3):
            for layer in (b"albedo.R", b"normal.X", b"depth.Z"):
                self.assertIn(layer, self.read_start("view.%04d.exr" % i))
            self.assertIn(b"node.X", self.read_start("ids.%04d.exr" % i))

    def test_reference(self):
        said = self.run_recipe("reference.exr")
        self.assertLessEqual(float(re.search(r"RMSE ([0-9.]+) %", said).group(1)), 25)
        self.assertEqual(self.read_start("reference.exr")[:4], b"\x76\x2f\x31\x01")


class OwnWorkflowsTest(unittest.TestCase):
    def test_steps_are_commands_of_pages(self):
        paths = glob.glob(os.path.join(ROOT, ".github", "workflows", "*.yml"))
        pages = [page for folder in ("", "python", "tests") for page in glob.glob(os.path.join(ROOT, folder, "*.md"))]
        shown = {line for page in pages for block in re.findall(r"```sh\n(.*?)```", read(page), re.DOTALL) for line in block.splitlines()}
        self.assertGreater(len(paths), 0)
        for path in paths:
            workflow = yaml.safe_load(read(path))
            self.assertIn(True, workflow, path)  # `on`, as YAML 1.1 reads it
            for job in workflow["jobs"].values():
                self.assertIn(job["container"], ("debian:12", {"image": "debian:12", "options": "--privileged"}))
                commands = [step["run"] for step in job["steps"] if "run" in step]
                self.assertTrue(commands[0].startswith("apt-get update && "), path)
                for command in commands[1:]:
                    self.assertTrue(command in shown or command == ".ci/run", "%s: no page shows %s" % (path, command))
                    self.assertTrue(os.access(os.path.join(ROOT, command.split()[0]), os.X_OK), command)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
