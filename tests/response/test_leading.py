"""Many outputs: a curve is followed by a few of them, and all have the peaks that they have alone."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from fcm.accuracy.refinement import unchecked_with_given_harmonics
from fcm.harmonic_balance.system import System
from fcm.response.master_dofs import of_all_dofs, with_master_dofs
from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.response.track import TrackRequest, track
from fcm.scene import scene_from_dict

COUNT = 60  # masses in a row, between two walls
STIFFNESS = 4e4 * (2.0 * np.eye(COUNT) - np.eye(COUNT, k=1) - np.eye(COUNT, k=-1))
NAMES = [f"m{i}" for i in range(COUNT)]
ALONE = ["m3", "m30", "m44", "m58"]


def masses(output, modes, n_0):
    structure = {"dofs": NAMES, "mass": [1.0] * COUNT, "stiffness": STIFFNESS.tolist(), "damping": 0.01}
    contact = {"name": "c", "tangential": "m20", "normal": "m21", "mu": 0.5, "k_u": 900.0, "k_v": 300.0}
    return scene_from_dict(
        {
            # the flexibility of modes that are not kept would hang on the outputs
            "structure": structure | {"modes": modes, "flexibility": False},
            "contact": [contact | {"n_0": n_0}],
            "force": [{"dof": "m7", "amplitude": 1.0}],
            "response": {"frequency": [8.0, 34.0], "output": output},
        }
    )


def test_peaks_among_many_are_those_alone_and_cost_few_points():
    """Alone its peak is a point of the curve, found as it is followed; among many it is between points."""
    alone, among = (traced_curve(masses(o, 6, 2.0).in_use(), Request((1, 2, 3))) for o in (ALONE, ["*"]))
    for name in ALONE:
        one, other = among.peaks[name], alone.peaks[name]
        assert one.amplitude == pytest.approx(other.amplitude, rel=1e-9)
        assert one.frequency == pytest.approx(other.frequency, rel=1e-6)
        # a part of it is the typical error of the degrees of freedom, which are others
        assert one.error == pytest.approx(other.error, rel=0.1, abs=1e-5)
        assert one.stable == other.stable
    assert set(among.peaks) == set(NAMES) and np.any(alone.regime[:, 0] != "E")
    assert among.frequency.size < 1.3 * alone.frequency.size


def test_peaks_among_many_are_those_of_the_linear_structure():
    """The contact sticks: the greatest answers of the matrices with its springs."""
    curve = traced_curve(masses(["*"], COUNT, 50.0), Request((1, 2)))
    natural, shapes = np.linalg.eigh(STIFFNESS)
    damping = shapes @ np.diag(0.02 * np.sqrt(natural)) @ shapes.T
    whole = STIFFNESS + np.diag(900.0 * (np.arange(COUNT) == 20) + 300.0 * (np.arange(COUNT) == 21))

    def answer(omega, d):
        matrix = whole - omega**2 * np.eye(COUNT) + 1j * omega * damping
        return -abs(np.linalg.solve(matrix, np.eye(COUNT)[7])[d])

    for d in (0, 13, 29, 41, 59):
        peak = curve.peaks[f"m{d}"]
        around = (0.99 * peak.frequency, 1.01 * peak.frequency)
        top = minimize_scalar(answer, bounds=around, args=(d,), method="bounded", options={"xatol": 1e-8})
        assert peak.amplitude == pytest.approx(-top.fun, rel=1e-9)
        assert peak.frequency == pytest.approx(top.x, rel=1e-6)


def test_errors_of_many_outputs_may_take_as_long_as_those_of_few():
    """The budget is a part of the work of the response; of many outputs it was that of no work at all."""
    scene = masses(["*"], 6, 2.0)
    found = unchecked_with_given_harmonics(System(with_master_dofs(scene), (1, 2, 3)))
    every = of_all_dofs(found, scene)
    assert len(every.quantities[0].amplitude[0]) == COUNT > len(found.quantities[0].amplitude[0])
    assert every.system.work.seconds == found.system.work.seconds > 0.0


@pytest.mark.slow
def test_of_many_outputs_those_that_lead_are_tracked_and_the_others_are_said_to_be_left_out():
    found = track(masses(["*"], 2, 50.0), TrackRequest("peaks", "contact.c.n_0", (49.0, 50.0)), harmonics=1)
    assert found.tracking is not None and found.tracking.complete
    whats = {one.what for one in found.tracking.curves}
    assert {f"peak of {name}" for name in ("m7", "m20", "m21")} <= whats and len(whats) < 10
    (said,) = found.left_out
    assert f"of {COUNT} degrees of freedom" in said and "[response] output" in said
    curve = traced_curve(masses(["*"], 2, 50.0), Request((1,)))
    highest = max(one.amplitude[-1, found.dofs.index("m7")] for one in found.tracking.curves)
    assert highest == pytest.approx(curve.peaks["m7"].amplitude, rel=1e-8)
