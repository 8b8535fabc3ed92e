"""Motions of several harmonics on which the contact is tried: random ones, and those on the boundaries."""

from dataclasses import dataclass, replace

import numpy as np

from fcm import periodic_forces

from ..scale import SCALE
from . import periodic_march


@dataclass(frozen=True)
class Case:
    """The arguments of `periodic_forces`."""

    u: np.ndarray
    v: np.ndarray
    mu: float = 0.5
    k_u: float = 1.0
    k_v: float = 1.0
    n_0: float = 1.0

    def arguments(self):
        return self.u, self.v, self.mu, self.k_u, self.k_v, self.n_0

    def forces(self, **options):
        return periodic_forces(*self.arguments(), **options)


def decaying(rng, harmonics, decay):
    """A complex coefficient for each harmonic, the mean first."""
    x = rng.standard_normal((2, harmonics)) * np.arange(1.0, harmonics + 1.0) ** -decay
    return np.concatenate(([rng.standard_normal()], x[0] + 1j * x[1]))


def random_case(rng, most=15):
    """1 to `most` harmonics; load variations from a hundredth of the tangential forces to a hundred times."""
    harmonics, decay = int(rng.integers(1, most + 1)), rng.uniform(0.7, 3.0)
    k_v = 10.0 ** rng.uniform(-2.0, 2.0)
    n_0 = k_v * (rng.normal(0.0, 2.0) if rng.random() < 0.7 else 10.0 ** rng.uniform(-1.0, 1.0))
    u, v = decaying(rng, harmonics, decay), decaying(rng, harmonics, decay)
    return Case(u, v, rng.uniform(0.1, 1.0), 10.0 ** rng.uniform(-0.5, 0.5), k_v, n_0)


def random_cases(n, seed=0, most=15):
    rng = np.random.default_rng(seed)
    return [random_case(rng, most) for _ in range(int(n * SCALE))]


def cosines(*coefficients):
    return np.array(coefficients, dtype=complex)


def powers_of_versine(power):
    """Coefficients of (1 - cos(theta))**power / 2**power, whose zero is of twice that order."""
    theta = 2.0 * np.pi * np.arange(64) / 64
    X = np.fft.rfft(((1.0 - np.cos(theta)) / 2.0) ** power)[: power + 1] / 64
    return np.concatenate((X[:1], 2.0 * X[1:]))


SINE, COSINE = cosines(0, -1j), cosines(0, 1)
THIRD, FOURTH = cosines(0, 0, 0, 1), cosines(0, 0, 0, 0, -1j)
MIXED = cosines(0.3, 1, -0.4j, 0.2, 0, 0.1 + 0.1j)
STILL = cosines(0)

BOUNDARIES = {
    "no motion of v": Case(MIXED, STILL, n_0=1.0),
    "no motion of v, no load": Case(MIXED, STILL, n_0=0.0),
    "no motion of v, a gap": Case(MIXED, STILL, n_0=-1.0),
    "no normal stiffness": Case(MIXED, MIXED[::-1], k_v=0.0),
    "no motion of u": Case(STILL, MIXED),
    "no motion of u, but a mean": Case(cosines(3.0), MIXED, n_0=5.0),
    "no motion of u, it opens": Case(cosines(3.0), MIXED, n_0=0.1),
    "no motion at all": Case(cosines(0.2), STILL),
    "no motion at all, pushed far": Case(cosines(2.0), STILL),
    "no friction": Case(MIXED, SINE, mu=0.0, n_0=0.5),
    "no friction, never open": Case(MIXED, SINE, mu=0.0, n_0=2.0),
    "no tangential stiffness": Case(MIXED, SINE, k_u=0.0, n_0=0.5),
    "nothing": Case(STILL, STILL, n_0=0.0),
    "touches as it opens": Case(MIXED, SINE, n_0=1.0),
    "touches as it closes": Case(MIXED, SINE, n_0=-1.0),
    "no preload": Case(MIXED, SINE, n_0=0.0),
    "touches three times": Case(SINE, THIRD, n_0=1.0),
    "closes for three instants": Case(SINE, THIRD, n_0=-1.0),
    "opens where u turns": Case(COSINE, COSINE, n_0=0.0),
    "opens and closes where u turns": Case(THIRD, THIRD, n_0=0.0),
    "a limit that rests": Case(THIRD, THIRD, mu=1.0, n_0=0.5),
    "a limit that rests, opposed": Case(THIRD, -THIRD, mu=1.0, n_0=0.5),
    "a limit that rests, never open": Case(MIXED, 2.0 * MIXED, n_0=3.0),
    "in phase and stiff": Case(MIXED, MIXED, mu=1.0, k_v=4.0, n_0=0.7),
    "extremes of both limits at once": Case(FOURTH, STILL, n_0=1.0),
    "both limits turn where it opens": Case(FOURTH, FOURTH, n_0=0.0),
    "the slip limit": Case(SINE, STILL, mu=1.0, n_0=1.0),
    "the slip limit of harmonics": Case(THIRD, STILL, mu=1.0, n_0=1.0),
    "a load with a zero of order 4": Case(MIXED, powers_of_versine(2), n_0=0.0),
    "a load with a zero of order 16": Case(MIXED, powers_of_versine(8), n_0=0.0),
    "a flat load that just opens": Case(MIXED, powers_of_versine(8), n_0=-1e-9),
    "a flat load that hardly closes": Case(MIXED, -powers_of_versine(8), n_0=1e-9),
    "a motion that halts": Case(powers_of_versine(3), SINE, n_0=1.5),
    "a motion that halts, light": Case(powers_of_versine(4), SINE, n_0=0.5, k_v=1e-3),
    "light and constant": Case(MIXED, STILL, mu=1e-6, n_0=1.0),
    "light": Case(MIXED, SINE, mu=1e-6, n_0=0.5),
    "heavy": Case(MIXED, SINE, mu=1e3, n_0=0.5),
    "heavy, touches": Case(MIXED, SINE, mu=1e3, n_0=1.0),
    "far preload": Case(MIXED, SINE, n_0=1e9),
    "far gap": Case(MIXED, SINE, n_0=-1e9),
    "only a high harmonic": Case(cosines(*[0] * 15, 1), cosines(*[0] * 14, 1), n_0=0.4),
    "a slow motion and a fast load": Case(SINE, cosines(*[0] * 15, 1), n_0=0.4),
    "a fast motion and a slow load": Case(cosines(*[0] * 15, 1), SINE, n_0=0.4),
}


def near(case, miss):
    """The same, its preload missed by so much of the normal forces."""
    return replace(case, n_0=case.n_0 + miss * case.k_v * float(np.abs(case.v[1:]).sum()))


def scale_of(case, friction):
    """What errors are compared with: the friction force.

    They carry the rounding of a load that varies far more, and without friction that of the motion.
    """
    motion, load = (float(np.abs(x[1:]).sum()) for x in (case.k_u * case.u, case.mu * case.k_v * case.v))
    return max(friction, 1e-4 * load, 1e-9 * motion, 1e-300)


def errors(case, beyond=3, depth=2):
    """Errors of the friction and of the normal coefficients, relative to the greatest force and amplitude."""
    highest = max(case.u.size, case.v.size) - 1
    u, v = (np.pad(x, (0, highest + 1 - x.size)) for x in (case.u, case.v))
    f, n, friction, _ = periodic_march.forces(u, v, *case.arguments()[2:], highest + beyond, depth)
    here = case.forces(harmonics=highest + beyond)
    variation = case.k_v * float(np.abs(case.v[1:]).sum()) + abs(case.n_0 + case.k_v * case.v[0].real)
    return (
        float(np.abs(here[0] - f).max() / scale_of(case, friction)),
        float(np.abs(here[1] - n).max() / max(variation, 1e-300)),
    )
