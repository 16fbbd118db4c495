"""What tools/farm says on terminals and to readers, and the files that tools write: python3 farm_files_test.py"""

import fcntl
import os
import pty
import resource
import struct
import subprocess
import sys
import tempfile
import termios
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(ROOT, "tools"))
from render_farm.errors import FarmError  # noqa: E402
from render_farm.job_folder import JobFolder  # noqa: E402
from whole_file import publish, write_whole  # noqa: E402

PROGRAM = """
import sys
sys.path.insert(0, %r)
from render_farm.progress import Progress
progress = Progress()
for done in range(3):
    progress.show("%%d of 3 pages" %% done, (1, 2), 10, None, "a dashboard that nobody has asked for, with a name that is long")
    sys.stdin.readline()
progress.say("done")
""" % os.path.join(ROOT, "tools")


def resize(terminal, columns):
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))


class ProgressTest(unittest.TestCase):
    def start(self, stderr):
        process = subprocess.Popen([sys.executable, "-B", "-c", PROGRAM], stdin=subprocess.PIPE, stderr=stderr)
        self.addCleanup(process.wait)
        self.addCleanup(process.stdin.close)
        return process

    def step(self, process):
        process.stdin.write(b"\n")
        process.stdin.flush()

    def read_line(self, terminal, mark):
        """What the terminal shows up to the line that has `mark`."""
        shown = b""
        while mark not in shown or shown.endswith(b"\x1b"):
            shown += os.read(terminal, 4096)
        return shown

    def test_lines_fit_a_terminal_that_changes_its_size(self):
        terminal, end = pty.openpty()
        self.addCleanup(os.close, terminal)
        resize(terminal, 60)
        process = self.start(end)
        os.close(end)
        self.assertEqual(len(self.read_line(terminal, b"0 of 3").rpartition(b"\x1b[K")[2]), 59)
        resize(terminal, 20)
        self.step(process)
        self.assertEqual(self.read_line(terminal, b"1 of 3").rpartition(b"\x1b[K")[2], b"1 of 3 pages, 1 of ")
        self.step(process)
        self.step(process)
        self.assertIn(b"farm: done", self.read_line(terminal, b"done"))
        self.assertEqual(process.wait(), 0)

    def test_a_terminal_that_hangs_up_ends_nothing(self):
        terminal, end = pty.openpty()
        process = self.start(end)
        os.close(end)
        self.read_line(terminal, b"0 of 3")
        os.close(terminal)
        for _ in range(3):
            self.step(process)
        self.assertEqual(process.wait(), 0)

    def test_a_reader_that_is_gone_ends_nothing(self):
        reader, end = os.pipe()
        os.close(reader)
        process = self.start(end)
        os.close(end)
        for _ in range(3):
            self.step(process)
        self.assertEqual(process.wait(), 0)


class FilesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="ascii") as file:
            file.write(text)
        return path

    def test_a_file_that_is_replaced_keeps_its_mode(self):
        new, old = self.write("new", "new"), self.write("old", "old")
        os.chmod(old, 0o640)
        publish(new, old)
        with open(old, encoding="ascii") as file:
            self.assertEqual(file.read(), "new")
        self.assertEqual(os.stat(old).st_mode & 0o777, 0o640)

    def test_a_file_that_would_grow_too_large_is_not_written(self):
        path = self.write("old", "old")
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (100, limits[1]))
        self.addCleanup(resource.setrlimit, resource.RLIMIT_FSIZE, limits)
        with self.assertRaisesRegex(OSError, "File too large.*old"):
            write_whole(path, bytes(1000))
        self.assertEqual(os.listdir(self.folder), ["old"])
        write_whole(path, b"new")

    def test_links_in_the_place_of_a_temporary_file_are_not_followed(self):
        path = os.path.join(self.folder, "new")
        self.write("mine", "mine")
        os.symlink("mine", os.path.join(self.folder, ".glim-new.partial"))
        write_whole(path, b"new")
        with open(os.path.join(self.folder, "mine"), encoding="ascii") as file:
            self.assertEqual(file.read(), "mine")

    def test_the_folder_of_another_is_left(self):
        output = os.path.join(self.folder, "out.exr")
        os.mkdir(output + ".farm")
        self.write("out.exr.farm/mine", "mine")
        with self.assertRaisesRegex(FarmError, "is no folder of a farm"):
            JobFolder(output).hold({}, {})
        self.assertEqual(os.listdir(output + ".farm"), ["mine"])


if __name__ == "__main__":
    unittest.main()
