"""Check for numbers that cannot be followed, as they change the rigid-body motions of a structure."""

from __future__ import annotations

from fcm.model.scene import Scene
from fcm.scene.draft import Number
from fcm.sensitivity.parameter_derivatives import changes_rigid_bodies
from fcm.structure.linear import linear_of


def rigid_fault(scene: Scene, number: Number, span: tuple[float, float]) -> str:
    """Text on why a number of a scene cannot be followed over a span; empty if it can."""
    first = scene.each_curve()[0]
    ends = [linear_of(number.put(first, value)) for value in span]
    if len({int((end.natural == 0.0).sum()) for end in ends}) > 1:
        return (
            f"at one end of {number.key} the structure has more rigid-body motions than at the other. "
            "What is tracked does not go on from there; leave that end out"
        )
    at_ends = [changes_rigid_bodies(end, number, value) for end, value in zip(ends, span, strict=True)]
    if all(at_ends):
        return (
            f"{number.key} changes the rigid-body motions of the structure, so nothing is followed in it; "
            "a [sweep] of it shows the response"
        )
    if any(at_ends):
        return f"at 0 {number.key} changes the rigid-body motions of the structure; leave 0 out"
    return ""
