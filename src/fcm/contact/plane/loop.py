"""The loop of a contact that slides in a plane: its states, transitions, directions and forces."""

from __future__ import annotations

from dataclasses import field, replace

import numpy as np
import numpy.typing as npt

from fcm.contact.contact_kernel import ContactParameters
from fcm.contact.kernel_arguments import ComplexArray, FloatArray, KernelArguments
from fcm.contact.periodic.cycle import join_states
from fcm.contact.pieces import LoadedPieces, Piece, from_piece, transitions_of, waves_at
from fcm.contact.plane.cycle import PlanarContact
from fcm.contact.plane.options import FINEST, LOOP
from fcm.contact.plane.radau import STAGES, radau
from fcm.frozen import Frozen

LETTERS = "EPS"  # by the kernel's states


class PlanarLoop(Frozen, LoadedPieces):
    """One steady cycle of a contact in its plane under x(theta) = Re sum_h X_h exp(i h theta).

    Attributes
    ----------
    u_x, u_y, v : ndarray, complex, shape (harmonic,) [length]
        The motion, as given to `planar_loop`, as are mu [-], k_u, k_v [force / length] and n_0 [force].
    sequence : str
        The states in order: E stick, P slip in any direction, S separation: 'EPEP', 'EPS', ...
    angles : ndarray, shape (len(sequence),) or (0,) for a single state [rad]
        ``angles[i]`` in [0, 2 pi) is where state ``sequence[i]`` begins and the one before it ends.
    slip_motion : ndarray, shape (max(len(angles), 1), 2) [length]
        w_x and w_y while the contact sticks, for each state; NaN for the others.
    dissipation : float
        Energy dissipated by friction in a cycle [force length].
    slip_path : float
        Path of the slider while it slips, in a cycle [length].
    greatest_force : float
        Greatest |f| [force].
    """

    u_x: ComplexArray
    u_y: ComplexArray
    v: ComplexArray
    mu: float
    k_u: float
    k_v: float
    n_0: float
    sequence: str
    angles: FloatArray
    slip_motion: FloatArray
    dissipation: float
    slip_path: float
    greatest_force: float
    _since: FloatArray = field(repr=False)  # angles from the first on
    _panels: FloatArray = field(repr=False)  # (panel, 5 + s): as `Slider.record`

    def displacement(self, theta: npt.ArrayLike) -> FloatArray:
        """Displacements u_x and u_y [length] at each angle theta [rad], (..., 2)."""
        return np.stack([waves_at(self.u_x, theta), waves_at(self.u_y, theta)], axis=-1)

    def direction(self, theta: npt.ArrayLike) -> FloatArray:
        """Direction of the slip at each angle theta [rad], (..., 2); NaN while it does not slip."""
        angle = np.asarray(theta, dtype=np.float64)
        found = np.full((*angle.shape, 2), np.nan)
        slips = np.asarray(self.states(angle) == "P")
        if self._panels.size == 0 or not slips.any():
            return found
        begin = self._panels[:, 0]
        t = begin[0] + np.mod(angle[slips] - begin[0], 2.0 * np.pi)
        at = np.searchsorted(begin, t, side="right") - 1
        # at the beginning of a slip rounding may put an angle before it, after the last panel of the slip
        # before
        after = (at + 1) % begin.size
        ahead = np.mod(begin[after] - t, 2.0 * np.pi)
        sooner = (t - begin[at] - self._panels[at, 1] > ahead) & (begin.size > 1)
        at, t = np.where(sooner, after, at), np.where(sooner, begin[after], t)
        found[slips] = directions(self._panels[at], t)
        return found

    def force(self, theta: npt.ArrayLike) -> FloatArray:
        """Friction force f_x and f_y [force] at each angle theta [rad], (..., 2).

        >>> loop = planar_loop([0, 1], [0, -1j], [0], mu=0.5, k_u=1.0, k_v=1.0, n_0=1.0)
        >>> loop.force(0.0).round(6).tolist()  # r / 2 along u, r sin(60 deg) along its velocity
        [0.25, 0.433013]
        """
        angle = np.asarray(theta, dtype=np.float64)
        state, limit = np.asarray(self.states(angle))[..., None], self.slip_limit(angle)[..., None]
        slid = np.nan_to_num(self.slip_motion)[self._piece(angle)]
        stick = self.k_u * (self.displacement(angle) - slid)
        slip = np.nan_to_num(self.direction(angle)) * limit
        return np.select([state == "E", state == "P"], [stick, slip], 0.0)

    def slider(self, theta: npt.ArrayLike) -> FloatArray:
        """Place of the slider w_x and w_y [length] at each angle theta [rad], (..., 2); k_u is not 0."""
        return self.displacement(theta) - self.force(theta) / self.k_u


def planar_loop(
    u_x: npt.ArrayLike,
    u_y: npt.ArrayLike,
    v: npt.ArrayLike,
    mu: float,
    k_u: float,
    k_v: float,
    n_0: float,
    *,
    start_x: float = 0.0,
    start_y: float = 0.0,
) -> PlanarLoop:
    """The steady loop of one contact that slides in a plane, its events located.

    Parameters
    ----------
    u_x, u_y, v : array_like, complex, shape (harmonic,)
        Coefficients of the displacements. The other arguments are numbers, as in `planar_forces`.

    Returns
    -------
    PlanarLoop
        With `sequence`, `angles`, and at any angle `force`, `slider`, `direction`, `normal_load`, `states`.

    Raises
    ------
    ValueError
        If mu, k_u or k_v is negative, or a number is not finite.
    RuntimeError
        If no steady cycle is found.

    Examples
    --------
    >>> loop = planar_loop([0, 1], [0, -0.4j], [0, 0.8j], mu=0.5, k_u=1.0, k_v=1.0, n_0=0.7)
    >>> loop.sequence
    'EPSP'
    """
    numbers = {"mu": mu, "k_u": k_u, "k_v": k_v, "n_0": n_0, "start_x": start_x, "start_y": start_y}
    motion = KernelArguments.of_one({"u_x": u_x, "u_y": u_y, "v": v}, numbers)
    contact = _solved(motion)
    slider, scale = contact.cycle.slider, contact.motion.scale
    length = scale / k_u if k_u > 0.0 else 0.0
    regions = visible(contact)
    sequence, angles, since = transitions_of(regions)
    rest = np.array([place if state == "E" else (np.nan, np.nan) for state, _, place in regions])
    slipped = "P" in sequence
    loop = PlanarLoop(
        np.atleast_1d(np.asarray(u_x, np.complex128)),
        np.atleast_1d(np.asarray(u_y, np.complex128)),
        np.atleast_1d(np.asarray(v, np.complex128)),
        float(mu), float(k_u), float(k_v), float(n_0),
        sequence, angles,
        motion.unknowns[0, :2] + length * rest,
        slider.integrals.work * scale * length if slipped else 0.0,
        slider.integrals.path * length if slipped else 0.0,
        0.0, since, np.array(slider.record)[: slider.panels],
    )  # fmt: skip
    return replace(loop, greatest_force=_greatest(loop, len(motion.harmonics)))


def _solved(motion: KernelArguments) -> PlanarContact:
    """The kernel with the steady cycle solved and all its panels recorded."""
    most = LOOP.recorded_panels
    while True:
        contact = PlanarContact(motion.harmonics, motion.outputs, most, FINEST)
        contact.at(motion.unknowns[0], ContactParameters(*motion.parameters[0].tolist()), False)
        if np.isnan(contact.forces).any():
            raise RuntimeError("no steady cycle of the motion was found")
        if contact.cycle.slider.panels <= most:
            return contact
        most = contact.cycle.slider.panels


def visible(contact: PlanarContact) -> list[Piece]:
    """Pieces (state, first angle, place of the slider) longer than rounding, with equal neighbours joined."""
    slider = contact.cycle.slider
    begin = np.asarray(slider.begin)[: slider.pieces]
    lengths = np.diff(begin, append=begin[0] + 2.0 * np.pi)
    shown = np.flatnonzero((lengths > FINEST.min_state_length) | (slider.pieces == 1)).astype(np.intc)
    left = join_states(np.asarray(slider.state)[shown], shown, len(shown))
    regions: list[Piece] = [
        (LETTERS[slider.state[p]], float(begin[p]), (float(slider.rest_x[p]), float(slider.rest_y[p])))
        for p in shown[:left].tolist()
    ]
    states = [state for state, _, _ in regions]
    first = next((i for i, state in enumerate(states) if state == "E"), 0)
    return from_piece(first, regions)


def _greatest(loop: PlanarLoop, harmonics: int) -> float:
    """Greatest |f|: at a transition, or by fine sampling near the angle where a coarse sample is greatest."""
    step = 2.0 * np.pi / (LOOP.angles_per_harmonic * max(harmonics, 1))
    theta = np.concatenate((loop.angles, np.arange(0.0, 2.0 * np.pi, step)))
    size = np.hypot(*np.moveaxis(loop.force(theta), -1, 0))
    best = theta[np.argmax(size)]
    near = best + np.linspace(-step, step, 201)
    return float(max(size.max(), np.hypot(*np.moveaxis(loop.force(near), -1, 0)).max()))


def directions(panels: FloatArray, theta: FloatArray) -> FloatArray:
    """Directions of slip (point, 2) at an angle in each given panel (point, 5 + s), see `Slider.record`."""
    begin, length, left = panels[:, 0], panels[:, 1], panels[:, 4]
    part = np.clip((theta - begin) / length, 0.0, 1.0)
    graded = left > 0.0
    gone = part[graded] * length[graded] / left[graded]
    part[graded] = (1.0 - np.sqrt(1.0 - gone)) / (1.0 - np.sqrt(1.0 - length[graded] / left[graded]))
    turned = np.exp(2j * np.arctan(between(panels[:, 5:], part))) * (panels[:, 2] + 1j * panels[:, 3])
    return np.stack((turned.real, turned.imag), axis=-1)


def between(tangent: FloatArray, part: FloatArray) -> FloatArray:
    """Value of each panel's polynomial (point, s), which is 0 at the start, at a fraction of the panel."""
    rule = radau(STAGES)
    nodes = np.concatenate(([0.0], rule.nodes))
    values = np.concatenate((np.zeros((tangent.shape[0], 1)), tangent), axis=1)
    apart = part[:, None] - nodes
    hit = apart == 0.0
    weights = rule.bary / np.where(hit, 1.0, apart)
    weights = np.where(hit.any(axis=1)[:, None], hit, weights)
    found: FloatArray = (weights * values).sum(axis=1) / weights.sum(axis=1)
    return found
