"""What tells a continuation that the regime changes: signed margins, of which one vanishes at every change.

Along lines between random motions every change of the sequence is located by bisection. Only a halt within a
slip (P to PEP) comes without one: there the forces and their derivatives go on without a corner.
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fcm.contact.contact_kernel import ContactParameters
from fcm.contact.periodic.cycle import PeriodicContact
from fcm.contact.periodic.margins import Measures
from fcm.harmonic_balance.contact_law import laws_on_a_line

from .motions import SINE, STILL, Case, random_cases

CLOSES, OPENS, TOP, BOTTOM = range(4)  # the kinds of events of the kernel
LEAST_LOAD, GREATEST_LOAD = 10, 11
STEPS = 40


def solve(case):
    """The contact with its Jacobian, and the measures of its cycle."""
    x = np.stack((case.u.real, case.u.imag, case.v.real, case.v.imag), axis=-1).ravel()
    contact = PeriodicContact(*2 * [list(range(1, case.u.size))])
    contact.at(np.delete(x, (1, 3)), ContactParameters(*case.arguments()[2:]))
    measures = Measures(contact.cycle)
    measures.measure(case.k_u)
    return contact, measures


def margins(case):
    """All that are signed, divided by the scale of the friction and of the load."""
    contact, measures = solve(case)
    cycle, extremes, scale = contact.cycle, measures.crossings, contact.motion.scale
    found = [measures.overlap / scale]
    found += [
        measures.value[i] for i in range(extremes.count) if extremes.kind[i] in (LEAST_LOAD, GREATEST_LOAD)
    ]
    for e in range(cycle.events):
        if cycle.event_kind[e] == CLOSES:
            found += [cycle.lower_rate[e], cycle.upper_rate[e]]
        elif cycle.event_kind[e] in (OPENS, TOP, BOTTOM):
            found.append(cycle.margin[e])
    return np.array(found)


def sequence(case):
    """The states in the least of their cyclic orders, equal wherever the cycle begins."""
    cycle = solve(case)[0].cycle
    states = "".join("NEPS"[cycle.state[p] + 1] for p in range(cycle.pieces))
    return min(states[i:] + states[:i] for i in range(len(states)))


def line(one, other):
    """From one motion to another; the stiffnesses are those of the first."""
    count = max(one.u.size, other.u.size)
    u, v, du, dv = (np.pad(x, (0, count - x.size)) for x in (one.u, one.v, other.u, other.v))
    n_0 = other.n_0 * one.k_v / other.k_v
    return lambda t: replace(
        one, u=(1 - t) * u + t * du, v=(1 - t) * v + t * dv, n_0=(1 - t) * one.n_0 + t * n_0
    )


def changes(at):
    """The two sides of every change of the sequence between neighbouring steps."""
    steps = np.linspace(0.0, 1.0, STEPS + 1)
    known = [sequence(at(t)) for t in steps]
    for i in (i for i in range(STEPS) if known[i] != known[i + 1]):
        low, high = steps[i], steps[i + 1]
        for _ in range(50):
            middle = 0.5 * (low + high)
            if sequence(at(middle)) == known[i]:
                low = middle
            else:
                high = middle
        yield at(low), at(high)


def without_halts(states):
    """The sequence as if a slip that halts went on, from its least letter on."""
    for halt, slip in (("PEP", "P"), ("NEN", "N")):
        while halt in 2 * states:
            i = (2 * states).find(halt)
            turned = (states[i:] + states[:i])[: len(states)]
            states = slip + turned[3:]
    return min(states[i:] + states[:i] for i in range(len(states)))


@pytest.mark.parametrize("seed", range(4))
def test_at_every_change_of_regime_a_margin_vanishes(seed):
    cases = random_cases(24, 300 + seed, most=4)
    kinds = {"margin": 0, "halt": 0}
    for one, other in zip(cases[::2], cases[1::2], strict=False):
        for before, after in changes(line(one, other)):
            if min(np.abs(margins(before)).min(), np.abs(margins(after)).min()) < 1e-6:
                kinds["margin"] += 1
                continue
            kinds["halt"] += 1
            assert without_halts(sequence(before)) == without_halts(sequence(after))
            J, K = (np.array(solve(case)[0].jacobian) for case in (before, after))
            assert np.abs(J - K).max() <= 1e-4 * np.abs(J).max()
    assert kinds["margin"] >= len(cases) / 3


def test_margins_of_the_slip_limit():
    """u = sin(theta) under a constant load n: the limits overlap by 2 k_u - 2 mu n, equation (25)."""
    for n in (0.3, 0.999, 1.0, 1.001, 5.0):
        _, measures = solve(Case(SINE, 0.0 * SINE, 1.0, n_0=n))
        assert measures.overlap == pytest.approx(2.0 - 2.0 * n, abs=1e-15)
        assert (measures.least_load, measures.greatest_load) == pytest.approx((n, n), rel=1e-15)
    assert solve(Case(SINE, 0.0 * SINE, 1.0, n_0=0.5))[1].slip_path == pytest.approx(2.0)


def test_measures_of_a_contact_that_is_open_or_never_moves():
    _, measures = solve(Case(SINE, 0.0 * SINE, n_0=-2.0))
    assert (measures.greatest_load, measures.greatest_friction, measures.dissipation) == (-2.0, 0.0, 0.0)
    _, measures = solve(Case(np.array([0.3 + 0j]), STILL, k_u=2.0, n_0=3.0))
    assert measures.greatest_friction == pytest.approx(0.6, abs=1e-16)
    assert measures.overlap < 0.0


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_another_extreme_of_a_limit_comes_to_hold_a_slider(side):
    """u = side (5 + c cos(theta) + cos(2 theta)) under a load 4: the limit is furthest at 0, or at pi."""
    contact, law = PeriodicContact([1, 2], [1, 2]), {"mu": 0.5, "k_u": 1.0, "k_v": 0.0, "n_0": 4.0}
    (bounds,), margins = laws_on_a_line(contact, [SimpleNamespace(**law)]), []
    for c in (1e-7, -1e-7):
        x = side * np.array([5.0, 0.0, c, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
        contact.at(x, ContactParameters(**law))
        assert contact.forces[0] == pytest.approx(side * (0.5 * 4.0 - 1.0 - abs(c)), abs=1e-12)
        assert contact.jacobian[0, 2] == pytest.approx(-np.sign(c), abs=1e-6)
        bounds.evaluate_margins(x, 0)
        kinds, angles, values = (np.asarray(one) for one in (bounds.kind, bounds.angle, bounds.margin))
        held = np.flatnonzero((kinds == 5) | (kinds == 6))
        margins.append({round(float(angles[i]) / np.pi) % 2: float(values[i]) for i in held})
    assert margins[0][0] > 0.0 > margins[0][1]
    assert margins[1][1] > 0.0 > margins[1][0]
