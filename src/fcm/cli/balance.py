"""``--harmonics``, ``--accuracy`` and related options of a balance, and checks of their combinations."""

from __future__ import annotations

import math

import click

WRONG = "is not a number of harmonics from 1 to 50, nor some of them such as 1,2,3,9 or 1-3,9"


def harmonics(_ctx: click.Context, _param: click.Parameter, text: str | None) -> tuple[int, ...] | None:
    """The harmonics given by an option, in the form of tables of curves (1-3,9) too; None without it."""
    if text is None:
        return None
    from fcm.scene.rules import harmonics_fault, harmonics_up_to

    try:
        numbers = tuple(h for word in text.split(",") for h in _from_to(word))
    except ValueError:
        raise click.BadParameter(f"{text!r} {WRONG}.") from None
    single = "," not in text and "-" not in text
    chosen = harmonics_up_to(numbers[0]) if single else numbers
    if fault := harmonics_fault(chosen):
        raise click.BadParameter(f"{text!r} {WRONG}: {fault}.")
    return chosen


def _from_to(word: str) -> range:
    """The whole numbers of 3, or of 1-3."""
    from fcm.scene.options import LIMITS

    first, dash, last = word.strip().partition("-")
    low, high = int(first), int(last if dash else first)
    if not low <= high <= low + LIMITS.harmonics:
        raise ValueError
    return range(low, high + 1)


def accuracy(_ctx: click.Context, _param: click.Parameter, text: str | None) -> float | None:
    """The accuracy asked for, a relative error such as 0.01 or 1%; None without it."""
    if text is None:
        return None
    number, percent, rest = text.partition("%")
    try:
        value = float(number) / (100.0 if percent else 1.0)
    except ValueError:
        value = math.nan
    if rest or not 0.0 < value < 1.0:
        raise click.BadParameter(f"{text!r} is not a relative error between 0 and 1, such as 0.01 or 1%.")
    return value


def level(_ctx: click.Context, _param: click.Parameter, text: str | None) -> tuple[float, float] | None:
    """The span of levels, FROM:TO; None without it."""
    if text is None:
        return None
    try:
        low, high = (float(part) for part in text.split(":"))
    except ValueError:
        raise click.BadParameter(
            f"{text!r}: give both ends, FROM:TO. Without --mode they are factors of the forces, as 0:2; with "
            "--mode modal amplitudes, as 1e-5:1e-3."
        ) from None
    from fcm.response.level import span_fault

    if fault := span_fault(low, high):
        raise click.BadParameter(f"{text!r}: {fault}.")
    return low, high


def check_level(
    span: tuple[float, float] | None, at: tuple[float, ...] | None, method: str, mode: int | None = None
) -> None:
    """Raise a usage error if a span of force levels lacks its frequency, conflicts, or is out of range.

    With a mode the levels are modal amplitudes, which are not checked here.
    """
    if span is None or mode is not None:
        return
    if at is None:
        raise click.UsageError(
            "--level needs --at F, the frequency at which the level of the forces is raised."
        )
    if method == "exact":
        raise click.UsageError(
            "--level is of no use with --method exact: levels are followed by harmonic balance."
        )
    from fcm.response.level import level_fault

    if fault := level_fault(*span):
        raise click.BadParameter(f"'{span[0]:g}:{span[1]:g}': {fault}.", param_hint="'--level'")


def check_peaks_only(wanted: bool, span: tuple[float, float] | None, csv: object) -> None:
    """Raise a usage error if --peaks-only is combined with --level, which has no peaks, or with --csv."""
    if wanted and span is not None:
        raise click.UsageError("--peaks-only is of no use with --level, whose curves have no peaks.")
    if wanted and csv is not None:
        raise click.UsageError("--csv has a row for each point; with --peaks-only use -o FILE.nc or --json.")


def check_options(
    chosen: tuple[int, ...] | None, error: float | None, method: str, table: str | None
) -> None:
    """Raise a usage error if these options exclude one another, or are of no use with the method."""
    if chosen is not None and error is not None:
        raise click.UsageError("--accuracy chooses the harmonics; give it or --harmonics, not both.")
    if method == "exact" and (chosen is not None or error is not None):
        raise click.UsageError(
            "--harmonics and --accuracy are of no use with --method exact: it has them all."
        )
    if table is not None and chosen is not None and chosen != (1,):
        raise click.UsageError("--table is of no use with more than one harmonic: their forces are exact.")
