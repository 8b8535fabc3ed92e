"""Omits parts of a scene that need not be computed, with a sentence on each: what, why, and its effect.

Two omissions have no effect at all: modes that neither a force nor a contact moves, and contacts that carry
no load. Modes far above the range are replaced by a few (`static_modes`) if that saves time. The change is
measured afterwards with all modes; if it exceeds the tolerance, they are restored.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fcm.contact.limits import BoolArray, FloatArray
from fcm.frozen import Frozen
from fcm.model.scene import Contact, Modal, Scene, has_friction
from fcm.reduction.options import REDUCTION, ReductionOptions
from fcm.reduction.sentences import named
from fcm.reduction.static_modes import with_static_modes
from fcm.scene.errors import counted


class ReducedScenes(Frozen):
    """The scenes of a sweep, with and without their negligible parts."""

    full: tuple[Scene, ...]
    exact: tuple[Scene, ...]  # without parts that have no effect at all
    curves: tuple[Scene, ...]  # the scenes to trace
    contacts: tuple[int, ...]  # indices of the contacts that are traced, with unknowns of their own
    sentences: tuple[str, ...]  # on parts omitted without any effect
    above: float | None = None  # [rad/s] modes above this frequency are replaced by a few
    whole: bool = False  # whether nothing may be omitted

    @property
    def idle_table(self) -> bool:
        """Whether no contact needs friction coefficients."""
        planar = any(s.planar for s in self.curves)
        return planar or not (self.whole or any(has_friction(c) for s in self.curves for c in s.contacts))


def unreduced(curves: tuple[Scene, ...]) -> ReducedScenes:
    """The scenes with nothing omitted."""
    return ReducedScenes(curves, curves, curves, tuple(range(len(curves[0].contacts))), (), whole=True)


def without_negligible_parts(
    curves: tuple[Scene, ...], tolerance: float, highest: int = 1, options: ReductionOptions = REDUCTION
) -> ReducedScenes:
    """The scenes without negligible parts; with tolerance 0 only parts without any effect are omitted.

    highest : the greatest harmonic of the response; replaced modes are far above this harmonic of the range.
    """
    needed = tuple(i for i in range(len(curves[0].contacts)) if any(_carries(s, i) for s in curves))
    lighter = tuple(_with_contacts(s, needed) for s in curves)
    lighter, said = _without_still_modes(lighter)
    sentences = (*_idle_contacts(curves[0], needed), *said)
    found = _static(ReducedScenes(curves, lighter, lighter, needed, sentences), tolerance, highest, options)
    return replace(found, sentences=(*found.sentences, *_parts_of_contacts(found)))


def leave_out_modes(
    curves: tuple[Scene, ...], tolerance: float, highest: int, options: ReductionOptions = REDUCTION
) -> ReducedScenes:
    """The scenes without negligible modes, but with all contacts; arguments as `without_negligible_parts`."""
    lighter, said = _without_still_modes(curves)
    every = tuple(range(len(curves[0].contacts)))
    return _static(ReducedScenes(curves, lighter, lighter, every, tuple(said)), tolerance, highest, options)


def _without_still_modes(curves: tuple[Scene, ...]) -> tuple[tuple[Scene, ...], list[str]]:
    """The scenes without modes that stay at rest, and a sentence on these."""
    moved = np.logical_or.reduce([_moved(s) for s in _different(curves)])
    if not moved.any() or moved.all():
        return curves, []
    lighter = _with_modals(curves, {id(s.modal): _some_modes(s.modal, moved) for s in curves})
    still = int((~moved).sum())
    what, them = f"{counted(still, 'mode')} of {moved.size}", "it" if still == 1 else "them"
    return lighter, [f"{what}: neither a force nor a contact moves {them} (no effect)"]


def _static(
    lighter: ReducedScenes, tolerance: float, highest: int, options: ReductionOptions
) -> ReducedScenes:
    """Replaces modes far above the range, if all curves have the same structure."""
    curves = lighter.curves
    if len(_different(curves)) > 1:
        return lighter
    found = with_static_modes(_stiffest(curves), tolerance, highest, options)
    if found is None:
        return lighter
    modal, above = found
    return replace(lighter, curves=tuple(replace(s, modal=modal, draft=None) for s in curves), above=above)


def _stiffest(curves: tuple[Scene, ...]) -> Scene:
    """The first scene with each contact's greatest stiffnesses among all scenes."""
    contacts = []
    for of_one in zip(*(s.contacts for s in curves), strict=True):
        k_u, k_v = max(c.k_u for c in of_one), max(c.k_v for c in of_one)
        contacts.append(replace(of_one[0], k_u=k_u, k_v=k_v))
    return replace(curves[0], contacts=tuple(contacts))


def _different(curves: tuple[Scene, ...]) -> list[Scene]:
    """One scene for each distinct combination of modes and directions of contacts and forces."""

    def key(s: Scene) -> tuple[int | bytes, ...]:
        along = [d.tobytes() for d in s.directions_of_contacts()]
        return (id(s.modal), *along, *(direction.tobytes() for direction in s.pushes()))

    return list({key(s): s for s in curves}.values())


def _reaches(modal: Modal, direction: FloatArray) -> BoolArray:
    """Whether each mode moves along a direction (dof,), or directions (dof, direction), beyond rounding."""
    size = np.abs(modal.shapes) @ np.abs(direction)
    reaches: BoolArray = np.abs(modal.shapes @ direction) > REDUCTION.rounding * size
    return reaches


def _carries(scene: Scene, number: int) -> bool:
    """Whether a contact can exert any force."""
    contact: Contact = scene.contacts[number]
    normal = _springs_back(scene, contact)
    friction = has_friction(contact) and (normal or contact.n_0 > 0.0)
    along = contact.directions[:-1]
    return normal or (friction and any(bool(_reaches(scene.modal, one).any()) for one in along))


def _springs_back(scene: Scene, contact: Contact) -> bool:
    """Whether a contact's normal load can change."""
    return contact.k_v > 0.0 and bool(_reaches(scene.modal, contact.normal).any())


def _moved(scene: Scene) -> BoolArray:
    """Mask of the modes that a force or a contact moves."""
    along = [one for c in scene.contacts if c.mu > 0.0 and c.k_u > 0.0 for one in c.directions[:-1]]
    along += [c.normal for c in scene.contacts if c.k_v > 0.0]
    along += scene.pushes()
    directions = np.reshape(along, (len(along), scene.modal.shapes.shape[1])).T
    return np.asarray(_reaches(scene.modal, directions).any(axis=1))


def _with_contacts(scene: Scene, needed: tuple[int, ...]) -> Scene:
    """The scene with the needed contacts; k_v becomes 0 for those whose normal load cannot change."""
    steady = [c.k_v > 0.0 and not _springs_back(scene, c) for c in scene.contacts]
    if len(needed) == len(scene.contacts) and not any(steady):
        return scene
    contacts = [replace(c, k_v=0.0) if idle else c for c, idle in zip(scene.contacts, steady, strict=True)]
    return replace(scene, contacts=tuple(contacts[i] for i in needed), draft=None)


def _with_modals(curves: tuple[Scene, ...], modals: dict[int, Modal]) -> tuple[Scene, ...]:
    return tuple(replace(s, modal=modals[id(s.modal)], draft=None) for s in curves)


def _some_modes(modal: Modal, which: BoolArray) -> Modal:
    return Modal(
        modal.dofs, modal.mass[which], modal.frequency[which], modal.damping[which], modal.shapes[which]
    )


def _idle_contacts(scene: Scene, needed: tuple[int, ...]) -> list[str]:
    why = "without friction or stiffness, or nothing moves it: it carries nothing (no effect)"
    idle = [i for i in range(len(scene.contacts)) if i not in needed]
    return [f"contact {scene.contacts[i].name or i}: {why}" for i in idle]


def _parts_of_contacts(lighter: ReducedScenes) -> list[str]:
    """Sentences on traced contacts whose friction or normal force is not computed."""
    contacts, said = lighter.full[0].contacts, []
    smooth = [i for i in lighter.contacts if not any(has_friction(s.contacts[i]) for s in lighter.full)]
    if smooth:
        said.append(f"the friction of {named(contacts, smooth)}: mu or k_u is 0 (no effect)")
    steady = [i for i in lighter.contacts if not any(_springs_back(s, s.contacts[i]) for s in lighter.full)]
    if steady:
        why = "k_v is 0, or nothing moves along it: the load is the preload"
        said.append(f"the normal force of {named(contacts, steady)}: {why} (no effect)")
    return said
