"""Curves of the level of the forces of which only the passings of the level 1 matter."""

import numpy as np
import pytest

from fcm.harmonic.linear_contacts import highest, least
from fcm.harmonic.start import BEFORE, LONG, STEP, level_curve, looked_at
from fcm.harmonic.system import System
from fcm.scene import load_scene


def test_a_hasty_curve_of_many_contacts_comes_to_the_same_with_less():
    """Against the same curve by way of all its corners, of ten contacts; they are followed up to a level."""
    system = System(load_scene("blade").each_curve()[0], (1, 2, 3))
    hasty = careful = passed = 0
    for omega in looked_at(system):
        linear, top = BEFORE * least(system, omega), min(highest(system, omega), 20.0)
        if linear >= top:
            continue
        one = level_curve(system, omega, (0.0, top), LONG, (1.0,), linear, hasty=True, lightly=True)
        other = level_curve(system, omega, (0.0, top), STEP, (1.0,), linear)
        there, true = (path.z[path.parameter == 1.0, :-1] for path in (one, other))
        assert there == pytest.approx(true, abs=1e-9 * np.abs(other.z[:, :-1]).max())
        hasty, careful = hasty + one.evaluations, careful + other.evaluations
        passed += len(true)
    assert passed > 1
    assert hasty < 1.03 * careful, (hasty, careful)
