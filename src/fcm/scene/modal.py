"""Reads the [modal] table of a scene, inline or from a file, and checks that lengths agree."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fcm.model.question import MissingModes
from fcm.model.scene import FloatArray, Modal, Scene
from fcm.scene.errors import choices, counted, kind
from fcm.scene.files import DataFileError, Files
from fcm.scene.keys import names
from fcm.scene.names import Names, checked_names
from fcm.scene.ring_modes import complex_row, read_diameters, travelling
from fcm.scene.rules import RULES, as_float
from fcm.scene.section import Section
from fcm.units import UNIT

KEYS = ("dofs", "mass", "frequency", "damping", "shapes", "participation", "diameter")
NEEDED = ("dofs", "frequency", "damping", "shapes")  # required keys, in the scene or in its file


def read_modal(
    top: Section, files: Files, unit: str, cyclic: Sequence[Mapping[str, float]]
) -> dict[str, Any]:
    """Dofs and arrays of the modal table, frequencies in the scene's unit; None for values with a mistake."""
    section = top.table("modal", "a [modal] table with dofs, frequency, damping and shapes")
    section, notes = _with_file(section, files, unit, top, bool(cyclic)) if section else (None, [])
    if section is None:
        return dict.fromkeys(KEYS)
    section.only(*names("modal"))
    frequency = section.vector("frequency", RULES["frequency"])
    dofs = _dofs(section)
    modes = len(frequency) if frequency is not None else None
    if frequency is not None and not modes:
        section.wrong("frequency", "is empty; there must be at least one mode")
    draft = {
        "dofs": dofs,
        "mass": _per_mode(section, "mass", modes, default=1.0),
        "frequency": frequency,
        "damping": _per_mode(section, "damping", modes),
        "shapes": _shapes(section, dofs, modes, complex_row if cyclic else Section.numbers),
        "participation": _participation(
            section, modes, not cyclic and isinstance(top.data.get("base"), Mapping)
        ),
        "notes": notes,
    }
    if cyclic:
        draft["diameter"] = read_diameters(section, modes, cyclic[0]["sectors"])
        return travelling(section, draft, cyclic[0]["sectors"])
    for key in ("nodal_diameter", "pairs"):
        if key in section.data:
            section.wrong(key, "is of the modes of a ring: give [cyclic] with sectors and engine_order")
    return draft


def lacks_modes_above(scene: Scene, high: float) -> bool:
    """Whether the highest mode is below a frequency [rad/s], and modes above it may be missing.

    Modes that are missing take flexibility from the contacts.
    """
    modal = scene.modal
    known = modal.added or modal.complete or modal.frequency.size == 1 or not scene.contacts
    return bool(not known and modal.frequency.max() < high)


def notes_of_modes_above(scene: Scene) -> list[str]:
    """A note that modes may be missing within the range; none for as many modes as degrees of freedom."""
    if not scene.has_range or scene.ring is not None or len(scene.modal.frequency) == len(scene.modal.dofs):
        return []
    harmonic, unit = max((one.harmonic for one in scene.forces), default=1), scene.frequency_unit
    if not lacks_modes_above(scene, scene.frequency_range[1] * harmonic):
        return []
    where = f"{scene.modal.frequency.max() / UNIT[unit]:.6g} {unit}"
    return [
        MissingModes(
            f"modal: is a mode missing? The highest is at {where}, within the range. Contacts lack the "
            "flexibility of modes above, so that peaks err by more than is said"
        )
    ]


def modal_of(draft: dict[str, Any], unit: str) -> Modal:
    """The `Modal` made from a draft that was read, in rad/s; its arrays are read-only."""
    arrays = {key: draft[key] for key in ("mass", "damping", "shapes")}
    arrays["frequency"] = draft["frequency"] * UNIT[unit]
    for array in arrays.values():
        array.flags.writeable = False
    more = {key: draft[key] for key in ("added", "complete") if key in draft}
    return Modal(dofs=tuple(draft["dofs"]), **more, **arrays)


def _with_file(
    section: Section, files: Files, unit: str, top: Section, waves: bool
) -> tuple[Section | None, list[str]]:
    """The section completed from its file, and notes; a key given inline takes precedence."""
    if "file" not in section.data:
        return section, []
    name = section.text("file")
    if not name:
        if section.data["file"] == "":
            section.wrong("file", "is empty; name a file of modes")
        return None, []
    from fcm.scene.modal_file import UNIVERSAL, question_of_scale, read_modal_file, without_masses

    try:
        found = read_modal_file(name, files, waves)
    except DataFileError as error:
        for fault in error.faults:
            section.wrong("file", fault)
        _check_inline(section)
        return None, []
    notes, unused = found.pop("notes"), found.pop("unused")
    if "angular_frequency" in found:
        found["frequency"] = found.pop("angular_frequency") / UNIT[unit]
    notes += _unused(section, found, unused, name)
    one = 1.0
    if (own := found.pop("units", None)) is not None:
        from fcm.scene.measured_units import units_in
        from fcm.scene.modal_units import converted, question_of_masses

        changed = converted(found, name, own, units_in(top.data))
        one = changed.mass
        notes += changed.notes
        if "mass" in section.data and "shapes" not in section.data:
            notes += question_of_masses(name, own, one)
    if not {"mass", "shapes"} & section.data.keys() and "mass" not in found and "shapes" in found:
        if name.lower().endswith(UNIVERSAL):
            section.wrong("mass", without_masses(name, one))
        else:
            notes += question_of_scale(name, found["shapes"])
    return Section({**found, **section.data}, section.path, section.mistakes), notes


def _unused(section: Section, found: Mapping[str, Any], unused: Sequence[str], name: str) -> list[str]:
    """A note on arrays of the file that are not used; a mistake if a required key is missing."""
    if not unused:
        return []
    said = f"{choices(unused)} of {name} {'is' if len(unused) == 1 else 'are'} not used"
    if lacking := [key for key in NEEDED if key not in found and key not in section.data]:
        section.wrong("file", f"{said}, but there is no {' and no '.join(lacking)}")
    return [f"modal: {said}"]


def _check_inline(section: Section) -> None:
    """Checks the inline keys of a section whose file cannot be read, to note their mistakes."""
    section.only(*names("modal"))
    for key in ("mass", "damping", "participation"):
        if key in section.data:
            _per_mode(section, key, None)
    if "frequency" in section.data:
        section.vector("frequency", RULES["frequency"])
    if "dofs" in section.data:
        _dofs(section)


def _dofs(section: Section) -> Names | None:
    """The names of the degrees of freedom."""
    if section.missing("dofs", "a list of the names of the degrees of freedom"):
        return None
    names = checked_names(section, section.data["dofs"])
    return None if names is None else Names(names)


def _per_mode(
    section: Section, key: str, modes: int | None, default: float | None = None
) -> FloatArray | None:
    """Reads one number for each mode; a single number stands for all."""
    if as_float(section.data.get(key, default)) is not None:
        return np.full(modes or 1, section.number(key, RULES[key], default))
    value = section.data.get(key)
    if key == "damping" and (isinstance(value, Mapping) or _of_lists(value)):
        section.wrong(key, "varies with the frequency, which is not computed: give one ratio for each mode")
        return None
    vector = section.vector(key, RULES[key], "a number for all modes, or a list with one for each")
    if vector is not None and modes is not None:
        _same_count(section, key, vector, modes)
    return vector


def _of_lists(value: object) -> bool:
    """Whether a value is a list of lists or tables, one for each mode."""
    return isinstance(value, list) and bool(value) and all(isinstance(one, list | dict) for one in value)


def _participation(section: Section, modes: int | None, needed: bool) -> FloatArray | None:
    """Phi^T M d of each mode for the direction d in which the base moves, if it is given."""
    if "participation" not in section.data:
        if needed:
            section.mistakes.add("base", "needs [structure], or modal.participation: phi^T M d of each mode")
        return None
    return _per_mode(section, "participation", modes)


def _shapes(section: Section, dofs: tuple[str, ...] | None, modes: int | None, read_row: Any) -> Any:
    """The mode shapes (mode, dof); read_row reads a row from section, value, path and rule."""
    if section.missing("shapes", "one list for each mode, one number in it for each of the dofs"):
        return None
    value = section.data["shapes"]
    if not _is_rows(value):
        section.wrong("shapes", f"must be a list of lists, one for each mode, is {kind(value)}")
        return None
    path = section.at("shapes")
    rows = [read_row(section, row, f"{path}[{index}]", RULES["shapes"]) for index, row in enumerate(value)]
    good = [row for row in rows if row is not None]
    if len(good) < len(rows):
        return None
    return np.array(good) if _right_size(section, good, dofs, modes) else None


def _is_rows(value: Any) -> bool:
    """Whether a value is a list of rows: a list whose first item is a list."""
    lists = (list, tuple, np.ndarray)
    some = isinstance(value, lists) and getattr(value, "shape", None) != () and len(value) > 0
    return some and isinstance(value[0], lists)


def _right_size(
    section: Section, rows: list[FloatArray], dofs: tuple[str, ...] | None, modes: int | None
) -> bool:
    """Whether there is a row for each mode, with a number for each dof."""
    before = section.mistakes.count
    width = len(rows[0]) if dofs is None else len(dofs)
    if len(rows) == width != modes and all(len(row) == modes for row in rows):
        has = f"has {len(rows)} rows of {_numbers(len(rows[0]))}"
        what = f"{has}, but there are {counted(modes or 0, 'mode')} and {counted(width, 'dof')}"
        section.wrong("shapes", f"{what}: transpose it; shapes[i][j] is mode i at dofs[j]")
        return False
    for index, row in enumerate(rows):
        if len(row) != width:
            section.wrong(f"shapes[{index}]", f"has {_numbers(len(row))}, but dofs names {width}")
    if modes is not None and len(rows) != modes:
        section.wrong("shapes", f"has {_rows(len(rows))}, but modal.frequency has {modes}")
    return section.mistakes.count == before


def _same_count(section: Section, key: str, values: FloatArray, modes: int) -> None:
    """Notes a length that is not the number of modes."""
    if len(values) != modes:
        section.wrong(key, f"has {_numbers(len(values))}, but modal.frequency has {modes}")


def _numbers(count: int) -> str:
    return "1 number" if count == 1 else f"{count} numbers"


def _rows(count: int) -> str:
    return "1 row" if count == 1 else f"{count} rows"
