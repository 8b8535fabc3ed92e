"""Peaks of a structure with a contact that slides in a plane, followed in a number, against ordinary runs."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import find_peaks

from fcm.harmonic_balance.system import System
from fcm.response import trace
from fcm.scene.draft import number_of
from fcm.scene.load import scene_from_dict
from fcm.tracking.curves import tracked_curves
from fcm.tracking.extended_system import Condition, Kind
from fcm.tracking.options import TRACKING
from fcm.tracking.parameter_line import line_along
from fcm.tracking.tracked_point import TrackingSetup


@pytest.fixture(scope="module")
def scene():
    """Three modes and a contact that slides in a plane; it begins to slip at folds close together."""
    modal = {
        "dofs": ["x", "y", "z"],
        "frequency": [1.0, 1.35, 3.1],
        "damping": [0.01, 0.012, 0.02],
        "shapes": [[0.9, 0.2, 0.15], [-0.25, 1.1, -0.3], [0.3, 0.35, 0.9]],
    }
    contact = {
        "name": "c", "tangential": ["x", "y"], "normal": "z",
        "mu": 0.3, "k_u": 0.8, "k_v": 1.1, "n_0": 3.0,
    }  # fmt: skip
    force = {"dof": "x", "amplitude": 1.0}
    response = {"frequency": [0.7, 1.9], "harmonics": 1}
    return scene_from_dict({"modal": modal, "contact": [contact], "force": [force], "response": response})


def followed(scene, key, span, dof):
    options = replace(TRACKING, curves=replace(TRACKING.curves, start_values=3))
    setup = TrackingSetup(System(scene, (1,)), line_along(number_of(scene, key)), span, options=options)
    return tracked_curves(setup, [Condition(Kind.PEAK, dof)]).curves


def ordinary(scene, key, value, dof):
    """Peaks (frequency, amplitude) of an ordinary run that stand out by a hundredth."""
    fine = replace(number_of(scene, key).put(scene, value), max_step=0.005)
    curve = trace(fine, "closed-form").curves[0]
    height = curve.amplitude[:, dof]
    tops, found = find_peaks(height, prominence=0.0)
    return [
        (curve.frequency[k], height[k])
        for k, stands in zip(tops, found["prominences"], strict=True)
        if stands > 0.01 * height[k]
    ]


def tracked_at(curves, value, dof):
    """Peaks (frequency, amplitude) of tracked curves at a value, between two of their points."""
    found = []
    for one in curves:
        for i in np.flatnonzero((one.s[:-1] - value) * (one.s[1:] - value) <= 0.0):
            part = (value - one.s[i]) / (one.s[i + 1] - one.s[i])
            ends = np.array([(one.frequency[k], one.amplitude[k, dof]) for k in (i, i + 1)])
            found.append(tuple(ends[0] + part * (ends[1] - ends[0])))
    return sorted(found)


@pytest.mark.slow
@pytest.mark.parametrize("dof", range(3))
def test_small_peaks_at_folds_close_together_begin_no_curve(scene, dof):
    """Where the contact begins to slip the response has local maxima of 2e-5 of their height."""
    curves = followed(scene, "contact.c.n_0", (2.0, 2.6), dof)
    assert all(one.whole for one in curves)
    for value in (2.2, 2.45):
        expected, found = ordinary(scene, "contact.c.n_0", value, dof), tracked_at(curves, value, dof)
        assert len(found) == len(expected) == 2
        assert np.array(found) == pytest.approx(np.array(expected), rel=2e-3)


@pytest.mark.slow
def test_a_peak_where_slip_begins_is_followed_along_that_corner(scene):
    """The sides of the corner are told apart beyond the rounding of its place."""
    curves = followed(scene, "contact.c.mu", (0.69, 0.7), 0)
    assert all(one.whole for one in curves)
    assert len(curves) == 2 and {point.corner.onset for point in curves[1].points if point.corner}
    expected, found = ordinary(scene, "contact.c.mu", 0.6955, 0), tracked_at(curves, 0.6955, 0)
    assert len(found) == len(expected) == 2
    assert np.array(found) == pytest.approx(np.array(expected), rel=2e-3)
