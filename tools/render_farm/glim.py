"""glim on the driver's machine."""

import os
import subprocess

from render_farm.errors import FarmError
from render_farm.exr_header import FilmHeader, read_header
from render_farm.glim_child import Servers, last_sentence, run_glim, serve_film

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

    def version(self):
        try:
            return self.read(["--version"]).strip()
        except OSError as error:
            raise FarmError("%s: is not glim: %s" % (self.program, error)) from error

    def read(self, arguments):
        """What glim prints. Refuses (FarmError) with glim's sentence."""
        done = subprocess.run([self.program, *arguments], capture_output=True, text=True, cwd=self.folder, check=False)
        if done.returncode != 0:
            raise FarmError(last_sentence(done.returncode, done.stderr))
        return done.stdout

    def run(self, arguments):
        """What glim says on stderr. Refuses (FarmError) with glim's sentence and exit code."""
        code, said = run_glim(self.program, arguments, self.folder)
        if code != 0:
            raise FarmError(last_sentence(code, said), code if code > 0 else 1)
        return said

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
