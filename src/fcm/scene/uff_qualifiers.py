"""Reads qualifiers of measured functions, dataset 1858, such as whether amplitudes are peak values or RMS.

The first line has, after the number of a record, the fraction of an octave of the bands. The second has the
frequency weighting, the window, the scale of amplitudes, the normalisation, and the kinds of the axes. No
field tells to which dataset 58 it belongs. That follows from the order if the two kinds alternate, or does
not matter if all datasets 1858 are equal.
Source: SDRC I-DEAS Test Data Universal File Format, dataset 1858, as published by the University of
Cincinnati and in pyuff.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from pathlib import Path
from typing import NamedTuple

from fcm.scene.errors import quoted
from fcm.scene.files import DataFileError
from fcm.scene.uff_datasets import Dataset

FUNCTIONS, QUALIFIER = ("58", "58b"), "1858"
BANDS, SCALES = 0, 1  # lines of the dataset
UNKNOWN, HALF_PEAK, PEAK, RMS = 0, 1, 2, 3  # scales of amplitudes
EXPONENTIAL = (4, 6)  # windows: exponential, also combined with an impact window
NORMALISED = {1: "units squared", 2: "units squared per Hz", 3: "units squared seconds per Hz"}
WEIGHTINGS = {1: "A", 2: "B", 3: "C", 4: "D"}
SQUARED = (2, 3)  # kinds of an axis: translation squared, rotation squared


class Qualifiers(NamedTuple):
    """Contents of a dataset 1858 for a function; 0 means none or unknown."""

    octave: int = 0
    weighting: int = 0
    window: int = 0
    scale: int = UNKNOWN
    normalised: int = 0
    numerator: int = 0

    @property
    def damps(self) -> bool:
        """Whether a window has added damping to the measurement."""
        return self.window in EXPONENTIAL

    def factor(self) -> float:
        """The factor that converts amplitudes of a harmonic motion to half the peak-to-peak value.

        >>> Qualifiers(scale=PEAK).factor(), round(Qualifiers(scale=RMS).factor(), 3)
        (1.0, 1.414)
        """
        return sqrt(2.0) if self.scale == RMS else 1.0

    def fault(self, spectrum: bool) -> str:
        """What is unsuitable for a response over frequency, and what would be right; or ''.

        The scale matters only for a spectrum: a frequency response function is a ratio.

        >>> Qualifiers(octave=3).fault(False)
        'is of bands of 1/3 octave (dataset 1858): export narrow bands'
        >>> Qualifiers(scale=HALF_PEAK).fault(False), Qualifiers(scale=RMS).fault(True)
        ('', '')
        """
        says = "(dataset 1858): export"
        if self.octave:
            return f"is of bands of 1/{self.octave} octave {says} narrow bands"
        if self.weighting:
            by = WEIGHTINGS.get(self.weighting, f"number {self.weighting}")
            return f"is weighted by frequency, {by} {says} it without weighting"
        if self.numerator in SQUARED or (spectrum and self.normalised):
            what = NORMALISED.get(self.normalised, "units squared")
            return f"is in {what} {says} a spectrum of amplitudes"
        if spectrum and self.scale == HALF_PEAK:
            return "has half-peak amplitudes (dataset 1858), which are not defined: export peak values or RMS"
        if spectrum and self.scale not in (UNKNOWN, PEAK, RMS):
            return f"has amplitudes on a scale {self.scale} {says} peak values (2) or RMS (3)"
        return ""


def qualifiers_of(every: Sequence[Dataset], function: Dataset, path: Path) -> Qualifiers | None:
    """The qualifiers of one of the functions of a file; None if it has no dataset 1858.

    Raises
    ------
    DataFileError
        If a dataset 1858 is damaged, or several differ and their order does not tell which is meant.
    """
    those = [one for one in every if one.kind == QUALIFIER]
    if not those:
        return None
    order = [one for one in every if one.kind == QUALIFIER or one.kind in FUNCTIONS]
    first, second = order[::2], order[1::2]
    kinds = [{one.kind == QUALIFIER for one in half} for half in (first, second)]
    if kinds in ([{True}, {False}], [{False}, {True}]) and len(first) == len(second):
        pairs = zip(first, second, strict=True)
        own = next(pair for pair in pairs if any(one is function for one in pair))
        return _read(next(one for one in own if one is not function), path)
    found = {_read(one, path) for one in those}
    if len(found) > 1:
        raise DataFileError(
            f"{quoted(path.name)} has {len(those)} datasets 1858 that differ, and their order does not tell "
            "which is of this function: export this function alone"
        )
    return found.pop()


def _read(one: Dataset, path: Path) -> Qualifiers:
    bands, scales = (one.integers(line) for line in (BANDS, SCALES))
    if len(bands) < 3 or len(scales) < 8:
        said = f"{quoted(path.name)}, line {one.first}: a dataset 1858 begins with a line of 6 whole numbers"
        raise DataFileError(f"{said}, and a line of 12. Leave it out, or export the file again")
    weighting, window, scale, normalised, _, numerator, *_ = scales
    return Qualifiers(bands[1], weighting, window, scale, normalised, numerator)
