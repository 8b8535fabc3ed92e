"""Run a scene by every method: references, runs at several resolutions, contributions to the error."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from fcm.compare.errors import Errors, Reference, Shown, reference, worst
from fcm.compare.methods import CLOSED_FORM, EXACT, Method, Run, run, solve, with_step
from fcm.compare.options import COMPARE, CompareOptions
from fcm.compare.startup import Startup, startup
from fcm.model.scene import Scene
from fcm.reduction.options import REDUCTION
from fcm.response.options import leaving_out
from fcm.response.ring_limits import refuse_in_time
from fcm.response.sweep import trace
from fcm.scene.errors import counted
from fcm.table import open_table
from fcm.table.error import seam
from fcm.table.shipped import DEFAULT

Progress = Callable[[float, str], None]


class IncomparableError(RuntimeError):
    """Raised when there is nothing to compare; the message says why."""


@dataclass
class Comparison:
    """Every run with its errors against both references; the lists of errors are in the order of the runs."""

    scene: Scene
    options: CompareOptions = COMPARE
    references: dict[str, Reference] = field(default_factory=dict)
    startups: dict[str, Startup] = field(default_factory=dict)
    runs: list[Run] = field(default_factory=list)
    errors: dict[str, list[Errors]] = field(default_factory=lambda: {EXACT: [], CLOSED_FORM: []})
    left_out: list[str] = field(default_factory=list)
    seams: dict[str, float] = field(default_factory=dict)  # of each table, see `fcm.table.error.seam`
    seconds: float = 0.0
    interrupted: bool = False

    @property
    def parameters(self) -> list[dict[str, float]]:
        """Swept values of each curve."""
        return [scene.parameters for scene in self.scene.each_curve()]

    @property
    def names(self) -> list[str]:
        """Name of each curve, made of its swept values."""
        return [", ".join(f"{k} = {v:g}" for k, v in p.items()) or "the curve" for p in self.parameters]

    @property
    def without_exact(self) -> list[str]:
        """Why some curves have no exact reference, a sentence for each."""
        return [
            f"{name}: {line.reason or 'no periodic solution'}"
            for name, line in zip(self.names, self.references[EXACT].lines, strict=True)
            if not line.complete
        ]

    @property
    def notes(self) -> list[str]:
        """Notes that are needed to judge the errors."""
        found = []
        lines = (self.references[CLOSED_FORM].lines, self.references[EXACT].lines)
        for name, harmonic, exact in zip(self.names, *lines, strict=True):
            if not harmonic.complete:
                found.append(f"{name}: harmonic balance is not complete, and not compared: {harmonic.reason}")
            if exact.complete and len(harmonic.branches()) != len(exact.branches()):
                count = f"{len(harmonic.branches())} separate parts, the exact curve {len(exact.branches())}"
                found.append(f"{name}: harmonic balance has {count}; what one of them lacks is in the errors")
            if harmonic.complete and exact.complete and len(harmonic.folds) != len(exact.folds):
                count = f"{counted(len(harmonic.folds), 'fold')}, the exact curve {len(exact.folds)}"
                found.append(f"{name}: harmonic balance has {count}; they are not compared")
        return found + self._stopped()

    def _stopped(self) -> list[str]:
        """Sentences on methods whose curves stopped early; for an uncorrected table with a likely reason."""
        found: dict[tuple[str, bool], list[float]] = {}
        for one in self.runs:  # `without_exact` names the exact ones
            if one.method != EXACT and not all(line.complete for line in one.lines):
                found.setdefault((one.method, one.corrected), []).append(one.max_step)
        return [_stopped_early(*kind, steps, self.seams) for kind, steps in found.items()]

    def add(self, one: Run) -> None:
        """Adds a run and its errors against every reference."""
        errors = {name: reference.errors(one.lines) for name, reference in self.references.items()}
        self.runs.append(one)
        for name, values in errors.items():
            self.errors[name].append(values)

    def shown(self, against: str, number: int, measure: str) -> Shown:
        """The greatest error of a run over all curves, or an upper limit of it."""
        own = self.references[against].own
        return worst(self.errors[against][number][measure], own[measure], self.options.margin)

    def find(
        self, method: str, corrected: bool = True, left_out: bool = True, share: float = 1.0
    ) -> int | None:
        """The number of a run; None if it was not made."""
        step = with_step(self.scene, share).max_step
        for number, one in enumerate(self.runs):
            if (one.method, one.corrected, one.left_out, one.max_step) == (method, corrected, left_out, step):
                return number
        return None


def _stopped_early(method: str, corrected: bool, steps: list[float], seams: Mapping[str, float]) -> str:
    """Sentence that curves of a method stopped early with some longest steps."""
    name = method if corrected else f"{method}, as it is"
    longest = ", ".join(f"{step:g}" for step in dict.fromkeys(steps))
    said = f"{name}: curves stopped early with the longest step {longest}"
    if corrected or method not in seams:
        return said
    jump = f"uncorrected coefficients jump by up to {seams[method]:.1e} at n0_bar = b_bar"
    return f"{said}; its {jump}, where a curve may end"


def compare(
    scene: Scene,
    table: Path | None = None,
    progress: Progress | None = None,
    tolerance: float | None = REDUCTION.tolerance,
    options: CompareOptions = COMPARE,
) -> Comparison:
    """Run a scene by every method and measure error against run time.

    The methods are harmonic balance with the default table, the fast one and the closed form, and the exact
    periodic motion. Each runs over a range of longest steps, with and without negligible parts of the scene.
    Errors of peaks, folds and whole curves (`fcm.compare.errors.MEANINGS`) are against two references: the
    exact motion, and the closed form with the shortest steps, which has the same single harmonic.

    Parameters
    ----------
    scene : Scene
        From `fcm.load_scene`; every curve of its sweep is compared.
    table : Path, optional
        Another table to compare.
    progress : optional
        Called with the finished fraction and a text.
    tolerance : float
        Tolerance for leaving out negligible parts, as in `fcm.response.trace`.
    options : CompareOptions
        Longest steps, and all tolerances and limits.

    Raises
    ------
    ResponseError, TableError
        If the calculation cannot begin, or a table cannot be read.
    IncomparableError
        If no curve reaches the end of its range.
    KeyboardInterrupt
        If it is interrupted before both references are complete; later, the finished runs are returned.

    Examples
    --------
    In half a minute:

    >>> import fcm
    >>> comparison = compare(fcm.load_scene("yang1998-n5"))  # doctest: +SKIP
    >>> str(comparison.shown("exact", comparison.find("default table"), "peak"))  # doctest: +SKIP
    '6.6e-02'
    """
    refuse_in_time(scene, "a comparison with the exact motion")
    begin = time.perf_counter()
    out = Comparison(scene, options)
    show = progress or (lambda _share, _text: None)
    tables = {"default table": DEFAULT, "fast table": DEFAULT.with_name("fast.nc")}
    if table is not None:
        tables[f"table {table.name}"] = table
    methods = [Method(name, open_table(path)) for name, path in tables.items()]
    out.seams = {one.name: float(seam(one.table).max()) for one in methods if one.table is not None}
    methods += [Method(CLOSED_FORM), Method(EXACT)]
    first = trace(with_step(scene, max(options.steps)), options=leaving_out(tolerance))
    if first.interrupted:
        raise KeyboardInterrupt
    if not any(curve.complete for curve in first.curves):
        raise IncomparableError(
            f"no curve is complete, so there is nothing to compare: {first.curves[0].reason}"
        )
    out.left_out = first.left_out
    jobs = list(_jobs(methods, tolerance, options))
    _references(out, show)
    try:
        for number, (method, share, kept) in enumerate(jobs):
            show(0.4 + 0.6 * number / len(jobs), f"{method.name}, max_step x {share:g}")
            out.add(_same(out, method, share) or run(method, with_step(scene, share), kept, options=options))
        for one in methods:
            out.startups[one.name] = startup(one.name, tables.get(one.name), options.startup)
    except KeyboardInterrupt:
        out.interrupted = True
    out.seconds = time.perf_counter() - begin
    return out


def _same(out: Comparison, method: Method, share: float) -> Run | None:
    """An existing exact run that is the same because nothing is left out; None without one."""
    number = out.find(EXACT, left_out=False, share=share) if method.name == EXACT else None
    return None if number is None or out.left_out else replace(out.runs[number], left_out=True)


def _jobs(
    methods: list[Method], tolerance: float | None, options: CompareOptions
) -> Iterator[tuple[Method, float, float | None]]:
    """Yield method, share of the longest step and tolerance for leaving out; the most important first."""
    for method in methods:
        yield method, 1.0, tolerance
        if method.name != EXACT:  # the reference has made the exact one
            yield method, 1.0, None
    for method in methods:
        for share in options.exact_steps if method.name == EXACT else options.steps:
            if share != 1.0:
                yield method, share, tolerance
            if method.table is not None and (share == 1.0 or share in options.steps[::2]):
                yield Method(method.name, method.table, corrected=False), share, None


def _references(out: Comparison, show: Progress) -> None:
    """Compute both references, and the error of each from a run with longer steps."""
    made = []
    # name, shares of the longest step (reference, coarser run), begin and end as shares of the whole time
    options, finest_step = out.options, out.options.finest_step
    wanted = (
        (CLOSED_FORM, finest_step, 4.0 * finest_step, 0.0, 0.1),
        (EXACT, options.finest_exact_step, 1.0, 0.1, 0.4),
    )
    floor = {CLOSED_FORM: options.floor, EXACT: options.exact_floor}
    for name, finest, coarse, begins, ends in wanted:
        middle = 0.6 * begins + 0.4 * ends
        coarser = run(
            Method(name), with_step(out.scene, coarse), None, _part(show, begins, middle, name), options
        )
        scene = with_step(out.scene, finest)
        lines = solve(Method(name), scene, None, _part(show, middle, ends, name), options)
        out.references[name] = reference(name, scene.max_step, lines, coarser.lines, floor[name])
        made.append(coarser)
    for one in made:
        out.add(one)


def _part(show: Progress, begins: float, ends: float, name: str) -> Progress:
    """Progress of the reference of this name, which takes a part of the whole time."""
    return lambda share, text: show(begins + (ends - begins) * share, f"reference: {name}, {text}")


def contributions(out: Comparison) -> dict[str, tuple[str, int | None]]:
    """Contributions to the error: the reference each is measured against, and the number of its run."""
    rows: dict[str, tuple[str, int | None]] = {}
    tables = [name for name in dict.fromkeys(one.method for one in out.runs) if "table" in name]
    for name in tables:
        rows[f"{name}, as it is"] = CLOSED_FORM, out.find(name, corrected=False, left_out=False)
        rows[f"{name}, corrected"] = CLOSED_FORM, out.find(name, left_out=False)
    rows["step and tolerance"] = CLOSED_FORM, out.find(CLOSED_FORM, left_out=False)
    if out.left_out:
        rows["step, and what was left out"] = CLOSED_FORM, out.find(CLOSED_FORM)
    rows["single harmonic"] = (
        EXACT,
        out.find(CLOSED_FORM, left_out=False, share=4.0 * out.options.finest_step),
    )
    return rows
