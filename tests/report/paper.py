"""The figures of the paper as they come out here: a page with each beside its numbers (``make paper``)."""

from __future__ import annotations

import struct
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import click

from fcm.cli.messages import Messages, pass_messages
from fcm.files import replacing
from fcm.plot.style import LAYOUT

from . import contact_figures, response_figures
from .made import facts
from .page import Page, Section, Table, render
from .rows import Row

COLUMNS = ("quantity", "paper", "obtained")


@dataclass(frozen=True)
class Figure:
    """A figure of the paper; its picture is figureN.png, its commands are in figureN*.command."""

    number: int
    caption: str
    rows: Callable[[Path], list[Row]]


TITLE = "Yang, Chu and Menq (1998), reproduced"
ABOUT = (
    "Figures of “Stick–slip–separation analysis and non-linear stiffness and damping characterization of "
    "friction contacts having variable normal load”, Journal of Sound and Vibration 210(4), as fcm draws "
    "them, with the commands that made them and the numbers that the paper states beside those obtained. "
    "The numbers are computed from the results when this page is made.",
    "States of a contact: E stick, P positive slip, N negative slip, S separation.",
)

FIGURES = (
    Figure(
        5,
        "Friction force over tangential displacement when the normal load varies out of phase. Angles "
        "count from the greatest displacement. Slip outlasts one reversal of the motion and ends before the "
        "other. The paper does not print its parameters; those of this one give its two angles.",
        contact_figures.figure_5,
    ),
    Figure(
        6,
        "The loop of a contact that slips and stays closed, for four phases between normal and tangential "
        "motion. Below each loop its force over one cycle, between the slip limits.",
        contact_figures.figure_6,
    ),
    Figure(
        8,
        "The same contact with a smaller preload: it separates for a part of every cycle.",
        contact_figures.figure_8,
    ),
    Figure(
        10,
        "Stiffness and damping of the friction force when the normal load varies in phase with the motion.",
        contact_figures.figure_10,
    ),
    Figure(
        11,
        "Damping when the normal motion leads the tangential one by 15° and by 30°.",
        contact_figures.figure_11,
    ),
    Figure(
        12,
        "Mean and stiffness of the variable normal load against the preload: as the motion grows, a "
        "preloaded contact softens and a gap hardens, and both come to one half.",
        contact_figures.figure_12,
    ),
    Figure(
        13,
        "Response of the oscillator for ten preloads, from fully stuck to fully separate: lines by harmonic "
        "balance, marks the exact motion, swept up and down.",
        response_figures.figure_13,
    ),
    Figure(
        14,
        "Response at the preload n₀ = 5: harmonic balance, its unstable part dashed, and the exact motion "
        "visited by an upward and a downward sweep of the frequency.",
        response_figures.figure_14,
    ),
    Figure(
        15,
        "The oscillator at n₀ = 5 in time: from the upper branch, through a small step of the frequency down "
        "and back up, to the lower branch.",
        response_figures.figure_15,
    ),
)


@click.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
@pass_messages
def paper(messages: Messages, folder: Path) -> None:
    """Write FOLDER/index.html: the figures in FOLDER beside the numbers of the paper."""
    begin = time.perf_counter()
    found = [(figure, figure.rows(folder)) for figure in FIGURES]
    output = folder / "index.html"
    with replacing(output) as partial:
        partial.write_text(render(page(folder, found)), encoding="utf-8")
    rows = [row for _, some in found for row in some]
    compared = [row for row in rows if row.agrees is not None]
    for row in compared:
        if not row.agrees:
            messages.warning(f"{row.quantity}: {row.obtained}, in the paper {row.stated}")
    agree = sum(bool(row.agrees) for row in compared)
    seconds = time.perf_counter() - begin
    messages.info(
        f"wrote {output}: {agree} of {len(compared)} numbers agree with the paper, in {seconds:.1f} s"
    )


def page(folder: Path, found: Sequence[tuple[Figure, Sequence[Row]]]) -> Page:
    """The page of the figures in a folder, with the rows of each."""
    sections = [_section(folder, figure, rows) for figure, rows in found]
    return Page(TITLE, ABOUT, sections, facts())


def _section(folder: Path, figure: Figure, rows: Sequence[Row]) -> Section:
    picture = f"figure{figure.number}.png"
    return Section(
        f"Figure {figure.number}",
        picture=picture,
        width=width_of(folder / picture),
        caption=figure.caption,
        commands=commands(folder, figure.number),
        tables=(Table(COLUMNS, [row[:3] for row in rows], [row.agrees for row in rows]),),
    )


def commands(folder: Path, number: int) -> tuple[str, ...]:
    """What made a figure and its results, results first, without the folder's name."""
    files = sorted(folder.glob(f"figure{number}[!0-9]*.command"), key=lambda p: (".png" in p.name, p.name))
    return tuple(file.read_text(encoding="utf-8").strip().replace(f"{folder}/", "") for file in files)


def width_of(picture: Path) -> float:
    """Width of a PNG in millimetres, as it is printed."""
    (pixels,) = struct.unpack(">I", picture.read_bytes()[16:20])
    return float(pixels / LAYOUT.dpi * 25.4)
