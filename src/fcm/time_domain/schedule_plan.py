"""Plan of the record of a schedule: its cycles, and the instants of sampled displacements.

Both are known before anything is simulated, and are the same for every curve of a sweep.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray, Phase
from fcm.time_domain.options import TIME, TimeOptions

IntArray = npt.NDArray[np.intp]


class Plan:
    """The cycles of a schedule in sequence; the last cycle of a phase may be incomplete.

    Parameters
    ----------
    phases : sequence of Phase
    columns : int
        Number of displacements at an instant: degrees of freedom times curves.
    options : TimeOptions, optional
        Limits on the number of samples.

    Examples
    --------
    >>> plan = Plan([Phase(2.0, 2.0), Phase(1.0, 0.5)], columns=2)
    >>> plan.samples, plan.every, plan.part.tolist(), plan.instants
    (64, 1, [1.0, 1.0, 0.5], 161)
    >>> plan.start.round(3).tolist(), plan.time[-1].round(3)  # [s]
    ([0.0, 3.142, 6.283], np.float64(9.425))
    >>> plan.sentence
    '64 samples a cycle'
    """

    def __init__(self, phases: Sequence[Phase], columns: int, options: TimeOptions = TIME) -> None:
        counts = [int(np.ceil(phase.cycles)) for phase in phases]
        self.period = 2.0 * np.pi / np.array([phase.frequency for phase in phases])  # (phase,) [s]
        self.length = np.array([phase.cycles for phase in phases])  # (phase,) in cycles
        self.phase = np.repeat(np.arange(len(phases)), counts)  # (cycle,) index of its phase
        within = np.concatenate([np.arange(count) for count in counts])
        self.part = np.minimum(self.length[self.phase] - within, 1.0)  # (cycle,) 1 of a whole one
        self.elapsed = _before(self.length)[self.phase] + within  # (cycle,) cycles at its start
        self.phase_start = _before(self.length * self.period)  # (phase,) [s]
        self.start = self.phase_start[self.phase] + within * self.period[self.phase]  # (cycle,) [s]
        self.samples, self.every = _density(self.phase.size, columns, options)
        sampled = np.ceil(self.part * self.samples - 1e-9).astype(np.intp)
        sampled[np.arange(sampled.size) % self.every > 0] = 0
        sampled[-1] = max(np.ceil(self.part[-1] * self.samples - 1e-9), 1)
        self.first = _before(sampled).astype(np.intp)  # (cycle,) its first instant
        self.sampled = sampled  # (cycle,) how many instants it has

    @property
    def instants(self) -> int:
        """Number of sampled instants, including the end."""
        return int(self.sampled.sum()) + 1

    @cached_property
    def time(self) -> FloatArray:
        """Time [s] of each instant from the start of the schedule."""
        owner, inside = self._inside
        begun = self.start[owner] + inside * self.period[self.phase[owner]]
        return np.append(begun, self.phase_start[-1] + self.length[-1] * self.period[-1])

    @cached_property
    def cycles(self) -> FloatArray:
        """Number of cycles passed at each instant."""
        owner, inside = self._inside
        return np.append(self.elapsed[owner] + inside, self.length.sum())

    @cached_property
    def _inside(self) -> tuple[IntArray, FloatArray]:
        """Cycle of each instant but the last, and the fraction of the cycle that has passed."""
        owner = np.repeat(np.arange(self.sampled.size), self.sampled)
        return owner, (np.arange(owner.size) - self.first[owner]) / self.samples

    @property
    def sentence(self) -> str:
        """Text on the sampling density of the displacements."""
        of = f" of every {self.every}th cycle" if self.every > 1 else " a cycle"
        return f"{self.samples} samples{of}"


def _before(values: FloatArray | IntArray) -> FloatArray:
    """Cumulative sum of the values before each one."""
    return np.concatenate(([0.0], np.cumsum(values)[:-1]))


def _density(cycles: int, columns: int, options: TimeOptions = TIME) -> tuple[int, int]:
    """Samples in a cycle, and the interval of sampled cycles (every n-th cycle is sampled)."""
    samples = options.history.max_samples
    while (
        samples > options.history.min_samples
        and cycles * samples * columns > options.history.max_displacements
    ):
        samples //= 2
    return samples, max(int(np.ceil(cycles * samples * columns / options.history.max_displacements)), 1)
