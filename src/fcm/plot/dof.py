"""The degree of freedom of a file that a picture is asked for."""

from __future__ import annotations

import json
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from fcm.plot.errors import PlotError
from fcm.plot.options import READ
from fcm.rotational_dofs import MOST_DOFS, greatest_first


def column_of(dofs: Sequence[str], dof: str | None, whose: str = "the file has") -> int:
    """Column of a degree of freedom, 0 by default; a node's may be written 40x, 40:x or 40:1.

    >>> column_of(["40x", "tip"], "40:1"), column_of(["40x", "tip"], None), column_of(["40x", "tip"], "tip")
    (0, 0, 1)
    """
    if dof is None:
        return 0
    if dof in dofs:
        return dofs.index(dof)
    from fcm.scene.errors import choices, quoted, suggestion
    from fcm.scene.names import Names

    if found := Names(dofs).find(dof):
        return dofs.index(found)
    listed = f"{whose} {choices(dofs, READ.dofs_named)}"
    raise PlotError(f"no degree of freedom {quoted(dof)}; {listed}{suggestion(dof, dofs)}")


def asked_for(attribute: object, dofs: Sequence[str]) -> tuple[str, ...]:
    """Degrees of freedom that the scene asks for, from an attribute of its file; empty without one.

    >>> asked_for('["2x"]', ["1x", "2x"]), asked_for("", ["1x", "2x"])
    (('2x',), ())

    Raises
    ------
    ValueError
        If the attribute is no list of names.
    """
    names = json.loads(str(attribute)) if attribute else []
    if not isinstance(names, list):
        raise ValueError("its attribute output is no list of degrees of freedom")
    return tuple(dof for dof in dofs if dof in names)


def leading_column(
    dofs: Sequence[str], dof: str | None, amplitudes: npt.NDArray[np.float64], asked: Sequence[str] = ()
) -> int:
    """Column of a degree of freedom; by default, if there are many, the one of the greatest amplitude.

    amplitudes is (any, dof). The default is among the degrees of freedom that the scene asks for, if any.
    Displacements come before rotations, which have another unit.

    >>> leading_column(["1x", "2x"], None, np.array([[1.0, 2.0]]))
    0
    >>> leading_column(["1x", "1y", "1rx", "2x", "2y"], None, np.array([[1.0, 2.0, 9.0, 7.0, np.nan]]))
    3
    """
    if dof is not None or (len(dofs) <= MOST_DOFS and not asked):
        return column_of(dofs, dof)
    return greatest_column(dofs, amplitudes, asked)


def greatest_column(
    dofs: Sequence[str], amplitudes: npt.NDArray[np.float64], asked: Sequence[str] = ()
) -> int:
    """Column of the greatest amplitude (any, dof), among those that the scene asks for, if any.

    >>> amplitudes = np.array([[1.0, 3.0], [2.0, np.nan]])
    >>> greatest_column(["1x", "2x"], amplitudes), greatest_column(["1x", "2x"], amplitudes, ["1x"])
    (1, 0)
    """
    height = np.fmax.reduce(amplitudes, axis=0, initial=0.0)
    return next(i for i in greatest_first(dofs, height) if not asked or dofs[i] in asked)
