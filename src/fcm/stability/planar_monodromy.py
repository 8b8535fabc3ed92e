r"""What becomes of a small disturbance of a motion whose contacts slide in a plane, within one period.

The modes, of mass 1 and with shapes P on the ports, obey as on a line (see `monodromy`)

    q'' + 2 zeta w q' + w^2 q = - P dF

and the forces of a contact in its plane change with its displacements du (2,), dv and with what its slider
remembers. With r = mu n / k_u, dr = mu k_v dv / k_u and the direction of slip e = (cos alpha, sin alpha):

    stick        df = k_u (du - dw),                               dw constant
    slip         df = k_u (dr e + (e_perp . du - s) e_perp),       s = e_perp . dw,   e . dw = e . du - dr
                 s' = (lambda / r) (e_perp . du - s) - alpha' (e . du - dr)
    separation   df = dn = 0

The equation of s is that of the direction, r alpha' = e_perp . u', linearised. Forces are continuous, so
events make nothing jump but what is remembered: as slip begins s = e_perp . dw, as it ends dw is put
together again; at a closing w = u where the load vanishes, so dw = du - u' dv / v' if it sticks, and
s = e_perp . du if it slips at once. A slider that never slips stays where it is.

Between events the equations are carried by Magnus's series of the fourth order (Blanes, Casas, Oteo, Ros,
Phys. Rep. 470, 2009): by the exponential of

    h (A_1 + A_2) / 2 - sqrt(3) h^2 [A_1, A_2] / 12,    A_1, A_2 at Gauss's two points,

which is exact where nothing slips. Where the radius vanishes the steps are shorter and shorter.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from fcm.contact.plane.forces import PlanarContact
from fcm.contact.plane.loop import directions as slip_directions
from fcm.contact.plane.loop import visible
from fcm.model.scene import FloatArray
from fcm.stability.options import STABILITY, PlanarStabilityOptions

IntArray = npt.NDArray[np.intp]
TWO_PI = 2.0 * np.pi
GAUSS = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0)  # points of a step


@dataclass
class Cycle:
    """One contact over a period: where each of its states begins [rad], which (E, P, S), and the slip."""

    begin: FloatArray  # (state,), rising from the first
    state: list[str]
    panels: FloatArray  # (panel, 5 + s): as `Slider.record`
    place: FloatArray  # (state, 2) of the slider, where it rests
    waves: npt.NDArray[np.complex128]  # (harmonic, 3) of u_x, u_y and r
    numbers: FloatArray  # (harmonic,)
    mean: FloatArray  # (3,)

    @property
    def moving(self) -> bool:
        """Whether it changes its state or slips."""
        return len(self.state) > 1 or self.state[0] == "P"

    def at(self, theta: float) -> str:
        """The state at an angle."""
        return str(self.states(np.array([theta]))[0])

    def states(self, theta: FloatArray) -> npt.NDArray[np.str_]:
        """Those at angles (angle,)."""
        since = np.mod(theta - self.begin[0], TWO_PI)
        at = np.searchsorted(self.begin - self.begin[0], since, side="right") - 1
        found: npt.NDArray[np.str_] = np.array(self.state)[at]
        return found

    def rates(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """r (angle,), and u_x', u_y', r' (angle, 3)."""
        turned = np.exp(1j * np.outer(theta, self.numbers))
        rate: FloatArray = (1j * self.numbers * turned @ self.waves).real
        r: FloatArray = self.mean[2] + (turned @ self.waves[:, 2]).real
        return r, rate

    def directions(self, theta: FloatArray) -> FloatArray:
        """Of the slip at angles (angle,), (angle, 2)."""
        first = self.panels[0, 0]
        t = first + np.mod(theta - first, TWO_PI)
        panel = self.panels[np.searchsorted(self.panels[:, 0], t, side="right") - 1]
        return slip_directions(panel, t)


@dataclass
class PlanarSequence:
    """`poll` at a motion finds the cycles of its contacts; contact (contact, 4): mu, k_u, k_v, n_0."""

    contact: FloatArray
    harmonics: tuple[int, ...]
    options: PlanarStabilityOptions = STABILITY.planar
    cycles: list[Cycle] = field(default_factory=list)
    moving: int = 0  # contacts that slip with friction, or open and close
    held: int = 0  # none: a slider that never slips stays where it is
    yielding: bool = True

    def __post_init__(self) -> None:
        self.kernel = PlanarContact(list(self.harmonics), [1], self.options.panels)
        self.width = 3 + 6 * len(self.harmonics)

    def find_events(self, x: FloatArray) -> bool:
        """Find the states of the motion x; false where a number is not finite, or a cycle is not found."""
        self.cycles = []
        for c, numbers in enumerate(self.contact):
            block = np.ascontiguousarray(np.asarray(x)[c * self.width : (c + 1) * self.width])
            if not self._cycle(block, numbers):
                return False
        self.moving = sum(one.moving for one in self.cycles)
        return True

    def _cycle(self, x: FloatArray, numbers: FloatArray) -> bool:
        mu, k_u, k_v, n_0 = numbers.tolist()
        while True:
            self.kernel.at(x, mu, k_u, k_v, n_0, 0.0, 0.0, False)
            slider = self.kernel.cycle.slider
            if np.isnan(self.kernel.forces[2]):
                return False
            if slider.panels <= len(slider.record):
                break
            self.kernel = PlanarContact(list(self.harmonics), [1], 2 * slider.panels)
        regions = visible(self.kernel)
        state = [letter for letter, _, _ in regions]
        if mu * k_u == 0.0:
            state = ["F" if letter != "S" else letter for letter in state]  # closed without friction
        if len(set(state)) == 1 and state[0] != "P":
            regions, state = regions[:1], state[:1]
        pairs = x[3:].reshape(-1, 3, 2)
        ratio = np.array([1.0, 1.0, mu * k_v / k_u if k_u > 0.0 else 0.0])
        mean = np.array([0.0, 0.0, mu * (n_0 + k_v * x[2]) / k_u if k_u > 0.0 else 0.0])
        unit = self.kernel.motion.scale / k_u if k_u > 0.0 else 0.0
        self.cycles.append(
            Cycle(
                np.array([begin for _, begin, _ in regions]),
                state,
                np.array(slider.record)[: slider.panels],
                x[:2] + unit * np.array([place for _, _, place in regions]),
                (pairs[..., 0] + 1j * pairs[..., 1]) * ratio,
                np.array(self.harmonics, dtype=np.float64),
                mean,
            )
        )
        return True


class PlanarMonodromy:
    """`follow` a sequence: `matrix` is then the derivative of (q, q', memory) after a period by that before.

    Velocities are by the angle.

    Parameters
    ----------
    shapes, natural, damping : (mode, port), (mode,), (mode,)
        Of all modes, of mass 1; three ports for each contact; natural frequencies in rad/s.
    far : (mode,) bool
        Which follow without delay.
    """

    def __init__(
        self,
        shapes: FloatArray,
        natural: FloatArray,
        damping: FloatArray,
        far: npt.NDArray[np.bool_],
        sequence: PlanarSequence,
    ) -> None:
        self.sequence = sequence
        self.shapes, self.natural, self.damping = shapes[~far], natural[~far], damping[~far]
        self.soft = (shapes[far].T * natural[far] ** -2.0) @ shapes[far]
        self.modes, self.contacts = len(self.natural), len(sequence.contact)
        self._matrix = np.zeros((0, 0))

    def matrix(self) -> FloatArray:
        """(2 modes + memories, the same); of more disturbances than the options allow, not a number."""
        return self._matrix

    def follow(self, omega: float) -> None:
        """Fill the matrix for a frequency."""
        moving = [c for c, one in enumerate(self.sequence.cycles) if one.moving]
        start = self._start(moving)
        states = [one.at(start) for one in self.sequence.cycles]
        m, options = self.modes, self.sequence.options
        memory = [2 * m + 2 * k + i for k, c in enumerate(moving) for i in range(_memories(states[c]))]
        columns = [*range(2 * m), *memory]
        if len(columns) > options.most:
            self._matrix = np.full((1, 1), np.nan)
            return
        size = 2 * m + 2 * len(moving)
        Y = np.zeros((size, len(columns)))
        Y[columns, range(len(columns))] = 1.0
        events = sorted(
            ((begin - start) % TWO_PI, k, i)
            for k, c in enumerate(moving)
            for i, begin in enumerate(self.sequence.cycles[c].begin)
            if len(self.sequence.cycles[c].state) > 1
        )
        steps = self._steps(moving, start, np.array([at for at, _, _ in events]))
        carried, at = self._exponentials(omega, moving, start, steps), 0
        for angle, k, i in events:
            while at < len(carried) and steps[at] < angle - options.same:
                Y = carried[at] @ Y
                at += 1
            Y = self._happened(moving, states, k, i, start + angle, Y)
        for one in carried[at:]:
            Y = one @ Y
        self._matrix = Y[columns]

    def _start(self, moving: list[int]) -> float:
        """An angle at which little is remembered, in the middle between two events."""
        cycles = self.sequence.cycles
        at = np.sort(np.mod(np.concatenate([[0.0], *(cycles[c].begin for c in moving)]), TWO_PI))
        gap = np.diff(at, append=at[0] + TWO_PI)
        middle = at + 0.5 * gap
        counts = [sum(_memories(cycles[c].at(theta)) for c in moving) for theta in middle]
        longest = max(range(len(at)), key=lambda j: (-counts[j] if gap[j] > 1e-6 else -np.inf, gap[j]))
        return float(middle[longest])

    def _steps(self, moving: list[int], start: float, events: FloatArray) -> FloatArray:
        """Where steps begin, and the end of the last, from the start (step + 1,), events among them."""
        cycles, options = self.sequence.cycles, self.sequence.options
        edges = [np.array([0.0, TWO_PI]), events]
        for one in (cycles[c] for c in moving):
            if len(one.panels):
                edges.append(np.mod(one.panels[:, 0] - start, TWO_PI))
            edges += [self._graded(one, j, start) for j in range(len(one.begin))]
        edge = np.unique(np.concatenate(edges))
        edge = edge[np.concatenate(([True], np.diff(edge) > options.same))]
        length = np.diff(edge)
        parts = np.ones(length.size)
        middle = start + edge[:-1] + 0.5 * length
        for one in (cycles[c] for c in moving):
            slips = one.states(middle) == "P"
            if slips.any():
                theta = middle[slips]
                r, rate = one.rates(theta)
                fastest = np.hypot(rate[:, 0], rate[:, 1]) / np.maximum(np.abs(r), 1e-12 * np.abs(r).max())
                by = np.maximum(
                    one.numbers[_last(one)] / options.step,
                    np.minimum(fastest / options.turn, 8.0 / length[slips]),
                )
                parts[slips] = np.maximum(parts[slips], np.ceil(length[slips] * by))
        inner = [a + (b - a) * np.arange(n) / n for a, b, n in zip(edge, edge[1:], parts, strict=False)]
        return np.concatenate((*inner, [TWO_PI]))

    def _graded(self, one: Cycle, j: int, start: float) -> FloatArray:
        """Edges towards the beginning of a state at which the radius vanishes."""
        before, now = one.state[j - 1], one.state[j]
        if {before, now} != {"S", "P"}:
            return np.zeros(0)
        options, n = self.sequence.options, len(one.begin)
        forward = now == "P"
        other = (one.begin[(j + 1) % n] - one.begin[j]) if forward else (one.begin[j] - one.begin[j - 1])
        room = 0.5 * (other % TWO_PI)
        away = min(room, 0.5) * options.shrink ** np.arange(options.graded)
        edges: FloatArray = np.mod(one.begin[j] - start + (away if forward else -away), TWO_PI)
        return edges

    def _exponentials(
        self, omega: float, moving: list[int], start: float, steps: FloatArray
    ) -> npt.NDArray[np.float64]:
        """Of each step, (step, size, size)."""
        h = np.diff(steps)
        theta = start + steps[:-1, None] + h[:, None] * GAUSS
        A = self._system(omega, moving, theta.ravel()).reshape(
            h.size, 2, -1, 2 * self.modes + 2 * len(moving)
        )
        one, other = A[:, 0], A[:, 1]
        scale = h[:, None, None]
        series = 0.5 * scale * (one + other) - np.sqrt(3.0) / 12.0 * scale**2 * (one @ other - other @ one)
        from scipy.linalg import expm  # whose import takes longer than the curves of other contacts

        return np.asarray(expm(series))

    def _system(self, omega: float, moving: list[int], theta: FloatArray) -> FloatArray:
        """A (angle, size, size) of (q, q', memory)' = A (q, q', memory)."""
        m, size, cycles = self.modes, 2 * self.modes + 2 * len(moving), self.sequence.cycles
        ports, still = 3 * self.contacts, set(range(self.contacts)) - set(moving)
        K, L = np.zeros((theta.size, ports, ports)), np.zeros((theta.size, ports, 2 * len(moving)))
        B, D = np.zeros((theta.size, 2 * len(moving), ports)), np.zeros((theta.size, 2 * len(moving)))
        for c in still:
            if cycles[c].state[0] != "S":
                _, k_u, k_v, _ = self.sequence.contact[c]
                rubs = k_u if cycles[c].state[0] == "E" else 0.0
                K[:, range(3 * c, 3 * c + 3), range(3 * c, 3 * c + 3)] = rubs, rubs, k_v
        for k, c in enumerate(moving):
            self._contact(c, k, theta, (K, L, B, D))
        shapes = np.broadcast_to(self.shapes.T, (theta.size, ports, m))
        seen: FloatArray = shapes
        through = np.zeros((theta.size, ports, 2 * len(moving)))
        if self.soft.any():
            inverse = np.linalg.inv(np.eye(ports) + self.soft @ K)
            seen, through = inverse @ shapes, inverse @ (self.soft @ L)
        A = np.zeros((theta.size, size, size))
        A[:, range(m), range(m, 2 * m)] = 1.0
        push = -self.shapes / omega**2
        A[:, m : 2 * m, :m] = push @ (K @ seen)
        A[:, range(m, 2 * m), range(m)] -= (self.natural / omega) ** 2
        A[:, range(m, 2 * m), range(m, 2 * m)] = -2.0 * self.damping * self.natural / omega
        A[:, m : 2 * m, 2 * m :] = push @ (K @ through - L)
        A[:, 2 * m :, :m] = B @ seen
        A[:, 2 * m :, 2 * m :] = B @ through
        A[:, range(2 * m, size), range(2 * m, size)] -= D
        return A

    def _contact(self, c: int, k: int, theta: FloatArray, parts: tuple[FloatArray, ...]) -> None:
        """Fill the parts K, L, B, D of one contact, number k of those that move."""
        K, L, B, D = parts
        one, (mu, k_u, k_v, _) = self.sequence.cycles[c], self.sequence.contact[c]
        x, y, v = range(3 * c, 3 * c + 3)
        state = one.states(theta)
        closed, stick, slip = state != "S", state == "E", state == "P"
        K[closed, v, v] = k_v
        K[stick, x, x] = K[stick, y, y] = k_u
        L[stick, x, 2 * k] = L[stick, y, 2 * k + 1] = k_u
        if not slip.any():
            return
        e = one.directions(theta[slip])
        across = np.stack((-e[:, 1], e[:, 0]), axis=-1)
        r, rate = one.rates(theta[slip])
        turning = (across * rate[:, :2]).sum(axis=1) / r
        follows = np.maximum((e * rate[:, :2]).sum(axis=1) - rate[:, 2], 0.0) / r
        ratio = mu * k_v / k_u
        for i, row in enumerate((x, y)):
            for j, column in enumerate((x, y)):
                K[slip, row, column] = k_u * across[:, i] * across[:, j]
            K[slip, row, v] = mu * k_v * e[:, i]
            L[slip, row, 2 * k] = k_u * across[:, i]
            B[slip, 2 * k, row] = follows * across[:, i] - turning * e[:, i]
        B[slip, 2 * k, v] = turning * ratio
        D[slip, 2 * k] = follows

    def _happened(
        self, moving: list[int], states: list[str], k: int, i: int, theta: float, Y: FloatArray
    ) -> FloatArray:
        """Y after an event: state i of a contact begins."""
        c = moving[k]
        one, now = self.sequence.cycles[c], self.sequence.cycles[c].state[i]
        before, states[c] = states[c], now
        row = 2 * self.modes + 2 * k
        kept, made = Y[row : row + 2].copy(), np.zeros((2, Y.shape[1]))
        if now in ("E", "P"):
            du = self._displaced(moving, theta, Y)[3 * c : 3 * c + 3]
            _, rate = one.rates(np.array([theta]))
            mu, k_u, k_v, _ = self.sequence.contact[c]
        if now == "P":
            e = one.directions(np.array([theta + self.sequence.options.inside]))[0]
            across = np.array([-e[1], e[0]])
            made[0] = across @ (du[:2] if before == "S" else kept)
        elif now == "E" and before == "S":
            load = rate[0, 2] * k_u / (mu * k_v)  # v'
            made[:] = du[:2] - np.outer(rate[0, :2] / load, du[2])
        elif now == "E":
            e = one.directions(np.array([theta - self.sequence.options.inside]))[0]
            across = np.array([-e[1], e[0]])
            made[:] = np.outer(e, e @ du[:2] - mu * k_v / k_u * du[2]) + np.outer(across, kept[0])
        Y = Y.copy()
        Y[row : row + 2] = made
        return Y

    def _displaced(self, moving: list[int], theta: float, Y: FloatArray) -> FloatArray:
        """Displacements of the ports (port, disturbance) just before an event."""
        own: FloatArray = self.shapes.T @ Y[: self.modes]
        if not self.soft.any():
            return own
        ports, memories = 3 * self.contacts, 2 * len(moving)
        K, L = np.zeros((1, ports, ports)), np.zeros((1, ports, memories))
        B, D = np.zeros((1, memories, ports)), np.zeros((1, memories))
        at = np.array([theta - self.sequence.options.inside])
        for k, c in enumerate(moving):
            self._contact(c, k, at, (K, L, B, D))
        for c in set(range(self.contacts)) - set(moving):
            if self.sequence.cycles[c].state[0] != "S":
                _, k_u, k_v, _ = self.sequence.contact[c]
                rubs = k_u if self.sequence.cycles[c].state[0] == "E" else 0.0
                K[0, range(3 * c, 3 * c + 3), range(3 * c, 3 * c + 3)] = rubs, rubs, k_v
        own = own + self.soft @ (L[0] @ Y[2 * self.modes :])
        return np.linalg.solve(np.eye(ports) + self.soft @ K[0], own)


def _memories(state: str) -> int:
    """Numbers that a contact remembers in a state: the place of its slider, or its direction."""
    return {"E": 2, "P": 1}.get(state, 0)


def _last(one: Cycle) -> int:
    """The highest harmonic that the motion has."""
    size = np.abs(one.waves).max(axis=1)
    return int(np.flatnonzero(size > 0.0)[-1]) if size.any() else 0
