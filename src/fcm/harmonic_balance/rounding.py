r"""Rounding error of displacements where contacts are much stiffer than the structure.

The balance x = X - G F subtracts nearly equal numbers where a contact hardly moves. It loses as many digits
as k |G| has before its decimal point, and a relatively small displacement may lose all. Where every contact
only sticks or is open, the same motion solves

    (H + k) x = f,    H = G^-1,    f = H X,

a sum of stiffnesses and of forces on the contacts. Nothing cancels here, provided that f is known as given:
forces along a contact's own direction are. Elsewhere the lost digits are reported: the rounding of the
balance, through the inverse of its Jacobian across the curve.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.harmonic_balance.dense_jacobian import jacobian_of
from fcm.harmonic_balance.options import DigitOptions
from fcm.harmonic_balance.reported_quantities import PointRecord
from fcm.harmonic_balance.residual import Balance
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Force
from fcm.structure.linear import Linear, amplitudes, linear_of
from fcm.structure.receptance import Receptance, TravellingReceptance
from fcm.structure.ring import RingLinear, Wave

ComplexArray = npt.NDArray[np.complex128]


class PreciseFundamental(NamedTuple):
    """The fundamental at stiff contacts, solved without cancellation.

    z (unknown + 1,) contains it. X (dof,) is that of the degrees of freedom, used for those that are no
    combination of contacts' displacements. ports (port,) and dofs (dof,) are rounding errors.
    """

    z: FloatArray
    X: ComplexArray
    ports: FloatArray
    dofs: FloatArray


def with_precise_fundamental(
    system: System, points: PointRecord, quick: npt.NDArray[np.bool_] | None = None
) -> tuple[PointRecord, FloatArray]:
    """Recompute points at stiff contacts; return them with the relative rounding of amplitudes (point, dof).

    Where contacts are not stiff, points stay as they are and their rounding counts as 0. In a ring only the
    rounding is computed. With many contacts it is computed at some points; a point between two of these gets
    the greater rounding. With quick (point,) all points stay as they are, and the rounding is computed at
    some of the marked points.
    """
    options, rounding = system.options.digits, np.zeros_like(points.amplitude)
    springs = system.springs(stuck=True)
    stiff = np.flatnonzero(_stiffness(system, points.z[:, -1], springs) > options.stiff_ratio)
    if quick is not None:
        stiff = stiff[quick[stiff]]
    if not stiff.size:
        return points, rounding
    balance = system.new_balance()
    made = replace(
        points, X=points.X.copy(), mean=points.mean.copy(), force=points.force.copy(), z=points.z.copy(),
        amplitude=points.amplitude.copy(),
    )  # fmt: skip
    displacements, forces = balance.displacements, _Forces(system)
    apart = np.asarray(displacements.without_modes) != 0
    looked = stiff
    if (quick is not None or balance.rank) and stiff.size > options.max_points:
        looked = stiff[np.linspace(0, stiff.size - 1, options.max_points).round().astype(np.intp)]
    attached = np.abs(displacements.attached)
    for i in looked:
        z = made.z[i].copy()
        balance.evaluate(z)
        found = None if quick is not None else _precise(balance, z, springs, forces, options)
        if found is None:
            ports, dofs = _as_balanced(balance, system.linear, springs, points.tangent[i], options)
        else:
            made.z[i], ports, dofs = found.z, found.ports, found.dofs
            balance.evaluate(found.z)
            balance.evaluate_outputs(found.z, np.zeros(found.z.size))
            made.X[i].real, made.X[i].imag, made.mean[i] = (
                displacements.re,
                displacements.im,
                displacements.mean,
            )
            made.amplitude[i], made.force[i] = displacements.amplitude, balance.force
            made.X[i, balance.receptance.first, apart] = found.X[apart]
            made.amplitude[i, apart] = np.abs(found.X[apart])
        size = np.where(made.amplitude[i] > 0.0, made.amplitude[i], np.inf)
        rounding[i] = np.where(apart, dofs, ports @ attached) / size
    behind = np.searchsorted(looked, stiff)
    before = np.where(looked[behind] == stiff, behind, behind - 1)
    rounding[stiff] = np.maximum(rounding[looked[before]], rounding[looked[behind]])
    return made, rounding


def _stiffness(system: System, omega: FloatArray, springs: FloatArray) -> FloatArray:
    """The greatest k |G| of the contacts at frequencies (point,); 0 where no contact can be stiff."""
    linear = system.linear
    if not springs.size:
        return np.zeros(omega.size)
    if isinstance(linear, RingLinear):
        balance = system.new_balance()
        return np.array([_stiffest(balance, w, springs) for w in omega])
    # no mode is softer than at its resonance: for most structures this bound suffices
    least = np.minimum(np.sqrt(2.0) * linear.damping, 1.0) * linear.natural**2
    if (
        least.all()
        and (springs * ((1.0 / least) @ linear.ports**2)).max() < system.options.digits.stiff_ratio
    ):
        return np.zeros(omega.size)
    force = np.ones((omega.size, 1, linear.natural.size), dtype=np.complex128)
    compliance = amplitudes(linear.natural, linear.damping, omega, np.ones(1), force)[:, 0]
    found: FloatArray = (np.abs(compliance @ linear.ports**2) * springs).max(axis=1)
    return found


def _stiffest(balance: Balance, omega: float, springs: FloatArray) -> float:
    """The greatest k |G| at a frequency."""
    balance.receptance.at(omega)
    return float((np.abs(_receptance(balance).diagonal()) * springs).max())


def _receptance(balance: Balance) -> ComplexArray:
    return balance.receptance.of_harmonic(balance.receptance.first)


class _Forces:
    """The forces of a scene: those along a contact's direction by port, the others by mode."""

    def __init__(self, system: System) -> None:
        scene = system.scene
        ports = scene.directions_of_contacts()
        self.along: list[tuple[int, float, Force]] = []
        others: list[Force] = []
        for force in scene.forces:
            shares = ((p, _share(force.direction, port)) for p, port in enumerate(ports))
            first = next(((p, share, force) for p, share in shares if share), None)
            if first is None:
                others.append(force)
            else:
                self.along.append(first)
        self.linear = system.linear
        self.others = linear_of(replace(scene, forces=tuple(others))) if others else None

    def on_ports(self, omega: float) -> ComplexArray:
        """The forces along directions of contacts, by port (port,)."""
        f = np.zeros(self.linear.ports.shape[1], dtype=np.complex128)
        for port, share, force in self.along:
            f[port] += -1j * share * force.amplitude * omega**force.power * np.exp(1j * force.phase)
        return f

    def on_modes(self, omega: float) -> ComplexArray:
        """The other forces, on the modes (mode,)."""
        if self.others is None:
            return np.zeros(self.linear.natural.size, dtype=np.complex128)
        force: ComplexArray = self.others.force[0] + omega**2 * self.others.square[0]
        return force


def _share(direction: FloatArray, port: FloatArray) -> float:
    """Factor such that direction = factor * port; 0 if they are not parallel."""
    most = int(np.abs(port).argmax())
    same = port[most] != 0.0 and np.array_equal(direction * port[most], port * direction[most])
    return float(direction[most] / port[most]) if same else 0.0


def _precise(
    balance: Balance, z: FloatArray, springs: FloatArray, forces: _Forces, options: DigitOptions
) -> PreciseFundamental | None:
    """Solve (H + k) x = f at the point evaluated last; None where this is not possible."""
    G, held = _receptance(balance), _port_stiffness(balance, springs)
    receptance, linear, at, omega = (
        balance.receptance,
        forces.linear,
        _fundamental_positions(balance),
        float(z[-1]),
    )
    other = len(linear.driven) > 1  # forces of another harmonic
    if (
        held is None
        or other
        or isinstance(linear, RingLinear)
        or not np.linalg.cond(G) < options.max_condition
    ):
        return None
    compliance = (
        np.asarray(receptance.c_re)[receptance.first] + 1j * np.asarray(receptance.c_im)[receptance.first]
    )
    H, others = np.linalg.inv(G), forces.on_modes(omega)
    computed = H @ (linear.ports.T @ (compliance * others))
    x = np.linalg.solve(H + np.diag(held), forces.on_ports(omega) + computed)
    z[at], z[at + 1] = x.real, x.imag
    # the contacts take f - H x: on the modes remain P H x, and the other forces without their part in f
    left = linear.ports @ (H @ x - computed) + others
    size = np.abs(H) @ np.abs(x) + np.abs(computed).max(initial=0.0)
    last_digit = options.last_digit
    wrong = last_digit * np.linalg.cond(G) * size
    ports = np.abs(np.linalg.inv(H + np.diag(held))) @ wrong + options.summed_roundings * last_digit * np.abs(
        x
    )
    on_modes = np.abs(linear.ports) @ wrong + last_digit * np.abs(others)
    return PreciseFundamental(
        z, (compliance * left) @ linear.dofs, ports, (np.abs(compliance) * on_modes) @ np.abs(linear.dofs)
    )


def _as_balanced(
    balance: Balance, linear: Linear, springs: FloatArray, tangent: FloatArray, options: DigitOptions
) -> tuple[FloatArray, FloatArray]:
    """Rounding errors of the displacements (port,) and (dof,) at the point evaluated last.

    They follow from the sizes of the terms in its equations.
    """
    receptance, n, at = balance.receptance, balance.unknowns, _fundamental_positions(balance)
    force, x = np.asarray(balance.force), np.asarray(balance.evaluated)
    size, on_ports = np.hypot(x[at], x[at + 1]), np.hypot(force[at], force[at + 1])
    terms = np.zeros(n)
    terms[at] = (
        np.abs(_receptance(balance)) @ on_ports + np.hypot(receptance.X_re[0], receptance.X_im[0]) + size
    )
    terms[at + 1] = terms[at]
    rounding = options.summed_roundings * options.last_digit
    off = moved_across_curve(balance, x, tangent, rounding * terms, options)
    ports = np.hypot(off[at], off[at + 1])
    modes: Receptance = receptance
    met: Linear | Wave = linear
    j = receptance.first
    if isinstance(receptance, TravellingReceptance) and isinstance(linear, RingLinear):
        modes, j, met = receptance.waves[j], 0, linear.wave(1)
    compliance = np.hypot(np.asarray(modes.c_re)[j], np.asarray(modes.c_im)[j])
    shapes, external = np.abs(met.ports), np.hypot(modes.force_re[0], modes.force_im[0])
    on_modes = rounding * (external + shapes @ on_ports) + shapes @ (springs * ports)
    return ports, (compliance * on_modes) @ np.abs(met.dofs)


def moved_across_curve(
    balance: Balance, z: FloatArray, tangent: FloatArray, wrong: FloatArray, options: DigitOptions
) -> FloatArray:
    """Upper bound of the displacements (unknown,) across the curve by errors (unknown,) of the equations.

    nan in a corner where the curve does not have the direction of tangent. With many contacts, where no
    inverse is computed, it is an estimate: a multiple of the root mean square over errors of random signs.
    """
    balance.evaluate_scale(z)
    scale = np.array(balance.scale)
    row = tangent / scale
    row /= np.linalg.norm(row)
    condensed = balance.condensed is not None
    matrix = None if condensed else np.vstack((jacobian_of(balance) * scale, row))
    try:
        if condensed or wrong.size >= options.min_unknowns:
            signs = np.random.default_rng(0).choice((-1.0, 1.0), (options.max_signs, wrong.size))
            ways = _ways(balance, matrix, row, scale, signs * wrong)
            typical: FloatArray = scale[:-1] * np.sqrt(np.square(ways[:, :-1]).mean(axis=0))
            return options.deviation_factor * typical
        assert matrix is not None
        (off,) = wrong.nonzero()
        inverse = np.linalg.solve(matrix, np.eye(wrong.size + 1)[:, off])[:-1]  # the columns that count
    except np.linalg.LinAlgError:
        return np.full(wrong.size, np.nan)
    moved: FloatArray = scale[:-1] * (np.abs(inverse) @ wrong[off])
    return moved


def _ways(
    balance: Balance, matrix: FloatArray | None, row: FloatArray, scale: FloatArray, errors: FloatArray
) -> FloatArray:
    """Displacements (way, unknown + 1) of a point, in units of scale, by errors (way, unknown).

    They are solved for with the matrix, or with the condensed system if matrix is None.
    """
    if matrix is not None:
        right = np.vstack((errors.T, np.zeros(len(errors))))
        return np.asarray(np.linalg.solve(matrix, right).T, dtype=np.float64)
    if not balance.factor(row, scale):
        raise np.linalg.LinAlgError
    ways: FloatArray = np.hstack((errors / scale[:-1], np.zeros((len(errors), 1))))
    for way in ways:
        balance.solve(way)
    return ways


def _fundamental_positions(balance: Balance) -> npt.NDArray[np.intp]:
    """Index (port,) of the real part of each port's fundamental among the unknowns."""
    places: npt.NDArray[np.intp] = balance.layout.waves_at[balance.receptance.first]
    return places


def _port_stiffness(balance: Balance, springs: FloatArray) -> FloatArray | None:
    """The stiffness of each port (port,) if every contact only sticks or stays open, else None."""
    d, stride = balance.directions, balance.receptance.stride
    j = d + stride * balance.receptance.first
    held = np.empty(springs.size)
    for c, tangent in enumerate(np.asarray(balance.tangent)):
        own, here = tangent[j : j + stride, d:].copy(), slice(c * d, (c + 1) * d)
        pairs = own.diagonal(j - d)
        held[here] = pairs[::2]
        whole = (pairs[::2] == springs[here]) | (pairs[::2] == 0.0)
        equal = np.array_equal(pairs[::2], pairs[1::2])
        own[np.arange(stride), j - d + np.arange(stride)] = 0.0
        if own.any() or not whole.all() or not equal:
            return None
    return held
