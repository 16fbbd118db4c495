"""Errors of pictures without a reference, and how the efficiencies of two renderers compare. Renders are arrays: seed x row x
column x channel. Estimates are dictionaries {value, low, high}; value is None where there is none."""

import numpy as np

from mitsuba_check.figures import block_sums

TILE = 16  # pixels: errors of neighbours go together, within a caustic for example
EPSILON = 0.01
RESAMPLES = 2000


def weights_of(reference):
    """Noise of the reference raises the weights by up to three times its own relMSE. As the mean of the 2 S renders of both renderers it
    has about 1 / (2 S) of a render's relMSE, and a firefly lowers its own weight. A long render has neither fault."""
    return 1 / (reference ** 2 + EPSILON)


def weights_around(picture, side=5):
    """1 / mean^2 of the square around each pixel, mirrored at the edges; 0 where that is black. For the dark, where EPSILON hides errors."""
    reach = side // 2
    padded = np.pad(picture, ((reach, reach), (reach, reach), (0, 0)), mode="reflect")
    means = np.lib.stride_tricks.sliding_window_view(padded, (side, side), axis=(0, 1)).mean(axis=(-2, -1))
    return np.divide(1, means ** 2, out=np.zeros_like(means), where=means > 0)


def tile_errors(renders, weights):
    """The squared errors of each seed, summed over each tile: seed x tile. Their expectations are the variance between seeds."""
    seeds = len(renders)
    squares = (renders - renders.mean(axis=0)) ** 2 * weights * (seeds / (seeds - 1))
    return block_sums(squares.mean(axis=-1, keepdims=True), TILE)[..., 0]


def pixels_of_tiles(height, width):
    return block_sums(np.ones((1, height, width, 1)), TILE)[0, :, 0]


def draws(source, count):
    """How often each of `count` things is drawn, in each resample."""
    return source.multinomial(count, np.full(count, 1 / count), RESAMPLES).astype(float)


def with_reach(value, resampled):
    low, high = np.quantile(resampled, (0.025, 0.975))
    return {"value": float(value), "low": float(low), "high": float(high)}


def relmse_of(renders, weights):
    """With two renders half of their squared difference."""
    source, errors, pixels = np.random.default_rng(1), tile_errors(renders, weights), pixels_of_tiles(*renders.shape[1:3])
    tiles = draws(source, len(pixels))
    drawn = ((draws(source, len(renders)) @ errors) * tiles).sum(axis=1) / (len(renders) * (tiles @ pixels))
    return with_reach(errors.sum() / (len(renders) * pixels.sum()), drawn)


def spread(values):
    return {"median": float(np.median(values)), "least": float(np.min(values)), "most": float(np.max(values))}


UNKNOWN = {"value": None, "low": None, "high": None}


def compare(errors, pixels, costs):
    """errors: of glim and of Mitsuba, as `tile_errors` has them; costs: seconds of a sample in each round. Seeds and tiles are drawn
    with replacement (Owen, The pigeonhole bootstrap, 2007): intervals are too wide rather than too narrow. Both get the same tiles, and
    the ratio of their costs is taken round by round, since the machine's speed changes."""
    source = np.random.default_rng(1)
    tiles, seeds = draws(source, len(pixels)), [len(e) for e in errors]
    drawn = [((draws(source, s) @ e) * tiles).sum(axis=1) / (s * (tiles @ pixels)) for e, s in zip(errors, seeds)]
    relmse = [e.sum() / (s * pixels.sum()) for e, s in zip(errors, seeds)]
    found = {"relmse": [with_reach(*pair) for pair in zip(relmse, drawn)], "time": None, "samples": UNKNOWN, "efficiency": UNKNOWN}
    if min(map(np.min, costs)) > 0:
        times = costs[0] / costs[1]
        found["time"] = spread(times)
    if min(relmse) > 0 and min(map(np.min, drawn)) > 0:
        value, ratios = relmse[1] / relmse[0], drawn[1] / drawn[0]
        found["samples"] = with_reach(value, ratios)
        if found["time"]:
            rounds = source.integers(0, len(times), (RESAMPLES, len(times)))
            found["efficiency"] = with_reach(value / np.median(times), ratios / np.median(times[rounds], axis=1))
    return found
