"""Groups of curves that are traced together, as batches (`fcm.run`), on several cores, with checkpoints."""

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
)  # classes of results
_BY_POINT = (
    *("amplitude", "fundamental", "phase", "mean", "regime", "loop", "cycle", "cycle_error", "stable"),
    *("table_error", "error", "truncation_error"),
)


class CurveTask(Frozen):
    """The task that traces a group of curves."""

    request: Request
    peaks_only: bool = False
    samples: int = 0  # number of points that are kept even then

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
        """The curve, without its points if only peaks are asked for."""
        return without_points(curve, self.samples) if self.peaks_only else curve


class _Shown:
    """The progress of one curve of a group: its share, and a text."""

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
    """The first curves of a group, as far as they are saved."""
    fitting = [fits(scene, curve) for scene, curve in zip(group, saved, strict=False)]
    return list(saved[: fitting.index(False) if False in fitting else len(fitting)])


def _save(curves: Sequence[Curve], saved: int, report: Report) -> int:
    """Save the curves of a group that are not saved yet; return the number of saved ones."""
    for curve in curves[saved:]:
        report.save(curve)
    return len(curves)


def anonymous(scenes: Group) -> list[Scene]:
    """The scenes without anything that no curve depends on, such as names."""
    return [
        replace(scene, name="", title="", curves=(), draft=None, tuned=None, files=()) for scene in scenes
    ]


def are_curves_of(groups: Sequence[Group], number: int, results: Any) -> bool:
    """Whether results read from a file can be the curves of the group with this number."""
    if not 0 <= number < len(groups) or not isinstance(results, list):
        return False
    group = groups[number]
    return len(results) == len(group) and all(map(fits, group, results))


def fits(expected: Scene | Curve, curve: Any) -> bool:
    """Whether an object read from a file can be the expected curve, or that of the expected scene."""
    if not isinstance(curve, Curve) or vars(curve).keys() != {field.name for field in fields(Curve)}:
        return False
    model = lost_curve(expected, "") if isinstance(expected, Scene) else expected
    names = ("frequency", *_BY_POINT)
    arrays = [getattr(curve, name) for name in names]
    if not all(_alike(array, getattr(model, name)) for array, name in zip(arrays, names, strict=True)):
        return False
    return curve.parameters == expected.parameters and len({array.shape[0] for array in arrays}) == 1


def _alike(array: Any, model: Any) -> bool:
    """Whether an array has the kind of a model, and its shape but for the number of points."""
    same = isinstance(array, np.ndarray) and array.ndim == model.ndim
    return same and array.shape[1:] == model.shape[1:] and array.dtype.kind == model.dtype.kind


def as_curve(scene: Scene, result: Curve | Lost | None, reason: str = "") -> Curve:
    """The curve of a result of a sweep; a curve without points if the result is lost or missing."""
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
    """Where the curves of a run are computed, and the checkpoint that keeps them."""

    jobs: int  # processes of this machine
    checkpoint: CheckpointFile | None
    place: Factory | None = None  # an executor or a cluster, instead of the processes
    defects: list[str] = field(default_factory=list)  # tracebacks of the curves that they have cost

    def curves(
        self,
        compute: Compute,
        batches: Sequence[Group],
        mark: bytes,
        progress: Progress | None,
        states: tuple[type, ...] = (),
    ) -> list[Curve]:
        """Compute the curves of all batches, in order; a lost curve has the reason.

        mark : digest of everything besides the scenes that decides the results.
        states : classes of the data that compute saves.
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
