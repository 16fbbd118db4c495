"""glim on the driver's machine."""

import json
import os
import subprocess

from render_farm.errors import FarmError
from render_farm.exr_header import FilmHeader, read_header
from render_farm.glim_child import Servers, last_sentence, serve_film

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))


def find_glim():
    """The program to run, which tools/glim builds if need be."""
    named = os.environ.get("GLIM_BINARY")
    if not named and subprocess.run([os.path.join(ROOT, "tools", "glim"), "--version"], stdout=subprocess.DEVNULL, check=False).returncode:
        raise FarmError("glim could not be built")
    return os.path.abspath(named) if named else os.path.join(ROOT, "build", "glim")


class Glim:
    def __init__(self, program, folder):
        """folder: where its relative names begin."""
        self.program, self.folder = program, folder

    def run(self, *arguments):
        try:
            done = subprocess.run([self.program, *arguments], capture_output=True, text=True, check=False)
        except OSError as error:
            raise FarmError("%s: is not glim: %s" % (self.program, error)) from error
        if done.returncode != 0:
            raise FarmError(last_sentence(done.returncode, done.stderr), done.returncode if done.returncode > 0 else 1)
        return done.stdout.strip()

    def version(self):
        return self.run("--version")

    def devices(self, wanted):
        """The descriptions of the devices that `--devices` wants, by worker. All are all GPUs, or all software devices if there is no GPU."""
        found = [{"index": index, **device} for index, device in enumerate(json.loads(self.run("devices", "--json")))]
        usable = [device for device in found if device["usable"]]
        if wanted == "all":
            chosen = [device for device in usable if device["kind"] != "software"] or usable
            if not chosen:
                raise FarmError("--devices all: this machine has no device that glim can use", 3)
            return chosen
        for index in wanted:
            if index >= len(found) or not found[index]["usable"]:
                raise FarmError("--devices: device %d %s; `glim devices` lists them" % (
                    index, "lacks what glim needs" if index < len(found) else "is not there"), 3)
        return [found[index] for index in wanted]

    def merge(self, films, output=None, **options):
        """Merges films into the file `output`; without one they are only looked at. options: others of `glim merge`.

        Returns what the merged film is: samples, exact (the bits of a single run), complete, estimate (of its error, or None). Refuses
        (FarmError, with the file that is to blame if there is one) with glim's sentence and exit code."""
        servers = Servers()
        try:
            answer = servers.ask(self.program, self.folder, {"merge": {"films": films, "output": output, **options}})
        finally:
            servers.end()
        if answer["code"] != 0:
            raise FarmError(answer["error"], answer["code"] if answer["code"] > 0 else 1, (answer["reason"] or {}).get("file"))
        return answer["film"]

    def sample(self, job):
        """The header of the picture's first sample: what it is a picture of, known before any worker is asked."""
        servers = Servers()
        try:
            film, code, error = serve_film(servers, self.program, {**job, "samples": "0:1"}, self.folder)
        finally:
            servers.end()
        if film is None:
            raise FarmError(error, code if code > 0 else 1)
        return FilmHeader(read_header(film, "the first sample"), "the first sample")
