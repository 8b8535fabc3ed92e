"""Converts frequencies to the unit of a scene, and gives units of swept numbers."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen

FloatArray = npt.NDArray[np.float64]


class AngleOptions(Frozen):
    """Options on when an angle without a unit is questioned."""

    # [rad] angle without a unit from which on it is questioned: slightly more than a turn
    largest: float = 2.001 * np.pi


ANGLES = AngleOptions()

UNIT = {"rad/s": 1.0, "Hz": 2.0 * np.pi}  # one unit of frequency in rad/s
CF_UNIT = {"rad/s": "rad s-1", "Hz": "Hz"}  # spelling of the CF conventions for netCDF files
EXCITATION = "excitation.frequency"  # key of the fixed frequency of a curve over the force level
QUANTITIES = {"displacement": 0, "velocity": 1, "acceleration": 2}  # powers of i omega on a displacement
PER_TIME = {"displacement": "", "velocity": "/s", "acceleration": "/s^2"}  # suffixes to the unit of length
EXCITED = "excitation.level"  # key of the force level of a curve, if several levels were measured
NATURAL = "modal.frequency"  # key of the frequencies of all modes; one mode's has its index appended
DIGITS = 15  # decimal numbers with so many digits survive conversion to binary and back


def spoken(omega: float, unit: str) -> str:
    """A frequency [rad/s] in words, in a unit.

    >>> spoken(2.0 * np.pi * 0.5, "Hz"), spoken(2.0, "rad/s")
    ('0.5 Hz', '2 rad/s')
    """
    return f"{float(in_unit(omega, unit)):g} {unit}"


def in_unit(omega: npt.ArrayLike, unit: str) -> FloatArray:
    """Converts frequencies [rad/s] to a unit.

    Conversion back and forth may change the last bit of a frequency given in Hz. So if a number with 15
    digits converts exactly to the frequency in rad/s, this number is returned.

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
    with np.errstate(all="ignore"):  # a value that is too large to be rounded stays as it is
        rounded = np.round(value * power) / power
        same = rounded * scale == exact
    return np.where(same, rounded, value)


def unit_of_number(key: str, length: str, force: str, frequency: str) -> str:
    """The unit of a swept number, by its key path; empty if it has none or it is unknown.

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
    """The heading of a column of swept numbers, with their unit if it is known.

    >>> headed("contact.shroud.n_0", "mm", "N", "Hz"), headed("contact.shroud.mu", "mm", "N", "Hz")
    ('contact.shroud.n_0 [N]', 'contact.shroud.mu')
    """
    unit = unit_of_number(key, length, force, frequency)
    return f"{key} [{unit}]" if unit else key
