"""Search for other motions at the frequencies of points of exact curves; its results are saved."""

from __future__ import annotations

import numpy as np

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.response.resumable_branches import TimeOver
from fcm.results.orbits import Stuck
from fcm.run import Report
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.periodic_orbit import Poll, never_interrupt


class CoexistingMotions(Frozen):
    """Motions at one frequency: amplitude ranges of points over residual friction, and isolated motions."""

    frequency: float
    amplitude: FloatArray  # (point, dof)
    least: FloatArray  # (point, dof) nan where the amplitude is unique
    greatest: FloatArray  # (point, dof)
    whole: FloatArray  # (point,) 1 if the extent covers all residual friction, 0 if not, nan without one
    isolated: list[Stuck]  # motions outside all extents

    @classmethod
    def unknown(cls, frequency: float, amplitude: FloatArray) -> CoexistingMotions:
        """A record without results, to be filled in."""
        least, greatest = np.full_like(amplitude, np.nan), np.full_like(amplitude, np.nan)
        return cls(frequency, amplitude, least, greatest, np.full(len(amplitude), np.nan), [])


FOUND = (CoexistingMotions, Stuck)  # classes of saved data


class Search:
    """A search that can be ended; its results until then stay known, also to a resumed run.

    poll : raises `TimeOver` to end the search.
    options : options of the motions sought.
    """

    def __init__(self, poll: Poll, report: Report, options: ShootingOptions = SHOOTING) -> None:
        self._poll, self._report, self.over = poll, report, False
        self.options = options
        self._known = {_key(one): one for one in report.saved if isinstance(one, CoexistingMotions)}

    @classmethod
    def none(cls) -> Search:
        """A search that looks for nothing."""
        search = cls(never_interrupt, Report(lambda _fraction, _text: None))
        search.end()
        return search

    def poll(self) -> None:
        """Raise `TimeOver` if the search is over; to be called regularly."""
        if not self.over:
            self._report(1.0, "looking for other motions")
            try:
                self._poll()
            except TimeOver:
                self.over = True
        if self.over:
            raise TimeOver

    def end(self) -> None:
        """End the search: look for nothing more."""
        self.over = True

    def known(self, frequency: float, amplitude: FloatArray) -> CoexistingMotions | None:
        """The motions found earlier at a frequency for points with these amplitudes, or None."""
        return self._known.get((frequency, amplitude.tobytes()))

    def keep(self, found: CoexistingMotions) -> None:
        """Store and save the motions found, unless the search has been ended meanwhile."""
        if not self.over:
            self._known[_key(found)] = found
            self._report.save(found)


def _key(found: CoexistingMotions) -> tuple[float, bytes]:
    return found.frequency, found.amplitude.tobytes()
