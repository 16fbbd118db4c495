#!/usr/bin/env python3
"""What tools/setup.sh says while it installs and builds, on a terminal and without one: how far it is, and that there is no network. How it
fetches the second driver of the tests."""

import concurrent.futures
import contextlib
import os
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
SETUP = os.path.join(ROOT, "tools", "setup.sh")
IS_DEBIAN = subprocess.run(["bash", "-c", 'source "$0" && isDebian', SETUP], check=False).returncode == 0

# Steps of a build: one by one, and one that takes as long as the argument says.
CMAKE = """case $1 in
    --build)
        printf '[1/3] Compiling a\\n[2/3] Compil'
        sleep %s
        printf 'ing b\\n[3/3] Linking glim\\n'
        printf '#!/bin/sh\\necho "glim $*"\\n' >"$2/glim"
        chmod +x "$2/glim"
        ;;
    *) touch build/build.ninja ;;
esac
"""


class Machine:
    """A folder with a copy of tools, and programs that stand in for those of the system."""

    def __init__(self, folder):
        self.folder = folder
        shutil.copytree(os.path.join(ROOT, "tools"), self.path("tools"), ignore=shutil.ignore_patterns("__pycache__"))
        for name in ("host", "python", "shaders", "tests", "programs"):
            os.mkdir(self.path(name))
        for name in ("CMakeLists.txt", "CMakePresets.json"):
            shutil.copy(os.path.join(ROOT, name), folder)
        self.environment = {**os.environ, "PATH": self.path("programs") + ":" + os.environ["PATH"]}
        self.environment.pop("GLIM_PRESET", None)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def add_program(self, name, script):
        with open(self.path("programs", name), "w", encoding="utf-8") as file:
            file.write("#!/bin/bash\n" + script)
        os.chmod(self.path("programs", name), 0o755)

    def run(self, *words):
        """Exit code, standard output, standard error and seconds."""
        start = time.monotonic()
        result = subprocess.run([self.path("tools", words[0]), *words[1:]], env=self.environment, stdin=subprocess.DEVNULL, text=True,
                                capture_output=True, timeout=120, check=False)
        return result.returncode, result.stdout, result.stderr, time.monotonic() - start

    def run_on_terminal(self, *words):
        """Exit code, what the terminal shows, and seconds."""
        start = time.monotonic()
        terminal, end = os.openpty()
        process = subprocess.Popen([self.path("tools", words[0]), *words[1:]], env=self.environment, stdin=end, stdout=end, stderr=end,
                                   start_new_session=True)
        os.close(end)
        shown = b""
        with contextlib.suppress(OSError):  # that is how a terminal ends
            while part := os.read(terminal, 65536):
                shown += part
        os.close(terminal)
        return process.wait(), shown.decode(), time.monotonic() - start


class Server:
    """Of packages: accepts connections, and sends each of them an answer and nothing more."""

    def __init__(self, answer=b""):
        self.answer = answer
        self.connections = []
        self.socket = socket.create_server(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        with contextlib.suppress(OSError):  # closed
            while True:
                self.connections.append(self.socket.accept()[0])
                self.connections[-1].sendall(self.answer)
                if self.answer and len(self.connections) > 1:
                    self.connections[-1].close()

    def close(self):
        for connection in [self.socket, *self.connections]:
            connection.close()


class SetupTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """Starts all calls at once, since each takes many seconds and no work."""
        cls.pool = concurrent.futures.ThreadPoolExecutor(10)
        silent, shown, awaited = (cls.make_machine_that_builds(seconds) for seconds in (11, 3, 11))
        cls.builds = cls.start(silent.run), cls.start(shown.run_on_terminal)
        cls.log = silent.path("build", "setup.log")
        cls.two_builds = [cls.start(awaited.run) for _ in range(2)]
        cls.awaited = awaited.path("build")
        if IS_DEBIAN:
            no_answer, cls.slow = Server(), Server(b"HTTP/1.1 200 OK\r\nContent-Length: 1000000\r\n\r\n-----BEGIN")
            machines = [cls.make_machine_without_packages(server) for server in (no_answer, no_answer, cls.slow)]
            cls.installs = cls.start(machines[0].run), cls.start(machines[1].run_on_terminal), cls.start(machines[2].run)
        cls.addClassCleanup(cls.pool.shutdown)

    @classmethod
    def start(cls, run):
        return cls.pool.submit(run, "glim", "devices")

    @classmethod
    def make_machine(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        return Machine(folder.name)

    @classmethod
    def make_machine_that_builds(cls, seconds):
        machine = cls.make_machine()
        machine.add_program("cmake", CMAKE % seconds)
        machine.add_program("dpkg-query", 'shift 3\nprintf "%s installed\\n" "$@"\n')
        return machine

    @classmethod
    def make_machine_without_packages(cls, server):
        """apt knows one server, and of no package."""
        cls.addClassCleanup(server.close)
        machine = cls.make_machine()
        machine.add_program("dpkg-query", "")
        machine.add_program("sudo", '[[ $1 != -n ]] || shift\nexec "$@"\n')
        for name in ("lists/partial", "cache/archives/partial"):
            os.makedirs(machine.path(name))
        files = {"status": "", "sources.list": "deb http://127.0.0.1:%d/debian stable main\n" % server.port,
                 "apt.conf": """Dir::State "%(folder)s";
Dir::State::lists "%(folder)s/lists";
Dir::State::status "%(folder)s/status";
Dir::Cache "%(folder)s/cache";
Dir::Etc::sourcelist "%(folder)s/sources.list";
Dir::Etc::sourceparts "/dev/null";
Acquire::http::Proxy "DIRECT";
APT::Sandbox::User "";
""" % {"folder": machine.folder}}
        for name, text in files.items():
            with open(machine.path(name), "w", encoding="utf-8") as file:
                file.write(text)
        machine.environment["APT_CONFIG"] = machine.path("apt.conf")
        return machine

    def test_builds_say_how_far_they_are(self):
        code, output, said, _ = self.builds[0].result()
        self.assertEqual((code, output), (0, "glim devices\n"), said)
        self.assertRegex(said, r"^glim: building in .*\nglim: building, 1 of 3 steps\nglim: built in [0-9]+ s\n$")
        with open(self.log, encoding="utf-8") as log:
            self.assertEqual(log.read(), "[1/3] Compiling a\n[2/3] Compiling b\n[3/3] Linking glim\n")
        code, said, _ = self.builds[1].result()
        self.assertEqual(code, 0, said)
        self.assertRegex(said, r"^glim: building in .*\r\n(\r\x1b\[Kglim: configuring, . s)?(\r\x1b\[K)+"
                         r"(\r\x1b\[Kglim: building, [1-3] of 3 steps){2,}(\r\x1b\[K)+"
                         r"glim: built in [0-9]+ s\r\nglim devices\r\n$")

    def test_one_that_waits_says_so(self):
        calls = [call.result() for call in self.two_builds]
        self.assertEqual([call[:2] for call in calls], [(0, "glim devices\n")] * 2)
        said = sorted(call[2] for call in calls)
        self.assertRegex(said[0], "^glim: building in ")
        self.assertEqual(said[1], "glim: waiting for another build in %s\n" % self.awaited)

    @unittest.skipUnless(IS_DEBIAN, "not Debian 12 or newer")
    def test_without_a_network_apt_fails_soon(self):
        sentence = r"\nglim: apt-get could not install, because no server of packages answers \(is there a network\?\): g\+\+ cmake [^\n]*$"
        code, output, said, seconds = self.installs[0].result()
        self.assertEqual((code, output), (1, ""))
        self.assertRegex(said.rstrip(), sentence)
        self.assertIn("\nglim: fetching apt's lists, 10 s\n", said)
        self.assertLess(seconds, 20)
        code, said, seconds = self.installs[1].result()
        self.assertEqual(code, 1)
        self.assertRegex(said.rstrip(), sentence)
        self.assertGreaterEqual(len(re.findall("\r\x1b\\[Kglim: fetching apt's lists, [0-9]+ s", said)), 10)
        self.assertLess(seconds, 20)
        # A server that answers is waited for, however slow it is.
        code, _, said, _ = self.installs[2].result()
        self.assertEqual(code, 1)
        self.assertRegex(said.rstrip(), r"\nglim: apt-get could not install: g\+\+ cmake [^\n]*$")
        self.assertGreater(len(self.slow.connections), 1)


@unittest.skipUnless(IS_DEBIAN, "not Debian 12 or newer")
class SecondDriverTest(unittest.TestCase):
    """ensureSwiftShader, with programs in place of apt-get."""

    WANTED = ("libvk_swiftshader.so", "vk_swiftshader_icd.json")

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.machine = Machine(folder.name)
        self.machine.add_program("sudo", "exit 1\n")
        os.mkdir(self.machine.path("build"))

    def fetch(self):
        """Exit code, what is said, and the files that are there then."""
        done = subprocess.run(["bash", "-c", "set -euo pipefail; source tools/setup.sh; ensureSwiftShader build"], cwd=self.machine.folder,
                              env=self.machine.environment, text=True, capture_output=True, timeout=120, check=False)
        driver = self.machine.path("build", "swiftshader")
        return done.returncode, done.stderr, sorted(os.listdir(driver)) if os.path.exists(driver) else []

    def add_apt(self, package, *names):
        """An apt-get that has only this package, with files of these names where Chromium has its libraries."""
        content = self.machine.path("content")
        os.makedirs(os.path.join(content, "DEBIAN"))
        os.makedirs(os.path.join(content, "usr/lib/chromium"))
        with open(os.path.join(content, "DEBIAN/control"), "w", encoding="utf-8") as file:
            file.write("Package: %s\nVersion: 1\nArchitecture: all\nMaintainer: nobody <a@b.c>\nDescription: a test\n" % package)
        for name in (*names, "resources.pak"):
            with open(os.path.join(content, "usr/lib/chromium", name), "w", encoding="utf-8") as file:
                file.write(name)
        subprocess.run(["dpkg-deb", "--build", content, self.machine.path("there.deb")], check=True, stdout=subprocess.DEVNULL)
        self.machine.add_program("apt-get", """[[ " $* " == *" download "* && ${!#} == %s ]] || { echo "E: nothing is there"; exit 100; }
cp %s %s.deb
""" % (package, self.machine.path("there.deb"), package))

    def test_is_fetched_once(self):
        self.add_apt("chromium-common", *self.WANTED)
        code, said, files = self.fetch()
        self.assertEqual((code, files), (0, sorted(self.WANTED)), said)
        self.assertRegex(said, r"^glim: fetching SwiftShader, [^\n]*\n$")
        self.machine.add_program("apt-get", "echo asked again >&2; exit 1\n")
        self.assertEqual(self.fetch(), (0, "", files))

    def test_without_a_network_it_is_skipped(self):
        self.machine.add_program("apt-get", 'echo "E: Could not resolve deb.debian.org"; exit 100\n')
        code, said, files = self.fetch()
        self.assertEqual((code, files), (0, []), said)
        self.assertIn("WARNING: tests on SwiftShader, the second driver, are skipped: no server of Debian's packages answers", said)

    def test_fails_where_others_are_fetched(self):
        self.add_apt("libvulkan1")
        code, said, files = self.fetch()
        self.assertEqual((code, files), (1, []), said)
        self.assertIn("could not download chromium-common, although it downloads other packages", said)

    def test_fails_where_the_package_has_no_driver(self):
        self.add_apt("chromium-common", "vk_swiftshader_icd.json")
        code, said, files = self.fetch()
        self.assertEqual((code, files), (1, []), said)
        self.assertIn("has no SwiftShader that can be unpacked", said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
