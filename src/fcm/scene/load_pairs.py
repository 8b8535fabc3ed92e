"""Reads only the node pairs of a scene's contacts, without computing the modes of its structure."""

from __future__ import annotations

from pathlib import Path

from fcm.frozen import Frozen
from fcm.model.interface import Interface
from fcm.scene.cyclic import read_cyclic
from fcm.scene.errors import Mistakes
from fcm.scene.files import Files
from fcm.scene.linear import read_linear
from fcm.scene.load import path_of
from fcm.scene.options import FILES
from fcm.scene.parts import read_contacts, read_units
from fcm.scene.section import Section
from fcm.scene.toml import read_toml
from fcm.units import UNIT


class Pairs(Frozen):
    """Node pairs of each contact, with notes on them and the scene's unit of length."""

    interfaces: tuple[Interface, ...]
    notes: tuple[str, ...]
    length: str
    files: tuple[Path, ...]


def load_pairs(path_or_name: str | Path, *, largest_file: int = FILES.largest) -> Pairs:
    """The pairs of a scene; SceneError names every mistake of its structure and contacts.

    >>> load_pairs("yang1998").interfaces
    ()
    """
    path, name = path_of(path_or_name), str(path_or_name)
    mistakes, inputs = Mistakes(name), Files(path.parent, largest_file)
    top = Section(read_toml(path, name), "", mistakes)
    given = top.data.get("frequency_unit")
    unit = given if isinstance(given, str) and given in UNIT else "rad/s"
    modal, _ = read_linear(top, inputs, unit, read_cyclic(top))
    read_contacts(top, modal["dofs"], inputs)
    length, _ = read_units(top)
    mistakes.raise_if_any()
    files = (path, *dict.fromkeys(inputs.read))
    return Pairs(tuple(inputs.interfaces), tuple(inputs.noted), length, files)
