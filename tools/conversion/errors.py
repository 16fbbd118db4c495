"""What ends a conversion with one sentence."""


def as_line(text):
    """A line that a terminal shows and does not obey. It holds words of files, which may be long; then its middle is lost."""
    text = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)
    return text if len(text) <= 2000 else text[:1000] + "..." + text[-900:]


class ConversionError(Exception):
    def __init__(self, sentence):
        super().__init__(as_line(sentence))
