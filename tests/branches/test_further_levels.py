"""Frequencies at which no motion that was found is stable, and what is missed there."""

from dataclasses import replace
from pathlib import Path as File

import numpy as np
import pytest

from fcm.branches.options import LevelCurveOptions, LevelOptions
from fcm.continuation.options import StepOptions
from fcm.response import trace
from fcm.response.options import ResponseOptions
from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.scene import load_scene, scene_from_dict
from fcm.stability.unstable_ranges import unstable_stretches
from fcm.time_domain import State, simulate

KNOWN = File(__file__).parents[1] / "harmonic_balance/scenes"
MARCHED = (1.6231, 7.0014, 6.7749, 3.7635)


def test_stretches_where_nothing_stays_are_told_the_widest_first():
    """A motion between 3 and 4 whose stability is not known may stay, and one falls back from 6 to 5. One
    point alone, as at 7, is where two stretches meet."""
    rising, falling = np.array([1.0, 2.0, 3.0, 4.0, 7.0, 8.0]), np.array([6.5, 6.0, 5.0])
    known = [np.array([1.0, 1.0, np.nan, np.nan, 0.0, 0.0]), np.array([0.0, 1.0, 1.0])]
    alone = np.array([0.0, 0.0, 0.0, 0.0, 1.0, 0.0])
    found = unstable_stretches([(rising, known[0]), (falling, known[1])], (1.0, 8.0))
    assert found == [(6.0, 8.0), (4.0, 5.0)]
    assert unstable_stretches([(rising, np.ones(6))], (1.0, 8.0)) == []
    assert (
        unstable_stretches([(rising, alone)], (1.0, 8.0))
        == unstable_stretches([], (1.0, 8.0))
        == [(1.0, 8.0)]
    )


@pytest.mark.slow
def test_a_stable_branch_that_was_missed_is_looked_for_where_nothing_is_stable():
    """At 1.567 rad/s a march of the contact law, with 3000 and 12000 steps of a cycle, settles at the same
    motion from all of 12 random states. The other branches there are 14 % lower and more, and unstable."""
    scene = load_scene(KNOWN / "missed.toml").each_curve()[0]
    curve = traced_curve(replace(scene, frequency_range=(1.35, 2.156)), Request(None, 1e-2))
    off, stable = curve.frequency - 1.567, curve.stable == 1.0
    (i,) = np.flatnonzero((off[:-1] * off[1:] < 0.0) & stable[:-1] & stable[1:])
    part = off[i] / (off[i] - off[i + 1])
    there = (1.0 - part) * curve.amplitude[i] + part * curve.amplitude[i + 1]
    assert curve.complete and there == pytest.approx(MARCHED, rel=2e-2)


ONE_MODE = {
    "modal": {"dofs": ["x", "y"], "frequency": [1.0], "damping": [0.032], "shapes": [[-1.723, 0.587]]},
    "contact": [
        {"name": "c", "tangential": "y", "normal": "x", "mu": 0.564, "k_u": 0.611, "k_v": 2.26, "n_0": 0.0785}
    ],
    "force": [{"dof": "x", "amplitude": 0.079}],
    "response": {"frequency": [0.5, 2.2], "harmonics": 5},
}
ONE_OPEN_AT_REST = {
    "modal": {
        "dofs": ["x", "y", "z"],
        "frequency": [1.0, 3.18],
        "damping": [0.0076, 0.0285],
        "shapes": [[0.899, 1.38, 1.4], [-0.853, -1.14, -0.149]],
    },
    "contact": [
        {"name": "closed", "tangential": {"x": -0.0925, "y": 0.112}, "normal": {"x": -0.321, "y": -2.42}}
        | {"mu": 0.473, "k_u": 0.999, "k_v": 0.173, "n_0": 0.493},
        {"name": "open", "tangential": {"z": 0.126, "y": 0.95}, "normal": "z"}
        | {"mu": 1.17, "k_u": 7.58, "k_v": 1.0, "n_0": -6.68},
    ],
    "force": [{"dof": "y", "amplitude": 1.0}],
    "response": {"frequency": [0.5, 2.2], "harmonics": 9},
}


@pytest.mark.slow
@pytest.mark.parametrize(("parts", "omega"), [(ONE_MODE, 0.8122), (ONE_OPEN_AT_REST, 0.81)])
def test_a_closed_branch_is_found_where_a_harmonic_comes_to_a_resonance(parts, omega):
    """The contact opens twice a period on it, at half of the frequency of the highest peak, or between that
    and half of the resonance with the contacts as at rest; beside it the motion is stable in which the
    contact sticks. A march settles at either."""
    scene = scene_from_dict(parts)
    modes, contacts = len(parts["modal"]["frequency"]), np.zeros(len(scene.contacts))
    begins = [State(np.eye(modes)[0] * q, np.zeros(modes), contacts) for q in (0.05, 0.1, 1.0, 2.0)]
    marched = [simulate(scene, omega, 800, begin).measures(last=1)[0].amplitude for begin in begins]
    assert max(marched, key=np.max)[0] > 2.0 * min(marched, key=np.max)[0]
    (curve,) = trace(scene).curves
    off = curve.frequency - omega
    at = np.flatnonzero((off[:-1] * off[1:] < 0.0) & (curve.stable[:-1] == 1.0))
    part = (off[at] / (off[at] - off[at + 1]))[:, None]
    there = (1.0 - part) * curve.amplitude[at] + part * curve.amplitude[at + 1]
    for amplitude in marched:
        assert np.abs(there / amplitude - 1.0).max(axis=1).min() < 2e-2


def test_a_level_that_is_not_followed_to_its_end_leaves_branches_unsure():
    """Without a preload nothing is stable around 0.75 rad/s, where the motion repeats after two periods."""
    (scene,) = (one for one in load_scene("yang1998").each_curve() if one.contacts[0].n_0 == 0.0)
    assert traced_curve(scene).complete and traced_curve(scene).uncertain_at == []
    short = ResponseOptions(others=(LevelCurveOptions(step=StepOptions(max_steps=10)),))
    curve = traced_curve(scene, Request(options=short))
    ((low, high),) = curve.summary()["no_stable_motion"]
    assert any(low < at < high for at in curve.uncertain_at)


@pytest.mark.slow
def test_ranges_are_looked_at_the_widest_first_as_long_as_it_may_take_and_the_others_are_told():
    scene = replace(load_scene(KNOWN / "chaos.toml"), frequency_range=(1.15, 1.45))
    every = traced_curve(scene, Request(tuple(range(1, 6)), 1e-2)).summary()
    few = ResponseOptions(others=(LevelOptions(work_fraction=0.05, min_seconds=0.0),))
    some = traced_curve(scene, Request(tuple(range(1, 6)), 1e-2, options=few)).summary()
    left, none = some["no_stable_motion_not_looked_at"], every.get("no_stable_motion_not_looked_at", [])
    assert len(none) < len(left) <= len(some["no_stable_motion"])
    looked = [ends for ends in some["no_stable_motion"] if ends not in left]
    assert max(high - low for low, high in left) <= max((high - low for low, high in looked), default=np.inf)


def test_a_window_of_stability_that_was_not_seen_is_where_a_look_finds_it():
    """At 1.425 rad/s a march of the exact motion settles at (2.2122, 1.0395) from each of 12 states."""
    given = {
        "modal": {
            "dofs": ["v", "u"],
            "frequency": [1.0, 2.3335, 3.7286, 4.7082],
            "damping": [0.041622, 0.04402, 0.0079051, 0.018357],
            "shapes": [[-1.5054, 0.41462], [-0.64261, 0.61897], [0.40903, 0.33035], [-0.90691, -1.1796]],
        },
        "contact": [
            {"name": "c", "tangential": "u", "normal": "v", "mu": 0.030279, "k_u": 0.25324, "k_v": 26.774,
             "n_0": -3.2003},
        ],
        "force": [{"dof": "v", "amplitude": 1.0}],
        "response": {"frequency": [1.1187, 1.4861]},
    }  # fmt: skip
    curve = traced_curve(scene_from_dict(given), Request(tuple(range(1, 11)), 1e-2))
    off = curve.frequency - 1.425
    (i,) = np.flatnonzero(off[:-1] * off[1:] < 0.0)
    assert (curve.stable[i : i + 2] == 1.0).all()
    part = off[i] / (off[i] - off[i + 1])
    there = (1.0 - part) * curve.amplitude[i] + part * curve.amplitude[i + 1]
    assert there == pytest.approx((2.2122, 1.0395), rel=1e-2)
    assert not any(low < 1.425 < high for low, high in curve.summary()["no_stable_motion"])


# at 1.25 rad/s a march of the exact motion settles here from one of 24 random states; from others it does not
HIGHER = (2.78856, 1.13617, 3.59541, 2.31086)


def curve(count, span):
    """Of the first harmonics, about a closed branch that seven of them have and five have not."""
    scene = load_scene(KNOWN / "chaos.toml")
    return traced_curve(replace(scene, frequency_range=span), Request(tuple(range(1, count + 1))))


def test_of_peaks_that_a_branch_of_more_harmonics_exceeds_no_error_is_told():
    peaks = curve(5, (1.22, 1.42)).peaks.values()
    assert all(peak.amplitude < 0.8 * there for peak, there in zip(peaks, HIGHER, strict=True))
    assert all(np.isnan(peak.error) for peak in peaks)


@pytest.mark.slow
@pytest.mark.parametrize("span", [(1.1, 1.6), (1.23, 1.6)])  # it is in the middle of no stretch of the second
def test_a_higher_branch_of_more_harmonics_is_led_to_those_given(span):
    found = curve(7, span)
    off = found.frequency - 1.25
    passed = np.flatnonzero(off[:-1] * off[1:] < 0.0)
    part = (off[passed] / (off[passed] - off[passed + 1]))[:, None]
    there = (1.0 - part) * found.amplitude[passed] + part * found.amplitude[passed + 1]
    nearest = there[np.abs(there - HIGHER).max(axis=1).argmin()]
    assert nearest == pytest.approx(HIGHER, rel=5e-2)
    assert all(peak.amplitude > there for peak, there in zip(found.peaks.values(), HIGHER, strict=True))
    assert all(peak.error < 0.05 for peak in found.peaks.values())
