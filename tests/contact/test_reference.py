"""The two references agree: many digits from the events of the cycle, small steps that know of no event."""

import numpy as np
import pytest

from fcm import fourier_coefficients

from . import marched, reference
from .cases import all_boundaries, points

STEPS = 2000


def exact(n0, b, phi):
    return np.array([reference.coefficients(*x) for x in zip(n0, b, phi, strict=True)], dtype=float).T


@pytest.mark.parametrize("name", ["linear", "near_boundaries", "near_degenerate", "between_sequences"])
def test_march_and_digits_agree(name):
    n0, b, phi = points(name, 150)
    difference = np.abs(marched.coefficients(n0, b, phi, STEPS) - exact(n0, b, phi))
    assert np.all(difference <= marched.error(n0, b, STEPS))


def test_march_and_closed_form_agree_on_every_boundary():
    n0, b, phi = all_boundaries()
    difference = np.abs(
        np.subtract(marched.coefficients(n0, b, phi, STEPS), fourier_coefficients(n0, b, phi))
    )
    assert np.all(difference <= marched.error(n0, b, STEPS))


@pytest.mark.parametrize(("never_opens", "order"), [(True, 2.0), (False, 1.0)])
def test_order_of_convergence_of_the_march(never_opens, order):
    n0, b, phi = points("linear", 200)
    n0 = np.where(never_opens, b + 0.3 * np.abs(n0), n0)
    truth = exact(n0, b, phi)
    steps = np.array([250, 500, 1000, 2000])
    error = [np.sqrt(np.mean((marched.coefficients(n0, b, phi, n) - truth) ** 2)) for n in steps]
    assert -np.polyfit(np.log(steps), np.log(error), 1)[0] == pytest.approx(order, abs=0.2)


def test_digits_are_enough():
    """Twice the digits do not change the first fifty."""
    for x in zip(*points("near_boundaries", 30), strict=True):
        with reference.mp.workdps(400):
            more = reference._Contact(*map(reference.mpf, map(float, x)))
            more = more.integrate() if more.ever_closes() else [0, 0, 0]
            error = [abs(p - q) for p, q in zip(reference.coefficients(*map(float, x)), more, strict=True)]
            assert max(error) < 1e-50
