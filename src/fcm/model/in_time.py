"""Whether the motion of a scene in time is computed, and if not why: what programs decide by."""

from __future__ import annotations

from enum import Enum

from fcm.model.scene import Scene


class InTime(Enum):
    """Whether there is an exact motion in time of a scene; the values are those of a summary as JSON."""

    COMPUTED = "computed"
    RING = "not of a ring of sectors"
    PLANE = "not of contacts in a plane"
    OWN_LAW = "not of a contact law of one's own"


def in_time(scene: Scene) -> InTime:
    """Whether the exact motion of a scene is computed.

    >>> import fcm
    >>> in_time(fcm.load_scene("yang1998-n5")), in_time(fcm.load_scene("bladed-disk"))
    (<InTime.COMPUTED: 'computed'>, <InTime.RING: 'not of a ring of sectors'>)
    """
    if scene.ring is not None:
        return InTime.RING
    if scene.planar:
        return InTime.PLANE
    return InTime.OWN_LAW if scene.with_own_laws else InTime.COMPUTED
