"""The coefficients to fifty digits and more, from the contact law alone; shares nothing with the closed form.

|f| <= n says that the slip motion w = u - f stays between u - n and u + n, and that it moves only when one
of these pushes it. The cycle is cut where either limit turns and where the normal load vanishes. In a piece
between two cuts both limits are monotone, so at most one of them pushes w, and pushes it up to the end of
the piece. The contact starts unstressed at theta = 0; after two cycles its motion has settled, and the third
is integrated exactly. Enough digits are carried that nothing has to be written with care: no series, no
rearranged differences, no special cases but the fully open contact.
"""

from mpmath import mp, mpf

STEP = mpf(10) ** -30  # of the differences


def coefficients(n0_bar, b_bar, phi):
    """F_b, F_s, F_c as mpf, at the exact values of the arguments (float or mpf), at least 50 digits right."""
    with mp.workdps(digits(n0_bar, b_bar)):
        contact = _Contact(mpf(n0_bar), mpf(b_bar), mpf(phi))
        return tuple(+F for F in contact.integrate()) if contact.ever_closes() else (mpf(0),) * 3


def derivatives(n0_bar, b_bar, phi, step=STEP):
    """dF[i][j], the derivative of F_i by (n0_bar, b_bar, phi)[j], by central differences of `coefficients`.

    With 100 digits carried the error is about step**2, away from the kinks; near one, up to the jump.
    """
    columns = []
    with mp.workdps(digits(n0_bar, b_bar) + 50):
        x = [mpf(n0_bar), mpf(b_bar), mpf(phi)]
        for j in range(3):
            ahead = [v + step * (i == j) for i, v in enumerate(x)]
            behind = [v - step * (i == j) for i, v in enumerate(x)]
            pairs = zip(_Contact(*ahead).integrate(), _Contact(*behind).integrate(), strict=True)
            columns.append([(p - m) / (2 * step) for p, m in pairs])
    return [[columns[j][i] for j in range(3)] for i in range(3)]


def normal_coefficients(n0_star):
    """N_b, N_s: Fourier integrals of max(n0_star + sin(theta), 0) from where it closes to where it opens."""
    with mp.workdps(digits(n0_star, 1.0)):
        n0 = mpf(n0_star)
        closes = -mp.asin(max(min(n0, mpf(1)), mpf(-1)))
        opens = mp.pi - closes

        def mean(t):
            return n0 * t - mp.cos(t)

        def sine(t):
            return -n0 * mp.cos(t) + t / 2 - mp.sin(2 * t) / 4

        return (mean(opens) - mean(closes)) / (2 * mp.pi), (sine(opens) - sine(closes)) / mp.pi


def digits(n0_bar, b_bar):
    """Digits to carry: limits differ by order one among terms of order b, events by square roots of that."""
    largest = max(abs(mpf(n0_bar)), abs(mpf(b_bar)), mpf(1))
    return 110 + 2 * int(mp.log10(largest))


class _Contact:
    """One contact and its cuts of the cycle."""

    def __init__(self, n0, b, phi):
        self.n0, self.b, self.phi = n0, b, phi
        self.sin_phi, self.cos_phi = mp.sin(phi), mp.cos(phi)
        cuts = [mpf(0)]
        for side in (-1, 1):  # u + side n = A sin + B cos + side n0
            A, B = self._amplitudes(side)
            cuts += [mp.atan2(A, B), mp.atan2(A, B) + mp.pi]
        if abs(n0) < b:
            cuts += [-phi - mp.asin(n0 / b), -phi + mp.pi + mp.asin(n0 / b)]
        turn = 2 * mp.pi
        self.cuts = [*sorted(c - turn * mp.floor(c / turn) for c in cuts), turn]

    def ever_closes(self):
        return self.n0 > -self.b

    def _amplitudes(self, side):
        return 1 + side * self.b * self.cos_phi, side * self.b * self.sin_phi

    def load(self, theta):
        return self.n0 + self.b * mp.sin(theta + self.phi)

    def limit(self, side, theta):
        A, B = self._amplitudes(side)
        return A * mp.sin(theta) + B * mp.cos(theta) + side * self.n0

    def integrate(self):
        closed = [self.load((p + q) / 2) > 0 for p, q in zip(self.cuts, self.cuts[1:], strict=False)]
        lower = [self.limit(-1, c) for c in self.cuts]
        upper = [self.limit(+1, c) for c in self.cuts]
        w = min(max(mpf(0), lower[0]), upper[0]) if closed[0] else mpf(0)
        path = [w]
        for piece in 3 * list(range(len(closed))):
            end = piece + 1
            w = min(max(w, lower[end]), upper[end]) if closed[piece] else mp.sin(self.cuts[end])
            path.append(w)
        settled = path[-len(closed) - 1 :]
        total = [mpf(0)] * 3
        for piece in range(len(closed)):
            if closed[piece]:
                part = self._piece(*self.cuts[piece : piece + 2], *settled[piece : piece + 2])
                total = [t + p for t, p in zip(total, part, strict=True)]
        return [t / mp.pi for t in total]

    def _piece(self, begin, end, before, after):
        """Integrals of the force over a closed piece in which w goes from before to after."""
        side = mp.sign(before - after)  # -1: the lower limit u - n pushes w up, so f = n
        middle = self._slip_begins(side, before, begin, end) if side else end
        stick, slip = self._stick(before, begin, middle), self._slip(-side, middle, end)
        return [p + q for p, q in zip(stick, slip, strict=True)]

    def _slip_begins(self, side, w, begin, end):
        """Where the limit that pushes, monotone from begin to end, is met."""
        A, B = self._amplitudes(side)
        offset, amplitude = w - side * self.n0, mp.hypot(A, B)
        if amplitude == 0:  # a constant limit pushes by a rounding error only
            return end
        ratio = min(max(offset / amplitude, mpf(-1)), mpf(1))
        crest, reach = mp.atan2(A, B), mp.acos(ratio)
        turn, middle = 2 * mp.pi, (begin + end) / 2
        candidates = [c + turn * mp.nint((middle - c) / turn) for c in (crest - reach, crest + reach)]
        best = min(candidates, key=lambda c: max(begin - c, c - end))
        return min(max(best, begin), end)

    def _stick(self, w, p, q):
        """Integrals of sin(t) - w times 1/2, sin(t), cos(t)."""

        def of(t):
            s, c = mp.sin(t), mp.cos(t)
            return (-c - w * t) / 2, (t - s * c) / 2 + w * c, s * s / 2 - w * s

        return [at_q - at_p for at_p, at_q in zip(of(p), of(q), strict=True)]

    def _slip(self, sign, p, q):
        """Integrals of sign * n(t) times 1/2, sin(t), cos(t)."""
        if p == q:
            return [mpf(0)] * 3

        def of(t):
            s, c = mp.sin(t), mp.cos(t)
            in_phase, quadrature = self.b * self.cos_phi, self.b * self.sin_phi
            return (
                (self.n0 * t - in_phase * c + quadrature * s) / 2,
                -self.n0 * c + in_phase * (t - s * c) / 2 + quadrature * s * s / 2,
                self.n0 * s + in_phase * s * s / 2 + quadrature * (t + s * c) / 2,
            )

        return [sign * (at_q - at_p) for at_p, at_q in zip(of(p), of(q), strict=True)]
