"""What ends a conversion with one sentence."""


class ConversionError(Exception):
    pass
