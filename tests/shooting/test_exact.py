"""Curves of exact periodic solutions: folds, limits, step sizes, interruptions."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fcm
from fcm.response import ResponseError
from fcm.response.exact import trace_exact
from fcm.run import Execution
from fcm.shooting import periodic, trace_orbits
from fcm.time_domain import SimulationError, simulate

from ..interrupted import interrupted_after
from ..time_domain.cases import one_mode, two_contacts, yang
from .curves import between, curve_of


@pytest.fixture(scope="module")
def folded():
    """n_0 = 5 around its folds."""
    return curve_of(between(yang(), 1.17, 1.26))


def test_folds_are_where_solutions_end():
    """1e-6 inside a fold shooting finds a solution from either side of it; 1e-6 beyond, none near it."""
    branch = trace_orbits(between(yang(), 1.185, 1.245, max_step=0.1))
    assert len(branch.folds) == 2
    for fold, inward in zip(branch.folds, (-1.0, 1.0), strict=True):
        k = branch.orbits.index(fold)
        sides = [branch.orbits[k - 1].state, branch.orbits[k + 1].state]
        size = np.abs(fold.state.q).max()
        one, other = (periodic(yang(), fold.frequency * (1.0 + 1e-6 * inward), side) for side in sides)
        assert {one.stable, other.stable} == {True, False}
        assert 0.0 < np.abs(one.state.q - other.state.q).max() < 0.05 * size
        for side in sides:
            try:
                beyond = periodic(yang(), fold.frequency * (1.0 - 1e-6 * inward), side)
            except SimulationError:
                continue
            assert np.abs(beyond.state.q - fold.state.q).max() > 0.2 * size


def test_folds_of_the_paper_s_preload(folded):
    """Beside 1.2388 and 1.1875 of the single harmonic; the upper state lives at 1.195 and not at 1.190, the
    lower one at 1.235 and not at 1.240."""
    up, down = folded.folds
    assert 1.235 < up < 1.240 and 1.190 < down < 1.195
    assert [(jump.sweep, jump.frequency) for jump in folded.jumps()] == [("up", up), ("down", down)]
    unstable = folded.frequency[folded.stable == 0.0]
    assert unstable.min() > down and unstable.max() < up


@pytest.mark.slow
@pytest.mark.parametrize(
    "scene",
    [between(yang(10.0), 1.47, 1.56), between(yang(), 1.185, 1.245), between(two_contacts(), 1.045, 1.07)],
    ids=["slip to stick", "folds", "folds 4e-5 apart"],
)
def test_peaks_and_folds_do_not_depend_on_the_step(scene):
    fine, coarse = (curve_of(replace(scene, max_step=step)) for step in (0.02, 0.2))
    assert fine.complete and coarse.complete
    assert coarse.points < fine.points
    assert coarse.folds == pytest.approx(fine.folds, rel=1e-8)
    for dof in fine.peaks:
        assert coarse.peaks[dof][0] == pytest.approx(fine.peaks[dof][0], rel=1e-6)


def linear(scene, omega, stuck):
    """Amplitudes of u and v with every contact a pair of springs, or nothing."""
    modal = scene.modal
    dynamic = np.diag(
        modal.mass * (modal.frequency**2 - omega**2 + 2j * modal.damping * modal.frequency * omega)
    )
    for contact in scene.contacts if stuck else ():
        u, v = modal.shapes @ contact.tangential, modal.shapes @ contact.normal
        dynamic += contact.k_u * np.outer(u, u) + contact.k_v * np.outer(v, v)
    push = modal.shapes @ sum(f.direction * f.amplitude * np.exp(1j * f.phase) for f in scene.forces)
    return modal.shapes.T @ np.linalg.solve(dynamic, push)


@pytest.mark.parametrize(("n_0", "stuck", "regime"), [(1e5, True, "E"), (-1e5, False, "S")])
def test_linear_limits(n_0, stuck, regime):
    curve = curve_of(replace(yang(n_0), max_step=0.2))
    assert curve.complete and set(curve.regime.ravel()) == {regime} and curve.stable.all()
    exact = np.array([linear(yang(n_0), omega, stuck) for omega in curve.frequency])
    assert curve.amplitude == pytest.approx(np.abs(exact), rel=1e-8)
    assert curve.fundamental == pytest.approx(np.abs(exact), rel=1e-8)
    assert np.exp(1j * curve.phase) == pytest.approx(exact / np.abs(exact), abs=1e-8)


def test_points_are_those_of_a_long_simulation():
    scene = between(one_mode(), 0.9, 1.2)
    curve = curve_of(replace(scene, max_step=0.2))
    for k in range(0, curve.points, 9):
        if curve.stable[k]:
            last = simulate(scene, curve.frequency[k], 200).measures(last=1)[0]
            assert curve.amplitude[k] == pytest.approx(last.amplitude, rel=1e-6)
            assert curve.mean[k] == pytest.approx(last.mean, abs=1e-6)


def test_closure_error_is_rounding(folded):
    assert np.nanmax(folded.orbits.closure_error) < 1e-9
    assert not folded.table_error.any() and not folded.truncation_error.any()


@pytest.mark.parametrize("frequency", [(0.7, 0.9), (1.1, 1.3)])
def test_without_damping(frequency):
    """Beside the resonance the open oscillator is the sum of its modes; through it there is no curve."""
    scene = yang(-1e15)
    scene = replace(scene, modal=replace(scene.modal, damping=np.zeros(2)), max_step=0.2)
    curve = curve_of(between(scene, *frequency))
    assert curve.complete
    exact = [np.abs(linear(scene, omega, stuck=False)) for omega in curve.frequency]
    assert curve.amplitude == pytest.approx(np.array(exact), rel=1e-7)


def test_an_undamped_resonance_is_named():
    scene = yang(-1e15)
    scene = replace(scene, modal=replace(scene.modal, damping=np.zeros(2)), max_step=0.2)
    curve = curve_of(between(scene, 0.95, 1.05))
    assert not curve.complete and "stopped at 1 rad/s" in curve.reason and "add damping" in curve.reason


def test_no_force_no_motion():
    curve = curve_of(one_mode(force=0.0))
    assert curve.complete and not curve.amplitude.any()


def test_a_contact_without_friction_slides_nowhere():
    curve = curve_of(between(one_mode(mu=0.0, n_0=0.5), 0.9, 1.3, max_step=0.2))
    assert curve.complete and set(curve.regime.ravel()) <= {"E", "S", "SE"}


def test_hertz():
    scene = between(one_mode(), 0.8, 1.2, max_step=0.2, frequency_unit="Hz")
    data = fcm.respond(scene, "exact")
    assert data.frequency.values[0, [0, -1]] == pytest.approx(np.array([0.8, 1.2]) / (2.0 * np.pi))
    (visited,) = trace_exact(scene, at=[1.0 / (2.0 * np.pi)]).curves
    assert visited.frequency == pytest.approx([1.0, 1.0])


def test_the_dataset_has_the_layout_of_every_response():
    scene = between(one_mode(), 0.9, 1.1, max_step=0.2)
    exact, balanced = fcm.respond(scene, "exact"), fcm.respond(scene, "closed-form", harmonics=1)
    of_balance = {"harmonic", "harmonic_amplitude", "harmonic_phase"}
    assert set(balanced.variables) - set(exact.variables) == of_balance
    for name in set(balanced.variables) - of_balance:
        assert exact[name].dims == balanced[name].dims
    assert set(exact.variables) - set(balanced.variables) == {
        "closure_error", "sweep",
        "repeats", "cycle_least", "cycle_greatest", "family_least", "family_greatest", "family_complete",
    }  # fmt: skip
    assert exact.fundamental.dims == exact.amplitude.dims
    # the greatest displacement is never less than what one harmonic of three can hide
    assert (exact.amplitude >= 0.75 * exact.fundamental).all()


def test_what_cannot_be_asked_for():
    scene = one_mode()
    for wrong in ([], [0.0], [-1.0], [np.nan], [1.0, np.inf]):
        with pytest.raises(ResponseError, match="positive"):
            trace_exact(scene, at=wrong)
    with pytest.raises(ResponseError, match='need the method "exact"'):
        fcm.respond(scene, "table", at=[1.0])
    with pytest.raises(ResponseError, match="table, closed-form, exact"):
        fcm.respond(scene, "magic")


def test_an_interrupted_curve_keeps_its_points():
    curve = curve_of(one_mode(), progress=interrupted_after(7))
    assert not curve.complete and curve.points == 8
    assert curve.reason.startswith("interrupted at ") and curve.reason.endswith(" rad/s")


def test_an_interrupted_sweep_goes_on(tmp_path):
    curves = tuple(replace(one_mode(n_0=n), parameters={"n_0": n}) for n in (0.5, 1.0, 2.0))
    scene = replace(curves[0], curves=curves)
    keep, at = tmp_path / "kept", [0.9, 1.1]
    first = trace_exact(scene, at, Execution(keep=keep, progress=interrupted_after(6)))
    assert [curve.complete for curve in first.curves] == [True, False, False]
    assert keep.is_file()
    done = trace_exact(scene, at, Execution(keep=keep, resume=True, progress=interrupted_after(14)))
    assert all(curve.complete for curve in done.curves) and not keep.exists()
    whole = trace_exact(scene, at)
    for one, other in zip(done.curves, whole.curves, strict=True):
        np.testing.assert_array_equal(one.amplitude, other.amplitude)


@pytest.mark.slow
def test_cores_give_the_same():
    curves = tuple(replace(one_mode(n_0=n), parameters={"n_0": n}) for n in (0.5, 2.0))
    scene = replace(curves[0], curves=curves)
    one, two = (trace_exact(scene, [1.1], execution=Execution(jobs=jobs)) for jobs in (1, 2))
    for a, b in zip(one.curves, two.curves, strict=True):
        np.testing.assert_array_equal(a.amplitude, b.amplitude)
        assert b.parameters == a.parameters


def test_a_scene_without_contacts():
    scene = replace(yang(), contacts=(), max_step=0.2)
    curve = curve_of(scene)
    assert curve.complete and curve.regime.shape == (curve.points, 0)
    exact = [np.abs(linear(scene, omega, stuck=False)) for omega in curve.frequency]
    assert curve.amplitude == pytest.approx(np.array(exact), rel=1e-8)
    (visited,) = trace_exact(scene, at=[1.0]).curves
    assert visited.amplitude[0] == pytest.approx(np.abs(linear(scene, 1.0, stuck=False)), rel=1e-8)


def test_a_mode_that_is_free_to_drift():
    curve = curve_of(one_mode(frequency=0.0, n_0=-100.0))
    assert curve.points == 0 and "free to drift" in curve.reason


def test_a_stretch_on_which_all_contacts_stick_is_passed():
    """Between 1.5787 and 1.5839 rad/s the motion is linear, whatever the residual friction."""
    scene = fcm.load_scene(Path(__file__).parent / "scenes/both_stuck.toml")
    curve = curve_of(between(scene, 1.55, 1.62, max_step=0.2))
    assert curve.complete
    stuck = (curve.regime == "E").all(axis=1)
    inside = (curve.frequency > 1.5787) & (curve.frequency < 1.5839)
    assert inside.any() and stuck[inside].all() and not stuck.all()
    exact = np.array([linear(scene, omega, stuck=True) for omega in curve.frequency[stuck]])
    assert curve.amplitude[stuck] == pytest.approx(np.abs(exact), rel=1e-8)
