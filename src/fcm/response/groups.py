"""Groups of curves traced one after the other in this process; what fails is lost alone."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from fcm.response.law import Coefficients
from fcm.response.path import Progress
from fcm.response.result import DEFECT, Curve
from fcm.response.trace import ResponseError, trace_group
from fcm.scene.model import Scene

Group = tuple[Scene, ...]
Finished = Iterator[tuple[int, list[Curve]]]


@dataclass(frozen=True)
class Work:
    """What all groups are traced with."""

    method: str
    table: Coefficients | None

    def curves(self, group: Group, progress: Progress | None = None) -> list[Curve]:
        """Trace a group; if that fails, each of its curves alone, and those that fail then are lost."""
        try:
            return self.traced(group, progress)
        except ResponseError:
            raise
        except Exception as error:
            if len(group) == 1:
                what = "" if isinstance(error, MemoryError) else f"{DEFECT}, "
                return [lost_curve(group[0], f"{what}{type(error).__name__}: {error}")]
        return [self.curves((scene,))[0] for scene in group]

    def traced(self, group: Group, progress: Progress | None) -> list[Curve]:
        """The curves of a group; whatever cannot be foreseen is raised."""
        whole = replace(group[0], curves=group)
        return trace_group(whole, self.method, self.table, progress).curves


def lost_curve(scene: Scene, reason: str) -> Curve:
    """A curve without points, and why."""
    none, dofs = np.empty(0), scene.modal.dofs
    return Curve(
        parameters=dict(scene.parameters),
        frequency=none,
        amplitude=np.empty((0, len(dofs))),
        phase=np.empty((0, len(dofs))),
        mean=np.empty((0, len(dofs))),
        regime=np.empty((0, len(scene.contacts)), dtype="<U6"),
        loop=np.empty((0, len(scene.contacts), 5)),
        stable=np.empty(0, dtype=bool),
        table_error=none,
        truncation_error=none,
        complete=False,
        reason=reason,
        peaks=dict.fromkeys(dofs, (np.nan, np.nan)),
        folds=[],
        seconds=0.0,
    )


def one_by_one(work: Work, groups: Mapping[int, Group], progress: Progress | None) -> Finished:
    """Trace the groups in this process."""
    share = Shares(groups, progress)
    for number, group in groups.items():
        yield number, work.curves(group, share.of(number))
        share.set(number, 1.0)


class Shares:
    """How much of each group is finished, shown as the progress of all."""

    def __init__(self, groups: Mapping[int, Group], progress: Progress | None) -> None:
        self.sizes = {number: len(group) for number, group in groups.items()}
        self.done = dict.fromkeys(groups, 0.0)
        self.progress = progress

    def of(self, number: int) -> Progress:
        return lambda fraction, _text: self.set(number, 0.999 * fraction)

    def set(self, number: int, fraction: float) -> None:
        self.done[number] = fraction
        if self.progress is not None:
            total = sum(self.sizes.values())
            traced = sum(self.sizes[n] * f for n, f in self.done.items())
            self.progress(traced / total, f"{int(traced)} of {total} curves")
