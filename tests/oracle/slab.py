"""What a slab of a scattering medium reflects and transmits, by adding and doubling layers (van de Hulst, "Multiple Light Scattering", 1980,
chapter 4). The slab has no interfaces and no end to its sides; the phase function is Henyey and Greenstein's."""

import numpy as np

NODES = 32
THINNEST = 1e-8  # optical depth of the first layer: one scattering there is all but its square


def redistribution(mu, other, g, sign):
    """The phase function's mean over azimuths, of mean 1 over the sphere: onwards (sign 1) or back (-1)."""
    orders = np.arange(2 * NODES)
    p = [np.polynomial.legendre.legval(m, np.eye(2 * NODES)).reshape(2 * NODES, -1) for m in (mu, other)]
    return np.einsum("k,ki,kj->ij", (2 * orders + 1) * float(g) ** orders * float(sign) ** orders, p[0], p[1])


def thin_layer(mu, albedo, g, tau):
    """Its operators by single scattering, before weights: what it reflects, and what it scatters onwards."""
    i, j = mu[:, None], mu[None, :]
    back = -np.expm1(-tau * (1 / i + 1 / j)) / (i + j)
    onwards = np.broadcast_to(tau / (i * j), back.shape)  # of (exp(-tau/i) - exp(-tau/j)) / (i - j), to the order of tau
    return [albedo / 4 * redistribution(mu, mu, g, sign) * part for sign, part in ((-1, back), (1, onwards))]


def slab(albedo, tau, g, cosines):
    """(reflectance, transmittance) in light of the same radiance from all directions of one side, as seen at these cosines; the light that
    passes unscattered is part of the second."""
    x, w = np.polynomial.legendre.leggauss(NODES)
    mu = np.concatenate([(x + 1) / 2, cosines])
    weights = 2 * mu * np.concatenate([w / 2, np.zeros(len(cosines))])  # directions that are only seen weigh nothing
    doublings = max(0, int(np.ceil(np.log2(tau / THINNEST))))
    thin = tau / 2.0**doublings
    back, onwards = (part * weights for part in thin_layer(mu, albedo, g, thin))
    onwards = onwards + np.diag(np.exp(-thin / mu))
    for _ in range(doublings):
        between = np.linalg.solve(np.eye(len(mu)) - back @ back, np.concatenate([onwards, back @ onwards], axis=1))
        half = len(mu)
        back, onwards = back + onwards @ between[:, half:], onwards @ between[:, :half]
    seen = slice(NODES, None)
    return back.sum(axis=1)[seen], onwards.sum(axis=1)[seen]
