"""Error against processor time with more and more harmonics, of five scenes (``make convergence``)."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

import click
import numpy as np

from fcm.cli.messages import Messages, pass_messages
from fcm.compare.exact import exact_lines
from fcm.model.scene import Scene
from fcm.response.request import Request
from fcm.response.sweep import trace
from fcm.response.trace import traced_curve
from fcm.results.result import Curve
from fcm.run import Execution
from fcm.scene.load import load_scene
from fcm.table import Table, open_table

from .convergence_picture import Balanced, Line, draw_convergence
from .measured import write_measured

HARMONICS = (1, 2, 3, 5, 9, 15)
FIRST = 2  # harmonics from which the order is taken: with one alone the error is not yet of the series
REPEATS = 5
SINE = 10e-6  # [ms] a value, of the machine to which times are scaled
ANGLES = np.random.default_rng(3).uniform(0.0, 2.0 * np.pi, 200_000)


class Case(NamedTuple):
    """One curve of a bundled scene, which with a sweep is that of a value."""

    name: str
    scene: str
    value: float | None = None


CASES = (
    Case("yang1998-n5", "yang1998-n5"),
    Case("yang1998, preload −5 (a gap)", "yang1998", -5.0),
    Case("two-contacts", "two-contacts"),
    Case("dry-friction-lift-off", "dry-friction-lift-off"),
    Case("extreme/b-one-opposed", "extreme/b-one-opposed"),
)


@click.command()
@click.argument("output", type=click.Path(dir_okay=False, path_type=Path))
@click.option("--picture", type=click.Path(dir_okay=False, path_type=Path), required=True, metavar="FILE")
@pass_messages
def convergence(messages: Messages, output: Path, picture: Path) -> None:
    """Write the numbers as JSON to OUTPUT and draw them; print them as a table."""
    table = open_table()
    lines = [_measured(case, table) for case in CASES]
    write_measured(output, lines, picture, draw_convergence(lines))
    click.echo("\n".join(as_text(lines)))
    messages.info(f"wrote {output} and {picture}")


def as_text(lines: Sequence[Line]) -> list[str]:
    """A row for each scene: error and time [ms] by the harmonics, of table and exact motion; the order."""
    heads = [*(f"H = {one.harmonics}" for one in lines[0].balanced), "table alone"]
    rows = [f"{'error, ms':30s}" + "".join(f"{head:>15s}" for head in heads) + f"{'exact':>8s}{'order':>7s}"]
    for line in lines:
        cells = "".join(f"{one.error:9.1e}{one.milliseconds:6.0f}" for one in (*line.balanced, line.table))
        order = "-" if line.order is None else f"{line.order:.1f}"
        rows.append(f"{line.name:30s}{cells}{line.exact:8.0f}{order:>7s}")
    return rows


def convergence_order(balanced: Sequence[Balanced]) -> float | None:
    """The p of error = c H**-p by least squares of the logarithms, from FIRST harmonics on.

    >>> round(convergence_order([Balanced(h, 0.2 * h**-3.0, 1.0) for h in (1, 2, 5, 9)]), 9)
    3.0
    """
    used = [(one.harmonics, one.error) for one in balanced if one.harmonics >= FIRST and one.error > 0.0]
    if len(used) < 2:
        return None
    harmonics, errors = np.log(np.array(used)).T
    return -float(np.polyfit(harmonics, errors, 1)[0])


def _measured(case: Case, table: Table) -> Line:
    scene = _scene(case)
    exact = exact_lines(scene)[0]
    peaks = {dof: height for dof, (height, _frequency) in exact.peaks.items()}

    def balanced(harmonics: int, solve: Callable[[], Curve]) -> Balanced:
        curve = solve()
        if not curve.complete:
            raise click.ClickException(f"{case.name} with {harmonics} harmonics: {curve.reason}")
        return Balanced(harmonics, greatest_error(curve, peaks), _milliseconds(solve))

    if not exact.complete:
        raise click.ClickException(f"{case.name}, exact: {exact.reason}")
    alone = balanced(1, partial(traced_curve, scene, Request(table=table, corrected=False)))
    rows = [balanced(h, partial(_curve, scene, h)) for h in HARMONICS]
    return Line(case.name, rows, alone, _milliseconds(partial(exact_lines, scene)), convergence_order(rows))


def _scene(case: Case) -> Scene:
    curves = load_scene(case.scene).each_curve()
    (one,) = [c for c in curves if case.value is None or case.value in c.parameters.values()]
    return replace(one, curves=())


def _curve(scene: Scene, harmonics: int) -> Curve:
    """The curve with exact forces, errors and stability included."""
    return trace(scene, "closed-form", harmonics=harmonics, execution=Execution(jobs=1)).curves[0]


def greatest_error(curve: Curve, peaks: Mapping[str, float]) -> float:
    """Of the peaks of all degrees of freedom, relative to those given."""
    return max(abs(curve.peaks[dof].amplitude / peak - 1.0) for dof, peak in peaks.items())


def _milliseconds(solve: Callable[[], object]) -> float:
    """Processor time, the least of several, as multiples of the sines of its turn."""
    multiples = []
    for _ in range(REPEATS):
        sine = min(_seconds(lambda: np.sin(ANGLES)) for _ in range(3)) / ANGLES.size
        multiples.append(_seconds(solve) / sine)
    return min(multiples) * SINE


def _seconds(call: Callable[[], object]) -> float:
    begin = time.process_time()
    call()
    return time.process_time() - begin
