"""Estimates with their uncertainty. Intervals are dictionaries {mean, low, high, n}: they go into study.json as they are."""

import math
import statistics

LEVEL = 0.95
# Two-sided 95 % points of Student's t for 1 to 30 degrees of freedom.
STUDENT = (12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646, 2.3060, 2.2622, 2.2281, 2.2010, 2.1788, 2.1604, 2.1448,
           2.1314, 2.1199, 2.1098, 2.1009, 2.0930, 2.0860, 2.0796, 2.0739, 2.0687, 2.0639, 2.0595, 2.0555, 2.0518, 2.0484,
           2.0452, 2.0423)


def student(degrees):
    """Beyond the table by Cornish and Fisher's expansion (Abramowitz and Stegun 26.7.5), which is right to 1e-5 there."""
    if degrees <= len(STUDENT):
        return STUDENT[degrees - 1]
    z = statistics.NormalDist().inv_cdf(0.5 + LEVEL / 2)
    return z + (z ** 3 + z) / (4 * degrees) + (5 * z ** 5 + 16 * z ** 3 + 3 * z) / (96 * degrees ** 2)


def interval(mean, low, high, n):
    return {"mean": mean, "low": low, "high": high, "n": n}


def mean_interval(values):
    """Student's interval of the mean. One value has no interval: low and high are None."""
    values = list(values)
    mean = statistics.fmean(values)
    if len(values) < 2:
        return interval(mean, None, None, len(values))
    reach = student(len(values) - 1) * statistics.stdev(values) / math.sqrt(len(values))
    return interval(mean, mean - reach, mean + reach, len(values))


def complement(share):
    """The interval of 1 - share."""
    low, high = (None, None) if share["low"] is None else (1 - share["high"], 1 - share["low"])
    return interval(1 - share["mean"], low, high, share["n"])


def standard_error(values):
    return statistics.stdev(values) / math.sqrt(len(values)) if len(values) > 1 else None


def spread(values):
    """Median, least and most of repeated timings. Their errors are one-sided and not independent, so this claims no interval."""
    return {"median": statistics.median(values), "least": min(values), "most": max(values), "n": len(values)}


def spread_of_ratio(above, below):
    """The ratio of the medians; it ranges from the least over the most to the most over the least."""
    return {"median": above["median"] / below["median"], "least": above["least"] / below["most"],
            "most": above["most"] / below["least"], "n": min(above["n"], below["n"])}


def logarithmic(mean, error, n):
    """Student's interval taken to the logarithm (the delta method), so that it stays positive."""
    factor = math.exp(student(n - 1) * error / mean)
    return interval(mean, mean / factor, mean * factor, n)


def positive_interval(values):
    """The interval of a mean that cannot be negative, such as an error or a variance; plain Student's if an estimate is negative."""
    values = list(values)
    if len(values) < 2 or min(values) <= 0:
        return mean_interval(values)
    return logarithmic(statistics.fmean(values), standard_error(values), len(values))


def ratio_of_means(numerators, denominators):
    """The ratio of two means over pairs by seed, with the ratio estimator's linearised error (Cochran 1977, section 6.3). There is no
    ratio if one side has no positive mean once its noise is subtracted."""
    below, count = statistics.fmean(denominators), len(numerators)
    if below <= 0 or statistics.fmean(numerators) <= 0:
        return interval(None, None, None, count)
    ratio = statistics.fmean(numerators) / below
    if count < 2:
        return interval(ratio, None, None, count)
    return logarithmic(ratio, standard_error([(a - ratio * b) / below for a, b in zip(numerators, denominators)]), count)


def fit_line(xs, ys):
    """Least squares: (a, b) of y = a + b x."""
    middle = statistics.fmean(xs)
    square = sum((x - middle) ** 2 for x in xs)
    slope = sum((x - middle) * y for x, y in zip(xs, ys)) / square
    return statistics.fmean(ys) - slope * middle, slope


def fit_logarithm(counts, values):
    """y = a + b log2(n), with the share of the variance of y that the line explains."""
    xs = [math.log2(n) for n in counts]
    a, b = fit_line(xs, values)
    middle = statistics.fmean(values)
    total = sum((y - middle) ** 2 for y in values)
    rest = sum((y - a - b * x) ** 2 for x, y in zip(xs, values))
    return {"a": a, "b": b, "r2": 1 - rest / total if total > 0 else 1.0}


def fit_slope(counts, series):
    """Slope of log(value) against log(count): one line per seed, since a seed's points share samples; then the mean."""
    xs = [math.log(n) for n in counts]
    if len(xs) < 2:
        return interval(None, None, None, len(series))
    return mean_interval([fit_line(xs, [math.log(v) for v in values])[1] for values in series])
