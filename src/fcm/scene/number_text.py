"""Reads numbers from words of text files, and explains what is wrong with other words."""

from __future__ import annotations

import re
from math import isfinite, radians

from fcm.scene.errors import quoted

_DIGITS = r"(?:\d+\.?\d*|\.\d+)"
_EXPONENT = r"[EeDdQq][-+]?\d+"
_LETTERLESS = r"(?:\d+\.\d*|\.\d+)[-+]\d{3}(?![\d.])"  # Fortran omits the E of an exponent of three digits
NUMBER = rf"[-+]?(?:{_LETTERLESS}|{_DIGITS}(?:{_EXPONENT})?)"
_WHOLE = re.compile(NUMBER, re.ASCII)
_HEXADECIMAL = re.compile(r"[-+]?0[xX]")
_PARTS = re.compile(rf"([-+]?{_DIGITS})(?:[EeDdQq]?([-+]?\d+))?", re.ASCII)
_COMMA = re.compile(rf"([-+]?\d+),(\d+)((?:{_EXPONENT})?)", re.ASCII)
_BEHIND = re.compile(rf"({NUMBER})\s*(\S.*)", re.ASCII)


def number_in(text: str) -> float | None:
    """The number that a whole text represents, with or without an exponent; None if it is not finite.

    Exponents of Fortran are accepted: with a D, and with three digits without a letter. nan, inf and numbers
    beyond 1.8e308 give None.

    >>> number_in("1.5"), number_in("-1.005D+02"), number_in("1.50162-101"), number_in("100,5")
    (1.5, -100.5, 1.50162e-101, None)
    """
    if not _WHOLE.fullmatch(text):
        return None
    mantissa, exponent = _PARTS.fullmatch(text).groups("0")  # type: ignore[union-attr]
    value = float(f"{mantissa}e{exponent}")
    return value if isfinite(value) else None


def fault_of_number(text: str) -> str:
    """Fault of a text that is not a number, and what to write if that is obvious.

    >>> fault_of_number("100,5"), fault_of_number("100.5kN")
    ('"100,5" has a decimal comma: write 100.5', '"100.5kN" has "kN" behind the number: write 100.5')
    >>> fault_of_number("30 %")
    '"30 %" has "%" behind the number: write 0.3'
    >>> fault_of_number("30deg")
    '"30deg" has "deg" behind the number: write 0.523598775598'
    >>> fault_of_number("nan"), fault_of_number("1e999")
    ('"nan" is not a number', '"1e999" is too large for a number: 1.8e308 is the largest')
    """
    if _WHOLE.fullmatch(text):
        return f"{quoted(text)} is too large for a number: 1.8e308 is the largest"
    if match := _COMMA.fullmatch(text):
        return f"{quoted(text)} has a decimal comma: write {match[1]}.{match[2]}{match[3]}"
    if _HEXADECIMAL.match(text):
        return f"{quoted(text)} is hexadecimal: write it in decimals"
    if ((match := _BEHIND.fullmatch(text)) and match[2][0].isalpha()) or (match and match[2][0] in "%°[("):
        factor = {"%": 0.01, "deg": radians(1.0), "\u00b0": radians(1.0)}.get(match[2].strip(), 1.0)
        meant = match[1] if factor == 1.0 else f"{(number_in(match[1]) or 0.0) * factor:.12g}"
        return f"{quoted(text)} has {quoted(match[2])} behind the number: write {meant}"
    return f"{quoted(text)} is not a number"
