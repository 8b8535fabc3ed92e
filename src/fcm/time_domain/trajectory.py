"""A simulated motion: displacements at any instant, amplitudes of each cycle, transitions, energy."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, Scene
from fcm.time_domain.cycle import Cycle
from fcm.time_domain.cycle_measures import Measure, measure
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.state import State


class Transition(NamedTuple):
    """A change of state of a contact."""

    time: float  # [s]
    contact: int
    before: str  # one of E, P, N, S
    after: str


class History(NamedTuple):
    """Displacements at evenly spaced phase angles."""

    time: FloatArray  # (time,) [s]
    displacement: FloatArray  # (time, dof)
    states: npt.NDArray[np.str_]  # (time, contact) letters E, P, N, S


class Motion(Frozen):
    """The exact motion of a scene; time starts at 0 with the motion."""

    scene: Scene
    cycles: tuple[Cycle, ...]
    end: State  # from which another simulation may continue

    @property
    def duration(self) -> float:
        """Time simulated [s]."""
        return self.cycles[-1].start + self.cycles[-1].duration

    def displacement(self, time: npt.ArrayLike) -> FloatArray:
        """Displacements of the degrees of freedom at times [s] in [0, duration], (time, dof).

        Raises
        ------
        SimulationError
            If a time is outside of the motion.
        """
        return self._at(time, velocities=False)

    def velocity(self, time: npt.ArrayLike) -> FloatArray:
        """Velocities of the degrees of freedom at times [s] in [0, duration], (time, dof)."""
        return self._at(time, velocities=True)

    def friction(self, time: npt.ArrayLike) -> FloatArray:
        """Friction forces f of the contacts at times [s] in [0, duration], (time, contact)."""
        return self._rows_at(time, friction_rows)

    def _at(self, time: npt.ArrayLike, velocities: bool) -> FloatArray:
        return self._rows_at(time, lambda system: dof_rows(system, velocities))

    def _rows_at(self, time: npt.ArrayLike, rows: Callable[[EquationsOfMotion], FloatArray]) -> FloatArray:
        times = np.atleast_1d(np.asarray(time, dtype=np.float64))
        if times.size and not (times.min() >= 0.0 and times.max() <= self.duration * (1.0 + 1e-15)):
            raise SimulationError(f"the motion lasts from 0 to {self.duration:g}")
        order = np.argsort(times, kind="stable")
        starts = np.array([cycle.start for cycle in self.cycles[1:]])
        owner = np.searchsorted(starts, times[order], side="right")
        parts = [
            cycle.values(rows(cycle.system), times[order[owner == i]] - cycle.start)
            for i, cycle in enumerate(self.cycles)
            if i in set(owner.tolist())
        ]
        out = np.empty_like(np.concatenate(parts))
        out[order] = np.concatenate(parts)
        return out

    def measures(self, last: int | None = None) -> list[Measure]:
        """Measures (amplitudes, means) of each cycle, or of the last cycles only.

        An incomplete cycle at the end of a phase is measured as far as it goes.
        """
        chosen = self.cycles if last is None else self.cycles[-last:]
        return [measure(cycle) for cycle in chosen]

    def history(self, samples: int = 64) -> History:
        """Displacements and contact states at `samples` instants a cycle, the end included."""
        times = [c.start + _instants(c, samples) for c in self.cycles]
        values = [c.values(dof_rows(c.system), _instants(c, samples)) for c in self.cycles]
        letters = [row for c in self.cycles for row in _letters(c, _instants(c, samples))]
        last = self.cycles[-1]
        final = last.values(dof_rows(last.system), np.array([last.duration]))
        letters += _letters(last, np.array([last.duration]))
        return History(
            np.concatenate([*times, [self.duration]]),
            np.concatenate([*values, final]),
            np.array(letters, dtype="<U1").reshape(-1, len(self.scene.contacts)),
        )

    def transitions(self) -> list[Transition]:
        """Every change of a contact's state, in order of time."""
        found: list[Transition] = []
        before = self.cycles[0].letters[0]
        for cycle in self.cycles:
            for start, after in zip(np.asarray(cycle.segments.start).tolist(), cycle.letters, strict=True):
                time, pairs = cycle.start + start, zip(before, after, strict=True)
                found += [Transition(time, j, a, b) for j, (a, b) in enumerate(pairs) if a != b]
                before = after
        return found


def dof_rows(system: EquationsOfMotion, velocities: bool = False) -> FloatArray:
    """Rows that give the displacements of the degrees of freedom from the state vector, (dof, d)."""
    rows = np.zeros((len(system.scene.modal.dofs), system.size))
    rows[:, system.p if velocities else system.q] = system.scene.modal.shapes.T
    return rows


def friction_rows(system: EquationsOfMotion) -> FloatArray:
    """Rows that give the friction forces from the state vector, (contact, d)."""
    rows: FloatArray = np.eye(system.size)[system.f]
    return rows


def _instants(cycle: Cycle, samples: int) -> FloatArray:
    """Times within the cycle at steps of 1 / samples of a period, without its end."""
    step = cycle.system.period / samples
    count = int(np.ceil(cycle.duration / step - 1e-9))
    return step * np.arange(count, dtype=np.float64)


def _letters(cycle: Cycle, times: FloatArray) -> list[list[str]]:
    starts, letters = np.asarray(cycle.segments.start)[1:], cycle.letters
    return [list(letters[i]) for i in np.searchsorted(starts, times, side="right")]
