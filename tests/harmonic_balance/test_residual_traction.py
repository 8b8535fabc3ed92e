"""How far a peak ranges with the friction that a contact keeps which sticks all through the cycle."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fcm
from fcm.continuation.corrector import Newton
from fcm.harmonic_balance.modal_condensation import CondensationOptions
from fcm.harmonic_balance.residual_traction import TractionOptions, peak_changes
from fcm.harmonic_balance.system import System
from fcm.response.exact import trace_exact
from fcm.scene import scene_from_dict

SHOOTING = Path(__file__).parent.parent / "shooting/scenes"


def scene(n_0, holding=(), shapes=None, frequency=(1.0, 3.0, 10.0)):
    """An oscillator a that slides on b with a preload; b, a spring of 9, and c may be held by a contact."""
    shapes = np.eye(len(frequency)).tolist() if shapes is None else shapes
    sliding = {"name": "A", "tangential": "a", "normal": {"b": 1.0}, "mu": 0.5, "k_u": 1.0, "k_v": 1.0}
    names = ["a", "b", "c", "d"][: len(frequency)]
    return scene_from_dict(
        {
            "modal": {
                "dofs": names, "frequency": list(frequency), "damping": [0.02] * len(names), "shapes": shapes,
            },
            "contact": [sliding | {"n_0": n_0}, *holding],
            "force": [{"dof": "a", "amplitude": 1.0}],
            "response": {"frequency": [0.8, 1.6], "harmonics": 3},
        },
        "held",
    )  # fmt: skip


HELD = {"name": "B", "tangential": "b", "normal": "c", "mu": 0.3, "k_u": 2.0, "k_v": 1.0, "n_0": 1.0}


def peak(response, dof="a"):
    return response.peak_amplitude.sel(dof=dof).item()


def test_a_residual_force_shifts_the_preload_of_the_contact_beside():
    """K b + k_v b + t = 0 with |t| <= mu n of B: the preload of A is n_0 -+ k_v mu n / (K + k_v)."""
    told = fcm.respond(scene(1.0, [HELD]))
    at_most = told.peak_residual_change.sel(dof="a").item()
    shift = 0.3 * 1.0 / (9.0 + 1.0)
    base, *ends = (peak(fcm.respond(scene(n))) for n in (1.0, 1.0 - shift, 1.0 + shift))
    assert peak(told) == pytest.approx(base, rel=1e-6)
    expected = max(abs(end - base) for end in ends) / base
    assert expected > 0.005 and at_most == pytest.approx(expected, rel=1e-2)


@pytest.mark.parametrize(
    ("preload", "changes"),
    [(5.0, np.sqrt(2.01 / 1.01) - 1.0), (-5.0, 1.0 - np.sqrt(1.01 / 2.01)), (80.0, 0.0), (-120.0, 0.0)],
)
def test_a_kept_force_that_opens_or_closes_a_stop_changes_a_peak_that_is_linear(preload, changes):
    """A spring of 1, a stop of 1 at a preload, a contact of 0.01 that sticks with up to 100: this moves
    the mean by 50 or 99. Open or closed all through, the peak is F / (c omega): the derivative of it is zero.
    """
    stop = {"name": "stop", "tangential": "v", "normal": "u", "mu": 0.0, "k_u": 0.0, "k_v": 1.0}
    rub = {"name": "rub", "tangential": "u", "normal": "v", "mu": 1.0, "k_u": 0.01, "k_v": 0.01, "n_0": 100.0}
    given = scene_from_dict(
        {
            "modal": {"dofs": ["u", "v"], "frequency": [1.0, 3.0], "damping": 0.005, "shapes": np.eye(2)},
            "contact": [stop | {"n_0": preload}, rub],
            "force": [{"dof": "u", "amplitude": 0.001}],
            "response": {"frequency": [0.5, 2.0], "harmonics": 1},
        }
    )
    told = fcm.respond(given).peak_residual_change.sel(dof="u").item()
    assert told == pytest.approx(changes, rel=1e-3, abs=1e-9)


def test_in_a_plane_the_residual_force_points_where_it_changes_most():
    """The normal of A is between two directions in which B may keep a force of any direction."""
    held = HELD | {"tangential": ["b", "d"]}
    planar = scene(1.0, [held], frequency=(1.0, 3.0, 10.0, 3.0))
    first = replace(planar.contacts[0], normal=np.array([0.0, 0.6, 0.0, 0.8]))
    told = fcm.respond(replace(planar, contacts=(first, *planar.contacts[1:]), draft=None))
    shift = 0.3 * 1.0 / (9.0 + 1.0)
    base, *ends = (peak(fcm.respond(scene(n))) for n in (1.0, 1.0 - shift, 1.0 + shift))
    expected = max(abs(end - base) for end in ends) / base
    assert told.peak_residual_change.sel(dof="a").item() == pytest.approx(expected, rel=2e-2)


def test_nothing_ranges_where_nothing_feels_it_or_all_slip():
    apart = HELD | {"tangential": "c", "normal": "b"}  # c presses on nothing
    assert fcm.respond(scene(1.0, [apart])).peak_residual_change.values.max() == pytest.approx(0.0, abs=1e-6)
    assert fcm.respond(scene(1.0)).peak_residual_change.values.max() == 0.0


@pytest.mark.slow
def test_the_range_holds_the_peaks_of_exact_motions_from_any_start():
    """With impacts beside, each start of the contact that sticks gives an exact curve of its own."""
    whole = fcm.load_scene(SHOOTING / "not_unique.toml")
    given = replace(whole, frequency_range=(1.4, 1.5), harmonics=tuple(range(1, 10)))
    told = fcm.respond(given)
    at_most = told.peak_residual_change.sel(dof="v").item()
    base, starts = peak(told, "v"), (-21.0, -10.0, 0.0, 10.0)
    found = []
    for friction in starts:
        start = replace(whole.start, friction=np.array([0.0, friction]))
        (curve,) = trace_exact(replace(whole, start=start, frequency_range=(1.4, 1.5), max_step=0.3)).curves
        found.append(curve.peaks["v"].amplitude)
    furthest = max(abs(one - base) for one in found) / base
    assert furthest > 0.5 and at_most == pytest.approx(furthest, rel=0.05)


def test_the_run_says_one_number_beside_the_peak(tmp_path, fcm):
    text = (SHOOTING / "not_unique.toml").read_text().replace("[0.8, 2.2]", "[1.4, 1.5]")
    (tmp_path / "model.toml").write_text(text.partition("[start]")[0])
    done = fcm("respond", tmp_path / "model.toml", "--harmonics", "3", "--json")
    change = max(one["residual_change"] for one in json.loads(done.out)["curves"][0]["peak"].values())
    assert change > 0.1 and done.err.count("past decides") == 1
    assert f"by up to {float(f'{100.0 * change:.2g}'):g} % of it" in done.err
    table = fcm("respond", tmp_path / "model.toml", "--harmonics", "3").out
    assert "residual" in table and f"{float(f'{100.0 * change:.2g}'):g} %" in table


def test_systems_condensed_to_modes_tell_the_same():
    """As those of many contacts are."""
    held = scene(1.0, [HELD])
    omega = fcm.respond(held).peak_frequency.sel(dof="a").item()
    told = []
    for options in (CondensationOptions(), CondensationOptions(min_unknowns=1, max_fraction=2.0)):
        system = System(held, (1, 3), condensation=options)
        newton = Newton(system.new_balance())
        newton.z[-1], newton.row[-1] = omega, 1.0
        newton.problem.evaluate_scale(newton.z)
        newton.scale[:] = newton.problem.scale
        assert newton.correct(1.0) and (newton.problem.rank > 0) == (options.min_unknowns == 1)
        z, newton_row = np.array(newton.z), np.zeros(len(newton.z))
        newton.problem.evaluate_outputs(z, newton_row)
        amplitude, stuck = np.array(newton.problem.output)[None], np.zeros((3, 2), dtype=bool)
        stuck[:, 1] = True
        told.append(peak_changes(system, z[None], amplitude, np.zeros(3, dtype=np.intp), stuck)[0])
    assert told[0] > 0.005 and told[1] == pytest.approx(told[0], rel=1e-4)


def test_the_way_to_the_limits_ends_where_it_takes_too_many_members():
    """The first member is at the limits; with none allowed the change is not told."""
    held = scene(1.0, [HELD])
    system = System(held, (1, 3))
    newton = Newton(system.new_balance())
    newton.z[-1], newton.row[-1] = fcm.respond(held).peak_frequency.sel(dof="a").item(), 1.0
    newton.problem.evaluate_scale(newton.z)
    newton.scale[:] = newton.problem.scale
    assert newton.correct(1.0)
    z = np.array(newton.z)
    newton.problem.evaluate_outputs(z, np.zeros(len(z)))
    amplitude, stuck = np.array(newton.problem.output)[None], np.zeros((3, 2), dtype=bool)
    stuck[:, 1] = True
    top = np.zeros(3, dtype=np.intp)
    one, none = (
        peak_changes(system, z[None], amplitude, top, stuck, TractionOptions(max_members=most))[0]
        for most in (1, 0)
    )
    assert one > 0.005 and np.isnan(none)


@pytest.mark.slow
def test_a_peak_in_the_corner_where_a_contact_in_a_plane_begins_to_slip_has_a_number_too():
    """On the way up A begins to slip before the peak of a member that always sticks, which is not counted.

    Of members that stick, found at each frequency from sliders that begin elsewhere, the highest points are
    up to 0.17 % lower, and 0.1 % higher.
    """
    given = scene_from_dict(
        {
            "frequency_unit": "Hz",
            "modal": {
                "dofs": ["x", "y", "z"], "frequency": [1.0, 1.35, 3.1], "damping": [0.01, 0.012, 0.02],
                "mass": [1.0, 2.0, 1.0], "shapes": [[0.9, 0.2, 0.15], [-0.25, 1.1, -0.3], [0.3, 0.35, 0.9]],
            },
            "contact": [
                {"name": "A", "tangential": ["x", "y"], "normal": "z", "mu": 0.8, "k_u": 32.0, "k_v": 44.0,
                 "n_0": 30.0},
                {"name": "B", "tangential": {"x": 1.0, "y": -0.5}, "normal": "z", "mu": 0.8, "k_u": 10.0,
                 "k_v": 20.0, "gap": 0.02},
            ],
            "force": [
                {"dof": "x", "amplitude": 10.0},
                {"dof": "x", "amplitude": 3.0, "phase": np.pi / 3.0},
                {"dof": {"y": 1.0, "z": -0.5}, "amplitude": 6.0, "phase": 0.5},
            ],
            "load": [{"dof": "z", "force": 2.0}],
            "response": {"frequency": [1.5, 1.6], "harmonics": 4},
        }
    )  # fmt: skip
    told = fcm.respond(given)
    assert peak(told, "y") == pytest.approx(0.712994, rel=1e-5)
    assert 0.001 < told.peak_residual_change.sel(dof="y").item() < 0.004


@pytest.mark.slow
def test_no_member_counts_on_which_the_contact_would_slip():
    """That with its traction at the limit went on sticking beyond, to a peak 27 % away.

    Of motions that begin elsewhere, found at each frequency, the peaks are 0.4 % lower and 0.5 % higher.
    """
    given = scene_from_dict(
        {
            "modal": {
                "dofs": ["x", "y", "z"], "frequency": [1.0, 1.35, 3.1], "damping": [0.01, 0.012, 0.02],
                "mass": [1.0, 2.0, 1.0],
                "shapes": [[1.12, 0.268, 0.042], [-0.502, 0.721, -0.296], [0.138, 0.176, 0.856]],
            },
            "contact": [
                {"name": "A", "tangential": ["x", "y"], "normal": "z", "mu": 0.478, "k_u": 2.81, "k_v": 1.25,
                 "n_0": 6.27},
                {"name": "B", "tangential": {"x": 1.0, "y": -0.5}, "normal": {"z": 1.0, "y": 0.93}, "mu": 0.5,
                 "k_u": 1.0, "k_v": 1.5, "n_0": 0.295},
            ],
            "force": [
                {"dof": "x", "amplitude": 0.327},
                {"dof": {"y": 1.0, "z": -0.5}, "amplitude": 0.2, "phase": 0.5},
            ],
            "load": [{"dof": "z", "force": 0.1}],
            "response": {"frequency": [1.6, 1.8], "harmonics": 3},
        }
    )  # fmt: skip
    assert 0.003 < fcm.respond(given).peak_residual_change.sel(dof="z").item() < 0.01
