"""How well the reported truncation error predicts the true one, peak by peak of the paper's oscillator."""

import numpy as np
import pytest

from .exact_peaks import peaks

SMALL = 1e-2  # a true error below this is small
EXACT = 1e-7  # to which the climb finds a peak of half-width 0.01 rad/s: 2e-6 from it at most, squared


@pytest.fixture(scope="module")
def found():
    return {peak.preload: peak for peak in peaks()}


def test_a_linear_peak_has_no_error(found):
    for preload in (100.0, -60.0):
        assert found[preload].truncation_error == 0.0
        assert found[preload].true_error == pytest.approx(0.0, abs=EXACT)


def test_a_large_error_is_predicted_within_a_factor_of_two(found):
    large = [peak for peak in found.values() if peak.true_error > SMALL]
    assert {peak.preload for peak in large} == {5.0, 2.0, 0.0, -5.0, -20.0}
    for peak in large:
        assert 0.5 < peak.truncation_error / peak.true_error < 2.0


def test_a_small_error_is_predicted_too(found):
    small = [peak for peak in found.values() if EXACT < abs(peak.true_error) < SMALL]
    assert {peak.preload for peak in small} == {50.0, 20.0, 10.0}
    for peak in small:
        assert 0.5 < peak.truncation_error / abs(peak.true_error) < 2.0


def test_the_worse_peaks_are_those_it_names(found):
    """Sorted by the estimate, the small true errors come before all large ones."""
    by_estimate = sorted(found.values(), key=lambda peak: peak.truncation_error)
    large = [abs(peak.true_error) > SMALL for peak in by_estimate]
    assert not np.any(np.diff(np.array(large, dtype=int)) < 0)
