"""The search for other motions beside the points of exact curves; what it has found is kept."""

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
    """Motions at one frequency: the extent of its points over residual friction, and those beside them."""

    frequency: float
    amplitude: FloatArray  # (point, dof)
    least: FloatArray  # (point, dof) nan where the amplitude is unique
    greatest: FloatArray  # (point, dof)
    whole: FloatArray  # (point,) 1 if it is that of all residual friction, 0 if not, nan where there is none
    isolated: list[Stuck]  # motions that no extent holds

    @classmethod
    def unknown(cls, frequency: float, amplitude: FloatArray) -> CoexistingMotions:
        """A record without results, to be filled in."""
        least, greatest = np.full_like(amplitude, np.nan), np.full_like(amplitude, np.nan)
        return cls(frequency, amplitude, least, greatest, np.full(len(amplitude), np.nan), [])


FOUND = (CoexistingMotions, Stuck)  # what is saved consists of these


class Search:
    """A search that is ended when it is to look no further; what it has found until then stays known.

    A run that is resumed knows what was found before it was interrupted.

    poll : raises `TimeOver` where no more is to be found out.
    options : of the motions that are sought.
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
        """Raise `TimeOver` if the search is over; to be called now and then."""
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
        """The motions found before at the points of a frequency, or None."""
        return self._known.get((frequency, amplitude.tobytes()))

    def keep(self, found: CoexistingMotions) -> None:
        """Keep and save the motions found, unless the search was ended meanwhile."""
        if not self.over:
            self._known[_key(found)] = found
            self._report.save(found)


def _key(found: CoexistingMotions) -> tuple[float, bytes]:
    return found.frequency, found.amplitude.tobytes()
