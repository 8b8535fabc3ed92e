"""Cache of the costly steps of a search, by keys, which a resumed run uses."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, TypeVar

T = TypeVar("T")


class KeptSteps:
    """Results of costly steps, kept by their keys.

    Parameters
    ----------
    known : iterable of (str, object)
        Keys and results of an earlier run.
    save : callable, optional
        Saves a key with its result as soon as the step is finished.

    Examples
    --------
    >>> steps = KeptSteps([("a", 1.0)])
    >>> steps("a", float, lambda: 2.0), steps("b", float, lambda: 3.0)
    (1.0, 3.0)
    """

    def __init__(
        self, known: Iterable[tuple[str, Any]] = (), save: Callable[[tuple[str, Any]], None] | None = None
    ) -> None:
        self._known, self._save = dict(known), save

    def of(self, what: str) -> KeptSteps:
        """The steps of a part of the search, whose keys get a prefix."""
        start, save = f"{what}: ", self._save
        known = [(key.removeprefix(start), one) for key, one in self._known.items() if key.startswith(start)]
        return KeptSteps(known, None if save is None else lambda step: save((start + step[0], step[1])))

    def __call__(self, key: str, kind: type[T], step: Callable[[], T]) -> T:
        """The result of a step, kept or computed; a kept result of another class is ignored."""
        known = self._known.get(key)
        if isinstance(known, kind):
            return known
        found = self._known[key] = step()
        if self._save is not None:
            self._save((key, found))
        return found


def steps_of(states: Iterable[Any]) -> list[tuple[str, Any]]:
    """Keys and results among the objects read from a file."""
    return [one for one in states if isinstance(one, tuple) and len(one) == 2 and isinstance(one[0], str)]
