"""Floquet multipliers of a motion in time, from the monodromy matrix of its sequence of states."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.stability.disturbance import Stiffness
from fcm.stability.eigenvalues import eigenvalues
from fcm.stability.monodromy import ManyMonodromy, Monodromy
from fcm.stability.options import STABILITY, StabilityOptions
from fcm.stability.quasi_static_modes import PortModes
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.segments import Segments, SegmentSequence

ComplexArray = npt.NDArray[np.complex128]


class Floquet:
    """Workspace that computes the Floquet `multipliers` of motions of a scene at any frequency."""

    def __init__(self, system: EquationsOfMotion, options: StabilityOptions = STABILITY) -> None:
        scene, unit = system.scene, 1.0 / np.sqrt(system.scene.modal.mass)
        held = [one.contact for one in scene.held if not one.open]
        contacts = (*scene.contacts, *held)
        law = np.array([[c.mu, c.k_u, c.k_v, c.n_0] for c in contacts], dtype=np.float64).reshape(-1, 4)
        directions = np.array([way for c in contacts for way in (c.tangential, c.normal)])
        modal = scene.modal
        ports = (modal.shapes * unit[:, None]) @ directions.reshape(-1, modal.shapes.shape[1]).T
        self.states = SegmentSequence(law, len(held), system.tangential, system.normal)
        self.monodromy: Monodromy | ManyMonodromy
        if len(law) < options.structure.many_contacts:
            stiffness = Stiffness(ports, modal.frequency, modal.damping, None, law)
            self.monodromy = Monodromy(stiffness, self.states)
        else:
            none = np.zeros(modal.frequency.size, dtype=bool)
            modes = PortModes(ports, modal.frequency, modal.damping, none)
            self.monodromy = ManyMonodromy(modes, law, self.states)

    def multipliers(self, segments: Segments, duration: float) -> ComplexArray:
        """The multipliers of segments that last for a duration [s], after which the motion repeats.

        The state of a disturbance has the modal displacements and velocities, and the sliders that keep their
        rest position at the start of the period. Multipliers are infinite where a disturbance overflows.
        """
        self.states.take(segments, duration)
        self.monodromy.follow(2.0 * np.pi / duration)
        matrix = self.monodromy.matrix()
        found = eigenvalues((matrix,))[0]
        return np.full(len(matrix), np.inf, dtype=complex) if found is None else np.array(found)


def floquet_of(system: EquationsOfMotion) -> Floquet:
    """The `Floquet` workspace of a system, one for all frequencies."""
    if "floquet" not in system.made:
        system.made["floquet"] = Floquet(system)
    found: Floquet = system.made["floquet"]
    return found
