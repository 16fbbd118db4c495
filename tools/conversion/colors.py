"""Colours of vertices."""


def to_linear(value):
    """From sRGB (IEC 61966-2-1), where both OBJ and PLY have what scanners and painters show, to glTF's linear values."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4
