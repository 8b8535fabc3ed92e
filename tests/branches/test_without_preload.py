"""Branches of large motions beside small ones: near the peaks of the response without preloads and gaps."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fcm.branches.force_level import level_frequencies
from fcm.branches.trace import traced
from fcm.branches.without_preload import without_preload
from fcm.harmonic_balance.system import System
from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.scene import load_scene
from fcm.time_domain import State, simulate

from .hunt import on_branch

BLADE = load_scene(Path(__file__).parent / "scenes/large_motions.toml")


def with_preload(n_0, contacts=1):
    """The blade with one or several contacts of a preload."""
    return replace(BLADE, contacts=contacts * (replace(BLADE.contacts[0], n_0=n_0),))


@pytest.fixture(scope="module")
def marched():
    """Amplitudes (dof,) at 371.5 rad/s of the exact motion from a large displacement: 57 times those from
    rest."""
    begin = State(np.array([-2e-3, 0.0]), np.zeros(2), np.zeros(1))
    last, before = (one.amplitude for one in simulate(BLADE, 371.5, 600, begin).measures(last=2))
    assert np.abs(last / before - 1.0).max() < 1e-3
    return last


@pytest.mark.parametrize("harmonics", [(1, 2, 3, 4, 5), None])
def test_a_closed_branch_of_large_motions_is_found(marched, harmonics):
    """Seven times as high as the peak of the response from rest, which alone was called complete."""
    curve = traced_curve(BLADE, Request(harmonics, None if harmonics else 1e-2))
    assert curve.complete and curve.isolated
    assert on_branch(curve, 371.5, marched)
    assert curve.peaks["u"].amplitude > marched[0] > 3e-3


def test_the_level_is_followed_near_a_peak_without_preload():
    """Nothing else leads there: neither the resonances of stuck and open contacts, nor what lies between."""
    system = System(BLADE, (1, 2, 3))
    free = traced(without_preload(system)).own_peaks
    assert not any(abs(omega / 371.5 - 1.0) < 0.02 for omega in level_frequencies(system))
    assert any(abs(one.omega / 371.5 - 1.0) < 0.005 for one in free)


def test_the_response_of_great_forces_tends_to_that_without_preload():
    """That of s times the forces, divided by s, is that with n_0 / s."""

    def height(system):
        return max(one.size for one in traced(system).own_peaks)

    limit, off = height(without_preload(System(BLADE, (1, 2, 3)))), []
    for s in (1e2, 1e3, 1e4):
        off.append(abs(height(System(with_preload(6.0 / s), (1, 2, 3))) / limit - 1.0))
    assert off[0] > 3.0 * off[1] > 9.0 * off[2] and off[2] < 1e-4


def test_many_contacts_and_those_without_preload_are_left_out():
    """Hardly any of many contacts opens; and without preload the response is its own limit."""
    for scene in (with_preload(6.0, 12), with_preload(0.0)):
        assert without_preload(System(scene, (1,))) is None
