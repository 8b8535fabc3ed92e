"""Groups of curves that are traced together, as batches (`fcm.run`): on cores, kept while not written."""

from __future__ import annotations

import time
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from fcm.branches.shared_levels import clear
from fcm.frozen import Frozen
from fcm.harmonic_balance.contact_motions import ContactMotions
from fcm.model.scene import Scene
from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.results.cause import Cause
from fcm.results.contact_maxima import Greatest
from fcm.results.curve_extracts import CurveExtract, without_points
from fcm.results.jumps import FrequencySweep, Jump, UnknownStability
from fcm.results.nonlinear_mode import NonlinearMode, Resonance
from fcm.results.orbits import Orbits, Stuck
from fcm.results.peak import Peak
from fcm.results.result import DEFECT, NOT_BEGUN, Curve
from fcm.run import (
    CheckpointFile,
    Compute,
    Factory,
    Interrupted,
    Lost,
    Progress,
    Report,
    Results,
    compute_batches,
    fingerprint,
    place_for,
)

Group = Sequence[Scene]
KINDS = (
    Cause,
    Curve,
    CurveExtract,
    ContactMotions,
    Orbits,
    Stuck,
    FrequencySweep,
    Jump,
    UnknownStability,
    Peak,
    Greatest,
    NonlinearMode,
    Resonance,
)  # what results consist of
_BY_POINT = (
    *("amplitude", "fundamental", "phase", "mean", "regime", "loop", "cycle", "cycle_error", "stable"),
    *("table_error", "error", "truncation_error"),
)


class CurveTask(Frozen):
    """The task that traces a group of curves."""

    request: Request
    peaks_only: bool = False
    samples: int = 0  # points that are kept all the same

    def __call__(self, group: Group, report: Report) -> list[Curve]:
        curves = _known(group, report.saved)
        begin, saved = time.monotonic(), len(curves)
        clear()
        for number, scene in list(enumerate(group))[len(curves) :]:
            if time.monotonic() - begin > self.request.options.sweep.save_interval:
                saved, begin = _save(curves, saved, report), time.monotonic()
            try:
                report(number / len(group), "")
                shown = _Shown(report, number, len(group))
                curve = traced_curve(scene, self.request, tell=shown.tell, progress=shown.progress)
            except KeyboardInterrupt as stopped:
                _save(curves, saved, report)
                if isinstance(stopped, Interrupted):
                    curves += [self._kept(one) for one in stopped.results]
                raise Interrupted(curves) from None
            curves.append(self._kept(curve))
        return curves

    def _kept(self, curve: Curve) -> Curve:
        """The part of a curve that is kept: without its points where only peaks are asked for."""
        return without_points(curve, self.samples) if self.peaks_only else curve


class _Shown:
    """The progress of one curve of a group: its share, and what is said beside it."""

    def __init__(self, report: Report, number: int, count: int) -> None:
        self.report, self.number, self.count = report, number, count
        self.share, self.text = 0.0, "being traced"

    def tell(self, text: str) -> None:
        self.text = text
        self.show()

    def progress(self, share: float) -> None:
        self.share = max(self.share, share)
        self.show()

    def show(self) -> None:
        self.report((self.number + self.share) / self.count, self.text)


def _known(group: Group, saved: Sequence[Any]) -> list[Curve]:
    """The first curves of a group that are finished already."""
    fitting = [fits(scene, curve) for scene, curve in zip(group, saved, strict=False)]
    return list(saved[: fitting.index(False) if False in fitting else len(fitting)])


def _save(curves: Sequence[Curve], saved: int, report: Report) -> int:
    """Save the curves of a group that are not saved; returns how many are then."""
    for curve in curves[saved:]:
        report.save(curve)
    return len(curves)


def anonymous(scenes: Group) -> list[Scene]:
    """The scenes without what no curve depends on, as their names."""
    return [
        replace(scene, name="", title="", curves=(), draft=None, tuned=None, files=()) for scene in scenes
    ]


def are_curves_of(groups: Sequence[Group], number: int, results: Any) -> bool:
    """Whether results that were read from a file can be the curves of the group with this number."""
    if not 0 <= number < len(groups) or not isinstance(results, list):
        return False
    group = groups[number]
    return len(results) == len(group) and all(map(fits, group, results))


def fits(expected: Scene | Curve, curve: Any) -> bool:
    """Whether what was read from a file can be the curve of a scene, or that of which this one is to be."""
    if not isinstance(curve, Curve) or vars(curve).keys() != {field.name for field in fields(Curve)}:
        return False
    model = lost_curve(expected, "") if isinstance(expected, Scene) else expected
    names = ("frequency", *_BY_POINT)
    arrays = [getattr(curve, name) for name in names]
    if not all(_alike(array, getattr(model, name)) for array, name in zip(arrays, names, strict=True)):
        return False
    return curve.parameters == expected.parameters and len({array.shape[0] for array in arrays}) == 1


def _alike(array: Any, model: Any) -> bool:
    """Whether an array is by points as another is, and of the same kind."""
    same = isinstance(array, np.ndarray) and array.ndim == model.ndim
    return same and array.shape[1:] == model.shape[1:] and array.dtype.kind == model.dtype.kind


def as_curve(scene: Scene, result: Curve | Lost | None, reason: str = "") -> Curve:
    """The curve of a result of a sweep; one without points where the run was interrupted before."""
    if isinstance(result, Lost):
        if result.defect:
            return lost_curve(scene, f"{DEFECT}, {result.reason}", Cause.DEFECT)
        return lost_curve(scene, result.reason)
    return lost_curve(scene, reason, Cause.INTERRUPTED) if result is None else result


def lost_curve(scene: Scene, reason: str, cause: Cause = Cause.CALCULATION) -> Curve:
    """A curve without points, with the reason."""
    none, dofs = np.empty(0), scene.modal.dofs
    return Curve(
        parameters=dict(scene.parameters),
        frequency=none,
        amplitude=np.empty((0, len(dofs))),
        fundamental=np.empty((0, len(dofs))),
        phase=np.empty((0, len(dofs))),
        mean=np.empty((0, len(dofs))),
        regime=np.empty((0, len(scene.contacts)), dtype="<U6"),
        loop=np.empty((0, len(scene.contacts), 5)),
        cycle=np.empty((0, len(scene.contacts), 4)),
        cycle_error=np.empty((0, len(scene.contacts), 4)),
        stable=none,
        table_error=none,
        error=np.empty((0, len(dofs))),
        truncation_error=none,
        complete=False,
        reason=reason,
        cause=cause,
        peaks=dict.fromkeys(dofs, Peak(np.nan, np.nan)),
        folds=[],
        seconds=0.0,
    )


@dataclass
class CurveBatches:
    """The place where curves are computed and kept: the same for everything that one run computes."""

    jobs: int  # processes of this machine
    checkpoint: CheckpointFile | None
    place: Factory | None = None  # instead: an executor or a cluster
    defects: list[str] = field(default_factory=list)  # tracebacks, of curves that were lost to them

    def curves(
        self,
        compute: Compute,
        batches: Sequence[Group],
        mark: bytes,
        progress: Progress | None,
        states: tuple[type, ...] = (),
    ) -> list[Curve]:
        """The curves of all batches in order; those that could not be had say why.

        mark : digest of everything besides the scenes that decides the results.
        states : what compute saves consists of these.
        """
        kept = Results()
        if self.checkpoint is not None:
            whole = fingerprint(mark, [anonymous(batch) for batch in batches])
            kept = self.checkpoint.results(
                whole, (*KINDS, *states), lambda i, found: are_curves_of(batches, i, found)
            )
        place = self.place or place_for(self.jobs if len(batches) > 1 else 1)
        outcome = compute_batches(compute, batches, place, kept, progress)
        if outcome.lost:
            warnings.warn(outcome.lost, stacklevel=2)
        curves: list[Curve] = []
        for number, batch in enumerate(batches):
            found = outcome.of(number)
            found += [None] * (len(batch) - len(found))
            curves += [as_curve(scene, one, NOT_BEGUN) for scene, one in zip(batch, found, strict=True)]
            self.defects += [one.defect for one in found if isinstance(one, Lost) and one.defect]
        return curves
