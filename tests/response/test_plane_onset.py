"""Onsets of slip of a contact in a plane under a varying load, where the forces begin as a root."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fcm.response import trace
from fcm.results.result import Curve

from .random_planes import random_plane


def curve_of(seed: int, harmonics: int) -> Curve:
    scene = replace(random_plane(seed, contacts=1), harmonics=tuple(range(1, harmonics + 1)))
    return trace(scene, method="closed-form").curves[0]


@pytest.mark.parametrize(("seed", "harmonics"), [(16, 1), (19, 1), (3, 3), (8, 3), (19, 3)])
def test_a_curve_goes_on_where_slip_begins(seed: int, harmonics: int) -> None:
    """It may leave in the direction that it came from: a cusp."""
    curve = curve_of(seed, harmonics)
    assert curve.complete, curve.reason
    assert {"E", "EPEP"} <= set(curve.regime[:, 0].tolist())


def test_slip_begins_at_a_cusp() -> None:
    """On both sides of the onset at 1.4578 the curve is at lower frequencies."""
    curve = curve_of(16, 1)
    state = curve.regime[:, 0]
    onsets = np.flatnonzero((state[:-1] == "EPEP") & (state[1:] == "E"))
    (onset,) = onsets[np.abs(curve.frequency[onsets] - 1.4578) < 1e-4]
    before, here, after = curve.frequency[onset - 1 : onset + 2]
    assert before < here
    assert after < here
    assert curve.frequency[onset : onset + 20].min() < here - 1e-4
