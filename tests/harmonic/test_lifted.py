"""Points of a balance of fewer harmonics moved to one of more, where there are many unknowns."""

import numpy as np
import pytest

from fcm.harmonic.corrector import ENOUGH
from fcm.harmonic.lifted import Lifted
from fcm.harmonic.system import System
from fcm.harmonic.trace import traced
from fcm.scene import load_scene


@pytest.fixture(scope="module")
def blade():
    """Ten contacts, the path of one harmonic, and a balance of 260 unknowns."""
    system = System(load_scene("blade").each_curve()[0], (1,))
    more = [1, 2, 3, 4, 5, 6]
    lifted = Lifted(system.with_harmonics(tuple(more)).balance(), [1], more, ENOUGH)
    assert len(system.scene.contacts) == 10
    return traced(system).branches.paths[0], lifted


def test_where_nothing_slips_more_harmonics_change_nothing(blade):
    path, lifted = blade
    assert lifted.beside(path.z[0], path.direction[0])
    assert lifted.found[0] == pytest.approx(path.parameter[0], rel=1e-9)
    assert np.linalg.norm(lifted.newton.z[:-1]) == pytest.approx(np.linalg.norm(path.z[0, :-1]), rel=1e-9)


def test_what_is_nowhere_is_given_up_within_few_evaluations(blade):
    path, lifted = blade
    top = np.abs(path.z[:, :-1]).max(axis=1).argmax()
    for factor in (2.0, 4.0, -1.0):
        before = lifted.newton.evaluations
        z = np.append(factor * path.z[top, :-1], path.parameter[top])
        assert not lifted.beside(z, path.direction[top])
        assert 0 < lifted.newton.evaluations - before <= 8  # Newton steps of one guess
