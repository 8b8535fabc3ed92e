r"""What becomes of a small disturbance of a motion with many contacts that slide in a plane, within a period.

The same equations as in `planar_monodromy`, collocated at the same points. But with K the springs of all
contacts as if they stuck, S the flexibility of the modes far above, and P the shapes of the others, the
structure with these springs is put together once:

    d = R^-1 P^T q + R^-1 S g,    R = 1 + S K,    q'' + .. + (w^2 + P K R^-1 P^T) q = (R^-1 P^T)^T g

What a contact does otherwise than stick is a force g on it, of which there is none where it sticks all
through the cycle:

    stick        g = k_u dw
    slip         g = k_u (e . du - dr) e + k_u s e_perp
    separation   g = K d

One that is open is linear as long as it stays so: with T = (K_o^-1 - (R^-1 S)_oo)^-1 of these it is put into
the structure, until another one opens or closes:

    d = (R^-1 P^T + (R^-1 S)_o T (R^-1 P^T)_o) q + (R^-1 S + (R^-1 S)_o T (R^-1 S)_o) g

What depends on one angle alone is found at each point by itself: e . du - dr of the contacts that slip, of
(q, s). Then q of s at all points, as modes are few; what is left of a step are equations of s, one unknown
for each contact that slips and point.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from fcm.contact.plane.radau import radau
from fcm.stability.planar_monodromy import VariationalSteps
from fcm.stability.state_sequence import PlanarSequence, states

FloatArray = npt.NDArray[np.float64]
STICK, SLIP, SEPARATION = states()


class ManyPlanarMonodromy(VariationalSteps):
    """Of many contacts: of those that never move nothing is followed.

    Parameters
    ----------
    shapes, natural, damping : (mode, port), (mode,), (mode,)
        Of all modes, of mass 1; three ports for each contact; natural frequencies in rad/s.
    far : (mode,) bool
        Which follow without delay.
    poll : callable, optional
        Called at every event, which it may interrupt.
    """

    def __init__(
        self,
        shapes: FloatArray,
        natural: FloatArray,
        damping: FloatArray,
        far: npt.NDArray[np.bool_],
        sequence: PlanarSequence,
        poll: Callable[[], object] = int,
    ) -> None:
        self.poll, self.options = poll, sequence.options
        options = self.options
        VariationalSteps.__init__(self, sequence, options.stages_of_many, options.tolerance_of_many)
        self.shapes, self.natural, self.damping = shapes[~far], natural[~far], damping[~far]
        self.all_soft = (shapes[far].T * natural[far] ** -2.0) @ shapes[far]
        self.rule = radau(self.stages)
        self.butcher = A = np.linalg.inv(self.rule.slopes[1:, 1:])
        self.twice = A[:, None, :] * A.T[None]  # A A = twice summed over the last

    def begin(self, omega: float) -> bool:
        """Take a frequency, and the disturbances to be followed; false if they are too many."""
        count, state = np.asarray(self.sequence.count), np.asarray(self.sequence.state)
        self.moving = np.flatnonzero((count > 1) | (state[:, 0] == SLIP))
        self.number = np.full(count.size, -1)
        self.number[self.moving] = np.arange(self.moving.size)
        m, held = self.natural.size, np.asarray(self.held)[self.moving]
        columns = 2 * m + int(held.sum())
        if columns > self.options.most_of_many:
            return False
        self._structure(omega)
        self.q, self.p = np.eye(m, columns), np.eye(m, columns, m)
        # (contact, number, disturbance), and the forces g (contact, direction, disturbance) of closed ones
        self.memory, self.g = (np.zeros((self.moving.size, n, columns)) for n in (2, 3))
        self.remembered = [(k, i) for k, n in enumerate(held.tolist()) for i in range(n)]
        for column, (k, i) in enumerate(self.remembered, 2 * m):
            self.memory[k, i, column] = 1.0
        sticks = np.asarray(self.state)[self.moving] == STICK
        self.g[sticks, :2] = self.k_u[sticks, None, None] * self.memory[sticks]
        self.arranged = False
        return True

    def _structure(self, omega: float) -> None:
        """That with the springs: what moving contacts see of the modes, and of one another's forces."""
        contact, m = np.asarray(self.sequence.contact), self.natural.size
        rubs = contact[:, 0] * contact[:, 1] > 0.0
        opened = (np.asarray(self.sequence.count) == 1) & (np.asarray(self.state) == SEPARATION)
        springs = np.stack((contact[:, 1] * rubs, contact[:, 1] * rubs, contact[:, 2]), axis=1)
        springs[opened] = 0.0
        self.k_u, self.springs = springs[self.moving, 0], springs[self.moving]
        self.ratio = np.where(rubs, contact[:, 0] * contact[:, 2] / np.where(rubs, contact[:, 1], 1.0), 0.0)
        self.ratio, every = self.ratio[self.moving], springs.ravel()
        ports = _ports(self.moving)
        seen: FloatArray = self.shapes.T
        soft: FloatArray = self.all_soft[:, ports]
        if self.all_soft.any():
            R: FloatArray = np.eye(every.size) + self.all_soft * every
            found = np.asarray(np.linalg.solve(R, np.concatenate((seen, soft), axis=1)), dtype=np.float64)
            seen, soft = found[:, :m], found[:, m:]
        self.C = 2.0 * self.damping * self.natural / omega
        self.omega = omega
        self.K_closed = ((self.shapes * every) @ seen + np.diag(self.natural**2)) / omega**2
        self.seen_closed, self.soft_closed = seen[ports], soft[ports]
        self.open = np.full(1, -1)  # of no contact yet

    def _open(self, contacts: npt.NDArray[np.intp]) -> None:
        """Put contacts that are open into the structure with the springs of all."""
        self.open, ports = contacts, _ports(contacts)
        seen, soft, K = self.seen_closed, self.soft_closed, self.K_closed
        if ports.size:
            springs = self.springs[contacts].ravel()
            freed = np.eye(ports.size) - soft[np.ix_(ports, ports)] * springs
            both = np.concatenate((seen[ports], soft[ports]), axis=1)
            force = springs[:, None] * np.asarray(np.linalg.solve(freed, both), dtype=np.float64)
            m = self.natural.size
            K = K - seen[ports].T @ force[:, :m] / self.omega**2
            seen, soft = seen + soft[:, ports] @ force[:, :m], soft + soft[:, ports] @ force[:, m:]
        self.K, self.seen, self.soft = K, seen, soft
        self.push = self.seen.T / self.omega**2

    def disturbances(self) -> FloatArray:
        """The rows (q, q', memory) now."""
        kept = np.array([self.memory[k, i] for k, i in self.remembered]).reshape(-1, self.q.shape[1])
        return np.concatenate((self.q, self.p, kept))

    def _arrange(self) -> None:
        """Which contacts slip, are open, and stick, and what those do to one another."""
        self.poll()
        state, columns = np.asarray(self.state)[self.moving], self.q.shape[1]
        self.slips, sticks = np.flatnonzero(state == SLIP), np.flatnonzero(state == STICK)
        opened = np.flatnonzero(state == SEPARATION)
        if not np.array_equal(opened, self.open):
            self._open(opened)
        n = self.slips.size
        slide, rest = _ports(self.slips), _ports(sticks, 2)
        # what the memory of those that stick pushes on the modes, and moves the others by
        still = self.g[sticks, :2].reshape(rest.size, columns)
        self.held_push = self.push[:, rest] @ still
        moved = self.soft[slide[:, None], rest] @ still
        by = np.concatenate((self.seen[slide], moved), axis=1)
        # of contacts that slip, by their directions: (direction, contact, what by)
        self.by = by.reshape(n, 3, by.shape[1]).transpose(1, 0, 2).copy()
        soft = self.soft[slide[:, None], slide].reshape(n, 3, n, 3)
        self.of_slips = soft[..., :2].transpose(1, 3, 0, 2).copy()
        self.pushes = self.push[:, slide].reshape(self.natural.size, n, 3)[..., :2].transpose(2, 0, 1).copy()
        self.arranged = True

    def _slip(self, theta: float, h: float) -> None:
        """Of the contacts that slip, at the nodes: directions, what s feels, and how it answers to that."""
        s, rule, n = self.stages, self.rule, self.slips.size
        angles = theta + h * rule.nodes
        found = [self.sequence.slip_at(c, angles) for c in self.moving[self.slips].tolist()]
        e, rate, r = np.split(np.array(found).reshape(n, s, 6).transpose(1, 0, 2), (2, 5), axis=2)
        r = r[..., 0]
        r = np.maximum(r, 1e-12 * np.abs(r).max(initial=0.0)).T
        rate = h * rate
        aside = np.stack((-e[..., 1], e[..., 0]), axis=-1)
        across = (aside * rate[..., :2]).sum(axis=-1)
        push = np.maximum((e * rate[..., :2]).sum(axis=-1) - rate[..., 2], 0.0)
        ratio = self.ratio[self.slips]
        along = np.concatenate((e, np.broadcast_to(-ratio[:, None], (s, n, 1))), axis=-1)
        tangential = push[..., None] * aside - across[..., None] * e
        feels = np.concatenate((tangential, (across * ratio)[..., None]), axis=-1)
        self.sees = np.stack((along, feels))  # (2, s, contact, direction)
        fresh = np.asarray(self.fresh)[self.moving[self.slips], None, None] > 0
        self.relaxing = r[..., None] * np.where(fresh, rule.inner, rule.slopes[1:, 1:])
        self.relaxing[:, range(s), range(s)] += push.T
        self.kept = np.where(fresh[..., 0], 0.0, -r * rule.slopes[1:, 0]).T
        self.e, self.aside = e, aside

    def _at_each_node(self) -> tuple[FloatArray, FloatArray]:
        """By (q, s, each disturbance), at each node: what s feels, and the forces on the modes.

        `at_end`: e . du - dr at the last.
        """
        m, n = self.natural.size, self.slips.size
        k_u = self.k_u[self.slips, None]
        along, aside = ((k_u * e).transpose(2, 0, 1)[..., None, :] for e in (self.e, self.aside))
        # of both rows of a contact, e . du - dr and what s feels: (2, s, slip, what by)
        by: FloatArray = sum(self.sees[..., d, None] * self.by[d] for d in range(3))
        half = [sum(self.sees[..., d, None] * self.of_slips[d, j] for d in range(3)) for j in range(2)]
        by_gamma, by_s = (half[0] * force[0] + half[1] * force[1] for force in (along, aside))
        right = np.concatenate((by[..., :m], by_s, by[..., m:]), axis=-1)
        found = np.linalg.solve(np.eye(n) - by_gamma[0], right[0])
        self.at_end = found[-1]
        on_gamma, on_s = (self.pushes[0] * force[0] + self.pushes[1] * force[1] for force in (along, aside))
        pushed = on_gamma @ found
        pushed[..., m : m + n] += on_s
        pushed[..., m + n :] += self.held_push
        return right[1] + by_gamma[1] @ found, pushed

    def step(self, theta: float, h: float) -> float:
        """A step from an angle on; what it leaves out beside a disturbance, infinity where it is singular."""
        if not self.arranged:
            self._arrange()
        m, n, s, columns = self.natural.size, self.slips.size, self.stages, self.q.shape[1]
        self._slip(theta, h)
        try:
            felt, pushed = self._at_each_node()
            p, q = self._modes(pushed, h)
            by_q = felt[..., :m] @ q
            system = -by_q[..., : s * n].reshape(s, n, s, n)
            system[range(s), :, range(s)] -= felt[..., m : m + n]
            system[:, range(n), :, range(n)] += self.relaxing
            right = by_q[..., s * n :] + felt[..., m + n :]
            right += self.kept[..., None] * self.memory[self.slips, 0]
            turned = np.linalg.solve(system.reshape(s * n, s * n), right.reshape(s * n, columns))
        except np.linalg.LinAlgError:
            return np.inf
        p = (p[:, : s * n] @ turned + p[:, s * n :]).reshape(s, m, columns)
        self.p_new, self.q_new = p[-1], q[-1, :, : s * n] @ turned + q[-1, :, s * n :]
        self.s_new = turned[n * (s - 1) :]
        tail = np.tensordot(self.rule.tail, np.concatenate((self.p[None], p)), axes=1)
        scale = np.maximum(1.0, np.abs(np.concatenate((self.q, self.p))).max(axis=0, initial=0.0))
        before, last = np.abs(tail / scale).max(axis=(1, 2), initial=0.0).tolist()
        rest = float(max(last, self.options.coefficient_floor * before))
        return rest if rest == rest else np.inf

    def _modes(self, pushed: FloatArray, h: float) -> tuple[FloatArray, FloatArray]:
        """p (s mode, s slip + disturbance) and q (s, mode, the same) at the nodes, by s there.

        From q = q_0 + h A p and p = p_0 + h A p', with p' = -K q - C p + the forces on the modes.
        """
        m, n, s = self.natural.size, self.slips.size, self.stages
        once, columns = h * self.butcher, self.q.shape[1]
        K = self.K - pushed[..., :m]
        system = np.tensordot(h * h * self.twice, K, axes=1).transpose(0, 2, 1, 3)
        right = np.empty((s, m, s * n + columns))
        of_s = once[:, None, :, None] * pushed[..., m : m + n].transpose(1, 0, 2)
        right[..., : s * n] = of_s.reshape(s, m, s * n)
        right[..., s * n :] = self.p + np.tensordot(once, pushed[..., m + n :] - K @ self.q, axes=1)
        whole = system.reshape(s * m, s * m) + np.kron(once, np.diag(self.C)) + np.eye(s * m)
        p: FloatArray = np.asarray(np.linalg.solve(whole, right.reshape(s * m, -1)), dtype=np.float64)
        q: FloatArray = np.tensordot(once, p.reshape(s, m, -1), axes=1)
        q[..., s * n :] += self.q
        return p, q

    def accept(self) -> int:
        """The end of the step is where the disturbances are."""
        m, n = self.natural.size, self.slips.size
        self.q, self.p = self.q_new, self.p_new
        found = self.at_end[:, :m] @ self.q + self.at_end[:, m : m + n] @ self.s_new
        found += self.at_end[:, m + n :]
        k_u = self.k_u[self.slips, None, None]
        along, across = self.e[-1, :, :, None], self.aside[-1, :, :, None]
        self.g[self.slips] = 0.0
        self.g[self.slips, :2] = k_u * (along * found[:, None] + across * self.s_new[:, None])
        self.memory[self.slips, 0] = self.s_new
        np.asarray(self.fresh)[:] = 0
        return 0

    def apply_event(self, c: int, i: int) -> int:
        """State i of a contact begins: what it remembers of the disturbances."""
        sequence, k = self.sequence, int(self.number[c])
        before, now, angle = int(self.state[c]), int(sequence.state[c, i]), float(sequence.begin[c, i])
        np.asarray(self.state)[c] = now
        np.asarray(self.fresh)[c] = now == SLIP and before == SEPARATION
        w, made = self.memory[k], np.zeros_like(self.memory[k])
        if self.arranged:  # several events at one angle see the displacements before them all
            self.g_before = self.g.copy()
        if {before, now} == {STICK, SLIP}:
            e = sequence.slip_at(c, np.array([angle]), now == STICK)[0, :2]
            aside = np.array([-e[1], e[0]])
        if now == STICK:
            ports = slice(3 * k, 3 * k + 3)
            du = self.seen[ports] @ self.q + self.soft[ports] @ self.g_before.reshape(-1, self.q.shape[1])
        if now == SLIP and before == STICK:
            made[0] = aside @ w
        elif now == STICK and before == SLIP:
            made = np.outer(e, e @ du[:2] - self.ratio[k] * du[2]) + np.outer(aside, w[0])
        elif now == STICK:
            rate = sequence.slip_at(c, np.array([angle]))[0, 2:5]
            made = du[:2] - np.outer(rate[:2], self.ratio[k] * du[2] / rate[2])
        self.memory[k] = made
        self.g[k, :2] = self.k_u[k] * made if now == STICK else 0.0
        self.arranged = False
        return 0


def _ports(contacts: npt.NDArray[np.intp], directions: int = 3) -> npt.NDArray[np.intp]:
    return (3 * contacts[:, None] + np.arange(directions)).ravel()
