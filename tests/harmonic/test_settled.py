"""Displacements of tops that are settled: harmonics that would do little are not balanced for that."""

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.harmonic.corrector import SETTLED, Corrector
from fcm.harmonic.cost import seconds_of
from fcm.harmonic.error import reported
from fcm.harmonic.system import System
from fcm.harmonic.trace import traced


@pytest.mark.parametrize("n_0", [5.0, 2.0, 0.0])
def test_a_top_that_its_first_harmonics_settle_is_as_with_33_and_took_no_more_than_those(n_0):
    (curve,) = (one for one in fcm.load_scene("yang1998").curves if one.contacts[0].n_0 == n_0)
    system = System(replace(curve, curves=()), (1,), fcm.open_table())
    path = traced(system).branches.paths[0]
    amplitude = reported(system, path).amplitude
    top = amplitude[:, 0].argmax()
    point = path.z[top], path.direction[top]
    corrector = Corrector(system)
    found = corrector.settled(*point, amplitude[top])[1:] - amplitude[top]
    assert corrector.seconds() < 2.0 * seconds_of(system, 1, 9)
    many = Corrector(system).lifted(tuple(range(1, 34)))
    assert many.beside(*point)
    true = np.array(many.found)[1:] - amplitude[top]
    assert found == pytest.approx(true, rel=SETTLED)
