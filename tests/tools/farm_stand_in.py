"""Programs in glim's place: glim itself, but for what happens when a page is rendered. FarmCase.program (farm_fixture.py) writes them."""

import json
import os
import struct
import subprocess
import sys
import time


PAGE = 256  # samples


class Page:
    """What a worker's child is to render."""

    def __init__(self, glim, server, job):
        """server: a child of glim's own."""
        self.glim, self.server, self.job = glim, server, job
        self.film, self.samples = job["output"], job.get("samples", "")
        self.number = int(self.samples.partition(":")[0]) // PAGE
        self.worker = os.getppid()

    def start(self, **more):
        """Begins to render it by glim, with more options."""
        self.server.stdin.write(json.dumps({"id": 0, "render": {**self.job, **more}}).encode() + b"\n")
        self.server.stdin.flush()

    def render(self, **more):
        """Returns the exit code, and why glim failed."""
        self.start(**more)
        answer = json.loads(self.server.stdout.readline())
        return answer["code"], answer["error"]

    def patch(self, change):
        """Gives the bytes of its film to `change`, which returns those that take their place."""
        with open(self.film, "rb") as file:
            content = file.read()
        with open(self.film, "wb") as file:
            file.write(change(content))

    def replace(self, *pairs):
        """Replaces bytes of its film, and has glim compute the digests of what comes of it: from a film of the first format, which
        has none."""
        kind = b"glim:film\0double\0\x08\0\0\0"
        formats = kind + struct.pack("<d", 3), kind + struct.pack("<d", 1)

        def change(content):
            for old, new in (*pairs, formats, (b"glim:digest", b"glim:forgot"), (b"glim:headerDigest", b"glim:headerForgot")):
                if content.count(old) != 1 or len(old) != len(new):
                    raise ValueError("%s is there %d times" % (old, content.count(old)))
                content = content.replace(old, new)
            return content
        self.patch(change)
        subprocess.run([self.glim, "merge", self.film, "-o", self.film], check=True, stderr=subprocess.DEVNULL)

    def forge(self):
        """Another picture with a digest that is right: that of another seed, which claims to be of this one."""
        code, error = self.render(seed=7)
        name = b"glim:seed\0double\0\x08\0\0\0"
        self.replace((b"seed=7 ", b"seed=0 "), (name + struct.pack("<d", 7), name + struct.pack("<d", 0)))
        return code, error

    def relabel(self, attribute):
        """Renders it as if by other kernels or another device, with a digest that is right."""
        code, error = self.render()
        name = b"glim:%s\0string\0\x10\0\0\0" % attribute.encode()
        with open(self.film, "rb") as file:
            mark = file.read().partition(name)[2][:16]
        self.replace((name + mark, name + b"0123456789abcdef"))
        return code, error

    def flip(self):
        """Renders it, and flips a bit of its samples."""
        code, error = self.render()
        self.flip_film()
        return code, error

    def flip_film(self):
        self.patch(lambda content: content[:-2000] + bytes([content[-2000] ^ 1]) + content[-1999:])
        return 0, None


def claim(folder, name, owner=None):
    """Whether this is the first call of that name, or comes from the owner of the first."""
    path = os.path.join(folder, "claim-" + name)
    try:
        os.symlink(str(owner), path)
    except FileExistsError:
        return owner is not None and os.readlink(path) == str(owner)
    return True


def owner_of(folder, name):
    """None without a claim."""
    path = os.path.join(folder, "claim-" + name)
    return os.readlink(path) if os.path.lexists(path) else None


def wait_for(folder, name):
    while owner_of(folder, name) is None:
        time.sleep(.02)


def stand_in(glim, mishap):
    """mishap: takes a Page, and returns the exit code and what is said."""
    if sys.argv[1] != "serve":  # --version
        os.execv(glim, [glim, *sys.argv[1:]])
    server = subprocess.Popen([glim, "serve"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    for line in sys.stdin:
        request = json.loads(line)
        if "merge" in request:  # of the driver's own
            server.stdin.write(line.encode())
            server.stdin.flush()
            print(server.stdout.readline().decode(), end="", flush=True)
            continue
        if not request["render"]["confine"]:
            raise ValueError("files of the worker's machine can be read by a scene")
        page = Page(glim, server, request["render"])
        code, error = page.render() if page.samples == "0:1" else mishap(page)  # the driver asks for that sample
        print(json.dumps({"id": request["id"], "code": code, "error": error}), flush=True)
