"""The loop as points: states in order, nothing left out, the friction law at every point."""

import numpy as np
import pytest

import fcm
from fcm.contact.sampled import parts, transitions

LOOPS = [
    (0.48, 0.4, 1.4),
    (0.32, 0.4, 0.0),
    (0.32, 0.4, 1.5),
    (0.1, 0.3, 2.1),
    (2.0, 0.1, 0.0),
    (-2.0, 1.0, 0.0),
    (0.3, 2.0, 0.0),
    (0.3, 2.0, 1e-3),
    (1e6, 1.0, 1.0),
]


@pytest.mark.parametrize("parameters", LOOPS)
def test_the_states_follow_one_another_through_one_cycle(parameters):
    loop = fcm.hysteresis_loop(*parameters)
    found = parts(loop)
    assert "".join(part.state for part in found) == loop.sequence
    assert sum(part.theta[-1] - part.theta[0] for part in found) == pytest.approx(2.0 * np.pi)
    for one, two in zip(found, [*found[1:], found[0]], strict=True):
        for ends in ("displacement", "force", "limit"):
            assert getattr(one, ends)[-1] == pytest.approx(getattr(two, ends)[0], abs=1e-9)


@pytest.mark.parametrize("parameters", LOOPS)
def test_each_state_is_what_it_is_called(parameters):
    n0_bar, b_bar, phi = parameters
    for part in parts(fcm.hysteresis_loop(*parameters)):
        load = np.maximum(n0_bar + b_bar * np.sin(part.theta + phi), 0.0)
        np.testing.assert_allclose(part.limit, load, atol=1e-12)
        np.testing.assert_allclose(part.displacement, np.sin(part.theta), atol=1e-15)
        slip = part.displacement - part.force
        moved = np.diff(slip[1:-1])  # the ends belong to the neighbours as well
        if part.state == "E":
            np.testing.assert_allclose(slip, slip[0], atol=1e-9)
        elif part.state == "S":
            np.testing.assert_allclose(part.force, 0.0, atol=1e-12)
        else:
            sign = 1.0 if part.state == "P" else -1.0
            np.testing.assert_allclose(part.force, sign * load, atol=1e-9)
            assert (sign * moved > 0.0).all()


def test_transitions_are_where_the_parts_meet():
    loop = fcm.hysteresis_loop(0.32, 0.4, 1.5)
    found, pieces = transitions(loop), parts(loop)
    assert [t.states[1] for t in found] == list(loop.sequence)
    assert [t.states[0] for t in found] == [loop.sequence[-1], *loop.sequence[:-1]]
    for t, part in zip(found, pieces, strict=True):
        assert (t.theta, t.displacement, t.force) == pytest.approx(
            (part.theta[0], part.displacement[0], part.force[0])
        )
    assert transitions(fcm.hysteresis_loop(2.0, 0.1, 0.0)) == []
