"""Converts modes of a file to the units of the scene, or questions units that are unknown.

The unit of a modal mass is force / length * s^2: kg with m and N, or with mm and mN; t with mm and N. The
displacements in a shape have no unit, but its rotations have that of 1 / length.
"""

from __future__ import annotations

from math import isclose
from typing import Any, NamedTuple

import numpy as np

from fcm.model.question import Question
from fcm.rotational_dofs import is_rotation
from fcm.scene.errors import quoted
from fcm.scene.measured_units import force_unit, length_unit


class FileUnits(NamedTuple):
    """The units that a file states: their name, and their sizes in m and N if it states these."""

    name: str
    system: tuple[float, float] | None

    def label(self) -> str:
        """The units in a sentence."""
        length, force = self.system or (1.0, 1.0)
        return quoted(self.name) if self.name else f"{length:g} m and {force:g} N"


class Converted(NamedTuple):
    """Factors on modal masses and on rotations of shapes, and notes."""

    mass: float
    rotation: float
    notes: list[str]


def converted(found: dict[str, Any], name: str, own: FileUnits, units: tuple[str, str]) -> Converted:
    """Converts masses and shapes of a file, in place, to the scene's length and force units if all are known.

    >>> modes = {"mass": np.array([2.0]), "dofs": ["1x", "1rz"], "shapes": np.array([[1.0, 0.001]])}
    >>> print(converted(modes, "m.uff", FileUnits("mm and N", (1e-3, 1.0)), ("m", "N")).notes[0])
    modal: m.uff is in "mm and N", converted to m and N: modal masses times 1000, rotations times 1000
    >>> modes["mass"].tolist(), modes["shapes"].tolist()
    ([2000.0], [[1.0, 1.0]])
    """
    length, force = length_unit(units[0]), force_unit(units[1])
    if own.system is None or length is None or force is None:
        return Converted(1.0, 1.0, [_unknown(name, own, (length, force))])
    mass, rotation = own.system[1] / own.system[0] * length / force, length / own.system[0]
    if isclose(mass, 1.0) and isclose(rotation, 1.0):
        return Converted(1.0, 1.0, [])
    turning, said = np.array([is_rotation(str(dof)) for dof in found["dofs"]], dtype=np.bool_), []
    if not isclose(mass, 1.0) and "mass" in found:
        found["mass"] = mass * found["mass"]
        said.append(f"modal masses times {mass:g}")
    if found["shapes"][:, turning].any() and not isclose(rotation, 1.0):
        found["shapes"] = np.where(turning, rotation, 1.0) * found["shapes"]
        said.append(f"rotations times {rotation:g}")
    how = f": {', '.join(said)}" if said else ", in which its numbers are the same" * isclose(mass, 1.0)
    note = f"modal: {name} is in {own.label()}, converted to {units[0]} and {units[1]}{how}"
    return Converted(mass, rotation, [note])


def _unknown(name: str, own: FileUnits, sizes: tuple[float | None, float | None]) -> str:
    """Note on units that are not all known; a question if one is known to differ."""
    pairs = zip(own.system or (), sizes, strict=False)
    if any(size is not None and not isclose(one, size) for one, size in pairs):
        return Question(
            f"modal: {name} is in {own.label()}: is the scene, too? With its [units] of length and force it "
            "is converted"
        )
    return f"modal: the units of the file are {own.label()}; the scene's must be the same"


def question_of_masses(name: str, own: FileUnits, mass: float) -> list[str]:
    """A question on masses given in the scene for shapes of a file in other units."""
    if isclose(mass, 1.0):
        return []
    said = f"modal.mass: {name} is in {own.label()}, in which a mass of 1 is {mass:g} here"
    return [Question(f"{said}. Are the masses in the units of the scene?")]
