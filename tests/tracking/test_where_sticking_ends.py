"""Peaks of two degrees of freedom that lie together where a contact ceases to stick.

The lower the preload, the sooner slip begins: at the peak itself, which then lies at a corner of the response
over a very short range of the preload, and on the side of slip below that.
"""

import numpy as np
import pytest

from fcm.harmonic_balance.system import System
from fcm.response import trace
from fcm.scene.draft import number_of
from fcm.scene.load import scene_from_dict
from fcm.tracking.curve import both_ways
from fcm.tracking.extended_system import Condition, Kind
from fcm.tracking.nonsmooth_continuation import land
from fcm.tracking.parameter_line import line_along
from fcm.tracking.start_points import special_points
from fcm.tracking.tracked_point import Ending, TrackingSetup

KEY, SPAN = "contact.c.n_0", (0.5, 1000.0)


def two_masses(detuning, k_u, damping, n_0=10.0):
    """Two alike masses with a contact between them, pushed out of phase."""
    return scene_from_dict(
        {
            "modal": {"dofs": ["a", "b", "n"], "frequency": [1.0, 1.0 + detuning, 5.0],
                      "damping": [damping, damping, 0.01], "shapes": np.eye(3).tolist()},
            "contact": [{"name": "c", "tangential": {"a": 1.0, "b": -1.0}, "normal": "n", "mu": 0.3,
                         "k_u": k_u, "k_v": 1.0, "n_0": n_0}],
            "force": [{"dof": "a", "amplitude": 1.0}, {"dof": "b", "amplitude": 1.0, "phase": 1.047}],
            "response": {"frequency": [0.8, 1.6], "harmonics": 1},
        }
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
    ("values", "dof"),
    [((0.01, 0.3, 0.003), 0), ((0.01, 0.3, 0.003), 1), ((0.02, 0.3, 0.001), 0), ((0.02, 0.3, 0.001), 1)],
    ids=["near-a", "near-b", "light-a", "light-b"],
)
def test_the_peak_is_followed_to_where_the_contact_slips(values, dof):
    """It was followed back to where it came from, and lost."""
    scene, condition = two_masses(*values), Condition(Kind.PEAK, dof)
    setup = TrackingSetup(System(scene, (1,)), line_along(number_of(scene, KEY)), SPAN, (), peaks_only=True)
    here = setup.system.with_scene(setup.line.scene(scene, SPAN[1]))
    points = [z for _, z in special_points(here, [condition]).points]
    heights = [land(setup, condition, np.append(z, SPAN[1])) for z in points]
    curves = [both_ways(setup, condition, point) for point in heights if point is not None]
    curve = max(curves, key=lambda one: one.amplitude[-1, dof])
    assert curve.endings == (Ending.SPAN, Ending.SPAN) and curve.greatest.all()
    for i in np.linspace(0, len(curve.s) - 1, 4).astype(int):
        there = trace(two_masses(*values, n_0=float(curve.s[i])), "closed-form").curves[0]
        at = there.amplitude[np.abs(there.frequency - curve.frequency[i]).argmin(), dof]
        assert at == pytest.approx(curve.amplitude[i, dof], rel=1e-6)
