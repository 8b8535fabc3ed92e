"""Curves that are followed one after the other in this process, and what an interruption leaves of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from fcm.results.result import INTERRUPTED, Curve
from fcm.run import Progress


def one_by_one(tasks: Sequence[tuple[Curve, Callable[[], Curve]]], progress: Progress | None) -> list[Curve]:
    """What each task follows; of those that an interruption leaves out, the curve without points beside it.

    Raises
    ------
    KeyboardInterrupt
        If no curve is finished then.
    """
    curves: list[Curve] = []
    for i, (none, followed) in enumerate(tasks):
        if progress is not None:
            progress(i / len(tasks), f"{i} of {len(tasks)} curves")
        if curves and curves[-1].reason.startswith(INTERRUPTED):
            curves.append(none)
            continue
        try:
            curves.append(followed())
        except KeyboardInterrupt:
            if not curves:
                raise
            curves.append(replace(none, reason=f"{INTERRUPTED} at the start"))
    return curves
