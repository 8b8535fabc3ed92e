"""Section 4.3 and 4.4 of the paper, and the numbers confirmed for its oscillator by time simulation."""

from dataclasses import replace

import pytest

import fcm
from fcm.response import trace

PRELOADS = [100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 0.0, -5.0, -20.0, -60.0]


@pytest.fixture(scope="module", params=["table", "closed-form"])
def curves(request):
    response = trace(fcm.load_scene("yang1998"), request.param)
    assert response.complete
    return {curve.parameters["contact.shroud.n_0"]: curve for curve in response.curves}


def test_the_ten_preloads_of_figure_13(curves):
    assert list(curves) == PRELOADS


def test_least_peak_at_the_optimal_preload(curves):
    peaks = {n_0: curve.peaks["u"][0] for n_0, curve in curves.items()}
    assert min(peaks, key=peaks.get) == 10.0
    amplitude, frequency, *_ = curves[10.0].peaks["u"]
    assert amplitude == pytest.approx(6.236, abs=5e-4)
    assert frequency == pytest.approx(1.345, abs=5e-4)


def test_folds_and_peak_at_preload_5(curves):
    assert curves[5.0].folds == pytest.approx([1.2388, 1.1875], abs=1e-4)
    assert curves[5.0].peaks["u"][0] == pytest.approx(15.83, abs=5e-3)


def test_number_of_folds(curves):
    count = {n_0: len(curve.folds) for n_0, curve in curves.items()}
    assert {n_0: count[n_0] for n_0 in (5.0, -5.0, -20.0)} == {5.0: 2, -5.0: 2, -20.0: 2}
    assert {n_0: count[n_0] for n_0 in (10.0, 2.0, 0.0)} == {10.0: 0, 2.0: 0, 0.0: 0}


def test_hardening_and_softening(curves):
    """Section 4.4: a gap bends the peak to higher frequencies, a moderate preload to lower ones."""
    gap, preload = curves[-20.0], curves[5.0]
    assert gap.peaks["u"][1] > curves[-60.0].peaks["u"][1]
    assert preload.peaks["u"][1] < curves[100.0].peaks["u"][1]


@pytest.mark.parametrize(("n_0", "peak"), [(90.0, 34.2236), (100.0, 35.1325)])
@pytest.mark.parametrize("method", ["table", "closed-form"])
def test_peaks_near_the_fully_stuck_case(n_0, peak, method):
    scene = fcm.load_scene("yang1998-n5")
    stuck = replace(scene, contacts=(replace(scene.contacts[0], n_0=n_0),))
    curve = trace(stuck, method).curves[0]
    assert curve.peaks["u"][0] == pytest.approx(peak, abs=1e-4)


def test_fully_stuck_and_fully_separate_cases(curves):
    """Above n_0 = 90 the contact sticks through the whole curve; below -50 it stays open."""
    assert set(curves[-60.0].regime.ravel()) == {"S"}
    assert "S" not in set(curves[50.0].regime.ravel())
