"""The mirror images of motions: of a symmetric structure the motion that breaks the symmetry has one.

An image is the motion half a period later, or at once, with contacts in the place of others like them, and
their tangential displacements reversed. Which contacts those are a symmetric motion tells, which is its own
image; that the image of another is a solution, too, its balance.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from fcm.branches.options import BRANCHING, BranchingOptions
from fcm.continuation import Path
from fcm.frozen import Frozen
from fcm.harmonic_balance.reported_quantities import reported_at
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray


class Symmetry(Frozen):
    """counterpart (contact,): whose motion a contact has in the image; factor (contact, unknown of one
    contact) of that motion's numbers."""

    counterpart: npt.NDArray[np.intp]
    factor: FloatArray

    def image(self, z: FloatArray) -> FloatArray:
        """The mirror image of a motion (unknown + 1,)."""
        blocks = z[:-1].reshape(len(self.counterpart), -1)
        return np.append(self.factor * blocks[self.counterpart], z[-1])


def parts_of(system: System, z: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Greatest even parts of a motion's displacements, and greatest odd ones.

    Even are the means and the even harmonics, which a symmetric motion has not.
    """
    parts = np.abs(system.layout.complex_ports(z)).max(axis=0, initial=0.0)
    even = np.array([True, *(h % 2 == 0 for h in system.harmonics)])
    return parts[even], parts[~even]


def is_symmetric(system: System, path: Path) -> bool:
    """Whether the motions of a path are symmetric, and not all of them linear, of which each is."""
    options = system.option(BRANCHING)
    some = np.arange(0, len(path.z), max(len(path.z) // options.symmetry_points, 1))
    for z in path.z[some]:
        even, odd = parts_of(system, z)
        if not (even < options.min_residual * odd.max()).all():
            return False
    return not reported_at(system, path.z[some], path.direction[some]).linear.all()


def broken_symmetries(system: System, symmetric: FloatArray, other: FloatArray) -> Iterator[Symmetry]:
    """The symmetries of which a symmetric solution (unknown + 1,) is its own image, and the image of another
    one is a solution, and not the same."""
    balance, options = system.new_balance(), system.option(BRANCHING)
    for later in (True, False):
        symmetry = _symmetry_of(system, symmetric, later, options)
        if symmetry is None:
            continue
        image = symmetry.image(other)
        balance.evaluate_scale(image)
        scale = np.asarray(balance.scale)
        balance.evaluate_residual(image)
        off = np.abs(np.asarray(balance.residual) / scale[:-1]).max(initial=0.0)
        if (
            off < options.motion_tolerance
            and np.linalg.norm((image - other) / scale) > options.motion_tolerance
        ):
            yield symmetry


def _symmetry_of(system: System, z: FloatArray, later: bool, options: BranchingOptions) -> Symmetry | None:
    contacts = system.scene.contacts
    laws = [(c.mu, c.k_u, c.k_v, c.n_0, c.law) for c in contacts]
    blocks = z[:-1].reshape(len(contacts), -1)
    harmonics = system.layout.harmonic_of(system.harmonics)
    turned = (-1.0) ** harmonics if later else np.ones(harmonics.size)
    tangential = ~system.layout.of_normal
    size = np.abs(blocks).max(initial=0.0)
    counterpart, factor = np.full(len(contacts), -1), np.ones(blocks.shape)
    for i in range(len(contacts)):
        if counterpart[i] >= 0:
            continue
        others = [j for j in range(i + 1, len(contacts)) if counterpart[j] < 0 and laws[j] == laws[i]]
        for j, sign in ((j, sign) for j in (*others, i) for sign in (-1.0, 1.0)):
            by = turned * np.where(tangential, sign, 1.0)
            if np.abs(blocks[i] - by * blocks[j]).max() < options.motion_tolerance * size:
                counterpart[i], counterpart[j], factor[i], factor[j] = j, i, by, by
                break
        else:
            return None
    return Symmetry(counterpart.astype(np.intp), factor)
