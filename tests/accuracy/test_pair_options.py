"""The options of a pair that are given take effect at each place, not the defaults."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fcm.accuracy.options import PAIR
from fcm.accuracy.peaks import tops_of_reference
from fcm.accuracy.reference_harmonics import keep_for_next, prolongation_to
from fcm.accuracy.refinement import with_errors
from fcm.accuracy.unchecked_response import unchecked_response
from fcm.harmonic_balance.system import System

from ..harmonic_balance.truth import scene
from ..response.random_scenes import random_scene


@pytest.mark.parametrize("neighbours, found", [(2, 1.0), (4, 1.5)])
def test_as_many_neighbours_of_the_highest_point_are_looked_at_as_is_asked(neighbours, found):
    """Point 3 of the reference is thought to be higher by half, three points beside the highest."""
    amplitude = np.full((9, 1), 0.5)
    amplitude[[3, 6]] = 1.0
    change = np.zeros((9, 1))
    change[3] = 0.5
    reference = SimpleNamespace(
        amplitude=amplitude,
        options=replace(PAIR, peak_neighbours=neighbours),
        unit=np.ones((9, 1)),
        known=np.arange(9) == 6,
        change=np.hstack((np.zeros((9, 1)), change)),
        arc=np.arange(9.0),
        quantities=SimpleNamespace(amplitude=amplitude, growth=np.zeros((9, 1))),
        path=SimpleNamespace(mark=np.zeros(9, dtype=np.int64)),
        followed=[],
    )

    def find(points):
        reference.known[points] = True

    reference.find = find
    none = np.zeros(0, dtype=np.intp)
    ((*_, top),) = tops_of_reference(reference, change, change, none)
    assert top.height == found


@pytest.mark.slow
def test_another_branch_nearly_as_high_is_a_rival_from_the_fraction_that_is_given():
    outline = unchecked_response(System(random_scene(16), (1, 2, 3)))
    few, many = (
        np.isnan(with_errors(outline, 1e-2, options=replace(PAIR, rival_fraction=part)).peak).sum()
        for part in (PAIR.rival_fraction, 0.01)
    )
    assert few < many


def test_places_compared_with_a_curve_a_few_at_a_time_give_the_same():
    """However many there are: that decides about memory alone."""
    outline = unchecked_response(System(random_scene(1), (1, 2)))
    found = [with_errors(outline, 1e-2, options=replace(PAIR, batch=batch)) for batch in (1, 3, PAIR.batch)]
    for one in found[:2]:
        np.testing.assert_array_equal(one.peak, found[2].peak)
        for own, other in zip(one.errors, found[2].errors, strict=True):
            np.testing.assert_array_equal(own.truncation, other.truncation)


def test_a_prolongation_is_kept_for_the_same_tolerance_alone():
    system, more = System(scene("yang1998", 5), (1,)), (1, 2, 3)
    exact = replace(PAIR, newton_tolerance=1e-9)
    kept = prolongation_to(system, more)
    keep_for_next(kept, system, more)
    other = prolongation_to(system, more, exact)
    assert other is not kept and other.tolerance == 1e-9
    assert prolongation_to(system, more) is kept
    keep_for_next(kept, system, more, replace(PAIR, max_kept=0))
    assert prolongation_to(system, more) is not kept
