"""All curves of a scene: what it does not need left out, groups traced on cores, interruptions survived."""

from __future__ import annotations

import os
import time
from pathlib import Path

from fcm.response import sentences
from fcm.response.foreseen import ENOUGH
from fcm.response.groups import Finished, Group, Work, lost_curve, one_by_one
from fcm.response.kept import Kept, fingerprint
from fcm.response.law import UNKNOWNS, ClosedForm, Coefficients
from fcm.response.leave_out import TOLERANCE, Lighter, keep_all, leave_out
from fcm.response.path import Progress
from fcm.response.put_back import checked, least_room, restored
from fcm.response.result import Curve, Response
from fcm.response.structure import unknown_contacts
from fcm.response.trace import METHODS, ResponseError
from fcm.scene.model import Scene

LARGEST_GROUP = 250  # curves
LARGEST_MATRICES = 20_000  # numbers in the Jacobians of a group
INTERRUPTED = "interrupted before it was traced"


def trace(
    scene: Scene,
    method: str = "table",
    table: Coefficients | None = None,
    progress: Progress | None = None,
    *,
    jobs: int = 1,
    tolerance: float | None = TOLERANCE,
    keep: Path | None = None,
    resume: bool = False,
) -> Response:
    """Trace the response curves of a scene.

    Parameters
    ----------
    scene : Scene
        From `fcm.load_scene`; one curve for each combination of its swept values.
    method : {"table", "closed-form"}
        Coefficients that the solver uses on its way. Either way every point is then corrected with the
        closed form; the shift is its `table_error`.
    table : optional
        An open table; the shipped one by default.
    progress : optional
        Called now and then with the finished fraction and a text.
    jobs : int
        Processes for the groups of curves; 0 for one on each core.
    tolerance : float, optional
        Greatest relative change of the response by what is left out; 0 leaves out only what has no effect
        at all, None nothing.
    keep : Path, optional
        File for the finished groups of a sweep; it is there only while the sweep is not finished.
    resume : bool
        Take from that file what is finished already.

    Raises
    ------
    ResponseError
        If the method is unknown, or the scene has no range of frequencies.
    """
    if method not in METHODS:
        raise ResponseError(f"method {method!r} is not one of {', '.join(METHODS)}")
    if not scene.has_range:
        raise ResponseError("the scene has no [response] with frequency = [from, to], so no curve to trace")
    begin = time.perf_counter()
    curves = scene.each_curve()
    lighter = keep_all(curves) if tolerance is None else leave_out(curves, tolerance)
    sweep = _Sweep(scene, method, table, progress, jobs or os.cpu_count() or 1, keep, resume)
    response, said = sweep.run(lighter), list(lighter.sentences)
    if lighter.above is not None and tolerance is not None:
        shift = checked(response, lighter)
        if 2.0 * shift <= tolerance or interrupted(response):
            said.append(sentences.on_modes(lighter, shift))
        else:  # the estimate was too good: with all modes after all
            lighter = leave_out(curves, 0.0)
            response = sweep.run(lighter)
    response = restored(response, lighter)
    if lighter.states:
        said += _as_foreseen(sweep, response, lighter)
    if sweep.table_idle:
        said.append("the table: no contact needs it (no effect)")
    response.left_out = [*said, *sentences.on_means(lighter), *sentences.on_points(response)]
    response.seconds = time.perf_counter() - begin
    return response


def _as_foreseen(sweep: _Sweep, response: Response, lighter: Lighter) -> list[str]:
    """Solve curves again on which contacts did not stay as foreseen, with all of them; what is to be said."""
    rooms = [least_room(*each, lighter.states) for each in zip(response.curves, lighter.full, strict=True)]
    wrong = [i for i, room in enumerate(rooms) if min(room.values()) < ENOUGH]
    if wrong:
        again = leave_out(tuple(lighter.full[i] for i in wrong), 0.0, foresee=False)
        sweep.keep = None
        for i, curve in zip(wrong, restored(sweep.run(again), again).curves, strict=True):
            response.curves[i] = curve
    right = [room for i, room in enumerate(rooms) if i not in wrong]
    return sentences.on_contacts(lighter, right, len(wrong))


class _Sweep:
    def __init__(
        self,
        scene: Scene,
        method: str,
        table: Coefficients | None,
        progress: Progress | None,
        jobs: int,
        keep: Path | None,
        resume: bool,
    ) -> None:
        self.scene, self.method, self.table, self.progress = scene, method, table, progress
        self.jobs, self.keep, self.resume = jobs, keep, resume
        self.table_idle = method == "table" and table is None  # until it is opened

    def run(self, lighter: Lighter) -> Response:
        """Trace all groups that are not finished already."""
        groups = in_groups(lighter.curves)
        several = self.keep if len(groups) > 1 else None
        mark = fingerprint(lighter.curves, self.method, self.table, len(groups)) if several else b""
        kept = Kept(several, mark, self.resume)
        left = {number: group for number, group in groups.items() if number not in kept.finished}
        try:
            for number, curves in self._finished(left, self._coefficients(lighter)):
                kept.add(number, curves)
            kept.remove()
        except KeyboardInterrupt:
            if not kept.finished:
                kept.remove()
                raise
        return self._response(groups, kept.finished)

    def _coefficients(self, lighter: Lighter) -> Coefficients | None:
        """What the curves are followed with; a table only if a contact needs it."""
        if self.method != "table" or self.table is not None:
            return self.table
        if lighter.idle_table:
            return ClosedForm()
        self.table_idle = False
        return _shipped_table()

    def _finished(self, groups: dict[int, Group], coefficients: Coefficients | None) -> Finished:
        work = Work(self.method, coefficients)
        if self.jobs > 1 and len(groups) > 1:
            from fcm.response.cores import on_cores

            return on_cores(work, groups, self.jobs, self.progress)
        return one_by_one(work, groups, self.progress)

    def _response(self, groups: dict[int, Group], finished: dict[int, list[Curve]]) -> Response:
        curves: list[Curve] = []
        for number, group in groups.items():
            curves += finished.get(number) or [lost_curve(scene, INTERRUPTED) for scene in group]
        contacts = tuple(c.name for c in groups[0][0].contacts)
        scene = self.scene
        return Response(scene.title, scene.modal.dofs, contacts, curves, self.method, scene.frequency_unit)


def _shipped_table() -> Coefficients:
    """The shipped table, opened once for all groups."""
    from fcm.table import open_table

    return open_table()


def interrupted(response: Response) -> bool:
    """Whether curves were not traced because the sweep was interrupted."""
    return any(curve.reason == INTERRUPTED for curve in response.curves)


def in_groups(curves: tuple[Scene, ...]) -> dict[int, Group]:
    """The curves in groups that advance together; how many there are does not depend on the cores."""
    unknowns = UNKNOWNS * max(unknown_contacts(curves[0]), 1)
    size = max(min(LARGEST_GROUP, LARGEST_MATRICES // unknowns**2), 1)
    return {i: curves[first : first + size] for i, first in enumerate(range(0, len(curves), size))}
