"""Images as glTF samples them: decoded to linear numbers, and prepared for a lookup that clamps coordinates."""

import numpy as np

from .materials import MIRRORED, REPEAT

SRGB = {"baseColorTexture", "emissiveTexture", "specularColorTexture", "sheenColorTexture", "diffuseTransmissionColorTexture"}


def linear_from_srgb(s):
    """IEC 61966-2-1."""
    return np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4)


def to_linear(pixels, name):
    """Whole numbers, row x column x 1 to 4 channels, to RGBA in [0, 1] for the texture slot of that name."""
    pixels = pixels.reshape(*pixels.shape[:2], -1)
    values = pixels / float(np.iinfo(pixels.dtype).max)
    alpha = values[..., -1:] if values.shape[-1] in (2, 4) else np.ones_like(values[..., :1])
    colors = values[..., :3] if values.shape[-1] > 2 else np.repeat(values[..., :1], 3, axis=-1)
    return np.concatenate([linear_from_srgb(colors) if name in SRGB else colors, alpha], axis=-1)


def padded(pixels, wraps):
    """With the opposite edge beside each edge that repeats, so that a lookup that clamps interpolates across it."""
    for axis, wrap in ((1, wraps[0]), (0, wraps[1])):
        if wrap == REPEAT:
            pixels = np.concatenate([np.take(pixels, [-1], axis), pixels, np.take(pixels, [0], axis)], axis)
    return pixels


def wrapped(t, size, wrap, floor):
    """A coordinate of the image `padded` in [0, 1]; `floor` is that of the numbers at hand."""
    if wrap == REPEAT:
        return ((t - floor(t)) * size + 1) / (size + 2)
    return abs(t - 2 * floor(0.5 * t + 0.5)) if wrap == MIRRORED else t


def rows_for_mitsuba(pixels):
    """A map with texel-centred rows as Mitsuba's envmap has it, whose outermost rows lie at the poles: by the same linear pieces."""
    height = len(pixels)
    place = np.clip(np.arange(2 * height + 1) / 2 - 0.5, 0, height - 1)
    low = np.minimum(place.astype(int), max(height - 2, 0))
    weight = (place - low)[:, None, None]
    return pixels[low] * (1 - weight) + pixels[np.minimum(low + 1, height - 1)] * weight
