"""Motions of a response at its peaks or chosen frequencies: contact forces and modes by harmonics.

Each motion is solved again with all contacts and modes, starting from the displacements of its curve. The
contact forces then are in balance with it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from fcm.continuation.corrector import Newton
from fcm.export.options import EXPORT, ExportOptions
from fcm.frozen import Frozen
from fcm.harmonic_balance.contact_cycles import ContactRecord
from fcm.harmonic_balance.reported_quantities import reported_at
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Modal, Scene
from fcm.reduction.restore import corrected, unknowns
from fcm.response.request import ResponseError
from fcm.results.motions import ComplexArray, ResponseMotion
from fcm.results.result import Curve, Response
from fcm.rotational_dofs import greatest_first
from fcm.structure.linear import linear_of
from fcm.units import UNIT, in_unit


def motions_of(
    response: Response, scene: Scene, at: Sequence[float] = (), options: ExportOptions = EXPORT
) -> list[ResponseMotion]:
    """Motions of every curve: at the peaks, or where it passes some frequencies in the scene's unit.

    For nonlinear modes, these are the motions kept by `fcm.response.mode.ModeRequest`; `at` are modal
    amplitudes.

    Parameters
    ----------
    response : Response
        From `fcm.response.trace`, with curves over the frequency and all degrees of freedom of the scene.
    scene : Scene
        The scene of the response.
    at : sequence of float, optional
        Frequencies; every solution that a curve has there counts, stable or not.
    options : ExportOptions, optional
        How many peaks.

    Raises
    ------
    ResponseError
        If no curve passes a frequency, or a point is no solution with all contacts and modes.

    Examples
    --------
    >>> import fcm
    >>> from fcm.response import trace
    >>> scene = fcm.load_scene("yang1998-n5")
    >>> (one,) = [m for m in motions_of(trace(scene), scene) if "u" in m.of]
    >>> one.force.shape, one.harmonics  # of a contact friction and normal force, the mean and a harmonic
    ((1, 2, 2), (1,))
    """
    if any(curve.mode is not None for curve in response.curves):
        return _of_modes(response, scene, at)
    found: list[ResponseMotion] = []
    for number, (curve, own) in enumerate(zip(response.curves, scene.each_curve(), strict=True)):
        if not curve.points:
            continue
        solver = _Solver.of(own, curve)
        if at:
            omegas = (one * UNIT[scene.frequency_unit] for one in at)
            found += [one for omega in omegas for one in solver.passing(number, omega)]
        else:
            found += list(solver.peaks(number, [own.asks_for(dof) for dof in own.modal.dofs], options))
    met = {one.frequency for one in found}
    for one in at:
        if one * UNIT[scene.frequency_unit] not in met:
            raise ResponseError(f"{scene.name}: no curve passes {one:g} {scene.frequency_unit}")
    return found


def _of_modes(response: Response, scene: Scene, at: Sequence[float]) -> list[ResponseMotion]:
    """The motions that nonlinear modes kept for export."""
    found: list[ResponseMotion] = []
    for number, (curve, own) in enumerate(zip(response.curves, scene.each_curve(), strict=True)):
        if curve.mode is None or not curve.mode.motions:
            continue
        system, turn = System(own, curve.harmonics), linear_of(scene_in_modes(own)).dofs
        swept, harmonics = dict(curve.parameters), curve.harmonics
        for one in curve.mode.motions:
            force, modal = contact_forces(system, one.contacts), turn.T @ one.modes
            motion = ResponseMotion(
                number, swept, (), one.frequency, np.nan, harmonics, force, modal, one.amplitude
            )
            motion = with_contacts(motion, system, one.contacts)
            found.append(motion)
    for amplitude in at:
        if not any(
            np.isclose(one.amplitude, amplitude, rtol=EXPORT.same_amplitude, atol=0.0) for one in found
        ):
            raise ResponseError(f"{scene.name}: no mode comes to the modal amplitude {amplitude:g}")
    return found


class _Solver(Frozen):
    """A curve, with a corrector for its balance."""

    scene: Scene
    curve: Curve
    newton: Newton
    system: System
    in_modes: System | None  # the system with modal displacements as output

    @staticmethod
    def of(scene: Scene, curve: Curve) -> _Solver:
        system = System(scene, curve.harmonics)
        modal = None if scene.ring is not None else System(scene_in_modes(scene), curve.harmonics)
        return _Solver(scene, curve, Newton(system.new_balance()), system, modal)

    def peaks(
        self, number: int, reported: Sequence[bool], options: ExportOptions
    ) -> Iterator[ResponseMotion]:
        """Yield the motion of each peak; degrees of freedom with a common peak share one motion."""
        dofs, amplitude = self.scene.modal.dofs, self.curve.amplitude
        shown = [d for d, one in enumerate(reported) if one and np.isfinite(amplitude[:, d]).any()]
        heights = [float(np.nanmax(amplitude[:, d])) for d in shown]
        first = greatest_first([dofs[d] for d in shown], heights)[: options.max_peaks]
        of: dict[int, list[str]] = {}
        for d in sorted(shown[i] for i in first):
            of.setdefault(int(np.nanargmax(amplitude[:, d])), []).append(dofs[d])
        for point, names in of.items():
            z = self._unknowns(point)
            solved = corrected(self.newton, z)
            if solved is None or abs(solved[-1] - z[-1]) > options.max_drift * z[-1]:
                raise ResponseError(
                    f"{self.scene.name}: the peak of {names[0]} at {z[-1]:.6g} rad/s is no solution "
                    "with all contacts and modes; try --keep-all"
                )
            yield self._motion(number, solved, float(self.curve.stable[point]), tuple(names))

    def passing(self, number: int, omega: float) -> Iterator[ResponseMotion]:
        """Yield the motions where the curve passes a frequency [rad/s]."""
        frequency = self.curve.frequency
        low, high = frequency[:-1], frequency[1:]
        inside = (np.minimum(low, high) <= omega) & (omega < np.maximum(low, high))
        places = [(k, k + 1) for k in np.flatnonzero(inside).tolist()]
        if (frequency == omega).any() and not places:  # the last point of a range
            places = [(k, k) for k in np.flatnonzero(frequency == omega).tolist()[:1]]
        for k, after in places:
            one, other = self._unknowns(k), self._unknowns(after)
            share = 0.0 if k == after else (omega - one[-1]) / (other[-1] - one[-1])
            z = one + share * (other - one)
            z[-1] = omega
            solved = corrected(self.newton, z, along=False)
            if solved is None:
                raise ResponseError(
                    f"{self.scene.name}: no solution was found at {omega:.6g} rad/s between two points of "
                    f"curve {number}"
                )
            solved[-1] = omega
            stable = {float(self.curve.stable[i]) for i in (k, after)}
            yield self._motion(number, solved, stable.pop() if len(stable) == 1 else np.nan, ())

    def _unknowns(self, point: int) -> FloatArray:
        z: FloatArray = unknowns(self.curve, self.scene, np.array([point]), self.curve.harmonics)[0]
        return z

    def _motion(self, number: int, z: FloatArray, stable: float, of: tuple[str, ...]) -> ResponseMotion:
        modal = None
        if self.in_modes is not None:
            in_modes = reported_at(self.in_modes, z[None])
            X, mean = in_modes.X, in_modes.mean
            modal = np.concatenate((mean[0, :, None], 1j * X[0].T), axis=1)
        force = contact_forces(self.system, z)
        swept, harmonics = dict(self.curve.parameters), self.system.harmonics
        found = ResponseMotion(number, swept, of, float(z[-1]), stable, harmonics, force, modal)
        return with_contacts(found, self.system, z)


def with_contacts(motion: ResponseMotion, system: System, z: FloatArray) -> ResponseMotion:
    """Add the states and loads of the contacts over a cycle at the point z (unknown + 1,) to a motion."""
    if not system.scene.contacts:
        return motion
    record = ContactRecord.at(system, z[None])
    return replace(motion, states=tuple(record.words[0].tolist()), contact_loads=record.contact_loads[0])


def contact_forces(system: System, z: FloatArray) -> ComplexArray:
    """Forces of the contacts (contact, direction, 1 + harmonic) at a point z (unknown + 1,) of a balance.

    Forces are Im(F_h exp(i h omega t)), the mean first. The last direction is the normal; it includes the
    preload.
    """
    layout, z = system.layout, np.ascontiguousarray(z)
    flat = np.zeros(layout.unknowns)
    for i, law in enumerate(system.exact_laws(system.harmonics)):
        law.evaluate_forces(z, i * layout.width)
        flat[i * layout.width : (i + 1) * layout.width] = np.asarray(law.force)[: layout.width]
    force = layout.complex_ports(flat).reshape(layout.contacts, layout.directions, -1)
    force[..., 1:] *= 1j
    for i, contact in enumerate(system.scene.contacts):
        force[i, -1, 0] += max(contact.n_0, 0.0)
    return force + 0.0  # turns -0.0 into 0.0


def scene_in_modes(scene: Scene) -> Scene:
    """The scene of one curve with the displacements of its modes, of mass 1, as degrees of freedom."""
    modal = scene.modal
    unit = np.sqrt(modal.mass)
    onto = modal.shapes / unit[:, None]  # (mode, dof)
    names = tuple(f"mode {i + 1}" for i in range(modal.mass.size))
    own = Modal(names, modal.mass, modal.frequency, modal.damping, np.diag(unit), modal.added, modal.complete)
    contacts = tuple(
        replace(
            one,
            tangential=onto @ one.tangential,
            normal=onto @ one.normal,
            second=None if one.second is None else onto @ one.second,
        )
        for one in scene.contacts
    )
    forces = tuple(replace(one, direction=onto @ one.direction) for one in scene.forces)
    loads = tuple(replace(one, direction=onto @ one.direction) for one in scene.loads)
    return replace(
        scene, modal=own, contacts=contacts, forces=forces, loads=loads, reported=(), curves=(), draft=None
    )


_OTHER = re.compile(r"[^A-Za-z0-9_.+-]+")


def labels_of(motions: Sequence[ResponseMotion], unit: str) -> list[str]:
    """A unique name for each motion, from its curve, its peak or modal amplitude, and its frequency.

    >>> import numpy as np
    >>> nothing = np.zeros((0, 2, 2), dtype=complex)
    >>> motion = ResponseMotion(0, {}, ("16y",), 2.5, 1.0, (1,), nothing, None)
    >>> labels_of([motion, motion], "rad/s")
    ['peak_16y_2.5_rad_s', 'peak_16y_2.5_rad_s_2']
    """
    several, found = len({one.curve for one in motions}) > 1, list[str]()
    for one in motions:
        of = "_".join(["peak", *one.of[:1]]) if one.of else "at"
        if np.isfinite(one.amplitude):
            of = f"amplitude_{one.amplitude:.4g}_at"
        text = f"{of}_{in_unit(one.frequency, unit):.6g}_{unit}"
        name = _OTHER.sub("_", f"curve{one.curve}_{text}" if several else text)
        count, first = 1, name
        while name in found:
            count += 1
            name = f"{first}_{count}"
        found.append(name)
    return found
