"""A window of instability that one point of a curve or two are in."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import fcm

SCENE = Path(__file__).parent / "scenes" / "one_point.toml"


@pytest.mark.slow
def test_a_point_is_unstable_where_the_exact_motion_is():
    scene = fcm.load_scene(SCENE)
    exact = fcm.respond(replace(scene, frequency_range=(0.905, 0.925)), method="exact")
    unstable = exact.frequency.values[0][exact.stable.values[0] == 0.0]
    assert 0.005 < unstable[-1] - unstable[0] < 0.01
    curve = fcm.respond(scene)
    frequency, stable = curve.frequency.values[0], curve.stable.values[0]
    within = (frequency > unstable[0]) & (frequency < unstable[-1])
    assert (stable[within] == 0.0).any()
    assert not (stable[within] == 1.0).any()
