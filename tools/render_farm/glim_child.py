"""glim as a child process. Workers get this module by value: it needs nothing but Python and glim."""

import os
import subprocess
import tempfile


def run_glim(program, arguments, folder):
    """Runs glim in `folder`, and kills it if the calling thread dies. Returns its exit code and what it said on stderr."""
    # setpriv, since Python's own way of running code between fork and exec is unsafe beside threads.
    # A session of its own, since Ctrl-C in a terminal is for the farm, which then ends the child itself.
    command = ["setpriv", "--pdeathsig", "KILL", program, *arguments]
    done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                          start_new_session=True, check=False)
    return done.returncode, done.stderr.decode(errors="replace").strip()


def last_sentence(code, said):
    """Why glim failed, in one line."""
    if code < 0:
        return "glim was killed by signal %d" % -code
    lines = [line for line in said.splitlines() if line.strip() and not line.startswith("Run with --help")]
    return lines[-1] if lines else "glim ended with exit code %d and said nothing" % code


def render_film(program, arguments, folder, scratch):
    """Renders one film in a folder of its own within `scratch`, which must exist, and returns its bytes.

    program: glim's, unless GLIM_BINARY of this machine names another. arguments: those of glim, without the output.
    Returns the film or None, why not in one line, and glim's exit code."""
    with tempfile.TemporaryDirectory(dir=scratch) as own:
        film = os.path.join(own, "film.#.exr" if "--frames" in arguments else "film.exr")
        try:
            code, said = run_glim(os.environ.get("GLIM_BINARY") or program, [*arguments, "--progress", "none", "-o", film], folder)
        except OSError as error:
            return None, "glim cannot be run: %s" % error, 1
        if code != 0:
            return None, last_sentence(code, said), max(code, 1)
        (name,) = [name for name in os.listdir(own) if name.endswith(".exr")]
        with open(os.path.join(own, name), "rb") as file:
            return file.read(), "", 0
