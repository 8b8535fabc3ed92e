"""Curves of special points against ordinary runs at several values of the number, and against similarity."""

import tomllib
from dataclasses import replace
from types import SimpleNamespace

import netCDF4
import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from fcm.branches.options import FoldOptions, LevelCurveOptions
from fcm.branches.trace import traced
from fcm.cli.caveats import tracked_uncertain
from fcm.continuation import Mark
from fcm.continuation.options import StepOptions
from fcm.harmonic_balance.reported_quantities import recorded
from fcm.harmonic_balance.system import System
from fcm.model.scene import Aim, Optimum
from fcm.response.optimum import optimise
from fcm.response.options import OPTIMUM, ResponseOptions
from fcm.response.track import TrackRequest, track
from fcm.results.output import write_netcdf
from fcm.run import Execution
from fcm.scene import load_scene
from fcm.scene.draft import number_of
from fcm.scene.load import scene_from_dict
from fcm.tracking.curve import SpecialPointCurve
from fcm.tracking.curves import tracked_curves
from fcm.tracking.extended_system import Condition, Kind
from fcm.tracking.lowest_peak import LowestPeak, LowestPeakSearch
from fcm.tracking.options import TRACKING
from fcm.tracking.parameter_line import line_along
from fcm.tracking.peak_envelope import EnvelopeMinimum, PieceHeight
from fcm.tracking.tracked_point import Ending, TrackedPoint, TrackingSetup

from ..interrupted import interrupted_beyond
from ..oscillator import oscillator

TEXT = oscillator("[response]\nfrequency = [0.8, 1.6]\n", damping=0.05)
PRELOAD = "contact.shroud.n_0"


@pytest.fixture(scope="module")
def scene():
    return load_scene("yang1998-n5")


@pytest.fixture(scope="module")
def folds(scene):
    """Of the paper's oscillator, with one harmonic."""
    return track(scene, TrackRequest("folds", PRELOAD, (-20.0, 10.0)), harmonics=1).tracking


def run(scene, value, harmonics=(1,), key=PRELOAD):
    system = System(number_of(scene, key).put(scene, value), harmonics)
    paths = traced(system).branches.paths
    return system, paths


def frequencies_at(curves, value):
    """Of the tracked points at a value of the number."""
    found = [one.frequency[np.abs(one.number - value) < 1e-9] for one in curves]
    return np.unique(np.concatenate(found).round(12))


@pytest.mark.slow
@pytest.mark.parametrize("value", [-20.0, -10.0, 5.0, 7.5])
def test_tracked_folds_are_those_of_ordinary_runs(scene, folds, value):
    _, paths = run(scene, value)
    expected = np.sort(np.concatenate([path.parameter[path.where(Mark.FOLD)] for path in paths]))
    assert frequencies_at(folds.curves, value) == pytest.approx(expected, abs=1e-9)
    assert folds.complete


def test_the_window_closes_where_two_folds_of_ordinary_runs_meet(scene, folds):
    """At a cusp the width of the window vanishes as the distance to the power 3/2."""
    least = min(one["number"] for curve in folds.curves[1:] for one in curve.summary("rad/s")["turns"])

    def width(value):
        _, paths = run(scene, value)
        found = np.concatenate([path.parameter[path.where(Mark.FOLD)] for path in paths])
        return np.ptp(found) if found.size else 0.0

    near, far = width(least + 0.01), width(least + 0.04)
    assert far / near == pytest.approx(8.0, rel=0.05)
    assert width(least - 1e-4) == 0.0


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e4])  # of the frequency, as in other units
@pytest.mark.parametrize("skew", [0.0, 1e-3, 1.0])  # of the frequency by the number, along the window
@pytest.mark.parametrize(("kind", "closes"), [("cusp", True), ("isola", False)])
def test_a_turn_of_folds_is_told_by_what_the_frequency_does(kind, closes, skew, unit):
    """Folds by x of x^3 + s x + w = 0: s = -3 x^2, w = 2 x^3; and of x^2 + w^2 - s = 0: x = 0, s = w^2."""
    tracked_points = []
    for x in (-0.3, -0.1, 0.0, 0.2, 0.4):
        rate = np.array([1.0, 6.0 * x * x, -6.0 * x]) if closes else np.array([0.0, 1.0, 2.0 * x])
        place = np.array([x, 2.0 * x**3, -3.0 * x * x]) if closes else np.array([0.0, x, x * x])
        for one in (place, rate):
            one[1] = unit * (one[1] + skew * one[2])
        tracked_points.append(TrackedPoint(place, rate, turn=x == 0.0))
    z, none = np.array([point.z for point in tracked_points]), np.zeros((len(tracked_points), 0))
    ends = (Ending.SPAN, Ending.SPAN)
    curve = SpecialPointCurve(
        Condition(Kind.FOLD), tuple(tracked_points), z[:, 2], z[:, 1], none, z[:, 0] == z[:, 0], ends
    )
    assert curve.turns() == [(2, kind)]


@pytest.mark.parametrize("name", ["mu", "k_u"])
def test_folds_are_tracked_from_where_a_contact_has_no_friction(scene, name):
    open_, key = number_of(scene, PRELOAD).put(scene, -5.0), f"contact.shroud.{name}"
    tracking = track(open_, TrackRequest("folds", key, (0.0, 0.4)), harmonics=1).tracking
    assert tracking.complete
    for value in (0.0, 0.4):
        _, paths = run(open_, value, key=key)
        expected = np.sort(np.concatenate([path.parameter[path.where(Mark.FOLD)] for path in paths]))
        assert frequencies_at(tracking.curves, value) == pytest.approx(expected, abs=1e-9)


def test_at_a_cusp_no_branch_is_born(scene, folds):
    """One branch on both sides of each, with two folds more on one of them."""
    for curve in folds.curves:
        for i, kind in curve.closings:
            counts = []
            for value in (curve.number[i] - 0.01, curve.number[i] + 0.01):
                _, paths = run(scene, value)
                counts.append((len(paths), sum(len(path.where(Mark.FOLD)) for path in paths)))
            (one, less), (other, more) = sorted(counts, key=lambda pair: pair[1])
            assert (kind, one, other, more - less) == ("cusp", 1, 1, 2)


def test_interrupted_the_curves_that_are_finished_are_kept(scene, folds, tmp_path):
    def stop_at(limit):
        progress = interrupted_beyond(limit)
        return track(
            scene,
            TrackRequest("folds", PRELOAD, (-20.0, 10.0)),
            harmonics=1,
            execution=Execution(progress=progress),
        )

    kept = stop_at(0.2)
    (curve,), (problem,) = kept.tracking.curves, kept.tracking.problems
    assert problem.startswith("interrupted") and not kept.complete and kept.interrupted
    assert np.array_equal(curve.frequency, folds.curves[0].frequency)
    write_netcdf(kept, tmp_path / "kept.nc")
    with netCDF4.Dataset(tmp_path / "kept.nc") as data:
        assert np.array_equal(data["tracked_number"][0], curve.number)
        assert np.ma.filled(data["tracked_error_told"][0], np.nan) == pytest.approx(np.nan, nan_ok=True)
    with pytest.raises(KeyboardInterrupt):
        stop_at(-1.0)


@pytest.mark.slow
def test_an_interrupted_run_goes_on_to_the_same_curves(scene, folds, tmp_path):
    shares, place = [], tmp_path / "folds.nc.unfinished"

    def stop_at(limit):
        def progress(share, _):
            shares.append(share)
            if share > limit:
                raise KeyboardInterrupt

        execution = Execution(progress=progress, keep=place, resume=True)
        return track(scene, TrackRequest("folds", PRELOAD, (-20.0, 10.0)), execution, harmonics=1)

    assert stop_at(0.2).interrupted
    with pytest.raises(KeyboardInterrupt):
        stop_at(-1.0)
    stepped = len(shares)
    done = stop_at(1.0)
    assert done.complete and not place.exists() and len(shares) > stepped
    for one, other in zip(done.tracking.curves, folds.curves, strict=True):
        assert np.array_equal(one.frequency, other.frequency) and one.errors == other.errors
        assert np.array_equal(one.amplitude, other.amplitude) and one.closings == other.closings


def test_the_window_in_the_level_is_the_one_in_the_preload(scene, folds):
    """Twice the forces with twice the preload is twice the motion: levels are 5 / n_0."""
    system, line = System(scene, (1,)), line_along(number_of(scene, "level"))
    levels = tracked_curves(TrackingSetup(system, line, (0.55, 2.5)), [Condition(Kind.FOLD)]).curves
    assert all(curve.whole for curve in levels)
    turns = np.sort([5.0 / curve.s[i] for curve in levels for i, _ in curve.turns()])
    expected = [one["number"] for curve in folds.curves for one in curve.summary("rad/s")["turns"]]
    assert turns == pytest.approx(np.sort([value for value in expected if value > 0.0]), abs=2e-6)


@pytest.mark.slow
def test_the_error_of_folds_is_what_twelve_harmonics_change(scene, folds):
    """At an end, and at a cusp, where it is of the number, too."""
    curve = folds.curves[0]
    more = track(scene, TrackRequest("folds", PRELOAD, (-5.0, -3.0)), harmonics=12).tracking.curves[0]
    (i,), (k,) = (np.flatnonzero(one.turn) for one in (curve, more))
    end, turn, other = curve.errors
    assert (end.place, turn.place, turn.point, other.point) == ("end", "cusp", i, curve.number.size - 1)
    assert turn.number == pytest.approx(abs(more.number[k] - curve.number[i]), rel=0.1)
    assert turn.relative == pytest.approx(abs(more.frequency[k] / curve.frequency[i] - 1.0), rel=0.1)
    _, paths = run(scene, -20.0, tuple(range(1, 13)))
    exact = np.concatenate([path.parameter[path.where(Mark.FOLD)] for path in paths]).max()
    assert end.relative == pytest.approx(abs(exact / curve.frequency[0] - 1.0), rel=0.1)


def test_the_error_of_peaks_is_what_twelve_harmonics_change(scene):
    curve = track(scene, TrackRequest("peaks", PRELOAD, (4.0, 10.0)), harmonics=1).tracking.curves[0]
    assert [one.place for one in curve.errors] == ["end, greatest", "least", "end"]
    for one in curve.errors:
        system, paths = run(scene, curve.number[one.point], tuple(range(1, 13)))
        exact = recorded(system, paths).amplitude[:, 0].max()
        assert one.relative == pytest.approx(abs(exact / curve.amplitude[one.point, 0] - 1.0), rel=0.1)


@pytest.mark.slow
def test_where_nothing_slips_or_opens_nothing_is_left_out(scene):
    curves = track(scene, TrackRequest("slip", PRELOAD, (60.0, 100.0)), harmonics=1).tracking.curves
    assert max(one.relative for curve in curves for one in curve.errors) < 1e-8


@pytest.mark.slow
@pytest.mark.parametrize(("harmonics", "to"), [((1,), 100.0), ((1, 2), 10.0)])
def test_tracked_peaks_are_those_of_ordinary_runs(scene, harmonics, to):
    tracking = track(scene, TrackRequest("peaks", PRELOAD, (-20.0, to)), harmonics=harmonics).tracking
    assert tracking.complete
    for value in (-20.0, 10.0, to):
        system, paths = run(scene, value, harmonics)
        amplitude = recorded(system, paths).amplitude.max(axis=0)
        for column, what in enumerate(("peak of u", "peak of v")):
            mine = [one for one in tracking.curves if one.what == what]
            heights = np.concatenate([c.amplitude[np.abs(c.number - value) < 1e-9, column] for c in mine])
            assert heights.max() == pytest.approx(amplitude[column], rel=1e-8)


@pytest.mark.slow
def test_the_onset_of_slip_is_where_stiff_contacts_reach_the_limit(scene):
    """Above the greatest preload of the curve nothing slips: the linear response of the stuck contact.

    On the verge of slip its mean friction is between two limits that have met, and moves the mean load.
    """
    (curve,) = track(
        scene, TrackRequest("slip", PRELOAD, (20.0, 100.0)), harmonics=1
    ).tracking.curves  # and no part twice
    highest = curve.number.max()
    contact, modal = scene.contacts[0], scene.modal

    def needed(omega):  # the preload with which u and v of the linear response just stick
        stiffness = np.diag(modal.frequency**2 - omega**2 + 2j * modal.damping * modal.frequency * omega)
        ports = modal.shapes @ np.stack((contact.tangential, contact.normal), axis=1)
        stiffness = stiffness + ports @ np.diag((contact.k_u, contact.k_v)) @ ports.T
        U, V = ports.T @ np.linalg.solve(stiffness, modal.shapes @ np.ones(2))
        push, load = contact.k_u * U, contact.mu * contact.k_v * V
        friction = 0.5 * (abs(push + load) - abs(push - load))
        flexible = ports.T @ np.diag(modal.frequency**-2) @ ports
        mean = -flexible[1, 0] * friction / (1.0 + flexible[1, 1] * contact.k_v)
        return 0.5 * (abs(push + load) + abs(push - load)) / contact.mu - contact.k_v * mean

    best = minimize_scalar(lambda omega: -needed(omega), bounds=(1.3, 1.5), options={"xatol": 1e-10})
    assert highest == pytest.approx(-best.fun, rel=1e-8)


@pytest.mark.slow
def test_separation_that_comes_and_goes_between_the_starts_is_met_by_the_peak(scene):
    tracking = track(scene, TrackRequest("separation", PRELOAD, (-20.0, 100.0)), harmonics=1).tracking
    (curve,) = tracking.curves
    top = curve.number.max()
    for value, opens in ((top - 1e-3, True), (top + 1e-3, False)):
        _, paths = run(scene, value)
        z = np.concatenate([path.z for path in paths])
        load = value + z[:, 1] - np.hypot(z[:, 4], z[:, 5])  # k_v is 1
        assert bool((load < 0.0).any()) is opens


def chosen(scene, bounds, *aims, vary=(PRELOAD,), **options):
    aimed = replace(scene, optimum=Optimum(vary, bounds, aims))
    response = optimise(aimed, **{"harmonics": 1, **options})
    assert response.complete
    return response


def test_the_least_peak_is_that_of_a_fine_minimisation_of_ordinary_runs(scene):
    """The paper's is at n_0 = 10, of the preloads that it has."""

    def peak(value):
        system, paths = run(scene, value)
        return recorded(system, paths).amplitude[:, 0].max()

    expected = minimize_scalar(peak, bounds=(9.0, 10.5), method="bounded", options={"xatol": 1e-6})
    found = chosen(scene, ((0.0, 60.0),), Aim("u")).tracking.optima[0]
    assert found.value == pytest.approx(expected.fun, rel=1e-9)
    assert found.values[PRELOAD] == pytest.approx(expected.x, abs=1e-4)
    assert found.kind == "smooth" and found.error < 0.01


def test_a_kink_of_two_equal_peaks_is_landed_on():
    """Two resonances apart from one another, each damped best at a preload of its own."""
    scene = two_resonances()
    found = chosen(scene, ((0.2, 12.0),), Aim("a"), Aim("b"), vary=("contact.c.n_0",)).tracking.optima[0]

    def peaks(value):
        system, paths = run(scene, value, key="contact.c.n_0")
        return recorded(system, paths).amplitude.max(axis=0)

    assert found.kind == "kink" and len(found.active) == 2
    heights = peaks(found.values["contact.c.n_0"])
    assert heights[0] == pytest.approx(heights[1], rel=1e-6)
    for beside in (-0.01, 0.01):
        assert peaks(found.values["contact.c.n_0"] + beside).max() > found.value


def two_resonances():
    """One contact on two modes: the first is pushed harder, and is damped best by a greater preload."""
    modal = {
        "dofs": ["a", "b", "n"],
        "frequency": [1.0, 2.0, 20.0],
        "damping": [0.01, 0.01, 0.01],
        "shapes": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    }
    contact = {
        "name": "c",
        "tangential": {"a": 1.0, "b": 1.0},
        "normal": "n",
        "mu": 0.5,
        "k_u": 1.0,
        "k_v": 1.0,
    }
    forces = [{"dof": "a", "amplitude": 1.0}, {"dof": "b", "amplitude": 1.5}]
    data = {"modal": modal, "contact": [contact | {"n_0": 1.0}], "force": forces}
    return scene_from_dict(data | {"response": {"frequency": [0.7, 2.6]}})


class FallsAndEnds(LowestPeakSearch):
    """A peak that falls to 1.8 and ends at 3, and one of 1.3 there that is followed only from there."""

    def __init__(self):
        self.system, self.span, self.curves = SimpleNamespace(harmonics=(1,)), (1.0, 9.0), []
        self.visited_values, self.visited = {}, set()
        self.setup = SimpleNamespace(span=self.span, options=TRACKING)
        self.pieces = [SimpleNamespace(s=np.array(self.span))]

    def best(self):
        return (
            EnvelopeMinimum(3.0, 1.3, (), "end")
            if "lower" in self.curves
            else EnvelopeMinimum(3.0, 1.8, (), "corner")
        )

    def visit(self, value):
        if value in self.span:
            return 2.6
        self.curves.append("lower")
        return 1.3


def test_where_the_highest_peak_ends_the_next_one_is_the_least():
    found = FallsAndEnds().run()
    assert (found.best.value, found.best.kind, found.checked) == (1.3, "end", True)


class Lost(LowestPeakSearch):
    """A peak that falls, and is followed to 3 alone; the response has it beyond as well, or it ends there."""

    def __init__(self, goes_on):
        self.system, self.span, self.curves = SimpleNamespace(harmonics=(1,)), (1.0, 9.0), []
        self.visited_values, self.visited, self.goes_on = {}, set(), goes_on
        self.setup = SimpleNamespace(span=self.span, options=TRACKING)
        self.pieces = [SimpleNamespace(s=np.array(ends)) for ends in ((1.0, 3.0), self.span)]

    def best(self):
        return EnvelopeMinimum(3.0, 1.8, (), "corner")

    def visit(self, value):
        falls = value <= 3.0 or self.goes_on
        height = 2.4 - 0.2 * value if falls else 2.0
        self.visited.add(value)
        self.visited_values[value] = PieceHeight(height, 0.0, np.zeros(0), 0)
        return height


@pytest.mark.parametrize("goes_on", [True, False])
def test_a_least_at_the_end_of_what_was_followed_is_looked_at_beyond(goes_on):
    """Where following was lost it is no least."""
    found = Lost(goes_on).run()
    assert (found.best.s, found.best.kind, found.checked) == (3.0, "corner", not goes_on)


class Line:
    """A piece of a curve of peaks that are as high as the number."""

    def __init__(self, low, high):
        self.s = self.height = np.array([low, high])

    def covers(self, s):
        return self.s[0] <= s <= self.s[1]

    def roughly(self, s):
        return s

    def at(self, s):
        return PieceHeight(s, 1.0, np.zeros(0), 0)


class Parted(LowestPeakSearch):
    """Two pieces, and nothing that can be followed between them; fewer harmonics lead to none."""

    def __init__(self, between):
        self.system, self.span, self.between = SimpleNamespace(harmonics=(1,)), (1.0, 9.0), between
        self.setup = SimpleNamespace(span=self.span, options=TRACKING)
        self.curves = self.pieces = []
        self.visited_values, self.visited = {}, set()

    def refine_curves(self, known):
        pass

    def greatest_at(self, value):
        self.visited_values[value] = PieceHeight(
            self.between if 4.0 < value < 6.0 else value, 0.0, np.zeros(0), 0
        )

    def visit(self, value):
        self.visited.add(value)
        self.greatest_at(value)
        self.curves += [line for line in (Line(1.0, 4.0), Line(6.0, 9.0)) if line.covers(value)]
        return self.visited_values[value].value


@pytest.mark.parametrize(
    ("between", "checked"),
    [(5.0, True), (1.05, False), (0.5, False), (0.0, True)],
    ids=["higher", "as high", "lower", "none"],
)
def test_where_fewer_harmonics_lead_to_nothing_the_response_is_looked_at(between, checked):
    found = Parted(between).run(LowestPeak(None, (), True, (1,)))
    assert (found.best.s, found.best.value, found.best.kind) == (1.0, 1.0, "bound")
    assert found.checked == checked


@pytest.mark.slow
def test_two_numbers_are_chosen_together(scene):
    """The best friction for the best preload: no response beside it has a lower peak."""
    keys = (PRELOAD, "contact.shroud.mu")
    found = chosen(scene, ((1.0, 40.0), (0.1, 0.6)), Aim("v"), vary=keys).tracking.optima[0]
    best = np.array([found.values[key] for key in keys])

    def peak(values):
        contact = replace(scene.contacts[0], n_0=values[0], mu=values[1])
        system = System(replace(scene, contacts=(contact,)))
        return recorded(system, traced(system).branches.paths).amplitude[:, 1].max()

    assert peak(best) == pytest.approx(found.value, rel=1e-8)
    for step in ((0.3, 0.0), (-0.3, 0.0), (0.0, 0.01), (0.0, -0.01)):
        beside = best + step
        if 0.1 <= beside[1] <= 0.6:
            assert peak(beside) > found.value


@pytest.mark.slow
def test_no_plateau_of_a_stuck_contact_is_taken_for_the_least_of_two_numbers():
    """With much preload the contact sticks, and no small change of that changes anything."""
    scene, keys = two_resonances(), ("contact.c.n_0", "contact.c.k_u")
    found = chosen(scene, ((0.2, 12.0), (0.3, 3.0)), Aim("a"), Aim("b"), vary=keys).tracking.optima[0]

    def peak(n_0, k_u):
        contact = replace(scene.contacts[0], n_0=n_0, k_u=k_u)
        system = System(replace(scene, contacts=(contact,)))
        return recorded(system, traced(system).branches.paths).amplitude[:, :2].max()

    assert found.kind == "kink" and found.values["contact.c.k_u"] == 3.0  # its bound
    assert found.value == pytest.approx(peak(*found.values.values()), rel=1e-8)
    beside = [found.values["contact.c.n_0"] + step for step in (-1e-3, 1e-3)]
    assert all(peak(n_0, k_u) > found.value for n_0 in (*beside, 2.0, 4.0, 12.0) for k_u in (1.5, 3.0))


@pytest.mark.slow
def test_where_ordinary_curves_may_lack_branches_tracked_ones_are_not_said_to_be_all(scene):
    """As an ordinary run says, where the level of the forces is not followed to its end."""
    assert track(scene, TrackRequest("folds", PRELOAD, (4.0, 6.0)), harmonics=1).tracking.uncertain_at == []

    stalled = ResponseOptions(others=(LevelCurveOptions(step=StepOptions(max_steps=10)),))
    response = track(scene, TrackRequest("folds", PRELOAD, (4.0, 6.0)), harmonics=1, options=stalled)
    lowest = scene.frequency_range[0]
    assert response.tracking.complete and lowest in {omega for _, omega in response.tracking.uncertain_at}
    assert {(4.0, lowest), (6.0, lowest)} <= set(response.tracking.uncertain_at)
    summary = {"tracked": response.tracking.summary("rad/s"), "frequency_unit": "rad/s"}
    assert tracked_uncertain(summary).startswith(
        f"other tracked curves may be missing: with {PRELOAD} = 4 at {lowest:.5g} rad/s"
    )


def test_where_a_fold_of_the_level_is_lost_tracked_curves_are_not_said_to_be_all(scene):
    lost = ResponseOptions(others=(FoldOptions(work_fraction=0.0, min_seconds=0.0),))
    uncertain_at = track(
        scene, TrackRequest("folds", PRELOAD, (4.0, 6.0)), harmonics=1, options=lost
    ).tracking.uncertain_at
    (middle,) = {omega for _, omega in uncertain_at}
    assert middle == pytest.approx(1.20695, abs=1e-5)
    assert all(4.0 <= value <= 6.0 for value, _ in uncertain_at)


def test_peaks_of_output_alone_are_tracked_where_it_is_given(scene):
    """Peaks of all degrees of freedom were, of which some are not asked for and end early."""
    asked = TrackRequest("peaks", PRELOAD, (4.0, 5.0))
    every = track(scene, asked, harmonics=1).tracking.curves
    asked_for = scene_from_dict(tomllib.loads(TEXT.replace("[response]", '[response]\noutput = ["v"]')))
    some = track(asked_for, asked, harmonics=1)
    assert {one.what for one in every} == {"peak of u", "peak of v"}
    assert {one.what for one in some.tracking.curves} == {"peak of v"} and not some.left_out


def test_peaks_of_output_are_tracked_though_other_degrees_of_freedom_are_many():
    """Those of which modes move most were, and that was said to be chosen by output."""
    count = OPTIMUM.max_dofs + 5
    dofs = [f"{node}x" for node in range(count)]
    shapes = [[1.0] * count, np.linspace(1.0, -2.0, count).tolist()]
    modal = {"dofs": dofs, "frequency": [1.0, 10.0], "damping": 0.05, "shapes": shapes}
    contact = {"name": "a", "tangential": "0x", "normal": "1x", "mu": 0.4, "k_u": 1.0, "k_v": 1.0, "n_0": 5.0}
    force, response = [{"dof": "0x", "amplitude": 1.0}], {"frequency": [0.5, 2.5]}
    data = {"modal": modal, "contact": [contact], "force": force, "response": response}
    asked = TrackRequest("peaks", "contact.a.n_0", (4.0, 4.2))
    leading = track(scene_from_dict(data), asked, harmonics=1)
    assert "[response] output chooses" in leading.left_out[0]
    chosen = track(scene_from_dict(data | {"response": response | {"output": ["7x"]}}), asked, harmonics=1)
    assert {one.what for one in chosen.tracking.curves} == {"peak of 7x"} and not chosen.left_out
