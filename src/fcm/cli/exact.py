"""``--method exact`` and ``--at``: the frequencies to visit, and checks of the other options."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from fcm.cli.limits import REQUESTS, SENTENCES
from fcm.cli.messages import Messages

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fcm.model.scene import Scene
    from fcm.response import Response
    from fcm.results.orbits import Orbits
    from fcm.run import Execution

FORMS = "give a frequency, as in 1.2, or a range FROM:TO:COUNT, as in 0.7:1.7:41; of several, --at for each"
_DOES = {"E": "closed all through", "S": "open all through"}  # without slip; otherwise states are named
OF_NO_USE = {  # options of no use with --method exact, and the reasons
    "table": "it needs no coefficients",
    "peaks_only": "its points say which of them are not unique",
}


def frequencies(
    _ctx: click.Context, _param: click.Parameter, texts: tuple[str, ...]
) -> tuple[float, ...] | None:
    """The frequencies of all --at, in the scene's unit; None if there is none."""
    found = tuple(value for text in texts for value in _values(text))
    if len(found) > REQUESTS.frequencies:
        raise click.BadParameter(f"{len(found)} frequencies; there can be {REQUESTS.frequencies}.")
    return found or None


def _values(text: str) -> list[float]:
    import numpy as np

    parts = text.split(":")
    try:
        ends = [float(part) for part in parts[:2]]
        count = int(parts[2]) if len(parts) == 3 else 1
    except ValueError:
        raise click.BadParameter(f"{text!r}: {FORMS}.") from None
    if len(parts) not in (1, 3):
        raise click.BadParameter(f"{text!r}: {FORMS}.")
    if not all(0.0 < end < np.inf for end in ends):
        raise click.BadParameter(f"{text!r}: a frequency must be finite and greater than 0.")
    if len(parts) == 3 and not 2 <= count <= REQUESTS.frequencies:
        raise click.BadParameter(f"{text!r}: the count must be from 2, both ends, to {REQUESTS.frequencies}.")
    if len(parts) == 3 and not ends[0] < ends[1]:
        raise click.BadParameter(
            f"{text!r}: the frequencies must rise; they are visited upward, then downward."
        )
    return ends if len(parts) == 1 else [float(value) for value in np.linspace(ends[0], ends[1], count)]


def check_options(
    method: str, at: tuple[float, ...] | None, only: str | None, periods: int, level: object = None
) -> None:
    """Raise a usage error if an option was given that is of no use with the method."""
    if periods > 1 and (method != "exact" or at is not None or only is not None):
        raise click.UsageError(
            "--periods needs --method exact, and whole curves: no --only; --at finds such motions by itself."
        )
    if only is not None and (method != "exact" or at is not None):
        raise click.UsageError("--only needs --method exact without --at: it is of whole curves.")
    if method != "exact":
        if at is not None and level is None:
            raise click.UsageError(
                "--at needs --method exact, whose motions are visited by sweeps, or --level."
            )
        return
    for name, why in (OF_NO_USE | ({"max_step": "no curve is followed"} if at else {})).items():
        context = click.get_current_context()
        if context.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE:
            (option,) = (param.opts[0] for param in context.command.params if param.name == name)
            given = "--at" if name == "max_step" else "--method exact"
            raise click.UsageError(f"{option} is of no use with {given}: {why}.")


def traced(
    messages: Messages,
    scene: Scene,
    at: tuple[float, ...] | None,
    execution: Execution,
    options: dict[str, Any],
) -> Response:
    """The exact curves of a scene, or its steady motions at frequencies."""
    from fcm.response.exact import trace_exact

    response = trace_exact(scene, at, execution, **options)
    messages.clear()
    for remark in remarks(response):
        messages.info(remark)
    return response


def remarks(response: Response) -> list[str]:
    """Remarks on points whose motion repeats only after several periods, or is one of many."""
    found = [curve.orbits for curve in response.curves if curve.orbits is not None]
    return [
        *_several_periods(found),
        *_doubles(found, response.frequency_unit),
        *_irregular(found),
        *_not_unique(found),
        *_uncertain(found),
        *_unreached(response),
        *_stuck(response),
    ]


def _several_periods(found: Sequence[Orbits]) -> Iterator[str]:
    periods = [int(one) for orbits in found for one in orbits.repeats if one > 1]
    if periods:
        yield (
            f"points that repeat only after several periods of the force (repeats): {len(periods)}, after "
            f"{' or '.join(map(str, sorted(set(periods))))}"
        )


def _doubles(found: Sequence[Orbits], unit: str) -> Iterator[str]:
    """Remark on period doublings whose branches are not followed, and on the option that follows them."""
    import numpy as np

    from fcm.units import in_unit

    doubles = [one for orbits in found for one in orbits.doubles]
    if not doubles:
        return
    periods = max(int(np.nanmax(orbits.repeats)) for orbits in found)
    first = f"{float(in_unit(doubles[0], unit)):.6g} {unit}"
    more = f": --periods {2 * periods} follows what begins there" if periods < REQUESTS.periods else ""
    yield f"places at which the period doubles: {len(doubles)}, the first at {first}{more}"


def _irregular(found: Sequence[Orbits]) -> Iterator[str]:
    count = sum(int((orbits.repeats == 0).sum()) for orbits in found)
    if count:
        yield (
            f"quasi-periodic or irregular points, or of more than 8 periods (repeats is 0): {count}. Their "
            "range is cycle_least to cycle_greatest, of the cycles that were looked at"
        )


def _not_unique(found: Sequence[Orbits]) -> Iterator[str]:
    """Remarks on points where residual friction allows several motions, and on their spread."""
    import numpy as np

    families = [orbits for orbits in found if np.isfinite(orbits.family_greatest).any()]
    if not families:
        return
    count = sum(int(np.isfinite(one.family_greatest).any(axis=1).sum()) for one in families)
    spread = max(map(_spread, families))
    yield (
        f"points that are not unique: {count}. A contact never slips there, and its residual friction "
        f"changes an amplitude by up to {100.0 * spread:.0f} % (family_least to family_greatest). [start] "
        "friction chooses one"
    )
    partly = sum(int((one.family_complete == 0.0).sum()) - _unknown(one) for one in families)
    if partly:
        yield (
            f"at {partly} of them it may change more: not every residual friction was reached "
            "(family_complete is 0)"
        )


def _spread(orbits: Orbits) -> float:
    """The greatest relative change of an amplitude by residual friction."""
    import numpy as np

    moves = orbits.family_greatest > 0.0
    most = orbits.family_greatest[moves]
    return float(np.max((most - orbits.family_least[moves]) / most, initial=0.0))


def _uncertain(found: Sequence[Orbits]) -> Iterator[str]:
    count = sum(map(_unknown, found))
    if count:
        yield (
            f"points that may not be unique: {count}. A contact never slips there, and not every residual "
            "friction of it was reached (family_complete is 0). [start] friction begins with another"
        )


def _unknown(orbits: Orbits) -> int:
    """Number of points without another motion found, where not every residual friction was tried."""
    import numpy as np

    none = np.isnan(orbits.family_greatest).all(axis=1)
    return int(((orbits.family_complete == 0.0) & none).sum())


def _unreached(response: Response) -> list[str]:
    """Remark on the number of lasting motions that neither sweep reached, with the first few."""
    from fcm.units import in_unit

    found = [(curve, one, k) for curve in response.curves if (one := curve.orbits) for k in one.unreached]
    if not found:
        return []
    named = []
    for curve, orbits, k in found[: SENTENCES.named]:
        swept = "".join(f"{key} = {value:g}, " for key, value in curve.parameters.items())
        where = f"{float(in_unit(curve.frequency[k], response.frequency_unit)):.6g} {response.frequency_unit}"
        sizes = zip(response.dofs[: SENTENCES.named], curve.amplitude[k], strict=False)
        again = _again(int(orbits.repeats[k]))
        named.append(f"{swept}{where}{again} with " + ", ".join(f"{dof} {size:.5g}" for dof, size in sizes))
    more = "; ..." if len(found) > SENTENCES.named else ""
    return [
        f"motions that neither sweep comes to (points without a sweep): {len(found)}, at "
        f"{'; at '.join(named)}{more}"
    ]


def _again(periods: int) -> str:
    """Text on how a motion repeats; empty if it does after one period."""
    if periods == 1:
        return ""
    return f" one of {periods} periods" if periods else " one that is quasi-periodic or irregular"


def _stuck(response: Response) -> list[str]:
    """Remark on motions beside the curves in which a contact never slips: the first, and how to reach it."""
    from fcm.units import in_unit

    stuck = [(curve, one) for curve in response.curves if curve.orbits for one in curve.orbits.stuck]
    if not stuck:
        return []
    (curve, first), unit = stuck[0], response.frequency_unit
    pairs = zip(response.contacts, first.states, strict=True)
    does = ", ".join(f"{name} {_DOES.get(one, one)}" for name, one in pairs)
    start = ", ".join(f"{force:.5g}" for force in first.friction)
    swept = "".join(f"{key} = {value:g}, " for key, value in curve.parameters.items())
    return [
        f"beside the curves there are motions in which a contact never slips, {len(stuck)} of them (all: "
        f"stuck_beside of --json). At {swept}{float(in_unit(first.frequency, unit)):.6g} {unit} there is one "
        f"with {does}: --method exact begins at it with friction = [{start}] in [start]"
    ]
