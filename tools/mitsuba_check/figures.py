"""Compares independent renders of two renderers: the ratio of their means, z-tests, errors at equal samples and time to equal
error. Renders are arrays: seed x row x column x channel."""

import math
from statistics import NormalDist

import numpy as np

from study_page.estimates import logarithmic, student

BLOCK = 8
LEVEL = 0.01  # of each family of tests
POWER = 0.95  # with which the test of the means finds the bias that is called detectable
ROUNDING = 2.0 ** -20  # of float32 sums, relative: no noise, as in host/measure/z_test.cpp
RESAMPLES = 2000
CERTAIN = 1e6  # Student's t of a difference without noise; JSON has no infinity


def welch(a, b):
    """Difference of the means over axis 0, its standard error and degrees of freedom (Welch 1947)."""
    va, vb = a.var(axis=0, ddof=1) / len(a), b.var(axis=0, ddof=1) / len(b)
    total = va + vb
    below = va ** 2 / (len(a) - 1) + vb ** 2 / (len(b) - 1)
    freedom = np.divide(total ** 2, below, out=np.full_like(total, len(a) + len(b) - 2), where=below > 0)
    return a.mean(axis=0) - b.mean(axis=0), np.sqrt(total), freedom


def normal_of_student(t, freedom):
    """The normal deviate as improbable as Student's t (Wallace, Bounds on normal approximations to Student's and the
    chi-square distributions, 1959): right to .5 % from 7 degrees of freedom on, to |t| = 6."""
    return np.sign(t) * (8 * freedom + 1) / (8 * freedom + 3) * np.sqrt(freedom * np.log1p(t * t / freedom))


def rounding_of(spp):
    """Mitsuba's film adds samples one by one in float32. Each sum rounds by at most 2^-24, and on average holds half of the light
    (Higham, Accuracy and Stability of Numerical Algorithms, 2002, section 4.2). Measured: 1e-5 at 1,024 samples of .7."""
    return max(ROUNDING, spp * 2.0 ** -25)


def z_of(a, b, rounding):
    """The z of each column, and where there is noise. z is 0 where the difference is rounding, and beyond any limit where it is more
    than that although nothing varies."""
    difference, error, freedom = welch(a, b)
    floor = rounding * np.abs(b).mean(axis=0)
    excess = np.sign(difference) * np.maximum(np.abs(difference) - floor, 0)
    t = np.divide(excess, error, out=np.sign(excess) * CERTAIN, where=error > 0)
    return normal_of_student(t, freedom), error > floor


def sidak_limit(tests):
    return -NormalDist().inv_cdf(0.5 * (1 - (1 - LEVEL) ** (1 / max(tests, 1))))


def ratio_of(a, b):
    """mean(a) / mean(b) of two independent samples, with Student's interval of its logarithm."""
    ma, mb, na, nb = a.mean(), b.mean(), len(a), len(b)
    va, vb = a.var(ddof=1) / na / ma ** 2, b.var(ddof=1) / nb / mb ** 2
    freedom = int((va + vb) ** 2 / (va ** 2 / (na - 1) + vb ** 2 / (nb - 1))) if va + vb > 0 else na + nb - 2
    reach = student(max(1, freedom)) * math.sqrt(va + vb)
    return {"value": ma / mb, "low": ma / mb * math.exp(-reach), "high": ma / mb * math.exp(reach)}


def block_sums(renders, side=BLOCK):
    """Sums over square blocks of pixels, which are smaller at the rim: seed x block x channel."""
    seeds, height, width, channels = renders.shape
    filled = np.zeros((seeds, -(-height // side) * side, -(-width // side) * side, channels))
    filled[:, :height, :width] = renders
    blocks = filled.reshape(seeds, filled.shape[1] // side, side, filled.shape[2] // side, side, channels)
    return blocks.sum(axis=(2, 4)).reshape(seeds, -1, channels)


def test_bias(a, b, spp):
    means_a, means_b = a.mean(axis=(1, 2)), b.mean(axis=(1, 2))
    z, noisy = z_of(block_sums(a), block_sums(b), rounding_of(spp))
    worst = np.unravel_index(np.argmax(np.abs(z)), z.shape)
    across = -(-a.shape[2] // BLOCK)
    mean_z, count = z_of(means_a, means_b, rounding_of(spp))[0], int(np.count_nonzero(noisy))
    errors = welch(means_a, means_b)[1] / np.maximum(means_b.mean(axis=0), 1e-30)
    found = {"mean_z": list(map(float, mean_z)), "mean_limit": sidak_limit(3),
             "detectable_bias": float((sidak_limit(3) + NormalDist().inv_cdf(POWER)) * errors.max()),
             "worst_block": {"z": float(z[worst]), "x": int(worst[0]) % across * BLOCK, "y": int(worst[0]) // across * BLOCK,
                             "channel": "RGB"[worst[1]]},
             "block_limit": sidak_limit(z.size),
             "mean_square": float((z[noisy] ** 2).mean()) if count else 0.0,
             # The channels of a block are not independent: as many terms as there are blocks.
             "mean_square_margin": 4 * math.sqrt(2 / max(1, count / 3))}
    agree = (max(map(abs, mean_z)) <= found["mean_limit"] and abs(z[worst]) <= found["block_limit"] and
             (count == 0 or found["mean_square"] <= 1 + found["mean_square_margin"]))
    ratios = {c: ratio_of(means_a[:, i], means_b[:, i]) for i, c in enumerate("RGB")}
    return {"ratio": {"all": ratio_of(means_a.mean(axis=1), means_b.mean(axis=1)), **ratios},
            "z_test": {"agree": bool(agree), **found}}


def relative_errors(renders, reference):
    """relMSE of each render, from its distance to the mean of that renderer's renders; unbiased in the mean."""
    weight = 1 / (reference ** 2 + 0.01 * reference.mean() ** 2)
    seeds = len(renders)
    return ((renders - renders.mean(axis=0)) ** 2 * weight).mean(axis=(1, 2, 3)) * seeds / (seeds - 1)


def interval(values):
    if values.min() <= 0:
        return {"mean": float(values.mean()), "low": None, "high": None}
    found = logarithmic(float(values.mean()), float(values.std(ddof=1)) / math.sqrt(len(values)), len(values))
    return {key: found[key] for key in ("mean", "low", "high")}


def time_to_equal_error(errors_a, seconds_a, errors_b, seconds_b):
    """How many times longer b takes than a, variance falling as 1 / samples; 95 % of resampled seeds (Efron 1979).
    The median of seconds: a machine may be interrupted, but not sped up."""
    source = np.random.default_rng(1)

    def costs(errors, seconds, picks):
        return errors[picks].mean(axis=-1) * np.median(seconds[picks], axis=-1)

    def resampled(errors, seconds):
        return costs(errors, seconds, source.integers(0, len(errors), (RESAMPLES, len(errors))))
    cost_a, cost_b = (costs(e, s, np.arange(len(e))) for e, s in ((errors_a, seconds_a), (errors_b, seconds_b)))
    if min(cost_a, cost_b) <= 0:
        return {"value": None, "low": None, "high": None}
    ratios = resampled(errors_b, seconds_b) / resampled(errors_a, seconds_a)
    low, high = np.quantile(ratios, (0.025, 0.975))
    return {"value": float(cost_b / cost_a), "low": float(low), "high": float(high)}


def compare_renders(a, seconds_a, b, seconds_b, spp):
    both = 0.5 * (a.mean(axis=0) + b.mean(axis=0))
    errors_a, errors_b = relative_errors(a, both), relative_errors(b, both)
    return {**test_bias(a, b, spp), "relmse": {"glim": interval(errors_a), "mitsuba": interval(errors_b)},
            "time_to_equal_error": time_to_equal_error(errors_a, seconds_a, errors_b, seconds_b)}
