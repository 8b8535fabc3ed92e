"""Transfer of curves with held contacts to a problem in which some of these are computed.

As long as a held contact keeps its state, the motion is also a solution with that contact computed. So a
curve need not be followed again up to the last point before a held contact changes its state.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from fcm.continuation import Checkpoint, Path
from fcm.continuation.checkpoint import stepper_state
from fcm.continuation.problem import Points, Stored
from fcm.continuation.step_control import Stepper
from fcm.model.scene import FloatArray, has_friction
from fcm.response.options import CONTACT_CHANGES
from fcm.response.resumable_branches import SavedPath, problem_kind
from fcm.shooting.problem import OrbitProblem


class ReinstatedContacts:
    """The affine map from points of a problem with held contacts to those of a problem with fewer held.

    The friction force of a contact that sticks is k_u (u - rest), with u the displacement along it.
    """

    def __init__(self, before: OrbitProblem, now: OrbitProblem) -> None:
        self.before, self.now = before, now
        rows, columns = _places(now), _places(before)
        self._linear = (rows[:, None] == columns).astype(np.float64)
        self._rest = np.zeros(rows.size)
        modal, computed = before.scene.modal, now.scene.computed()
        self._released = [i for i, one in enumerate(before.scene.held) if one.place in computed]
        for one in (before.scene.held[i] for i in self._released):
            if has_friction(one.contact) and not one.open:
                row = rows == 2 * modal.mass.size + one.place
                self._linear[row, : modal.mass.size] = one.contact.k_u * (
                    modal.shapes @ one.contact.tangential
                )
                self._rest[row] = -one.contact.k_u * one.rest

    def saved_paths(self, saved_paths: Iterable[SavedPath]) -> Iterator[SavedPath]:
        """Yield the saved paths that are also paths of the other problem, in its unknowns."""
        for saved in saved_paths:
            path = None if saved.path is None else self._path(saved.path)
            checkpoint = (
                None
                if saved.checkpoint is None or saved.path is not None
                else self._checkpoint(saved.checkpoint)
            )
            if path is not None or checkpoint is not None:
                yield SavedPath(saved.number, *problem_kind(self.now), path, checkpoint)

    def states_kept(self, points: Iterable[FloatArray]) -> bool:
        """Whether the released contacts have kept their state in motions z."""
        shots = [self.before.shot(z) for z in points]
        return all(shot is not None and (shot.held_distances[self._released] > 0.0).all() for shot in shots)

    def point(self, z: FloatArray) -> FloatArray:
        """A motion in the unknowns of the other problem."""
        there: FloatArray = self._linear @ z + self._rest
        return there

    def way(self, direction: FloatArray) -> FloatArray:
        """A direction in the unknowns of the other problem."""
        there: FloatArray = self._linear @ direction
        return there

    def _path(self, path: Path) -> Path | None:
        if not (len(path.z) and self.states_kept(path.z)):
            return None
        stepper = self._stepper(path.z[-1], path.direction[-1])
        if stepper is None:
            return None
        sense = stepper.here.orientation * path.orientation[-1]
        z, direction = _each(self.point, path.z), _each(self.way, path.direction)
        return replace(path, z=z, direction=direction, orientation=sense * path.orientation)

    def _checkpoint(self, checkpoint: Checkpoint) -> Checkpoint | None:
        """The checkpoint in the other problem, with the stepper at the same point; None if not possible."""
        before, last = checkpoint.kept
        if not self.states_kept([*before.z, last[0], checkpoint.z]):
            return None
        stepper = self._stepper(checkpoint.z, checkpoint.scale * checkpoint.tangent)
        if stepper is None:
            return None
        sense = stepper.here.orientation * checkpoint.orientation
        points = Points(
            _each(self.point, before.z),
            _each(self.way, before.direction),
            before.mark,
            sense * before.orientation,
        )
        end = self.point(last[0]), self.way(last[1]), last[2], sense * last[3]
        return checkpoint._replace(
            kept=Stored(points, end),
            first=self.point(checkpoint.first),
            initial_direction=self._initial_direction(checkpoint),
            **(stepper_state(stepper) | {"z": self.point(checkpoint.z)}),
        )

    def _stepper(self, z: FloatArray, direction: FloatArray) -> Stepper | None:
        """A stepper of the other problem at a point; None if its curve is not there in that direction."""
        there, stepper = self.point(z), Stepper(self.now)
        row = _unit(self.now, there, self.way(direction))
        if not stepper.begin(there, row):
            return None
        off = (np.asarray(stepper.here.z) - there) / np.asarray(stepper.newton.scale)
        same = (
            np.linalg.norm(off) < CONTACT_CHANGES.point_tolerance
            and np.asarray(stepper.here.tangent) @ row > 1.0 - CONTACT_CHANGES.point_tolerance
        )
        return stepper if same else None

    def _initial_direction(self, checkpoint: Checkpoint) -> FloatArray:
        """The direction at the start of the path, in units of the scale there."""
        self.before.evaluate_scale(checkpoint.first)
        direction = checkpoint.initial_direction * np.asarray(self.before.scale)
        return _unit(self.now, self.point(checkpoint.first), self.way(direction))


def _each(change: Callable[[FloatArray], FloatArray], rows: FloatArray) -> FloatArray:
    """Apply a change row by row, so that equal rows stay equal to the last digit."""
    return np.array([change(row) for row in rows]).reshape(len(rows), -1)


def _places(problem: OrbitProblem) -> FloatArray:
    """Indices of the unknowns of a point among those of the whole scene; -1 for the frequency."""
    scene = problem.scene
    modes = 2 * scene.modal.mass.size
    every: Sequence[int] = [*range(modes), *(modes + i for i in scene.computed())]
    return np.append(np.array(every)[problem.free], -1)


def _unit(problem: OrbitProblem, z: FloatArray, direction: FloatArray) -> FloatArray:
    """The unit vector of a direction at z, in units of the scale there."""
    problem.evaluate_scale(z)
    scaled = direction / np.asarray(problem.scale)
    unit: FloatArray = scaled / np.linalg.norm(scaled)
    return unit
