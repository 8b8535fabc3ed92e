"""Stability, jumps and the error that the single harmonic leaves."""

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.response import trace

from .random_scenes import random_scene


@pytest.fixture(scope="module")
def curves():
    response = trace(fcm.load_scene("yang1998"), "table")
    return {curve.parameters["contact.shroud.n_0"]: curve for curve in response.curves}


def test_stability_changes_at_the_folds_and_nowhere_else(curves):
    for curve in curves.values():
        if curve.parameters["contact.shroud.n_0"] == 0.0:
            continue  # it loses stability near 0.75 rad/s without a fold: tests/stability
        known = np.isfinite(curve.stable)
        stable, frequency = curve.stable[known], curve.frequency[known]
        changes = np.flatnonzero(np.diff(stable))
        assert len(changes) == len(curve.folds)
        for k, fold in zip(changes, curve.folds, strict=True):
            assert min(abs(frequency[k : k + 2] - fold)) == 0.0


def test_the_part_between_the_folds_is_unstable(curves):
    curve = curves[5.0]
    upper, lower = curve.folds
    falling = np.concatenate((np.diff(curve.frequency) < 0.0, [False]))
    assert np.all(curve.stable[1:-1][falling[:-2] & falling[1:-1]] == 0.0)
    assert np.all(curve.stable[curve.frequency > upper + 1e-6] == 1.0)
    assert np.all(curve.stable[curve.frequency < lower - 1e-6] == 1.0)


def test_jumps_of_a_slow_sweep(curves):
    """Figure 14: upward the lower branch ends at the upper fold, downward the upper at the lower."""
    up, down = curves[5.0].jumps()
    assert (up.sweep, down.sweep) == ("up", "down")
    assert up.frequency == pytest.approx(1.2388, abs=1e-4)
    assert down.frequency == pytest.approx(1.1875, abs=1e-4)
    assert up.after[0] > up.before[0]
    assert down.after[0] < down.before[0]
    assert curves[10.0].jumps() == []


def test_the_truncation_error_vanishes_for_a_linear_response(curves):
    linear = curves[-60.0]
    assert set(linear.regime.ravel()) == {"S"}
    assert np.all(linear.truncation_error == 0.0)


def test_the_truncation_error_predicts_the_size_of_the_papers_discrepancy(curves):
    """Time simulation gives 14.8 where single-harmonic balance gives 15.83 (figure 14)."""
    curve = curves[5.0]
    predicted = curve.peaks["u"].error
    true = (15.83 - 14.8) / 14.8
    assert true / 2.0 < predicted < 2.0 * true
    assert curves[50.0].peaks["u"].error < 0.1 * predicted


@pytest.mark.slow
def test_contacts_too_stiff_for_the_table_are_traced_without_it():
    """A gap closed by springs 1e6 times as stiff as the structure: the right answer, and the run says how."""
    scene = replace(random_scene(26), max_step=0.1)
    by_table, exact = trace(scene, "table"), trace(scene, "closed-form")
    one, other = by_table.curves[0], exact.curves[0]
    assert one.complete and other.complete
    assert one.folds == pytest.approx(other.folds, rel=1e-6)
    for dof in one.peaks:
        assert one.peaks[dof][0] == pytest.approx(other.peaks[dof][0], rel=1e-6)


def test_a_contact_without_friction_opens_and_closes_and_may_be_unstable():
    """mu = 0 and a mu too small to matter are the same curve, with the same unstable part."""
    none, hardly = (
        trace(fcm.load_scene(f"extreme/{name}"), "closed-form").curves[0]
        for name in ("no-friction", "tiny-friction")
    )
    assert set(none.regime.ravel()) == {"E", "SE"}
    for curve in (none, hardly):
        between = (curve.frequency > min(curve.folds)) & (curve.frequency < max(curve.folds))
        first, last = np.flatnonzero(np.isin(curve.frequency, curve.folds))
        inner = np.arange(curve.points)
        inner = (inner > first) & (inner < last)
        assert inner.sum() > 10 and between[inner].all()
        assert not curve.stable[inner].any() and curve.stable[~inner].all()
    assert none.folds == pytest.approx(hardly.folds, rel=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [2, 10])
def test_stability_between_folds_ends_at_the_same_frequencies_whatever_the_step(seed):
    crossings = []
    for max_step in (0.2, 0.02):
        (curve,) = trace(replace(random_scene(seed), max_step=max_step)).curves
        changes = np.abs(curve.stable[2:] - curve.stable[:-2]) == 1.0
        crossings.append(curve.frequency[1:-1][changes & np.isnan(curve.stable[1:-1])].tolist())
    assert crossings[0]
    assert crossings[0] == pytest.approx(crossings[1], rel=1e-8)
