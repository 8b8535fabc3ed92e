"""Half the peak-to-peak displacement of several harmonics against motions that are sampled finely."""

from pathlib import Path

import numpy as np
import pytest

from fcm.harmonic.system import System
from fcm.scene import load_scene

HARMONICS = (1, 2, 3)
ANGLES = np.linspace(0.0, 2.0 * np.pi, 20001)  # between two of them an extreme rises by 1e-7 at most
WAVES = np.exp(1j * np.outer(ANGLES, HARMONICS))


@pytest.fixture(scope="module")
def balance():
    return System(load_scene(Path(__file__).parent / "scenes" / "chaos.toml"), HARMONICS).balance()


def places(balance, count):
    """Unknowns and a frequency, by chance."""
    rng = np.random.default_rng(5)
    return np.column_stack((rng.normal(size=(count, balance.unknowns)), rng.uniform(1.0, 3.0, count)))


def motions(balance):
    """Of all degrees of freedom as just reported, (angle, dof)."""
    return (WAVES @ (np.asarray(balance.shown.re) + 1j * np.asarray(balance.shown.im))).real


def test_no_extreme_is_greater_than_the_one_reported(balance):
    """Also where two are nearly equal, and samples next to the lower one are the greatest."""
    for z in places(balance, 400):
        balance.evaluate(z)
        balance.report(z, np.zeros(z.size))
        assert np.array(balance.output) == pytest.approx(0.5 * np.ptp(motions(balance), axis=0), rel=1e-6)
