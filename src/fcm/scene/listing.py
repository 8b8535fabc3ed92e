"""Describes the structure of a scene before anything is solved: modes, excitation, and warnings."""

from __future__ import annotations

from typing import Any

import numpy as np

from fcm.model.question import Question
from fcm.model.ring import Ring
from fcm.model.scene import FloatArray, Force, Scene
from fcm.scene.contact_springs import stuck_stiffness
from fcm.scene.contact_stiffness import contact_flexibility
from fcm.scene.errors import counted
from fcm.scene.modal import lacks_modes_above
from fcm.scene.open_modes import stuck_modes
from fcm.scene.options import LIMITS, MESSAGES, TOLERANCES
from fcm.structure.ring import nodal_diameters
from fcm.units import UNIT

METRE_AND_MILLIMETRE = float(np.sqrt(1000.0))  # frequency factor if stiffness and mass mix m and mm units
POUND_AND_INCH = float(np.sqrt(386.09))  # frequency factor from the acceleration of gravity in in/s^2
METRIC_SLIPS = {  # factors that correct the frequencies, with cause and remedy
    METRE_AND_MILLIMETRE: "the range would hold modes if frequencies were 31.6 times as high. So it is "
    "with a stiffness in N/mm and a mass in kg: give the mass in t",
    1.0 / METRE_AND_MILLIMETRE: "the range would hold modes if frequencies were 31.6 times as low. So it is "
    "with a stiffness in N/m and a mass in t: give the mass in kg",
}
IMPERIAL_SLIPS = {
    POUND_AND_INCH: "the range would hold modes if frequencies were 19.6 times as high. So it is with a "
    "stiffness in lbf/in and a mass in lb: divide the mass by 386"
}

FLEXIBILITY = "flexibility"  # kind of a mode that stands for the flexibility of omitted modes


def listing(scene: Scene) -> dict[str, Any]:
    """Modes with frequency, damping, mass and participation; how they are normalised; notes and warnings.

    It also has the resonances with open and with stuck contacts, how much friction can damp them, and the
    stiffness of the structure at each contact. For a ring of sectors it leaves these to `fcm plot campbell`.

    The participation of a mode in a direction (of a contact or a force) is its share of the static
    flexibility along it: phi^2 / (m omega^2) over the sum of all modes. It is None if rigid-body modes make
    the flexibility infinite. `displacement` is phi / sqrt(m), the displacement of the mode of mass 1.
    """
    if scene.ring is not None:
        return _of_ring(scene, scene.ring)
    from fcm.scene.friction_damping import friction_damping  # only needed here

    modal, directions = scene.modal, _directions(scene)
    motion = {name: modal.shapes @ direction / np.sqrt(modal.mass) for name, direction in directions.items()}
    shares = {name: _shares(modal.frequency, along) for name, along in motion.items()}
    own = modal.frequency.size - modal.added
    modes = [
        {
            "mode": i + 1,
            "kind": FLEXIBILITY if i >= own else "mode" if modal.frequency[i] else "rigid body",
            "frequency": float(modal.frequency[i] / UNIT[scene.frequency_unit]),
            "damping": float(modal.damping[i]),
            "mass": float(modal.mass[i]),
            "participation": {name: None if share is None else share[i] for name, share in shares.items()},
            "displacement": {name: float(along[i]) for name, along in motion.items()},
        }
        for i in range(modal.frequency.size)
    ]
    return {
        "scene": scene.name,
        "title": scene.title,
        "frequency_unit": scene.frequency_unit,
        "units": dict(zip(("length", "force"), scene.units, strict=True)),
        "modes": modes,
        "resonances": friction_damping(scene),
        "of_pairs": _of_pairs(scene),
        "preload_shares": _preload_shares(scene),
        "stiffness": _beside_structure(scene, shares),
        "normalisation": _normalisation(scene),
        "read": _read(scene, modal.frequency[:own]),
        "notes": list(scene.notes),
        "warnings": _warnings(scene, directions, motion),
    }


def _of_pairs(scene: Scene) -> list[str]:
    """Names of the contacts that come from a [[contact]] with node pairs."""
    drafts = [] if scene.draft is None else scene.draft.parts["contact"]
    return [one["name"] for one in drafts if "group" in one]


def _preload_shares(scene: Scene) -> dict[str, float]:
    """Share of each node pair in the n_0 of its contact, if that is a total for all pairs."""
    drafts = [] if scene.draft is None else scene.draft.parts["contact"]
    return {one["name"]: one["share"]["n_0"] for one in drafts if "n_0" in one.get("share", ())}


def _beside_structure(scene: Scene, shares: dict[str, Any]) -> dict[str, dict[str, float | None]]:
    """By contact, k_u and k_v, and the stiffness of the structure without contacts along its directions.

    `structure_tangential` and `structure_normal` are None if a rigid-body mode moves along the direction, or
    if no mode does. `elastic_tangential` and `elastic_normal` are the stiffnesses by elastic modes alone;
    None if no such mode moves along the direction.
    """
    found: dict[str, dict[str, float | None]] = {}
    for contact, (along, across) in zip(scene.contacts, contact_flexibility(scene).tolist(), strict=True):
        free = [
            shares[name] is None for name in shares if name.startswith(f"contact.{contact.name}.tangential")
        ]
        held = shares[f"contact.{contact.name}.normal"] is not None
        elastic = [1.0 / one if one else None for one in (along, across)]
        found[contact.name] = {
            "k_u": contact.k_u,
            "structure_tangential": elastic[0] if not any(free) else None,
            "elastic_tangential": elastic[0],
            "k_v": contact.k_v,
            "structure_normal": elastic[1] if held else None,
            "elastic_normal": elastic[1],
        }
    return found


_IN_HERTZ = 'the range would hold modes if its numbers were in Hz: frequency_unit = "Hz"'


def resonance_doubt(scene: Scene) -> str:
    """Warning that no resonance is near the frequency range, with the nearest modes and likely mistake.

    It is empty if there is a resonance. A resonance lies between a mode without contacts and the same mode
    with all contacts stuck: springs only raise frequencies, and a moving contact is softer than its spring
    (Rayleigh). A resonance near the range suffices. For a structure of matrices it does not, if the range
    would contain it with its numbers in Hz.
    """
    if not scene.has_range:
        return ""
    ranges, room = _ranges_of_forces(scene), MESSAGES.range_near
    near, alone = [(low / room, high * room) for low, high in ranges], _modes_alone(scene)
    enough = ranges if scene.of_matrices else near
    if _resonance_within(alone, alone, *enough):  # modes with stuck contacts are not needed
        return ""
    opened, stuck = _modes_open_and_stuck(scene)
    if not opened.size or _resonance_within(opened, stuck, *enough):
        return ""
    ends, unit = ranges[0], scene.frequency_unit
    is_near = _resonance_within(opened, stuck, *near)
    margin = (ends[1] / ends[0]) ** MESSAGES.range_margin  # a mode close to an end may be chance
    within = (ends[0] * margin, ends[1] / margin)
    slip = _slip_of_units(opened[:1], stuck[:1], within, unit, imperial="lbf" in scene.units)
    if is_near and slip != _IN_HERTZ:
        return ""
    places = f"the nearest mode is at {_nearest(opened, ends) / UNIT[unit]:.6g} {unit}"
    if scene.contacts:
        places += f" without contacts, at {_nearest(stuck, ends) / UNIT[unit]:.6g} {unit} while all stick"
    if slip and slip != _IN_HERTZ:
        slip = f"is the range as meant? If so, {slip}"
    elif not slip:
        slip = "are the units of the structure, of the contacts' stiffness and of the range those meant?"
    low, high = (f"{end / UNIT[unit]:.6g}" for end in ends)
    of = f", in which forces act from {low} to {high} {unit}" if ends != scene.frequency_range else ""
    where = "within" if is_near else "near"
    return f"no resonance is {where} the range of frequencies{of}: {places}; {slip}"


def _ranges_of_forces(scene: Scene) -> list[tuple[float, float]]:
    """Frequency ranges [rad/s] in which forces act: the scene's range times each harmonic of the forces."""
    low, high = scene.frequency_range
    driven = sorted({force.harmonic for force in scene.forces}) or [1]
    return [(h * low, h * high) for h in driven]


def _modes_alone(scene: Scene) -> FloatArray:
    """Natural frequencies [rad/s] of the structure without contacts, without those for flexibility."""
    modal, ring = scene.modal, scene.ring
    return (
        modal.frequency[: modal.frequency.size - modal.added] if ring is None else ring.frequency[~ring.added]
    )


def _modes_open_and_stuck(scene: Scene) -> tuple[FloatArray, FloatArray]:
    """Natural frequencies (mode,) [rad/s] without contacts and with all stuck; the latter are positive."""
    if scene.ring is not None:
        every = nodal_diameters(scene)
        opened, stuck = (np.concatenate([getattr(one, of) for one in every]) for of in ("opened", "stuck"))
    else:
        opened = np.sort(_modes_alone(scene))
        stuck = _stuck(scene)[: opened.size] if scene.contacts else opened
    elastic = stuck > 0.0
    return opened[elastic], stuck[elastic]


def _resonance_within(opened: FloatArray, stuck: FloatArray, *ranges: tuple[float, float]) -> bool:
    """Whether a resonance between two modes, open and stuck, may be within one of the ranges."""
    return any(bool(((opened <= high) & (stuck >= low)).any()) for low, high in ranges)


def _nearest(frequency: FloatArray, ends: tuple[float, float]) -> float:
    """The frequency that is nearest to an end of the range, by ratio."""
    with np.errstate(divide="ignore"):
        away = np.abs(np.log(frequency[:, None] / np.array(ends)))
    return float(frequency[np.argmin(away.min(axis=1))])


def _stuck(scene: Scene) -> FloatArray:
    """Natural frequencies (mode,) [rad/s], ascending, with all contacts stuck."""
    squares: FloatArray = np.asarray(np.linalg.eigvalsh(stuck_stiffness(scene)), dtype=np.float64)
    return np.sqrt(np.maximum(squares, 0.0))


def _damped_stuck(scene: Scene) -> tuple[FloatArray, FloatArray]:
    """Frequencies [rad/s] and damping ratios (mode,) of the first elastic modes with all contacts stuck.

    The ratio is phi^T C phi / (2 omega), with the damping matrix C of the modes without contacts.
    """
    import scipy.linalg  # which most runs do without

    modal, stiffness = scene.modal, stuck_stiffness(scene)
    floating = int((modal.frequency == 0.0).sum())  # with contacts there are no more rigid-body modes
    last = min(floating + MESSAGES.stuck_modes, len(stiffness)) - 1
    squares, turn = scipy.linalg.eigh(stiffness, subset_by_index=[0, last])
    damping = (2.0 * modal.damping * modal.frequency) @ turn**2
    elastic = squares > TOLERANCES.undamped * np.abs(stiffness).sum(axis=1).max(initial=0.0)
    omega = np.sqrt(squares[elastic])
    return omega, damping[elastic] / (2.0 * omega)


def notes_of_modes(scene: Scene) -> list[str]:
    """Notes on the first resonances with contacts open and stuck and their damping, to check units."""
    unit, most = scene.frequency_unit, MESSAGES.stuck_modes
    opened = np.sort(_modes_alone(scene))
    rigid, opened = int((opened == 0.0).sum()), opened[opened > 0.0]
    omega, ratio = _damped_stuck(scene)
    of_open = f"{_listed(opened[:most] / UNIT[unit])} {unit}" if opened.size else "none"
    if rigid:
        of_open = f"0 ({counted(rigid, 'rigid-body mode')})" + (f", {of_open}" if opened.size else "")
    damped = f". Their damping ratios while stuck: {_listed(ratio[:most], 3)}" if omega.size else ""
    of_stuck = f"{_listed(omega[:most] / UNIT[unit])} {unit}" if omega.size else "none"
    if rigid and omega.size:  # open and stuck modes do not correspond by number
        alike = np.array([scene.modal.frequency[one.open_mode] for one in stuck_modes(scene)[:most]])
        of_stuck += f", by shape those at {_listed(alike / UNIT[unit])} {unit} open"
    numbers = "" if scene.fit is None else " of the numbers before the fit"
    said = [
        f"structure: first resonances{numbers} with all contacts open: {of_open}; with all stuck: {of_stuck}"
        f"{damped}. The main peak of a mode lies {'mostly ' if rigid else ''}between the two"
    ]
    if scene.of_matrices and ratio.size and ratio.min() >= LIMITS.damping_ratio:
        said.append(
            Question(
                "structure.damping: is it right? It damps each of these more than critically, "
                f"{ratio.min():.3g} times at least, so that no resonance is seen. Is it in the units of the "
                "stiffness, and the frequency in rad/s?"
            )
        )
    if scene.of_matrices and (slip := _first_far_below(scene)):
        said.append(Question(slip))
    return said


def notes_of_diameters(scene: Scene) -> list[str]:
    """Notes on the first resonances of a ring, contacts open and stuck, by diameter that forces excite."""
    ring, unit, most = scene.ring, scene.frequency_unit, MESSAGES.stuck_modes
    assert ring is not None
    met = {ring.meets(one.harmonic): one.harmonic for one in reversed(scene.forces)}
    return [
        f"structure: nodal diameter {one.number}, which harmonic {met[one.number]} of engine order "
        f"{ring.engine_order} meets: first resonances with all contacts open: "
        f"{_listed(one.opened[:most] / UNIT[unit])} {unit}; with all stuck: "
        f"{_listed(one.stuck[:most] / UNIT[unit])} {unit}. The main peak of a mode lies between the two"
        for one in nodal_diameters(scene)
        if one.number in met
    ]


def _first_far_below(scene: Scene) -> str:
    """Sentence that the first resonance is far below the range, as a unit mistake would explain; or ''.

    `resonance_doubt` finds nothing then, since higher modes are in the range.
    """
    if not scene.has_range:
        return ""
    opened, stuck = _modes_open_and_stuck(scene)
    (low, high), unit = _ranges_of_forces(scene)[0], scene.frequency_unit
    if not stuck.size or stuck[0] > low / MESSAGES.far_below:
        return ""
    if not _resonance_within(
        METRE_AND_MILLIMETRE * opened[:1], METRE_AND_MILLIMETRE * stuck[:1], (low, high)
    ):
        return ""
    return (
        f"structure: are the units those meant? The first resonance, {stuck[0] / UNIT[unit]:.5g} {unit} "
        "while all contacts stick, is far below the range of frequencies. 31.6 times as high it would be "
        "within. So it is of a mass in kg with a stiffness in N/mm, or of one in g with N/m"
    )


def _listed(values: FloatArray, digits: int = 5) -> str:
    return ", ".join(f"{value:.{digits}g}" for value in values)


def _of_ring(scene: Scene, ring: Ring) -> dict[str, Any]:
    """The listing of a ring; participations are shares within one diameter, displacements magnitudes."""
    directions, met = _directions(scene), {ring.meets(one.harmonic) for one in scene.forces}
    motion = {name: np.abs(ring.shapes @ direction) for name, direction in directions.items()}
    order = np.lexsort((ring.frequency, ring.added, ring.diameter))
    shares: dict[str, dict[int, float | None]] = {name: {} for name in motion}
    for name, along in motion.items():
        for number in set(ring.diameter.tolist()):
            which = np.flatnonzero(ring.diameter == number)
            part = _shares(ring.frequency[which], along[which])
            for place, i in enumerate(which.tolist()):
                shares[name][i] = None if part is None else part[place]
    modes = [
        {
            "mode": number + 1,
            "nodal_diameter": int(ring.diameter[i]),
            "met": int(ring.diameter[i]) in met,
            "kind": FLEXIBILITY if ring.added[i] else "mode" if ring.frequency[i] else "rigid body",
            "frequency": float(ring.frequency[i] / UNIT[scene.frequency_unit]),
            "damping": float(ring.damping[i]),
            "mass": 1.0,
            "participation": {name: share[i] for name, share in shares.items()},
            "displacement": {name: float(along[i]) for name, along in motion.items()},
        }
        for number, i in enumerate(order.tolist())
    ]
    size = np.abs(ring.shapes)
    idle = [
        n for n, d in directions.items() if (motion[n] <= TOLERANCES.displacement * (size @ np.abs(d))).all()
    ]
    return {
        "scene": scene.name,
        "title": scene.title,
        "frequency_unit": scene.frequency_unit,
        "modes": modes,
        "normalisation": "every modal mass is 1 for each sector",
        "read": _read(scene, ring.frequency[~ring.added]),
        "notes": list(scene.notes),
        "warnings": [f"{name}: no mode moves along it" for name in idle],
    }


def _read(scene: Scene, frequency: FloatArray) -> list[str]:
    """Sentences on the structure as read: matrices, rigid-body modes, frequencies in both units.

    They include a warning on a likely unit mistake.
    """
    elastic = np.sort(frequency[frequency > 0.0])
    rigid = int((frequency == 0.0).sum())
    bodies = {0: "no rigid-body mode", 1: "1 rigid-body mode"}.get(rigid, f"{rigid} rigid-body modes")
    if not elastic.size:
        return [*scene.read, f"{bodies}, and no other"]
    low, high = elastic[0], elastic[-1]
    in_hertz = f"{low / (2.0 * np.pi):.6g} to {high / (2.0 * np.pi):.6g} Hz"
    said = [*scene.read, f"{bodies}; others from {in_hertz}, which are {low:.6g} to {high:.6g} rad/s"]
    if scene.ring is None and scene.contacts and not scene.of_matrices:  # for matrices notes has it
        said += [one.removeprefix("structure: ") for one in notes_of_modes(scene)]
    if doubt := resonance_doubt(scene):
        said.append(doubt)
    return said


def _slip_of_units(
    opened: FloatArray, stuck: FloatArray, ends: tuple[float, float], unit: str, imperial: bool = False
) -> str:
    """The common unit mistake without which the range [rad/s] would contain the lowest resonance; or ''."""
    hertz = 2.0 * np.pi
    slips = {
        1.0 / hertz: _IN_HERTZ,
        hertz: 'the range would hold modes if its numbers were in rad/s: frequency_unit = "rad/s"',
    } | (IMPERIAL_SLIPS if imperial else METRIC_SLIPS)
    del slips[hertz if unit == "rad/s" else 1.0 / hertz]  # the scene already uses this unit
    return next(
        (text for factor, text in slips.items() if _resonance_within(opened * factor, stuck * factor, ends)),
        "",
    )


def _directions(scene: Scene) -> dict[str, FloatArray]:
    """Directions of contacts and forces by their key paths."""
    found = {}
    for contact in scene.contacts:
        if contact.second is None:
            found[f"contact.{contact.name}.tangential"] = contact.tangential
        else:
            found[f"contact.{contact.name}.tangential.0"] = contact.tangential
            found[f"contact.{contact.name}.tangential.1"] = contact.second
        found[f"contact.{contact.name}.normal"] = contact.normal
    for number, force in enumerate(scene.forces):
        found[f"force.{_name(scene, force) or number}"] = force.direction
    return found


def _name(scene: Scene, force: Force) -> str:
    """The degree of freedom of a force on a single one, if no other force acts there; else ''."""
    at = np.flatnonzero(force.direction)
    alone = sum(np.array_equal(force.direction, one.direction) for one in scene.forces) == 1
    return scene.modal.dofs[at[0]].strip("\0") if at.size == 1 and alone else ""


def _shares(frequency: FloatArray, along: FloatArray) -> list[float] | None:
    """Share of each mode in the static flexibility along a direction; None if it is infinite."""
    if (frequency == 0.0)[np.abs(along) > TOLERANCES.displacement * np.abs(along).max(initial=0.0)].any():
        return None
    flexibility = np.divide(along, frequency, out=np.zeros_like(along), where=frequency > 0.0) ** 2
    total = float(flexibility.sum())
    return [float(one) / total if total else 0.0 for one in flexibility]


def _normalisation(scene: Scene) -> str:
    mass = scene.modal.mass
    largest = np.abs(scene.modal.shapes).max(axis=1, initial=0.0)  # there may be no degrees of freedom
    of_one = largest.size > 1 and np.allclose(largest, 1.0, rtol=1e-6, atol=0.0)
    if (mass == 1.0).all():
        doubt = "taken as mass-normalised, but the largest value of each is 1"
        return doubt if of_one else "mass-normalised: every modal mass is 1"
    scale = "largest value 1; " if of_one else ""
    return f"{scale}modal masses from {mass.min():.6g} to {mass.max():.6g}"


def _warnings(scene: Scene, directions: dict[str, FloatArray], motion: dict[str, FloatArray]) -> list[str]:
    said = []
    for name, direction in directions.items():
        size = (np.abs(scene.modal.shapes) @ np.abs(direction)) / np.sqrt(scene.modal.mass)
        if (np.abs(motion[name]) <= TOLERANCES.displacement * size).all():
            said.append(f"{name}: no mode moves along it")
    if scene.has_range:
        said += _of_range(scene)
    return said


def _of_range(scene: Scene) -> list[str]:
    """Warnings on the frequency range."""
    said, modal, unit = [], scene.modal, scene.frequency_unit
    ranges = _ranges_of_forces(scene)
    inside = np.any([(modal.frequency > low) & (modal.frequency < high) for low, high in ranges], axis=0)
    if not _resonance_within(*_modes_open_and_stuck(scene), *ranges):
        said.append("no resonance is within the range, with contacts open, stuck, or between")
    undamped = np.flatnonzero(inside & (modal.damping == 0.0)) + 1
    if undamped.size:
        said.append(f"within the range, without damping: mode {', '.join(map(str, undamped[:10]))}")
    if lacks_modes_above(scene, MESSAGES.range_above * ranges[-1][1]):
        where = f"{modal.frequency.max() / UNIT[unit]:.6g} {unit}"
        said.append(f"the highest mode is at {where}: a contact lacks the flexibility of all modes above")
    return said
