"""A curve is the same whatever else is calculated while it is followed, or was left half-done before it."""

import numpy as np
import pytest

from fcm.harmonic_balance.system import System
from fcm.response.request import Request
from fcm.response.trace import traced_curve

from .scenes import STUCK, TWO_MODES, scene, up_to

EVERY = 12  # times that a curve is looked at, something else happens


def points(wanted, n_0, poll=None):
    curve = traced_curve(scene(TWO_MODES, [{**STUCK, "n_0": n_0}], (0.7, 1.5)), wanted, poll)
    return [curve.frequency, curve.amplitude, curve.mean, curve.stable, curve.error, np.array(curve.folds)]


def same(some, others):
    for one, other in zip(some, others, strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.slow
@pytest.mark.parametrize("harmonics", [(1,), up_to(3), None])
def test_another_curve_of_the_structure_while_one_is_followed(harmonics):
    """By what looks how far it is, on the same balance if that could be had."""
    wanted, looks, within = Request(harmonics), 0, []

    def poll():
        nonlocal looks
        looks += 1
        if looks % EVERY == 0:
            within.append(points(wanted, 0.5))

    found = points(wanted, 2.0, poll)
    assert within
    same(found, points(wanted, 2.0))
    for one in within:
        same(one, points(wanted, 0.5))


@pytest.mark.slow
@pytest.mark.parametrize("harmonics", [(1,), up_to(3)])
@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError])
def test_a_curve_after_one_that_was_interrupted(harmonics, error):
    """Wherever that was."""
    wanted, left, ended = Request(harmonics), 0, False

    def poll():
        nonlocal left
        left -= 1
        if left == 0:
            raise error

    expected = points(wanted, 0.5)
    for count in range(1, 10_000, 8 * EVERY):
        left = count
        try:
            points(wanted, 2.0, poll)
            ended = True
        except error:
            same(points(wanted, 0.5), expected)
        if ended:
            break
    assert ended


def test_a_balance_that_follows_a_curve_is_nobody_elses():
    scenes = [scene(TWO_MODES, [{**STUCK, "n_0": n_0}], (0.7, 1.5)) for n_0 in (2.0, 0.5, 1.0)]
    one, other, last = (System(each, up_to(3)) for each in scenes)
    with one.exclusive_balance():
        assert other.shared_balance is not one.shared_balance
    assert last.shared_balance is one.shared_balance
