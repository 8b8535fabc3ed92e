"""The degree of freedom of a file that a picture is asked for."""

from __future__ import annotations

from collections.abc import Sequence

from fcm.plot.errors import PlotError

MOST_NAMED = 12  # degrees of freedom in a message


def column_of(dofs: Sequence[str], dof: str | None, whose: str = "the file has") -> int:
    """Its place, the first by default; that of a node and a direction may be written 40x, 40:x or 40:1.

    >>> column_of(["40x", "tip"], "40:1"), column_of(["40x", "tip"], None), column_of(["40x", "tip"], "tip")
    (0, 0, 1)
    """
    if dof is None:
        return 0
    if dof in dofs:
        return dofs.index(dof)
    from fcm.scene.errors import suggestion
    from fcm.scene.names import Names

    if found := Names(dofs).find(dof):
        return dofs.index(found)
    more = f", ... ({len(dofs)} in all)" if len(dofs) > MOST_NAMED else ""
    listed = f"{whose} {', '.join(dofs[:MOST_NAMED])}{more}"
    raise PlotError(f"no degree of freedom {dof!r}; {listed}{suggestion(dof, dofs)}")
