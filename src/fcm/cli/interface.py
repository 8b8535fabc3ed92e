"""``fcm plot contacts``: which contacts of a response stick, slip and open, and what they bear."""

from __future__ import annotations

from pathlib import Path

import click

from fcm.cli.columns import aligned
from fcm.cli.drawing import (
    drawing,
    draws_file,
    is_page,
    not_at,
    picture_of,
    save_picture_of,
    solution_option,
)
from fcm.cli.files import wrote
from fcm.cli.limits import SENTENCES
from fcm.cli.messages import Messages, pass_messages
from fcm.cli.options import FiniteRange
from fcm.files import replacing

HEAD = ("contact", "state", "energy", "of all", "slip path", "normal force")
OF_UNIT = {"energy": 0, "slip path": 1, "normal force": 2}  # index of the unit in the file


@click.command()
@draws_file("-contacts.png", page=True)
@click.option(
    "--at", type=FiniteRange(min=0.0), multiple=True, metavar="F",
    help="The frequency, in the file's unit, or the level; several make a film strip. On a folded curve all "
    "solutions there are drawn.  "
    "[default: of the greatest peak of the scene's output]",
)  # fmt: skip
@click.option(
    "--amplitude", type=FiniteRange(min=0.0), multiple=True, metavar="A",
    help="Of a nonlinear mode, instead of --at: the modal amplitude; several make a film strip.",
)  # fmt: skip
@click.option(
    "--curve", "curves", type=click.IntRange(min=0), multiple=True, metavar="K",
    help="Of a sweep, counted from 0; several make a film strip.  [default: all that it has room for]",
)  # fmt: skip
@solution_option
@click.option(
    "--places", type=click.Path(exists=True, dir_okay=False, readable=True, path_type=Path), metavar="PLACES",
    help="A text file with a line NAME X Y for each contact.  [default: places of node sets, or a row]",
)  # fmt: skip
@pass_messages
def contacts(
    messages: Messages,
    file: Path,
    output: Path | None,
    at: tuple[float, ...],
    amplitude: tuple[float, ...],
    curves: tuple[int, ...],
    solution: int | None,
    places: Path | None,
) -> None:
    """Draw what the contacts do of FILE, the netCDF file of `fcm respond -o FILE`.

    At points of the curve: which contacts stick, slip and open. Of each the energy and the slip path of a
    cycle, and the greatest normal force. Those that take most energy are listed.
    """
    from fcm.plot.interface import (
        counted_states,
        draw_interface,
        greatest_takers,
        place_of,
        points_of,
        read_interface,
        read_places,
        stays_at,
    )
    from fcm.plot.style import LAYOUT
    from fcm.scene.errors import counted

    output = picture_of(file, output, "-contacts.png", places, page=True)
    if at and amplitude:
        raise click.UsageError("--at and --amplitude both say where; give one of them.")
    read = read_interface(file)
    every = range(len(read.frequency))
    along: list[tuple[tuple[float, ...], tuple[float, ...]]] = [
        *(((one,), ()) for one in at),
        *(((), (one,)) for one in amplitude),
    ]
    found = [
        (curve, (*here, *modal), points_of(read, here, curve, modal, solution))
        for curve in curves or (every if len(every) <= LAYOUT.panels else (None,))
        for here, modal in along or [((), ())]
    ]
    points = [point for *_, here in found for point in here]
    if len(points) > LAYOUT.panels:
        raise click.UsageError(_too_many(len(points), at, amplitude, curves, len(found)))
    where, axes = read.places, read.axes
    if places is not None:
        where, axes = read_places(places, read.contacts), type(read).axes
    units = {key: read.units[k] for key, k in OF_UNIT.items()}
    head = [f"{key} [{units[key]}]" if units.get(key) else key for key in HEAD]
    if read.places is not None:
        head.append(f"at {', '.join(read.axes)}" + (f" [{read.units[1]}]" if read.units[1] else ""))
    for curve, asked, here in found:
        there = [
            point.frequency if point.modal_amplitude is None or at else point.modal_amplitude
            for point in here
        ]
        for one in asked:
            if said := not_at(one, there, read.unit if at else ""):
                messages.info(said)
        for point in here:
            takers = greatest_takers(read, point, SENTENCES.rows)
            swept = ", ".join(f"{key} = {value:.6g}" for key, value in point.swept.items())
            of = f", curve {curve}{f' ({swept})' if swept else ''}" if len(read.frequency) > 1 else ""
            energy = ", those that take most energy:" if takers else ": none takes energy"
            states = f"{counted(len(read.contacts), 'contact')} ({counted_states(point)})"
            messages.info(f"at {place_of(read, point)}{stays_at(point)}{of}; {states}{energy}")
            if takers:
                messages.info(aligned([head, *takers], left=0))
    if is_page(output):
        from fcm.plot.interactive import contacts_page

        with drawing(), replacing(output) as partial:
            contacts_page(read, points, where, partial, axes)
    else:
        save_picture_of(lambda: draw_interface(read, points, where, axes), output)
    messages.info(wrote(output))


def _too_many(
    count: int, at: tuple[float, ...], amplitude: tuple[float, ...], curves: tuple[int, ...], asked: int
) -> str:
    """Message that a picture has no room for so many points, and how to draw fewer."""
    from fcm.plot.style import LAYOUT

    options = (("--at", at), ("--amplitude", amplitude), ("--curve", curves))
    by = " and ".join(name for name, given in options if len(given) > 1)
    folded = "; --solution 1 takes one where a curve is folded" if count > asked else ""
    of = f" by {by}" if by else ""
    return f"{count} points{of} are too many: a picture has room for {LAYOUT.panels}{folded}."
