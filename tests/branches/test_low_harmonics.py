"""Windows of several solutions that one harmonic puts beside the range, and more of them inside it."""

import numpy as np
import pytest

from fcm.accuracy.refinement import refined_response
from fcm.branches.force_level import with_low_harmonics
from fcm.branches.trace import traced
from fcm.harmonic_balance.system import System
from fcm.response.request import Request
from fcm.response.trace import traced_curve

from ..harmonic_balance.scenes import scene
from ..harmonic_balance.truth import exact

MODAL = {
    "dofs": ["u", "v"],
    "frequency": [1.3, 5.2],
    "damping": [0.007, 0.012],
    "shapes": [[0.25, 1.02], [0.9, -0.35]],
}
STOP = {"name": "stop", "tangential": "u", "normal": "v", "mu": 0.1, "k_u": 0.8, "k_v": 4.5, "gap": 4.375}
# amplitudes of v at 1.653 rad/s where a march of the contact law, by the method of Runge and Kutta, settles:
# from 13 of 120 random states, and from the others
MARCHED = (29.41, 0.9926)


def beyond():
    """One harmonic has its upper fold at 1.6439 rad/s, below the range; it is at 1.6553."""
    return System(scene(MODAL, [STOP], (1.653, 2.05)))


@pytest.mark.parametrize("accuracy", [1e-2, 1e-4])
def test_a_window_that_one_harmonic_has_outside_the_range_is_found(accuracy):
    found = refined_response(beyond(), accuracy)
    path, quantities = max(
        zip(found.traced.branches.paths, found.quantities, strict=True),
        key=lambda one: one[1].amplitude[:, 1].max(),
    )
    top = int(quantities.amplitude[:, 1].argmax())
    peak = quantities.amplitude[top, 1]
    assert peak == pytest.approx(exact(found.system, path.z[top])[1], rel=accuracy)
    assert found.reached
    starts = sorted(
        float(one.amplitude[i, 1])
        for path, one in zip(found.traced.branches.paths, found.quantities, strict=True)
        for i in (path.parameter == 1.653).nonzero()[0]
    )
    assert starts[0] == pytest.approx(MARCHED[1], rel=0.03) and starts[-1] == pytest.approx(
        MARCHED[0], rel=0.03
    )


def test_harmonics_that_have_the_same_solutions_stay():
    """Beyond the true fold as well the level turns near 1, but above it with any harmonics."""
    system = System(scene(MODAL, [STOP], (1.665, 2.05)))
    found = traced(system).found
    assert 1.0 < min(turn.level for turn in found[0].folds) < 2.0
    assert with_low_harmonics(system, found) == (1,)


IMPACTS = 0.776378  # amplitude of v
GAP = {
    "name": "gap",
    "tangential": "u",
    "normal": "v",
    "mu": 0.355,
    "k_u": 0.1748,
    "k_v": 31.502,
    "n_0": -15.623,
}
NEVER_CLOSED = {
    "dofs": ["v", "u"],
    "frequency": [1.0, 3.6523, 4.3209, 4.3311],
    "damping": [0.00959, 0.00625, 0.01156, 0.00713],
    "shapes": [[-0.071486, 0.032441], [1.0554, 0.96054], [-1.3723, -0.34316], [1.4898, 0.54145]],
}


def test_impacts_beside_a_gap_that_just_stays_open_are_found():
    """The open motion fills 0.91 of the gap, and the level of one harmonic does not turn. At 2.3427 rad/s a
    march of the exact motion settles, from each of 12 random states, at another one: that of IMPACTS."""
    of = scene(NEVER_CLOSED, [GAP], (2.1, 2.45))
    curve = traced_curve(of, Request(None, 1e-2))
    off, stays, v = curve.frequency - 2.3427, curve.stable != 0.0, curve.amplitude[:, 0]  # or just begins to
    passed = np.flatnonzero((off[:-1] * off[1:] < 0.0) & stays[:-1] & stays[1:])
    least, greatest = sorted((v[i] * off[i + 1] - v[i + 1] * off[i]) / (off[i + 1] - off[i]) for i in passed)
    assert curve.complete and least < 0.91 * 15.623 / 31.502
    assert greatest == pytest.approx(IMPACTS, rel=1e-2)
