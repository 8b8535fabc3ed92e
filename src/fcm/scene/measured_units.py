"""Sizes in SI units of the units of measured quantities, by the labels that test software writes."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from typing import Any, NamedTuple

from fcm.units import QUANTITIES

LENGTHS = {
    "m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "μm": 1e-6, "micron": 1e-6, "nm": 1e-9,
    "in": 0.0254, "inch": 0.0254, "ft": 0.3048, "mil": 2.54e-5,
}  # fmt: skip
ANGLES = {"rad": 1.0, "deg": pi / 180.0, "°": pi / 180.0}
GRAVITY = 9.80665  # [m/s^2]
FORCES = {
    "N": 1.0, "mN": 1e-3, "kN": 1e3, "MN": 1e6, "daN": 10.0, "dyn": 1e-5,
    "lbf": 4.4482216152605, "lb": 4.4482216152605, "kgf": GRAVITY, "kp": GRAVITY, "gf": 1e-3 * GRAVITY,
}  # fmt: skip
_GRAVITIES = ("g", "gn", "g's")
_HERTZ = {
    "hz": 1.0, "khz": 1e3, "rpm": 1.0 / 60.0, "1/min": 1.0 / 60.0, "rev/min": 1.0 / 60.0, "cpm": 1.0 / 60.0,
    "rad/s": 0.5 / pi,
}  # fmt: skip
FREQUENCIES = ("rad/s", "Hz", "kHz", "rpm")  # the usual ones, for messages
_PER_TIME = {"/s^2": 2, "/s": 1, "": 0}  # suffix of a unit of length, and the power of the frequency
_BRACKETS = "()[] "
_SAME = {
    "²": "^2", "**": "^", " ": "", "*": "", "sec": "s", "/s/s": "/s^2", "/s2": "/s^2",
}  # fmt: skip


class MotionUnit(NamedTuple):
    """A unit of a displacement, a velocity or an acceleration."""

    size: float  # in SI units
    quantity: str
    angular: bool


def units_in(data: Mapping[str, Any]) -> tuple[str, str]:
    """The units of length and force in [units] of a scene; empty if not given.

    >>> units_in({"units": {"length": "mm"}})
    ('mm', '')
    """
    units = data.get("units")
    length, force = (
        str(units.get(key, "")) if isinstance(units, Mapping) else "" for key in ("length", "force")
    )
    return length, force


def hertz_of(label: str) -> float | None:
    """The size of a frequency unit in Hz; None if it is unknown.

    >>> hertz_of("Hz"), hertz_of("kHz"), hertz_of("order")
    (1.0, 1000.0, None)
    """
    return _HERTZ.get(_plain(label).lower())


def motion_unit(label: str) -> MotionUnit | None:
    """The unit of motion with a label; None if it is unknown.

    >>> motion_unit("(mm/s²)"), motion_unit("mV")
    (MotionUnit(size=0.001, quantity='acceleration', angular=False), None)
    """
    word = _plain(label).lower()
    if word in _GRAVITIES:
        return MotionUnit(GRAVITY, "acceleration", False)
    end = next(end for end in _PER_TIME if word.endswith(end))
    quantity = next(one for one, power in QUANTITIES.items() if power == _PER_TIME[end])
    for known, angular in ((LENGTHS, False), (ANGLES, True)):
        if (size := known.get(word.removesuffix(end))) is not None:
            return MotionUnit(size, quantity, angular)
    return None


def length_unit(label: str) -> float | None:
    """The size of a unit of length in m; None if it is unknown."""
    return LENGTHS.get(_plain(label).lower())


def force_unit(label: str) -> float | None:
    """The size of a unit of force in N; None if it is unknown.

    >>> force_unit("mN"), force_unit("MN"), force_unit("n"), force_unit("V")
    (0.001, 1000000.0, 1.0, None)
    """
    word = _plain(label)
    return FORCES.get(word, next((FORCES[one] for one in ("N", "lbf") if one.lower() == word.lower()), None))


def ratio_of(label: str) -> tuple[str, str]:
    """Numerator and denominator of a label such as "(m/s^2)/N"; the denominator may be empty.

    >>> ratio_of("(m/s^2)/N"), ratio_of("g/lbf"), ratio_of("m/s")
    (('m/s^2', 'N'), ('g', 'lbf'), ('m/s', ''))
    """
    upper, bar, lower = label.rpartition("/")
    if bar and motion_unit(upper) and force_unit(lower):
        return upper.strip(_BRACKETS), lower
    return label.strip(_BRACKETS), ""


def _plain(label: str) -> str:
    word = label.strip()
    for one, other in _SAME.items():
        word = word.replace(one, other)
    return word.strip(_BRACKETS)
