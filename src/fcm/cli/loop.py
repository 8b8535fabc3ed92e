"""``fcm plot loop``: hysteresis loops of given parameters, or of the contacts of a response."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from fcm.cli.drawing import ENDINGS, angle, angles, save_picture, save_picture_of, solution_option
from fcm.cli.files import check_not_read, check_output, output_option, wrote
from fcm.cli.limits import REQUESTS
from fcm.cli.messages import Messages, pass_messages

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from fcm.cli.loop_cases import Case, NormalCase, PlanarCase
    from fcm.cli.loop_names import Harmonic

OF_FILE = ("curves", "at", "amplitudes", "contact", "solution", "dimensionless")
OF_RATIOS = ("n0_bars", "b_bars")
OF_CONTACT = ("mu", "k_u", "k_v", "n_0", "a", "b")


def _number(low: float | None, strict: bool = False) -> Callable[..., Any]:
    """Callback that checks for finite numbers, none below a limit (or, if strict, at it)."""

    def check(_ctx: click.Context, _param: click.Parameter, values: tuple[float, ...]) -> tuple[float, ...]:
        for value in values:
            if not math.isfinite(value):
                raise click.BadParameter(f"{value} is not a finite number.")
            if low is not None and (value < low or (strict and value == low)):
                raise click.BadParameter(f"{value:g} is not {'above' if strict else 'at least'} {low:g}.")
        return tuple(dict.fromkeys(values))

    return check


def _ratio(low: float) -> Callable[..., Any]:
    def check(_ctx: click.Context, _param: click.Parameter, values: tuple[float, ...]) -> tuple[float, ...]:
        for value in values:
            if not low <= value <= REQUESTS.farthest:
                raise click.BadParameter(f"{value:g} is not between {low:g} and {REQUESTS.farthest:g}.")
        return tuple(dict.fromkeys(values))

    return check


def _harmonics(
    _ctx: click.Context, _param: click.Parameter, values: tuple[tuple[str, int, float, str], ...]
) -> tuple[Harmonic, ...]:
    """Callback that checks that each harmonic of u and v, from the second on, is given once."""
    from fcm.cli.loop_names import Harmonic

    found: dict[tuple[str, int], Harmonic] = {}
    for motion, order, amplitude, phase in values:
        if not (math.isfinite(amplitude) and amplitude >= 0.0):
            raise click.BadParameter(f"{amplitude:g} is no amplitude: give a number of at least 0.")
        if (motion, order) in found:
            raise click.BadParameter(f"harmonic {order} of {motion} is given twice.")
        found[motion, order] = Harmonic(motion, order, amplitude, angle(phase))
    return tuple(found.values())


def _several(name: str, field: str, check: Callable[..., Any], text: str, **more: Any) -> Callable[..., Any]:
    return click.option(
        name, field, type=float, multiple=True, metavar="X", callback=check, help=text, **more
    )


def _parameters(command: Any) -> Any:
    """The options that give a contact without a file."""
    positive, amplitude = _number(0.0, strict=True), _number(0.0)
    options = (
        _several(
            "--n0-bar", "n0_bars", _ratio(-REQUESTS.farthest), "Preload mu n_0 / (k_u a).  [default: 0.8]"
        ),
        _several("--b-bar", "b_bars", _ratio(0.0), "Load variation mu k_v b / (k_u a).  [default: 1]"),
        click.option(
            "--phi", "phases", multiple=True, default=("45deg",), callback=angles,
            show_default=True, metavar="ANGLE",
            help="Phase of the normal motion before the tangential, in radians or as 15deg.",
        ),
        _several("--mu", "mu", positive, "Instead of the ratios: the friction coefficient,"),
        _several("--k-u", "k_u", positive, "the tangential stiffness,"),
        _several("--k-v", "k_v", amplitude, "the normal stiffness,"),
        _several("--n0", "n_0", _number(None), "the preload, negative for a gap,"),
        _several("--a", "a", positive, "the amplitude of the tangential motion,"),
        _several("--b", "b", amplitude, "and that of the normal motion."),
        click.option(
            "--harmonic", "harmonics", multiple=True, callback=_harmonics, metavar="u|v H AMPLITUDE PHASE",
            type=(click.Choice(["u", "v"]), click.IntRange(2, REQUESTS.highest_harmonic), float, str),
            help="Beside --a and --b a harmonic of the tangential or normal motion, as u 3 0.1 20deg: 0.1 "
            "sin(3 theta + 20deg).",
        ),
    )  # fmt: skip
    for option in reversed(options):
        command = option(command)
    return command


@click.command()
@click.argument(
    "file", required=False, type=click.Path(exists=True, dir_okay=False, readable=True, path_type=Path)
)
@output_option(
    "-o", "--output", endings=ENDINGS,
    help="The picture to write: .png, .svg or .pdf.  [default: loop.png, or FILE with the ending -loop.png]",
)  # fmt: skip
@_parameters
@click.option(
    "--curve", "curves", type=click.IntRange(min=0), multiple=True, metavar="N",
    help="Of FILE: the number of the curve, from 0.  [default: the only one]",
)  # fmt: skip
@click.option(
    "--at", type=float, multiple=True, metavar="FREQUENCY", callback=_number(0.0),
    help="Of FILE: the frequency, or the level; the nearest points are drawn, on a folded curve all.  "
    "[default: the peak of the scene's output]",
)  # fmt: skip
@click.option(
    "--amplitude", "amplitudes", type=float, multiple=True, metavar="A", callback=_number(0.0),
    help="Of FILE with a nonlinear mode, instead of --at: the modal amplitude.",
)  # fmt: skip
@click.option(
    "--contact", metavar="NAME", help="Of FILE: the contact.  [default: that which takes most energy]"
)
@solution_option
@click.option("--dimensionless", is_flag=True, help="Divide displacements by a and forces by k_u a.")
@click.option(
    "--units", nargs=2, metavar="LENGTH FORCE", help="Units to write at the axes, as in --units mm N."
)
@click.option("--cosine", is_flag=True, help="Count angles from the greatest displacement, u = a cos(theta).")
@click.option("--json", "to_json", is_flag=True, help="Print sequences, transitions and coefficients.")
@click.pass_context
@pass_messages
def loop(
    messages: Messages,
    ctx: click.Context,
    /,
    file: Path | None,
    output: Path | None,
    units: tuple[str, str] | None,
    cosine: bool,
    to_json: bool,
    **options: Any,
) -> None:
    """Draw hysteresis loops, as figures 5, 6 and 8: friction force over tangential displacement.

    The contact is given by ratios, or by its stiffness, friction, preload and motion. Any of them may be
    repeated, and every combination is drawn. Or it is a contact of FILE, at a point of a curve. FILE is what
    `fcm respond -o FILE` wrote; the displacement counts from its mean. Of a contact without friction the
    normal force is drawn, over the normal displacement.

    Below each loop are its force and the slip limits over a cycle. Transitions are marked with their angles.
    """
    from fcm.cli.loop_cases import NormalCase, PlanarCase
    from fcm.contact import Loop

    begin = time.perf_counter()
    options["phases"] = tuple(dict.fromkeys(options["phases"]))
    given = {name for name in ctx.params if ctx.get_parameter_source(name) is ParameterSource.COMMANDLINE}
    _check(given, file is not None)
    cases = _cases(given, file, options, units, messages.info)
    without_friction = isinstance(cases[0], NormalCase)
    if without_friction:
        _check_without_friction(given)
    if len(cases) > 1 and isinstance(cases[0], PlanarCase | NormalCase):
        what = "normal forces" if without_friction else "loops in a plane"
        raise click.UsageError(f"{len(cases)} {what} are too many for a picture: {_one_of(options)}.")
    if cosine and isinstance(cases[0], PlanarCase):
        raise click.UsageError("--cosine is of no use in a plane: each direction has a phase of its own.")
    if len(cases) > REQUESTS.loops:
        raise click.UsageError(f"{len(cases)} loops are too many for a picture: at most {REQUESTS.loops}.")
    if output is None:
        output = Path("loop.png") if file is None else file.with_name(f"{file.stem}-loop.png")
        check_output(output, ENDINGS)
    check_not_read({"-o": output}, [file])
    scaled = not options["dimensionless"] and (file is not None or bool(options["mu"]))
    if file is None:
        save_picture(_drawn(cases, scaled, units, cosine), output)
    else:
        save_picture_of(lambda: _drawn(cases, scaled, units, cosine), output)
    if to_json:
        records = [case.record(cosine) for case in cases]
        click.echo(json.dumps({"loops": records}, indent=2, allow_nan=False))
    for case in cases:
        messages.info(_sentence(case, cosine))
    seconds = time.perf_counter() - begin
    located = any(not isinstance(case.loop, Loop) for case in cases)
    how = (
        "the normal force"
        if without_friction
        else "from events located exactly"
        if located
        else "from the closed form"
    )
    messages.info(f"{wrote(output)}: {how}, in {seconds:.2f} s")


def _cases(
    given: set[str],
    file: Path | None,
    options: dict[str, Any],
    units: tuple[str, str] | None,
    tell: Callable[[str], None],
) -> Sequence[Case | PlanarCase | NormalCase]:
    """The loops from a file, a contact's parameters or dimensionless ratios, as given."""
    from fcm.cli.loop_cases import of_contact, of_file, of_ratios

    if file is not None:
        from fcm.plot.loop_file import PlaceOnCurve

        places = [
            *map(PlaceOnCurve, options["at"]),
            *(PlaceOnCurve(one, modal=True) for one in options["amplitudes"]),
        ]
        curves = options["curves"] or [None]
        return of_file(file, curves, options["contact"], places or [None], options["solution"], tell)
    if given.intersection(OF_CONTACT):
        return of_contact(
            {name: options[name] for name in OF_CONTACT}, options["phases"], options["harmonics"], units
        )
    return of_ratios(options["n0_bars"] or (0.8,), options["b_bars"] or (1.0,), options["phases"])


def _check(given: set[str], of_file: bool) -> None:
    """Raise a usage error that lists all mistakes in the combination of options."""
    dimensionless = "dimensionless" in given or not (of_file or given.intersection(OF_CONTACT))
    wrong = [_useless(given, ("units",), ": the axes have no dimension")] if dimensionless else []
    if of_file:
        others = (*OF_RATIOS, *OF_CONTACT, "phases", "harmonics")
        wrong.append(_useless(given, others, " with a FILE: its points have their own"))
        wrong.append("--at and --amplitude both say where" if given >= {"at", "amplitudes"} else "")
    elif given.intersection(OF_CONTACT):
        wrong.append(_useless(given, OF_FILE[:-1], " without a FILE"))
        wrong.append(_useless(given, OF_RATIOS, " beside --mu, --k-u, --k-v, --n0, --a and --b"))
        missing = [_option(name) for name in OF_CONTACT if name not in given]
        wrong.append(f"the contact is not complete: {', '.join(missing)} missing" if missing else "")
    else:
        wrong.append(_useless(given, OF_FILE, " without a FILE"))
        wrong.append(_useless(given, ("harmonics",), " without --mu, --k-u, --k-v, --n0, --a and --b"))
    if any(wrong):
        raise click.UsageError(f"{'; '.join(filter(None, wrong))}.")


def _check_without_friction(given: set[str]) -> None:
    """Raise a usage error if options are of no use for the normal force of a contact without friction."""
    if wrong := _useless(given, ("cosine", "dimensionless"), ": the contact has no friction, and so no loop"):
        raise click.UsageError(f"{wrong}.")


def _one_of(options: dict[str, Any]) -> str:
    """Text on how to choose one loop among several of a file."""
    several = [_option(name) for name in ("curves", "at", "amplitudes") if len(options[name]) > 1]
    if several:
        return f"give {' and '.join(several)} once"
    return "the curve is folded there; take one solution, as by --solution 1"


def _useless(given: set[str], names: tuple[str, ...], why: str) -> str:
    """Message on given options that have no effect; empty if there are none."""
    wrong = [_option(name) for name in names if name in given]
    return f"{', '.join(wrong)} {'are' if len(wrong) > 1 else 'is'} of no use{why}" if wrong else ""


def _option(name: str) -> str:
    other = {"n_0": "--n0", "phases": "--phi", "dimensionless": "--dimensionless", "units": "--units"}
    return other.get(name, "--" + name.removesuffix("s").replace("_", "-"))


def _drawn(
    cases: Sequence[Case | PlanarCase | NormalCase], scaled: bool, units: tuple[str, str] | None, cosine: bool
) -> Figure:
    from fcm.cli.loop_cases import Case, NormalCase, PlanarCase

    first = cases[0]
    if isinstance(first, NormalCase):
        return _drawn_normal_force(first, units)
    if isinstance(first, PlanarCase):
        return _drawn_in_plane(first, scaled, units)
    return _drawn_on_lines([case for case in cases if isinstance(case, Case)], scaled, units, cosine)


def _drawn_in_plane(case: PlanarCase, scaled: bool, units: tuple[str, str] | None) -> Figure:
    from fcm.plot.planar_loop import DrawnPlanarLoop, draw_planar_loop

    title = ", ".join(filter(None, [*(name.drawn for name in case.names), case.note, case.loop.sequence]))
    drawn = DrawnPlanarLoop(case.loop, title, case.directions, units or case.units)
    if not scaled:
        drawn = replace(drawn, loop=case.dimensionless(), units=None, dimensionless=True)
    return draw_planar_loop(drawn)


def _drawn_normal_force(case: NormalCase, units: tuple[str, str] | None) -> Figure:
    from fcm.cli.loop_names import titles
    from fcm.plot.normal_force import DrawnNormalForce, draw_normal_force

    common, _ = titles([case])
    title = "\n".join(filter(None, [common, ", ".join(filter(None, [case.note, "without friction"]))]))
    return draw_normal_force(DrawnNormalForce(case.loop, title, units or case.units))


def _drawn_on_lines(cases: list[Case], scaled: bool, units: tuple[str, str] | None, cosine: bool) -> Figure:
    from fcm.cli.loop_names import titles
    from fcm.plot.loop import DrawnLoop, LoopAxes, draw_loops

    common, panels = titles(cases)
    units = units or cases[0].units
    drawn = [
        DrawnLoop(case.loop, title, case.amplitude, case.force) if scaled else DrawnLoop(case.loop, title)
        for case, title in zip(cases, panels, strict=True)
    ]
    axes = LoopAxes.with_units(units, cosine) if scaled else LoopAxes(from_greatest=cosine)
    return draw_loops(drawn, axes, common)


def _sentence(case: Case | PlanarCase | NormalCase, cosine: bool) -> str:
    """Message on the states of a loop and the angle at which each begins."""
    from fcm.cli.loop_cases import NormalCase, PlanarCase
    from fcm.contact.sampled import shown_degrees, transitions

    names = ", ".join(filter(None, [*(name.plain for name in case.names if name.in_message), case.note]))
    if isinstance(case, NormalCase):
        begins = zip(case.states(), case.loop.angles.tolist(), strict=False)
        where = ", ".join(f"{state} from {math.degrees(theta):.1f}°" for state, theta in begins)
        greatest = max(case.loop.greatest_load, 0.0)
        return f"{names}: no friction; normal force up to {greatest:.4g}, {where or case.states()[0]}"
    if isinstance(case, PlanarCase):
        begun = zip(case.loop.sequence, case.loop.angles.tolist(), strict=False)
        where = ", ".join(f"{state} at {math.degrees(theta):.1f}°" for state, theta in begun)
    else:
        found = transitions(case.loop)
        where = ", ".join(f"{one.states[1]} at {shown_degrees(one.theta, cosine):.1f}°" for one in found)
    return f"{names}: {case.loop.sequence}{', ' if where else ''}{where}"
