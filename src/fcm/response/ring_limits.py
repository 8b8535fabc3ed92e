"""Limits of the response of a ring's sector: unknown quantities, and requests that need the whole ring."""

from __future__ import annotations

from typing import NamedTuple

from fcm.model.scene import InTime, Scene, in_time
from fcm.response.options import SENTENCES
from fcm.response.request import Request, ResponseError
from fcm.scene.cyclic import WHOLE_RING, lacks
from fcm.scene.errors import quoted
from fcm.scene.options import LIMITS
from fcm.structure.loads import driven_harmonics

PLANE = (
    "is computed of contacts on a line alone, between whose events the structure is linear. While one slips "
    "in a plane its direction turns with the motion. More harmonics (--harmonics, --accuracy) come as "
    "near to it as is asked for"
)


def refuse_in_time(scene: Scene, what: str) -> None:
    """Raise ResponseError if the motion in time of a scene is requested but cannot be computed."""
    match in_time(scene):
        case InTime.RING:
            raise ResponseError(f"{scene.name}: {what} {WHOLE_RING}")
        case InTime.PLANE:
            names = [quoted(one.name) for one in scene.contacts if one.second is not None]
            raise ResponseError(f"{scene.name}: contact {names[0]}: {what} {PLANE}")
        case InTime.OWN_LAW:
            refuse_own_laws(scene, what)


def refuse_other_harmonics(scene: Scene, what: str) -> None:
    """Raise ResponseError if the scene has forces of other harmonics than 1, which `what` does not allow."""
    others = driven_harmonics(scene)[1:]
    if others:
        named = " and ".join(map(str, others))
        raise ResponseError(
            f"{scene.name}: {what} knows forces of harmonic 1 alone, and there are some of harmonic {named}. "
            "Curves of harmonic balance have them (--method closed-form)"
        )


def check_no_ring(scene: Scene, what: str) -> None:
    """Raise ResponseError for a sector of a ring, for which `what` is not computed."""
    if scene.ring is not None:
        raise ResponseError(
            f"{scene.name}: cyclic: {what} of a ring of sectors are not computed. Write all its sectors out "
            "as a scene without [cyclic], or take a [sweep]"
        )


def refuse_own_laws(scene: Scene, what: str) -> None:
    """Raise ResponseError if a contact has a law of one's own, which gives only forces over a cycle."""
    if scene.with_own_laws:
        names = [quoted(one.name) for one in scene.contacts if one.law is not None]
        raise ResponseError(
            f"{scene.name}: contact {names[0]}: {what} needs more than the forces over a cycle that its own "
            'law gives. Response curves of harmonic balance do not (method "closed-form")'
        )


def check_modes(scene: Scene, request: Request) -> None:
    """Raise ResponseError if a requested harmonic excites a nodal diameter without modes."""
    for curve in scene.each_curve():
        if curve.ring is None:
            return
        driven = driven_harmonics(curve)
        harmonics = (
            range(LIMITS.harmonics + 1) if request.harmonics is None else (0, *request.harmonics, *driven)
        )
        for harmonic, diameter in curve.ring.lacking(harmonics).items():
            what = f"{scene.name}: {lacks(curve.ring, harmonic, diameter)}"
            hint = "; give its modes, or the harmonics (--harmonics 1)" if request.harmonics is None else ""
            raise ResponseError(f"{what}{hint}")


class UnknownOfRing(NamedTuple):
    """Sentences on what is unknown of the curves of a ring, and whether stability of any is unknown."""

    sentences: list[str]
    stability: bool = False


def unknown(scene: Scene, request: Request) -> UnknownOfRing:
    """What is unknown of the curves of a ring, for lack of modes or because it would take too long."""
    found: dict[str, None] = {}
    without_stability = False
    orders = {one.ring.engine_order: one for one in scene.each_curve() if one.ring is not None}
    if not orders:
        return UnknownOfRing([])
    from fcm.harmonic_balance.system import System
    from fcm.stability.ring_multipliers import stability_unknown

    for curve in orders.values():
        assert curve.ring is not None
        lacking = curve.ring.lacking(range(1, LIMITS.harmonics + 1))
        if lacking:
            named = ", ".join(map(str, list(lacking)[: SENTENCES.max_harmonics])) + (
                ", ..." if len(lacking) > SENTENCES.max_harmonics else ""
            )
            diameters = ", ".join(map(str, sorted(set(lacking.values()))))
            found[
                f"the answer to the harmonics {named}: there are no modes of nodal diameter {diameters} "
                "(errors are estimated without them)"
            ] = None
        system = System(curve, request.harmonics or (1,))
        if why := stability_unknown(system, curve.frequency_range[1]):
            found[f"stability: {why}"] = None
            without_stability = True
    return UnknownOfRing(list(found), without_stability)
