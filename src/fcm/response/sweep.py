"""Sweep over all curves of a scene: leaves out negligible parts, traces groups on cores, can be resumed."""

from __future__ import annotations

import time
from collections.abc import Sequence
from copy import copy
from dataclasses import replace
from functools import cache, partial

from fcm.harmonic_balance.cost_model import seconds_of_curve
from fcm.harmonic_balance.sampled_law import check_own_laws
from fcm.model.scene import Scene
from fcm.quoting import quoted
from fcm.reduction import sentences
from fcm.reduction.negligible_parts import ReducedScenes, unreduced, without_negligible_parts
from fcm.reduction.options import REDUCTION
from fcm.reduction.restore import checked, restored
from fcm.response.blades import with_blades
from fcm.response.curve_batches import CurveBatches, CurveTask
from fcm.response.options import ResponseOptions
from fcm.response.request import Request, ResponseError, request_of
from fcm.response.ring_limits import check_modes, unknown
from fcm.response.trace import METHODS
from fcm.results.at_rest import without_rounding
from fcm.results.result import Response
from fcm.run import IN_THIS_PROCESS, Execution, Progress, fingerprint
from fcm.run.progress import part
from fcm.structure.loads import driven_harmonics
from fcm.table import Table

HILL = (
    "the sequence of states of contacts with laws of their own: stability is by Hill's method, with the "
    "harmonics that are balanced"
)
NO_TABLE_IN_PLANE = "the table: forces of contacts in a plane are exact, with one harmonic too (no effect)"


def trace(
    scene: Scene,
    method: str | Table = "table",
    execution: Execution = IN_THIS_PROCESS,
    *,
    harmonics: int | Sequence[int] | None = None,
    accuracy: float | None = None,
    options: ResponseOptions | None = None,
) -> Response:
    """Trace the response curves of a scene.

    Parameters
    ----------
    scene : Scene
        From `fcm.load_scene`; one curve for each combination of its swept values.
    method : {"table", "closed-form"} or an open table
        Coefficients of one harmonic; "table" is the shipped table. The points are solutions with the closed
        form in any case. With a table, `table_error` is the distance of the table's own solution from each.
    execution : Execution, optional
        Where groups of curves are computed, and the checkpoint; by default in this process, without one.
    harmonics : int or sequence of int, optional
        Harmonics of the balance: up to a number, or some that begin with 1; the scene's by default.
    accuracy : float, optional
        Relative accuracy of peaks and folds that chooses the harmonics instead. The default is the scene's,
        or 1e-2 if no harmonics are given.
    options : ResponseOptions, optional
        Tolerances and limits; `reduction.tolerance` decides on modes left out, `sweep.peaks_only` on points.

    Raises
    ------
    ResponseError
        If the method is unknown, or the scene has no range of frequencies.
    ContactLawError
        If a contact law of one's own gives no forces.
    CheckpointError
        If another run uses the checkpoint file.
    PlaceClosed
        If the place of execution accepts nothing more, and no curve is finished; else the finished curves are
        returned.
    """
    table = None if isinstance(method, str) else method
    name = method if isinstance(method, str) else "table"
    if name not in METHODS:
        raise ResponseError(f"method {quoted(name)} is not one of {', '.join(METHODS)}")
    if not scene.has_range:
        raise ResponseError("the scene has no [response] with frequency = [from, to], so no curve to trace")
    begin = time.perf_counter()
    request = request_of(scene, harmonics, accuracy, options)
    check_own_laws(scene)
    check_modes(scene, request)
    progress = execution.progress
    with execution.checkpoint() as checkpoint:
        curves = CurveBatches(execution.processes, checkpoint, execution.place)
        response = _traced(_Sweep(scene, name, table, request, curves), progress)
        if not response.interrupted:
            execution.discard(checkpoint)
    if scene.tuned is not None and not response.interrupted:
        own = partial(trace, method=method, harmonics=harmonics, accuracy=accuracy, options=options)
        response = with_blades(response, scene, own)
    response.defects = curves.defects
    response.seconds = time.perf_counter() - begin
    if progress is not None and not response.interrupted:
        progress(1.0, f"{len(response.curves)} of {len(response.curves)} curves")
    return response


def _traced(sweep: _Sweep, progress: Progress | None) -> Response:
    """Trace the curves without negligible parts, and again with all modes if these turn out to matter."""
    curves = sweep.scene.each_curve()
    options, tolerance = sweep.request.options.sweep, sweep.request.options.reduction.tolerance
    asked = sweep.request.harmonics or (options.expected_harmonic,)
    highest = max((*asked, *driven_harmonics(sweep.scene)))
    if tolerance is None or sweep.scene.ring is not None or sweep.scene.with_own_laws:
        lighter = unreduced(curves)
    else:
        lighter = without_negligible_parts(curves, tolerance, highest, sweep.request.options.reduction)
    response, said = sweep.run(lighter, part(progress, 0.0, options.traced_share)), list(lighter.sentences)
    if lighter.above is not None and tolerance is not None:
        shift = checked(response, lighter)
        if 2.0 * shift <= tolerance or response.interrupted:
            said.append(sentences.on_modes(lighter, shift))
        else:  # the estimate was too low: trace with all modes
            lighter = without_negligible_parts(curves, 0.0, highest, sweep.request.options.reduction)
            response = sweep.run(lighter, part(progress, options.traced_share, 1.0))
    response = restored(response, lighter)
    response.curves = [without_rounding(one) for one in response.curves]
    if sweep.table is not None and sweep.scene.planar:
        said.append(NO_TABLE_IN_PLANE)
    elif sweep.table_idle and any(one.harmonics == (1,) for one in response.curves):  # only these use it
        said.append(NO_TABLE_IN_PLANE if sweep.scene.planar else "the table: no contact needs it (no effect)")
    if sweep.scene.with_own_laws:
        said.append(HILL)
    of_ring = unknown(sweep.scene, sweep.request)
    response.left_out = [*said, *sentences.on_means(lighter), *of_ring.sentences]
    response.without_stability = of_ring.stability
    return response


class _Sweep:
    """The sweeps of a run, each with fewer parts left out; they share one progress bar."""

    def __init__(
        self, scene: Scene, method: str, table: Table | None, request: Request, curves: CurveBatches
    ) -> None:
        self.scene, self.method, self.table, self.curves = scene, method, table, curves
        self.request, self.peaks_only = request, request.options.sweep.peaks_only
        self.table_idle = method == "table" and table is None  # until it is opened
        # before the table is used, as it counts its look-ups
        options = (method, table, request.harmonics, request.accuracy, request.options)
        self.mark = b"" if curves.checkpoint is None else fingerprint(*options)

    def run(self, lighter: ReducedScenes, progress: Progress | None) -> Response:
        """Trace all groups that are not finished yet; return the response."""
        every = tuple(replace(scene, draft=None) for scene in lighter.curves)
        batches = in_batches(every, batch_size(every[0], self.request))
        samples = REDUCTION.max_checked_of_curve if lighter.above is not None else 0
        task = CurveTask(replace(self.request, table=self._table(lighter)), self.peaks_only, samples)
        curves = self.curves.curves(task, batches, self.mark, progress)
        response = Response.of(self.scene, curves, self.method)
        response.peaks_only = self.peaks_only
        return response

    def _table(self, lighter: ReducedScenes) -> Table | None:
        """The table that is evaluated at the points of the curves; None unless a contact needs it."""
        if self.method != "table" or self.table is not None:
            return self.table
        if lighter.idle_table:
            return None
        self.table_idle = False
        return _shipped_table()


@cache
def _opened() -> Table:
    from fcm.table import open_table

    return open_table()


def _shipped_table() -> Table:
    """A copy of the shipped table, which is opened once per process; each copy has its own counts."""
    return copy(_opened())


def batch_size(scene: Scene, request: Request) -> int:
    """Number of curves in a batch: fewer where each takes long, so that cores share even a few curves."""
    options = request.options.sweep
    each = seconds_of_curve(scene, len(request.harmonics or range(options.expected_harmonic)))
    if each * options.batch <= options.batch_seconds:
        return options.batch
    return max(int(options.batch_seconds / each), 1)


def in_batches(curves: tuple[Scene, ...], size: int) -> list[tuple[Scene, ...]]:
    """The curves in batches of a size; results do not depend on it, as each curve is computed alone."""
    return [curves[first : first + size] for first in range(0, len(curves), size)]
