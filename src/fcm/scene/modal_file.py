"""Reads modes from a file: NumPy's .npz, MATLAB's .mat, universal files, or the user's own formats."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from fcm.model.question import Question
from fcm.scene.errors import counted, quoted
from fcm.scene.files import DataFileError, Files
from fcm.scene.npz_file import names_in_npz, read_npz
from fcm.scene.options import TOLERANCES
from fcm.scene.reader_process import NAMES, read_apart
from fcm.scene.readers import own_endings, own_reader, read_own
from fcm.scene.uff import read_uff

KEYS = {  # of a file, and names that other programs give the same
    "dofs": ("dof", "dof_names"),
    "mass": ("modal_mass", "modal_masses", "masses", "generalized_mass", "generalised_mass"),
    "frequency": ("frequencies", "freq", "natural_frequency", "natural_frequencies"),
    "angular_frequency": ("omega", "angular_frequencies"),
    "damping": ("zeta", "damping_ratio", "damping_ratios", "modal_damping"),
    "shapes": ("phi", "modes", "mode_shapes", "shape"),
    "participation": (),
    "nodal_diameter": ("nodal_diameters", "harmonic_index"),
}
UNIVERSAL = (".uff", ".unv")
ENDINGS = (".npz", ".mat", *UNIVERSAL)
WANTED = tuple(name for key, others in KEYS.items() for name in (key, *others))


def read_modal_file(name: str, files: Files, waves: bool = False) -> dict[str, Any]:
    """Reads the dofs, mass, frequency, damping and shapes of a file of modes, with "notes" on it.

    "unused" are the names of its other arrays; "units" (`FileUnits`) its units, if it states them. A
    universal file is always in Hz: it gives angular_frequency [rad/s] in place of frequency.

    waves : whether shapes may be complex, as for travelling waves.
    """
    ending = (files.folder / name).suffix.lower()
    if ending not in ENDINGS and own_reader(ending) is None:
        endings = ", ".join((*ENDINGS, *own_endings()))
        raise DataFileError(f"{quoted(name)} cannot be read: a file of modes is {endings}")
    with files.opened(name) as path:
        if ending == ".npz":
            found: dict[str, Any] = dict(read_npz(path, WANTED, files))
            others = names_in_npz(path)
        elif ending == ".mat":
            found = dict(read_apart(path, WANTED, files))
            others = found.pop(NAMES, np.array([])).tolist()
        elif ending in UNIVERSAL:
            found, others = read_uff(path), []
        else:
            found = {name: np.asarray(one) for name, one in read_own(path).items()}
            others = list(found)
            found = {name: one for name, one in found.items() if name in WANTED}
        notes, units = found.pop("notes", []), found.pop("units", None)
        faults: list[str] = []
        found = _by_keys(found, others, name, notes, faults)
        if ending == ".mat":
            found = {key: _without_matrix(key, value) for key, value in found.items()}
        kinds = {"shapes": "iufc" if waves else "iuf"}
        found = {key: _plain(key, value, kinds.get(key, "iuf"), faults) for key, value in found.items()}
        if faults:
            raise DataFileError(*faults, *_lengths(found))
        unused = [one for one in others if one not in WANTED and not one.startswith("__")]
        return found | {"notes": notes, "unused": unused} | ({} if units is None else {"units": units})


def without_masses(name: str, one: float) -> str:
    """Message that a universal file gives no modal masses, and what to write.

    Datasets 55 and 2414 have a field for modal masses; zero in every mode means that they are unknown.

    one : the modal mass of mass-normalised shapes of the file, in the scene's units.
    """
    return (
        f"missing; {quoted(name)} has 0 for the modal mass of each mode. Its shapes may have any scale, and "
        f"amplitudes depend on it. Give mass = {one:g} if they are mass-normalised; else phi^T M phi of each "
        "mode"
    )


def question_of_scale(name: str, shapes: Any) -> list[str]:
    """A question on shapes without modal masses that are all scaled to a largest value of 1.

    >>> question_of_scale("m.npz", np.array([[1.0, 0.5], [0.5, -1.0]]))[0][:60]
    'modal: m.npz gives no modal masses, and each of its shapes i'
    >>> question_of_scale("m.npz", np.array([[0.9, 0.5], [0.5, -1.0]]))
    []
    """
    several = np.ndim(shapes) == 2 and min(np.shape(shapes)) > 1
    if not several or (np.abs(np.abs(shapes).max(axis=1) - 1.0) >= TOLERANCES.scaled_shape).any():
        return []
    text = (
        f"modal: {name} gives no modal masses, and each of its shapes is scaled to a largest value of 1. Are "
        "they mass-normalised? If not, all amplitudes are wrong: give modal.mass, phi^T M phi of each mode"
    )
    return [Question(text)]


def _by_keys(
    found: dict[str, Any], others: Iterable[str], name: str, notes: list[str], faults: list[str]
) -> dict[str, Any]:
    """The arrays by the keys of a scene; notes arrays that have another name in the file."""
    arrays = {}
    for key, aliases in KEYS.items():
        names = [one for one in (key, *aliases) if one in found]
        if len(names) > 1:
            faults.append(f"{quoted(name)} has {' and '.join(map(quoted, names))}; keep one")
        if names:
            arrays[key] = found[names[0]]
        if names and names[0] != key:
            notes.append(f"modal: {quoted(names[0])} of {name} is taken as {key}")
    unknown = [one for one in others if one not in WANTED and _may_be_mass(one)]
    if unknown and "mass" not in arrays:
        may_be = f"{quoted(name)} has {quoted(unknown[0])}, which may be the modal mass"
        faults.append(f"{may_be}: name it mass, or leave it out")
    if "frequency" in arrays and "angular_frequency" in arrays:
        faults.append(f"{quoted(name)} has frequency and angular_frequency; keep one")
    return arrays


def _may_be_mass(name: str) -> bool:
    return "mass" in name.casefold() or name == "m"


def _without_matrix(key: str, array: Any) -> Any:
    """Converts a matrix of MATLAB, which has no other arrays, to a vector or a number."""
    if key in ("shapes", "dofs"):
        return array
    flat = array.ravel()
    return flat[0] if flat.size == 1 and key in ("mass", "damping") else flat


def _lengths(found: dict[str, Any]) -> list[str]:
    """Faults of arrays whose number of modes differs from that of the frequencies."""
    frequency = next((found[key] for key in ("frequency", "angular_frequency") if key in found), None)
    if frequency is None:
        return []
    modes = np.size(frequency)
    per_mode = {key: np.size(found[key]) for key in ("mass", "damping") if np.ndim(found.get(key, 0.0))}
    if np.ndim(found.get("shapes", 0.0)) == 2:
        per_mode["shapes"] = len(found["shapes"])
    said = [f"its {key} is of {counted(count, 'mode')}" for key, count in per_mode.items() if count != modes]
    return [f"{one}, its frequency of {modes}" for one in said]


_HELD = {"c": "complex ones", "b": "true and false", "U": "words", "S": "words", "M": "dates", "m": "times"}


def _plain(key: str, value: Any, kinds: str, faults: list[str]) -> Any:
    """The value as an array of numbers, a float if it is a single number, or for dofs a list of strings."""
    if key == "dofs":
        names = np.ravel(np.asarray(value))
        return [str(name) for name in (np.char.decode(names, "utf-8") if names.dtype.kind == "S" else names)]
    array = np.asarray(value)
    if array.dtype.kind not in kinds:
        held = _HELD.get(array.dtype.kind, "what are no numbers")
        faults.append(f"{key} must hold real numbers, and holds {held}")
        return array
    if array.dtype.kind == "c":
        return array.astype(np.complex128)
    return float(array) if array.ndim == 0 else array.astype(np.float64)
