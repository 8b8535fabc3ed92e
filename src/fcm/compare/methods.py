"""The compared methods: each solves a scene for its lines, with run time and evaluations counted."""

from __future__ import annotations

import time
from dataclasses import replace

from fcm.compare.exact import exact_lines
from fcm.compare.lines import Line, line_of
from fcm.compare.options import COMPARE, CompareOptions
from fcm.frozen import Frozen
from fcm.model.scene import Scene
from fcm.reduction.negligible_parts import without_negligible_parts
from fcm.response.options import leaving_out
from fcm.response.request import Request
from fcm.response.sweep import trace
from fcm.response.trace import traced_curve
from fcm.run import Progress
from fcm.table import Table

CLOSED_FORM, EXACT = "closed form", "exact"


class Method(Frozen):
    """A method: a table, the closed form, or the exact motion."""

    name: str
    table: Table | None = None
    corrected: bool = True  # whether its points are corrected with the closed form, as all results of fcm are


class Run(Frozen):
    """Results and cost of one method at one resolution."""

    method: str
    corrected: bool
    left_out: bool  # whether negligible parts of the scene were left out
    max_step: float  # longest step along the curves, relative to their extent
    lines: list[Line]
    seconds: float  # to solve only, without the start of the program and the opening of the table
    processor_seconds: float  # processor time of the same
    evaluations: int  # of the balanced equations, to follow the curves; of `exact`: periods of the motion

    @property
    def points(self) -> int:
        """Number of points of all curves."""
        return sum(line.points for line in self.lines)


def run(
    method: Method,
    scene: Scene,
    tolerance: float | None,
    progress: Progress | None = None,
    options: CompareOptions = COMPARE,
) -> Run:
    """Solve the scene by a method and time it.

    tolerance : for leaving out negligible parts; None leaves nothing out.
    """
    if method.name != EXACT:  # warm-up
        solve(method, scene, tolerance, options=options)
    begin, processor = time.perf_counter(), time.process_time()
    lines = solve(method, scene, tolerance, progress, options)
    seconds, processor = time.perf_counter() - begin, time.process_time() - processor
    evaluations = sum(line.evaluations for line in lines)
    step, left_out = scene.each_curve()[0].max_step, tolerance is not None
    return Run(method.name, method.corrected, left_out, step, lines, seconds, processor, evaluations)


def with_step(scene: Scene, share: float) -> Scene:
    """The scene with its longest steps scaled by a share, none longer than the whole extent of a curve."""
    curves = tuple(replace(c, max_step=min(share * c.max_step, 1.0), curves=()) for c in scene.each_curve())
    return replace(scene, max_step=curves[0].max_step, curves=curves)


def solve(
    method: Method,
    scene: Scene,
    tolerance: float | None,
    progress: Progress | None = None,
    options: CompareOptions = COMPARE,
) -> list[Line]:
    """The curves of a scene by a method; the arguments are those of `run`."""
    lighter = _lighter(scene, tolerance)
    if method.name == EXACT:
        return exact_lines(lighter, progress, options.exact)
    if not method.corrected:
        wanted = Request(table=method.table, corrected=False)
        curves = [traced_curve(curve, wanted) for curve in lighter.each_curve()]
        return [line_of(curve, scene) for curve in curves]
    law = "closed-form" if method.table is None else method.table
    response = trace(scene, law, harmonics=1, options=leaving_out(tolerance))
    if response.interrupted:
        raise KeyboardInterrupt
    return [line_of(curve, scene) for curve in response.curves]


def _lighter(scene: Scene, tolerance: float | None) -> Scene:
    """The scene without its negligible parts."""
    if tolerance is None:
        return scene
    return replace(scene, curves=without_negligible_parts(scene.each_curve(), tolerance).curves)
