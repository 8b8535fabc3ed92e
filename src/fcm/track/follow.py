"""Follow a special point of a response as a curve in a number of its scene, through its corners and turns."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fcm.continuation.options import FOLLOW
from fcm.scene.model import FloatArray
from fcm.track.circle import Circle
from fcm.track.corner import nearest
from fcm.track.meeting import NEAR, SHORTEST, Meeting
from fcm.track.place import FIRST, KINK
from fcm.track.spot import Ending, Spot, Way
from fcm.track.top import is_top, overtaken
from fcm.track.tracked import Condition

COSINE = 0.94  # of the turn in a step: at most 20 degrees
MISSED = 0.3  # of a step, by which the prediction may be wrong
MOST = 3000  # points of a curve
RADII = (1e-6, 1e-5, 1e-4, 1e-3)  # of circles about a kink on which the curve is looked for
OFF = 0.1  # of such a radius, by which the point found there may be wrong
ACROSS = 0.7  # cosine of the angle of the way on with its radius; other lines cross the circle anyhow
BENT = 5.0  # of such a step, by which the prediction may be wrong
HALVINGS = 30  # of a step, within which another extreme becomes the greatest
SHORT = 1e-3  # a step below which a corner of the response is looked for ahead
AIM = 0.2  # [rad] the turn that a step aims at
FAR = 0.3  # in the problem's scale: a start that is corrected by more is none


def follow(way: Way, condition: Condition, start: Spot, forward: bool) -> tuple[list[Spot], Ending]:
    """The curve from a spot, which is the first of the list, with s rising or falling at first."""
    return _Follower(way, condition).run(start, forward)


def land(way: Way, condition: Condition, z: FloatArray) -> Spot | None:
    """The spot near z = (x, omega, s) at the same s; at a corner if there is one that holds."""
    return _Follower(way, condition).land(z)


class _Follower(Meeting):
    """The steps."""

    def land(self, z: FloatArray) -> Spot | None:
        spot = self._landed(z)
        if spot is not None and overtaken(self.smooth, spot.z):
            spot = self._landed(spot.z)  # as a peak of those extremes that are the greatest of a cycle there
            if spot is not None and overtaken(self.smooth, spot.z):
                return None
        return spot

    def _landed(self, z: FloatArray) -> Spot | None:
        self._measure(z)
        scale = np.array(self.newton.scale)
        for off, at in nearest(self.smooth.varied, z, scale) if self.turns else ():
            if off > NEAR:
                break
            self._use(at)
            self._measure(z)
            if self._solve(z, self.held) and self.newton.moved < NEAR and self._holds():
                return self._spot(np.array(self.newton.z), np.array(self.newton.tangent))
        self._use(None)
        self._measure(z)
        if self._solve(z, self.held) and self.newton.moved < FAR:
            return self._spot(np.array(self.newton.z), np.array(self.newton.tangent))
        return None

    def run(self, start: Spot, forward: bool) -> tuple[list[Spot], Ending]:
        self._use(start.corner)
        self._measure(start.z)
        row, beside = self.held if forward else -self.held, np.array(start.z)
        if beside[-1] in self.kinks:
            beside += KINK * self.smooth.span * row
        if not self._solve(beside, row):
            return [], Ending.STALLED
        self._accept()
        first, heading, step = self.z, self.t * np.asarray(self.newton.scale), FIRST
        self.spots = [self._spot(self.z, self.t)]
        if beside[-1] != start.z[-1]:
            self.spots.insert(0, start)
        if self._outside(self.z[-1] + self.t[-1] * SHORTEST * self.smooth.span):
            return self.spots, Ending.SPAN
        for count in range(MOST):
            before, known = self.z, len(self.spots)
            taken = self._advance(step)
            turned = [i for i in range(known, len(self.spots)) if self.spots[i].turn]
            if self.way.peaks_only and turned:
                return self.spots[: turned[0] + 1], Ending.TURNED
            if isinstance(taken, Ending):
                return self.spots, taken
            step = taken
            if count > 2 and self._passes(before, first, heading):
                self.spots.append(self.spots[0])
                return self.spots, Ending.CLOSED
        return self.spots, Ending.LONG

    def _advance(self, step: float) -> float | Ending:
        """One step; the length of the next, or how the curve ends."""
        bend, met = self.bend, False
        while step > SHORTEST:
            scale = np.asarray(self.newton.scale)
            guess = self.z + scale * (step * self.t + 0.5 * step * step * bend)
            if (kink := self._kink(guess)) is not None and (passed := self._pass(guess, kink, step)):
                return passed
            sharp = step < FOLLOW.step.sharp
            good = self._solve(guess, self.t) and self.newton.moved < (BENT if sharp else MISSED) * step
            turned = float(np.asarray(self.newton.tangent) @ self.t) if good else 0.0
            good = good and turned > (0.0 if sharp else COSINE)
            good = good and not self._crosses()
            if good and overtaken(self.smooth, np.array(self.newton.z)):
                return self._overtaken(step)
            if good and not self._holds():
                return self._leave(step)
            if good and (kept := self._keep(step)) is not None:
                return kept
            step *= 0.25
            if step < SHORT and not met:
                met = True
                if (taken := self._meet()) is not None:
                    return taken
        return self._round()

    def _overtaken(self, step: float) -> Ending:
        """Up to where, within a step, extremes other than those of the peak become the greatest of the cycle.

        There the amplitude has a kink that is a trough: it meets a peak, and takes the place of a trough.
        """
        low, high = 0.0, step
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            if self._between(middle) and not overtaken(self.smooth, np.array(self.newton.z)):
                low = middle
            else:
                high = middle
        if low > 0.0 and self._between(low) and isinstance(kept := self._keep(low), Ending):
            return kept
        return Ending.MET if is_top(self.smooth, self.spots[-1]) else Ending.TROUGH

    def _round(self) -> float | Ending:
        """Go on from a kink of the curve, on a circle about the place; or why it cannot be gone on.

        Where what a contact does changes with continuous derivatives, second ones jump, and so does the
        direction of a curve of folds or peaks. Where the derivatives jump the response has a corner.
        """
        problem, ending = self.smooth if self.corner is None else self.corner.problem, Ending.STALLED
        for radius in RADII:
            back = self._back(radius)
            if back is None:
                break
            for change in Circle(problem, self.z, self.t, radius).changes(back):
                if change.jump:
                    ending = Ending.CORNER
                elif (taken := self._turn_to(change.z, radius)) is not None:
                    return taken
        return ending

    def _back(self, radius: float) -> FloatArray | None:
        """The point on the way back at a distance, by the chord; None if that is further than it was come."""
        scale, near = np.asarray(self.newton.scale), self.z
        for spot in reversed(self.spots):
            far = float(np.linalg.norm((spot.z - self.z) / scale))
            if far > radius:
                short = float(np.linalg.norm((near - self.z) / scale))
                return near + (spot.z - near) * ((radius - short) / (far - short))
            near = spot.z
        return None

    def _turn_to(self, there: FloatArray, radius: float) -> float | Ending | None:
        """Go on to a point on a circle; None if it is none of the curve."""
        came, last = float(self.t[-1]), self.spots[-1]
        row = (there - self.z) / np.asarray(self.newton.scale)
        row /= np.linalg.norm(row)
        if not self._solve(there, row) or self.newton.moved > OFF * radius:
            return None
        if np.asarray(self.newton.tangent) @ row < ACROSS:
            return None
        z, t = np.array(self.newton.z), np.array(self.newton.tangent)
        self.spots[-1] = replace(last, turn=last.turn or came * t[-1] < 0.0)
        ending = self._passed(radius, z)
        if ending is True:
            self._go_to(z, t)
            return radius
        return ending or None

    def _keep(self, step: float) -> float | Ending | None:
        """Go on to the point that was found, with what happens on the way; None if not all is found."""
        z, t = np.array(self.newton.z), np.array(self.newton.tangent)
        missed, scale = max(self.newton.moved / step, 1e-9), np.array(self.newton.scale)
        turn = self._turn(step, t) if self.t[-1] * t[-1] < 0.0 else None
        if turn is None and self.t[-1] * t[-1] < 0.0:
            return None
        if (ending := self._passed(step, z, turn)) is not True:
            return ending or None
        turned = float(np.arccos(min(float(self.t @ t), 1.0)))
        bend = (t - self.t) / step
        self._go_to(z, t)
        ratio = scale / np.asarray(self.newton.scale)
        self.bend = (bend - (bend @ t) * t) * ratio
        grown = min(AIM / max(turned, 1e-9), float(np.sqrt(0.03 / missed)))
        return min(step * min(max(0.9 * grown, 0.4), 2.5), self.way.step)

    def _go_to(self, z: FloatArray, t: FloatArray) -> None:
        """Go on from a point, and keep it."""
        self.newton.z[:], self.newton.tangent[:] = z, t
        self._accept()
        self.spots.append(self._spot(self.z, self.t))

    def _passes(self, before: FloatArray, first: FloatArray, heading: FloatArray) -> bool:
        """Whether the last step passes the point where the curve began, in the same direction."""
        scale = np.asarray(self.newton.scale)
        heading = heading / scale
        heading = heading / np.linalg.norm(heading)
        one, other = (before - first) / scale, (self.z - first) / scale
        length = np.linalg.norm(other - one)
        if min(np.linalg.norm(one), np.linalg.norm(other)) > length:
            return False
        return bool(one @ heading < 0.0 <= other @ heading and self.t @ heading > 0.5)
