r"""What becomes of a small disturbance of a motion with many contacts that slide in a plane, within a period.

The same equations as in `planar_monodromy`, collocated at the same points, in steps chosen by the same rule.
But with K the springs of all contacts as if they stuck, S the flexibility of the modes far above, and P the
shapes of the others, the structure with these springs is put together once:

    d = R^-1 P^T q + R^-1 S g,    R = 1 + S K,    q'' + .. + (w^2 + P K R^-1 P^T) q = (R^-1 P^T)^T g

What a contact does otherwise than stick is a force g on it, of which there is none where it sticks all
through the cycle:

    stick        g = k_u dw
    slip         g = k_u (e . du - dr) e + k_u s e_perp
    separation   g = K d

So a contact that slips has two unknowns at each point, e . du - dr and what s feels of the displacements, one
that is open three, and any other none.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.contact.plane.radau import radau
from fcm.stability.planar_sequence import PlanarSequence, states

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.intp]
TWO_PI = 2.0 * np.pi
STICK, SLIP, SEPARATION = states()


class ManyPlanarMonodromy:
    """`follow` a sequence: `matrix` is then the derivative of (q, q', memory) after a period by that before.

    Velocities are by the angle.

    Parameters
    ----------
    shapes, natural, damping : (mode, port), (mode,), (mode,)
        Of all modes, of mass 1; three ports for each contact; natural frequencies in rad/s.
    far : (mode,) bool
        Which follow without delay.

    Attributes
    ----------
    steps
        How many the last period took.
    """

    def __init__(
        self,
        shapes: FloatArray,
        natural: FloatArray,
        damping: FloatArray,
        far: npt.NDArray[np.bool_],
        sequence: PlanarSequence,
    ) -> None:
        self.sequence, self.options = sequence, sequence.options
        self.shapes, self.natural, self.damping = shapes[~far], natural[~far], damping[~far]
        self.soft = (shapes[far].T * natural[far] ** -2.0) @ shapes[far]
        self.rule = radau(self.options.stages)
        self.butcher = np.linalg.inv(self.rule.slopes[1:, 1:])
        self.steps = 0
        self._matrix = np.zeros((0, 0))

    def matrix(self) -> FloatArray:
        """(2 modes + memories, the same); of more disturbances than the options allow, not a number."""
        return self._matrix

    def follow(self, omega: float) -> None:
        """Fill the matrix for a frequency."""
        period = _Period(self, omega)
        self._matrix = period.followed()
        self.steps = period.steps


class _Period:
    """The disturbances on their way: q, p (mode, disturbance), and what each moving contact remembers."""

    def __init__(self, of: ManyPlanarMonodromy, omega: float) -> None:
        self.of, self.sequence, self.options = of, of.sequence, of.options
        count, state = np.asarray(of.sequence.count), np.asarray(of.sequence.state)
        self.moving = np.flatnonzero((count > 1) | (state[:, 0] == SLIP))
        self.number = {int(c): k for k, c in enumerate(self.moving)}
        contact = np.asarray(of.sequence.contact)
        rubs, opened = contact[:, 0] * contact[:, 1] > 0.0, (count == 1) & (state[:, 0] == SEPARATION)
        springs = np.stack((contact[:, 1] * rubs, contact[:, 1] * rubs, contact[:, 2]), axis=1)
        springs[opened] = 0.0
        self.k_u, self.springs = springs[self.moving, 0], springs[self.moving]
        self.ratio = np.where(rubs, contact[:, 0] * contact[:, 2] / np.where(rubs, contact[:, 1], 1.0), 0.0)
        self.ratio = self.ratio[self.moving]
        self._structure(springs.ravel(), omega)
        self.memory = np.zeros((self.moving.size, 2, 0))
        self.next, self.steps, self._taken = self.options.max_step, 0, -1.0

    def _structure(self, springs: FloatArray, omega: float) -> None:
        """That with the springs: what moving contacts see of the modes, and of one another's forces."""
        of, m = self.of, len(self.of.natural)
        ports = (3 * self.moving[:, None] + np.arange(3)).ravel()
        seen: FloatArray = of.shapes.T
        soft: FloatArray = of.soft
        if soft.any():
            R: FloatArray = np.eye(springs.size) + soft * springs
            right = np.concatenate((seen, soft[:, ports]), axis=1)
            found = np.asarray(np.linalg.solve(R, right), dtype=np.float64)
            seen, soft = found[:, :m], found[:, m:]
        else:
            soft = soft[:, ports]
        self.C = 2.0 * of.damping * of.natural / omega
        self.K = ((of.shapes * springs) @ seen + np.diag(of.natural**2)) / omega**2
        n = self.moving.size
        self.seen, self.soft = seen[ports].reshape(n, 3, m), soft[ports].reshape(n, 3, n, 3)
        self.push = self.seen / omega**2

    def followed(self) -> FloatArray:
        """The matrix."""
        events = self._events()
        start, first = self._start(events)
        held = [self.sequence.remembers(int(c), start) for c in self.moving]
        m = len(self.of.natural)
        columns = 2 * m + sum(held)
        lost: FloatArray = np.full((1, 1), np.nan)
        if columns > self.options.most_of_many:
            return lost
        self.q, self.p = np.eye(m, columns), np.eye(m, columns, m)
        self.memory = np.zeros((self.moving.size, 2, columns))
        rows = [(k, i) for k, n in enumerate(held) for i in range(n)]
        for column, (k, i) in enumerate(rows, 2 * m):
            self.memory[k, i, column] = 1.0
        self.g = np.zeros((self.moving.size, 3, columns))
        self.state = np.array([self.sequence.state_at(int(c), start) for c in self.moving], dtype=np.intp)
        self.fresh = np.zeros(self.moving.size, dtype=bool)
        self._rest()
        now = start
        for angle, k, i in [*events[first:], *((a + TWO_PI, k, i) for a, k, i in events[:first])]:
            opens = self.state[k] == SLIP and self.sequence.state[self.moving[k], i] == SEPARATION
            if not self._propagate(now, angle - now, opens):
                return lost
            now = angle if angle - now > self.options.event_tolerance else now
            self._apply_event(k, i)
        if not self._propagate(now, start + TWO_PI - now, False):
            return lost
        kept = np.array([self.memory[k, i] for k, i in rows]).reshape(len(rows), columns)
        return np.concatenate((self.q, self.p, kept))

    def _events(self) -> list[tuple[float, int, int]]:
        """Angle in [0, 2 pi), number of the moving contact and of its state that begins, in order."""
        begin, count = self.sequence.begin, self.sequence.count
        return sorted(
            (float(begin[c, i]) % TWO_PI, k, i)
            for k, c in enumerate(self.moving.tolist())
            for i in range(count[c] if count[c] > 1 else 0)
        )

    def _start(self, events: list[tuple[float, int, int]]) -> tuple[float, int]:
        """An angle at which little is remembered, in the middle between two events, and the next of these."""
        if not events:
            return 0.0, 0
        at = np.array([angle for angle, _, _ in events])
        gap = np.diff(at, append=at[0] + TWO_PI)
        wide = np.flatnonzero(gap > self.options.min_gap)
        middle = at + 0.5 * gap
        counts = {
            j: sum(self.sequence.remembers(int(c), middle[j]) for c in self.moving) for j in wide.tolist()
        }
        best = min(counts, key=lambda j: (counts[j], -gap[j]))
        start = float(middle[best])
        return (start, best + 1) if start < TWO_PI else (start - TWO_PI, 0)

    def _rest(self) -> None:
        """Which contacts slip, are open, and stick, and the places of their unknowns."""
        self.slips, self.open = np.flatnonzero(self.state == SLIP), np.flatnonzero(self.state == SEPARATION)
        self.sticks = np.flatnonzero(self.state == STICK)
        n = self.slips.size
        self.at = np.arange(n), n + np.arange(n), 2 * n + np.arange(3 * self.open.size)
        still = self.k_u[self.sticks, None, None] * self.memory[self.sticks]
        # what the memory of those that stick pushes on the modes, and moves the others by
        self.held = np.einsum("kim,kic->mc", self.push[self.sticks, :2], still)
        self.moved = np.einsum("kdlj,ljc->kdc", self.soft[:, :, self.sticks, :2], still)
        self.g[self.sticks] = 0.0
        self.g[self.sticks, :2] = still

    def _propagate(self, theta: float, length: float, opens: bool) -> bool:
        """Carry the disturbances on, in steps as of `PlanarMonodromy`; false where none is short enough."""
        options, left, s = self.options, length, self.options.stages
        if length <= options.event_tolerance:
            return True
        closed = bool(self.fresh.any())
        while left > 0.0:
            h = min(self.next, options.max_step)
            wanted, h = h, left if h >= left else 0.5 * left if h > 0.5 * left else h
            refused = False
            while True:
                if h < options.event_tolerance:
                    return False
                rest = self._step(theta + length - left, h)
                rest /= options.end_factor if closed or (opens and h == left) else 1.0
                by = (options.tolerance / max(rest, 1e-300)) ** (1.0 / s)
                if rest <= options.tolerance:
                    break
                h *= min(max(options.safety * by, options.min_factor), options.max_retry_factor)
                refused = True
            following = h * min(max(options.safety * by, options.min_factor), options.max_factor)
            self.next = following if refused else max(following, wanted)  # an event alone cut it
            self._accept()
            closed = False
            left = left - h if h < left else 0.0
            self.steps += 1
        return True

    def _prepare(self, h: float) -> None:
        """q and p at the nodes of a step by those at its start and by pushes at the nodes."""
        if h == self._taken:
            return
        m, s, A = len(self.of.natural), self.options.stages, self.of.butcher
        once, twice = h * A, h * h * A @ A
        system = np.kron(twice, self.K) + np.kron(once, np.diag(self.C)) + np.eye(s * m)
        ones = np.ones((s, 1))
        right = np.concatenate(
            (-np.kron(once @ ones, self.K), np.kron(ones, np.eye(m)), np.kron(once, np.eye(m))), axis=1
        )
        p = np.linalg.solve(system, right)
        q = np.kron(once, np.eye(m)) @ p
        q[:, :m] += np.kron(ones, np.eye(m))
        self.p_of, self.q_of, self._taken = p, q, h

    def _slip(self, theta: float, h: float) -> None:
        """Of the contacts that slip, at the nodes: directions, what s feels, and how it answers to that."""
        s, rule, n = self.options.stages, self.of.rule, self.slips.size
        angles = theta + h * rule.nodes
        found = [self.sequence.slip_at(c, angles) for c in self.moving[self.slips].tolist()]
        e, rate, r = np.split(np.array(found).reshape(n, s, 6), (2, 5), axis=2)
        r = r[..., 0]
        r = np.maximum(r, 1e-12 * np.abs(r).max(initial=0.0))
        rate = h * rate
        aside = np.stack((-e[..., 1], e[..., 0]), axis=-1)
        across = (aside * rate[..., :2]).sum(axis=-1)
        push = np.maximum((e * rate[..., :2]).sum(axis=-1) - rate[..., 2], 0.0)
        ratio = self.ratio[self.slips, None]
        self.along = np.concatenate((e, np.broadcast_to(-ratio[..., None], (n, s, 1))), axis=-1)
        tangential = push[..., None] * aside - across[..., None] * e
        self.feels = np.concatenate((tangential, (across * ratio)[..., None]), axis=-1)
        fresh = self.fresh[self.slips, None, None]
        system = r[..., None] * np.where(fresh, rule.inner, rule.slopes[1:, 1:])
        system[:, range(s), range(s)] += push
        self.inverse = np.linalg.inv(system) if n else system
        self.kept = (self.inverse @ np.where(fresh[..., 0], 0.0, -r * rule.slopes[1:, 0])[..., None])[..., 0]
        self.e, self.aside = e, aside

    def _coupled(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """At each node: the unknowns by the modes (s, unknown, mode), what they push these by, what they do
        to one another by the flexibility, and what the memory of those that stick does to them."""
        m, s, columns = len(self.of.natural), self.options.stages, self.q.shape[1]
        gamma, sigma, apart = self.at
        size = gamma.size + sigma.size + apart.size
        k_u, springs = self.k_u[self.slips, None, None], self.springs[self.open]
        by_modes, on_modes = np.zeros((s, size, m)), np.zeros((s, m, size))
        soft, aside = np.zeros((s, size, size)), np.zeros((s, size, columns))
        # of the two unknowns of a slip: the displacements that it is of, and the force that it is
        two = (gamma, self.along, k_u * self.e), (sigma, self.feels, k_u * self.aside)
        of_slips, of_open = self.soft[self.slips], self.soft[self.open]
        for rows, part, force in two:
            by_modes[:, rows] = np.einsum("ksd,kdm->skm", part, self.seen[self.slips])
            on_modes[:, :, rows] = np.einsum("ksi,kim->smk", force, self.push[self.slips, :2])
            aside[:, rows] = np.einsum("ksd,kdc->skc", part, self.moved[self.slips])
            for cols, _, other in two:
                half = np.einsum("kdlj,lsj->skdl", of_slips[:, :, self.slips, :2], other)
                soft[:, rows[:, None], cols] = np.einsum("ksd,skdl->skl", part, half)
        if not apart.size:
            return by_modes, on_modes, soft, aside
        by_modes[:, apart] = self.seen[self.open].reshape(apart.size, m)
        on_modes[:, :, apart] = (springs[..., None] * self.push[self.open]).reshape(apart.size, m).T
        aside[:, apart] = self.moved[self.open].reshape(apart.size, columns)
        for rows, part, force in two:
            found = np.einsum("ksd,kdlj->sklj", part, of_slips[:, :, self.open] * springs)
            soft[:, rows[:, None], apart] = found.reshape(s, rows.size, apart.size)
            found = np.einsum("kdlj,lsj->skdl", of_open[:, :, self.slips, :2], force)
            soft[:, apart[:, None], rows] = found.reshape(s, apart.size, rows.size)
        soft[:, apart[:, None], apart] = (of_open[:, :, self.open] * springs).reshape(apart.size, apart.size)
        return by_modes, on_modes, soft, aside

    def _step(self, theta: float, h: float) -> float:
        """One step from an angle on; what it leaves out, and infinity where it is singular."""
        m, s, columns = len(self.of.natural), self.options.stages, self.q.shape[1]
        self._prepare(h)
        self._slip(theta, h)
        by_modes, on_modes, soft, aside = self._coupled()
        sigma, size = self.at[1], soft.shape[1]
        q_0, q_f = self.q_of[:, : 2 * m], self.q_of[:, 2 * m :].reshape(s, m, s, m)
        whole = np.einsum("imjn,jnk->imjk", q_f, on_modes)
        B = (by_modes @ whole.reshape(s, m, s * size)).reshape(s, size, s, size)
        B[range(s), :, range(s), :] += soft
        y = np.concatenate((self.q, self.p))
        free = (q_0 @ y).reshape(s, m, columns)
        free += q_f.sum(axis=2).reshape(s * m, m).reshape(s, m, m) @ self.held
        right = by_modes @ free + aside
        # s at the nodes by what it feels there and by s before
        known = self.kept[..., None] * self.memory[self.slips, :1]
        of_s = B[..., sigma]
        right += np.einsum("iajk,kjc->iac", of_s, known)
        B[..., sigma] = np.einsum("iajk,kjl->ialk", of_s, self.inverse)
        system = np.eye(s * size) - B.reshape(s * size, s * size)
        try:
            u = np.linalg.solve(system, right.reshape(s * size, columns)).reshape(s, size, columns)
        except np.linalg.LinAlgError:
            return np.inf
        strain = u.copy()
        strain[:, sigma] = np.einsum("kij,jkc->ikc", self.inverse, u[:, sigma]) + known.transpose(1, 0, 2)
        push = (on_modes @ strain + self.held).reshape(s * m, columns)
        p = (self.p_of[:, : 2 * m] @ y + self.p_of[:, 2 * m :] @ push).reshape(s, m, columns)
        self.q_new = self.q_of[-m:, : 2 * m] @ y + self.q_of[-m:, 2 * m :] @ push
        self.p_new, self.strain = p[-1], strain[-1]
        tail = np.tensordot(self.of.rule.tail, np.concatenate((self.p[None], p)), axes=1)
        scale = np.maximum(1.0, np.abs(y).max(axis=0, initial=0.0))
        before, last = np.abs(tail / scale).max(axis=(1, 2), initial=0.0).tolist()
        return float(max(last, self.options.coefficient_floor * before))

    def _accept(self) -> None:
        """The end of the step is where the disturbances are."""
        gamma, sigma, apart = self.at
        self.q, self.p = self.q_new, self.p_new
        k_u = self.k_u[self.slips, None, None]
        along, across = self.e[:, -1, :, None], self.aside[:, -1, :, None]
        self.g[self.slips] = 0.0
        self.g[self.slips, :2] = k_u * (along * self.strain[gamma, None] + across * self.strain[sigma, None])
        self.g[self.open] = self.springs[self.open][..., None] * self.strain[apart].reshape(
            self.open.size, 3, self.q.shape[1]
        )
        self.memory[self.slips, 0] = self.strain[sigma]
        self.fresh[:] = False

    def _apply_event(self, k: int, i: int) -> None:
        """State i of a moving contact begins: what it remembers of the disturbances."""
        sequence, c = self.sequence, int(self.moving[k])
        before, now = int(self.state[k]), int(sequence.state[c, i])
        angle = float(sequence.begin[c, i])
        self.state[k], self.fresh[k] = now, now == SLIP and before == SEPARATION
        w, made = self.memory[k], np.zeros_like(self.memory[k])
        if {before, now} == {STICK, SLIP}:
            e = sequence.slip_at(c, np.array([angle]), now == STICK)[0, :2]
            aside = np.array([-e[1], e[0]])
        if now == STICK:
            du = self.seen[k] @ self.q + np.einsum("dlj,ljc->dc", self.soft[k], self.g)
        if now == SLIP and before == STICK:
            made[0] = aside @ w
        elif now == STICK and before == SLIP:
            made = np.outer(e, e @ du[:2] - self.ratio[k] * du[2]) + np.outer(aside, w[0])
        elif now == STICK:
            rate = sequence.slip_at(c, np.array([angle]))[0, 2:5]
            made = du[:2] - np.outer(rate[:2], self.ratio[k] * du[2] / rate[2])
        self.memory[k] = made
        self._rest()
