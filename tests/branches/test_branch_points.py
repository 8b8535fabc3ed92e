"""Branches that leave others at branch points."""

import json
from pathlib import Path

import numpy as np
import pytest

from fcm.accuracy.refinement import every_branch
from fcm.branches.branch_points import branch_points
from fcm.branches.options import BranchingOptions, FoldOptions
from fcm.branches.search import with_unsymmetric
from fcm.branches.symmetry import broken_symmetries
from fcm.branches.symmetry_loss import SymmetryLoss, symmetry_loss
from fcm.branches.trace import traced
from fcm.continuation import Status
from fcm.continuation.all_branches import contains
from fcm.harmonic_balance.system import System
from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.scene import load_scene
from fcm.time_domain import State, simulate

from .hunt import on_branch
from .relatives import KINDS

SCENE = load_scene(Path(__file__).parent / "scenes/equal_stops.toml").each_curve()[0]


@pytest.mark.slow
def test_the_highest_peak_of_equal_stops_is_of_a_motion_that_is_not_symmetric():
    """Marched independently: 0.31653 at 1.7695 rad/s, stable, on two mirrored motions. Those of the symmetric
    motion are lower by 4 %."""
    curve = traced_curve(SCENE, Request((1, 2, 3, 4, 5), 1e-2))
    peak = curve.peaks["x1"]
    assert curve.complete
    assert peak.amplitude == pytest.approx(0.31653, rel=1e-3)
    assert peak.frequency == pytest.approx(1.7695, rel=1e-3)
    assert peak.stable and curve.mirrored >= 2 and curve.summary()["mirrored_branches"] == curve.mirrored


@pytest.mark.slow
def test_even_harmonics_are_taken_where_a_symmetric_motion_loses_its_symmetry():
    """With odd harmonics alone the symmetric motion is within the accuracy, and its branch points hidden."""
    curve = traced_curve(SCENE, Request(None, 1e-2))
    assert {2, 4} < set(curve.harmonics)
    assert curve.peaks["x1"].amplitude == pytest.approx(0.31653, rel=1e-3)


def test_both_sides_of_a_branch_point_are_mirror_images_of_which_one_is_traced():
    system = System(SCENE, (1, 2, 3))
    known = traced(system)
    points = list(branch_points(system, known.branches.paths))
    assert len(points) >= 4 and all(len(point.starts) == 2 for point in points)
    found = every_branch(system).traced
    balance = system.new_balance()
    for point in points:
        one, other = point.starts
        (symmetry,) = broken_symmetries(system, point.z, one)
        balance.evaluate_scale(one)
        off = (symmetry.image(one) - other) / np.asarray(balance.scale)
        assert np.abs(off).max() < 1e-3 and np.allclose(symmetry.image(symmetry.image(one)), one)
        on = [
            sum(contains(path, z, system.reset_balance()) for path in found.branches.paths)
            for z in (one, other)
        ]
        assert sorted(on) == [0, 1]


@pytest.mark.slow
def test_where_odd_harmonics_alone_are_given_it_is_said_where_symmetry_is_lost(fcm, tmp_path):
    """The branch points are those with all even harmonics to twice the highest; the unsymmetric motions have
    even ones. Two more, at 0.7 rad/s, lie within one step."""
    odd = traced_curve(SCENE, Request((1, 3, 5)))
    system = System(SCENE, (1, 2, 3, 4, 5, 6, 8, 10))
    there = [point.z[-1] for point in branch_points(system, traced(system).branches.paths)]
    near = [np.abs(np.subtract(odd.symmetry_lost, one)).min() < 1e-4 for one in there if one > 0.8]
    assert len(near) == 6 and all(near)
    whole = traced_curve(SCENE, Request(system.harmonics))
    assert whole.symmetry_lost == [] and whole.mirrored and not odd.mirrored
    done = fcm("respond", Path(__file__).parent / "scenes/equal_stops.toml", "--harmonics", "1,3,5", "--json")
    assert "loses its symmetry" in done.err and f"{odd.symmetry_lost[0]:.5g} rad/s" in done.err


@pytest.mark.slow
def test_symmetry_is_lost_by_even_harmonics_whatever_odd_ones_are_balanced():
    """A curve with 1, 2, 3 and 7 has motions that 5 would change; 4 breaks their symmetry all the same."""
    scene = KINDS["stops"](54)
    odd = System(scene, (1, 2, 3, 7))
    lost = symmetry_loss(odd, traced(odd))
    assert 4 in lost.harmonics and all(h % 2 == 0 for h in lost.harmonics)
    none = System(scene, odd.harmonics, other_options=(BranchingOptions(even_factor=0.0),))
    assert symmetry_loss(none, traced(none)) == SymmetryLoss()  # as no even harmonics are tried
    with_them = System(scene, tuple(sorted({1, 2, 3, 5, 7, *lost.harmonics})))
    assert symmetry_loss(with_them, traced(with_them)) == SymmetryLoss()
    unsymmetric = [
        path.parameter
        for path in every_branch(with_them).traced.branches.paths
        if with_them.layout.complex_ports(path.z[0])[:, 4].any()
    ]
    assert any(min(abs(one - omega)) < 1e-3 for one in unsymmetric for omega in lost.frequencies)


@pytest.mark.slow
def test_symmetry_that_is_lost_within_two_steps_is_not_missed():
    """Between the branch points at 0.841 and 0.863 rad/s the curve has one point; a march settles there at an
    unsymmetric motion."""
    scene = KINDS["stops"](2033)
    few = System(scene, (1, 2, 3, 4, 5, 7, 9, 11))
    lost = symmetry_loss(few, traced(few))
    assert lost.harmonics and set(lost.harmonics) <= {6, 8, 10}
    whole = System(scene, tuple(range(1, 12)))
    there = [point.z[-1] for point in branch_points(whole, traced(whole).branches.paths)]
    assert all(min(abs(one - omega) for omega in there) < 1e-3 for one in lost.frequencies)


@pytest.mark.slow
def test_of_a_curve_with_one_harmonic_symmetry_is_lost_too():
    """One harmonic has the accuracy; beside its symmetric motion a march settles at an unsymmetric one."""
    scene, omega = KINDS["stops"](5004), 0.6 + 1.4 / 3.0
    rest = State(np.array([0.3, 0.1]), np.zeros(2), np.zeros(2))
    marched = next(iter(simulate(scene, omega, 400, rest).measures(last=1))).amplitude
    one = System(scene, (1,))
    assert symmetry_loss(one, traced(one)).harmonics == (2,)
    curve = traced_curve(scene, Request(None, 1e-2))
    assert on_branch(curve, omega, marched) and curve.mirrored


@pytest.mark.slow
def test_a_branch_point_that_the_sixth_harmonic_alone_makes_is_not_missed():
    """Every march from a random state at 0.8333 rad/s settles at one of two mirrored motions. With the second
    and fourth harmonic alone no symmetric motion loses its symmetry near there."""
    scene, omega = KINDS["stops"](222), 0.6 + 1.4 / 6.0
    rest = State(np.array([0.3, 0.1]), np.zeros(2), np.zeros(2))
    marched = next(iter(simulate(scene, omega, 400, rest).measures(last=1))).amplitude
    curve = traced_curve(scene, Request(None, 1e-2))
    assert 6 in curve.harmonics and curve.symmetry_lost == []
    assert on_branch(curve, omega, marched)
    assert curve.mirrored == 2


def test_where_unsymmetric_motions_of_a_level_are_not_looked_for_to_the_end_it_is_incomplete():
    """So the run says that branches may be missing there."""
    scene = KINDS["stops"](16)
    hasty = System(scene, (1, 2, 3, 4, 5), other_options=(FoldOptions(work_fraction=0.0, min_seconds=0.0),))
    known = traced(hasty)
    assert all(one.complete for one in known.found)
    assert not any(one.complete for one in with_unsymmetric(hasty, known).found)


@pytest.mark.slow
def test_even_harmonics_by_which_a_level_loses_symmetry_are_lacking_or_balanced():
    """A closed branch, which marches come to, leaves the level at 1.478 rad/s, and the response nowhere."""
    scene = KINDS["stops"](16)
    few, whole = (System(scene, one) for one in ((1, 3, 5), (1, 2, 3, 4, 5)))
    by_level = with_unsymmetric(few, traced(few)).symmetry_lost_in_level
    assert by_level and all({2, 4} & set(even) for _, even in by_level)
    known = traced(whole)
    found = with_unsymmetric(whole, known)
    assert found.symmetry_lost_in_level == () and len(found.mirrored) > 0
    further = found.branches.paths[len(known.branches.paths) :]
    assert any(
        path.parameter.min() < 1.3 < path.parameter.max() and path.status is Status.CLOSED for path in further
    )


@pytest.mark.slow
def test_a_closed_branch_is_reached_along_the_branch_of_few_harmonics():
    """With five harmonics it is one with a branch that a level leads to. With eight it is apart (1.036 to
    1.067 rad/s), and no level that is followed passes it. A march settles there."""
    scene, omega = KINDS["stops"](5054), 0.6 + 1.4 / 3.0
    rest = State(np.array([0.3, 0.1]), np.zeros(2), np.zeros(2))
    marched = next(iter(simulate(scene, omega, 400, rest).measures(last=1))).amplitude
    curve = traced_curve(scene, Request(None, 1e-2))
    assert on_branch(curve, omega, marched)


@pytest.mark.slow
@pytest.mark.parametrize("force", [1.5, 3.0])
def test_a_sweep_goes_on_along_the_branch_that_begins_where_its_own_loses_stability(fcm, tmp_path, force):
    """With 3.0 the branch is followed through the branch point, where its frequency turns. With 1.5 it ends
    where its amplitude is still off by 2e-6."""
    text = (Path(__file__).parent / "scenes/stops_and_second_harmonic.toml").read_text(encoding="utf-8")
    scene = tmp_path / "scene.toml"
    scene.write_text(text.replace("amplitude = 3.0", f"amplitude = {force}"), encoding="utf-8")
    balanced, exact = (
        json.loads(fcm("respond", scene, "--method", method, "--json").out)["curves"][0]["jumps"]
        for method in ("table", "exact")
    )
    assert (
        [one["sweep"] for one in balanced] == [one["sweep"] for one in exact] == ["up", "up", "down", "down"]
    )
    for one, other in zip(balanced, exact, strict=True):
        assert one["frequency"] == pytest.approx(other["frequency"], rel=1e-3)
        assert one["before"] == pytest.approx(other["before"], rel=1e-2)
