"""Estimated errors of forces, slip and energy beside those of the exact motion."""

import csv
import json

import netCDF4
import numpy as np
import pytest

import fcm
from fcm.accuracy.contact_load_errors import relative
from fcm.accuracy.options import PAIR
from fcm.continuation import Mark
from fcm.harmonic_balance.contact_cycles import contact_loads_along
from fcm.harmonic_balance.system import System
from fcm.response.exact import trace_exact
from fcm.response.level import LevelRequest, trace_levels
from fcm.response.mode import ModeRequest, trace_modes
from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.shooting.orbit_record import recorded
from fcm.shooting.periodic_orbit import periodic
from fcm.shooting.problem import OrbitProblem
from fcm.time_domain import SimulationError

from ..harmonic_balance.truth import SAME, Truth, scene, state
from .calibration import with_estimated_errors

NAMES = ("greatest_normal_force", "greatest_friction_force", "slip_path", "dissipated_energy")
SMALLEST = 1e-3  # errors below are not compared


def exactly(truth, z):
    """What the contacts bear in the exact motion beside one of many harmonics; None if none is found."""
    try:
        orbit = periodic(truth.many.scene, float(z[-1]), state(truth.many, z))
    except SimulationError:
        return None
    if np.abs(orbit.measure.amplitude / truth.amplitude(z) - 1.0).max() > SAME:
        return None
    problem = OrbitProblem(truth.many.scene)
    return recorded(problem, problem.z(orbit.state, orbit.frequency)).contact_loads


def pairs(system, number):
    """(told, true) of each output, and how many of the points are told."""
    found, truth, both, told = with_estimated_errors(system, 0.0), Truth(system), [[], [], [], []], []
    for path, errors in zip(found.traced.branches.paths, found.errors, strict=True):
        own = contact_loads_along(system, path.z)
        at = np.linspace(1, len(path.z) - 2, number).astype(int)
        for i in np.setdiff1d(at, path.where(Mark.FOLD)):
            told.append(not np.isnan(errors.contact_loads[i]).any())
            z = truth.at(path.z[i], path.direction[i]) if told[-1] else None
            there = None if z is None else exactly(truth, z)
            if there is None:
                continue
            for k, c in np.ndindex(4, own.shape[1]):
                if own[i, c, k] > 1e-3 * own[:, c, k].max():
                    both[k].append((errors.contact_loads[i, c, k], abs(there[c, k] / own[i, c, k] - 1.0)))
    return both, np.mean(told)


@pytest.mark.parametrize(
    ("name", "preload", "harmonics"),
    [
        ("yang1998", 5, (1,)),
        ("yang1998", 0, (1, 2, 3)),
        ("yang1998", -5, (1, 2)),
        ("stuck_mean", None, (1,)),
    ],
)
def test_points_beside_the_exact_motion(name, preload, harmonics):
    """Nine in ten within a factor of two, of each output."""
    both, told = pairs(System(scene(name, preload), harmonics), 40)
    one_slips = name == "yang1998"  # of the other neither contact slips
    assert told > 0.7
    for of, known in zip(NAMES, both, strict=True):
        known = np.array(known)
        known = known[known.max(axis=1, initial=0.0) > SMALLEST] if len(known) else known.reshape(0, 2)
        if one_slips:
            assert len(known) > 10, of
        if not len(known):
            continue
        ratio = known[:, 0] / known[:, 1]
        assert np.mean((ratio > 0.5) & (ratio < 2.0)) >= 0.9, of


def test_a_contact_without_friction_closes_and_opens_with_any_number_of_harmonics():
    """As the exact motion says; its slider has no way."""
    one = scene("stuck_mean")
    exact = trace_exact(one, [1.9]).curves[0]
    assert set(exact.regime[:, 0]) == {"SE"} and not exact.cycle[:, 0, 1:].any()
    for harmonics in ((1,), (1, 2, 3)):
        curve = traced_curve(one, Request(harmonics, 1e-2))
        assert set(curve.regime[:, 0]) == {"S", "SE"} and not curve.cycle[:, 0, 1:].any()


@pytest.mark.parametrize("preload", [20, 5, 0, -5])
def test_the_greatest_of_a_curve_beside_that_of_many_harmonics(preload):
    one = scene("yang1998", preload)
    few, many = (traced_curve(one, Request(tuple(range(1, n + 1)), 1e-2)).greatest for n in (1, 21))
    true = np.abs(many.value / few.value - 1.0)
    for told, is_really in zip(few.error.ravel(), true.ravel(), strict=True):
        if is_really > SMALLEST:
            assert is_really / 2.0 < told < 2.0 * is_really
        else:
            assert told < 3.0 * SMALLEST


@pytest.mark.slow
def test_at_levels_and_of_a_mode_beside_many_harmonics():
    """The same motion with more harmonics: at the level 1; of the mode at the same modal amplitude."""
    one = fcm.load_scene("yang1998-n5")
    few, many = (trace_levels(one, LevelRequest([1.3], (0.5, 1.5)), harmonics=n).curves[0] for n in (1, 15))
    here, there = (curve.cycle[curve.level == 1.0][0] for curve in (few, many))
    told = few.cycle_error[few.level == 1.0][0]
    assert told == pytest.approx(np.abs(there / here - 1.0), rel=0.5)
    few, many = (trace_modes(one, ModeRequest(1, (0.1, 10.0)), harmonics=n).curves[0] for n in (1, 9))
    here, there = few.cycle[-1], many.cycle[-1]
    assert few.mode.amplitude[-1] == pytest.approx(many.mode.amplitude[-1], rel=1e-9)
    assert few.cycle_error[-1] == pytest.approx(np.abs(there / here - 1.0), rel=0.7)


def test_of_nothing_an_error_is_nothing_or_infinite():
    change, own = np.array([[0.0, 1e-12, 0.1]]), np.array([[0.0, 0.0, 0.0]])
    found = relative(change, own, np.ones(3), PAIR)
    assert found.tolist() == [[0.0, 0.0, np.inf]]


def test_where_nothing_slips_or_opens_there_is_no_error():
    for preload in (100, -60):
        found = with_estimated_errors(System(scene("yang1998", preload)), 0.0)
        assert (found.errors[0].contact_loads == 0.0).all() and (found.errors[0].greatest == 0.0).all()


@pytest.mark.parametrize(
    "options",
    [
        (),
        ("--level", "0.5:1.5", "--at", 1.2),
        ("--mode", 1, "--level", "0.1:10"),
        ("--method", "exact", "--at", 1.2),
    ],
)
def test_files_and_json_have_them(fcm, tmp_path, options):
    run = fcm("respond", "yang1998-n5", *options, "--json", "-o", "a.nc", "--csv", "a.csv")
    (curve,) = json.loads(run.out)["curves"]
    with netCDF4.Dataset(tmp_path / "a.nc") as data, (tmp_path / "a.csv").open() as file:
        rows = list(csv.DictReader(file))
        for name in NAMES:
            told = np.ma.filled(data[f"{name}_error"][0, :, 0], np.nan)
            there = np.isfinite(np.ma.filled(data["frequency"][0], np.nan))
            assert "relative" in data[f"{name}_error"].long_name
            written = np.array([float(row[f"{name}_error shroud"]) for row in rows])
            assert np.array_equal(written, told[there], equal_nan=True)
            assert np.isfinite(written).any()
            values = np.ma.filled(data[name][0, :, 0], np.nan)
            top = curve["contacts"]["shroud"][name]
            assert top["greatest"] == values[there].max() == data[f"peak_{name}"][0, 0]
            assert top["error"] == data[f"peak_{name}_error"][0, 0] >= 0.0


def test_a_file_without_points_has_those_of_the_greatest(fcm, tmp_path):
    found = []
    for options in ((), ("--peaks-only",)):
        run = fcm("respond", "yang1998-n5", *options, "--json", "-o", "a.nc")
        found.append(json.loads(run.out)["curves"][0]["contacts"])
        with netCDF4.Dataset(tmp_path / "a.nc") as data:
            energy = found[-1]["shroud"]["dissipated_energy"]
            assert data["peak_dissipated_energy_error"][0, 0] == energy["error"]
    assert found[0] == found[1]


@pytest.mark.parametrize(
    ("options", "unknown"),
    [
        ((), []),
        (("--mode", 1, "--level", "0.1:10"), ["error u", "error v", "error_at_frequency u"]),
    ],
)
def test_errors_that_are_unknown_at_all_points_have_no_column(fcm, tmp_path, options, unknown):
    """Those of the amplitudes of nonlinear modes were columns of nan."""
    assert fcm("respond", "yang1998-n5", *options, "-o", "a.nc", "--csv", "a.csv").code == 0
    with (tmp_path / "a.csv").open() as file, netCDF4.Dataset(tmp_path / "a.nc") as data:
        head, *rows = csv.reader(file)
        assert all(len(row) == len(head) for row in rows)
        for name in ("error", "error_at_frequency"):
            values = np.ma.filled(data[name][0], np.nan)
            for i, dof in enumerate(data["dof"][:]):
                assert (f"{name} {dof}" in head) == np.isfinite(values[:, i]).any()
        columns = dict(zip(head, np.array(rows).T, strict=True))
        there = np.isfinite(np.ma.filled(data["frequency"][0], np.nan))
        amplitude = np.ma.filled(data["amplitude"][0, :, 0], np.nan)[there]
        assert columns["amplitude u"].astype(float).tolist() == amplitude.tolist()
    errors = [name for name in head if "error" in name.split()[0]]
    assert errors and not set(unknown) & set(errors)
    assert all(set(columns[name]) != {"nan"} for name in errors)
