"""How wrong and how slow every method is, and what failed: one page (``make report``)."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from fcm.cli.messages import Messages, pass_messages
from fcm.compare.tables import TextTable, every
from fcm.files import replacing

from . import extremes_table, others, published, recorded
from .made import facts
from .page import Page, Section, Table, render

TITLE = "The evidence"
ABOUT = (
    "Every scene below is solved by every method: harmonic balance with the default table, with the fast one "
    "and in closed form, and the exact periodic motion, each over a range of longest steps. Errors are "
    "greatest over all curves of a scene. Those of peaks and folds are relative. The distance of points and "
    "curves is measured in the plane of the logarithm of frequency and of amplitude relative to its "
    "greatest value, from each point of the one to the nearest of the other, so that it is as fair on steep "
    "flanks and at folds as elsewhere.",
    "Two references: the exact periodic motion, and harmonic balance in closed form with the shortest steps, "
    "which has the same single harmonic as what is compared. Their own errors are stated; where an error is "
    "less than ten times that of its reference, only a limit is given. “As it is” is a table before its "
    "points are corrected with the closed form, as fcm does at every point.",
    "“Solve” is the time of all curves together, on one core, in a program that has begun and has its table, "
    "and “CPU” the part of it in which the processor worked for it; “start” is the time of a program that "
    "begins as one with that method does and ends at once, “table” the part of it that opens the table. "
    "Evaluations are of the balanced equations, or periods of the exact motion.",
)
CAPTION = (
    "Error of the curve against processor time, longest steps halved from marker to marker. Arrows point "
    "down where the error is below what its reference can show."
)
STORED = (  # how a file of results becomes a section, what of it failed, the file, and what makes it
    (extremes_table.section, extremes_table.failures, "extremes.json", "make extremes"),
    (published.section, published.failures, "published.json", "make published"),
)
RECORDED = (recorded.STUDY, recorded.CALIBRATION, recorded.KEPT_MODES)
OTHERS = "bench-others"  # a folder of results


@click.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option("--scene", "scenes", multiple=True, required=True, metavar="NAME", help="In this order.")
@click.option(
    "--results", type=click.Path(path_type=Path), required=True, metavar="FOLDER",
    help="Where the targets of make leave what they found.",
)  # fmt: skip
@pass_messages
def evidence(messages: Messages, folder: Path, scenes: Sequence[str], results: Path) -> None:
    """Write FOLDER/index.html from NAME.json and NAME.png of each scene in it, and from the results."""
    begin = time.perf_counter()
    found = {name: json.loads((folder / f"{name}.json").read_text(encoding="utf-8")) for name in scenes}
    sections = [recorded.section(recorded.CONVERGENCE, results, folder)]
    sections += [_scene(name, summary) for name, summary in found.items()]
    failed = [(name, text) for name, one in found.items() for text in _failures(one)]
    missing = []
    for read, wrong, file, target in STORED:
        path = results / file
        if path.is_file():
            sections.append(read(path))
            failed += wrong(path)
        else:
            missing.append((target, recorded.MISSING.format(target)))
    sections += [recorded.section(one, results, folder) for one in RECORDED]
    unknown = [one.target for one in (recorded.CONVERGENCE, *RECORDED) if not (results / one.file).is_file()]
    missing += [(target, recorded.MISSING.format(target)) for target in unknown]
    if (results / OTHERS / "problems.json").is_file():
        sections.append(_others(results / OTHERS, folder))
    else:
        missing.append(("make bench-others", recorded.MISSING.format("make bench-others")))
    sections.append(_left_out(found, failed, missing))
    output = folder / "index.html"
    with replacing(output) as partial:
        partial.write_text(render(Page(TITLE, ABOUT, sections, facts(), facts_first=True)), encoding="utf-8")
    messages.info(f"wrote {output}: {len(found)} scenes, in {time.perf_counter() - begin:.1f} s")


def _others(results: Path, folder: Path) -> Section:
    """Beside other packages, with the picture drawn into the page's folder."""
    others.draw(results, folder / "others.png")
    return others.section(results)


def _scene(name: str, summary: dict[str, Any]) -> Section:
    return Section(
        name,
        text=(summary["title"],),
        picture=f"{name}.png",
        width=85.0,
        caption=CAPTION,
        commands=(
            f"fcm respond {name} --compare -o {name}.nc",
            f"fcm plot accuracy {name}.nc",
        ),
        tables=tuple(_table(rows) for rows in every(summary)),
    )


def _table(rows: TextTable) -> Table:
    return Table(tuple(rows[0]), [tuple(row) for row in rows[1:]])


def _left_out(
    found: dict[str, dict[str, Any]], failed: Sequence[tuple[str, str]], missing: Sequence[tuple[str, str]]
) -> Section:
    """What failed, what was not compared, and what the scenes did not need."""
    rows = [(name, "failed", text) for name, text in failed]
    rows += [(name, "left out", text) for name, one in found.items() for text in one["left_out"]]
    rows += [(target, "not run", text) for target, text in missing]
    text = () if rows else ("Nothing failed, and nothing was left out.",)
    tables = (Table(("scene or target", "", "what"), rows),) if rows else ()
    return Section("What failed or was left out", text=text, tables=tables)


def _failures(summary: dict[str, Any]) -> list[str]:
    out = [f"no exact reference, compared with the closed form alone: {t}" for t in summary["without_exact"]]
    out += summary["notes"]
    return out if summary["complete"] else [*out, "interrupted: some runs are missing"]
