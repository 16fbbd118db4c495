"""The frames of an animation, one part each."""

import os
import re
import tempfile

from render_farm.errors import FarmError
from render_farm.exr_header import FilmHeader, read_film_header, read_header
from whole_file import publish, write_whole
from render_farm.picture import check_identity


def numbered(pattern, frame):
    """The name with a frame's number in place of its first run of #."""
    folder, name = os.path.split(pattern)
    return os.path.join(folder, re.sub("#+", lambda match: str(frame).zfill(len(match[0])), name, count=1))


class Animation:
    """Its parts are numbers of frames. Each is a film of its own, which gets its name when it is whole."""

    part = "frame"
    error = None  # of the picture so far: frames have their own
    has_class = True  # the kernels of the driver's glim; devices may differ from frame to frame

    def __init__(self, options, glim, folder, say):
        self.options, self.glim, self.folder, self.say = options, glim, folder, say
        first, last = options.frames
        self.parts = range(first, last + 1)
        self.count = len(self.parts)
        self.there = set()

        self.finished = False

    @property
    def expected(self):
        return self.count

    @property
    def whole(self):
        return len(self.there) == self.count

    def publish(self):
        self.finished = True  # each frame has its name already

    def open(self):
        """Finds out what is asked and what is done. Returns the digests of the frames that are rendered already."""
        header = self.glim.sample(self.picture(self.parts[0]))
        self.header, self.pixels = header, header.pixels
        job = {"frames": "%d:%d" % self.options.frames, "fps": self.options.fps or "24", "samples": self.options.spp, **header.identity()}
        self.folder.hold(job, {"plan": {"frames": self.count}, "glim": self.glim.version(),
                               "render": self.options.job})
        self.identity = header.identity()
        del self.identity["scene"]  # each frame has one of its own
        if self.options.any_device:
            del self.identity["kernels"]
        done = {}
        for frame in self.parts:
            path = numbered(self.options.output, frame)
            if os.path.exists(path) and self.is_there(frame, path):
                done[frame] = read_film_header(path).digest
        self.there = set(done)
        self.finished = self.whole
        if done:
            self.say("%d of %d frames are whole and were kept" % (len(done), self.count))
        return done

    def is_there(self, frame, path):
        try:
            header = read_film_header(path)
            self.check_header(header, path)
            return header.scene == self.glim.sample(self.picture(frame)).scene and self.read_whole(path, frame)
        except (FarmError, OSError):
            return False

    def read_whole(self, path, frame):
        """Whether glim can read the film, from which it draws the PNG."""
        picture = {"image": numbered(self.options.png, frame), "exposure": self.options.exposure} if self.options.png else {}
        with tempfile.TemporaryDirectory(dir=self.folder.path) as scratch:
            self.glim.merge([path], os.path.join(scratch, "film.exr"), **picture)
        return True

    def picture(self, frame):
        return {**self.options.job, "frames": "%d:%d" % (frame, frame), "fps": self.options.fps}

    def job(self, frame):
        return {**self.picture(frame), "spp": self.options.spp}

    def samples(self, _frame):
        """Of one pixel."""
        return self.options.spp

    def check(self, _frame, film, name):
        """The header of a frame that may be taken. Refuses (FarmError) others, and (OtherClass) one of other kernels."""
        header = FilmHeader(read_header(film, name), name)
        self.check_header(header, name)
        return header

    def check_header(self, header, name):
        check_identity(header, self.identity, name)
        if header.samples != "0:%d" % self.options.spp or not header.complete:
            raise FarmError("%s: its samples are %s, expected 0:%d" % (name, header.samples, self.options.spp))

    def take(self, frame, _header, film):
        """Keeps a frame that was checked. Refuses (FarmError) a damaged one."""
        new, path = os.path.join(self.folder.pages, "%d.exr" % frame), numbered(self.options.output, frame)
        write_whole(new, film)
        self.read_whole(new, frame)
        publish(new, path)
        self.there.add(frame)

    def holds(self, frame):
        return frame in self.there

    def suspend(self, frame):
        """Takes back a frame that two hosts render differently."""
        self.drop({frame})

    def settle(self):
        pass

    def drop(self, frames):
        """Removes frames whose bits are in doubt. Returns them."""
        for frame in frames & self.there:
            os.unlink(numbered(self.options.output, frame))
        self.there -= frames
        return set(frames)

    def foldable(self):
        return range(0)

    def close(self):
        self.folder.remove()
        return "%s: %d frames, %s, %d samples per pixel" % (self.options.output, self.count, self.header.size, self.options.spp)
