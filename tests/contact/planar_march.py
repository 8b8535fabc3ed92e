"""The law of a contact in its plane marched from rest by the rule of Dormand and Prince.

Slip is integrated as r alpha' = e_perp . u' together with the Fourier integrals of the force; a stick is
followed in small steps to where |u - w| reaches r. Nothing is shared with the kernel: no collocation
and no fixed point; periods follow one another until the slider comes back to where it was.
"""

import itertools

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

SCAN = 4000  # steps of a period in which a stick is followed
NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)
END = 1e-7  # [rad] before it opens, where the march ends: later the rounding over r is more than 1e-8


class March:
    """u_x, u_y and v as coefficients; forces in units of k_u."""

    def __init__(self, u_x, u_y, v, mu, k_u, k_v, n_0, outputs):
        self.u = np.array([np.asarray(u_x, complex), np.asarray(u_y, complex)])
        self.order = np.arange(self.u.shape[1])
        self.u[:, 0] = 0.0
        load = k_v * np.asarray(v, complex)
        load[0] = load[0].real + n_0
        self.r = mu / k_u * load
        self.k_u, self.mu, self.outputs = k_u, mu, outputs
        self.load = load
        theta = np.linspace(0.0, 2.0 * np.pi, 20001)
        r = self.reach(theta)
        self.changes = [
            brentq(self.reach, a, b, xtol=1e-15, rtol=1e-15)
            for a, b in itertools.pairwise(theta)
            if self.reach(a) * self.reach(b) < 0.0
        ]
        self.begin = next((c for c in self.changes if self.reach(c + 1e-6) > 0.0), 0.0)
        self.closed = r.min() > 0.0

    def wave(self, theta, derivative=0):
        turn = np.exp(1j * np.multiply.outer(theta, self.order)) * (1j * self.order) ** derivative
        return turn

    def at(self, theta, derivative=0):
        return np.moveaxis((self.wave(theta, derivative) @ self.u.T).real, -1, 0)

    def reach(self, theta, derivative=0):
        return (self.wave(theta, derivative) @ self.r).real

    def push(self, theta, alpha):
        e = np.array([np.cos(alpha), np.sin(alpha)])
        return e @ self.at(theta, 1) - self.reach(theta, 1)

    def sums(self, f, theta):
        """f exp(-i h theta) of both directions and all harmonics, as real numbers."""
        turn = np.exp(-1j * theta * np.arange(self.outputs + 1))
        return np.multiply.outer(f, turn).view(float).ravel()

    def slip(self, theta, alpha, end):
        """Until lambda vanishes, or an angle: angle, alpha, integrals."""

        def rates(t, y):
            e = np.array([np.cos(y[0]), np.sin(y[0])])
            x_1, y_1 = self.at(t, 1)
            r = self.reach(t)
            return np.concatenate(([(e[0] * y_1 - e[1] * x_1) / r], self.sums(r * e, t)))

        def halts(t, y):
            return self.push(t, y[0])

        halts.terminal, halts.direction = True, -1.0
        start = np.concatenate(([alpha], np.zeros(4 * (self.outputs + 1))))
        done = solve_ivp(rates, (theta, end), start, "DOP853", events=halts, rtol=1e-13, atol=1e-14)
        assert done.success, done.message
        return done.t[-1], done.y[0, -1], done.y[1:, -1]

    def stick(self, theta, w, end):
        """Until |u - w| = r, or an angle: angle, whether it slips, integrals."""

        def gap(t):
            x, y = self.at(t)
            return np.hypot(x - w[0], y - w[1]) - self.reach(t)

        steps = np.linspace(theta, end, max(int(SCAN * (end - theta) / 6.3), 50))
        beyond = np.flatnonzero(gap(steps[1:]) > 0.0)
        last, slips = end, False
        if beyond.size:
            last, slips = brentq(gap, steps[beyond[0]], steps[beyond[0] + 1], xtol=1e-15, rtol=1e-15), True
        total = np.zeros(4 * (self.outputs + 1))
        pieces = np.linspace(theta, last, 9)
        for a, b in itertools.pairwise(pieces):
            for node, weight in zip(NODES, WEIGHTS, strict=True):
                t = 0.5 * (a + b) + 0.5 * (b - a) * node
                total += 0.5 * (b - a) * weight * self.sums(self.at(t) - w, t)
        return last, slips, total

    def interval(self, theta, w, alpha, end):
        """From an angle to another, sticking at w unless alpha is given; the slider at the end, integrals."""
        total, words = np.zeros(4 * (self.outputs + 1)), ""
        while theta < end:
            if alpha is None:
                theta, slips, part = self.stick(theta, w, end)
                words += "E"
                if slips:
                    d = self.at(theta) - w
                    alpha = np.arctan2(d[1], d[0])
            else:
                theta, alpha, part = self.slip(theta, alpha, end)
                words += "P"
                w = self.at(theta) - self.reach(theta) * np.array([np.cos(alpha), np.sin(alpha)])
                if theta < end:
                    alpha = None
            total += part
        return w, alpha, total, words

    def forces(self):
        """Coefficients of f_x and f_y (2, harmonic), and the sequence."""
        if self.closed:
            w, alpha = np.zeros(2), None
            d = self.at(0.0)
            if np.hypot(*d) > self.reach(0.0):
                alpha = np.arctan2(d[1], d[0])
            for _ in range(60):
                before = w
                w, alpha, total, words = self.interval(0.0, w, alpha, 2.0 * np.pi)
                if np.abs(w - before).max() < 2e-14:
                    break
        else:
            total, words = np.zeros(4 * (self.outputs + 1)), ""
            cuts = sorted((c - self.begin) % (2.0 * np.pi) for c in self.changes)
            for a, b in zip(cuts[::2], cuts[1::2], strict=True):
                a, b = a + self.begin, b + self.begin
                speed = self.at(a, 1)
                alpha = np.arctan2(speed[1], speed[0]) if np.hypot(*speed) > self.reach(a, 1) else None
                theta = a
                if alpha is not None:  # off the singular start, along alpha' there
                    bend = self.at(a, 2)
                    e = speed / np.hypot(*speed)
                    theta = a + 1e-7
                    alpha += 1e-7 * (e[0] * bend[1] - e[1] * bend[0]) / (self.reach(a, 1) + np.hypot(*speed))
                _, _, part, letters = self.interval(theta, self.at(a), alpha, b - END)
                total, words = total + part, words + letters + "S"
        F = total.view(complex).reshape(2, -1) / np.pi * self.k_u
        F[:, 0] *= 0.5
        return F, words


def returned(cases, steps, highest, periods=6):
    """Coefficients (case, 2, harmonic) of f_x and f_y by radial return, no event located, for any load.

    A step goes once and in two halves, and the places of the slider are extrapolated: of second order.
    """
    h = np.arange(max(one.size for case in cases for one in (case.u_x, case.u_y, case.v)))
    wave = np.exp(1j * np.outer(np.pi * np.arange(2 * steps) / steps, h))
    u_x, u_y, v = (
        np.stack([(wave[:, : getattr(case, key).size] @ getattr(case, key)).real for case in cases], axis=1)
        for key in ("u_x", "u_y", "v")
    )
    mu, k_u, k_v, n_0 = (
        np.array([getattr(case, key) for case in cases]) for key in ("mu", "k_u", "k_v", "n_0")
    )
    u, reach = np.stack((u_x, u_y), axis=1), mu * np.maximum(n_0 + k_v * v, 0.0) / k_u

    def held(i, w):
        d = u[i] - w
        return u[i] - d * np.minimum(1.0, reach[i] / np.maximum(np.hypot(*d), 1e-300))

    w, f = u[0].copy(), np.zeros((steps, 2, len(cases)))
    for step in range(1, periods * steps + 1):
        i = 2 * (step % steps)
        once, twice = held(i, w), held(i, held(i - 1, w))
        w = held(i, 2.0 * twice - once)
        f[step % steps] = k_u * (u[i] - w)
    F = np.fft.fft(f, axis=0)[: highest + 1] / steps
    F[1:] *= 2.0
    return np.moveaxis(F, 2, 0).swapaxes(1, 2)
