"""The methods that are compared, each as one function from scenes to lines, with its calls counted."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

from fcm.compare.exact import exact_lines
from fcm.compare.lines import FloatArray, Line, line_of
from fcm.response.law import ClosedForm, Coefficients
from fcm.response.leave_out import leave_out
from fcm.response.path import Progress
from fcm.response.sweep import in_groups, trace
from fcm.response.trace import trace_group
from fcm.scene.model import Scene

CLOSED_FORM, EXACT = "closed form", "exact"


@dataclass(frozen=True)
class Method:
    """A table, the closed form, or the exact motion."""

    name: str
    table: Coefficients | None = None
    corrected: bool = True  # its points, with the closed form, as every result of fcm is


@dataclass(frozen=True)
class Run:
    """One method at one resolution."""

    method: str
    corrected: bool
    left_out: bool  # whether what the scene does not need was left out
    max_step: float  # longest step along the curves, relative to their extent
    lines: list[Line]
    seconds: float  # solving alone, in a program that has begun and has its table
    processor_seconds: float  # the same where nothing else takes the processor
    calls: int  # of the solver for friction coefficients, each for many curves or points at once
    evaluations: int  # of these, each of one contact; of `exact`: periods of the motion, each a call

    @property
    def points(self) -> int:
        """Of all curves."""
        return sum(line.points for line in self.lines)


class Counted:
    """Coefficients that count how often they are asked."""

    def __init__(self, source: Coefficients) -> None:
        self.source, self.calls, self.evaluations = source, 0, 0

    def gradients(
        self, n0_bar: FloatArray, b_bar: FloatArray, phi: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        self.calls += 1
        self.evaluations += n0_bar.size
        return self.source.gradients(n0_bar, b_bar, phi)


def run(method: Method, scene: Scene, tolerance: float | None, progress: Progress | None = None) -> Run:
    """Solve the scene by a method, time it, and count its calls.

    tolerance : of what is left out; None for leaving nothing out.
    """
    calls = evaluations = 0
    if method.name != EXACT:  # at the same time it is warm
        calls, evaluations = _counted(method, scene, tolerance)
    begin, processor = time.perf_counter(), time.process_time()
    lines = solve(method, scene, tolerance, progress)
    seconds, processor = time.perf_counter() - begin, time.process_time() - processor
    if method.name == EXACT:
        calls = evaluations = sum(line.periods for line in lines)
    step, left_out = scene.each_curve()[0].max_step, tolerance is not None
    return Run(method.name, method.corrected, left_out, step, lines, seconds, processor, calls, evaluations)


def with_step(scene: Scene, share: float) -> Scene:
    """The scene with this share of its longest steps, none longer than the whole extent of a curve."""
    curves = tuple(replace(c, max_step=min(share * c.max_step, 1.0), curves=()) for c in scene.each_curve())
    return replace(scene, max_step=curves[0].max_step, curves=curves)


def solve(
    method: Method, scene: Scene, tolerance: float | None, progress: Progress | None = None
) -> list[Line]:
    """The curves of a scene by a method; the arguments are those of `run`."""
    if method.name == EXACT:
        return exact_lines(_lighter(scene, tolerance, foresee=False), progress)
    if not method.corrected:
        assert method.table is not None
        return _by_groups(_lighter(scene, tolerance), method.table, method.table)
    kind = "closed-form" if method.table is None else "table"
    response = trace(scene, kind, method.table, tolerance=tolerance)
    if response.interrupted:
        raise KeyboardInterrupt
    return [line_of(curve) for curve in response.curves]


def _counted(method: Method, scene: Scene, tolerance: float | None) -> tuple[int, int]:
    """Calls and evaluations, of the table and of the closed form that corrects it together."""
    last = Counted(method.table if method.table and not method.corrected else ClosedForm())
    way = Counted(method.table) if method.table else None
    _by_groups(_lighter(scene, tolerance), way, last)
    counters = [last] if way is None else [way, last]
    return sum(c.calls for c in counters), sum(c.evaluations for c in counters)


def _lighter(scene: Scene, tolerance: float | None, foresee: bool = True) -> Scene:
    """The scene without what it does not need.

    foresee : also without what is only foreseen not to be needed, which `trace` checks afterwards.
    """
    if tolerance is None:
        return scene
    return replace(scene, curves=leave_out(scene.each_curve(), tolerance, foresee).curves)


def _by_groups(scene: Scene, way: Coefficients | None, last: Coefficients) -> list[Line]:
    """Follow with one source of coefficients, None for the last too; the points satisfy the last."""
    kind = "closed-form" if way is None else "table"
    groups = in_groups(scene.each_curve())
    parts = (trace_group(replace(scene, curves=group), kind, way, exact=last) for group in groups)
    return [line_of(curve) for part in parts for curve in part.curves]
