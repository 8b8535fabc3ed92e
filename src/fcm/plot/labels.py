"""Names of quantities for readers: ``contact.shroud.n_0`` becomes the symbol n with the subscript 0."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axis import Axis

_POWER = re.compile(r"10\^\{(-?\d+)\}")  # in the offset text of an axis
_OF_MODE = re.compile(r"modal\.\w+\.(\d+)(?:\.|$)")
_SYMBOLS = {"n_0": "$n_{0}$", "k_u": "$k_{u}$", "k_v": "$k_{v}$", "mu": "$\\mu$"}
_WORDS = {*_SYMBOLS, "gap", "amplitude", "phase", "mass", "frequency", "damping", "level"}


def plain(text: str) -> str:
    """Escape the user's text so that none of it is read as mathematics."""
    return text.replace("$", r"\$")


def short_names(keys: Iterable[str]) -> dict[str, str]:
    """Short name of each key: its last part, or the whole key where two would be the same.

    >>> short_names(["contact.shroud.n_0", "modal.shapes.0.u"])
    {'contact.shroud.n_0': 'n_0', 'modal.shapes.0.u': 'modal.shapes.0.u'}
    >>> list(short_names(["contact.a.mu", "contact.b.mu"]).values())
    ['contact.a.mu', 'contact.b.mu']
    >>> short_names(["excitation.level"])
    {'excitation.level': 'level'}
    """
    last = {key: key.rpartition(".")[2] for key in keys}
    several = list(last.values())
    return {key: name if name in _WORDS and several.count(name) == 1 else key for key, name in last.items()}


def with_mode(key: str) -> str:
    """The path of a number of the scene; for a mode, with its number, which counts from 1 as in every table.

    In a path, entries of lists count from 0.

    >>> with_mode("modal.damping.0"), with_mode("modal.shapes.11.u"), with_mode("contact.shroud.mu")
    ('modal.damping.0 (mode 1)', 'modal.shapes.11.u (mode 12)', 'contact.shroud.mu')
    """
    found = _OF_MODE.match(key)
    return f"{key} (mode {int(found[1]) + 1})" if found else key


def symbols(keys: Iterable[str], units: Mapping[str, str] | None = None) -> list[str]:
    """How each swept quantity is written in a picture, in matplotlib's mathematical text; with units of keys.

    >>> symbols(["contact.shroud.n_0", "contact.shroud.mu", "modal.shapes.0.u"])
    ['$n_{0}$', '$\\\\mu$', 'modal.shapes.0.u']
    >>> symbols(["contact.shroud.n_0", "contact.shroud.mu"], {"contact.shroud.n_0": "N"})
    ['$n_{0}$ (N)', '$\\\\mu$']
    """
    return [
        with_unit(_SYMBOLS.get(name, plain(name)), _unit(key, units))
        for key, name in short_names(keys).items()
    ]


def curve_label(
    parameters: Mapping[str, float], named: bool = True, units: Mapping[str, str] | None = None
) -> str:
    """Label of a curve: its swept values with units of keys; without names only the values.

    >>> curve_label({"contact.shroud.n_0": -5.0, "contact.shroud.mu": 0.4}, units={"contact.shroud.n_0": "N"})
    '$n_{0}$ = −5 N, $\\\\mu$ = 0.4'
    """
    values = [f"{value:.4g}".replace("-", "−") for value in parameters.values()]
    if not named:
        return ", ".join(values)
    each = zip(symbols(parameters), values, parameters, strict=True)
    return ", ".join(f"{name} = {value} {_unit(key, units)}".rstrip() for name, value, key in each)


def _unit(key: str, units: Mapping[str, str] | None) -> str:
    """Unit of a key, as text beside mathematical text."""
    return plain((units or {}).get(key, ""))


def with_unit(text: str, unit: str) -> str:
    """A label with its unit, if there is one.

    >>> with_unit("Amplitude of u", "mm"), with_unit("Amplitude of u", "")
    ('Amplitude of u (mm)', 'Amplitude of u')
    """
    return f"{text} ({unit})" if unit else text


def with_power(text: str, power: int) -> str:
    """A label whose unit is multiplied by a power of ten.

    >>> with_power("Amplitude (mm)", -3), with_power("Amplitude", -3), with_power("Amplitude (mm)", 0)
    ('Amplitude ($10^{-3}$ mm)', 'Amplitude ($10^{-3}$)', 'Amplitude (mm)')
    """
    if not power:
        return text
    factor = f"$10^{{{power}}}$"
    head, opened, unit = text.rpartition(" (")
    return f"{head} ({factor} {unit}" if opened and text.endswith(")") else f"{text} ({factor})"


def power_to_label(*group: Axis) -> None:
    """Move the power of ten of drawn axes into their labels; beside an axis it would overlap that.

    Several axes get one power: the least of theirs, if any has one.
    """
    offsets = (axis.get_major_formatter().get_offset().replace("−", "-") for axis in group)
    powers = [int(found[1]) for found in map(_POWER.search, offsets) if found]
    for axis in group if powers else ():
        axis.get_major_formatter().set_powerlimits((min(powers),) * 2)  # type: ignore[attr-defined]
        axis.get_offset_text().set_visible(False)
        axis.set_label_text(with_power(axis.get_label_text(), min(powers)))


def staying(stable: float) -> str:
    """Text beside a peak: empty if it is stable, else that it is unstable or its stability unknown.

    >>> staying(1.0), staying(0.0), staying(float("nan"))
    ('', ', unstable', ', stability unknown')
    """
    if stable != stable:
        return ", stability unknown"
    return "" if stable else ", unstable"


def frequency_label(unit: str) -> str:
    if unit == "level":
        return "Level of the forces"
    return "Frequency $f$ (Hz)" if unit == "Hz" else f"Frequency $\\omega$ ({unit})"
