"""Three oscillators marched in small steps, whose one contact slides in a plane: radial return.

x, y and z, of mass 1, are not coupled but by the contact: x and y are its tangential displacements, z its
normal one. Of second order where nothing slips and of first where it does; see `extrapolated`.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, pi

import numpy as np

from fcm.scene import scene_from_dict


@dataclass(frozen=True)
class Oscillators:
    """Frequencies and damping ratios of x, y, z, forces amplitude * cos(theta - lag), and the contact."""

    frequency: tuple[float, float, float]
    damping: tuple[float, float, float]
    force: tuple[float, float, float]
    lag: tuple[float, float, float]
    mu: float
    k_u: float
    k_v: float
    n_0: float

    def scene(self, span, harmonics=1, **more):
        """The same as a scene."""
        dofs = ["x", "y", "z"]
        forces = [
            {"dof": dof, "amplitude": f, "phase": pi / 2 - lag}
            for dof, f, lag in zip(dofs, self.force, self.lag, strict=True)
            if f
        ]
        contact = {"name": "pad", "tangential": ["x", "y"], "normal": "z"}
        contact |= {key: getattr(self, key) for key in ("mu", "k_u", "k_v", "n_0")}
        return scene_from_dict(
            {
                "modal": {
                    "dofs": dofs, "mass": [1.0] * 3, "frequency": list(self.frequency),
                    "damping": list(self.damping), "shapes": np.eye(3).tolist(),
                },
                "contact": [contact],
                "force": forces,
                "response": {"frequency": list(span), "harmonics": harmonics},
            }
            | more
        )  # fmt: skip

    def march(self, omega, periods, steps, state=None):
        """States (x, y, z, velocities, w_x, w_y) after `periods`, and the displacements of the last one."""
        h = 2.0 * pi / omega / steps
        x, y, z, p, q, r, w_x, w_y = state or (0.0,) * 8
        (a, b, c), (d_a, d_b, d_c) = (
            self.frequency,
            (s * w * h for s, w in zip(self.damping, self.frequency, strict=True)),
        )
        a, b, c, preload = a * a, b * b, c * c, max(self.n_0, 0.0)
        forces = [
            [f * cos(2.0 * pi * k / steps - lag) for k in range(steps)]
            for f, lag in zip(self.force, self.lag, strict=True)
        ]
        path = np.empty((steps, 3))

        def contact(x, y, z, w_x, w_y):
            n = self.n_0 + self.k_v * z
            if n <= 0.0:
                return 0.0, 0.0, -preload, x, y
            f_x, f_y, limit = self.k_u * (x - w_x), self.k_u * (y - w_y), self.mu * n
            size = hypot(f_x, f_y)
            if size > limit:
                f_x, f_y = f_x * limit / size, f_y * limit / size
                w_x, w_y = x - f_x / self.k_u, y - f_y / self.k_u
            return f_x, f_y, n - preload, w_x, w_y

        f_x, f_y, n, w_x, w_y = contact(x, y, z, w_x, w_y)
        for _ in range(periods):
            for k in range(steps):
                later = k + 1 if k + 1 < steps else 0
                g, i, j = forces[0][k] - a * x - f_x, forces[1][k] - b * y - f_y, forces[2][k] - c * z - n
                # central differences, the damping by the mean of the velocities before and after
                p = p * (1.0 - d_a) + 0.5 * h * g
                q = q * (1.0 - d_b) + 0.5 * h * i
                r = r * (1.0 - d_c) + 0.5 * h * j
                x, y, z = x + h * p, y + h * q, z + h * r
                f_x, f_y, n, w_x, w_y = contact(x, y, z, w_x, w_y)
                g = forces[0][later] - a * x - f_x
                i = forces[1][later] - b * y - f_y
                j = forces[2][later] - c * z - n
                p = (p + 0.5 * h * g) / (1.0 + d_a)
                q = (q + 0.5 * h * i) / (1.0 + d_b)
                r = (r + 0.5 * h * j) / (1.0 + d_c)
                path[k] = x, y, z
        return (x, y, z, p, q, r, w_x, w_y), path

    def extrapolated(self, omega, periods, steps):
        """Half the peak-to-peak of x, y, z (3,), of three step sizes: without the first and second order."""
        found = []
        for times in (1, 2, 4):
            _, path = self.march(omega, periods, times * steps)
            found.append(half_peak_to_peak(path))
        one, two, four = found
        first = 2.0 * two - one, 2.0 * four - two
        return (4.0 * first[1] - first[0]) / 3.0


def half_peak_to_peak(path):
    """Of samples (step, dof) of a period: extremes by parabolas."""
    found = []
    for sign in (1.0, -1.0):
        x = sign * path
        k = x.argmax(axis=0)
        dof = np.arange(x.shape[1])
        before, top, after = x[k - 1, dof], x[k, dof], x[(k + 1) % len(x), dof]
        bend = 2.0 * top - before - after
        found.append(
            top + np.where(bend > 0.0, (after - before) ** 2 / (8.0 * np.maximum(bend, 1e-300)), 0.0)
        )
    return 0.5 * (found[0] + found[1])
