"""One picture of many bands of rows."""

from render_farm.errors import FarmError
from render_farm.picture import Picture


class Bands(Picture):
    """Its parts are bands, from the top. The film of a band has all samples of its rows, and the last step puts all of them together. So a
    worker folds its pages itself, and sends a film once, however many samples there are."""

    part = "band"

    def count_parts(self):
        if self.options.bands > self.header.height:
            raise FarmError("--bands %d: the picture has %d rows" % (self.options.bands, self.header.height))
        return self.options.bands

    def pages_of(self, header):
        if header.samples != self.range(0) or not header.complete or header.rows != super().rows(0):
            raise FarmError("%s: is not the whole picture" % header.name)
        return self.count

    def range(self, _band):
        return "0:%d" % self.options.spp

    def bounds(self, band):
        return self.header.height * band // self.count, self.header.height * (band + 1) // self.count

    def rows(self, band):
        return "%d:%d" % self.bounds(band)

    def job(self, band):
        return {**super().job(band), "rows": self.rows(band)}

    def samples(self, band):
        begin, end = self.bounds(band)
        return self.options.spp * (end - begin) / self.header.height

    def foldable(self):
        return self.parts if not self.folded and len(self.files) == self.count else range(0)
