"""Fits to points with errors that are not stated, beside an independent search of the likeliest numbers."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq, minimize, minimize_scalar

from fcm.fit.estimate import estimated
from fcm.fit.options import FIT
from fcm.fit.parameters import parameters_of
from fcm.fit.solve import FitProblem, SearchResult, solved
from fcm.model.scene import Measured
from fcm.scene.load import scene_from_dict

TRUTH = np.array([0.37, 0.8])
KEYS = ["contact.c.mu", "contact.c.k_u"]
N_0 = 3.0
OMEGA = np.linspace(0.85, 1.5, 25)


def scene(mu, k_u):
    """A mass on a contact that slips."""
    return scene_from_dict(
        {
            "modal": {"dofs": ["x", "y"], "frequency": [1.0, 9.0], "damping": [0.01, 0.1],
                      "shapes": [[1.0, 0.0], [0.0, 1.0]]},
            "contact": [{"name": "c", "tangential": "x", "normal": "y", "mu": mu, "k_u": k_u, "k_v": 1.0,
                         "n_0": N_0}],
            "force": [{"dof": "x", "amplitude": 1.0}],
            "response": {"frequency": [0.8, 1.6], "harmonics": 1},
        }
    )  # fmt: skip


def amplitude(mu, k_u):
    """Of the mass: its balance of one harmonic by hand, with the describing function of a Jenkins element."""

    def excess(A, omega):
        turn = np.arccos(max(1.0 - 2.0 * mu * N_0 / (k_u * A), -1.0))
        held = k_u / np.pi * (turn - np.sin(turn) * np.cos(turn) + 1j * np.sin(turn) ** 2)
        return abs(1.0 - omega**2 + 0.02j * omega + held) * A - 1.0

    return np.array([brentq(excess, 1e-9, 1e3, args=(omega,), xtol=1e-14, rtol=1e-14) for omega in OMEGA])


def drawn(seed, floor, share):
    """Measured points that err by a floor and a share of themselves, both relative."""
    clean = amplitude(*TRUTH)
    first, second = np.random.default_rng(seed).standard_normal((2, OMEGA.size))
    ones = np.ones(OMEGA.size)
    value = clean * (1.0 + share * first) + floor * clean.max() * second
    return Measured("made", "x", OMEGA, value, ones, ones)


def unlikely(data, x):
    """-2 ln of the likelihood of numbers exp(x), less the best of the errors, by Schwarz's criterion."""
    n, square = OMEGA.size, (amplitude(*np.exp(x)) - data.amplitude) ** 2
    shape = (data.amplitude / data.amplitude.max()) ** 2

    def with_ratio(log):
        size = 1.0 + np.exp(log) * shape
        return np.log(size).sum() + n * np.log((square / size).mean()) + n

    floor = with_ratio(-np.inf) + np.log(n)
    share = np.log(shape).sum() + n * np.log((square / shape).mean()) + n + np.log(n)
    grid = np.linspace(-10.0, 20.0, 16)
    at = grid[np.argmin([with_ratio(log) for log in grid])]
    both = minimize_scalar(with_ratio, bounds=(at - 2.0, at + 2.0), method="bounded").fun + 2.0 * np.log(n)
    return min(floor, share, both)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "floor", "share"),
    [(1, 0.0, 0.02), (2, 0.0, 0.02), (3, 0.0, 0.02), (4, 0.02, 0.0), (5, 0.002, 0.05), (6, 0.002, 0.05)],
)
def test_every_start_comes_to_the_likeliest_numbers(seed, floor, share):
    data = drawn(seed, floor, share)
    found = []
    for start in ([0.3, 1.1], [0.6, 0.6]):
        parameters = parameters_of(scene(*start), KEYS, [None, None])
        fit = solved(parameters, [data], (1,), replace(FIT, starts=3))
        error = estimated(parameters, fit.values, fit.rows).error
        ends = [one for one in fit.starts if one.finished]
        assert fit.settled and len(ends) == 2
        found += [fit.values, *(one.end for one in ends)]
        assert [one.cost for one in ends] == pytest.approx([fit.rows.cost] * 2, rel=1e-6)
    best = min(
        (
            minimize(lambda x: unlikely(data, x), np.log(x), method="Nelder-Mead",
                     options={"xatol": 1e-7, "fatol": 1e-10})
            for x in (TRUTH, 1.1 * TRUTH)
        ),
        key=lambda one: one.fun,
    )  # fmt: skip
    assert np.abs((np.array(found) - np.exp(best.x)) / error).max() < 0.02


def test_a_search_without_evaluations_left_is_not_settled():
    data = drawn(1, 0.0, 0.02)
    parameters = parameters_of(scene(0.2, 2.0), KEYS, [None, None])
    problem = FitProblem(parameters, [data], (1,), False)
    x = parameters.unknowns(parameters.start)
    short, long = problem.least(x, 2), problem.least(x, 60)
    assert isinstance(short, SearchResult) and not short.settled and long.settled
    options = replace(FIT, starts=1, finalist_evaluations=1, start_evaluations=1)
    assert not solved(parameters, [data], (1,), options).settled


def test_a_point_that_does_not_move_is_fitted_with_a_floor():
    data = drawn(1, 0.0, 0.02)
    still = replace(data, amplitude=np.where(OMEGA > 1.45, 0.0, data.amplitude))
    parameters = parameters_of(scene(0.3, 1.1), KEYS, [None, None])
    fit = solved(parameters, [still], (1,), replace(FIT, starts=1))
    rms = np.sqrt(((amplitude(*fit.values) - still.amplitude) ** 2).mean())
    assert (fit.data[0].estimated[still.amplitude == 0.0] > 0.5 * rms).all()
    assert fit.values == pytest.approx(TRUTH, rel=0.1)
