"""Mirror images of motions: in a symmetric structure, a motion that breaks the symmetry has one.

An image is the motion half a period later, or at the same time, with equal contacts interchanged, and their
tangential displacements reversed. A symmetric motion, which is its own image, shows which contacts are
interchanged. The balance shows whether the image of another motion is a solution, too.
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
    """A symmetry of the structure with its contacts.

    counterpart (contact,): the contact whose motion a contact has in the image. factor (contact, unknown of
    one contact): factors on the unknowns of that motion.
    """

    counterpart: npt.NDArray[np.intp]
    factor: FloatArray

    def image(self, z: FloatArray) -> FloatArray:
        """The mirror image of a motion (unknown + 1,)."""
        blocks = z[:-1].reshape(len(self.counterpart), -1)
        return np.append(self.factor * blocks[self.counterpart], z[-1])


def parts_of(system: System, z: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Greatest even parts of a motion's displacements, and greatest odd parts.

    The even parts are the means and the even harmonics, which a symmetric motion does not have.
    """
    parts = np.abs(system.layout.complex_ports(z)).max(axis=0, initial=0.0)
    even = np.array([True, *(h % 2 == 0 for h in system.harmonics)])
    return parts[even], parts[~even]


def is_symmetric(system: System, path: Path) -> bool:
    """Whether the motions of a path are symmetric, and not all of them linear; linear ones always are."""
    options = system.option(BRANCHING)
    some = np.arange(0, len(path.z), max(len(path.z) // options.symmetry_points, 1))
    for z in path.z[some]:
        even, odd = parts_of(system, z)
        if not (even < options.min_residual * odd.max()).all():
            return False
    return not reported_at(system, path.z[some], path.direction[some]).linear.all()


def broken_symmetries(system: System, symmetric: FloatArray, other: FloatArray) -> Iterator[Symmetry]:
    """Yield the symmetries that a symmetric solution (unknown + 1,) has, and another solution breaks.

    The symmetric solution is its own image. The image of the other one is another solution.
    """
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
