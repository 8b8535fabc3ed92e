"""Contacts whose springs are far stiffer, or far softer, than the structure: mostly of another unit."""

from __future__ import annotations

import numpy as np

from fcm.model.question import Question
from fcm.model.scene import FloatArray, Scene
from fcm.scene.errors import several
from fcm.scene.options import MESSAGES


def notes_of_stiffness(scene: Scene) -> list[str]:
    """Notes on contacts far stiffer than the structure at them, or if all are far softer.

    The measure is k times the flexibility of the elastic modes along the contact's displacement, sum phi^2 /
    (m omega^2). Nothing is said of rings, of stiffnesses that are swept, nor of soft contacts that hold rigid
    bodies.
    """
    varied = () if scene.draft is None else scene.draft.swept
    swept = any(one.key.endswith((".k_u", ".k_v")) for one in varied)
    if scene.ring is not None or swept or not scene.contacts:
        return []
    ratio = _stiffness_beside_structure(scene)
    stiff = np.flatnonzero(ratio > MESSAGES.stiff_contact)
    if stiff.size:
        names = several([scene.contacts[i].name for i in stiff])
        contacts, at_most = ("contacts", " at most") if stiff.size > 1 else ("contact", "")
        return [
            Question(
                f"{contacts} {names}: {ratio.max():.1e} times as stiff as the structure there{at_most}. "
                "Are k_u and k_v in its units? Beyond some hundred times little changes, and runs take long"
            )
        ]
    if not 0.0 < ratio.max() < MESSAGES.soft_contact or not scene.modal.frequency.all():
        return []
    return [
        Question(
            f"the contacts are soft beside the structure: {ratio.max():.1e} times its stiffness at most, "
            "so that they change little. Are k_u and k_v in its units?"
        )
    ]


def _stiffness_beside_structure(scene: Scene) -> FloatArray:
    """Ratio (contact,): the greater of k_u and k_v times the flexibility along the displacement."""
    modal = scene.modal
    elastic = modal.frequency > 0.0
    shapes = modal.shapes[elastic] / (np.sqrt(modal.mass) * modal.frequency)[elastic][:, None]
    ratio = np.zeros(len(scene.contacts))
    for i, one in enumerate(scene.contacts):
        springs = [*((one.k_u, along) for along in one.directions[:-1]), (one.k_v, one.normal)]
        ratio[i] = max(k * float(np.sum((shapes @ along) ** 2)) for k, along in springs)
    return ratio
