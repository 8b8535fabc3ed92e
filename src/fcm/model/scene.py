"""The checked scene: modal structure, contacts, forces, frequency range and the curves to trace."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from fcm.contact.contact_law import ContactLaw
from fcm.frozen import Frozen
from fcm.model.ring import Ring, with_own
from fcm.quoting import quoted
from fcm.units import UNIT

if TYPE_CHECKING:
    from pathlib import Path

    from fcm.model.interface import Interface


FloatArray = npt.NDArray[np.float64]
Address = tuple[str | int, ...]  # of a number of a scene, or of a vector all of whose entries are set
NO_RANGE = (np.nan, np.nan)  # frequency range of a scene with nothing to trace


class Modal(Frozen):
    """Modes of the structure without contacts: m_i (q_i'' + 2 zeta_i w_i q_i' + w_i^2 q_i) = Phi_i^T F."""

    dofs: tuple[str, ...]
    mass: FloatArray  # (mode,)
    frequency: FloatArray  # (mode,) undamped, angular [rad/s]
    damping: FloatArray  # (mode,) ratio [-]
    shapes: FloatArray  # (mode, dof)
    added: int = 0  # number of modes at the end that stand for the flexibility of omitted modes
    complete: bool = False  # whether it is known that the structure has no further modes

    def at(self, used: npt.NDArray[np.bool_]) -> Modal:
        """The modes restricted to some of the degrees of freedom."""
        dofs = tuple(name for name, one in zip(self.dofs, used, strict=True) if one)
        return replace(self, dofs=dofs, shapes=self.shapes[:, used])


class Contact(Frozen):
    """A contact; its relative displacements are ``u = tangential @ x`` and ``v = normal @ x``.

    A planar contact also slides along ``second @ x``.
    """

    name: str
    tangential: FloatArray  # (dof,)
    normal: FloatArray  # (dof,)
    mu: float
    k_u: float
    k_v: float
    n_0: float  # preload, negative for a gap
    second: FloatArray | None = None  # (dof,) of a planar contact, at right angles to tangential
    law: ContactLaw | None = None  # a user's law; mu, k_u, k_v and n_0 then only approximate it
    # displacements along the sliding directions at which the friction force is zero, from [start]
    slider: tuple[float, ...] = ()

    @property
    def directions(self) -> tuple[FloatArray, ...]:
        """Directions of the contact: one or two sliding directions, then the normal."""
        if self.second is None:
            return self.tangential, self.normal
        return self.tangential, self.second, self.normal

    def at(self, used: npt.NDArray[np.bool_]) -> Contact:
        """The contact restricted to some of the degrees of freedom."""
        second = None if self.second is None else self.second[used]
        return replace(self, tangential=self.tangential[used], second=second, normal=self.normal[used])


def has_friction(contact: Contact) -> bool:
    """Whether the contact can exert friction; otherwise it only opens and closes."""
    return contact.mu > 0.0 and contact.k_u > 0.0


class Force(Frozen):
    """External force amplitude * omega^power * sin(harmonic omega t + phase) on ``direction @ x``."""

    direction: FloatArray  # (dof,)
    amplitude: float
    phase: float  # [rad]
    power: int = 0  # 2 for a force proportional to omega^2, as from unbalance; omega in rad/s
    harmonic: int = 1


class Load(Frozen):
    """External static force on ``direction @ x``."""

    direction: FloatArray  # (dof,)
    force: float


class Phase(Frozen):
    """One phase of a schedule: a constant frequency for a number of cycles."""

    frequency: float  # [rad/s]
    cycles: float


class Start(Frozen):
    """The initial state of a time simulation; its friction also holds for contacts that never slip."""

    displacement: FloatArray  # (mode,) modal
    velocity: FloatArray  # (mode,) modal
    friction: FloatArray  # (contact,) friction forces
    angle: float  # omega t of the external forces [rad]
    second: FloatArray | None = None  # (contact,) along second directions, if a contact is planar

    @property
    def forces(self) -> tuple[FloatArray, ...]:
        """Friction forces (contact,), one array for each sliding direction."""
        return (self.friction,) if self.second is None else (self.friction, self.second)

    @property
    def friction_size(self) -> FloatArray:
        """Magnitudes (contact,) of the friction forces."""
        found: FloatArray = np.linalg.norm(self.forces, axis=0)
        return found


class HeldContact(Frozen):
    """A contact that is not computed because it always sticks or is always open."""

    place: int  # index among all contacts of the scene
    contact: Contact
    open: bool
    rest: float = 0.0  # the constant slip motion w of a sticking contact


class Aim(Frozen):
    """Quantity to minimise: the peak of a degree of freedom; with ends, its maximum on the range."""

    dof: str
    ends: bool = False


class Optimum(Frozen):
    """A minimax problem: the numbers to vary so that the greatest of the aims becomes least."""

    vary: tuple[str, ...]
    bounds: tuple[tuple[float, float], ...]  # of each number
    minimise: tuple[Aim, ...]


class Measured(Frozen):
    """Measured points to fit to: points of a backbone if damping is given, otherwise of a forced response.

    The errors are relative, and None where the scene states none; see `fcm.fit.options`.
    """

    file: str
    dof: str  # empty for a backbone whose amplitude is modal
    frequency: FloatArray  # (point,) [rad/s]
    amplitude: FloatArray  # (point,) of the quantity
    weight: FloatArray  # (point,) weight of the squared residual
    level: FloatArray  # (point,) factor on the scene's forces
    phase: FloatArray | None = None  # (point,) [rad] of amplitude * sin(omega t + phase)
    damping: FloatArray | None = None  # (point,) ratios
    quantity: str = "displacement"
    mode: int = 1  # number of the mode of a backbone
    amplitude_error: float | None = None
    frequency_error: float | None = None
    damping_error: float | None = None
    estimated: FloatArray | None = None  # (point, component) errors, from the residuals of a first fit

    @property
    def points(self) -> int:
        """Number of measured points."""
        return self.frequency.size

    @property
    def components(self) -> int:
        """Number of residuals of each measured point."""
        return 3 if self.phase is not None else 2

    @property
    def values(self) -> int:
        """Number of measured values; the frequencies of a forced response were set, and do not count."""
        return self.points * (self.components if self.damping is not None else self.components - 1)


class Fit(Frozen):
    """Numbers that are fitted to measured data."""

    vary: tuple[str, ...]
    bounds: tuple[tuple[float, float] | None, ...]  # of each number
    data: tuple[Measured, ...]
    starts: int | None = None  # greatest number of starts; None for the default


class SourceKey(Protocol):
    """Protocol of a swept key; drawn tells whether its values are random draws."""

    @property
    def key(self) -> str: ...

    @property
    def drawn(self) -> bool: ...


class Source(Protocol):
    """Protocol of the input that a scene was built from, for changes of its numbers; `fcm.scene.draft`."""

    @property
    def parts(self) -> dict[str, Any]: ...

    @property
    def swept(self) -> tuple[SourceKey, ...]: ...

    def curve(
        self, scene: Scene, values: Mapping[str, float], more: Mapping[Address, float] = {}, fix: bool = False
    ) -> Scene:
        """The scene with swept values, then numbers at addresses; fix: keep them in the new source."""

    def fixed(self, scene: Scene) -> Source:
        """The source of one curve of the sweep, with its swept values written into it."""

    def at(self, used: npt.NDArray[np.bool_]) -> Source:
        """The source restricted to some of the degrees of freedom."""


class Scene(Frozen):
    """Everything that a calculation needs; immutable, with angular frequencies [rad/s]."""

    title: str
    modal: Modal
    contacts: tuple[Contact, ...]
    forces: tuple[Force, ...]
    frequency_range: tuple[float, float]  # [rad/s], NO_RANGE if nothing is traced
    max_step: float  # longest step along a curve, relative to the curve's own extent
    harmonics: tuple[int, ...] | None = None  # of harmonic balance, if the scene sets them
    accuracy: float | None = None  # from which harmonics are chosen, if the scene sets it
    frequency_unit: str = "rad/s"  # the unit of the scene's file and of results: "rad/s" or "Hz"
    schedule: tuple[Phase, ...] = ()
    start: Start | None = None  # initial state of the schedule, friction of stuck contacts; None for rest
    parameters: dict[str, float] = field(default_factory=dict)  # the swept values of this curve
    curves: tuple[Scene, ...] = ()  # one for each combination of swept values; empty without a sweep
    name: str = ""  # file or bundled name, for messages
    reported: tuple[str, ...] = ()  # those of modal.dofs in results; the others carry loads and contacts
    output: tuple[str, ...] = ()  # those of reported that the scene requests; empty if it does not say
    loads: tuple[Load, ...] = ()  # static loads
    units: tuple[str, str] = ("", "")  # of length and force, for labels; empty where they are not given
    ring: Ring | None = None  # ring of which this is one sector; modal then holds the modes of the mean
    notes: tuple[str, ...] = ()  # remarks on how the scene was read, for readers of a result
    read: tuple[str, ...] = ()  # what was read as the matrices of [structure], for `fcm plot modes`
    optimum: Optimum | None = None
    fit: Fit | None = None
    of_matrices: bool = False  # whether the modes come from [structure]; otherwise from [modal]
    exchanged: float = 0.0  # [rad/s] of a mode if K and M are swapped; see `scene.reduction.exchanged`
    files: tuple[Path, ...] = field(default=(), compare=False)  # files that were read
    interfaces: tuple[Interface, ...] = field(default=(), repr=False, compare=False)  # places of node pairs
    held: tuple[HeldContact, ...] = ()  # contacts replaced by springs or by nothing; they are not in contacts
    draft: Source | None = field(default=None, repr=False, compare=False)  # the input it was built from
    tuned: Scene | None = field(default=None, repr=False, compare=False)  # a sector of the tuned ring

    def __repr__(self) -> str:
        """Name and sizes, without the arrays.

        >>> import fcm
        >>> fcm.load_scene("yang1998")
        Scene('yang1998': 2 degrees of freedom, 1 contact, 2 forces, 10 curves from 0.7 to 1.7 rad/s)
        """
        dofs, curves = len(self.reported or self.modal.dofs), max(len(self.curves), 1)
        sizes = [
            f"{dofs} degree{'s' * (dofs != 1)} of freedom",
            f"{len(self.contacts)} contact{'s' * (len(self.contacts) != 1)}",
            f"{len(self.forces)} force{'s' * (len(self.forces) != 1)}",
            f"{curves} curve{'s' * (curves != 1)}",
        ]
        low, high = (f"{end / UNIT[self.frequency_unit]:.6g}" for end in self.frequency_range)
        between = f" from {low} to {high} {self.frequency_unit}" if self.has_range else ""
        return f"Scene({self.name or self.title!r}: {', '.join(sizes)}{between})"

    @property
    def has_range(self) -> bool:
        """Whether there is a range of frequencies to trace."""
        return not np.isnan(self.frequency_range[0])

    @property
    def drawn(self) -> tuple[str, ...]:
        """The swept keys whose values are random draws."""
        return () if self.draft is None else tuple(one.key for one in self.draft.swept if one.drawn)

    def reports(self, dof: str) -> bool:
        """Whether results contain a degree of freedom; others only carry loads and contacts."""
        return not self.reported or dof in self.reported

    def asks_for(self, dof: str) -> bool:
        """Whether the accuracy applies to a degree of freedom: one of `output`, or if empty, of results."""
        return dof in self.output if self.output else self.reports(dof)

    def with_step(self, max_step: float) -> Scene:
        """The scene with another longest step along all its curves."""
        curves = tuple(replace(curve, max_step=max_step) for curve in self.curves)
        return replace(self, max_step=max_step, curves=curves)

    def holding(self, held: Sequence[HeldContact]) -> Scene:
        """The scene with some of its contacts held, that is, not computed."""
        places = {one.place for one in held}
        contacts = tuple(one for i, one in enumerate(self.contacts) if i not in places)
        return replace(self, contacts=contacts, held=tuple(held), draft=None)

    @property
    def with_own_laws(self) -> bool:
        """Whether a contact of any curve has a user's contact law."""
        return any(one.law is not None for curve in self.each_curve() for one in curve.contacts)

    def with_laws(self, laws: Mapping[str, ContactLaw]) -> Scene:
        """The scene with the user's contact laws, a dict by names of contacts.

        The name of a [[contact]] with nodes stands for the contacts of all its pairs. A law under the name of
        a single pair takes precedence.

        The search for solutions still starts from the contact's mu, k_u, k_v and n_0. They give an
        approximate stiffness, and the force level beyond which the contact may slip or open.

        Raises
        ------
        ValueError
            If no contact has a name, if numbers of such a contact are swept (its law does not have them), or
            if the scene is a sector of a ring.

        Examples
        --------
        >>> import fcm
        >>> class Spring(fcm.ContactLaw):
        ...     def forces(self, x, dx):
        ...         return 2.0 * x, 2.0 * dx
        >>> fcm.load_scene("yang1998-n5").with_laws({"shroud": Spring()}).with_own_laws
        True
        """
        groups = self._groups()
        swept = [key for curve in self.curves for key in curve.parameters]
        of_groups, of_contacts = dict[str, ContactLaw](), dict[str, ContactLaw]()
        for name, law in laws.items():
            pairs = [one for one, group in groups.items() if group == name]
            own = [name] if name in groups else pairs
            if not own:
                there = dict.fromkeys(one for pair in groups.items() for one in reversed(pair) if one)
                raise ValueError(
                    f"no contact is called {quoted(name)}; there are {', '.join(map(quoted, there))}"
                )
            if not isinstance(law, ContactLaw):
                raise ValueError(
                    f"the law of {quoted(name)} is a {type(law).__name__}, and no fcm.ContactLaw"
                )
            called = {"*", name, *own, *(groups[one] for one in own)} - {""}
            if any(key.startswith(tuple(f"contact.{one}." for one in called)) for key in swept):
                raise ValueError(
                    f"numbers of the contact {quoted(name)} are swept, which its own law has not"
                )
            (of_contacts if name in groups else of_groups).update(dict.fromkeys(own, law))
        laws = of_groups | of_contacts
        if self.ring is not None and laws:
            raise ValueError("a contact of a ring of sectors cannot have a law of its own")
        return replace(self._with_laws(laws), curves=tuple(one._with_laws(laws) for one in self.curves))

    def _groups(self) -> dict[str, str]:
        """By contact, the name of the [[contact]] with nodes that it belongs to; empty for other contacts."""
        drafts = [] if self.draft is None else self.draft.parts["contact"]
        of_pairs = {one["name"]: one["group"] for one in drafts if "group" in one}
        return {one.name: of_pairs.get(one.name, "") for one in self.contacts}

    def _with_laws(self, laws: Mapping[str, ContactLaw]) -> Scene:
        for one in self.contacts:
            if one.name in laws and one.slider:
                raise ValueError(
                    f"the law of {quoted(one.name)} has no residual friction that [start] could set"
                )
        contacts = tuple(replace(one, law=laws.get(one.name, one.law)) for one in self.contacts)
        return replace(self, contacts=contacts)

    def started(self) -> Scene:
        """The scene with the sliders of its contacts set from [start].

        The friction force of [start] is k_u (u - slider), with u from the initial displacement.
        """
        start = self.start
        if start is None:
            return self
        displacement = self.modal.shapes.T @ start.displacement
        contacts = []
        for one, *friction in zip(self.contacts, *start.forces, strict=True):
            pairs = zip(one.directions[:-1], friction, strict=False)
            at = [float(way @ displacement) - f / one.k_u for way, f in pairs if one.k_u > 0.0]
            contacts.append(replace(one, slider=tuple(at) if any(at) else ()))
        return replace(self, contacts=tuple(contacts))

    def unstressed(self) -> Scene:
        """The scene with no initial friction: its contacts are unstressed at zero displacement."""
        return replace(self, contacts=tuple(replace(one, slider=()) for one in self.contacts))

    @cached_property
    def strained(self) -> bool:
        """Whether the structure is strained at rest, by static loads or by initial friction."""
        return bool(self.loads) or any(one.slider for one in self.contacts)

    def sliders(self) -> FloatArray:
        """Displacements (port,) along contact directions at which friction is zero; 0 along normals."""
        found = np.zeros((len(self.contacts), self.directions_of_contact))
        for row, one in zip(found, self.contacts, strict=True):
            row[: len(one.slider)] = one.slider
        return found.ravel()

    def whole(self) -> Scene:
        """The scene with no contact held."""
        if not self.held:
            return self
        contacts = list(self.contacts)
        for one in sorted(self.held, key=lambda one: one.place):
            contacts.insert(one.place, one.contact)
        return replace(self, contacts=tuple(contacts), held=())

    def computed(self) -> list[int]:
        """The places of the contacts that are not held, among all contacts."""
        places = {one.place for one in self.held}
        return [i for i in range(len(self.contacts) + len(self.held)) if i not in places]

    def in_use(self) -> Scene:
        """The scene restricted to degrees of freedom that are reported or carry a contact, force or load."""
        return self.at_attached_and(np.isin(self.modal.dofs, self.reported))

    def at_attached_and(self, chosen: npt.NDArray[np.bool_]) -> Scene:
        """The scene restricted to a mask chosen (dof,), and to those that carry a contact, force or load."""
        used = chosen.copy()
        different = {id(one): one for curve in self.each_curve() for one in curve.directions()}
        for direction in different.values():
            used |= direction != 0.0
        if self.ring is not None:
            used = with_own(self.modal.dofs, used)
        if used.all():
            return self
        modals = {id(curve.modal): curve.modal.at(used) for curve in (self, *self.curves)}
        draft = None if self.draft is None else self.draft.at(used)
        curves = tuple(replace(curve._at(used, modals), draft=draft) for curve in self.curves)
        return replace(self._at(used, modals), curves=curves, draft=draft)

    @cached_property
    def planar(self) -> bool:
        """Whether any contact slides in a plane."""
        return any(contact.second is not None for contact in self.contacts)

    @property
    def directions_of_contact(self) -> int:
        """Number of directions of each contact, including its normal.

        If any contact is planar, the others get a second direction too, along which nothing moves.
        """
        return 3 if self.planar else 2

    def directions(self) -> list[FloatArray]:
        """The directions of all contacts, forces and loads, each (dof,)."""
        return [*self.directions_of_contacts(), *self.pushes()]

    def directions_of_contacts(self) -> list[FloatArray]:
        """Directions (dof,) of all contacts, `directions_of_contact` for each."""
        if not self.planar:
            return [one for contact in self.contacts for one in contact.directions]
        still = np.zeros(len(self.modal.dofs))
        pairs = ((one, still if one.second is None else one.second) for one in self.contacts)
        return [along for one, second in pairs for along in (one.tangential, second, one.normal)]

    def pushes(self) -> list[FloatArray]:
        """The directions of all forces and loads, each (dof,)."""
        return [*(force.direction for force in self.forces), *(load.direction for load in self.loads)]

    def _at(self, used: npt.NDArray[np.bool_], modals: dict[int, Modal]) -> Scene:
        contacts = tuple(one.at(used) for one in self.contacts)
        forces = tuple(replace(one, direction=one.direction[used]) for one in self.forces)
        loads = tuple(replace(one, direction=one.direction[used]) for one in self.loads)
        ring = None if self.ring is None else self.ring.at(used)
        modal = modals[id(self.modal)]
        return replace(self, modal=modal, ring=ring, contacts=contacts, forces=forces, loads=loads)

    def each_curve(self) -> tuple[Scene, ...]:
        """The scenes to trace: those of the sweep, or this one alone."""
        return self.curves or (self,)


class InTime(Enum):
    """Whether the exact motion in time of a scene is computed, or why not; values as in a JSON summary."""

    COMPUTED = "computed"
    RING = "not of a ring of sectors"
    PLANE = "not of contacts in a plane"
    OWN_LAW = "not of a contact law of one's own"


def in_time(scene: Scene) -> InTime:
    """Whether the exact motion in time of a scene is computed, or why not.

    >>> import fcm
    >>> in_time(fcm.load_scene("yang1998-n5")), in_time(fcm.load_scene("bladed-disk"))
    (<InTime.COMPUTED: 'computed'>, <InTime.RING: 'not of a ring of sectors'>)
    """
    if scene.ring is not None:
        return InTime.RING
    if scene.planar:
        return InTime.PLANE
    return InTime.OWN_LAW if scene.with_own_laws else InTime.COMPUTED
