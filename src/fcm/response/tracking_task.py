"""Task that tracks the curves of one scene of a sweep (`fcm.run`) and saves each finished step.

A step is a response curve at a value of the number, a tracked curve, or its errors. The order of steps
depends only on the scene and the request. A resumed run takes saved steps in that order and computes the
others, with results that are equal to the last bit.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field, replace
from functools import partial
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from fcm.accuracy.options import VALIDITY, ValidityOptions
from fcm.frozen import Frozen
from fcm.harmonic_balance.contact_cycles import cycles, loops
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Scene
from fcm.response.incomplete import no_steady_states, reason_for
from fcm.response.options import RESPONSE, ResponseOptions
from fcm.response.request import Request
from fcm.response.undetermined_traction import undetermined
from fcm.results.result import INTERRUPTED
from fcm.results.tracked import TrackedCurve, TrackedError
from fcm.run import Interrupted, Report
from fcm.scene.draft import Number
from fcm.tracking.curve import SpecialPointCurve
from fcm.tracking.curves import tracked_curves
from fcm.tracking.ending_peak import EndingPeak
from fcm.tracking.error import error_points, truncation_error
from fcm.tracking.extended_system import Condition, Kind
from fcm.tracking.onset_functions import KINDS as ONSETS
from fcm.tracking.parameter_line import line_along
from fcm.tracking.stability import stability_along
from fcm.tracking.start_points import SpecialPoints
from fcm.tracking.tracked_point import Ending, TrackedPoint, TrackingSetup
from fcm.units import in_unit

STOPPED = f"{INTERRUPTED}, so that curves and errors may be missing"
T = TypeVar("T")


class TrackedScene(Frozen):
    """The tracked curves of one scene."""

    curves: list[TrackedCurve]
    problems: list[str]
    uncertain_at: list[tuple[float, float]] = field(default_factory=list)  # see `Tracking`
    interrupted: bool = False


KINDS = (TrackedScene, TrackedCurve, TrackedError)  # classes of results
STATES = (
    EndingPeak,
    SpecialPoints,
    SpecialPointCurve,
    TrackedPoint,
    Ending,
    Condition,
    Kind,
)  # classes of saved steps


class TrackingTask(Frozen):
    """The task of tracking curves in each scene."""

    number: Number
    what: str
    span: tuple[float, float]
    harmonics: tuple[int, ...]
    options: ResponseOptions = RESPONSE

    def __call__(self, scenes: Sequence[Scene], report: Report) -> list[TrackedScene]:
        return [self._one(scene, report) for scene in scenes]

    def _one(self, scene: Scene, report: Report) -> TrackedScene:
        system = Request(self.harmonics, options=self.options).system(scene)
        line, once = line_along(self.number), _SavedSteps(report)
        shown = partial(report, text=self.number.key)
        setup = TrackingSetup(system, line, self.span, (), scene.max_step)
        found = tracked_curves(setup, conditions_of(scene, self.what), (), shown, once)
        followed = TrackedScene([], list(found.problems), list(found.uncertain))
        followed.problems.extend(_lost(scene, condition, z) for condition, z in found.lost)
        stopped = found.interrupted
        for one in found.curves:  # after an interruption neither stability nor errors are computed
            estimates: tuple[TrackedError, ...] = ()
            stable: FloatArray | None = None
            try:
                if not stopped:
                    one, stable = once(partial(stability_along, setup, one))
                estimates = () if stopped else once(partial(errors, setup, one))
            except KeyboardInterrupt:
                stopped = True
            followed.curves.append(as_curve(scene, setup, one, stable, estimates))
        if not stopped:
            return followed
        followed = replace(followed, problems=[*followed.problems, STOPPED], interrupted=True)
        raise Interrupted([followed] if followed.curves else [])


def _lost(scene: Scene, condition: Condition, z: FloatArray) -> str:
    """Sentence on a special point at which no curve could be begun."""
    frequency = float(in_unit(z[-2], scene.frequency_unit))
    return (
        f"at {z[-1]:.6g}: no curve could be begun at the {named(scene, condition)} at "
        f"{frequency:.6g} {scene.frequency_unit}, which may be a corner of the response"
    )


class _SavedSteps:
    """Runs the steps of a scene and saves their results; saved steps are not computed again."""

    def __init__(self, report: Report) -> None:
        self.report, self.saved = report, deque(report.saved)

    def __call__(self, step: Callable[[], T]) -> T:
        if self.saved:
            return self.saved.popleft()  # type: ignore[no-any-return]
        found = step()
        self.report.save(found)
        return found


def conditions_of(scene: Scene, what: str) -> list[Condition]:
    """Conditions to track: the fold, peaks of the requested degrees of freedom, or onsets of all contacts."""
    if what == "folds":
        return [Condition(Kind.FOLD)]
    if what == "peaks":
        return [
            Condition(Kind.PEAK, dof) for dof, name in enumerate(scene.modal.dofs) if scene.asks_for(name)
        ]
    assert what in ONSETS
    return [Condition(Kind.ONSET, i, what) for i in range(len(scene.contacts))]


def errors(setup: TrackingSetup, one: SpecialPointCurve) -> tuple[TrackedError, ...]:
    """Truncation errors of a tracked curve at its ends, turns, least and greatest peak."""
    estimates = []
    for point, place in error_points(one).items():
        by = truncation_error(setup, one, point)
        estimates.append(
            TrackedError(point, place, by.relative, by.number if one.points[point].turn else np.nan)
        )
    return tuple(estimates)


def as_curve(
    scene: Scene,
    setup: TrackingSetup,
    one: SpecialPointCurve,
    stable: FloatArray | None,
    estimates: tuple[TrackedError, ...] = (),
) -> TrackedCurve:
    """Convert a tracked curve to a result named as in its scene, with stability and errors if known."""
    corners = ["" if point.corner is None else named(scene, point.corner) for point in one.points]
    stopped = [ending for ending in one.endings if not ending.whole]
    nowhere, count = _along_points(setup, one)
    stable = np.full(one.s.size, np.nan) if stable is None else np.array(stable)
    stable[_is_unreliable(estimates, one.s.size, setup.system.option(VALIDITY)) & (stable == 1.0)] = np.nan
    reason = _unsteady_ranges(setup.system, one.s, nowhere)
    for which in nowhere.values():
        stable[which] = 0.0  # a structure that creeps or floats has no steady state
    end = one.s[0] if not one.endings[0].whole else one.s[-1]
    return TrackedCurve(
        parameters=dict(scene.parameters),
        what=named(scene, one.condition),
        number=one.s,
        frequency=one.frequency,
        amplitude=one.amplitude,
        corner=np.array(corners, dtype=str),
        turn=np.array([bool(point.turn) for point in one.points]),
        trough=~one.greatest,
        stable=stable,
        closings=tuple(one.turns()),
        complete=one.whole and not reason,
        reason=f"stopped at {end:.6g}: {stopped[0].value}" if stopped else reason,
        errors=estimates,
        undetermined=count,
    )


def _is_unreliable(
    estimates: Sequence[TrackedError], count: int, options: ValidityOptions
) -> npt.NDArray[np.bool_]:
    """Points (point,) whose nearest estimated errors are too great to call the motion there stable.

    Each too great error covers the points up to the estimates before and after it.
    """
    far = np.zeros(count, dtype=np.bool_)
    places = sorted((one.point, one.relative) for one in estimates)
    for k, (_, error) in enumerate(places):
        if error > options.max_error:
            first = places[k - 1][0] if k else 0
            last = places[k + 1][0] if k + 1 < len(places) else count - 1
            far[first : last + 1] = True
    return far


def _along_points(
    setup: TrackingSetup, one: SpecialPointCurve
) -> tuple[dict[str, npt.NDArray[np.bool_]], int]:
    """Reasons why points of a tracked curve are no steady states, each with a mask (point,); and a count.

    The count is the number of `undetermined` points.
    """
    count, lost = 0, dict[str, npt.NDArray[np.bool_]]()
    for k, point in enumerate(one.points):
        system = setup.system.with_scene(setup.line.scene(setup.system.scene, float(point.z[-1])))
        z = np.array(point.z[None, :-1])
        count += int(undetermined(system.scene, cycles(system, z, loops(system, z))[0]).sum())
        for why, which in no_steady_states(system, z, np.ones(1)).items():
            lost.setdefault(why, np.zeros(len(one.points), dtype=np.bool_))[k] = which[0]
    return lost, count


def _unsteady_ranges(system: System, number: FloatArray, nowhere: Mapping[str, npt.NDArray[np.bool_]]) -> str:
    """Sentence on the range of a tracked curve without steady states, and why; empty if there is none."""
    for why, which in nowhere.items():
        if which.any():
            ends = number[which]
            return f"from {ends.min():.6g} to {ends.max():.6g} {reason_for(system, why)}"
    return ""


def named(scene: Scene, condition: Condition) -> str:
    """Name of a tracked condition, as "peak of u"."""
    if condition.kind is Kind.PEAK:
        return f"peak of {scene.modal.dofs[condition.which]}"
    if condition.kind is Kind.ONSET:
        return f"{condition.onset} of {scene.contacts[condition.which].name or condition.which}"
    return "fold" if condition.kind is Kind.FOLD else "end of the range"
