"""Reads the modes of a ring's sector from [modal]: complex, or cosines and sines of the whole ring."""

from __future__ import annotations

from math import isnan
from typing import Any

import numpy as np

from fcm.model.ring import ComplexArray, FloatArray
from fcm.scene.errors import kind, shown
from fcm.scene.options import TOLERANCES
from fcm.scene.rules import RULES, Rule, as_float
from fcm.scene.section import Part, Section


def complex_row(section: Section, value: Any, path: str, rule: Rule) -> ComplexArray | None:
    """Reads numbers, or pairs [real part, imaginary part], as a complex array; None after a mistake."""
    if isinstance(value, np.ndarray) and value.dtype.kind == "c":
        value = [[one.real, one.imag] for one in value.tolist()]
    if not isinstance(value, list | tuple | np.ndarray):
        section.mistakes.add(path, f"must be a list of numbers, or of pairs [re, im], is {kind(value)}")
        return None
    before = section.mistakes.count
    parts = [_pair(section, item, f"{path}[{index}]", rule) for index, item in enumerate(value)]
    return np.array(parts, dtype=np.complex128) if section.mistakes.count == before else None


def _pair(section: Section, item: Any, path: str, rule: Rule) -> complex:
    if as_float(item) is not None:
        return complex(section.checked(item, path, rule), 0.0)
    if isinstance(item, list | tuple) and len(item) == 2:
        real, imaginary = (section.checked(part, path, rule) for part in item)
        return complex(real, imaginary)
    section.mistakes.add(path, f"must be a number, or a pair [re, im], is {kind(item)}")
    return complex(np.nan)


def read_diameters(section: Section, modes: int | None, sectors: float) -> Any:
    """The nodal diameter of each mode; None after a mistake."""
    if section.missing("nodal_diameter", "one whole number for each mode"):
        return None
    value = section.data["nodal_diameter"]
    found = section.numbers(value, section.at("nodal_diameter"), RULES["nodal_diameter"])
    if found is None:
        return None
    if modes is not None and len(found) != modes:
        section.wrong("nodal_diameter", f"has {len(found)} numbers, but modal.frequency has {modes}")
        return None
    for index in np.flatnonzero(found > sectors / 2.0).tolist():
        most = f"of {int(sectors)} sectors are 0 to {int(sectors) // 2}"
        section.wrong(f"nodal_diameter[{index}]", f"is {shown(float(found[index]))}, but those {most}")
    return found.astype(np.int64)


def travelling(section: Section, draft: Part, sectors: float) -> Part:
    """The draft with travelling-wave shapes; with `pairs`, these are made from modes of the whole ring.

    Two modes c, s of the whole ring with one frequency make the shape c + i s. In sector k they are the real
    and imaginary parts of (c + i s) exp(2 pi i n k / sectors): the sine lags the cosine by a quarter turn.
    The modal mass per sector is 2 / sectors times theirs; that of a single mode is 1 / sectors times its own.
    """
    pairs = section.data.get("pairs", False)
    if not isinstance(pairs, bool):
        section.wrong("pairs", f"must be true or false, is {kind(pairs)}")
        return draft
    arrays = ("mass", "frequency", "damping", "shapes", "diameter")
    if any(draft[key] is None for key in arrays) or isnan(sectors):
        return draft
    if len({len(draft[key]) for key in arrays}) > 1:  # said where the modes are checked
        return draft
    if not pairs:
        if "pairs" not in section.data:
            _check_no_pairs(section, draft, int(sectors))
        _check_real(section, draft, int(sectors))
        return draft
    firsts = _firsts(section, draft["diameter"], draft["frequency"], int(sectors))
    if firsts is None:
        return draft
    if draft["shapes"].imag.any():
        section.wrong("pairs", "the shapes of pairs are real: the cosine and the sine of each")
        return draft
    at = np.array([first for first, _ in firsts])
    double = np.array([second for _, second in firsts])
    made = {key: draft[key][at] for key in ("frequency", "damping", "diameter")}
    partner = draft["shapes"][np.minimum(at + 1, len(draft["shapes"]) - 1)]
    made["shapes"] = draft["shapes"][at] + np.where(double[:, None], 1j * partner, 0.0)
    made["mass"] = draft["mass"][at] * np.where(double, 2.0, 1.0) / sectors
    return draft | made


def _firsts(
    section: Section, diameter: Any, frequency: FloatArray, sectors: int
) -> list[tuple[int, bool]] | None:
    """Index of each single mode or first mode of a pair, and whether it is a pair; None after a mistake.

    Modes of diameter 0 and sectors / 2 are single.
    """
    found, i = [], 0
    while i < diameter.size:
        single = diameter[i] == 0 or 2 * diameter[i] == sectors
        found.append((i, not single))
        if not single and (i + 1 == diameter.size or diameter[i + 1] != diameter[i]):
            what = f"mode {i + 1} of diameter {diameter[i]} has no sine behind it"
            section.wrong("pairs", f"{what}; modes come as cosine and sine, one behind the other")
            return None
        if not single and abs(frequency[i + 1] - frequency[i]) > 1e-3 * frequency[i]:
            what = f"modes {i + 1} and {i + 2} are no cosine and sine: their frequencies differ"
            section.wrong("pairs", f"{what}, {frequency[i]:.6g} and {frequency[i + 1]:.6g}")
            return None
        i += 1 if single else 2
    return found


def _check_no_pairs(section: Section, draft: Part, sectors: int) -> None:
    """Notes modes that may be meant as cosine and sine, if `pairs` is missing."""
    if draft["shapes"].imag.any():
        return
    diameter, frequency = draft["diameter"], draft["frequency"]
    same = (np.diff(diameter) == 0) & (
        np.abs(np.diff(frequency)) <= TOLERANCES.equal_frequency * frequency[1:]
    )
    double = np.flatnonzero(same & (diameter[1:] > 0) & (2 * diameter[1:] != sectors)).tolist()
    if double:
        which = f"modes {double[0] + 1} and {double[0] + 2} have one diameter and one frequency"
        right = (
            "give true if they are cosine and sine of the whole ring, false if they are two travelling modes"
        )
        section.wrong("pairs", f"missing: {which}; {right}")


def _check_real(section: Section, draft: Part, sectors: int) -> None:
    """Makes the shapes of diameters 0 and sectors / 2 real; they must be so apart from a complex factor."""
    shapes = draft["shapes"] = draft["shapes"].copy()
    for i, diameter in enumerate(draft["diameter"].tolist()):
        if diameter and 2 * diameter != sectors:
            continue
        largest = shapes[i, np.abs(shapes[i]).argmax()]
        if largest:
            shapes[i] *= abs(largest) / largest
        if np.abs(shapes[i].imag).max() > TOLERANCES.rotated * abs(largest):
            section.wrong(f"shapes[{i}]", f"is of diameter {diameter}, so it is real, but for a factor")
        shapes[i].imag = 0.0
