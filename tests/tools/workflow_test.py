#!/usr/bin/env python3
"""The workflow for CI that README.md shows: its form, and its steps from the first one that renders, run as a worker's shell does. And the
project's own workflows: their form, and that pages show the commands of their steps."""

import glob
import os
import re
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
            os.mkdir(os.path.join(folder, "tools"))
            os.symlink(GLIM, os.path.join(folder, "tools", "glim"))
            for name in ("scenes", "tests"):
                os.symlink(os.path.join(ROOT, name), os.path.join(folder, name))
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


class OwnWorkflowsTest(unittest.TestCase):
    def test_steps_are_commands_of_pages(self):
        paths = glob.glob(os.path.join(ROOT, ".github", "workflows", "*.yml"))
        pages = glob.glob(os.path.join(ROOT, "*.md")) + glob.glob(os.path.join(ROOT, "tests", "*.md"))
        shown = {line for page in pages for block in re.findall(r"```sh\n(.*?)```", read(page), re.DOTALL) for line in block.splitlines()}
        self.assertGreater(len(paths), 0)
        for path in paths:
            workflow = yaml.safe_load(read(path))
            self.assertIn(True, workflow, path)  # `on`, as YAML 1.1 reads it
            for job in workflow["jobs"].values():
                self.assertEqual(job["container"], "debian:12")
                commands = [step["run"] for step in job["steps"] if "run" in step]
                self.assertTrue(commands[0].startswith("apt-get update && "), path)
                for command in commands[1:]:
                    self.assertTrue(command in shown or command == ".ci/run", "%s: no page shows %s" % (path, command))
                    self.assertTrue(os.access(os.path.join(ROOT, command.split()[0]), os.X_OK), command)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
