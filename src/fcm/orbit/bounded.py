"""The balances that are to lead to further branches, as long as nobody waits for them."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from fcm.orbit.periodic import Look

if TYPE_CHECKING:
    from fcm.harmonic.outline import Outline

SELDOM = 0.05  # [s] between two looks at the processor time, which takes long to tell on some machines


class Bounded:
    """Balances that take no more than so many seconds of processor time together.

    outside : called now and then, all the while; `look` is to be called while a balance is computed.
    given_up : why there may be more branches than those that they lead to, empty if all were computed.
    """

    def __init__(self, outside: Look, most: float) -> None:
        self.outside, self.most, self.given_up = outside, most, list[str]()
        self._end, self._left, self._ask = np.inf, most, 0.0

    def look(self) -> None:
        """Raise `TooLongError` when they have taken as much."""
        from fcm.harmonic.work import TooLongError

        self.outside()
        if self._end < np.inf and time.monotonic() > self._ask:
            if time.process_time() > self._end:
                raise TooLongError
            self._ask = time.monotonic() + SELDOM

    def each(self, balances: Iterator[Outline]) -> Iterator[Outline]:
        """One after the other; what is done with them between takes nothing of their time."""
        from fcm.harmonic.work import TooLongError

        while True:
            begin = time.process_time()
            self._end = begin + self._left
            try:
                balance = next(balances, None)
            except TooLongError:
                self._note(f"a balance that leads to them takes more than {self.most:.3g} s")
                return
            self._left -= time.process_time() - begin
            if balance is None:
                return
            if balance.further:
                few, many = len(balance.system.harmonics), len(balance.further)
                self._note(f"with {few} harmonics, as the {many} that it is foreseen to take are too many")
            yield balance

    def _note(self, why: str) -> None:
        self.given_up.append(f"the search for further branches was given up: {why}")
