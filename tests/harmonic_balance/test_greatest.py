"""Half the peak-to-peak displacement of several harmonics against motions that are sampled finely."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fcm.harmonic_balance.dense_jacobian import Amplitude
from fcm.harmonic_balance.options import HARMONIC_BALANCE
from fcm.harmonic_balance.system import System
from fcm.harmonic_balance.wave_extremes import half_peak_to_peak
from fcm.scene import load_scene

HARMONICS = (1, 2, 3)
ANGLES = np.linspace(0.0, 2.0 * np.pi, 20001)  # between two of them an extreme rises by 1e-7 at most
WAVES = np.exp(1j * np.outer(ANGLES, HARMONICS))


@pytest.fixture(scope="module")
def balance():
    return System(load_scene(Path(__file__).parent / "scenes" / "chaos.toml"), HARMONICS).new_balance()


def places(balance, count):
    """Unknowns and a frequency, by chance."""
    rng = np.random.default_rng(5)
    return np.column_stack((rng.normal(size=(count, balance.unknowns)), rng.uniform(1.0, 3.0, count)))


def motions(balance):
    """Of all degrees of freedom as just reported, (angle, dof)."""
    return (WAVES @ (np.asarray(balance.displacements.re) + 1j * np.asarray(balance.displacements.im))).real


def test_no_extreme_is_greater_than_the_one_reported(balance):
    """Also where two are nearly equal, and samples next to the lower one are the greatest."""
    for z in places(balance, 400):
        balance.evaluate(z)
        balance.evaluate_outputs(z, np.zeros(z.size))
        assert np.array(balance.output) == pytest.approx(0.5 * np.ptp(motions(balance), axis=0), rel=1e-6)


def test_an_extreme_is_followed_where_it_is_no_more_the_greatest(balance):
    """From one place to another, with its slopes; and it is nothing where there is no such extreme."""
    one, counts = Amplitude(balance, 1), {"lower": 0, "none": 0}
    for start in places(balance, 40):
        end = start + 0.5 * np.random.default_rng(6).normal(size=start.size)
        balance.evaluate(start)
        one.at(start)
        for part in np.linspace(0.0, 1.0, 41):
            z = start + part * (end - start)
            balance.evaluate(z)
            near = one.angles
            one.at(z, near)
            if np.isnan(one.value):
                counts["none"] += 1
                break
            x = motions(balance)[:, 1]
            high, low = (x[np.abs(ANGLES - angle % (2.0 * np.pi)).argmin()] for angle in one.angles)
            assert one.value == pytest.approx(0.5 * (high - low), rel=1e-6, abs=1e-6)
            assert np.abs(one.angles - near).max() < 1.0
            counts["lower"] += one.value < 0.5 * np.ptp(x) * (1.0 - 1e-6)
        else:
            direction, values = np.random.default_rng(7).normal(size=z.size), []
            slope, angles = one.slopes @ direction, one.angles
            for step in (1e-6, -1e-6):
                balance.evaluate(z + step * direction)
                one.at(z + step * direction, angles)
                values.append(one.value)
            assert slope == pytest.approx((values[0] - values[1]) / 2e-6, rel=1e-5, abs=1e-6)
    assert min(counts.values()) > 0


@pytest.mark.slow
def test_no_extreme_of_a_nonlinear_mode_is_greater_than_its_amplitude():
    parts = np.random.default_rng(5).normal(size=(2, 2000, len(HARMONICS), 1))
    X = parts[0] + 1j * parts[1]
    x = np.einsum("th,phd->tpd", WAVES, X).real
    assert half_peak_to_peak(X, HARMONICS) == pytest.approx(0.5 * np.ptp(x, axis=0), rel=1e-6)


def test_as_many_samples_as_the_options_say_are_taken_of_each_period():
    few, many = (
        replace(HARMONIC_BALANCE, extremes=replace(HARMONIC_BALANCE.extremes, samples=count))
        for count in (8, 20)
    )
    scene = load_scene(Path(__file__).parent / "scenes" / "chaos.toml")
    found = [System(scene, HARMONICS, options=one).new_balance().displacements.samples for one in (few, many)]
    assert found == [8 * 3, 20 * 3]
