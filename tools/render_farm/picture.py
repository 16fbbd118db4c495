"""One picture of many pages."""

import math
import os
import re

from render_farm.arguments import PAGE
from render_farm.errors import FarmError
from render_farm.exr_header import FilmHeader, read_film_header, read_header
from render_farm.film_error import UNKNOWN_SAMPLES, is_rung, next_rung, read_film_error
from whole_file import publish, write_whole

BATCH = 16  # pages that are folded at a time: each fold writes the film anew


class OtherClass(FarmError):
    """A film of other kernels or of a device that rounds differently: not wrong, but not of this picture's bits."""


def end_of(samples):
    """The end of samples as in "0:256 256:512"; they must begin at 0 and leave nothing out."""
    end = 0
    for text in samples.split():
        begin, next_end = map(int, text.split(":"))
        if begin != end:
            raise FarmError("its samples are %s, expected all from 0" % samples)
        end = next_end
    return end


def check_identity(header, identity, name):
    """Refuses (FarmError) a film of another picture, in what `identity` names. `name`: whose film it is."""
    for what, expected in identity.items():
        found = header.identity()[what]
        if found != expected:
            kind = OtherClass if what == "kernels" else FarmError
            raise kind("%s: its %s is %s, expected %s" % (name, what, found, expected))


class Picture:
    """Its pages are parts 0 to count - 1. They are folded in order by `glim merge`, many at a time. Memory and disk hold those alone that
    are not folded yet."""

    part = "page"

    def __init__(self, options, glim, folder, say):
        self.options, self.glim, self.folder, self.say = options, glim, folder, say
        self.all = self.count = 0  # count: of the pages needed, fewer once a target is reached; known once it is open
        self.folded = 0  # pages in folder.film
        self.files = {}  # of pages that are not folded, by page
        self.doubts = os.path.join(folder.path, "doubts")  # is there while a page is in dispute that is folded
        self.arithmetic = None  # of the picture's class; known from the first page on
        self.error = None  # of the folded pages
        self.finished = False

    @property
    def parts(self):
        return range(self.count)

    def count_parts(self):
        """Refuses (FarmError) a plan that does not fit the picture."""
        return -(-self.options.spp // PAGE)

    def open(self):
        """Finds out what is asked and what is done. Returns the digests of the pages that are rendered already."""
        self.header = self.glim.sample(self.options.job)
        self.pixels = self.header.pixels
        self.identity = self.header.identity()
        if self.options.any_device:
            del self.identity["kernels"]
        target = self.options.target
        self.all = self.count = self.count_parts()
        self.folder.hold({"samples": self.options.spp, "target": target and vars(target), "bands": self.options.bands,
                          **self.header.identity()},
                         {"plan": {"%ss" % self.part: self.count}, "glim": self.glim.version(),
                          "render": self.options.job})
        if self.is_there():
            self.say("%s is whole and was kept" % self.options.output)
            self.finished = True
            return {}
        self.drop_doubtful()
        done = self.read_folded()
        self.judge()
        done.update(self.read_pages())
        return done

    def is_there(self):
        """Whether the picture is whole already: a run may have been killed before it could remove the folder."""
        try:
            header = read_film_header(self.options.output)
            check_identity(header, self.identity, self.options.output)
            pages = self.pages_of(header)
            whole = self.is_end(pages, self.options.output)
        except (FarmError, OSError):
            return False
        if not whole or self.merge([self.options.output], self.folder.film, **self.png()) is None:
            self.error = None
            return False
        self.count = pages
        return True

    def pages_of(self, header):
        """Refuses (FarmError) a film that ends within a page."""
        end = end_of(header.samples)
        if not header.complete or end > self.options.spp or (end % PAGE and end != self.options.spp):
            raise FarmError("%s: its samples are %s" % (header.name, header.samples))
        return -(-end // PAGE)

    def is_end(self, pages, film):
        """Whether the film of so many pages is the picture. Finds out its error."""
        self.error = read_film_error(self.glim, film)
        reached = self.options.target and is_rung(pages) and self.error and self.error.times_to(self.options.target) <= 1
        unknown = self.options.target and not self.error and is_rung(pages) and pages * PAGE >= UNKNOWN_SAMPLES
        return bool(reached or unknown) or pages == self.all

    @property
    def expected(self):
        """How many pages it will have, as far as is known."""
        if self.options.target is None or self.error is None:
            return self.count
        return min(self.count, math.ceil(self.folded * max(1, self.error.times_to(self.options.target))))

    def judge(self):
        if self.folded and self.is_end(self.folded, self.folder.film):
            self.count = self.folded

    def drop_doubtful(self):
        """Two hosts differed on a page that was folded, and the run ended before it knew which was right."""
        if os.path.exists(self.doubts) and os.path.exists(self.folder.film):
            self.drop_file(self.folder.film, FarmError("%s: hosts differed on a page of it" % self.folder.film))
        self.settle()

    def read_folded(self):
        if not os.path.exists(self.folder.film):
            return {}
        try:
            header = read_film_header(self.folder.film)
            check_identity(header, self.identity, self.folder.film)
            self.folded, self.arithmetic = self.pages_of(header), header.arithmetic
        except (FarmError, OSError) as error:
            self.drop_file(self.folder.film, error)
            return {}
        return {page: header.digest for page in range(self.folded)}

    def read_pages(self):
        done = {}
        for name in sorted(os.listdir(self.folder.pages)):
            path = os.path.join(self.folder.pages, name)
            match = re.fullmatch(r"([0-9]{5,})\.([0-9a-f]{64})\.exr", name)
            if not match or int(match[1]) < self.folded or int(match[1]) in done:
                os.unlink(path)
                continue
            try:
                with open(path, "rb") as file:
                    header = self.check(int(match[1]), file.read(), path)
                if header.digest != match[2]:
                    raise FarmError("%s: its digest is %s" % (path, header.digest))
            except (FarmError, OSError) as error:
                self.drop_file(path, error)
                continue
            self.arithmetic = self.arithmetic or header.arithmetic
            done[int(match[1])] = header.digest
            self.files[int(match[1])] = path
        return done

    def drop_file(self, path, error):
        self.say("%s; it is rendered again" % error)
        os.unlink(path)

    def range(self, page):
        """The samples that its film must have."""
        return "%d:%d" % (page * PAGE, min((page + 1) * PAGE, self.options.spp))

    def rows(self, _page):
        """The rows that its film must have."""
        return "0:%d" % self.header.height

    def job(self, page):
        """What `glim serve` is asked to render, but for where the film goes."""
        return {**self.options.job, "samples": self.range(page)}

    def samples(self, page):
        """Of one pixel."""
        return min(PAGE, self.options.spp - page * PAGE)

    def check(self, page, film, name):
        """The header of a page that may be taken. Refuses (FarmError) another's, and (OtherClass) one of another class."""
        header = FilmHeader(read_header(film, name), name)
        check_identity(header, self.identity, name)
        if header.samples != self.range(page) or not header.complete:
            raise FarmError("%s: its samples are %s, expected %s" % (name, header.samples, self.range(page)))
        if header.rows != self.rows(page):
            raise FarmError("%s: its rows are %s, expected %s" % (name, header.rows, self.rows(page)))
        if not self.options.any_device and self.arithmetic not in (None, header.arithmetic):
            raise OtherClass("%s: its device rounds differently: its arithmetic is %s, expected %s"
                             % (name, header.arithmetic, self.arithmetic))
        return header

    def take(self, page, header, film):
        """Keeps a page that was checked."""
        path = os.path.join(self.folder.pages, "%05d.%s.exr" % (page, header.digest))
        write_whole(path, film)
        self.arithmetic = self.arithmetic or header.arithmetic
        self.files[page] = path

    def holds(self, page):
        return page < self.folded or page in self.files

    def suspend(self, page):
        """Takes back a page that two hosts render differently. If it is folded, it may turn out right."""
        if page in self.files:
            os.unlink(self.files.pop(page))
        elif page < self.folded:
            write_whole(self.doubts, b"")

    def settle(self):
        """No page is in dispute any more."""
        if os.path.exists(self.doubts):
            os.unlink(self.doubts)

    def drop(self, pages):
        """Forgets pages whose bits are in doubt. Returns all that is to be rendered again for that: if one is folded, all folded ones."""
        again = set(pages)
        if any(page < self.folded for page in pages):
            self.say("%ss in doubt are folded already: the picture begins anew" % self.part)
            again |= set(range(self.folded))
            os.unlink(self.folder.film)
            self.folded, self.count, self.error = 0, self.all, None
        for page in pages & self.files.keys():
            os.unlink(self.files.pop(page))
        self.forget_class()
        return again

    def forget_class(self):
        """Without a page, the next one decides the class again."""
        if not self.folded and not self.files:
            self.arithmetic = None

    def foldable(self):
        """The next pages to fold, if all of them are there."""
        end = min(self.folded + BATCH, self.count, next_rung(self.folded) if self.options.target else self.count)
        pages = range(self.folded, end)
        return pages if all(page in self.files for page in pages) else range(0)

    def fold(self, pages):
        """Returns pages that turned out damaged, and others to be rendered again."""
        batch = [self.files[page] for page in pages]
        before = [self.folder.film] if self.folded else []
        merged = self.merge(before + batch, self.folder.film)
        if merged is None:
            return self.drop_damaged(before, batch)
        if not merged["exact"] and not self.options.any_device:
            raise FarmError("%ss %d to %d do not fold exactly" % (self.part, pages[0], pages[-1]))
        for page in pages:
            os.unlink(self.files.pop(page))
        self.folded = pages.stop
        self.judge()
        return set(), set()

    def merge(self, films, output, **options):
        """What the merged film is, or None if one of the films is damaged or of another picture."""
        try:
            return self.glim.merge(films, output, **options)
        except FarmError as error:
            if error.file not in films:
                raise
            return None

    def drop_damaged(self, before, batch):
        damaged, again, trial = set(), set(), os.path.join(self.folder.path, "trial.exr")
        for page, film in zip(range(self.folded, self.folded + len(batch)), batch):
            if self.merge([film], trial) is None:
                self.drop_file(film, FarmError("%s: is damaged" % film))
                del self.files[page]
                damaged.add(page)
        self.forget_class()
        if before and self.merge(before, trial) is None:
            self.say("%s: is damaged" % before[0])
            again = self.drop({0})
        if not damaged | again:
            raise FarmError("glim cannot merge the films in %s" % self.folder.pages)
        return damaged, again

    @property
    def has_class(self):
        return self.arithmetic is not None

    @property
    def whole(self):
        return self.folded == self.count

    def publish(self):
        """Gives the whole picture its name."""
        if self.options.png and self.merge([self.folder.film], self.folder.film, **self.png()) is None:
            raise FarmError("%s: is damaged" % self.folder.film)
        beyond = [page for page in self.files if page >= self.count]
        if self.options.target:
            reached = self.error and self.error.times_to(self.options.target) <= 1
            state = "reached" if reached else "not reached" if self.error else "not reached, for the error is unknown"
            self.say("the target is %s; pages beyond that were not needed: %d" % (state, len(beyond)))
        publish(self.folder.film, self.options.output)
        self.finished = True

    def png(self):
        return {"image": self.options.png, "exposure": self.options.exposure} if self.options.png else {}

    def close(self):
        self.folder.remove()
        error = ", estimated %s" % self.error if self.error else ""
        return "%s: %s, %s samples per pixel%s" % (self.options.output, self.header.size, self.range(self.count - 1).partition(":")[2], error)
