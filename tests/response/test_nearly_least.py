"""How sharp an optimum is, and with which other numbers the greatest peak is unstable."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.response import trace
from fcm.response.nearly_least import nearly_least, unstable_peaks
from fcm.response.optimum import optimise
from fcm.results.tracked import Optimal, TrackedCurve
from fcm.scene import scene_from_dict

BLADE = {
    "modal": {"dofs": ["u", "v"], "frequency": [1.0, 10.0], "damping": [0.01, 0.01],
              "shapes": [[0.707, 0.707], [1.0, -0.5]]},
    "contact": [{"name": "c", "tangential": "u", "normal": "v", "mu": 0.4, "k_u": 1.0, "k_v": 1.0,
                 "n_0": 5.0}],
    "force": [{"dof": "u", "amplitude": 1.0}],
    "response": {"frequency": [0.7, 1.7], "harmonics": 1},
}  # fmt: skip
AIM = {"vary": "contact.c.n_0", "bounds": [1, 50], "minimise": "peak.u"}


def peak(n_0):
    contact = [BLADE["contact"][0] | {"n_0": float(n_0)}]
    return trace(scene_from_dict(BLADE | {"contact": contact})).curves[0].peaks["u"].amplitude


@pytest.mark.slow
def test_responses_at_the_ends_have_peaks_greater_by_that_share():
    (found,) = optimise(scene_from_dict(BLADE | {"optimum": AIM})).tracking.optima
    near = found.nearly
    assert near.low_known and near.high_known and near.low < found.values["contact.c.n_0"] < near.high
    for end in (near.low, near.high):
        assert peak(end) / found.value == pytest.approx(1.0 + near.share, abs=5e-4)


def tracked(number, height, what="peak of u"):
    none = np.zeros(number.size)
    flags = none.astype(bool)
    corner = np.full(number.size, "")
    return TrackedCurve({}, what, number, none, height[:, None], corner, flags, flags, none, (), True, "")


OPTIMAL = Optimal({}, {"n": 2.0}, ("peak.u",), 1.0, (("u", 1.0),), "kink", (1,))


@pytest.mark.parametrize("share", [0.01, 0.1])
def test_of_two_peaks_the_steeper_is_the_end_on_its_side(share):
    number = np.linspace(1.0, 3.0, 21)
    falling, rising = 1.0 - 0.5 * (number - 2.0), 1.0 + 2.0 * (number - 2.0)
    near = nearly_least(OPTIMAL, [tracked(number, falling), tracked(number, rising)], ["u"], share)
    assert (near.low, near.high) == pytest.approx((2.0 - 2.0 * share, 2.0 + 0.5 * share), rel=1e-9)
    other = tracked(number, 9.0 + 0.0 * number, "peak of v")
    again = nearly_least(OPTIMAL, [tracked(number, falling), tracked(number, rising), other], ["u"], share)
    assert again == near


def test_where_the_peaks_are_not_greater_up_to_an_end_that_is_said():
    number = np.linspace(1.0, 3.0, 21)
    near = nearly_least(OPTIMAL, [tracked(number, 1.0 + (number - 2.0).clip(0.0))], ["u"], 0.01)
    assert (near.low, near.low_known) == (1.0, False) and near.high_known
    assert near.high == pytest.approx(2.01)


def test_the_next_higher_peaks_that_end_on_either_side_are_told():
    """Of two below the nearer one; none where another peak of that height goes on, or at the bounds."""
    number = np.linspace(1.0, 4.0, 61)
    valley = tracked(number, 1.0 + abs(number - 2.0))
    far, near = (
        tracked(np.linspace(1.0, 1.2, 5), np.full(5, 9.0)),
        tracked(np.linspace(1.0, 1.5, 5), np.full(5, 7.0)),
    )
    above = tracked(np.linspace(4.0, 3.0, 5), np.linspace(6.0, 5.0, 5))
    found = nearly_least(OPTIMAL, [valley, far, near, above], ["u"], 0.01)
    assert found.higher == ((pytest.approx(1.5), 7.0), (pytest.approx(3.0), 5.0))
    goes_on = tracked(np.linspace(1.5, 1.7, 5), np.linspace(7.0, 1.2, 5))
    assert nearly_least(OPTIMAL, [valley, far, near, goes_on], ["u"], 0.01).higher == (
        (pytest.approx(1.2), 9.0),
    )
    assert nearly_least(OPTIMAL, [valley], ["u"], 0.01).higher == ()
    turning = tracked(np.array([1.0, 4.0, 3.0]), np.array([1.0, 4.0, 6.0]))
    assert nearly_least(OPTIMAL, [turning], ["u"], 0.01).higher == ((3.0, 6.0),)


@pytest.mark.parametrize("kind", ["end", "trials", "flat", "unfinished"])
def test_of_peaks_that_are_no_curves_around_it_nothing_is_told(kind):
    number = np.linspace(1.0, 3.0, 21)
    one = replace(OPTIMAL, kind=kind)
    assert nearly_least(one, [tracked(number, 1.0 + abs(number - 2.0))], ["u"], 0.01) is None


def test_numbers_with_which_the_greatest_peak_is_higher_and_unstable_are_ranges():
    """A higher peak that is unstable up to 2.2, of unknown stability in part; a short stretch is left out."""
    number = np.linspace(1.0, 5.0, 41)
    flat, higher = tracked(number, 1.0 + 0.0 * number), tracked(number, 2.0 - 0.1 * number)
    flat, higher = (replace(one, stable=np.ones(41)) for one in (flat, higher))
    assert unstable_peaks(OPTIMAL, [flat, higher], ["u"]) == ()
    stable = np.where(number < 2.2, 0.0, 1.0)
    stable[number < 1.4], stable[number > 4.95] = np.nan, 0.0
    ((low, high, peak),) = unstable_peaks(OPTIMAL, [flat, replace(higher, stable=stable)], ["u"])
    assert (low, high, peak) == pytest.approx((1.0, 2.2, 1.9), abs=0.02)
    unknown = replace(higher, stable=np.where(stable == 0.0, np.nan, stable))
    lower = replace(higher, amplitude=0.5 * higher.amplitude, stable=stable)
    assert unstable_peaks(OPTIMAL, [flat, unknown], ["u"]) == unstable_peaks(OPTIMAL, [flat, lower], ["u"])
    assert unstable_peaks(OPTIMAL, [flat, lower], ["u"]) == ()
    several = replace(OPTIMAL, values={"n": 2.0, "m": 1.0})
    assert unstable_peaks(several, [flat, replace(higher, stable=stable)], ["u"]) == ()
