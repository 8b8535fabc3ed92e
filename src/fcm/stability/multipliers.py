r"""Floquet multipliers of a balanced solution, and the classification of its stability by them.

The growth of a small disturbance over a period, slow or fast, is an eigenvalue of the `Monodromy` of the
motion. The monodromy is that of the finer motion (`EnrichedMotion`); that of the balanced harmonics alone
shows how certain the classification is. If it is uncertain, the further harmonics are balanced, too
(`Rebalancing`). That motion decides if harmonics beyond its own add little to it. Light impacts need this:
their multipliers change severalfold if amplitudes change by a hundredth.

If no contact changes its state, the motion is linear and stable. This holds, too, where an extreme of its
limit holds a slider: with a little less residual friction the slider rests in the same motion.

Neither motion is exactly a periodic solution of the structure, so that a real multiplier passes +1 beside the
fold of the curve. The parity of the balance's determinant changes exactly at the folds. In the limit of many
harmonics it is that of the number of real multipliers above +1. Therefore it decides on that number.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.harmonic_balance.residual_spectrum import EnrichedMotion, enriched_harmonics
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.stability.classification import (
    LINEAR,
    UNKNOWN,
    Classification,
    MultiplierSpectrum,
    classify_even,
    combine_one_sided,
    flip_distance,
    is_uncertain,
)
from fcm.stability.disturbance import Propagator, Stiffness
from fcm.stability.eigenvalues import eigenvalues
from fcm.stability.monodromy import ManyMonodromy, Monodromy
from fcm.stability.options import STABILITY, StabilityOptions
from fcm.stability.quasi_static_modes import PortModes, combined, quasi_static_modes
from fcm.stability.rebalanced import Rebalancing
from fcm.stability.state_sequence import BalancedSequence

if TYPE_CHECKING:
    from fcm.stability.planar_monodromy import PlanarMonodromy, PlanarSequence


class VariationalProblem(NamedTuple):
    """The states of a balanced motion, and the monodromy that propagates its disturbances through them."""

    states: BalancedSequence | PlanarSequence
    monodromy: Monodromy | ManyMonodromy | PlanarMonodromy


class _MotionSample(NamedTuple):
    """A solution z, its finer motion x, and the monodromy matrix of x.

    at_fold and without_neighbour are as in `Multipliers.classify`. shift: how much the finer motion adds.
    held: number of contacts held in x, see `Classification`.
    """

    z: FloatArray
    x: FloatArray
    at_fold: bool
    without_neighbour: bool
    shift: float
    held: int
    matrix: FloatArray


class Multipliers:
    """Computes the multipliers of a system's solutions up to a frequency [rad/s]; a workspace."""

    def __init__(
        self, system: System, highest: float, last: bool = False, options: StabilityOptions = STABILITY
    ) -> None:
        """last: whether no further harmonics are balanced where a classification is uncertain."""
        linear, self.options = system.linear, options
        self.system, self.highest, self.last = system, highest, last
        self.contacts = len(system.scene.contacts)
        law = [[c.mu, c.k_u, c.k_v, c.n_0] for c in system.scene.contacts]
        self.contact = contact = np.array(law, dtype=np.float64).reshape(self.contacts, 4)  # shared by all
        harmonics = [int(h) for h in system.harmonics]
        spectrum = system.options.spectrum
        finer = enriched_harmonics(harmonics, spectrum)
        far = quasi_static_modes(linear.natural, highest, harmonics, system.scene.planar, self.options)
        self.has_rigid_body_modes = int(np.count_nonzero(linear.adrift))
        summed = linear.ports.shape[1] <= spectrum.compiled_ports
        seen = linear.receptance(np.array(finer, dtype=np.float64), summed)
        self.finer = EnrichedMotion(seen, system.exact_laws(tuple(finer)), harmonics, spectrum)
        self.far = far
        self.states: tuple[BalancedSequence, BalancedSequence] | tuple[PlanarSequence, PlanarSequence]
        if system.scene.planar:
            from fcm.stability.planar_monodromy import PlanarSequence  # most scenes do not need it

            self.states = (
                PlanarSequence(contact, tuple(finer), options.planar),
                PlanarSequence(contact, tuple(harmonics), options.planar),
            )
        else:
            self.states = BalancedSequence(contact, finer), BalancedSequence(contact, harmonics)
        self.fine, self.plain = self._followed()
        self.further: tuple[Rebalancing, Multipliers] | None = None
        self.refined_solution: FloatArray | None = (
            None  # the motion with further harmonics that was found last
        )

    def take(self, system: System) -> None:
        """Take another system with the same structure and harmonics, whose contacts may differ."""
        before, scene = self.system.scene, system.scene
        same = scene.frequency_range == before.frequency_range and not (scene.strained or before.strained)
        self.system, self.further = system, self.further if same else None
        known = self.contact[:, :3].copy()
        for row, c in zip(self.contact, system.scene.contacts, strict=True):
            row[:] = c.mu, c.k_u, c.k_v, c.n_0
        for law, c in zip(self.finer.laws, system.scene.contacts, strict=True):
            law.set_parameters(c.mu, c.k_u, c.k_v, c.n_0)
        if not np.array_equal(self.contact[:, :3], known):  # the kept matrices are of other contacts
            self.fine, self.plain = self._followed()

    def _followed(self) -> list[VariationalProblem]:
        """The variational problems of the finer motion and of that of the balanced harmonics."""
        fine, plain = self.states
        if isinstance(fine, BalancedSequence) and isinstance(plain, BalancedSequence):
            make = (
                _many_contacts if len(self.contact) >= self.options.structure.many_contacts else _few_contacts
            )
            return make(self.system, self.far, self.contact, (fine, plain), self.options)
        from fcm.stability.planar_monodromy import PlanarMonodromy, PlanarSequence

        linear = self.system.linear
        modes = PortModes(linear.ports, linear.natural, linear.damping, self.far)
        planar = (one for one in self.states if isinstance(one, PlanarSequence))
        return [VariationalProblem(one, PlanarMonodromy(modes, one, self._poll)) for one in planar]

    def _poll(self) -> None:
        self.system.work.poll()  # of the present system: `take` may change it

    def of(self, z: FloatArray) -> list[complex] | None:
        """Multipliers at z (unknown + 1,) of the finer motion; None where they are not finite."""
        self.finer.at(z)
        return self._values(self.fine, z[-1]) if self.find_states(self.fine.states, self.finer.x) else None

    def find_states(self, states: BalancedSequence | PlanarSequence, x: FloatArray) -> bool:
        """Find the states of the contacts in the motion x; false where a number is not finite."""
        return bool(states.find_events(x))

    def of_period(self, values: list[complex]) -> list[complex]:
        """Multipliers of a period from the eigenvalues of the monodromy matrix."""
        return values

    def classify(
        self,
        z: FloatArray,
        at_fold: bool = False,
        sufficient: Sequence[float] = (),
        without_neighbour: bool = False,
    ) -> Classification:
        """Classify a solution with an even number of real multipliers above 1, or a fold (at_fold).

        If the stability of the finer motion, 1 or 0, is in `sufficient`, the balanced harmonics need not
        confirm it. without_neighbour: whether no solution with further harmonics is near, so that none is
        sought.
        """
        return self.classify_all((z,), (at_fold,), (without_neighbour,), sufficient)[0]

    def classify_all(
        self,
        z: Sequence[FloatArray],
        at_fold: Sequence[bool],
        without_neighbour: Sequence[bool],
        sufficient: Sequence[float] = (),
    ) -> list[Classification]:
        """Classifications of several solutions (unknown + 1,), as `classify` gives them.

        LAPACK is called once for up to `StructureOptions.max_entries` matrix entries.
        """
        found, count = list[Classification](), 0
        while count < len(z):
            samples, entries = list[_MotionSample | Classification](), 0
            while count < len(z) and entries < self.options.structure.max_entries:
                one = self._sample(z[count], at_fold[count], without_neighbour[count])
                samples.append(one)
                entries += one.matrix.size if isinstance(one, _MotionSample) else 0
                count += 1
            found += self._classify_samples(samples, sufficient)
        return found

    def _sample(
        self, z: FloatArray, at_fold: bool, without_neighbour: bool
    ) -> _MotionSample | Classification:
        """The sample of a solution and its finer motion; a classification if that needs no multipliers."""
        fine, plain = self.fine.states, self.plain.states
        self.finer.at(z)
        if self.finer.shift < self.options.confirmation.min_addition:
            if not self.find_states(plain, z):
                return UNKNOWN
            if plain.moving == 0:  # nor does any contact move in the finer motion, which is the same
                return LINEAR._replace(held=plain.held) if plain.held else LINEAR
        x = np.array(self.finer.x)
        if not self.find_states(fine, x):
            return UNKNOWN
        matrix = self._matrix(self.fine, float(z[-1]))
        return (
            UNKNOWN
            if matrix is None
            else _MotionSample(z, x, at_fold, without_neighbour, self.finer.shift, fine.held, matrix)
        )

    def _classify_samples(
        self, samples: Sequence[_MotionSample | Classification], sufficient: Sequence[float]
    ) -> list[Classification]:
        """Classifications of samples; the balanced harmonics confirm them where that may matter."""
        seen = [one for one in samples if isinstance(one, _MotionSample)]
        fine = dict(zip(map(id, seen), self._spectra([one.matrix for one in seen]), strict=True))
        known, left = dict[int, Classification](), list[_MotionSample]()
        for one in seen:
            classified = self._from_finer(one, fine[id(one)], sufficient)
            if classified is None:
                left.append(one)
            else:
                known[id(one)] = classified
        both = [self._plain_matrix(one.z) for one in left]
        for one, plain in zip(left, self._spectra(both), strict=True):
            known[id(one)] = self._of_both(one, fine[id(one)], plain)
        for one in seen:
            if one.held and fine[id(one)] is not None:
                resting = self._with_sliders_at_rest(one)
                known[id(one)] = combine_one_sided(known[id(one)], resting)._replace(held=one.held)
        return [known[id(one)] if isinstance(one, _MotionSample) else one for one in samples]

    def _from_finer(
        self, one: _MotionSample, fine: MultiplierSpectrum | None, sufficient: Sequence[float]
    ) -> Classification | None:
        """The classification by the finer motion alone; None if that has to be confirmed."""
        if fine is None:
            return UNKNOWN
        finer, options = fine.classify(one.at_fold), self.options.confirmation
        safe = finer.growth < -max(options.safe_decay, options.decay_ratio * one.shift)
        if not fine.odd and (safe or finer.stable in sufficient):
            return finer
        if one.shift == 0.0:  # both motions are the same, as where no contact slips but one just would
            return classify_even(fine, fine, one.at_fold, self.options)
        return None

    def _plain_matrix(self, z: FloatArray) -> FloatArray | None:
        return self._matrix(self.plain, float(z[-1])) if self.find_states(self.plain.states, z) else None

    def _of_both(
        self, one: _MotionSample, fine: MultiplierSpectrum | None, plain: MultiplierSpectrum | None
    ) -> Classification:
        """Classify by the finer motion and by that of the balanced harmonics.

        If they disagree, or agree only just, the motion with the further harmonics balanced decides instead.
        With `last` none is balanced: the classification is then unknown.
        """
        if fine is None or plain is None:
            return UNKNOWN
        options = self.options.confirmation
        found = classify_even(fine, plain, one.at_fold, self.options)
        if one.at_fold:
            return found
        if self.last:
            doubt = self._is_uncertain(found, fine, plain, 1.0, one)
            return found._replace(stable=math.nan) if doubt else found
        slight = 0.0 < found.growth < max(options.safe_decay, options.growth_ratio * one.shift)
        if slight or self._is_uncertain(found, fine, plain, options.growth_ratio, one):
            better = (
                None
                if one.without_neighbour
                else self._rebalanced(one.z, one.x, persistent=found.stable == 1.0)
            )
            return better or found._replace(stable=math.nan)
        return found

    def _is_uncertain(
        self,
        found: Classification,
        fine: MultiplierSpectrum,
        plain: MultiplierSpectrum,
        times: float,
        one: _MotionSample,
    ) -> bool:
        """Whether a classification `is_uncertain`, other than by a pair that decays where it meets at -1."""
        if not is_uncertain(found, fine, plain, times, options=self.options):
            return False
        return is_uncertain(found, fine, plain, times, False, self.options) or not self._pair_decays_at_flip(
            found.values, one
        )

    def _pair_decays_at_flip(self, values: Sequence[complex], one: _MotionSample) -> bool:
        """Whether the pair nearest to -1, among values of the finer motion, decays where it meets there.

        The same motion is evaluated at frequencies at which the pair comes to -1. How far the pair parts
        there shows how strongly the changing contacts drive it.
        """
        self.find_states(self.fine.states, one.x)
        at, seen, omega = [0.0], [flip_distance(values, self.options)], float(one.z[-1])
        ahead = self.options.confirmation.frequency_step
        for _ in range(self.options.confirmation.max_evaluations):
            there = self._values(self.fine, omega * (1.0 + ahead))
            if there is None:
                return False
            at.append(ahead)
            seen.append(flip_distance(there, self.options))
            if not math.isfinite(seen[-1][0]):
                return False
            if len(at) > 2 and abs(seen[-1][0]) < self.options.confirmation.meeting_tolerance:
                break
            roots = [math.copysign(math.sqrt(abs(apart)), apart) for apart, _ in seen[-2:]]
            slope = (roots[1] - roots[0]) / (at[-1] - at[-2])
            if slope == 0.0 or abs(roots[1] / slope) > self.options.confirmation.max_frequency_change:
                return False
            ahead = at[-1] - roots[1] / slope
        else:
            return False
        bend, tilt, level = np.polyfit(at[-3:], [apart for apart, _ in seen[-3:]], 2)
        least = level - 0.25 * tilt**2 / bend if bend > 0.0 else -math.inf
        return bool(math.sqrt(max(-least, 0.0)) + seen[-1][1] < -self.options.confirmation.meeting_decay)

    def _rebalanced(self, z: FloatArray, x: FloatArray, persistent: bool) -> Classification | None:
        """Classify with the harmonics of the finer motion x balanced.

        None if no solution is near, or harmonics beyond these add too much to it.
        """
        refined, multipliers = self._further()
        self.refined_solution = there = refined.rebalance(z, x, persistent)
        if there is None:
            return None
        found = self._classify_if_sufficient(multipliers, there)
        return None if found is None else found._replace(rebalanced=True)

    def _further(self) -> tuple[Rebalancing, Multipliers]:
        """The balance with the harmonics of the finer motion, and the multipliers of its solutions."""
        if self.further is None:
            refined = Rebalancing(
                self.system, enriched_harmonics([int(h) for h in self.system.harmonics]), self.options
            )
            self.further = refined, type(self)(refined.system, self.highest, True, self.options)
        refined, multipliers = self.further
        if refined.fewer is not self.system:
            refined.take(self.system)
            multipliers.take(refined.system)
        return refined, multipliers

    def confirms(self, z: FloatArray, stable: float) -> bool:
        """Whether a solution keeps the given stability (1 or 0) with the further harmonics balanced, too."""
        self.finer.at(z)
        if self.finer.shift == 0.0:  # it has none
            return True
        found = self._rebalanced(z, np.array(self.finer.x), persistent=True)
        return found is not None and found.stable == stable

    def confirmation(self, z: FloatArray) -> Classification:
        """Classify a solution with the further harmonics balanced, too.

        UNKNOWN if no such motion is near, or harmonics beyond these add too much to it.
        """
        self.finer.at(z)
        self.refined_solution = None
        if self.finer.shift == 0.0:  # it has none
            return self.classify(z)
        return self._rebalanced(z, np.array(self.finer.x), persistent=True) or UNKNOWN

    def continued(
        self, z: FloatArray, motion: FloatArray, harmonics: tuple[int, ...] | None = None
    ) -> Classification:
        """Classify the motion with further harmonics to which Newton's method leads from a known one.

        harmonics: those of the known motion, if they differ.
        """
        refined, multipliers = self._further()
        if harmonics is not None:
            motion = refined.system.extended(motion, harmonics)
        self.refined_solution = there = refined.continue_to(z, motion)
        return UNKNOWN if there is None else self._classify_if_sufficient(multipliers, there) or UNKNOWN

    def _classify_if_sufficient(self, multipliers: Multipliers, z: FloatArray) -> Classification | None:
        """The classification of a motion with further harmonics; None if it is not accurate enough to tell.

        If harmonics beyond its own add more than `max_addition`, it errs as much as the motion that it should
        confirm. Then those are balanced, too, unless many contacts slide in a plane: there one evaluation
        takes as long as tens of points of the curve.
        """
        multipliers.finer.at(z)
        if multipliers.finer.shift <= self.options.confirmation.max_addition:
            return multipliers.classify(z)
        many = self.contacts >= self.options.structure.many_contacts
        if self.last or (many and self.system.scene.planar):
            return None
        return multipliers._rebalanced(z, np.array(multipliers.finer.x), persistent=True)

    def _matrix(self, followed: VariationalProblem, omega: float) -> FloatArray | None:
        """The monodromy matrix of the motion whose states were found last."""
        # many contacts take long; the workspace of few is shared, and the poll may run code that uses it
        if self.contacts >= self.options.structure.many_contacts:
            self.system.work.poll()
        followed.monodromy.follow(omega)
        found: FloatArray = followed.monodromy.matrix()
        return found

    def _values(self, followed: VariationalProblem, omega: float) -> list[complex] | None:
        """The multipliers of the motion whose states were found last; None where they are not finite."""
        matrix = self._matrix(followed, omega)
        found = None if matrix is None else eigenvalues((matrix,))[0]
        return None if found is None else self._without_neutral(found)

    def _spectra(self, matrices: Sequence[FloatArray | None]) -> list[MultiplierSpectrum | None]:
        """Spectra of monodromy matrices; None for each that is None, or has no finite eigenvalues."""
        known = iter(eigenvalues([one for one in matrices if one is not None]))
        each = (None if one is None else next(known) for one in matrices)
        return [
            None if one is None else MultiplierSpectrum(self._without_neutral(one), self.options)
            for one in each
        ]

    def _without_neutral(self, found: list[complex]) -> list[complex]:
        """Multipliers of a period, without those of unconstrained rigid-body modes."""
        values = self.of_period(found)
        for _ in range(2 * self.has_rigid_body_modes):
            nearest = min(values, key=_distance_from_one)
            if _distance_from_one(nearest) < self.options.classification.neutral_tolerance:
                values.remove(nearest)
        return values

    def _with_sliders_at_rest(self, one: _MotionSample) -> Classification:
        """Classify with those sliders at rest that an extreme of their limit holds."""
        states = self.fine.states
        states.yielding = False
        self.find_states(states, one.x)
        values = self._values(self.fine, float(one.z[-1])) if states.moving else []
        states.yielding = True
        return UNKNOWN if values is None else MultiplierSpectrum(values, self.options).classify()


def _few_contacts(
    system: System,
    far: npt.NDArray[np.bool_],
    contact: FloatArray,
    states: Sequence[BalancedSequence],
    options: StabilityOptions,
) -> list[VariationalProblem]:
    """Variational problems of few contacts: each combination of states is assembled anew."""
    linear = system.linear
    modes = PortModes(linear.ports, linear.natural, linear.damping, far)
    soft = modes.flexibility if far.any() else None
    stiffness = Stiffness(*modes.near, soft, contact, options.propagation)
    carried = system.cache.setdefault((Propagator, stiffness.modes), Propagator(options.propagation))
    assert isinstance(carried, Propagator)
    return [VariationalProblem(one, Monodromy(stiffness, one, carried)) for one in states]


def _many_contacts(
    system: System,
    far: npt.NDArray[np.bool_],
    contact: FloatArray,
    states: Sequence[BalancedSequence],
    options: StabilityOptions,
) -> list[VariationalProblem]:
    """Variational problems of many contacts: each change of one contact's state updates the matrices."""
    linear, near = system.linear, ~far
    following = combined(
        linear.ports[far], linear.natural[far], contact[:, 1:3].ravel(), options.structure.min_yield
    )
    shown = PortModes(
        np.concatenate((linear.ports[near], following)),
        np.concatenate((linear.natural[near], np.ones(len(following)))),
        np.concatenate((linear.damping[near], np.zeros(len(following)))),
        np.arange(near.sum() + len(following)) >= near.sum(),
    )
    return [
        VariationalProblem(one, ManyMonodromy(shown, contact, one, options.propagation)) for one in states
    ]


def _distance_from_one(value: complex) -> float:
    return abs(value - 1.0)
