"""Two other ways to the same motion, that share nothing with the one under test.

`integrate` follows each combination of contact states with `scipy.integrate.solve_ivp` and its events, in
displacements and slip motions as sections 3.1 and 3.2 write them. `marched` takes fixed steps with a
return map for the friction (trial force clipped to the limit) and Newmark's average acceleration.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp


class Law:
    """Forces and conditions of a scene, in q, q' and w."""

    def __init__(self, scene, omega):
        modal = scene.modal
        self.scene, self.omega = scene, omega
        self.m, self.w2 = modal.mass, modal.frequency**2
        self.c2 = 2.0 * modal.damping * modal.frequency
        self.U = np.array([modal.shapes @ c.tangential for c in scene.contacts])
        self.V = np.array([modal.shapes @ c.normal for c in scene.contacts])
        self.modes = modal.mass.size

    def external(self, t):
        total = sum(load.direction * load.force for load in self.scene.loads)
        for f in self.scene.forces:
            turned = np.sin(f.harmonic * self.omega * t + f.phase)
            total = total + f.direction * f.amplitude * self.omega**f.power * turned
        return self.scene.modal.shapes @ total

    def rhs(self, t, y, states):
        """y = (q, q', w of each contact)."""
        k = self.modes
        q, p, w = y[:k], y[k : 2 * k], y[2 * k :]
        push = self.external(t)
        dw = np.zeros(w.size)
        for j, (c, s) in enumerate(zip(self.scene.contacts, states, strict=True)):
            u, v, du, dv = self.U[j] @ q, self.V[j] @ q, self.U[j] @ p, self.V[j] @ p
            n = 0.0 if s == "S" else c.n_0 + c.k_v * v
            f = {"E": c.k_u * (u - w[j]), "P": c.mu * n, "N": -c.mu * n, "S": 0.0}[s]
            rate = c.mu * c.k_v / c.k_u * dv
            dw[j] = {"E": 0.0, "P": du - rate, "N": du + rate, "S": du}[s]
            push = push - self.U[j] * f - self.V[j] * (n - max(c.n_0, 0.0))
        return np.concatenate((p, push / self.m - self.c2 * p - self.w2 * q, dw))

    def events(self, states):
        """(function of t and y, contact, kind) for all that can end the states."""
        k, out = self.modes, []
        for j, (c, s) in enumerate(zip(self.scene.contacts, states, strict=True)):
            load = lambda t, y, c=c, j=j: c.n_0 + c.k_v * (self.V[j] @ y[:k])  # noqa: E731
            force = lambda t, y, c=c, j=j: c.k_u * (self.U[j] @ y[:k] - y[2 * k + j])  # noqa: E731
            if s == "E":
                out.append((lambda t, y, c=c, n=load, f=force: c.mu * n(t, y) - f(t, y), j, "P"))
                out.append((lambda t, y, c=c, n=load, f=force: c.mu * n(t, y) + f(t, y), j, "N"))
            elif s == "S":
                out.append((lambda t, y, n=load: -n(t, y), j, "close"))
            else:
                sign = 1.0 if s == "P" else -1.0
                row = sign * self.U[j] - c.mu * c.k_v / c.k_u * self.V[j]
                out.append((lambda t, y, row=row: row @ y[k : 2 * k], j, "E"))
                out.append((load, j, "S"))
        return out

    def after(self, y, j, kind):
        """The contact's state after an event, by (9)-(22)."""
        if kind != "close":
            return kind
        c, k = self.scene.contacts[j], self.modes
        du, limit = self.U[j] @ y[k : 2 * k], c.mu * c.k_v / c.k_u * (self.V[j] @ y[k : 2 * k])
        return "P" if du > limit else "N" if du < -limit else "E"


def integrate(scene, omega, cycles, times, rtol=1e-12, atol=1e-13):
    """Displacements at times, from rest, by solve_ivp with events."""
    law = Law(scene, omega)
    y = np.zeros(2 * law.modes + len(scene.contacts))
    states = ["E" if c.n_0 > 0.0 else "S" for c in scene.contacts]
    if any(c.n_0 == 0.0 for c in scene.contacts):
        start = law.rhs(0.0, y, states)[law.modes : 2 * law.modes]
        states = ["E" if c.n_0 > 0.0 or (c.n_0 == 0.0 and law.V[j] @ start > 0.0) else "S"
                  for j, c in enumerate(scene.contacts)]  # fmt: skip
    t, end = 0.0, cycles * 2.0 * np.pi / omega
    out = np.empty((times.size, len(scene.modal.dofs)))
    while t < end:
        watched = law.events(states)
        functions = []
        for g, _, _ in watched:

            def event(time, state, g=g):
                return g(time, state)

            event.terminal, event.direction = True, -1.0
            functions.append(event)
        sol = solve_ivp(
            lambda time, state, s=tuple(states): law.rhs(time, state, s),
            (t, end), y, "DOP853", events=functions, rtol=rtol, atol=atol, dense_output=True, max_step=0.3,
        )  # fmt: skip
        inside = (times >= t) & (times <= sol.t[-1])
        if inside.any():
            out[inside] = sol.sol(times[inside])[: law.modes].T @ scene.modal.shapes
        t, y = sol.t[-1], sol.y[:, -1].copy()
        for i, (_, j, kind) in enumerate(watched):
            if sol.t_events[i].size:
                states[j] = law.after(y, j, kind)
    return out


def marched(scene, omega, cycles, steps):
    """Displacements at `steps` equal steps a cycle, from rest: Newmark, return map; second order."""
    law = Law(scene, omega)
    dt = 2.0 * np.pi / omega / steps
    q, p = np.zeros(law.modes), np.zeros(law.modes)
    force = np.zeros(len(scene.contacts))
    out = [q]

    def pushed(t, new, old, f_old):
        push, forces = law.external(t), f_old.copy()
        for j, c in enumerate(scene.contacts):
            n = max(c.n_0 + c.k_v * (law.V[j] @ new), 0.0)
            forces[j] = np.clip(f_old[j] + c.k_u * (law.U[j] @ (new - old)), -c.mu * n, c.mu * n)
            push = push - law.U[j] * forces[j] - law.V[j] * (n - max(c.n_0, 0.0))
        return push / law.m, forces

    a = pushed(0.0, q, q, force)[0]
    lead = 4.0 / dt**2 + 2.0 * law.c2 / dt + law.w2
    for i in range(1, cycles * steps + 1):
        known = 4.0 / dt**2 * q + 4.0 / dt * p + a + law.c2 * (2.0 / dt * q + p)
        new = q + dt * p
        for _ in range(100):
            push, forces = pushed(i * dt, new, q, force)
            better = (known + push) / lead
            change = np.abs(better - new).max()
            new = better
            if change < 1e-14:
                break
        speed = 2.0 / dt * (new - q) - p
        a = 4.0 / dt**2 * (new - q) - 4.0 / dt * p - a
        q, p, force = new, speed, forces
        out.append(q)
    return np.array(out) @ scene.modal.shapes
