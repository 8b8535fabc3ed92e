"""The draft of a scene: the input it is built from, so that it can be rebuilt with other numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.ring import Ring
from fcm.model.scene import Address, Force, Modal, Scene
from fcm.scene.address import LEVEL, Addresses, overlap, replaced
from fcm.scene.cyclic import ring_of
from fcm.scene.errors import Mistakes, quoted
from fcm.scene.excitation import DIRECTIONS, base_force, load_of
from fcm.scene.mistuning import mistuned_modes, standing_drafts
from fcm.scene.modal import modal_of
from fcm.scene.parts import contact_of, force_of
from fcm.scene.rules import RULES, Rule
from fcm.scene.section import Parts
from fcm.scene.sweep import SweptKey, combinations, field_of
from fcm.units import UNIT


class Draft(Frozen):
    """The parts of a scene as read, and its swept keys; all curves of a scene share one draft."""

    parts: Parts
    swept: tuple[SweptKey, ...]

    def curve(
        self, scene: Scene, values: Mapping[str, float], more: Mapping[Address, float] = {}, fix: bool = False
    ) -> Scene:
        """The scene with swept values, then numbers (more) at addresses; unchanged parts are shared.

        fix: whether the new scene's draft contains these values, without a sweep.
        """
        parts, draft = self.parts, self._with(values, more)
        changed: dict[str, Any] = {"draft": Draft(draft, ())} if fix else {}
        if draft["modal"] is not parts["modal"] or _mistuned_otherwise(draft, parts):
            changed["modal"], changed["ring"] = modes_of(draft, scene.frequency_unit)
        elif scene.ring is not None and draft["cyclic"] is not parts["cyclic"]:
            order = int(draft["cyclic"][0]["engine_order"])
            changed["ring"] = replace(scene.ring, engine_order=order)
        if draft["contact"] is not parts["contact"]:
            changed["contacts"] = tuple(map(contact_of, draft["contact"]))
        if any(draft.get(key) is not parts.get(key) for key in ("force", "base", "whole")):
            changed["forces"] = forces_of(draft)
        if draft["load"] is not parts["load"]:
            changed["loads"] = tuple(map(load_of, draft["load"]))
        return replace(scene, parameters=dict(values), **changed).started()

    def values(self, scene: Scene, addresses: tuple[Address, ...]) -> list[Any]:
        """Values at addresses in a curve of the scene."""
        return [_at(self.fixed(scene).parts, address) for address in addresses]

    def fixed(self, scene: Scene) -> Draft:
        """The draft of one curve, with its swept values written into it."""
        return Draft(self._with(scene.parameters, {}), ())

    def _with(self, values: Mapping[str, float], more: Mapping[Address, float]) -> Parts:
        """The parts with swept values, then numbers at addresses."""
        parts = self.parts
        for one in self.swept:
            for address in one.addresses:
                parts = replaced(parts, address, values[one.key])
        for address, value in more.items():
            parts = replaced(parts, address, value)
        return parts

    def present(self, number: Number) -> list[tuple[float, float]]:
        """Value and weight at each address of a number, before any sweep."""
        weights = number.weights or (1.0,) * len(number.addresses)
        return [
            (float(value), weight)
            for address, weight in zip(number.addresses, weights, strict=True)
            for value in np.ravel(_at(self.parts, address))
        ]

    def at(self, used: npt.NDArray[np.bool_]) -> Draft:
        """The draft restricted to some of the degrees of freedom."""
        modal = self.parts["modal"]
        shapes = modal["shapes"]  # for a sector of a ring only at its own dofs, which come first
        names = tuple(name for name, one in zip(modal["dofs"], used, strict=True) if one)
        parts = self.parts | {
            "modal": modal
            | {"dofs": type(modal["dofs"])(names), "shapes": shapes[:, used[: shapes.shape[1]]]}
        }
        for table, keys in DIRECTIONS.items():
            parts[table] = [
                draft | {key: draft[key][used] for key in keys if key in draft} for draft in parts[table]
            ]
        return Draft(parts, self.swept)


class Number(Frozen):
    """A number of a scene by its key path, such as "contact.shroud.n_0"; a group or a * stands for several.

    The force level is a number too: the value at each address is then the level times a weight.
    """

    key: str
    addresses: tuple[Address, ...]
    weights: tuple[float, ...] = ()  # by address; all 1 if empty

    @property
    def rule(self) -> Rule:
        """The rule that a value of the number must obey."""
        return RULES[field_of(self.addresses[0])]

    def value(self, scene: Scene) -> float:
        """Its value in a scene; NaN if it stands for several that differ."""
        values = {value / weight for _, value, weight in self.each(scene)}
        return values.pop() if len(values) == 1 else np.nan

    def each(self, scene: Scene) -> list[tuple[Number, float, float]]:
        """The single numbers that this one stands for, with their values and weights."""
        found = []
        values = _draft(scene).values(scene, self.addresses)
        weights = self.weights or (1.0,) * len(self.addresses)
        for address, value, weight in zip(self.addresses, values, weights, strict=True):
            places = [(*address, i) for i in range(len(value))] if np.ndim(value) else [address]
            found += [
                (Number(self.key, (place,)), float(one), weight)
                for place, one in zip(places, np.ravel(value), strict=True)
            ]
        return found

    def values(self, value: float) -> dict[Address, float]:
        """The value at each address for a given value of the number."""
        weights = self.weights or (1.0,) * len(self.addresses)
        return {address: value * weight for address, weight in zip(self.addresses, weights, strict=True)}

    def put(self, scene: Scene, value: float) -> Scene:
        """The scene with another value of the number."""
        return _draft(scene).curve(scene, scene.parameters, self.values(value))

    def freed(self, scene: Scene) -> Scene:
        """The scene without a sweep of this number, if there is one."""
        draft = _draft(scene)
        swept = tuple(one for one in draft.swept if not set(one.addresses) <= set(self.addresses))
        if len(swept) == len(draft.swept):
            return scene
        free = Draft(draft.parts, swept)
        curves = tuple(free.curve(scene, values) for values in combinations(list(swept)))
        curves = tuple(replace(curve, draft=free, curves=()) for curve in curves)
        return replace(scene, draft=free, curves=curves)


def number_of(scene: Scene, key: str) -> Number:
    """The number of a scene with a key path, as in [sweep], or "level".

    Raises
    ------
    SceneError
        If there is no such number.

    Examples
    --------
    >>> import fcm
    >>> scene = fcm.load_scene("yang1998-n5")
    >>> preload = number_of(scene, "contact.shroud.n_0")
    >>> preload.value(scene), preload.put(scene, 7.0).contacts[0].n_0
    (5.0, 7.0)
    """
    mistakes = Mistakes(scene.name)
    number = number_in(_draft(scene), key, quoted(key), mistakes)
    mistakes.raise_if_any()
    assert number is not None
    return number


def number_in(draft: Draft, key: str, path: str, mistakes: Mistakes) -> Number | None:
    """The number of a draft with a key path; None after a mistake, which is noted."""
    if key == LEVEL:
        return _level(draft.parts, path, mistakes)
    addresses = Addresses(draft.parts).find(key, path, mistakes)
    for one in draft.swept if addresses else ():
        shared = any(overlap(mine, its) for mine in addresses for its in one.addresses)
        if shared and not set(one.addresses) <= set(addresses):
            mistakes.add(path, f"sets some of the numbers that {quoted(one.key)} of [sweep] sets")
            addresses = ()
    return Number(key, addresses) if addresses else None


AT_REST = "at 0 nothing moves"  # said of a number that is the only force


def only_force(parts: Parts, number: Number) -> bool:
    """Whether only this number excites the structure: it sets all amplitudes of forces and of the base."""
    return all(address in number.addresses for address, _ in _amplitudes(parts))


def _amplitudes(parts: Parts) -> list[tuple[Address, float]]:
    """Address and value of each amplitude of a force, and of the base's motion, that is not 0."""
    keys = (("force", "amplitude"), ("base", "acceleration"))
    found = [((kind, i, key), draft[key]) for kind, key in keys for i, draft in enumerate(parts[kind])]
    return [(address, value) for address, value in found if value]


def _level(parts: Parts, path: str, mistakes: Mistakes) -> Number | None:
    """The force level as a number: a common factor on all amplitudes of forces and of the base."""
    found = _amplitudes(parts)
    if not found:
        mistakes.add(path, "no force has an amplitude that a level could multiply")
        return None
    addresses, weights = zip(*found, strict=True)
    return Number(LEVEL, addresses, weights)


def modes_of(parts: Parts, unit: str) -> tuple[Modal, Ring | None]:
    """The modes, and the ring if the scene is a sector of one; the modes are then those of the mean."""
    if parts["cyclic"]:
        return ring_of(parts["modal"], parts["cyclic"][0], UNIT[unit])
    if parts.get("whole"):
        return modal_of(mistuned_modes(parts["modal"], parts["whole"][0], UNIT[unit]), unit), None
    return modal_of(parts["modal"], unit), None


def forces_of(parts: Parts) -> tuple[Force, ...]:
    """The harmonic forces, and the inertial forces of a moving base."""
    of_base = (base_force(draft, parts["modal"]["dofs"]) for draft in parts["base"])
    own = parts["force"]
    if parts.get("whole"):
        own = [one for draft in own for one in standing_drafts(draft, parts["whole"][0])]
    return (*map(force_of, own), *of_base)


def _mistuned_otherwise(draft: Parts, parts: Parts) -> bool:
    """Whether two drafts of a mistuned ring have different factors of the blades."""
    if draft.get("whole") is parts.get("whole"):
        return False
    one, other = draft["whole"][0], parts["whole"][0]
    return any(one[key] != other[key] for key in ("draw", "scale"))


def _draft(scene: Scene) -> Draft:
    if not isinstance(scene.draft, Draft):
        raise ValueError(f"the scene {quoted(scene.name)} was not read from a file or a dict")
    return scene.draft


def _at(tree: Any, address: Address) -> Any:
    for step in address:
        tree = tree[step]
    return tree
