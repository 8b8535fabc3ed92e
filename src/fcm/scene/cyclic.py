"""The [cyclic] table: of a ring of equal sectors, of which the scene describes one."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from math import isnan
from typing import Any

import numpy as np

from fcm.scene.errors import Mistakes, kind, quoted, shown
from fcm.scene.keys import names
from fcm.scene.model import Modal, Scene
from fcm.scene.names import Names
from fcm.scene.ring import NEXT, ComplexArray, FloatArray, Ring
from fcm.scene.rules import RULES, Rule, as_float
from fcm.scene.section import Section

Draft = dict[str, Any]
WHOLE_RING = "needs the whole ring: write all its sectors out as a scene without [cyclic]"
ROTATED = 1e-8  # relative: of shapes that are real but for a factor, what is left of the imaginary part
TABLES = {  # that have no meaning for one sector, and why
    "schedule": f"a simulation in time {WHOLE_RING}",
    "start": f"a simulation in time {WHOLE_RING}",
    "base": "a base that moves shakes all sectors alike, which no engine order does but 0: give [[force]]",
}


class RingNames(Names):
    """The degrees of freedom of a sector, and behind them those of the next."""

    @cached_property
    def own(self) -> Names:
        """Those of the sector itself."""
        return Names(name for name in self if not name.startswith(NEXT))

    def find(self, name: str) -> str:
        """As `Names.find`, also of "next.40x".

        >>> RingNames(("40x", "tip", "next.40x", "next.tip")).find("next.40:1")
        'next.40x'
        """
        if not name.startswith(NEXT):
            return self.own.find(name)
        found = self.own.find(name.removeprefix(NEXT))
        return f"{NEXT}{found}" if found else ""


def own_name(name: str) -> str:
    """The degree of freedom of the sector itself that one of the next is.

    >>> own_name("next.tip"), own_name("tip")
    ('tip', 'tip')
    """
    return name.removeprefix(NEXT)


def read_cyclic(top: Section) -> list[Draft]:
    """The number of sectors and the engine order as read: a list of one, or of none."""
    if "cyclic" not in top.data:
        return []
    section = top.table("cyclic", "")
    if section is None:
        return [{"sectors": np.nan, "engine_order": np.nan}]
    section.only(*names("cyclic"))
    for table, why in TABLES.items():
        if table in top.data:
            top.wrong(table, f"cannot be beside [cyclic]: {why}")
    return [{key: section.number(key, RULES[key]) for key in ("sectors", "engine_order")}]


def ring_names(top: Section, own: Names | None) -> RingNames | None:
    """The names that contacts may use; None after a mistake."""
    if own is None:
        return None
    for name in own:
        if name.startswith(NEXT):
            top.wrong(own.key, f"{quoted(name)} is the name of a degree of freedom of the next sector")
    made = RingNames((*own, *(f"{NEXT}{name}" for name in own)))
    made.key = own.key
    return made


def only_own(top: Section, drafts: Mapping[str, list[Draft]], dofs: RingNames | None) -> None:
    """Note forces and loads on the next sector, which has its own."""
    if dofs is None:
        return
    for table in ("force", "load"):
        for number, draft in enumerate(drafts[table]):
            if draft["dof"] is not None and draft["dof"][len(dofs.own) : len(dofs)].any():
                what = 'is of the next sector, which has its own; "next." is for contacts'
                top.wrong(f"{table}[{number}].dof", what)


def complex_row(section: Section, value: Any, path: str, rule: Rule) -> ComplexArray | None:
    """Numbers, or pairs [real part, imaginary part], as an array; None after a mistake."""
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


def travelling(section: Section, draft: Draft, sectors: float) -> Draft:
    """The modes of a draft with shapes of travelling waves; with pairs, those of the ring made so.

    Of the whole ring's modes the pair c, s of one frequency makes the shape c + i s, of which sector k has
    Re, Im (c + i s) exp(2 pi i n k / sectors): the sine follows a quarter of a turn behind the cosine. Its
    modal mass for each sector is 2 / sectors times theirs, that of a single mode 1 / sectors times its own.
    """
    pairs = section.data.get("pairs", False)
    if not isinstance(pairs, bool):
        section.wrong("pairs", f"must be true or false, is {kind(pairs)}")
        return draft
    arrays = ("mass", "frequency", "damping", "shapes", "diameter")
    if any(draft[key] is None for key in arrays) or isnan(sectors):
        return draft
    if not pairs:
        _note_pairs(draft)
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
    """Where each pair begins, and whether it is one: those of 0 and half of the sectors are single."""
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


def _note_pairs(draft: Draft) -> None:
    """Say so where modes may be meant as cosines and sines."""
    if draft["shapes"].imag.any():
        return
    same = (np.diff(draft["diameter"]) == 0) & (np.diff(draft["frequency"]) == 0.0)
    double = next(iter(np.flatnonzero(same & (draft["diameter"][1:] > 0)).tolist()), None)
    if double is not None:
        draft["notes"].append(
            f"modal: modes {double + 1} and {double + 2} have one diameter and one frequency: if they are "
            "cosine and sine, say so by pairs = true; they are taken as two travelling modes"
        )


def _check_real(section: Section, draft: Draft, sectors: int) -> None:
    """Turn the shapes of diameter 0 and of half of the sectors real, which they are but for a factor."""
    shapes = draft["shapes"] = draft["shapes"].copy()
    for i, diameter in enumerate(draft["diameter"].tolist()):
        if diameter and 2 * diameter != sectors:
            continue
        largest = shapes[i, np.abs(shapes[i]).argmax()]
        if largest:
            shapes[i] *= abs(largest) / largest
        if np.abs(shapes[i].imag).max() > ROTATED * abs(largest):
            section.wrong(f"shapes[{i}]", f"is of diameter {diameter}, so it is real, but for a factor")
        shapes[i].imag = 0.0


def ring_of(modal: Draft, cyclic: Draft, unit: float) -> tuple[Modal, Ring]:
    """What the mean meets, and the whole ring, of what was read; unit is rad/s in one of the frequency."""
    dofs = tuple(modal["dofs"])
    sectors, order = int(cyclic["sectors"]), int(cyclic["engine_order"])
    diameter = modal["diameter"]
    shapes = modal["shapes"] / np.sqrt(modal["mass"])[:, None]
    place = {name: index for index, name in enumerate(dofs)}
    columns = [place[own_name(name)] for name in dofs]
    ahead = np.array([name.startswith(NEXT) for name in dofs])
    turn = np.exp(2j * np.pi * diameter / sectors)[:, None]
    whole = np.where(ahead, turn, 1.0) * shapes[:, columns]
    added = np.array(modal.get("flexible", np.zeros(diameter.size, dtype=bool)))
    ring = Ring(sectors, order, modal["frequency"] * unit, modal["damping"], whole, diameter, added)
    rest = diameter == 0
    at_rest = Modal(
        dofs, np.ones(int(rest.sum())), ring.frequency[rest], ring.damping[rest],
        np.ascontiguousarray(whole[rest].real), int(added[rest].sum()),
    )  # fmt: skip
    for array in (ring.frequency, ring.damping, ring.shapes, at_rest.shapes):
        array.flags.writeable = False
    return at_rest, ring


def check_diameters(curve: Scene, mistakes: Mistakes, where: str) -> bool:
    """Whether all harmonics of a curve meet modes; note those that do not."""
    if curve.ring is None:
        return True
    before = mistakes.count
    for harmonic, diameter in curve.ring.lacking((0, *(curve.harmonics or (1,)))).items():
        mistakes.add(where or "modal.nodal_diameter", lacks(curve.ring, harmonic, diameter))
    return mistakes.count == before


def note_of_stability(scene: Scene) -> list[str]:
    """Which disturbances decide whether the waves of a scene are stable."""
    rings = {one.ring.engine_order: one.ring for one in scene.each_curve() if one.ring is not None}
    if not rings:
        return []
    periods = sorted({ring.period for ring in rings.values()})
    each = ", ".join(map(str, periods))
    return [
        "cyclic: stability is that of disturbances of the same travelling wave, which repeat as it does, "
        f"after {each} sectors"
        + (": all that there are" if periods == [next(iter(rings.values())).sectors] else "")
    ]


def lacks(ring: Ring, harmonic: int, diameter: int) -> str:
    """A sentence on a harmonic whose nodal diameter has no modes."""
    who = "the mean" if harmonic == 0 else f"harmonic {harmonic} of engine order {ring.engine_order}"
    return f"there are no modes of nodal diameter {diameter}, which {who} meets"


def own_names(dofs: Names | None) -> Names | None:
    """The degrees of freedom that can be in results: a sector's own."""
    return dofs.own if isinstance(dofs, RingNames) else dofs
