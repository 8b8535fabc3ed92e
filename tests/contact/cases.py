"""Where to look: random points, and the boundary cases on which grids put their nodes.

Every function takes a random generator and a number of points and returns n0_bar, b_bar, phi.
The samples are small enough for every run; see `tests.scale`.
"""

from itertools import product

import numpy as np

from fcm.contact.loop import sequences

from ..scale import SCALE

FIGURE_7 = ["SEP", "SEN", "SP", "SN", "SNEP", "SPEN", "SEPEN", "SENEP", "SPENEP", "SNEPEN"]
SEQUENCES = ["E", "EPEN", "S", "SE", *FIGURE_7]

PHASES = np.pi * np.array([0.0, 0.5, 1.0, 1.5, 2.0, -0.5, -1.0, -2.0, 3.0, 1.0 / 3.0, 5.0 / 6.0, 1e5])
VARIATIONS = np.array([0.0, 1e-300, 1e-12, 0.4, 1.0 - 2.0**-53, 1.0, 1.0 + 2.0**-52, 2.0, 1e3])


def points(name, n):
    """n points (or as many as SCALE makes of them) of one of the classes below, the same in every run."""
    rng = np.random.default_rng(sum(map(ord, name)))
    n0, b, phi = globals()[name](rng, int(n * SCALE))
    return n0, np.abs(b), phi


def linear(rng, n):
    return rng.uniform(-3.0, 4.0, n), rng.uniform(0.0, 4.0, n), rng.uniform(-7.0, 7.0, n)


def logarithmic(rng, n):
    n0 = rng.choice([-1.0, 1.0], n) * 10.0 ** rng.uniform(-12.0, 3.0, n)
    return n0, 10.0 ** rng.uniform(-12.0, 3.0, n), rng.uniform(-7.0, 7.0, n)


def turned_often(rng, n):
    n0, b, _ = linear(rng, n)
    return n0, b, rng.choice([-1.0, 1.0], n) * 10.0 ** rng.uniform(1.0, 6.0, n)


def _slip_limits(b, phi):
    return np.hypot(1.0 - b * np.cos(phi), b * np.sin(phi)), np.hypot(1.0 + b * np.cos(phi), b * np.sin(phi))


def _preloads(b, phi):
    """Where something changes: opens, never closes, just slips, cannot be centred; and a few between."""
    ell_1, ell_2 = _slip_limits(b, phi)
    named = [b, -b, 0.5 * (ell_1 + ell_2), np.maximum(ell_1, ell_2), np.minimum(ell_1, ell_2)]
    plain = [0.0 * b, 0.5 * b, -0.5 * b, 1.0 - b, b - 1.0, 0.0 * b + 1.0, 0.0 * b + 1e-300]
    return np.array(named + plain)


def all_boundaries():
    """Every combination of the special values, exactly."""
    b, phi = np.array(list(product(VARIATIONS, PHASES))).T
    n0 = _preloads(b, phi)
    return n0.ravel(), np.broadcast_to(b, n0.shape).ravel(), np.broadcast_to(phi, n0.shape).ravel()


def _miss(rng, n, least=-17.0):
    """Zero, or a miss of either sign from 1e-17 to 1e-5."""
    return rng.choice([0.0, -1.0, 1.0], n) * 10.0 ** rng.uniform(least, -5.0, n)


def near_boundaries(rng, n):
    """The special values and others, each missed by nothing, a few units in the last place, or up to 1e-5."""
    b = np.where(rng.random(n) < 0.5, rng.choice(VARIATIONS, n), 10.0 ** rng.uniform(-3.0, 3.0, n))
    b = np.abs(b * (1.0 + _miss(rng, n)))
    phi = np.where(rng.random(n) < 0.7, rng.choice(PHASES, n) + _miss(rng, n), rng.uniform(-7.0, 7.0, n))
    with np.errstate(all="ignore"):
        n0 = _preloads(b, phi)[rng.integers(0, 12, n), np.arange(n)]
    relative = rng.random(n) < 0.5
    return np.where(relative, n0 * (1.0 + _miss(rng, n)), n0 + _miss(rng, n)), b, phi


def near_degenerate(rng, n):
    """b = 1 with phi = 0 or pi, where a limit vanishes: b, phi and n0 missed independently, at all scales."""
    miss = _miss(rng, n) * 10.0 ** rng.uniform(0.0, 4.0, n)
    b = 1.0 + miss
    phi = np.pi * rng.integers(-2, 3, n)
    phi = phi + np.where(rng.random(n) < 0.4, miss * rng.choice([-1.0, 1.0, 2.0], n), _miss(rng, n))
    n0 = np.choose(rng.integers(0, 5, n), [b, -b, 0.0 * b, 1.0 - b, rng.uniform(-1.1, 2.2, n)])
    return n0 + _miss(rng, n), b, phi


def faint(rng, n):
    """Normal load that hardly varies, down to 1e-300."""
    b = 10.0 ** rng.uniform(-300.0, -3.0, n)
    n0 = np.choose(
        rng.integers(0, 4, n), [b, -b, b * rng.uniform(-1.0, 1.0, n), 1.0 + b * rng.uniform(-1, 1, n)]
    )
    return n0, b, np.where(rng.random(n) < 0.5, rng.choice(PHASES, n), rng.uniform(-7.0, 7.0, n))


def between_sequences(rng, n, largest=2.0):
    """On the border between two sequences, to the last bit or nearly.

    There a region has zero length, two events coincide, the slip limit is just met, or contact begins
    just on the limit between stick and slip. Found by bisection between random neighbours.
    """
    m = 6 * n
    b = 10.0 ** rng.uniform(-2.0, largest, m)
    n0 = np.where(rng.random(m) < 0.5, b * rng.uniform(-1.1, 1.1, m), b + rng.uniform(-1.0, 1.0, m))
    here = np.array([n0, b, rng.uniform(-3.2, 3.2, m)])
    there = here.copy()
    axis = rng.integers(0, 3, m)
    there[axis, np.arange(m)] += rng.choice([-1.0, 1.0], m) * 10.0 ** rng.uniform(-3.0, 0.0, m)
    there[1] = np.abs(there[1])
    name = sequences(*here)
    differ = np.flatnonzero(name != sequences(*there))[:n]
    here, there, name = here[:, differ], there[:, differ], name[differ]
    for _ in range(60):
        middle = here + 0.5 * (there - here)
        same = sequences(*middle) == name
        here, there = np.where(same, middle, here), np.where(same, there, middle)
    found = np.where(rng.random(differ.size) < 0.5, here, there)
    return (
        found[0] + np.where(rng.random(differ.size) < 0.5, _miss(rng, differ.size), 0.0),
        found[1],
        found[2],
    )


def between_sequences_at_large_b(rng, n):
    return between_sequences(rng, n, largest=12.0)


def large(rng, n, exponent=16.0):
    """Large variation of the normal load; half of the points within a distance of order one of opening."""
    b = 10.0 ** rng.uniform(3.0, exponent, n)
    near = np.pi * rng.integers(-2, 3, n) + rng.uniform(-5.0, 5.0, n) * b ** rng.choice(
        [-0.25, -0.5, -1.0], n
    )
    phi = np.choose(rng.integers(0, 3, n), [rng.uniform(-7.0, 7.0, n), rng.choice(PHASES, n), near])
    distance = rng.choice([-1.0, 0.0, 1.0], n) * 10.0 ** rng.uniform(-3.0, 2.0, n)
    n0 = np.choose(
        rng.integers(0, 4, n), [b + distance, b + distance, distance - b, b * rng.uniform(-1, 1, n)]
    )
    return n0, b, phi


def largest(rng, n):
    return large(rng, n, exponent=300.0)
