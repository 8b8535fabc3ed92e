"""From a scene to its response: start, follow, correct with the closed form, assemble the results."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from fcm.response.assembly import Assembly
from fcm.response.balance import Balance
from fcm.response.branches import all_branches, outcome
from fcm.response.changes import with_changes
from fcm.response.crossings import with_stability
from fcm.response.law import ClosedForm, Coefficients
from fcm.response.newton import CLOSE
from fcm.response.path import Progress
from fcm.response.points import corrected, refined, with_folds
from fcm.response.result import Curve, Response
from fcm.response.structure import IntArray, group_of, with_contact
from fcm.scene.model import Scene

TO_BE_CORRECTED = 1e-6  # error of a traced point that the correction of the table's error removes as well
METHODS = ("table", "closed-form")


class ResponseError(ValueError):
    """The calculation cannot be begun; the message says why."""


def trace_group(
    scene: Scene,
    method: str = "table",
    table: Coefficients | None = None,
    progress: Progress | None = None,
    exact: Coefficients | None = None,
) -> Response:
    """Trace the curves of a scene as one group; the arguments are those of `fcm.response.trace`.

    The points are solutions with the coefficients `exact`: by default the closed form.
    """
    begin = time.perf_counter()
    curves = scene.each_curve()
    group = group_of([with_contact(curve) for curve in curves])
    exact_balance = Balance(group, exact or ClosedForm())
    by_table = method == "table" and not isinstance(table, ClosedForm)
    used = Balance(group, table or _default_table()) if by_table else exact_balance
    steps = np.array([c.max_step for c in curves])
    branches = all_branches(used, steps, progress, TO_BE_CORRECTED if by_table else CLOSE)
    points, uncorrected = corrected(exact_balance, branches, len(curves))
    if not by_table:
        points.shift[:] = 0.0
    points = with_folds(exact_balance, refined(exact_balance, with_changes(exact_balance, points)))
    points, stable = with_stability(exact_balance, points)
    results = Assembly(exact_balance, points, stable, branches).curves(curves, scene.modal.dofs)
    if by_table:
        stopped = np.array([not outcome(branches, i)[0] for i in range(len(curves))])
        _without_table(scene, curves, results, np.flatnonzero((uncorrected > 0) | stopped), progress)
    response = Response(
        scene.title, scene.modal.dofs, tuple(c.name for c in scene.contacts), results, method,
        scene.frequency_unit,
    )  # fmt: skip
    response.seconds = time.perf_counter() - begin
    share = response.seconds / max(sum(c.points for c in results), 1)
    for curve, number in zip(results, uncorrected, strict=True):
        curve.seconds = share * curve.points  # curves advance together: each is charged by its points
        curve.uncorrected = curve.uncorrected if curve.without_table else int(number)
    return response


def _without_table(
    scene: Scene,
    curves: tuple[Scene, ...],
    results: list[Curve],
    again: IntArray,
    progress: Progress | None,
) -> None:
    """Trace again, with the closed form, the curves that stop early or whose correction fails.

    The force of a contact much stiffer than the structure carries the table's error multiplied.
    """
    if again.size == 0:
        return
    whole = replace(scene, curves=tuple(curves[i] for i in again))
    for i, curve in zip(again, trace_group(whole, "closed-form", None, progress).curves, strict=True):
        curve.without_table = True
        results[i] = curve


def _default_table() -> Coefficients:
    from fcm.table import open_table

    return open_table()
