"""One number of the paper beside the one obtained."""

from __future__ import annotations

from typing import NamedTuple


class Row(NamedTuple):
    """A quantity as the paper states it and as it was obtained, and whether the two agree."""

    quantity: str
    stated: str
    obtained: str
    agrees: bool | None  # None where the paper states nothing


def near(
    quantity: str, stated: float, obtained: float, within: float, form: str = "g", unit: str = ""
) -> Row:
    """A row of two numbers that agree if they differ by no more than the paper's rounding.

    >>> near("angle", 22.9, 22.93, within=0.05, form=".2f", unit="°")
    Row(quantity='angle', stated='22.9°', obtained='22.93°', agrees=True)
    """
    return Row(quantity, f"{stated:g}{unit}", f"{obtained:{form}}{unit}", abs(obtained - stated) <= within)
