"""Reads base motion and static loads."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fcm.model.question import Question
from fcm.model.scene import FloatArray, Force, Load
from fcm.rotational_dofs import is_rotation
from fcm.scene.errors import bare, kind, quoted
from fcm.scene.files import DataFileError, Files
from fcm.scene.keys import names
from fcm.scene.names import Names, motion_of
from fcm.scene.options import TOLERANCES
from fcm.scene.rules import ANY, RULES
from fcm.scene.section import Section

TRANSLATIONS = ("x", "y", "z")
DIRECTIONS = {  # keys of arrays over the degrees of freedom; only planar contacts have second
    "contact": ("tangential", "second", "normal"), "force": ("dof",), "load": ("dof",)
}  # fmt: skip
MASS_UNITS = {("m", "N"): "kg", ("mm", "N"): "t", ("mm", "mN"): "kg", ("mm", "kN"): "10^3 t"}
BASE = "\0base"  # name of the displacement conjugate to base acceleration; no name in a file begins so
LOAD = "\0load"  # prefix of the name of the displacement conjugate to a distributed load


def read_base(top: Section, dofs: Names | None, matrices: bool) -> list[dict[str, Any]]:
    """The motion of the base as read: a list of one, or of none."""
    if "base" not in top.data:
        return []
    section = top.table("base", "")
    if section is None:
        return []
    section.only(*names("base"))
    direction = _direction(section, dofs) if matrices else None
    if not matrices and "direction" in section.data:
        section.wrong("direction", "needs [structure]; modes have modal.participation for it")
    return [
        {
            "name": "base",
            "direction": direction,
            "acceleration": section.number("acceleration", RULES["acceleration"]),
            "phase": section.angle("phase", default=0.0),
        }
    ]


def _direction(section: Section, dofs: Names | None) -> FloatArray | None:
    """The displacement of all degrees of freedom when the base moves by 1."""
    if section.missing("direction", 'x, y, z, or a table of weights such as { "40x" = 1.0 }'):
        return None
    value = section.data["direction"]
    if isinstance(value, str) and value in TRANSLATIONS:
        return _translation(section, value, dofs)
    if isinstance(value, Mapping) and value and set(value) <= set(TRANSLATIONS):
        return _oblique(section, value, dofs)
    if isinstance(value, str) and dofs is not None and not dofs.find(value):
        section.wrong("direction", f"must be x, y, z or a table of weights, is {quoted(value)}")
        return None
    return section.weights("direction", dofs)


def _oblique(section: Section, weights: Mapping[str, Any], dofs: Names | None) -> FloatArray | None:
    """Displacements of a rigid translation along several axes, given as { x = 0.6, y = 0.8 }."""
    before, path = section.mistakes.count, section.at("direction")
    each = {axis: section.checked(weight, f"{path}.{axis}", ANY) for axis, weight in weights.items()}
    if section.mistakes.count == before and not any(each.values()):
        section.wrong("direction", "has only zero weights, so nothing moves")
    along = [(weight, _translation(section, axis, dofs)) for axis, weight in each.items()]
    if section.mistakes.count > before:
        return None
    moved = [weight * one for weight, one in along if one is not None]
    return np.sum(moved, axis=0, dtype=np.float64) if moved else None


def _translation(section: Section, axis: str, dofs: Names | None) -> FloatArray | None:
    """Displacements of a rigid translation by 1 along one axis."""
    if dofs is None:
        return None
    moved = [along_axis(name, axis) for name in dofs]
    if not any(moved):
        what = (
            f"no degree of freedom is named {quoted(axis)}, or as a node and {quoted(axis)}; give a table of "
            f"weights, such as {{ {bare(dofs[0])} = 1.0 }}"
        )
        section.wrong("direction", what)
        return None
    return np.array(moved, dtype=np.float64)


def along_axis(name: str, axis: str) -> bool:
    """Whether a degree of freedom is named by an axis, or by a node and that axis.

    >>> [along_axis(name, "x") for name in ("x", "12x", "tip_x", "n1_ux", "12rx", "tip_rx", "max")]
    [True, True, True, True, False, False, False]
    """
    return re.fullmatch(rf"(.*[\d_:. ])?u?{axis}", motion_of(name) or name, re.IGNORECASE) is not None


def base_force(draft: dict[str, Any], dofs: tuple[str, ...]) -> Force:
    """The inertial force -M d a of a base with the acceleration a along d."""
    direction = _unit(dofs, BASE)
    return Force(direction=direction, amplitude=-draft["acceleration"], phase=draft["phase"])


def read_loads(top: Section, files: Files, dofs: Names | None, matrices: bool) -> list[dict[str, Any]]:
    """Reads the static loads."""
    return [_load(section, files, dofs, matrices) for section in top.tables("load")]


def _load(section: Section, files: Files, dofs: Names | None, matrices: bool) -> dict[str, Any]:
    section.only(*names("load"))
    dof = section.data.get("dof")
    draft: dict[str, Any] = {
        "name": dof if isinstance(dof, str) else "",
        "force": section.number("force", RULES["force"], default=1.0 if "file" in section.data else None),
        "distribution": None,
    }
    if "file" not in section.data:
        weights = section.weights("dof", dofs)
        return draft | {"dof": weights, "net": _net(weights, dofs)}
    if "dof" in section.data:
        section.wrong("", "has both dof and file; give one of them")
    if not matrices:
        section.wrong("file", "needs [structure], whose rows the numbers of the file belong to")
    found = _distribution(section, files, dofs)
    return draft | {"dof": None, "distribution": found, "net": _net(found, dofs)}


def _net(weights: FloatArray | None, dofs: Names | None) -> FloatArray | None:
    """Sums along x, y and z of a load and of its magnitudes, (3, 2); None if names do not tell the axes."""
    if weights is None or dofs is None:
        return None
    loaded = np.flatnonzero(weights)
    along = np.array([[along_axis(dofs[i], axis) for i in loaded] for axis in TRANSLATIONS], dtype=np.bool_)
    turning = np.array([is_rotation(motion_of(dofs[i]) or dofs[i]) for i in loaded], dtype=np.bool_)
    if not (along.any(axis=0) | turning).all():
        return None
    each = along * weights[loaded]
    return np.stack((each.sum(axis=1), np.abs(each).sum(axis=1)), axis=1)


def note_of_mass(
    masses: Mapping[str, float], length: str, force: str, floats: bool = False, mesh: bool = False
) -> list[str]:
    """Note on the mass of a structure along each axis, in the unit derived from those of length and force.

    Different masses along the axes are questioned: for a floating structure they should be the same, and
    for a mesh nearly so, if nodes are held in all directions or not at all.

    >>> note_of_mass({"x": 0.25, "y": 0.25, "z": 0.2}, "mm", "N")
    ['structure: its mass along x, y, z is 0.25, 0.25, 0.2 t, without rows that are held']
    >>> note_of_mass({"z": 2.0}, "", "")
    ['structure: its mass along z is 2, without rows that are held']
    >>> print(note_of_mass({"x": 2.0, "y": 2.0, "z": 1.9}, "", "", floats=True)[1])
    structure: it floats, but its mass differs by 5 % along the axes. Do dofs name the rows in their order?
    >>> print(note_of_mass({"x": 4e-7, "y": 4e-6, "z": 4e-4}, "", "")[1][:66])
    structure: its mass differs by a factor of 1e+03 along the axes, m
    """
    if not masses:
        return []
    unit = MASS_UNITS.get((length, force), f"{force} s^2/{length}" if length and force else "")
    each = [f"{mass:.4g}" for mass in masses.values()]
    values = each[0] if len(set(each)) == 1 else ", ".join(each)
    said = [
        f"structure: its mass along {', '.join(masses)} is {values}{f' {unit}' if unit else ''}, "
        "without rows that are held"
    ]
    least, most = min(masses.values()), max(masses.values())
    if floats and least < (1.0 - TOLERANCES.floating_mass) * most:
        said.append(
            Question(
                f"structure: it floats, but its mass differs by {100 * (1 - least / most):.2g} % along the "
                "axes. Do dofs name the rows in their order?"
            )
        )
    elif mesh and least < (1.0 - TOLERANCES.mesh_mass) * most:
        said.append(
            Question(
                f"structure: its mass differs by {100 * (1 - least / most):.2g} % along the axes, though "
                "each of its nodes has rows along x, y and z. Do dofs name the rows in their order?"
            )
        )
    elif most > TOLERANCES.held_mass * least > 0.0:
        said.append(
            Question(
                f"structure: its mass differs by a factor of {most / least:.2g} along the axes, more than "
                "rows that are held explain. Do dofs name the rows in their order?"
            )
        )
    return said


def notes_of_loads(drafts: Sequence[Mapping[str, Any]], unit: str) -> list[str]:
    """Note on the net static load along each axis, by the names of its degrees of freedom.

    Forces within a structure, as those of a bolt, cancel; supports and contacts hold the rest.
    """
    every = [draft["force"] * draft["net"] for draft in drafts if draft.get("net") is not None]
    if not every or len(every) < len(drafts):
        return []
    net = sum(every)
    size = np.sum(np.abs(every), axis=0)[:, 1]
    unit = f" {unit}" if unit else ""
    left = np.where(np.abs(net[:, 0]) <= TOLERANCES.negligible * size, 0.0, net[:, 0])
    said = [
        f"{total:.4g} of {whole:.4g}{unit} along {axis}"
        for axis, total, whole in zip(TRANSLATIONS, left, size, strict=True)
        if whole
    ]
    if not said:
        return []
    return [
        f"static loads: net force {', '.join(said)}, by the names of degrees of freedom. Forces within the "
        "structure cancel, as those of a bolt on its two sides; supports and contacts must hold the rest"
    ]


def _distribution(section: Section, files: Files, dofs: Names | None) -> FloatArray | None:
    value = section.data["file"]
    if not isinstance(value, str) or not value:
        section.wrong("file", f"must be the name of a file, is {kind(value)}")
        return None
    from fcm.scene.matrix_file import read_vector  # scipy, which other scenes do without

    try:
        found = read_vector(value, files)
    except DataFileError as error:
        for fault in error.faults:
            section.wrong("file", fault)
        return None
    if dofs is not None and found.size != len(dofs):
        section.wrong("file", f"has {found.size} numbers, but the structure has {len(dofs)} rows")
        return None
    if not np.isfinite(found).all():
        section.wrong("file", "has numbers that are not finite")
        return None
    return found


def load_of(draft: dict[str, Any]) -> Load:
    """The `Load` made from a draft that was read."""
    draft["dof"].flags.writeable = False
    return Load(direction=draft["dof"], force=draft["force"])


def distributions(parts: dict[str, Any], mass: Any) -> dict[str, FloatArray]:
    """Load vectors (row,) of distributed loads and of the base, by names of their conjugate displacements."""
    found = {f"{LOAD}{number}": draft["distribution"] for number, draft in enumerate(parts["load"])}
    for draft in parts["base"]:
        found[BASE] = mass @ draft["direction"]
    return {name: one for name, one in found.items() if one is not None}


def with_displacements(parts: dict[str, Any], columns: dict[str, FloatArray]) -> dict[str, Any]:
    """The parts with one more degree of freedom for each load over many rows.

    columns: the mode shapes (mode,) along each, by its name. The load is then a force on that displacement.
    """
    if not columns:
        return parts
    modal = parts["modal"]
    dofs = (*modal["dofs"], *columns)
    shapes = np.concatenate((modal["shapes"], np.array(list(columns.values())).T), axis=1)
    parts = parts | {"modal": modal | {"dofs": type(modal["dofs"])(dofs), "shapes": shapes}}
    more = np.zeros(len(columns))
    for table, keys in DIRECTIONS.items():
        parts[table] = [
            draft | {key: np.append(draft[key], more) for key in keys if draft.get(key) is not None}
            for draft in parts[table]
        ]
    parts["load"] = [
        draft | ({"dof": _unit(dofs, f"{LOAD}{number}")} if draft["dof"] is None else {})
        for number, draft in enumerate(parts["load"])
    ]
    return parts


def _unit(dofs: tuple[str, ...], name: str) -> FloatArray:
    """The direction of one degree of freedom."""
    return np.array([1.0 if one == name else 0.0 for one in dofs])
