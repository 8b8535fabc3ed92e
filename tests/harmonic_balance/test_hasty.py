"""Curves of the level of the forces of which only the passings of the level 1 matter."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.branches.force_level import (
    LEVEL_REACH,
    LevelRange,
    LevelReachOptions,
    level_curve,
    level_frequencies,
    solutions,
    turned_back,
)
from fcm.branches.linear_limits import highest_linear_limit, lowest_linear_limit
from fcm.branches.options import LEVEL_CURVE
from fcm.continuation import Path, Status
from fcm.harmonic_balance.system import System
from fcm.scene import load_scene

from .strips import strip


@pytest.mark.slow
def test_a_hasty_curve_of_many_contacts_comes_to_the_same_with_less():
    """Against the same curve by way of all its corners, of ten contacts; they are followed up to a level."""
    system = System(load_scene("blade").each_curve()[0], (1, 2, 3))
    hasty = careful = passed = 0
    for omega in level_frequencies(system):
        linear, top = (
            LEVEL_CURVE.linear_fraction * lowest_linear_limit(system, omega),
            min(highest_linear_limit(system, omega), 20.0),
        )
        if linear >= top:
            continue
        one = level_curve(
            system,
            omega,
            LevelRange((0.0, top), LEVEL_CURVE.max_step_user_points, (1.0,), linear, True, True),
        )
        other = level_curve(system, omega, LevelRange((0.0, top), LEVEL_CURVE.max_step, (1.0,), linear))
        there, true = (path.z[path.parameter == 1.0, :-1] for path in (one, other))
        assert there == pytest.approx(true, abs=1e-9 * np.abs(other.z[:, :-1]).max())
        hasty, careful = hasty + one.evaluations, careful + other.evaluations
        passed += len(true)
    assert passed > 1
    assert hasty < 1.03 * careful, (hasty, careful)


def test_with_many_contacts_the_level_is_followed_no_further_than_allowed():
    """To the same solutions, with less; strips of stiff contacts slip and open at ever higher levels."""
    one = strip(n_0=12.0)
    contacts = tuple(replace(c, n_0=c.n_0 * (1.0 + i) ** 2) for i, c in enumerate(one.contacts))
    scene = replace(one, contacts=contacts)
    system = System(scene)
    taken, found = [], []
    assert all(
        highest_linear_limit(system, omega) > LEVEL_REACH.max_level for omega in level_frequencies(system)
    )
    for contacts in (LEVEL_REACH.min_contacts, 10**6):
        system = System(scene, other_options=(LevelReachOptions(contacts),))
        found.append([solutions(system, omega) for omega in level_frequencies(system)])
        taken.append(system.work.seconds)
    for near, far in zip(*found, strict=True):
        assert near.complete and len(near.solutions) == len(far.solutions) > 0
        assert np.allclose(near.solutions, far.solutions, rtol=1e-9, atol=1e-12)
    assert taken[0] < 0.8 * taken[1]


def test_beyond_the_level_of_the_scene_the_curve_takes_no_more_than_a_share_and_says_so():
    """To the same solutions with less, but whether the curve comes back is not known."""
    scene, found, taken = strip(), [], []
    for options in (LevelReachOptions(), LevelReachOptions(beyond_fraction=0.0, min_seconds_beyond=0.0)):
        system = System(scene, other_options=(options,))
        found.append([solutions(system, omega) for omega in level_frequencies(system)])
        taken.append(system.work.seconds)
    for whole, short in zip(*found, strict=True):
        assert whole.complete and not short.complete and np.isinf(short.max_level)
        assert np.allclose(whole.solutions, short.solutions, rtol=1e-9, atol=1e-12)
        assert len(short.solutions) > 0
    assert taken[1] < taken[0]


def test_a_curve_that_turned_far_below_the_level_of_the_scene_is_followed_no_further():
    """As contacts begin to slip the level may turn back; a resonance that keeps itself up turns it near 1."""
    near, options = LEVEL_REACH.max_level_without_fold, LEVEL_REACH

    def turned(*levels):
        z = np.array(levels)[:, None]
        return turned_back(
            Path(z, z, np.zeros(len(z), dtype=np.intp), np.ones(len(z)), Status.COMPLETE, 0), options
        )

    assert not turned(0.01, 0.0133, 0.0129, 0.5, near)
    assert turned(0.5, 1.4, 1.2, near) and turned(0.5, 0.9, 0.5, near)
    assert not turned(0.5, 1.4, 1.3999, near)
