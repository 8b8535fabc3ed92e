"""Frequencies in the unit of a scene; units of the numbers that are swept."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen

FloatArray = npt.NDArray[np.float64]


class AngleOptions(Frozen):
    """Options on when an angle without a unit leads to a question."""

    # [rad] largest angle without a unit that is not doubted: a whole turn and a little more
    largest: float = 2.001 * np.pi


ANGLES = AngleOptions()

UNIT = {"rad/s": 1.0, "Hz": 2.0 * np.pi}  # one unit of frequency in rad/s
CF_UNIT = {"rad/s": "rad s-1", "Hz": "Hz"}  # as the conventions for netCDF files write them
EXCITATION = "excitation.frequency"  # key of where a curve over the level of the forces is
QUANTITIES = {"displacement": 0, "velocity": 1, "acceleration": 2}  # powers of i omega, over a displacement
PER_TIME = {"displacement": "", "velocity": "/s", "acceleration": "/s^2"}  # behind the unit of a displacement
EXCITED = "excitation.level"  # key of the level of the forces of a curve, where several were measured
NATURAL = "modal.frequency"  # key of the frequencies of all modes; with its number of one
DIGITS = 15  # that every number of so many has again after it was a binary one


def spoken(omega: float, unit: str) -> str:
    """A frequency [rad/s] in a unit, as a message names it.

    >>> spoken(2.0 * np.pi * 0.5, "Hz"), spoken(2.0, "rad/s")
    ('0.5 Hz', '2 rad/s')
    """
    return f"{float(in_unit(omega, unit)):g} {unit}"


def in_unit(omega: npt.ArrayLike, unit: str) -> FloatArray:
    """Frequencies [rad/s] in a unit.

    Two roundings may change the last bit of a frequency that was given in Hz; so where a number of 15 digits
    is this frequency in rad/s, it is that number.

    >>> float(in_unit(2.0 * np.pi * 52.0, "Hz")), float(np.float64(2.0 * np.pi * 52.0) / (2.0 * np.pi))
    (52.0, 52.00000000000001)
    """
    exact = np.asarray(omega, dtype=np.float64)
    scale = UNIT[unit]
    if scale == 1.0:
        return exact
    value: FloatArray = exact / scale
    size = np.abs(np.where(np.isfinite(value) & (value != 0.0), value, 1.0))
    power = 10.0 ** np.clip(DIGITS - 1 - np.floor(np.log10(size)), -300, 300)
    with np.errstate(all="ignore"):  # where it is too large to be rounded it stays as it is
        rounded = np.round(value * power) / power
        same = rounded * scale == exact
    return np.where(same, rounded, value)


def unit_of_number(key: str, length: str, force: str, frequency: str) -> str:
    """The unit of a number that is swept by its key path, empty where none is given or known.

    >>> given = "mm", "N", "Hz"
    >>> unit_of_number("contact.*.n_0", *given), unit_of_number("contact.shroud.k_u", *given)
    ('N', 'N/mm')
    >>> unit_of_number("contact.shroud.mu", *given), unit_of_number("contact.shroud.k_u", "mm", "", "Hz")
    ('', '')
    >>> unit_of_number("excitation.frequency", *given), unit_of_number("modal.frequency.0", *given)
    ('Hz', 'Hz')
    """
    if key in (EXCITATION, NATURAL) or key.startswith(f"{NATURAL}."):
        return frequency
    if not key.startswith("contact."):
        return ""
    stiffness = f"{force}/{length}" if force and length else ""
    units = {"n_0": force, "gap": length, "k_u": stiffness, "k_v": stiffness}
    return units.get(key.rpartition(".")[2], "")


def headed(key: str, length: str, force: str, frequency: str) -> str:
    """The head of a column of swept numbers, with their unit where it is known.

    >>> headed("contact.shroud.n_0", "mm", "N", "Hz"), headed("contact.shroud.mu", "mm", "N", "Hz")
    ('contact.shroud.n_0 [N]', 'contact.shroud.mu')
    """
    unit = unit_of_number(key, length, force, frequency)
    return f"{key} [{unit}]" if unit else key
