"""Reads the [structure] table: matrices, names of rows, damping, and the number of modes to keep."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
import scipy.sparse

from fcm.frozen import Frozen
from fcm.scene.entries import check_numbers, check_symmetric, symmetric
from fcm.scene.errors import choices, counted, kind, quoted, shown
from fcm.scene.excitation import TRANSLATIONS, along_axis
from fcm.scene.files import DataFileError, Files
from fcm.scene.formats.labelled import Labelled
from fcm.scene.keys import names
from fcm.scene.matrix_file import is_matrix_file, read_matrix
from fcm.scene.names import Names, motion_of
from fcm.scene.options import TOLERANCES
from fcm.scene.row_names import in_order, labels_of, row_names
from fcm.scene.rules import ANY, NOT_NEGATIVE, RULES, as_float
from fcm.scene.section import Section, written_as
from fcm.structure.eigen import StructureError, factored_structure
from fcm.structure.rigid_body import bodies


class StructureMatrices(Frozen):
    """Contents of a [structure] table."""

    dofs: Names
    K: Any  # scipy sparse, (row, row), symmetric
    M: Any
    ratio: float | None  # damping ratio of every mode
    by_mass: float  # factor of proportional damping
    by_stiffness: float
    C: Any | None  # damping matrix
    hysteretic: float  # loss factor
    modes: int | None  # number of modes to keep; None for the default
    flexibility: bool  # whether to keep the flexibility of the other modes
    coupling: Coupling | None = None  # coupling to the next sector of a ring


class Coupling(Frozen):
    """Blocks of a ring's matrices with this sector's rows and the next sector's columns."""

    K: Any
    M: Any


def read_structure(top: Section, files: Files) -> tuple[Names | None, StructureMatrices | None]:
    """The names of the rows, and the contents of the table; None for each after a mistake."""
    section = top.table("structure", "")
    if section is None:
        return None, None
    before = top.mistakes.count
    section.only(*names("structure"))
    read = top.mistakes.count
    given = {key: _matrix(section, key, files) for key in ("stiffness", "mass")}
    labels = labels_of(given.values())
    dofs = row_names(section, files, labels)
    K, M = (in_order(section, key, one, dofs) for key, one in given.items())
    rows = None if K is None else K.shape[0]
    if K is not None and M is not None and M.shape[0] != rows:
        section.wrong("mass", f"has {counted(M.shape[0], 'row')}, but the stiffness has {rows}")
    sound = top.mistakes.count == read
    if dofs is not None and rows is not None and len(dofs) != rows:
        section.wrong("dofs", f"names {counted(len(dofs), 'row')}, but the stiffness has {rows}")
    read = top.mistakes.count
    for key, matrix in (("stiffness", K), ("mass", M)):
        off = check_symmetric(section, key, matrix, dofs)
        if matrix is not None:
            files.said.append(said_of(section.data[key], key, matrix, off, given[key]))
    if sound:
        _check_rows(section, K, M, dofs)
    sound = sound and top.mistakes.count == read
    damping = _damping(section, files, rows, dofs)
    modes = _modes(section)
    coupling = _coupling(section, files, rows, dofs)
    keep = section.data.get("flexibility", True)
    if not isinstance(keep, bool):
        section.wrong("flexibility", f"must be true or false, is {kind(keep)}")
    if top.mistakes.count > before or dofs is None:
        if sound and coupling is None:
            _check_definite(section, K, M)
        return dofs, None
    files.masses.update(translated(M, dofs))
    files.meshes.append(is_mesh(K, dofs))
    return dofs, StructureMatrices(
        dofs, symmetric(K), symmetric(M), modes=modes, flexibility=keep, coupling=coupling, **damping
    )


def said_of(value: Any, key: str, matrix: Any, off: float, given: Labelled | None) -> str:
    """Sentence on a matrix that was read; off is its relative asymmetry.

    >>> said_of("K.mtx", "stiffness", scipy.sparse.csc_array([[2.0, -1.0], [-1.0, 2.0]]), 0.0, None)
    'stiffness: K.mtx: 2 rows, 4 entries that are not 0, symmetric'
    """
    entries, diagonal = matrix.count_nonzero(), np.count_nonzero(matrix.diagonal())
    form = "diagonal" if entries == diagonal else "symmetric" if off == 0.0 else f"symmetric to {off:.1g}"
    source = f"{value}: " if isinstance(value, str) else ""
    rows = given.rows if given is not None else ()
    named = f"; the file names its rows, {rows[0]} to {rows[-1]}" if rows else ""
    size = counted(matrix.shape[0], "row")
    many = "1 entry that is" if entries == 1 else f"{entries} entries that are"
    return f"{key}: {source}{size}, {many} not 0, {form}{named}"


def translated(M: Any, dofs: Names) -> dict[str, float]:
    """The mass that a unit translation along each axis moves, by axes in the names of degrees of freedom.

    >>> translated(scipy.sparse.diags_array([2.0, 2.0, 1.0, 7.0]), Names(("1x", "1y", "2x", "q")))
    {'x': 3.0, 'y': 2.0}
    """
    moved = {axis: np.array([along_axis(name, axis) for name in dofs], dtype=float) for axis in TRANSLATIONS}
    return {axis: float(one @ (M @ one)) for axis, one in moved.items() if one.any()}


def is_mesh(K: Any, dofs: Names) -> bool:
    """Whether all rows belong to nodes with three translations, coupled only to their neighbours.

    A reduced structure couples all rows. Its mass may differ along the axes, due to the shapes of its
    reduction; that of a mesh does not.

    >>> dofs = Names([f"{node}{axis}" for axis in "xyz" for node in range(8)])
    >>> chain = scipy.sparse.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(8, 8))
    >>> mesh, reduced = (scipy.sparse.block_diag([one] * 3) for one in (chain, np.ones((8, 8))))
    >>> is_mesh(mesh, dofs), is_mesh(reduced, dofs), is_mesh(mesh, Names((*dofs[:-1], "q")))
    (True, False, False)
    """
    at: dict[str, set[str]] = {}
    for name in dofs:
        node, axis = re.fullmatch(r"(\d*)(.*)", motion_of(name), re.DOTALL).groups()  # type: ignore[union-attr]
        at.setdefault(node, set()).add(axis)
    if not all(set(TRANSLATIONS) <= axes for axes in at.values()):
        return False
    sizes = np.bincount(bodies(K))
    return bool(K.count_nonzero() <= TOLERANCES.mesh_entries * (sizes.astype(np.float64) ** 2).sum())


def _check_rows(section: Section, K: Any, M: Any, dofs: Names | None) -> None:
    """Notes rows without stiffness and mass."""
    idle = np.flatnonzero((K.diagonal() == 0.0) & (M.diagonal() == 0.0)).tolist()
    if idle:
        fits = dofs is not None and len(dofs) == K.shape[0]
        rows = choices([dofs[i] if dofs is not None and fits else str(i) for i in idle])
        have = "has" if len(idle) == 1 else "have"
        section.wrong(
            "", f"{rows} {have} neither stiffness nor mass on the diagonal; leave out what is not used"
        )


def _check_definite(section: Section, K: Any, M: Any) -> None:
    """Notes matrices that are not those of a structure."""
    try:
        factored_structure(symmetric(K), symmetric(M))
    except StructureError as error:
        section.wrong("", str(error))


def _matrix(section: Section, key: str, files: Files) -> Labelled | None:
    """The square matrix at a key, from a file, a list of rows, or a diagonal; None after a mistake."""
    if section.missing(key, 'a file such as "K.npz", or a list of rows'):
        return None
    return matrix_of(section, key, section.data[key], files)


def matrix_of(section: Section, key: str, value: Any, files: Files) -> Labelled | None:
    """The square matrix that the value of a key describes; None after a mistake."""
    rows: tuple[str, ...] = ()
    if isinstance(value, str):
        if not value:
            section.wrong(key, "is empty; name a file")
            return None
        try:
            found = read_matrix(value, files)
            matrix, rows = _of_diagonal(found.matrix), found.rows
        except DataFileError as error:
            for fault in error.faults:
                section.wrong(key, fault)
            return None
    else:
        matrix = _from_rows(section, key, value)
        if matrix is None:
            return None
    if matrix.shape[0] != matrix.shape[1] or not matrix.shape[0]:
        section.wrong(
            key,
            f"must be square, has {counted(matrix.shape[0], 'row')} and {counted(matrix.shape[1], 'column')}",
        )
        return None
    return Labelled(matrix, rows) if check_numbers(section, key, matrix) else None


def _of_diagonal(matrix: Any) -> Any:
    """The matrix of a file; a single row or column is taken as a diagonal, like a list in a scene."""
    several = max(matrix.shape) > min(matrix.shape) == 1
    return scipy.sparse.diags_array(matrix.toarray().ravel(), format="csc") if several else matrix


def _from_rows(section: Section, key: str, value: Any) -> Any:
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if not isinstance(value, list | tuple) or not value:
        what = shown(value) if isinstance(value, bool | int | float) else kind(value)
        section.wrong(key, f"must be a file, or a list of rows, is {what}")
        return None
    path = section.at(key)
    if as_float(value[0]) is not None:
        diagonal = section.numbers(value, path, ANY)
        return None if diagonal is None else scipy.sparse.diags_array(diagonal, format="csc")
    rows = [section.numbers(row, f"{path}[{index}]", ANY) for index, row in enumerate(value)]
    good = [row for row in rows if row is not None]
    if len(good) < len(rows):
        return None
    uneven = [index for index, row in enumerate(good) if len(row) != len(good[0])]
    for index in uneven:
        section.wrong(
            f"{key}[{index}]", f"has {len(good[index])} numbers, but the first row has {len(good[0])}"
        )
    return None if uneven else scipy.sparse.csc_array(np.array(good))


def _damping(section: Section, files: Files, rows: int | None, dofs: Names | None) -> dict[str, Any]:
    """Reads the damping: a ratio, proportional, a matrix, or a loss factor."""
    found: dict[str, Any] = {"ratio": None, "by_mass": 0.0, "by_stiffness": 0.0, "C": None, "hysteretic": 0.0}
    right = 'a ratio, { mass = , stiffness = }, { loss_factor = } or a file such as "C.npz"'
    if section.missing("damping", right):
        return found
    value = section.data["damping"]
    if isinstance(value, Mapping):
        return found | _proportional(Section(value, section.at("damping"), section.mistakes))
    if as_float(value) is not None:
        return found | {"ratio": section.number("damping", RULES["damping"])}
    if isinstance(value, str) and not is_matrix_file(value):
        section.wrong("damping", f"must be {right}, is {quoted(value)}{written_as(value)}")
        return found
    C = in_order(section, "damping", matrix_of(section, "damping", value, files), dofs)
    if C is not None and rows is not None and C.shape[0] != rows:
        section.wrong("damping", f"has {counted(C.shape[0], 'row')}, but the stiffness has {rows}")
    check_symmetric(section, "damping", C, dofs)
    return found | {"C": None if C is None else symmetric(C)}


def _proportional(table: Section) -> dict[str, Any]:
    if set(table.data) == {"ratio"}:
        table.wrong("ratio", f"unknown key; a ratio of all modes is damping = {shown(table.data['ratio'])}")
        return {}
    table.only(*names("structure.damping"))
    if "loss_factor" in table.data:
        if len(table.data) > 1:
            table.wrong("", "has a loss_factor beside others; give it alone")
        return {"hysteretic": table.number("loss_factor", NOT_NEGATIVE)}
    if not table.data:
        table.wrong("", "is empty; give { mass = , stiffness = } or { loss_factor = }")
    return {
        "by_mass": table.number("mass", NOT_NEGATIVE, default=0.0),
        "by_stiffness": table.number("stiffness", NOT_NEGATIVE, default=0.0),
    }


def _coupling(section: Section, files: Files, rows: int | None, dofs: Names | None) -> Coupling | None:
    """The coupling blocks to the next sector; None if there are none, or after a mistake."""
    if "coupling" not in section.data:
        return None
    table = section.table("coupling", "")
    if table is None:
        return None
    table.only(*names("structure.coupling"))
    if not table.data:
        table.wrong("", "is empty; give { stiffness = } or { mass = , stiffness = }")
        return None
    K, M = (_block(table, key, files, rows, dofs) for key in ("stiffness", "mass"))
    return Coupling(K, M)


def _block(table: Section, key: str, files: Files, rows: int | None, dofs: Names | None) -> Any:
    """A coupling block to the next sector; zero if it is not given."""
    given = matrix_of(table, key, table.data[key], files) if key in table.data else None
    block = in_order(table, key, given, dofs)
    if block is not None and rows is not None and block.shape[0] != rows:
        table.wrong(key, f"has {counted(block.shape[0], 'row')}, but the stiffness has {rows}")
    return scipy.sparse.csc_array((rows or 1, rows or 1)) if block is None else block


def _modes(section: Section) -> int | None:
    value = section.data.get("modes")
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        what = shown(value) if isinstance(value, bool | int | float) else kind(value)
        section.wrong("modes", f"must be a whole number of at least 1, is {what}")
        return None
    return value
