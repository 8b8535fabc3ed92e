"""The least peak where detached branches have the greatest: they are met, and end at some number."""

import numpy as np
import pytest

from fcm.accuracy.refinement import every_branch, with_given_harmonics
from fcm.harmonic_balance.system import System
from fcm.response import trace
from fcm.response.least_peak import PeakTask
from fcm.response.optimum import optimise
from fcm.results.tracked import Optimal
from fcm.scene import scene_from_dict
from fcm.scene.draft import number_of

KEY = "contact.*.n_0"
SHAPES = [
    [2.564, 0.739, 3.126, 0.739, -3.126], [0.104, 1.634, -1.643, 1.634, 1.643],
    [-1.624, -4.062, -4.326, 4.062, -4.326], [-2.529, -2.602, -0.283, -2.602, 0.283],
]  # fmt: skip


def blade(n_0=40.0, **more):
    """The first modes of a blade that two faces hold: where one opens the other closes."""
    law = {"mu": 0.25, "k_u": 6e5, "k_v": 1e6, "n_0": n_0}
    faces = (("left", "tl", "nl"), ("right", "tr", "nr"))
    scene = {
        "frequency_unit": "Hz",
        "modal": {
            "dofs": ["tip", "tl", "nl", "tr", "nr"], "frequency": [108.4, 661.4, 774.0, 1164.4],
            "damping": 0.0015, "shapes": SHAPES,
        },
        "contact": [{"name": name, "tangential": u, "normal": v, **law} for name, u, v in faces],
        "force": [{"dof": "tip", "amplitude": 2.0}],
        "response": {"frequency": [80.0, 640.0], "output": ["tip"]},
    }  # fmt: skip
    return scene_from_dict(scene | more)


def greatest(quantities):
    return max(one.amplitude[:, 0].max() for one in quantities)


@pytest.mark.slow
def test_a_search_sees_the_branches_that_the_response_has():
    """With three harmonics the level led to none of them, and the greatest was a ninth of what it is."""
    system = System(blade(10.0), (1, 2, 3))
    of_response = greatest(with_given_harmonics(System(blade(10.0), (1, 2, 3))).quantities)
    assert of_response > 5e-4
    assert greatest(every_branch(system).quantities) == pytest.approx(of_response, rel=1e-6)


AIM = {"optimum": {"vary": [KEY], "bounds": [[50.0, 160.0]], "minimise": "peak.tip"}}


def test_the_harmonics_of_a_least_peak_are_those_of_the_branch_that_it_is_on():
    """One harmonic has a detached branch at 150 N, 20 times as high as the motion there. Without it the
    response was as right as was asked, so that 150 N were told with one harmonic."""
    scene = blade(**AIM)
    number = number_of(scene, KEY)
    task = PeakTask(number.freed(scene).each_curve()[0], [number], 1e-2)
    found = Optimal({}, {KEY: 150.0}, ("peak.tip",), 1.6e-3, (), "bound", (1,))
    assert set(task.needed(found, (1,))) >= {1, 2, 3}


def test_a_peak_that_falls_until_it_leaves_the_range_is_not_at_a_corner():
    """The range ends at 400 Hz, and the peak goes from 389 Hz at 10 N to 425 Hz at 160 N."""
    short = {"frequency": [80.0, 400.0], "output": ["tip"]}
    aim = {"vary": [KEY], "bounds": [[10.0, 160.0]], "minimise": "peak.tip"}
    (best,) = optimise(blade(optimum=aim, response=short), harmonics=1).tracking.optima
    assert best.kind == "corner" and best.leaves_range == pytest.approx(2.0 * np.pi * 400.0)
    beyond = trace(blade(best.values[KEY] + 1.0, response={"frequency": [80.0, 420.0]}), harmonics=1)
    assert 400.0 < beyond.curves[0].peaks["tip"].frequency / (2.0 * np.pi) < 402.0


@pytest.mark.slow
def test_the_least_peak_is_where_the_detached_branch_ends():
    """It was told as 40 times what it is, at an end of the bounds, by one harmonic. How far the end is off
    is told, or that it cannot be."""
    found = optimise(blade(**AIM))
    (best,) = found.tracking.optima
    value = best.values[KEY]
    assert best.kind == "end" and best.higher is None
    assert best.end_error <= 1e-2 or "at which a higher peak ends" in found.curves[0].short_of
    sweep = trace(blade(sweep={KEY: [0.97 * value, 1.03 * value]}))
    below, above = (curve.peaks["tip"].amplitude for curve in sweep.curves)
    assert below > 3.0 * best.value and best.value < above < 1.1 * best.value
