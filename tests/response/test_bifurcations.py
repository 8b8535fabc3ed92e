"""Where stability changes without a fold: told of curves of the balance and of exact ones alike."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import fcm
from fcm.response import trace
from fcm.response.exact import trace_exact

from ..time_domain.cases import yang


def test_the_balance_and_the_exact_motion_tell_the_same_period_doublings():
    scene = replace(yang(0.0), frequency_range=(0.7, 0.82))
    (balanced,), (exact,) = trace(scene, harmonics=9).curves, trace_exact(scene).curves
    assert [kind for kind, _ in balanced.bifurcations] == ["period doubling"] * 2
    assert [kind for kind, _ in exact.bifurcations] == ["period doubling"] * 2
    for (_, one), (_, other) in zip(sorted(balanced.bifurcations), sorted(exact.bifurcations), strict=True):
        assert one == pytest.approx(other, rel=2e-3)


def test_both_tell_the_same_neimark_sacker_bifurcation():
    path = Path(__file__).parents[1] / "harmonic_balance/scenes/chaos.toml"
    scene = replace(fcm.load_scene(path).each_curve()[0], frequency_range=(2.32, 2.38))
    (balanced,), (exact,) = trace(scene, harmonics=5).curves, trace_exact(scene).curves
    ((kind, at),) = exact.bifurcations
    assert kind == "Neimark-Sacker" and balanced.bifurcations == [(kind, pytest.approx(at, rel=2e-3))]
    assert balanced.summary()["bifurcations"] == [{"kind": kind, "frequency": balanced.bifurcations[0][1]}]
