"""Harmonics foreseen from a curve of one, beside what curves of these and of many harmonics are."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.harmonic.further import padded
from fcm.harmonic.outline import outlined
from fcm.harmonic.system import System

from .truth import MANY, scene


def heights(system):
    return np.max([one.amplitude.max(axis=0) for one in outlined(system).shown], axis=0)


@pytest.mark.parametrize("case", [("yang1998", 5), ("yang1998", -5), ("yang1998", 0), ("stuck_mean", None)])
@pytest.mark.parametrize("accuracy", [1e-2, 1e-3])
def test_curves_of_what_is_foreseen_are_accurate(case, accuracy):
    system = System(scene(*case))
    ahead = outlined(system).ahead(accuracy)
    true = heights(system.with_harmonics(MANY))
    assert ahead.told
    assert np.abs(heights(system.with_harmonics(ahead.harmonics)) / true - 1.0).max() < accuracy


def test_the_change_is_that_to_the_peaks_of_many_harmonics():
    system = System(scene("yang1998", -5))
    ahead = outlined(system).ahead(1e-3)
    change = np.abs(heights(system.with_harmonics(MANY)) / heights(system) - 1.0).max()
    assert ahead.change == pytest.approx(change, rel=0.2)


def test_harmonics_between_others_are_left_out():
    """The ninth meets the mode at 10 rad/s: it has less than others that do less."""
    ahead = outlined(System(scene("yang1998", -5))).ahead(2e-3)
    assert 9 in ahead.harmonics
    assert len(ahead.harmonics) < 7


def test_a_stuck_contact_needs_no_more():
    ahead = outlined(System(scene("yang1998", 100))).ahead(1e-6)
    assert ahead.harmonics == (1,)
    assert ahead.change == 0.0
    assert ahead.told


def test_a_peak_that_more_harmonics_do_not_have_is_not_told():
    """One harmonic has a peak of v of 35, three have one of 18, at another frequency."""
    ahead = outlined(System(scene("gap5"))).ahead(1e-2)
    assert not ahead.told
    assert ahead.harmonics != (1,)


def test_harmonics_that_are_not_wanted_are_taken_away():
    z = np.arange(2.0 * (2 + 4 * 3) + 1.0)
    fewer = padded(z, (1, 2, 3), (1, 3))
    assert (
        padded(fewer, (1, 3), (1, 2, 3)) == np.where(np.isin(z % 14, (6, 7, 8, 9)) & (z < 28), 0.0, z)
    ).all()


def test_where_nothing_moves_no_more_is_needed():
    still = scene("yang1998", 5)
    still = replace(still, forces=tuple(replace(force, amplitude=0.0) for force in still.forces))
    ahead = outlined(System(still)).ahead(1e-2)
    assert ahead.harmonics == (1,)
    assert ahead.change == 0.0
