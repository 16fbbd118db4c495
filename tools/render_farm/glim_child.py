"""glim as a child process. Workers get this module by value: it needs nothing but Python and glim."""

import contextlib
import json
import os
import subprocess
import tempfile

ENDING_SECONDS = 10


def start(program, arguments, folder, **pipes):
    """Starts glim in `folder`. It is killed if the calling thread dies."""
    # setpriv, since Python's own way of running code between fork and exec is unsafe beside threads.
    # A session of its own, since Ctrl-C in a terminal is for the farm, which then ends the child itself.
    return subprocess.Popen(["setpriv", "--pdeathsig", "KILL", program, *arguments], cwd=folder, start_new_session=True, **pipes)


def last_sentence(code, said):
    """Why glim failed, in one line."""
    lines = [line for line in said.splitlines() if line.strip() and not line.startswith("Run with --help")]
    how = "glim was killed by signal %d" % -code if code < 0 else "glim ended with exit code %d" % code
    if code >= 0:
        return lines[-1] if lines else how + " and said nothing"
    return "%s; it said last: %s" % (how, lines[-1]) if lines else how


class Server:
    """A child that keeps scene, device and kernels from one request to the next (glim serve)."""

    def __init__(self, program, folder):
        self.key = program, folder
        self.said = tempfile.TemporaryFile("a+b")
        self.process = start(program, ["serve"], folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.said)

    def ask(self, request):
        """request: {"render": options of `glim render` by name} or {"merge": of `glim merge`}. Returns the answer of `glim serve`."""
        self.said.truncate(0)
        try:
            self.process.stdin.write(json.dumps({"id": 0, **request}).encode() + b"\n")
            self.process.stdin.flush()
            answer = self.process.stdout.readline()
        except BrokenPipeError:
            answer = b""
        if not answer:
            code = self.end(ENDING_SECONDS)
            self.said.seek(0)
            return {"code": code or 1, "error": last_sentence(code, self.said.read().decode(errors="replace")), "reason": None}
        return json.loads(answer)

    def end(self, seconds=0):
        """Kills it unless it ends within these seconds. Returns the exit code."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            return self.process.wait(seconds)
        self.process.kill()
        return self.process.wait()

    def close(self):
        self.end()
        for pipe in (self.process.stdin, self.process.stdout, self.said):
            with contextlib.suppress(BrokenPipeError):
                pipe.close()


class Servers:
    """The server of a worker: of the program and the folder that were asked for last."""

    def __init__(self):
        self.server = None

    def ask(self, program, folder, request):
        if self.server and (self.server.key != (program, folder) or self.server.process.poll() is not None):
            self.end()
        if not self.server:
            self.server = Server(program, folder)
        return self.server.ask(request)

    def end(self):
        if self.server:
            self.server.close()
            self.server = None


def end_server_of(dask_worker):
    """Ends the server of a worker. (Dask knows its argument by this name.)"""
    if hasattr(dask_worker, "glim_servers"):
        dask_worker.glim_servers.end()


def serve_film(servers, program, job, folder, scratch=None):
    """Has the server render one film in a folder of its own within `scratch`, which must exist.

    program: glim's, unless GLIM_BINARY of this machine names another. job: options of `glim render` by name, without the output. What the
    scene names must lie in its folder: other machines are not to send files of this one.
    Returns the film's bytes or None, the exit code of `glim render`, and why it failed in one line."""
    with tempfile.TemporaryDirectory(dir=scratch, prefix="glim-farm-") as own:
        film = os.path.join(own, "film.#.exr" if "frames" in job else "film.exr")
        job = {**job, "confine": True, "progress": "none", "output": film}
        try:
            answer = servers.ask(os.environ.get("GLIM_BINARY") or program, folder, {"render": job})
        except OSError as caught:
            return None, 1, "glim cannot be run: %s" % caught
        if answer["code"] != 0:
            return None, answer["code"], answer["error"]
        (name,) = [name for name in os.listdir(own) if name.endswith(".exr")]
        with open(os.path.join(own, name), "rb") as file:
            return file.read(), 0, ""
