"""Questions about valid but implausible numbers, such as a ratio in percent or an angle in degrees."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from math import pi
from typing import Any

import numpy as np

from fcm.model.question import Question
from fcm.scene.errors import bare, choices, shown
from fcm.scene.options import LIMITS
from fcm.scene.rules import as_float
from fcm.scene.section import Parts, Section
from fcm.scene.sweep import SweptKey
from fcm.units import ANGLES

CRITICAL = "critical damping"
SWEEP = "sweep."  # prefix of the path of a swept key


def questions(top: Section, parts: Parts, swept: Sequence[SweptKey]) -> list[str]:
    """A question for each kind of implausible number; the scene is still read as it is.

    These are: damping ratios and loss factors of at least 1; damping ratios that are all large, and large
    loss factors if units are given; no damping at all; mistuning factors that are all small; coefficients of
    friction above two; negative gaps; angles in rad of more than a turn; a sweep of one frequency for all
    modes.
    """
    real = isinstance(top.data.get("units"), Mapping)
    found = [_of_ratio(*one, real) for one in _ratios(top, parts, swept)]
    found += [_of_nothing(*one) for one in _ratios(top, parts, swept)]
    found += _once(_of_friction, _of_contacts("mu", top, swept), max)
    found += _once(_of_gap, _of_contacts("gap", top, swept), min)
    found += _once(_of_angle, _angles(top, swept), _furthest)
    found += [_of_factors(values) for values in _factors(parts)]
    found += [_of_one_frequency(one, parts) for one in swept]
    return [Question(one) for one in found if one]


def _once(
    question: Callable[[str, Iterable[float]], str],
    numbers: Iterable[tuple[str, Iterable[float]]],
    extreme: Callable[[Iterable[float]], float],
) -> list[str]:
    """One question on the most extreme number of a kind, naming the other keys; and one per swept key."""
    asked = [(key, list(values)) for key, values in numbers]
    asked = [(key, values) for key, values in asked if question(key, values)]
    own = [question(key, values) for key, values in asked if key.startswith(SWEEP)]
    given = {key: extreme(values) for key, values in asked if not key.startswith(SWEEP)}
    if not given:
        return own
    worst = extreme(given.values())
    first = next(key for key, value in given.items() if value == worst)
    others = [key for key in given if key != first]
    also = f". The same of {choices(others)}" if others else ""
    return [f"{question(first, [worst])}{also}", *own]


def _furthest(values: Iterable[float]) -> float:
    return max(values, key=abs)


def _ratios(
    top: Section, parts: Parts, swept: Sequence[SweptKey]
) -> Iterator[tuple[str, Iterable[float], str]]:
    """Yields key and values of damping, and the reference that the values are ratios of."""
    structure = top.data.get("structure")
    if isinstance(structure, Mapping):
        damping = structure.get("damping")
        if isinstance(damping, Mapping):
            yield "structure.damping.loss_factor", _numbers(damping.get("loss_factor")), "the stiffness"
        else:
            yield "structure.damping", _numbers(damping), CRITICAL
    elif (damping := parts["modal"].get("damping")) is not None:
        given = top.data["modal"].get("damping") if isinstance(top.data.get("modal"), Mapping) else None
        yield "modal.damping", _numbers(damping.tolist() if given is None else given), CRITICAL
    for one in swept:
        if one.key.startswith("modal.damping"):
            yield _of_sweep(one), one.values, CRITICAL


def _angles(top: Section, swept: Sequence[SweptKey]) -> Iterator[tuple[str, Iterable[float]]]:
    for table, key in (("force", "phase"), ("base", "phase"), ("start", "angle")):
        value = top.data.get(table)
        if isinstance(value, Mapping):
            yield f"{table}.{key}", _numbers(value.get(key))
        elif isinstance(value, list | tuple):
            for index, one in enumerate(value):
                yield f"{table}[{index}].{key}", _numbers(one.get(key) if isinstance(one, Mapping) else None)
    for one in swept:
        if one.key.endswith(".phase"):
            yield _of_sweep(one), one.values


def _of_contacts(key: str, top: Section, swept: Sequence[SweptKey]) -> Iterator[tuple[str, Iterable[float]]]:
    """Yields path and values of a key of each contact, and of sweeps of that key."""
    contacts = top.data.get("contact")
    for index, one in enumerate(contacts if isinstance(contacts, list | tuple) else ()):
        yield f"contact[{index}].{key}", _numbers(one.get(key) if isinstance(one, Mapping) else None)
    for varied in swept:
        if varied.key.endswith(f".{key}"):
            yield _of_sweep(varied), varied.values


def _of_sweep(one: SweptKey) -> str:
    return f"{SWEEP}{bare(one.key)}"


def _factors(parts: Parts) -> Iterator[list[float]]:
    """Yields the factors of the blades of a mistuned ring."""
    for ring in parts.get("whole", ()):
        yield ring["factors"].ravel().tolist()


def _numbers(value: Any) -> list[float]:
    """The finite numbers in a value or a list."""
    several = value if isinstance(value, list | tuple | np.ndarray) else [value]
    return [number for one in several if (number := as_float(one)) is not None and np.isfinite(number)]


def _of_ratio(key: str, values: Iterable[float], whole: str, real: bool) -> str:
    each = list(values)
    value = max(each, default=0.0)
    large = LIMITS.damping_with_units if real else LIMITS.damping_of_all
    ratios = each if whole == CRITICAL else [0.5 * one for one in each]
    all_large = (whole == CRITICAL or real) and min(ratios, default=0.0) >= large
    if value < LIMITS.damping_ratio and not all_large:
        return ""
    height = f"{0.5 / max(ratios):.2g} times the static displacement"
    high = f", so that a resonance is {height}" if value < LIMITS.damping_ratio else ""
    meant = f"if {shown(value)} % is meant, write {value / 100.0:.12g}"
    return f"{key}: is {shown(value)} right? It is {100.0 * value:.12g} % of {whole}{high}; {meant}"


def _of_nothing(key: str, values: Iterable[float], _whole: str) -> str:
    each = list(values)
    if not each or any(each):
        return ""
    return f"{key}: is 0 right? Where no contact slips nothing damps, and a resonance has no peak"


def _of_factors(values: Sequence[float]) -> str:
    greatest = max(values, default=1.0)
    if not 0.0 < greatest < LIMITS.mistuning:
        return ""
    return (
        f"cyclic.mistuning.factors: is {shown(greatest)}, the greatest, right? Properties are multiplied by "
        "them: write 0.97 for 3 % less"
    )


def _of_one_frequency(one: SweptKey, parts: Parts) -> str:
    frequency = parts["modal"].get("frequency")
    count = 0 if frequency is None else len(frequency)
    if count < 2 or ("modal", "frequency") not in one.addresses:
        return ""
    return (
        f"{_of_sweep(one)}: is one frequency for all {count} modes right? Each is then the same: sweep "
        'that of one mode, as "modal.frequency.0"'
    )


def _of_friction(key: str, values: Iterable[float]) -> str:
    value = max(values, default=0.0)
    if value <= LIMITS.friction:
        return ""
    meant = f"if {shown(value)} % is meant, write {value / 100.0:.12g}"
    return f"{key}: is {shown(value)} right? Friction is {shown(value)} times the normal force; {meant}"


def _of_gap(key: str, values: Iterable[float]) -> str:
    value = min(values, default=0.0)
    if value >= 0.0:
        return ""
    return f"{key}: is {shown(value)} right? Below zero the faces overlap, and press at rest with -k_v * gap"


def _of_angle(key: str, values: Iterable[float]) -> str:
    value = max(values, default=0.0, key=abs)
    if abs(value) < ANGLES.largest:
        return ""
    swept = key.startswith(SWEEP)
    meant = "write it in rad" if swept else f'write "{shown(value)}deg"'
    turns = f"{shown(value)} rad are {abs(value) / (2.0 * pi):.3g} turns"
    return f"{key}: is {shown(value)} right? {turns}; if degrees are meant, {meant}"
