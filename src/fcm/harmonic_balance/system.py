"""`System`: a scene of one curve with its linear structure and the balanced harmonics."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import field, replace
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from fcm.contact.closed_form import ClosedForm, CoefficientLaw
from fcm.contact.kernels import periodic_contact, planar_contact
from fcm.continuation.step_control import Stepper
from fcm.frozen import Frozen
from fcm.harmonic_balance.contact_law import Law, SingleHarmonicLaw, laws_in_a_plane, laws_on_a_line
from fcm.harmonic_balance.displacement import Displacements, TravellingDisplacements
from fcm.harmonic_balance.modal_condensation import (
    CONDENSATION,
    CondensationOptions,
    CondensedSystem,
    condensed_size,
    modal_compliance,
)
from fcm.harmonic_balance.modal_equations import ModalCompliance
from fcm.harmonic_balance.options import HARMONIC_BALANCE, ExtremeOptions, HarmonicBalanceOptions
from fcm.harmonic_balance.prolongation import ForceLevelProblem
from fcm.harmonic_balance.residual import Balance
from fcm.harmonic_balance.sampled_law import SampledLaw
from fcm.harmonic_balance.work_budget import WorkCount
from fcm.model.scene import FloatArray, Scene
from fcm.structure.layout import Layout, layout_of
from fcm.structure.linear import ComplexArray, Linear, linear_of
from fcm.structure.receptance import Receptance, TravellingReceptance
from fcm.structure.ring import RingLinear
from fcm.table.lookup import Table

if TYPE_CHECKING:
    from fcm.harmonic_balance.static_equilibrium import AtRest

Options = TypeVar("Options")


class System(Frozen):
    """A scene with its linear structure and the balanced harmonics, the first of which is 1.

    The harmonics of the forces are always balanced, even if not asked for.

    With one harmonic, a table may give the coefficients of the contact laws: this balance uses it if
    corrected is false, see `table_balance`. condensation has the options on linear systems of many contacts,
    options all other tolerances and limits of the balance. other_options has instances of options classes for
    computations that use the system, such as branches, where they are not the default.
    """

    scene: Scene
    harmonics: tuple[int, ...] = (1,)
    table: Table | None = None
    corrected: bool = True
    condensation: CondensationOptions = CONDENSATION
    options: HarmonicBalanceOptions = HARMONIC_BALANCE
    other_options: tuple[object, ...] = ()
    linear: Linear = field(init=False)
    coefficients: CoefficientLaw = field(init=False)  # the table's, or the closed form's
    port_responses: dict[float, ComplexArray] = field(
        init=False, default_factory=dict
    )  # see `fcm.branches.linear_limits`
    cache: dict[object, object] = field(init=False, default_factory=dict)  # results on its contacts' states
    work: WorkCount = field(init=False, default_factory=WorkCount, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "linear", linear_of(self.scene))
        object.__setattr__(self, "harmonics", self._with_driven(self.harmonics))
        object.__setattr__(self, "coefficients", ClosedForm() if self.table is None else self.table.law())

    def of(self, scene: Scene) -> System:
        """A new system of another scene, with the same harmonics and options."""
        return System(
            scene,
            self.harmonics,
            self.table,
            self.corrected,
            self.condensation,
            self.options,
            self.other_options,
        )

    def option(self, default: Options) -> Options:
        """The options in other_options that have the class of default, or default itself."""
        given = (one for one in self.other_options if isinstance(one, type(default)))
        return next(given, default)

    def with_harmonics(self, harmonics: tuple[int, ...]) -> System:
        """The system with other harmonics."""
        return self._with(harmonics=self._with_driven(harmonics))

    def with_scene(self, scene: Scene) -> System:
        """The system of another scene, with the same harmonics, options and work count."""
        return self._with(scene=scene, linear=linear_of(scene), port_responses={}, cache={})

    def _with_driven(self, harmonics: tuple[int, ...]) -> tuple[int, ...]:
        driven = self.linear.driven
        return harmonics if set(driven) <= {*harmonics} else tuple(sorted({*harmonics, *driven}))

    @cached_property
    def own_laws(self) -> bool:
        """Whether any contact has a law of one's own."""
        return any(one.law is not None for one in self.scene.contacts)

    @cached_property
    def preload_unit(self) -> float:
        """The greatest preload if curves of a sweep may be the same but for a factor, else 0.

        This requires that only preloads are swept, and that all are nonzero.
        """
        scene = self.scene
        swept = [key.startswith("contact.") and key.endswith(".n_0") for key in scene.parameters]
        plain = type(self.linear) is Linear and self.corrected and not scene.strained and not self.own_laws
        preloads = [abs(one.n_0) for one in scene.contacts]
        return max(preloads, default=0.0) if plain and swept and all(swept) and all(preloads) else 0.0

    @cached_property
    def normalised(self) -> System:
        """The system with all preloads divided by the greatest."""
        contacts = tuple(replace(one, n_0=one.n_0 / self.preload_unit) for one in self.scene.contacts)
        own, work = self.work, WorkCount()  # charged to the systems that share the curve
        work.poll = lambda: own.poll()  # looked up at each call, as it may change
        return self._with(scene=replace(self.scene, contacts=contacts), work=work)

    def _with(self, **other: object) -> System:
        """The system with other fields; it keeps the cached equilibrium if the scene is the same."""
        found = object.__new__(type(self))
        kept = {*self.__dataclass_fields__} | ({"_at_rest"} if "scene" not in other else set())
        found.__dict__.update({name: value for name, value in vars(self).items() if name in kept}, **other)
        return found

    @cached_property
    def layout(self) -> Layout:
        """The layout of the contacts' displacements among the unknowns."""
        return self.layout_of(self.harmonics)

    def layout_of(self, harmonics: tuple[int, ...]) -> Layout:
        """The layout of the unknowns for other harmonics."""
        return layout_of(len(self.scene.contacts), self.scene.directions_of_contact, len(harmonics))

    def extended(self, z: FloatArray, harmonics: tuple[int, ...]) -> FloatArray:
        """Convert unknowns (..., unknown + any) from other harmonics to those of this system.

        Missing harmonics are zero; the entries after the unknowns are kept.
        """
        return self.layout_of(harmonics).with_harmonics(z, harmonics, self.harmonics)

    @cached_property
    def _at_rest(self) -> AtRest:
        """The equilibrium at rest, see `harmonic_balance.static_equilibrium`."""
        from fcm.harmonic_balance.static_equilibrium import equilibrium  # that module imports this one

        return equilibrium(self)

    @property
    def rest(self) -> FloatArray:
        """Displacements (port,) at rest, as unknowns of the balance."""
        return self._at_rest.ports

    @property
    def adrift_at_rest(self) -> FloatArray:
        """Displacements (mode,) of the modes adrift at rest under the static loads; 0 of others."""
        return self._at_rest.adrift if self.linear.adrift.any() else np.zeros(self.linear.natural.size)

    @cached_property
    def loads_at_rest(self) -> list[float]:
        """Normal loads of the contacts at rest, negative where one is open."""
        d = self.layout.directions
        each = zip(self.scene.contacts, self.rest[d - 1 :: d].tolist(), strict=True)
        return [c.n_0 + c.k_v * displacement for c, displacement in each]

    @property
    def shared_balance(self) -> Balance:
        """The balance that all evaluations and curves of this system share, one after the other."""
        return self._workspace.reset_for(self).balance

    @property
    def shared_stepper(self) -> Stepper:
        """The stepper of `shared_balance`."""
        return self._workspace.reset_for(self).stepper

    @property
    def level_problem(self) -> tuple[ForceLevelProblem, Stepper]:
        """The `shared_balance` with the level of its forces as parameter, and its stepper."""
        return self._workspace.reset_for(self).level_problem

    @cached_property
    def _workspace(self) -> _Workspace:
        return _workspace_of(self)

    @contextmanager
    def exclusive_balance(self) -> Iterator[None]:
        """Context in which no other system uses this balance, as a progress callback might.

        After an error the balance may be inconsistent and is not used again.
        """
        mine = self._workspace
        before, mine.exclusive = mine.exclusive, True
        try:
            yield
        except BaseException:
            _WORKSPACES.forget(mine)
            raise
        mine.exclusive = before

    def reset_balance(self) -> Balance:
        """The `shared_balance` at level 1, as before any curve was followed."""
        balance = self.shared_balance
        balance.largest[:] = 0.0
        balance.load = 1.0
        return balance

    def new_balance(self, loaded: bool = True) -> Balance:
        """A new balance with the frequency as parameter.

        loaded: whether static loads act. The unknowns are displacements from where contacts start unstressed,
        see `Scene.sliders`.
        """
        low, high = self.scene.frequency_range
        linear = self.linear
        rank = condensed_size(self, linear.ports.shape[1], len(self.harmonics))
        receptance = linear.receptance(np.array(self.harmonics, dtype=np.float64), not rank)
        displacements = _displacements(linear, receptance, self.options.extremes)
        balance = Balance(displacements, self.laws(), linear.counted, high - low, rank, self.options.units)
        balance.reported = np.array([float(self.scene.reports(dof)) for dof in self.scene.modal.dofs])
        if rank:
            tangent, options = np.asarray(balance.tangent), self.condensation
            answer = ModalCompliance(receptance, linear.flexibility)
            stuck, yields, counted = self.springs(stuck=True), self.modal_compliance, linear.counted
            balance.condense(CondensedSystem(answer, tangent, yields, stuck, counted, options))
        if self.scene.strained and loaded:
            modes, sliders = linear.flexibility @ linear.load + self.adrift_at_rest, self.scene.sliders()
            balance.rest[:] = linear.ports.T @ modes - sliders
            of_ports = np.asarray(displacements.attached).T @ sliders + 0.0
            displacements.rest[:] = np.where(displacements.without_modes, linear.dofs.T @ modes, of_ports)
        return balance

    @cached_property
    def modal_compliance(self) -> FloatArray:
        """Compliance of each mode (mode,) relative to the contacts; empty for a ring."""
        linear, highest = self.linear, max(self.harmonics) * self.scene.frequency_range[1]
        if type(linear) is not Linear:
            return np.zeros(0)
        springs = self.springs(stuck=True)
        return modal_compliance(linear.natural, linear.ports, linear.flexibility, springs, highest)

    @cached_property
    def table_balance(self) -> System | None:
        """The system balanced by the table, from which the errors of the table are computed.

        None without a table, with further harmonics, or for a condensed system: there solving takes most of
        the time, so that a table saves none.
        """
        with_one = self.harmonics == (1,) and self._of_one_harmonic
        if self.table is None or not self.corrected or not with_one or self.shared_balance.rank:
            return None
        return self._with(corrected=False)

    @property
    def _of_one_harmonic(self) -> bool:
        """Whether `SingleHarmonicLaw` holds for all contacts: on a line, without laws of one's own."""
        return not self.scene.planar and not self.own_laws

    def laws(self) -> list[Law]:
        """Contact laws of the balance; on a line with one harmonic in closed form, or by the table."""
        if self.harmonics != (1,) or not self._of_one_harmonic:
            return self.exact_laws(self.harmonics)
        of = ClosedForm() if self.corrected else self.coefficients
        return [SingleHarmonicLaw(of, c) for c in self.scene.contacts]

    def exact_laws(self, outputs: tuple[int, ...]) -> list[Law]:
        """Contact laws with the exact forces of the motion, in the harmonics outputs."""
        return self.exact_laws_of(self.harmonics, outputs)

    def exact_laws_of(self, harmonics: tuple[int, ...], outputs: tuple[int, ...]) -> list[Law]:
        """Contact laws of a motion with other harmonics, with the exact forces in the harmonics outputs."""
        found: list[Law] = []
        if self.scene.planar:  # a contact on a line does not move in the second direction
            found += laws_in_a_plane(planar_contact(harmonics, outputs), self.scene.contacts)
        else:
            found += laws_on_a_line(periodic_contact(harmonics, outputs), self.scene.contacts)
        directions = self.scene.directions_of_contact
        for i, c in enumerate(self.scene.contacts):
            if c.law is not None:
                found[i] = SampledLaw(
                    c, harmonics, outputs, directions, found[i].margins, self.options.samples
                )
        return found

    def springs(self, stuck: bool) -> FloatArray:
        """Stiffnesses (port,) with all contacts stuck, or 0 with all open."""
        along = self.scene.directions_of_contact - 1
        each = [(*[c.k_u if c.mu > 0.0 else 0.0] * along, c.k_v) for c in self.scene.contacts]
        return np.array(each).ravel() * float(stuck)


class _Workspace:
    """A balance and its steppers, shared in turn by systems that differ only in their contacts.

    exclusive: no other system may use it now.
    """

    def __init__(self, system: System) -> None:
        self.system, self.balance, self.exclusive = system, system.new_balance(), False

    def reset_for(self, system: System) -> _Workspace:
        """Switch to a system with other contacts, and reset the balance."""
        if self.system is not system:
            self.system, self.balance.laws = system, system.laws()
            system.reset_balance()
        return self

    @cached_property
    def stepper(self) -> Stepper:
        return Stepper(self.balance)

    @cached_property
    def level_problem(self) -> tuple[ForceLevelProblem, Stepper]:
        level = ForceLevelProblem(self.balance)
        return level, Stepper(level)


class _WorkspaceCache(threading.local):
    """The workspaces that each thread used last, by structure, range and harmonics."""

    def __init__(self) -> None:
        self.by_key: OrderedDict[tuple[object, ...], _Workspace] = OrderedDict()

    def forget(self, workspace: _Workspace) -> None:
        """Remove a workspace from the cache."""
        for key in [key for key, kept in self.by_key.items() if kept is workspace]:
            del self.by_key[key]


_WORKSPACES = _WorkspaceCache()


def _workspace_of(system: System) -> _Workspace:
    """The workspace for a system; a small system uses that of an earlier one, as in a sweep."""
    scene, kept = system.scene, _WORKSPACES.by_key
    large = len(scene.contacts) * len(system.harmonics) > system.options.workspace.max_size
    if scene.ring is not None or scene.strained or system.own_laws or large:
        return _Workspace(system)
    approximate = system.table is not None, system.corrected
    key = (*system.linear.numbers, scene.frequency_range, scene.reported, system.harmonics, *approximate)
    found = kept.pop(key, None)
    own = system.options, system.condensation  # not in the key: their hash takes as long as a point
    if found is None or (found.system.options, found.system.condensation) != own:
        found = _Workspace(system)
    kept[key] = found
    if len(kept) > system.options.workspace.max_count:
        kept.popitem(last=False)
    return _Workspace(system) if found.exclusive else found


def _displacements(linear: Linear, receptance: Receptance, options: ExtremeOptions) -> Displacements:
    """The displacements of a structure, with the class that its receptance needs."""
    if not (isinstance(linear, RingLinear) and isinstance(receptance, TravellingReceptance)):
        return Displacements(receptance, linear, options)
    shapes = [linear.wave(int(h)).dofs for h in receptance.harmonics]
    return TravellingDisplacements(receptance, linear, shapes, options)
