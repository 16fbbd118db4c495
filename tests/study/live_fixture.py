"""What the tests of tools/study --serve share: the server as a process, requests to it, and a program in glim's place."""

import http.client
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
STUDY = os.path.join(ROOT, "tools", "study")
SIGNALS = (signal.SIGHUP, signal.SIGINT, signal.SIGTERM)
PNG = b"\x89PNG of a program in glim's place"

# What a request gets depends on its samples.
STAND_IN = """#!%(python)s -BS
import json, os, signal, sys, time
folder = %(folder)r
if sys.argv[1] == "--version":
    print("glim stand-in")
elif sys.argv[1] == "devices":
    print(json.dumps([{"usable": True, "name": "a <device>", "driver": "none", "kind": "software"}]))
else:
    with open(os.path.join(folder, "pid"), "w") as file:
        file.write(str(os.getpid()))
    for line in sys.stdin:
        with open(os.path.join(folder, "asked"), "a") as file:
            file.write(line)
        job = json.loads(line)["render"]
        while os.path.exists(os.path.join(folder, "hold")):
            time.sleep(.01)
        if job["spp"] == 3:
            print(json.dumps({"code": 2, "error": "--spp: three is refused", "reason": None}), flush=True)
            continue
        if job["spp"] == 5:
            os.kill(os.getpid(), signal.SIGKILL)
        open(job["output"], "w").close()
        with open(job["image"], "wb") as file:
            file.write(%(png)r)
        with open(job["stats"], "w") as file:
            json.dump({"seconds": {"render": .5}, "estimate": {"relmse": .02, "relmse95": [.01, .04]}, "rmseOfMeanBound": None,
                       "steps": None, "adaptive": None, "samples": 4 * job["size"][0] * job["size"][1], "size": job["size"],
                       "raysPerSecond": 2e6, "pixelsDigest": "bits"}, file)
        print(json.dumps({"code": 0, "error": None, "reason": None}), flush=True)
"""


def take_signals():
    """Also of who has started the tests so that some are ignored."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_DFL)


def wait_for(condition, seconds=60):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.01)


class Live:
    """tools/study --serve. `glim`: the program, or None for the stand-in."""

    def __init__(self, *arguments, glim=None):
        self.folder = tempfile.TemporaryDirectory()
        for name in ("temporary", "scenes"):  # the latter without the course's scenes
            os.mkdir(self.path(name))
        if glim is None:
            glim = self.path("glim")
            with open(glim, "w", encoding="utf-8") as file:
                file.write(STAND_IN % {"python": sys.executable, "folder": self.folder.name, "png": PNG})
            os.chmod(glim, 0o755)
        with open(self.path("said"), "wb") as said:
            self.process = subprocess.Popen([STUDY, "--serve", "--scenes", self.path("scenes"), *arguments], stdin=subprocess.DEVNULL,
                                            stdout=subprocess.PIPE, stderr=said, preexec_fn=take_signals, text=True,
                                            env={**os.environ, "GLIM_BINARY": glim, "TMPDIR": self.path("temporary")})
        self.url = self.process.stdout.readline().strip()
        if self.url:
            self.authority, self.token = self.url.split("/")[2:4]
            self.port = int(self.authority.split(":")[1])

    def path(self, *names):
        return os.path.join(self.folder.name, *names)

    def read(self, name):
        if not os.path.exists(self.path(name)):
            return ""
        with open(self.path(name), encoding="utf-8") as file:
            return file.read()

    def asked(self):
        """The options of each render that the stand-in was asked for."""
        return [json.loads(line)["render"] for line in self.read("asked").splitlines()]

    def request(self, method, path, headers=(), body=None):
        """Status, headers and content. headers: (name, value), in place of those that a browser sends."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        try:
            connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
            own = [("Host", self.authority)] + [("Origin", "http://" + self.authority)] * (method == "POST")
            given = {name for name, _ in headers}
            for name, value in [pair for pair in own if pair[0] not in given] + [pair for pair in headers if pair[1] is not None]:
                connection.putheader(name, value)
            if body is not None and "Content-Length" not in given:
                connection.putheader("Content-Length", str(len(body)))
            connection.endheaders(body)
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read()
        finally:
            connection.close()

    def get(self, name, *headers):
        return self.request("GET", "/%s/%s" % (self.token, name), headers)

    def post(self, request, *headers, name="render"):
        body = request if isinstance(request, bytes) else json.dumps(request).encode()
        return self.request("POST", "/%s/%s" % (self.token, name), headers, body)

    def end(self, number=signal.SIGTERM):
        """The exit code."""
        self.process.send_signal(number)
        code = self.process.wait(60)
        self.process.stdout.close()
        return code

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        if self.process.poll() is None:
            self.end(signal.SIGKILL)
        self.process.stdout.close()
        self.folder.cleanup()
