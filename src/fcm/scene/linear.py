"""The linear structure of a scene: given modes, or modes of matrices, at the degrees of freedom in use."""

from __future__ import annotations

from collections.abc import Mapping
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

import numpy as np

from fcm import resources
from fcm.model.ring import NEXT
from fcm.model.scene import FloatArray
from fcm.scene.cyclic import own_name, ring_names
from fcm.scene.errors import choices, quoted
from fcm.scene.excitation import BASE, DIRECTIONS, distributions, with_displacements
from fcm.scene.files import Files
from fcm.scene.mistuning import energy_of_matrices
from fcm.scene.modal import KEYS, read_modal
from fcm.scene.names import Names, RowNames
from fcm.scene.options import LIMITS
from fcm.scene.section import Part, Parts, Section, described
from fcm.structure.rigid_body import MOST, rigid_by_gap
from fcm.units import UNIT

if TYPE_CHECKING:
    from fcm.scene.structure_table import StructureMatrices

HIDDEN = "\0"  # prefix of the name of a displacement conjugate to a load over many rows


def read_linear(
    top: Section, files: Files, unit: str, cyclic: list[Part]
) -> tuple[Parts, StructureMatrices | None]:
    """The draft of the modal table, and the matrices from which it is still to be computed, if any.

    For a sector of a ring, dofs include those of the next sector.
    """
    if "structure" not in top.data:
        modal = read_modal(top, files, unit, cyclic)
        return (modal | {"dofs": ring_names(top, modal["dofs"])} if cyclic else modal), None
    if "modal" in top.data:
        top.wrong("", "has both [modal] and [structure]; give one of them")
    from fcm.scene.structure_table import read_structure  # scipy, which other scenes do without

    dofs, matrices = read_structure(top, files)
    if cyclic:
        dofs = ring_names(top, dofs)
    elif isinstance(top.data["structure"], Mapping) and "coupling" in top.data["structure"]:
        top.wrong("structure.coupling", "couples the sectors of a ring: give [cyclic]")
    return dict.fromkeys(KEYS) | {"dofs": dofs}, matrices


def with_modes(
    top: Section,
    parts: Parts,
    matrices: StructureMatrices,
    output: list[str],
    ends: tuple[float, float],
    unit: str,
) -> tuple[Parts, list[str]]:
    """The parts with the modes of matrices at all rows, and notes on them."""
    from fcm.scene.reduction import exchanged, modal_of_matrices
    from fcm.structure.eigen import unit_columns

    if parts["cyclic"]:
        return _of_ring(top, parts, matrices, output, ends, unit)
    dofs = parts["modal"]["dofs"]
    swept = [dofs.place[name] for name in sorted(_swept(top, dofs))]
    only = [dofs.place[name] for name in output]
    if not _room_for(top, len(_directions(parts)) + len(swept), len(dofs)):
        return parts, []
    over_rows = distributions(parts, matrices.M)
    pushed = _columns([*_directions(parts), *over_rows.values()], len(dofs))
    loads = np.concatenate((pushed, unit_columns(len(dofs), swept)), axis=1)
    draft, shapes, notes = modal_of_matrices(
        top, matrices, loads, _springs(parts, loads.shape[1]), only, ends
    )
    if draft is None:
        return parts, notes
    draft["exchanged"] = exchanged(
        matrices, draft["frequency"][: draft["frequency"].size - draft["added"]], ends
    )
    draft |= {"dofs": dofs, "frequency": draft["frequency"] / UNIT[unit], "shapes": shapes.T}
    columns = {name: shapes.T @ load for name, load in over_rows.items()}
    return with_displacements(parts | {"modal": draft}, columns), notes


def _room_for(top: Section, directions: int, rows: int) -> bool:
    """Whether there is memory for the flexibility along a number of directions; notes it if not."""
    taken = float(LIMITS.bytes_of_direction * directions * rows)
    said = f"its flexibility along {directions} directions of contacts and forces, at {rows} rows, takes"
    notices = top.mistakes.notices
    if taken > (free := notices.memory()):
        top.wrong(
            "structure",
            f"{said} {resources.size(taken)} of memory, "
            f"and {resources.size(free)} are free. Reduce it to the rows of the contacts and forces "
            "first, as by Craig and Bampton, or give fewer contacts",
        )
        return False
    if taken > notices.options.memory:
        notices.say(f"structure: {said} about {resources.size(taken)} of memory")
    return True


def check_matrices(
    top: Section, matrices: StructureMatrices, cyclic: list[Part], ends: tuple[float, float]
) -> None:
    """Checks the matrices of a scene that already has other mistakes, to note their mistakes as well."""
    from fcm.scene.reduction import modal_of_matrices
    from fcm.scene.ring_reduction import LoadedRing, modal_of_ring

    rows = len(matrices.dofs)
    none: list[int] = []
    ends = (ends[0], ends[1]) if np.isfinite(ends).all() else (0.0, 0.0)
    if not cyclic:
        modal_of_matrices(top, matrices, np.zeros((rows, 0)), np.zeros(0), none, ends)
    elif np.isfinite(sectors := cyclic[0]["sectors"]):
        unloaded = np.zeros((2 * rows, 0)), np.zeros(0), np.zeros((rows, 0))
        modal_of_ring(top, LoadedRing(matrices, int(sectors), *unloaded), none, ends)


def _of_ring(
    top: Section,
    parts: Parts,
    matrices: StructureMatrices,
    output: list[str],
    ends: tuple[float, float],
    unit: str,
) -> tuple[Parts, list[str]]:
    """The parts of a ring scene with the modes of every nodal diameter, see `with_modes`."""
    from fcm.scene.reduction import exchanged
    from fcm.scene.ring_reduction import LoadedRing, all_alike, modal_of_ring
    from fcm.structure.eigen import unit_columns

    dofs, own = parts["modal"]["dofs"], parts["modal"]["dofs"].own
    swept = [dofs.place[name] for name in sorted(_swept(top, dofs))]
    if not _room_for(top, len(_directions(parts)) + len(swept), len(dofs)):
        return parts, []
    over_rows = distributions(parts, all_alike(matrices).M)
    pushed = np.concatenate((_columns(_directions(parts), len(dofs)), unit_columns(len(dofs), swept)), axis=1)
    distributed = _columns([*over_rows.values()], len(own))
    only = [own.place[name] for name in output]
    sectors = int(parts["cyclic"][0]["sectors"])
    draft, notes = modal_of_ring(
        top, LoadedRing(matrices, sectors, pushed, _springs(parts, pushed.shape[1]), distributed), only, ends
    )
    if draft is None:
        return parts, notes
    if "mistuning" in parts["cyclic"][0]:
        found = parts["cyclic"][0]["mistuning"]
        draft["energy"] = energy_of_matrices(found, matrices.K, draft["shapes"])
    draft["exchanged"] = exchanged(all_alike(matrices), draft["frequency"][~draft["flexible"]], ends)
    of_next = np.zeros_like(draft["shapes"])  # placeholders: they follow from the sector's own
    columns = {name: draft["shapes"] @ load for name, load in over_rows.items()}
    shapes = np.concatenate((draft["shapes"], of_next), axis=1)
    draft |= {"dofs": dofs, "frequency": draft["frequency"] / UNIT[unit], "shapes": shapes}
    return with_displacements(parts | {"modal": draft}, columns), notes


def with_base(parts: Parts) -> Parts:
    """The parts of a scene with given modes, with the displacement conjugate to base acceleration."""
    return with_displacements(parts, {BASE: parts["modal"]["participation"]}) if parts["base"] else parts


def with_exact_rigid_modes(parts: Parts, ends: tuple[float, float], unit: str) -> tuple[Parts, list[str]]:
    """The parts with frequencies of rigid-body modes, which rounding made positive, set to 0; and notes."""
    frequency = parts["modal"]["frequency"]
    bodies = len(parts["contact"]) + 1  # greatest number of bodies that only contacts join
    count = rigid_by_gap(frequency, most=MOST * bodies)
    if not count or np.isnan(ends[0]):
        return parts, []
    lowest = np.sort(frequency[frequency > 0.0])[:count]
    if lowest[-1] * UNIT[unit] > LIMITS.of_no_interest * ends[0]:
        return parts, []
    if count == 1:
        note = f"modal: the mode of {lowest[0]:.3g} {unit} is a rigid-body mode: taken as 0"
    else:
        span = f"{lowest[0]:.3g} to {lowest[-1]:.3g} {unit}"
        note = f"modal: {count} modes of {span} are rigid-body modes: taken as 0"
    zeroed = np.where(frequency <= lowest[-1], 0.0, frequency)
    return parts | {"modal": parts["modal"] | {"frequency": zeroed}}, [note]


OF_ALL_SECTORS = "; a name of the sector is that of all sectors"


def read_output(section: Section, dofs: Names | None) -> list[str]:
    """Requested degrees of freedom, from names or patterns such as "40*", in the order of the dofs."""
    if "output" not in section.data:
        return []
    value = section.data["output"]
    patterns = [value] if isinstance(value, str) else value
    if not isinstance(patterns, list | tuple):
        section.wrong("output", 'must be a list of degrees of freedom, or of patterns such as "40*"')
        return []
    found: set[str] = set()
    for index, pattern in enumerate(patterns):
        found |= _matching(section, f"output[{index}]", pattern, dofs)
    return [name for name in dofs or () if name in found]


def _matching(section: Section, key: str, pattern: object, dofs: Names | None) -> set[str]:
    """The degrees of freedom that one entry requests."""
    if not isinstance(pattern, str):
        what = 'must be a degree of freedom or a pattern such as "40*"'
        section.wrong(key, f"{what}, is {described(pattern)}")
        return set()
    if dofs is None:
        return set()
    matching = {name for name in dofs if fnmatchcase(name, pattern)} | ({dofs.find(pattern)} - {""})
    if not matching:
        of_all = "" if dofs.find(pattern.partition("@")[0]) == "" or "@" not in pattern else OF_ALL_SECTORS
        hint = dofs.of_node(pattern)
        said = (
            f"no degree of freedom matches {quoted(pattern)}{of_all}{hint or f'; there are {choices(dofs)}'}"
        )
        section.wrong(key, said, "" if hint else pattern, dofs)
    return matching


def reported_of(parts: Parts, output: list[str], asked: bool) -> tuple[str, ...]:
    """The degrees of freedom in results: requested ones and those of contacts and forces.

    If none are requested (asked) and there are few, these are all.
    """
    dofs: Names = parts["modal"]["dofs"]
    own = [name for name in dofs if not name.startswith((HIDDEN, NEXT))]
    if not asked and len(own) <= LIMITS.reported:
        return tuple(own)
    used = _columns(_directions(parts), len(dofs)).any(axis=1)
    wanted = {*output, *(own_name(dofs[i]) for i in np.flatnonzero(used))}
    return tuple(name for name in own if name in wanted)


def without_others(top: Section, parts: Parts, reported: tuple[str, ...]) -> Parts:
    """The parts restricted to rows that are reported, named by a sweep, or conjugate to distributed loads."""
    dofs: Names = parts["modal"]["dofs"]
    needed = {*reported, *map(own_name, _swept(top, dofs))}
    kept = [i for i, name in enumerate(dofs) if own_name(name) in needed or name.startswith(HIDDEN)]
    modal = parts["modal"] | {"dofs": RowNames(dofs[i] for i in kept)}
    parts = parts | {"modal": modal | {"shapes": parts["modal"]["shapes"][:, kept]}}
    for kind, keys in DIRECTIONS.items():
        parts[kind] = [
            draft | {key: draft[key][kept] for key in keys if key in draft} for draft in parts[kind]
        ]
    return parts


def _directions(parts: Mapping[str, Any]) -> list[FloatArray]:
    found = (draft.get(key) for kind, keys in DIRECTIONS.items() for draft in parts[kind] for key in keys)
    return [direction for direction in found if direction is not None]


def _springs(parts: Mapping[str, Any], loads: int) -> FloatArray:
    """Contact stiffnesses (load,) along the contact directions, which come first; 0 along other loads."""
    own = [
        draft["k_v" if key == "normal" else "k_u"]
        for draft in parts["contact"]
        for key in DIRECTIONS["contact"]
        if key in draft
    ]
    return np.array([*own, *np.zeros(loads - len(own))])


def _columns(directions: list[FloatArray], rows: int) -> FloatArray:
    return np.array(directions).reshape(len(directions), rows).T


def _swept(top: Section, dofs: Names) -> set[str]:
    """Degrees of freedom in swept keys such as "contact.shroud.normal.40x"."""
    sweep = top.data.get("sweep")
    keys = list(sweep) if isinstance(sweep, Mapping) else []
    return {name for name in dofs if any(str(key).endswith(f".{name}") for key in keys)}
