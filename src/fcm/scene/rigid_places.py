"""Checks coordinates of paired nodes by rigid-body modes, which must move them as one rigid body."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from fcm.model.interface import Interface
from fcm.model.question import Question
from fcm.model.scene import FloatArray
from fcm.scene.errors import quoted
from fcm.scene.names import Names
from fcm.scene.options import TOLERANCES

AXES = ("x", "y", "z")
SIDES = ("first nodes", "other nodes")
MOTIONS = 6  # number of independent motions of a rigid body


def notes_of_places(modal: Mapping[str, Any], interfaces: Iterable[Interface]) -> list[str]:
    """A question for each side of pairs that rigid-body modes do not move as a rigid body at its places.

    A side that belongs to several bodies, or has held nodes, is not checked.
    """
    rigid: FloatArray = np.asarray(modal["shapes"])[np.asarray(modal["frequency"]) == 0.0]
    if not rigid.size or np.iscomplexobj(rigid):
        return []
    return [note for one in interfaces for note in _of(one, rigid, modal["dofs"])]


def _of(interface: Interface, rigid: FloatArray, dofs: Names) -> Iterator[str]:
    for side, places in enumerate((interface.first, interface.second)):
        there = [
            (pair[side], place) for pair, place in zip(interface.nodes, places, strict=False) if pair[side:]
        ]
        if (worst := _off(there, rigid, dofs)) is not None:
            node, share = worst
            yield Question(
                f"contact {quoted(interface.name)}: its {SIDES[side]} move as no rigid body does at their "
                f"places: node {node} is off most, by {100.0 * share:.0f} % of the motion. Is a column of "
                "the file shifted, or a coordinate wrong?"
            )


def _off(there: list[tuple[str, FloatArray]], rigid: FloatArray, dofs: Names) -> tuple[str, float] | None:
    """The node whose motion in rigid-body modes fits t + theta x r worst, and its error; None if all fit."""
    rows, columns, owners = list[FloatArray](), list[int](), list[str]()
    for node, (x, y, z) in there:
        turns = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])  # derivative of theta x r by theta
        for i, axis in enumerate(AXES):
            if name := dofs.find(f"{node}{axis}") or dofs.find(f"{node}_{axis}"):
                rows.append(np.concatenate((np.eye(3)[i], turns[i])))
                columns.append(dofs.place[name])
                owners.append(node)
    if not rows:
        return None
    body, moved = np.array(rows), rigid[:, columns].T
    size = np.abs(moved).max()
    least = min(np.abs(moved[[one == node for one in owners]]).max() for node in dict.fromkeys(owners))
    motions = np.linalg.matrix_rank(moved, tol=TOLERANCES.asymmetry * np.linalg.norm(moved))
    if not least > TOLERANCES.asymmetry * size or motions > min(MOTIONS, len(rows) - 1):
        return None  # some nodes are held, or there are several bodies
    off = np.abs(moved - body @ np.linalg.lstsq(body, moved, rcond=None)[0]).max(axis=1) / size
    worst = int(off.argmax())
    return (owners[worst], float(off[worst])) if off[worst] > TOLERANCES.placed else None
