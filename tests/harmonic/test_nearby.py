"""Windows of several solutions that one harmonic puts beside the range, and more of them inside it."""

import pytest

from fcm.harmonic.choice import accurate
from fcm.harmonic.nearby import with_a_window
from fcm.harmonic.system import System
from fcm.harmonic.trace import traced

from ..motion.cases import yang
from .scenes import scene
from .truth import exact

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
    found = accurate(beyond(), accuracy)
    path, shown = max(
        zip(found.traced.branches.paths, found.shown, strict=True),
        key=lambda one: one[1].amplitude[:, 1].max(),
    )
    top = int(shown.amplitude[:, 1].argmax())
    peak = shown.amplitude[top, 1]
    assert peak == pytest.approx(exact(found.system, path.z[top])[1], rel=accuracy)
    assert found.reached
    starts = sorted(
        float(one.amplitude[i, 1])
        for path, one in zip(found.traced.branches.paths, found.shown, strict=True)
        for i in (path.parameter == 1.653).nonzero()[0]
    )
    assert starts[0] == pytest.approx(MARCHED[1], rel=0.03) and starts[-1] == pytest.approx(
        MARCHED[0], rel=0.03
    )


def test_where_no_level_turns_near_one_nothing_more_is_followed(monkeypatch):
    system = System(yang(100.0))
    found = traced(system).found
    monkeypatch.setattr("fcm.harmonic.nearby.solutions", None)
    assert with_a_window(system, found) == (1,)


def test_harmonics_that_have_the_same_solutions_stay():
    """Beyond the true fold as well the level turns near 1, but above it with any harmonics."""
    system = System(scene(MODAL, [STOP], (1.665, 2.05)))
    found = traced(system).found
    assert 1.0 < min(turn.level for turn in found[0].turns) < 2.0
    assert with_a_window(system, found) == (1,)
