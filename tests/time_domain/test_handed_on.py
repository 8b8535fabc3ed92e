"""What is raised where a compiled loop calls Python, as by Ctrl-C, comes out of it: it is not lost there."""

from __future__ import annotations

import numpy as np
import pytest

import fcm.time_domain.equations_of_motion as systems
from fcm.scene import Contact, Force, Modal, Scene
from fcm.shooting.period_derivative import derivative_at
from fcm.time_domain.cycle_measures import measure
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.simulation import cycles_from
from fcm.time_domain.state import State

MODES = 17  # with two forces and a number 37 components: matrices are multiplied by BLAS


def many_modes():
    """Seventeen masses apart, the first on a contact that slips now and then."""
    x = np.eye(MODES)
    frequency = 1.0 + np.arange(MODES) / MODES
    modal = Modal(
        tuple(f"x{i}" for i in range(MODES)), np.ones(MODES), frequency, np.full(MODES, 0.05), x + 0.1
    )
    contact = Contact("c", x[0], x[1], 0.3, 0.5, 0.2, 1.0)
    return Scene("many modes", modal, (contact,), (Force(x[0], 1.0, 0.0),), (0.05, 2.0), 0.05)


def cycle():
    """One cycle that is many times as long as its steps."""
    found, _ = next(iter(cycles_from(EquationsOfMotion(many_modes(), 0.01), 1.0, State.rest(many_modes()))))
    return found


def moved():
    """The derivative of that motion."""
    found = cycle()
    last = found.segments.count - 1
    derivative_at(found.system, found.segments, last, float(found.segments.length[last]))


def measured():
    """What is reported of it."""
    measure(cycle())


CALLED_BACK = [
    ("Flows", "next_power", cycle),
    ("Flows", "spell", moved),
    ("MotionIntegrals", "fill_ahead", measured),
    ("Scan", "fill_ahead", measured),
    ("Scan", "values", measured),
]


@pytest.mark.parametrize(("kernel", "name", "run"), CALLED_BACK)
def test_what_a_kernel_calls_may_be_interrupted(monkeypatch, kernel, name, run):
    def interrupted(*_):
        raise KeyboardInterrupt

    run()  # nothing is wrong with it
    monkeypatch.setattr(systems, kernel, type(kernel, (getattr(systems, kernel),), {name: interrupted}))
    with pytest.raises(KeyboardInterrupt):
        run()


def test_a_product_of_matrices_may_be_interrupted(monkeypatch):
    found, real = cycle(), np.matmul
    last = found.segments.count - 1

    def interrupted(a, b, **options):
        if a.shape[0] != b.shape[1]:  # rows of a derivative, and no power of a flow
            raise KeyboardInterrupt
        return real(a, b, **options)

    monkeypatch.setattr(np, "matmul", interrupted)
    with pytest.raises(KeyboardInterrupt):
        derivative_at(found.system, found.segments, last, float(found.segments.length[last]))
