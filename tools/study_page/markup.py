"""HTML from plain values: numbers with their intervals, tables, pictures."""

import base64
import html
import os

FLOOR_SHARE = 0.01  # a reference's noise above this share of a value is shown


def escape(text):
    return html.escape(str(text))


def number(value, digits=3):
    """Rounded to as many digits; large numbers in groups of three."""
    if value is None:
        return "unknown"
    if value == 0:
        return "0"
    if 1e-3 <= abs(value) < 1e7:
        text = "%.*g" % (digits, value)
        return "{:,.0f}".format(float(text)) if "e" in text or abs(value) >= 1000 else text
    return "%.*e" % (digits - 1, value)


def percent(share, digits=3):
    return number(100 * share, digits) + " %"


def signed_percent(share):
    return "%+.2f %%" % (100 * share)


def bracket(interval, form=number):
    """A mean with its 95 % interval. Says so if there is only one value, or if noise leaves no mean."""
    if interval["mean"] is None:
        return "lost in the long render's noise"
    if interval["low"] is None:
        return "%s (one run)" % form(interval["mean"])
    return "%s [%s, %s]" % tuple(form(interval[key]) for key in ("mean", "low", "high"))


def timing(spread, form=number):
    return "%s (%s to %s)" % tuple(form(spread[key]) for key in ("median", "least", "most"))


def relmse(summary):
    """relMSE of one run or several, with the noise of the long render where that is worth telling."""
    value = summary["relmse"] if isinstance(summary["relmse"], dict) else {"mean": summary["relmse"], "low": None}
    noise = summary["referenceNoise"]
    if value["mean"] <= 0:
        return "below the long render's noise %s" % number(noise)
    text = bracket(value) if value["low"] is not None else number(value["mean"])
    if noise > FLOOR_SHARE * value["mean"]:
        text += " after subtracting %s of the long render" % number(noise)
    return text


def table(headers, rows, caption=None):
    """Cells are text; the first column is the row's header."""
    parts = ["<table>"]
    if caption:
        parts.append("<caption>%s</caption>" % escape(caption))
    parts.append("<thead><tr>%s</tr></thead><tbody>" % "".join('<th scope="col">%s</th>' % escape(h) for h in headers))
    for first, *others in rows:
        parts.append('<tr><th scope="row">%s</th>%s</tr>' %
                     (escape(first), "".join("<td>%s</td>" % escape(cell) for cell in others)))
    return "\n".join(parts) + "</tbody></table>\n"


def paragraph(text):
    return "<p>%s</p>\n" % escape(text)


def heading(text):
    return "<h3>%s</h3>\n" % escape(text)


def gallery(figures):
    return '<div class="gallery">\n%s</div>\n' % "".join(figures)


def plot(svg, caption):
    return '<figure class="plot">%s<figcaption>%s</figcaption></figure>\n' % (svg, escape(caption))


class Pictures:
    """Reads pictures of the study's folder into the page."""

    def __init__(self, folder):
        self.folder = folder

    def image(self, name, alt):
        with open(os.path.join(self.folder, "pictures", name), "rb") as file:
            data = base64.b64encode(file.read()).decode()
        return '<img src="data:image/png;base64,%s" alt="%s">' % (data, escape(alt))

    def figure(self, title, run):
        """A picture with its caption: seconds, Mrays/s, relMSE."""
        caption = "%s s, %s Mrays/s, relMSE %s" % (number(run["seconds"]), number(run["mrays"]), relmse(run))
        return "<figure>%s<figcaption><b>%s</b><br>%s</figcaption></figure>\n" % (
            self.image(run["picture"], title), escape(title), escape(caption))

    def rates(self, title, run):
        return "<figure>%s<figcaption><b>%s</b><br>blue few, red many; mean %s samples</figcaption></figure>\n" % (
            self.image(run["rates"], title), escape(title), number(run["spp"]))
