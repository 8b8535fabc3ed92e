"""A signal while many points of a curve are evaluated: it is seen to before the last."""

import signal

import numpy as np
import pytest

from fcm.harmonic_balance.residual import PointQuantities
from fcm.harmonic_balance.system import System

from .strips import planar_strip

SOON = 0.02  # [s]


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs a timer of the system")
def test_a_signal_is_seen_to_between_points():
    system = System(planar_strip(), (1, 2, 3))
    z = np.ones((20_000, system.layout.unknowns + 1))
    still, level = np.zeros_like(z), np.ones(len(z))
    points = PointQuantities(system.new_balance(), len(z))

    def interrupted(_number, _frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupted)
    try:
        signal.setitimer(signal.ITIMER_REAL, SOON)
        with pytest.raises(KeyboardInterrupt):
            points.evaluate(z, still, level)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert np.asarray(points.force)[0].any() and not np.asarray(points.force)[-1].any()
