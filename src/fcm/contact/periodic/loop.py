"""The hysteresis loop of a contact over any periodic motion: its states, transitions and forces."""

from __future__ import annotations

from dataclasses import field

import numpy as np
import numpy.typing as npt

from fcm.contact.contact_kernel import ContactParameters
from fcm.contact.kernel_arguments import ComplexArray, FloatArray, KernelArguments
from fcm.contact.options import PERIODIC
from fcm.contact.periodic.cycle import LineCycle, PeriodicContact, join_states
from fcm.contact.periodic.margins import Measures
from fcm.contact.pieces import LoadedPieces, Piece, friction, from_piece, transitions_of, waves_at
from fcm.frozen import Frozen

STICK = 0  # of the kernel's states
LETTERS = {-1: "N", STICK: "E", 1: "P", 2: "S"}


class PeriodicLoop(Frozen, LoadedPieces):
    """One steady cycle of a contact under x(theta) = Re sum_h X_h exp(i h theta).

    Attributes
    ----------
    u, v : ndarray, complex, shape (harmonic,) [length]
        The motion, as given to `periodic_loop`, as are mu [-], k_u, k_v [force / length] and n_0 [force].
    sequence : str
        The states in order, E stick, P positive slip, N negative slip, S separation: 'EPEN', 'SEPSP', ...
    angles : ndarray, shape (len(sequence),) or (0,) for a single state [rad]
        ``angles[i]`` in [0, 2 pi) is where state ``sequence[i]`` begins and the one before it ends.
    slip_motion : ndarray, shape (max(len(angles), 1),) [length]
        w while the contact sticks, for each state; NaN for the others.
    dissipation : float
        Energy dissipated by friction in a cycle [force length].
    slip_path : float
        Path of the slider while it slips, in a cycle [length].
    greatest_force, least_load, greatest_load : float
        Greatest |f|; least and greatest n_0 + k_v v, negative where the contact is open [force].
    overlap : float
        Greatest lower limit of k_u w minus its least upper limit, equation (25) [force]; below 0 it never
        slips.
    """

    u: ComplexArray
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
    least_load: float
    greatest_load: float
    overlap: float
    _since: FloatArray = field(default_factory=lambda: np.empty(0), repr=False)  # angles from the first on

    def displacement(self, theta: npt.ArrayLike) -> FloatArray:
        """Displacement u [length] at each angle theta [rad]."""
        return waves_at(self.u, theta)

    def force(self, theta: npt.ArrayLike) -> FloatArray:
        """Friction force f [force] at each angle theta [rad].

        >>> periodic_loop([0.0, -1j], [0.0], 0.5, 1.0, 1.0, 1.0).force(np.pi / 2).item()
        0.5
        """
        angle = np.asarray(theta, dtype=np.float64)
        slid = np.nan_to_num(self.slip_motion)[self._piece(angle)]
        stick = self.k_u * (self.displacement(angle) - slid)
        return friction(self.states(angle), stick, self.slip_limit(angle))


def periodic_loop(
    u: npt.ArrayLike, v: npt.ArrayLike, mu: float, k_u: float, k_v: float, n_0: float, *, start: float = 0.0
) -> PeriodicLoop:
    """The steady hysteresis loop of one contact under any periodic motion, its events located exactly.

    Parameters
    ----------
    u, v : array_like, complex, shape (harmonic,)
        Coefficients of the displacements. mu, k_u, k_v, n_0 and start are numbers, as in `periodic_forces`.

    Returns
    -------
    PeriodicLoop
        With `sequence`, `angles`, and the functions of the angle `force`, `normal_load`, `displacement`,
        `states`.

    Raises
    ------
    ValueError
        If mu, k_u or k_v is negative, or a number is not finite.

    Examples
    --------
    >>> loop = periodic_loop([0.0, -1j, 0.0, 0.4], [0.0, 1.0], mu=0.4, k_u=1.0, k_v=1.0, n_0=0.5)
    >>> loop.sequence
    'SNEPEPEN'
    """
    numbers = {"mu": mu, "k_u": k_u, "k_v": k_v, "n_0": n_0, "start": start}
    motion = KernelArguments.of_one({"u": u, "v": v}, numbers)
    contact = PeriodicContact(motion.harmonics, motion.outputs)
    contact.at(motion.unknowns[0], ContactParameters(*motion.parameters[0].tolist()), False)
    measures = Measures(contact.cycle)
    measures.measure(k_u)
    length = contact.motion.scale / k_u if k_u > 0.0 else 0.0
    mean = float(motion.unknowns[0, 0])
    regions = _ordered(_visible(contact.cycle))
    sequence, angles, since = transitions_of(regions)
    return PeriodicLoop(
        np.atleast_1d(np.asarray(u, np.complex128)),
        np.atleast_1d(np.asarray(v, np.complex128)),
        float(mu), float(k_u), float(k_v), float(n_0),
        sequence, angles,
        np.array([mean + length * rest if state == "E" else np.nan for state, _, rest in regions]),
        measures.dissipation, measures.slip_path,
        measures.greatest_friction, measures.least_load, measures.greatest_load, measures.overlap,
        since,
    )  # fmt: skip


def _visible(cycle: LineCycle) -> list[Piece]:
    """Pieces (state, first angle, place of the slider) longer than rounding, with equal neighbours joined."""
    begin = np.asarray(cycle.begin)[: cycle.pieces]
    length = np.diff(begin, append=begin[0] + 2.0 * np.pi)
    shown = np.flatnonzero((length > PERIODIC.min_state_length) | (cycle.pieces == 1)).astype(np.intc)
    seen = {p: _seen(cycle, p) for p in shown.tolist()}
    left = join_states(np.array([state for state, _ in seen.values()], np.intc), shown, len(shown))
    return [(LETTERS[seen[p][0]], float(begin[p]), seen[p][1]) for p in shown[:left].tolist()]


def _seen(cycle: LineCycle, p: int) -> tuple[int, float]:
    """State of piece p and initial place of the slider; a slip shorter than rounding counts as a stick."""
    state = cycle.state[p]
    if LETTERS[state] not in "PN":
        return state, float(cycle.rest[p])
    limit = cycle.lower if state > 0 else cycle.upper
    begin, end = (float(limit[cycle.event[q % cycle.pieces]]) for q in (p, p + 1))
    return state if abs(end - begin) > PERIODIC.min_state_length else STICK, begin


def _ordered(regions: list[Piece]) -> list[Piece]:
    """The pieces, beginning with a separation, or without one with a stick after negative slip.

    If there are several, the first after angle 0 is taken.
    """
    states = [state for state, _, _ in regions]
    firsts = [i for i, state in enumerate(states) if state == "S"] or [
        i for i, state in enumerate(states) if state == "E" and states[i - 1] == "N"
    ]
    if not firsts:
        return regions
    return from_piece(min(firsts, key=lambda i: regions[i][1] % (2.0 * np.pi)), regions)
