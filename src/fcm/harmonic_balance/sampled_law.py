"""Contact laws of one's own in the balance: forces sampled over a cycle (alternating frequency and time).

    x(theta_s) = x_0 + Re sum_j X_j exp(i h_j theta_s),    F_h = 2/S sum_s f(theta_s) exp(-i h theta_s)

Harmonics of the law beyond S/2 are aliased (Cameron and Griffin, Journal of Applied Mechanics 56, 1989).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.contact.contact_law import ContactLaw, ContactLawError
from fcm.harmonic_balance.contact_law import Law
from fcm.harmonic_balance.options import HARMONIC_BALANCE
from fcm.model.scene import Contact, FloatArray, Scene
from fcm.quoting import quoted
from fcm.structure.layout import Layout


class SampledLaw(Law):
    """Forces in the harmonics `outputs` of a motion with other harmonics, and their tangent.

    There are as many margins as in the other contacts, all marked as absent: it is unknown where the law is
    not smooth. The contact loads are sampled; the slip path is unknown and counts as 0.
    """

    def __init__(
        self,
        contact: Contact,
        harmonics: Sequence[int],
        outputs: Sequence[int],
        directions: int,
        margins: int,
        samples: int = HARMONIC_BALANCE.samples,
    ) -> None:
        assert contact.law is not None
        motion, answer = (Layout(1, directions, len(one)) for one in (harmonics, outputs))
        super().__init__(motion.width, directions, margins, contact)
        self.own, self.name = contact.law, contact.name
        self.without_margins()
        count = max(int(contact.law.samples), samples * max((*harmonics, *outputs)))
        angle: FloatArray = 2.0 * np.pi / count * np.arange(count, dtype=np.float64)
        self.variation = _waves(motion, harmonics, angle)
        self.rate = np.zeros_like(self.variation)  # by the angle
        for j, h in enumerate(harmonics):
            re = slice(directions + motion.stride * j, directions + motion.stride * (j + 1), 2)
            im = slice(re.start + 1, re.stop + 1, 2)
            self.rate[..., re], self.rate[..., im] = h * self.variation[..., im], -h * self.variation[..., re]
        self.projection = _waves(answer, outputs, angle) * (2.0 / count)
        self.projection[..., answer.mean_at] *= 0.5
        self.rest = np.zeros((directions, count))
        self.rest = self._sampled(np.zeros((directions, count)), self.variation)[0]
        self.force, self.tangent = np.zeros(answer.width), np.zeros((answer.width, motion.width))

    def set_parameters(self, mu: float, k_u: float, k_v: float, n_0: float) -> None:
        """Do nothing: a law of one's own does not use the parameters of the contact."""

    def evaluate(self, x: FloatArray, first: int) -> int:
        """Compute forces and tangent from the sampled law."""
        force, change = self._sampled(self._motion(x, first), self.variation)
        self.force[:] = np.einsum("dso,ds->o", self.projection, force)
        self.tangent[:, :] = np.einsum("dso,dsk->ok", self.projection, change)
        self.nonlinear = True
        return 0

    def evaluate_forces(self, x: FloatArray, first: int) -> int:
        """Compute the forces alone from the sampled law."""
        force, _ = self._sampled(self._motion(x, first), self.variation[:, :, :1])
        self.force[:] = np.einsum("dso,ds->o", self.projection, force)
        self.nonlinear = True
        return 0

    def compute_resistance(self) -> int:
        """Fill `resistance` with the tangent of the means."""
        self.resistance[:, :] = np.asarray(self.tangent)[: self.directions, : self.directions]
        return 0

    def cycle(self, x: FloatArray, first: int) -> int:
        """Fill the contact loads from the samples: greatest forces and energy; there are no states."""
        motion = self._motion(x, first)
        force = self._sampled(motion, self.variation[:, :, :1])[0] + self.rest
        power = force * (self.rate @ np.asarray(x)[first : first + self.width])
        self.pieces = 0
        self.contact_loads[0] = force[-1].max()
        self.contact_loads[1] = np.sqrt((force[:-1] ** 2).sum(axis=0)).max()
        self.contact_loads[2], self.contact_loads[3] = 0.0, 2.0 * np.pi * float(power.sum()) / motion.shape[1]
        return 0

    def _motion(self, x: FloatArray, first: int) -> FloatArray:
        block: FloatArray = np.asarray(x)[first : first + self.width]
        return np.asarray(self.variation @ block)

    def _sampled(self, motion: FloatArray, variation: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Forces of the law, less those at rest, and their changes; ContactLawError if they are invalid."""
        found = self.own.forces(motion, variation)
        if not isinstance(found, tuple | list) or len(found) != 2:
            what = f"an array of shape {found.shape}" if isinstance(found, np.ndarray) else _kind(found)
            raise ContactLawError(
                f"{self.description}: forces(x, dx) has returned {what}. It is to return two arrays: the "
                f"forces, of shape {motion.shape} as x, and their changes, of {variation.shape} as dx"
            )
        force, change = (np.asarray(one, dtype=np.float64) for one in found)
        if force.shape != motion.shape or change.shape != variation.shape:
            raise ContactLawError(
                f"{self.description}: forces of shape {force.shape} and changes of shape {change.shape}; "
                f"they are to have the shapes of x and dx, {motion.shape} and {variation.shape}"
            )
        if not (np.isfinite(force).all() and np.isfinite(change).all()):
            raise ContactLawError(f"{self.description}: a force or its change is not a finite number")
        return force - self.rest, change

    @property
    def description(self) -> str:
        """The class of the law and the name of its contact, for a sentence."""
        return f"the law {type(self.own).__name__} of the contact {quoted(self.name)}"


def _kind(found: object) -> str:
    """Describe what a law has returned instead of two arrays.

    >>> _kind((1.0, 2.0, 3.0)), _kind(None)
    ('3 values', 'a NoneType')
    """
    return f"{len(found)} values" if isinstance(found, tuple | list) else f"a {type(found).__name__}"


def check_own_laws(scene: Scene) -> None:
    """Raise ContactLawError where a contact law of one's own returns invalid forces or wrong changes.

    `ContactLaw.off_by` is evaluated at motions of the size at which the contact may slip, and at larger ones.
    """
    most = HARMONIC_BALANCE.own_law_changes
    for contact in scene.contacts:
        if contact.law is not None:
            law = SampledLaw(contact, (1,), (1,), scene.directions_of_contact, 1)
            law.evaluate(np.ones(law.width), 0)
            off = _off_by(contact, contact.law, scene.directions_of_contact)
            if off > most:
                raise ContactLawError(
                    f"{law.description}: its changes are off by {off:.2g} from central differences of its "
                    f"forces, relative to the greatest. With more than {most:g} no solution would be found"
                )


def _off_by(contact: Contact, law: ContactLaw, directions: int) -> float:
    """Greatest error of a law's changes at motions of two sizes.

    For each size the lesser error of two motions counts: one may have a sample in a corner of the forces.
    """
    slip = contact.mu * abs(contact.n_0) / contact.k_u if contact.k_u > 0.0 else 0.0
    motions = np.random.default_rng(1).normal(size=(2, 2, directions, 8)) * (slip or 1.0)
    with np.errstate(all="ignore"):
        each = [
            [law.off_by(size * one) for one in two] for size, two in zip((1.0, 10.0), motions, strict=True)
        ]
    return max((min(two) for two in each if np.isfinite(two).all()), default=0.0)


def _waves(layout: Layout, harmonics: Sequence[int], angle: FloatArray) -> FloatArray:
    """Motion (direction, sample, unknown) over the cycle for a unit value of each unknown of a contact."""
    found = np.zeros((layout.directions, angle.size, layout.width))
    for d in range(layout.directions):
        found[d, :, d] = 1.0
        for j, h in enumerate(harmonics):
            at = layout.directions + layout.stride * j + 2 * d
            found[d, :, at], found[d, :, at + 1] = np.cos(h * angle), -np.sin(h * angle)
    return found
