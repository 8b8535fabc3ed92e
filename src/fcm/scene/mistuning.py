"""Reads [cyclic.mistuning], factors of the blades' stiffness, and expands the sector to the whole ring."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

import numpy as np

from fcm.model.ring import NEXT, of_sector
from fcm.model.scene import FloatArray
from fcm.scene.address import Addresses
from fcm.scene.errors import Mistakes, choices, kind, quoted
from fcm.scene.excitation import DIRECTIONS
from fcm.scene.files import Files
from fcm.scene.keys import names
from fcm.scene.names import Names
from fcm.scene.options import LIMITS
from fcm.scene.rules import RULES
from fcm.scene.section import Part, Parts, Section
from fcm.scene.sweep import SweptKey, draws_in

if TYPE_CHECKING:
    from fcm.scene.structure_table import StructureMatrices

KEY = "cyclic.mistuning"
DRAW = f"{KEY}.draw"
OF = {"stiffness": 1, "frequency": 2}  # the stiffness is multiplied by this power of a factor
HIDDEN = "\0"  # prefix of the names of displacements conjugate to loads on the whole ring


class MistuningError(ValueError):
    """Raised for factors that are not positive or leave a ring without stiffness."""


def read_mistuning(section: Section, sectors: float) -> Part | None:
    """Reads [cyclic.mistuning], apart from what needs the structure; None if it is not there.

    "section" is the table, "factors" the factors (draw, sector) or None after a mistake, "power" their
    exponent in the stiffness, "drawn" their `Draws` or None, "numbers" the scale and the index of the draw.
    """
    if "mistuning" not in section.data:
        return None
    table = section.table("mistuning", "")
    if table is None:
        return None
    table.only(*names(KEY))
    of = table.data.get("of", "stiffness")
    if not isinstance(of, str) or of not in OF:
        table.wrong("of", f'must be "stiffness" or "frequency", is {_worded(of)}')
    scale = table.number("scale", RULES["scale"], default=1.0)
    factors, drawn = _factors(table, sectors)
    return {
        "section": table,
        "factors": factors,
        "power": OF.get(of, 1) if isinstance(of, str) else 1,
        "drawn": drawn,
        "numbers": {"scale": scale, "draw": 0.0},
    }


def _worded(value: object) -> str:
    return quoted(value) if isinstance(value, str) else kind(value)


def _factors(table: Section, sectors: float) -> tuple[FloatArray | None, Any]:
    """Factors (draw, sector), None after a mistake; and their `Draws`, None if the factors are given."""
    if table.missing("factors", "a list with one for each sector, or { normal = [1.0, 0.02], count = 100 }"):
        return None, None
    value = table.data["factors"]
    if not isinstance(value, Mapping):
        given = table.vector("factors", RULES["factors"])
        if given is not None and np.isfinite(sectors) and given.size != sectors:
            table.wrong("factors", f"has {given.size} numbers, but there are {int(sectors)} sectors")
        return (None if given is None else given[None]), None
    draws = draws_in(Section(value, table.at("factors"), table.mistakes), KEY)
    if draws is None or not np.isfinite(sectors):
        return None, None
    found = replace(draws, count=draws.count * int(sectors)).values().reshape(draws.count, int(sectors))
    faulty = RULES["factors"].faulty(found)
    if len(faulty):
        first = float(found[tuple(faulty[0])])
        what = f"{len(faulty)} of its {found.size} draws are not allowed; the first"
        table.wrong("factors", f"{what} {RULES['factors'].fault(first)}")
    return found, draws


def drawn_rings(parts: Parts) -> list[SweptKey]:
    """The swept key over random draws of the ring, as a list; empty without draws."""
    if not parts.get("whole") or parts["whole"][0]["drawn"] is None:
        return []
    draws = parts["whole"][0]["drawn"]
    values = tuple(float(i) for i in range(draws.count))
    return [SweptKey(DRAW, (("whole", 0, "draw"),), values, ("drawn", draws.count), draws)]


def read_blade(
    top: Section, files: Files, cyclic: list[Part], dofs: Names | None, matrices: StructureMatrices | None
) -> None:
    """Sets the blade in the draft of a mistuned ring: its "rows" in a sector, or its "stiffness"."""
    found = cyclic[0].get("mistuning") if cyclic else None
    if found is None:
        return
    table: Section = found["section"]
    of_matrices = "structure" in top.data
    found["rows"], found["stiffness"] = None, None
    if "blade" in table.data and "stiffness" in table.data:
        table.wrong("", "has both blade and stiffness; give one of them")
    elif "blade" in table.data and not of_matrices:
        table.wrong("blade", "needs [structure]; with [modal] give the blade's stiffness, or neither")
    elif "blade" in table.data:
        found["rows"] = _rows(table, dofs)
        if matrices is not None and found["rows"] is not None:
            _check_apart(table, matrices, found["rows"])
    elif "stiffness" in table.data:
        found["stiffness"] = _stiffness(table, files, dofs if matrices is None else matrices.dofs)
    elif of_matrices:
        table.wrong("blade", "missing; name the degrees of freedom of the blade, or give its stiffness")


def _rows(table: Section, dofs: Names | None) -> list[int] | None:
    """The places of the blade's degrees of freedom; None after a mistake."""
    value = table.data["blade"]
    patterns = [value] if isinstance(value, str) else value
    if not isinstance(patterns, list | tuple) or not patterns:
        table.wrong("blade", 'must be a list of degrees of freedom, or of patterns such as "40*"')
        return None
    if dofs is None:
        return None
    own = Names(name for name in dofs if not name.startswith(NEXT))
    before, rows = table.mistakes.count, set[int]()
    for index, pattern in enumerate(patterns):
        text = pattern if isinstance(pattern, str) else ""
        matching = {own.place[name] for name in own if fnmatchcase(name, text)}
        matching |= {own.place[own.find(text)]} if own.find(text) else set()
        if not matching:
            table.wrong(f"blade[{index}]", f"no degree of freedom matches {_worded(pattern)}", text, own)
        rows |= matching
    return sorted(rows) if table.mistakes.count == before else None


def _check_apart(table: Section, matrices: StructureMatrices, rows: list[int]) -> None:
    """Notes blade rows coupled to the next sector: their stiffness is not that of the blade alone."""
    if matrices.coupling is None:
        return
    block = abs(matrices.coupling.K).tocsc()
    both = np.asarray(block.sum(axis=0)).ravel() + np.asarray(block.sum(axis=1)).ravel()
    coupled = [matrices.dofs[i] for i in rows if both[i]]
    if coupled:
        what = f"{choices(coupled)} {'is' if len(coupled) == 1 else 'are'} coupled to the next sector"
        table.wrong("blade", f"{what}, so its rows are not of the blade alone: give stiffness instead")


def _stiffness(table: Section, files: Files, dofs: Names | None) -> Any:
    """The blade's stiffness in the degrees of freedom of a sector; None after a mistake."""
    from fcm.scene.entries import check_symmetric, symmetric
    from fcm.scene.row_names import in_order
    from fcm.scene.structure_table import matrix_of

    own = None if dofs is None else type(dofs)(name for name in dofs if not name.startswith(NEXT))
    matrix = in_order(table, "stiffness", matrix_of(table, "stiffness", table.data["stiffness"], files), own)
    if matrix is None or own is None:
        return None
    if matrix.shape[0] != len(own):
        table.wrong("stiffness", f"has {matrix.shape[0]} rows, but a sector has {len(own)}")
        return None
    check_symmetric(table, "stiffness", matrix, own)
    return symmetric(matrix)


def energy_of_matrices(found: Part, K: Any, shapes: Any) -> Any:
    """Blade stiffness K_b between shapes (mode, row), as `fcm.structure.mistuned.energy_of`.

    For a blade given by its rows b in a sector with stiffness K, the energy is (K x)_b^T K_bb^-1 (K x)_b.
    This is the energy with its root held, of the deformation beyond that from the root's displacement.
    None after a mistake.
    """
    from scipy.sparse.linalg import splu

    from fcm.structure.mistuned import energy_of

    if found["rows"] is None:
        return energy_of(shapes, (found["stiffness"] @ shapes.T).T)
    rows = found["rows"]
    pushed = K.tocsr()[rows] @ shapes.T
    try:
        solved = splu(K.tocsr()[rows].tocsc()[:, rows])
        moved = solved.solve(np.ascontiguousarray(pushed.real)) + 1j * solved.solve(
            np.ascontiguousarray(pushed.imag)
        )
    except RuntimeError:
        found["section"].wrong("blade", "moves without stiffness when its root is held: name all of its rows")
        return None
    return energy_of(np.ascontiguousarray(moved.T), np.ascontiguousarray(pushed.T))


def whole_ring(
    top: Section, parts: Parts, reported: Sequence[str], output: Sequence[str]
) -> tuple[Parts, tuple[str, ...], list[str]]:
    """The parts of the whole ring, the reported degrees of freedom and notes.

    parts are those of a sector with the modes of all nodal diameters. The part "whole" holds the numbers from
    which modes and forces of the mistuned ring are built (see `mistuned_modes`), and the sector's parts.
    """
    from fcm.structure.mistuned import basis_of

    cyclic = parts["cyclic"][0]
    found, sectors, modal = cyclic["mistuning"], int(cyclic["sectors"]), parts["modal"]
    tuned = parts | {"cyclic": [{key: cyclic[key] for key in ("sectors", "engine_order")}]}
    diameter, own = modal["diameter"], [n for n in modal["dofs"] if not n.startswith((NEXT, HIDDEN))]
    lacking = sorted(set(range(sectors // 2 + 1)) - set(diameter.tolist()))
    if lacking:
        which = ", ".join(map(str, lacking))
        top.wrong("modal.nodal_diameter", f"mistuning couples all diameters; there are no modes of {which}")
        return parts, (), []
    shapes = modal["shapes"] / np.sqrt(modal["mass"])[:, None]
    of_own = shapes[:, [modal["dofs"].place[name] for name in own]]
    energy, notes = modal.get("energy"), list[str]()
    if energy is None:
        energy, notes = _energy_of_modes(top, found, modal, of_own)
        if energy is None:
            return parts, (), []
    basis = basis_of(diameter, sectors)
    hidden = [name for name in modal["dofs"] if name.startswith(HIDDEN)]
    of_ring = basis.shapes(of_own).reshape(basis.mode.size, -1)
    alike = basis.shapes(shapes[:, [modal["dofs"].place[name] for name in hidden]]).sum(axis=1)
    dofs = Names((*(of_sector(name, k) for k in range(sectors) for name in own), *hidden))
    dofs.key = modal["dofs"].key
    flexible = np.array(modal.get("flexible", np.zeros(diameter.size, dtype=bool)))
    draft = {
        "dofs": dofs,
        "mass": np.ones(basis.mode.size),
        "frequency": modal["frequency"][basis.mode],
        "damping": modal["damping"][basis.mode],
        "shapes": np.concatenate((of_ring, alike), axis=1),
        "participation": None,
        "added": int(flexible[basis.mode].sum()),
    }
    numbers = {
        **found["numbers"],
        "engine_order": cyclic["engine_order"],
        "factors": found["factors"],
        "power": found["power"],
        "drawn": found["drawn"],
        "sectors": sectors,
        "energy": energy,
        "basis": basis,
        "tuned": tuned,
        "reported": tuple(reported),
        "output": tuple(output),
    }
    around = _Around(sectors, tuple(modal["dofs"]), tuple(own), len(hidden))
    made = parts | {"modal": draft, "cyclic": [], "whole": [numbers], **around.drafts(parts)}
    return made, tuple(of_sector(name, k) for k in range(sectors) for name in reported), notes


def _energy_of_modes(top: Section, found: Part, modal: Part, shapes: Any) -> tuple[Any, list[str]]:
    """Blade energy from given modes, like `energy_of_matrices`, and notes; None after a mistake."""
    from fcm.structure.mistuned import OPTIONS, energy_of, strains

    if found["stiffness"] is not None:
        return energy_of(shapes, (found["stiffness"] @ shapes.T).T), []
    counts = np.bincount(modal["diameter"])
    if (counts != counts[0]).any():
        few, many = counts.min(), counts.max()
        what = f"there are {few} modes of one diameter and {many} of another, so they are no families"
        found["section"].wrong("stiffness", f"missing: {what}; give the blade's stiffness")
        return None, []
    strain, likeness = strains(modal["frequency"], shapes, modal["diameter"])
    least = int(likeness.argmin())
    if likeness[least] < OPTIONS.min_likeness:
        other = f"has another shape than the first of its family (likeness {likeness[least]:.2g})"
        what = f"mode {least + 1} {other}"
        found["section"].wrong("stiffness", f"missing: {what}; give the blade's stiffness")
        return None, []
    from fcm.units import UNIT

    strain = strain * UNIT[top.data.get("frequency_unit", "rad/s")]
    note = (
        "cyclic.mistuning: the i-th modes of all diameters are taken as a family in which a sector deforms "
        f"alike, its whole stiffness times the factor. The shapes are alike to {1.0 - likeness[least]:.2g}"
    )
    return energy_of(strain, strain), [note]


class _Around:
    """Expands the contacts, forces and loads of a sector to all sectors."""

    def __init__(self, sectors: int, dofs: tuple[str, ...], own: tuple[str, ...], hidden: int) -> None:
        place = {name: number for number, name in enumerate(own)}
        self.sectors, self.own, self.hidden = sectors, len(own), hidden
        self.column = [place.get(name.removeprefix(NEXT), -1) for name in dofs]
        self.ahead = [name.startswith(NEXT) for name in dofs]

    def direction(self, weights: FloatArray, sector: int) -> FloatArray:
        """Direction over the ring's degrees of freedom, from weights on a sector's and the next one's."""
        found = np.zeros(self.sectors * self.own + self.hidden)
        hidden = self.sectors * self.own
        for weight, column, ahead in zip(weights.tolist(), self.column, self.ahead, strict=True):
            if column < 0:
                found[hidden] += weight
                hidden += 1
            elif weight:
                found[(sector + ahead) % self.sectors * self.own + column] += weight
        return found

    def drafts(self, parts: Parts) -> dict[str, list[Part]]:
        """Contacts of each sector; forces (dof, sector), a column for each; loads equal on all sectors."""
        contacts = [
            draft
            | {"name": of_sector(draft["name"], k), "of": draft["name"]}
            | {"group": draft.get("group", draft["name"])}
            | {key: self.direction(draft[key], k) for key in DIRECTIONS["contact"] if key in draft}
            for k in range(self.sectors)
            for draft in parts["contact"]
        ]
        forces = [draft | {"dof": self._each(draft["dof"])} for draft in parts["force"]]
        loads = [draft | {"dof": self._all(draft["dof"])} for draft in parts["load"]]
        return {"contact": contacts, "force": forces, "load": loads}

    def _each(self, weights: FloatArray) -> FloatArray:
        return np.stack([self.direction(weights, k) for k in range(self.sectors)], axis=1)

    def _all(self, weights: FloatArray) -> FloatArray:
        found: FloatArray = self._each(weights).sum(axis=1)
        hidden = self.sectors * self.own
        found[hidden:] /= self.sectors  # these displacements exist once, for the whole ring
        return found


def factors_of(whole: Part) -> FloatArray:
    """The factors (sector,) on the blades' stiffness; MistuningError if one is not positive."""
    factor: FloatArray = 1.0 + whole["scale"] * (whole["factors"][int(whole["draw"])] - 1.0)
    if not (factor > 0.0).all():
        raise MistuningError(f"with scale = {whole['scale']:g} a factor is {factor.min():.3g}")
    found: FloatArray = factor ** int(whole["power"])
    return found


def mistuned_modes(modal: Part, whole: Part, unit: float) -> Part:
    """The modes of a mistuned ring from those of the tuned ring; unit is rad/s per frequency unit.

    Damping ratios are means of those of the tuned modes, weighted by their share of the kinetic energy.

    Raises MistuningError if the factors leave no stiffness.
    """
    from fcm.structure.eigen import StructureError
    from fcm.structure.mistuned import modes_of_mistuned

    factors = factors_of(whole)
    change = whole["basis"].stiffness(whole["energy"], factors - 1.0)
    try:
        squared, vectors = modes_of_mistuned((modal["frequency"] * unit) ** 2, change)
    except StructureError as error:
        hint = "; of factors write 0.97 for 3 % less" if factors.max() < LIMITS.mistuning else ""
        raise MistuningError(f"{error}{hint}") from None
    return modal | {
        "frequency": np.sqrt(squared) / unit,
        "damping": np.square(vectors).T @ modal["damping"],
        "shapes": np.ascontiguousarray(vectors.T @ modal["shapes"]),
    }


def standing_drafts(draft: Part, whole: Part) -> list[Part]:
    """A travelling wave force on all sectors as two standing ones, with cosine and sine around the ring.

    sin(h w t + p + h k phi) = cos(h k phi) sin(h w t + p) + sin(h k phi) sin(h w t + p + pi / 2)
    """
    sectors = whole["sectors"]
    steps = draft["harmonic"] * int(whole["engine_order"]) * np.arange(sectors) % sectors
    angle = 2.0 * np.pi * steps / sectors
    return [
        draft | {"dof": draft["dof"] @ np.cos(angle)},
        draft | {"dof": draft["dof"] @ np.sin(angle), "phase": draft["phase"] + 0.5 * np.pi},
    ]


def tuned_sweep(parts: Parts, swept: Sequence[SweptKey]) -> tuple[SweptKey, ...]:
    """The swept keys that also exist for the tuned ring, with their addresses there."""
    known, found = Addresses(parts), list[SweptKey]()
    for one in swept:
        addresses = () if one.key.startswith(KEY) else known.find(one.key, "", Mistakes(""))
        if addresses:
            found.append(replace(one, addresses=addresses))
    return tuple(found)
