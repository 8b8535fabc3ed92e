"""The contact law of any periodic motion marched through cells, in extended precision; knows of no sequence.

Cells of the cycle are halved until Taylor's series with a bounded rest forbids that in one of them the load
vanishes or a limit turns, or until they are so short that it does not matter: 1e-18 rad of the load, 1e-9 rad
of a limit, whose extreme is flat. In a cell a slider between two monotone limits can only be clipped to them.
It starts unstressed and is marched for three cycles; the force of the last is integrated by Gauss's rule.
The arithmetic has 64 bits, so the error is some 1e-18 of the greatest terms.
"""

import numpy as np

real, cplx = np.longdouble, np.clongdouble
PI = real("3.14159265358979323846264338327950288")
CELLS = 128
SHORTEST_LOAD, SHORTEST_LIMIT = real(2.0) ** -60, real(2.0) ** -30  # of a first cell
ROUNDING = real(1e-19)
WIDEST = 0.05  # [rad] of a piece that is integrated at once
NODES, WEIGHTS = (x.astype(real) for x in np.polynomial.legendre.leggauss(14))


def _polished():
    """The rule to extended precision: one step of Newton's method on Legendre's polynomial."""
    n, x = NODES.size, NODES.copy()
    for _ in range(2):
        p0, p1 = np.ones_like(x), x.copy()
        for k in range(2, n + 1):
            p0, p1 = p1, ((2 * k - 1) * x * p1 - (k - 1) * p0) / k
        slope = n * (x * p1 - p0) / (x * x - 1)
        x = x - p1 / slope
    return x, 2 / ((1 - x * x) * slope * slope)


NODES, WEIGHTS = _polished()


class Motion:
    """u and n_0 + k_v v, scaled to forces; both limits."""

    def __init__(self, u, v, mu, k_u, k_v, n_0, depth=2):
        self.depth = depth  # of Taylor's series, the order of the derivative that is bounded
        u, v = np.asarray(u, cplx), np.asarray(v, cplx)
        self.order = np.arange(u.size).astype(real)
        self.u = real(k_u) * u
        self.u[0] = 0  # counts only where it never slips
        self.load = real(k_v) * v
        self.load[0] = self.load[0].real + real(n_0)
        self.mu = real(mu)
        self.size = self.bound(self.u, 1) + self.mu * self.bound(self.load, 1) + np.abs(self.load).sum()
        self.limits = {-1: self.u - self.mu * self.load, 1: self.u + self.mu * self.load}
        self.centre = real(k_u) * real(np.asarray(u, cplx)[0].real)

    def turn(self, theta):
        return np.exp(1j * np.multiply.outer(theta, self.order))

    def value(self, coefficients, turn, derivative=0):
        return (turn @ (coefficients * (1j * self.order) ** derivative)).real

    def at(self, coefficients, theta):
        return self.value(coefficients, self.turn(np.asarray(theta, real)))

    def bound(self, coefficients, derivative):
        return np.sum(np.abs(coefficients) * self.order**derivative)

    def safe(self, coefficients, derivative, turn, half):
        """Whether that derivative has one sign within half of each angle, or is nothing but rounding."""
        value = np.abs(self.value(coefficients, turn, derivative))
        change, term = np.zeros_like(value), real(1)
        for k in range(1, self.depth):
            term = term * half / k
            change += term * np.abs(self.value(coefficients, turn, derivative + k))
        change += term * half / self.depth * self.bound(coefficients, derivative + self.depth)
        return (value > change) | (value + change <= ROUNDING * self.size)


def cells(motion):
    """Ends of all cells, and whether each is open."""
    begin = 2 * PI * np.arange(CELLS).astype(real) / CELLS
    ends, width = [begin], 2 * PI / CELLS
    relative = real(1)
    while begin.size and relative >= SHORTEST_LOAD:
        half = 0.5 * width
        turn = motion.turn(begin + half)
        unsafe = ~motion.safe(motion.load, 0, turn, half)
        if relative > SHORTEST_LIMIT:
            closed = unsafe | (motion.value(motion.load, turn) > 0)
            for limit in motion.limits.values():
                unsafe |= closed & ~motion.safe(limit, 1, turn, half)
        begin, width, relative = begin[unsafe], half, 0.5 * relative
        middle = begin + width
        ends.append(middle)
        begin = np.sort(np.concatenate((begin, middle)))
    ends = np.unique(np.concatenate([*ends, [2 * PI]]))
    return ends, motion.at(motion.load, 0.5 * (ends[1:] + ends[:-1])) <= 0


def pieces(motion):
    """(state, begin, end, w) of the third cycle."""
    ends, opened = cells(motion)
    u = motion.at(motion.u, ends)
    reach = motion.mu * np.maximum(motion.at(motion.load, ends), 0)
    lower, upper = u - reach, u + reach
    w, found = -motion.centre, []
    for cycle in range(3):
        for i in range(ends.size - 1):
            if opened[i]:
                new, state = u[i + 1], "S"
            else:
                new = max(lower[i + 1], min(w, upper[i + 1]))
                state = "P" if new > w else "N" if new < w else "E"
            if cycle == 2:
                found += _parts(motion, state, w, ends[i], ends[i + 1], lower[i], upper[i])
            w = new
    return found


def _parts(motion, state, w, begin, end, lower, upper):
    if state not in "PN" or w == (lower if state == "P" else upper):
        return [(state, begin, end, w)]
    limit, low, high = motion.limits[-1 if state == "P" else 1], begin, end
    for _ in range(64):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        pushed = (motion.at(limit, middle) > w) == (state == "P")
        low, high = (low, middle) if pushed else (middle, high)
    return [("E", begin, low, w), (state, low, end, w)]


def _merged(found):
    whole = []
    for state, begin, end, w in found:
        if whole:
            last, first, _, before = whole[-1]
            if last == state and (state != "E" or w == before) and end - first < WIDEST:
                whole[-1] = (last, first, end, before)
                continue
        whole.append((state, begin, end, w))
    return whole


def forces(u, v, mu, k_u, k_v, n_0, outputs, depth=2):
    """Harmonics 0 to outputs of the friction and of the normal force, and the greatest of each."""
    motion = Motion(u, v, mu, k_u, k_v, n_0, depth)
    whole = _merged(pieces(motion))
    half = np.array([0.5 * (end - begin) for _, begin, end, _ in whole])
    centre = np.array([0.5 * (end + begin) for _, begin, end, _ in whole])
    states = np.array([state for state, *_ in whole])[:, None]
    w = np.array([w for *_, w in whole])[:, None]
    theta = centre[:, None] + half[:, None] * NODES
    load = np.maximum(motion.at(motion.load, theta), 0)
    stick = motion.at(motion.u, theta) - w
    friction = np.select(
        [states == "E", states == "P", states == "N"], [stick, motion.mu * load, -motion.mu * load], 0
    )
    load = np.where(states == "S", 0, load)
    found = []
    for force in (friction, load):
        part = (force * half[:, None] * WEIGHTS).ravel()
        F = np.exp(-1j * np.multiply.outer(np.arange(outputs + 1).astype(real), theta.ravel())) @ part / PI
        F[0] *= 0.5
        found.append(F)
    return (*found, np.abs(friction).max(), np.abs(load).max())
