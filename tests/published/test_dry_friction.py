"""TMDSimPy's example `2dof_eldry_fric` (github.com/tmd-lab/tmdsimpy), by that program, 1024 samples a cycle.

Its amplitudes are those of the fundamental. The integral over a corner of the force between two samples errs
by up to an eighth of the square of their distance, (2 pi / 1024)^2 / 8 = 5e-6: so far may these be off.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.model.scene import Load
from fcm.response import trace

PEAKS = {25: 10.499584, 50: 17.202195, 80: 32.168471, 100: 45.539025, 200: 124.093857, 300: 206.469541}
SAMPLED = 5e-6


def greatest(curve):
    """The greatest fundamental of the tangential displacement and its frequency, between points too."""
    at = int(np.nanargmax(curve.fundamental[:, 0]))
    near = slice(at - 1, at + 2)
    a, b, c = np.polyfit(curve.frequency[near] - curve.frequency[at], curve.fundamental[near, 0], 2)
    return c - b * b / (4.0 * a), curve.frequency[at] - b / (2.0 * a)


def test_peaks_with_one_harmonic():
    scene = fcm.load_scene("dry-friction")
    curves = trace(scene).curves
    assert len(curves) == len(PEAKS)
    for curve in curves:
        force = curve.parameters["force.tangent.amplitude"]
        assert curve.complete and not curve.folds
        assert curve.peaks["tangent"].amplitude == pytest.approx(PEAKS[force], rel=SAMPLED)
    assert curves[0].peaks["tangent"].frequency == pytest.approx(4.0288, abs=1e-4)


def test_the_peak_with_eight_harmonics():
    scene = replace(fcm.load_scene("dry-friction").curves[0], max_step=0.01)
    (curve,) = trace(scene, harmonics=8).curves
    assert greatest(curve)[0] == pytest.approx(10.52245, rel=SAMPLED)


@pytest.mark.parametrize("harmonics, peak", [(1, 40.019506), (3, 38.8184), (8, 38.83219)])
def test_with_lift_off(harmonics, peak):
    scene = replace(fcm.load_scene("dry-friction-lift-off"), max_step=0.01)
    (curve,) = trace(scene, harmonics=harmonics).curves
    amplitude, frequency = greatest(curve)
    assert amplitude == pytest.approx(peak, rel=SAMPLED)
    at = int(np.nanargmin(np.abs(curve.frequency - frequency)))
    assert "S" in curve.regime[at, 0]
    if harmonics != 3:
        assert frequency == pytest.approx({1: 3.5411, 8: 3.5504}[harmonics], abs=3e-4)


def test_the_static_load_makes_the_preload():
    (scene, *_), lifting = fcm.load_scene("dry-friction").curves, fcm.load_scene("dry-friction-lift-off")
    contact = replace(scene.contacts[0], n_0=0.0)
    load = Load(np.array([0.0, 1.0]), 100.0)
    (one,) = trace(replace(scene, contacts=(contact,), loads=(load,))).curves
    (other,) = trace(scene).curves
    assert one.peaks["tangent"][:2] == pytest.approx(other.peaks["tangent"][:2], rel=1e-9)
    assert one.mean[0, 1] - other.mean[0, 1] == pytest.approx(100.0 / 42.0)
    preloaded = replace(lifting, loads=(), contacts=(replace(lifting.contacts[0], n_0=50.0),))
    first, second = (trace(each, harmonics=1).curves[0] for each in (lifting, preloaded))
    assert first.peaks["tangent"][:2] == pytest.approx(second.peaks["tangent"][:2], rel=1e-9)
