"""What is said of a [start] whose friction a contact cannot carry there."""

from __future__ import annotations

from fcm.model.scene import Contact, Scene, Start
from fcm.scene.options import MESSAGES


def note_of_start(scene: Scene) -> list[str]:
    """One sentence for each contact whose friction in [start] is beyond its limit there, in any curve."""
    return [_sentence(scene, place, beyond) for place, beyond in _beyond(scene).items()]


def _beyond(scene: Scene) -> dict[int, list[tuple[Scene, float]]]:
    """The contacts with their limits in those curves."""
    found = dict[int, list[tuple[Scene, float]]]()
    for curve in scene.each_curve():
        start = curve.start
        for place, contact in enumerate(curve.contacts if start is not None and start.friction.any() else ()):
            assert start is not None
            limit = _limit(curve, contact, start)
            if abs(start.friction[place]) > limit * (1.0 + MESSAGES.start_rounding):
                found.setdefault(place, []).append((curve, limit))
    return found


def _limit(scene: Scene, contact: Contact, start: Start) -> float:
    """The greatest friction force of a contact where the scene starts."""
    if contact.k_u == 0.0:
        return 0.0
    displacement = scene.modal.shapes.T @ start.displacement
    return contact.mu * max(contact.n_0 + contact.k_v * float(contact.normal @ displacement), 0.0)


def _sentence(scene: Scene, place: int, beyond: list[tuple[Scene, float]]) -> str:
    first, limit = beyond[0]
    assert first.start is not None
    swept = ", ".join(f"{key} = {value:g}" for key, value in first.parameters.items())
    count = f"{len(beyond)} of {len(scene.each_curve())}"
    where = f" in {count} curves, the first with {swept}," if swept else ""
    begins = "a [[schedule]] starts from the limit; " if scene.schedule else ""
    contact = first.contacts[place]
    return (
        f"start.friction[{place}]: {first.start.friction[place]:g} is beyond what {contact.name} can carry "
        f"there,{where} mu n = {limit:g}: {begins}exact curves take that residual friction where the motion "
        "itself holds it, else the nearest"
    )
