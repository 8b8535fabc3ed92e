"""One cycle of an exact motion: its sequence of contact states and its values at any instant."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from fcm.contact.periodic.cycle import join_states
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.time_domain.equations_of_motion import LETTERS, EquationsOfMotion
from fcm.time_domain.segments import Segments, sample


class Cycle(Frozen):
    """The motion over one period of the force, or over the part of one that ends a phase."""

    system: EquationsOfMotion
    start: float  # [s] from the start of the motion
    duration: float  # [s]
    angle: float  # angle of the forces at its start [rad]
    segments: Segments

    @property
    def letters(self) -> list[str]:
        """Contact states in each segment, as a word with one letter of SEPN for each contact."""
        return ["".join(LETTERS[code] for code in row) for row in np.asarray(self.segments.states).tolist()]

    @property
    def states(self) -> tuple[str, ...]:
        """State sequence of each contact, such as 'EPEN', for a repeating cycle."""
        lasting = np.asarray(self.segments.states)[np.asarray(self.segments.length) > 0.0]
        return _sequences(lasting.tobytes(), lasting.shape[1])

    def values(self, rows: FloatArray, times: FloatArray) -> FloatArray:
        """rows @ y at increasing times [s] from the start of the cycle: (time, row)."""
        steps, done = self.system.steps(self.segments), 0
        out, times = np.empty((times.size, self.system.size)), np.ascontiguousarray(times, dtype=np.float64)
        while (done := sample(steps, times, out, done)) < times.size:
            self.system.make(np.asarray(self.segments.states)[steps.at + 1])
        values: FloatArray = out @ rows.T
        return values


@lru_cache
def _sequences(states: bytes, contacts: int) -> tuple[str, ...]:
    """State sequences of all contacts, from their codes in each segment; cached, as most of them repeat."""
    return tuple(_sequence(states[j::contacts]) for j in range(contacts))


def _sequence(codes: bytes) -> str:
    """Letters of a cycle without repetitions, beginning with separation, else with the stick before P.

    >>> _sequence(bytes(map(LETTERS.index, "NEEPPEN")))
    'EPEN'
    """
    state, segment = np.frombuffer(codes, np.int8).astype(np.intc), np.arange(len(codes), dtype=np.intc)
    kept = "".join(LETTERS[code] for code in state[: join_states(state, segment, len(codes))])
    if segment[0] > 0:  # the last state continues in the first
        kept = kept[-1:] + kept[:-1]
    for first in ("S", "EP", "E"):
        at = (kept + kept[:1]).find(first)
        if at >= 0:
            return kept[at:] + kept[:at]
    return kept
