"""Other packages beside fcm, as ``make bench-others`` has measured: tables, and where they are ahead."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

import click

from fcm.cli.columns import aligned
from fcm.cli.messages import Messages, pass_messages
from fcm.files import replacing
from fcm.plot.style import save

from .measured import DPI
from .others_picture import Points, draw_others
from .page import Section, Table

PACKAGES = {"pyharm": "pyHarm-os", "tmdsimpy": "tmdsimpy"}  # by the files of their results
OURS = "fcm"
AGREE = 0.01  # relative difference of a random scene's peak, within which it is that of fcm
COLUMNS = ("harmonics", "package", "samples", "curves", "points", "CPU [s]", "greatest error", "median error",
           "folds right", "time over fcm")  # fmt: skip
RANDOM_COLUMNS = ("package", "complete", "peak as fcm's", "CPU [s], median", "why not, most often")
ABOUT = (
    "The same balance with the same harmonics: eight preloads of the paper's oscillator, and fifty random "
    "scenes of two to twelve modes and one to four contacts. Both packages sample the forces over the cycle; "
    "those of fcm are exact. Error: of the peak of half the peak-to-peak displacement, relative to exact "
    "forces with steps sixteen times shorter; a peak of the other packages is taken from a polynomial "
    "through five of their points, which alone errs by some 1e-7. What is said of fcm is what its steps do; "
    "that the others come to the same peaks with more samples says that these are right. Processor "
    "time, compilation not counted; that of fcm has every branch, the estimated errors and the stability in "
    "it, that of the others has not.",
    "pyHarm-os gets the law of the paper as a plug-in of compiled code; tmdsimpy has it, differentiated by "
    "JAX. Both have what fcm has not: pyHarm-os any element in a structure of many parts, tmdsimpy rough "
    "contacts and sliding in a plane.",
)

Record = dict[str, Any]  # of a JSON file


class Row(NamedTuple):
    """The preloads with so many harmonics, by a package with so many samples (None: exact forces)."""

    harmonics: int
    package: str
    samples: int | None
    finished: int
    asked: int
    points: int
    seconds: float
    errors: Sequence[float]
    folds_right: int
    ratio: float  # of the processor time to that of fcm for the same curves

    def cells(self) -> tuple[str, ...]:
        greatest, middle = (f"{f(self.errors):.1e}" if self.errors else "-" for f in (max, median))
        return (
            str(self.harmonics), self.package, str(self.samples or "exact"),
            f"{self.finished} of {self.asked}", str(self.points), f"{self.seconds:.3g}", greatest, middle,
            f"{self.folds_right} of {self.finished}", f"{self.ratio:.3g}" if self.finished else "-",
        )  # fmt: skip


def read(folder: Path) -> tuple[Record, dict[str, Record]]:
    """The problems, and the results of each package that there is."""
    problems: Record = json.loads((folder / "problems.json").read_text(encoding="utf-8"))
    files = {name: folder / f"{name}.json" for name in PACKAGES}
    return problems, {n: json.loads(f.read_text(encoding="utf-8")) for n, f in files.items() if f.is_file()}


def rows(problems: Record, found: dict[str, Record]) -> list[Row]:
    """By harmonics, package and samples; fcm first."""
    asked = [p for p in problems["problems"] if p["group"] == "preloads"]
    out = []
    for harmonics in sorted({p["harmonics"] for p in asked}):
        here = {p["name"]: p for p in asked if p["harmonics"] == harmonics}
        own = [{**p["fcm"], "name": name} for name, p in here.items()]
        out.append(_row(OURS, None, here, own))
        for package, record in found.items():
            results = [r for r in record["results"] if r["harmonics"] == harmonics and r["name"] in here]
            for samples in sorted({r["samples"] for r in results}):
                some = [r for r in results if r["samples"] == samples]
                out.append(_row(PACKAGES[package], samples, here, some))
    return out


def _row(package: str, samples: int | None, asked: dict[str, Record], results: list[Record]) -> Row:
    done = [r for r in results if not r["state"] and r["peak"] is not None]
    pairs = [(r, asked[r["name"]]) for r in done]
    seconds, ours = sum(r["seconds"] for r in done), sum(p["fcm"]["seconds"] for _, p in pairs)
    return Row(
        next(iter(asked.values()))["harmonics"], package, samples, len(done), len(asked),
        sum(r["points"] for r in done), seconds, [abs(r["peak"] / p["peak"] - 1.0) for r, p in pairs],
        sum(r["folds"] == p["folds"] for r, p in pairs), seconds / ours if ours else float("nan"),
    )  # fmt: skip


def random_rows(problems: Record, found: dict[str, Record]) -> list[tuple[str, ...]]:
    """How many random scenes each completes, and how many peaks are as those of fcm."""
    asked = {p["name"]: p for p in problems["problems"] if p["group"] == "random"}
    own = [{**p["fcm"], "name": name} for name, p in asked.items()]
    theirs = {PACKAGES[n]: [r for r in one["results"] if r["name"] in asked] for n, one in found.items()}
    return [_random_row(package, some, asked) for package, some in {OURS: own, **theirs}.items()]


def _random_row(package: str, results: list[Record], asked: dict[str, Record]) -> tuple[str, ...]:
    done = [r for r in results if not r["state"]]
    same = sum(_agrees(r["peak"], asked[r["name"]]["peak"]) for r in done)
    reasons = [r["state"].partition(":")[0].partition(" at ")[0] for r in results if r["state"]]
    often = max(set(reasons), key=reasons.count, default="")
    return (
        package, f"{len(done)} of {len(results)}", "-" if package == OURS else f"{same}",
        f"{median(r['seconds'] for r in results):.2g}" if results else "-",
        f"{often} ({reasons.count(often)})" if often else "",
    )  # fmt: skip


def _agrees(one: float | None, other: float | None) -> bool:
    return bool(one and other and abs(one / other - 1.0) < AGREE)


def ahead(problems: Record, found: dict[str, Record]) -> list[str]:
    """Where another package is: in time, or with a scene that fcm does not complete."""
    out = [
        f"{row.package} with {row.harmonics} harmonics and {row.samples} samples takes {row.ratio:.2g} times "
        f"the time of fcm"
        for row in rows(problems, found)
        if row.package != OURS and row.ratio < 1.0
    ]
    left = {p["name"] for p in problems["problems"] if p["fcm"]["state"]}
    for name, record in found.items():
        done = sorted({r["name"] for r in record["results"] if r["name"] in left and not r["state"]})
        out += [f"{PACKAGES[name]} completes {scene}, and fcm does not" for scene in done]
    if not found:
        return []
    return out or ["In none of these measurements is another package ahead, in time, error or completeness."]


def at_equal_error(problems: Record, found: dict[str, Record]) -> list[str]:
    """The ratio of times where the error of another package is least; whether that of fcm is less."""
    every, out = rows(problems, found), []
    for package in PACKAGES.values():
        for harmonics in sorted({row.harmonics for row in every}):
            (own,) = (row for row in every if (row.package, row.harmonics) == (OURS, harmonics))
            theirs = [r for r in every if (r.package, r.harmonics) == (package, harmonics) and r.errors]
            if theirs:
                best = min(theirs, key=lambda row: max(row.errors))
                than = "below" if max(own.errors) <= max(best.errors) else "NOT below"
                out.append(
                    f"{package}, {harmonics} harmonics: {best.ratio:.0f} times the time of fcm at its least "
                    f"error, {max(best.errors):.1e} with {best.samples} samples; fcm's is {than} it"
                )
    return out


def missing(found: dict[str, Record]) -> list[str]:
    """The packages of which there are no results."""
    return [f"{full}: not measured" for name, full in PACKAGES.items() if name not in found]


def section(folder: Path) -> Section:
    """For the page: the picture, the tables, and what is to be said of them."""
    problems, found = read(folder)
    versions = "; ".join([problems["versions"], *(one["versions"] for one in found.values())])
    limits = sorted({one["limit"] for one in found.values()})
    said = f"A curve is stopped after {', '.join(f'{one:g}' for one in limits)} s of processor time."
    table = Table(COLUMNS, [row.cells() for row in rows(problems, found)])
    return Section(
        "Beside other packages",
        text=(*ABOUT, f"Versions: {versions}. {said if limits else ''}", *missing(found)),
        picture="others.png" if found else "",
        width=140.0,
        caption="Error of the peaks against processor time of the eight curves, 64 to 16384 samples from "
        "left to right; the median, and a thin line up to the greatest; at the lower edge what is less.",
        commands=("make bench-others",),
        tables=(table, Table(RANDOM_COLUMNS, random_rows(problems, found))),
        after=(*at_equal_error(problems, found), *ahead(problems, found)),
    )


def draw(folder: Path, output: Path) -> None:
    """The picture of a folder's results."""
    every = rows(*read(folder))
    lines: dict[tuple[str, int], list[Row]] = {}
    for row in every:
        if row.errors and row.finished == row.asked:
            lines.setdefault((row.package, row.harmonics), []).append(row)
    points = [
        Points(package, harmonics, [r.seconds for r in some], [median(r.errors) for r in some],
               [max(r.errors) for r in some])
        for (package, harmonics), some in lines.items()
    ]  # fmt: skip
    with replacing(output) as partial:
        save(draw_others(points), partial, dpi=DPI)


@click.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
@pass_messages
def others(messages: Messages, folder: Path) -> None:
    """Print the tables of FOLDER's results, and draw FOLDER/others.png."""
    shown = section(folder)
    for table in shown.tables:
        click.echo(aligned([table.columns, *table.rows], left=1) + "\n")
    click.echo("\n".join(shown.after))
    draw(folder, folder / "others.png")
    messages.info(f"wrote {folder / 'others.png'}")
