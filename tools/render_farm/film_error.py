"""How wrong a film still is by its own estimate, and when that is looked at."""

UNKNOWN_SAMPLES = 1024  # a film with a target ends after so many if its error is still unknown, as by `glim render`


def is_rung(pages):
    """Whether a film of so many pages is looked at. That must not depend on how fast workers are: every page at first, then a tenth more."""
    rung = 1
    while rung < pages:
        rung = next_rung(rung)
    return rung == pages


def next_rung(pages):
    rung = 1
    while rung <= pages:
        rung += -(-rung // 10)
    return rung


class FilmError:
    """Estimates: the relMSE, and the RMSE as a share of the picture's mean."""

    def __init__(self, relmse, rmse):
        self.relmse, self.rmse = relmse, rmse

    def __str__(self):
        return "relMSE %.3g, RMSE %.3g %% of the mean" % (self.relmse, 100 * self.rmse)

    def times_to(self, target):
        """By what factor the samples must grow to reach the target; at most 1: it is reached. What is None in `target` is no target."""
        times = [] if target.relmse is None else [self.relmse / target.relmse]
        return max(times if target.rmse is None else [*times, (self.rmse / target.rmse) ** 2])


def read_film_error(glim, path):
    """The FilmError of a film, or None if it is unknown: of too few samples, of a black picture, or where float32 does not hold it."""
    estimate = glim.merge([path])["estimate"]
    return estimate and FilmError(estimate["relmse"], estimate["rmseOfMean"])
