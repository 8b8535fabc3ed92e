"""The hysteresis loop: its sequence, its transitions, its force."""

import numpy as np
import pytest

from fcm import fourier_coefficients, hysteresis_loop
from fcm.contact.loop import sequences

from . import marched
from .cases import SEQUENCES, all_boundaries, points

# angle and weight of Gauss's rule on [-1, 1]: exact for the sines of one region
NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)
MODERATE = ["linear", "logarithmic", "near_boundaries", "near_degenerate", "faint", "between_sequences"]
ALL = [*MODERATE, "turned_often", "between_sequences_at_large_b", "large", "largest"]

# one contact of each sequence, away from the borders of its region
EXAMPLES = {
    "E": (2.0, 0.5, 1.0),
    "EPEN": (0.6, 0.4, 1.4),
    "S": (-1.0, 0.5, 1.0),
    "SE": (0.5, 2.0, 0.0),
}


def loops(name, n):
    return [hysteresis_loop(*x) for x in zip(*points(name, n), strict=True)]


@pytest.mark.parametrize("name", ALL)
def test_sequences_are_known(name):
    arguments = points(name, 20000)
    assert set(np.unique(sequences(*arguments))) <= set(SEQUENCES)


def test_sequences_are_known_on_every_boundary():
    assert set(np.unique(sequences(*all_boundaries()))) <= set(SEQUENCES)


def test_each_sequence_occurs():
    """All thirteen in a plain random sample; the fourteenth is a limit, met on phi = 0 and pi only."""
    occur = set(np.unique(sequences(*points("linear", 20000))))
    assert occur == set(SEQUENCES) - {"SE"}
    assert sequences([0.5, 0.5], 2.0, [0.0, np.pi]).tolist() == ["SE", "SE"]


@pytest.mark.parametrize("phi", np.pi * np.arange(-4.0, 5.0))
@pytest.mark.parametrize("b", [1.0 + 1e-6, 1.25, 2.0, 10.0, 1e3, 1e12, 1e300])
def test_in_phase_and_above_one_only_sticks_and_opens(b, phi):
    for n0 in b * np.array([-0.9, -0.3, 0.0, 0.3, 0.9]):
        assert hysteresis_loop(n0, b, phi).sequence == "SE"


@pytest.mark.parametrize("sequence", EXAMPLES)
def test_examples(sequence):
    assert hysteresis_loop(*EXAMPLES[sequence]).sequence == sequence


@pytest.mark.parametrize("name", ALL)
def test_vectorised_sequences_are_those_of_the_loops(name):
    arguments = points(name, 150)
    assert sequences(*arguments).tolist() == [
        hysteresis_loop(*x).sequence for x in zip(*arguments, strict=True)
    ]


def test_half_a_turn_of_phase_exchanges_positive_and_negative():
    n0, b, phi = points("linear", 3000)
    here, there = sequences(n0, b, phi), sequences(n0, b, phi + np.pi)
    opens = np.char.startswith(here, "S")
    exchanged = [name.translate(str.maketrans("PN", "NP")) for name in here[opens]]
    assert there[opens].tolist() == exchanged
    assert there[~opens].tolist() == here[~opens].tolist()


@pytest.mark.parametrize("name", ALL)
def test_force_is_within_the_load(name):
    for loop in loops(name, 150):
        theta = np.concatenate((np.linspace(-7.0, 7.0, 211), loop.angles, np.nextafter(loop.angles, 9.0)))
        assert np.all(np.abs(loop.force(theta)) <= loop.normal_load(theta)), loop


@pytest.mark.parametrize("name", [*MODERATE, "turned_often"])
def test_force_is_continuous(name):
    """No jump at a transition: the force moves by no more than the motion and the load do."""
    h = 1e-9
    for loop in loops(name, 150):
        jump = np.abs(loop.force(loop.angles + h) - loop.force(loop.angles - h))
        rounding = 4.0 * (1.0 + loop.b_bar) * np.spacing(10.0 + abs(loop.phi))
        assert np.all(jump <= 2.0 * h * (1.0 + loop.b_bar) + rounding), loop


@pytest.mark.parametrize("name", MODERATE)
def test_force_integrates_to_the_coefficients(name):
    for loop in loops(name, 150):
        cuts = np.unique(np.concatenate(([0.0, np.pi, 2.0 * np.pi], loop.angles)))
        half = 0.5 * np.diff(cuts)[:, None]
        theta = cuts[:-1, None] + half * (1.0 + NODES)
        part = loop.force(theta) * half * WEIGHTS / np.pi
        F = 0.5 * np.sum(part), np.sum(part * np.sin(theta)), np.sum(part * np.cos(theta))
        # theta + phi is rounded, and n with it
        allowed = 2e-15 + 2.0 * loop.b_bar * np.spacing(10.0 + abs(loop.phi))
        exact = fourier_coefficients(loop.n0_bar, loop.b_bar, loop.phi)
        np.testing.assert_allclose(F, exact, rtol=0.0, atol=allowed, err_msg=str(loop))


@pytest.mark.parametrize("name", MODERATE)
def test_angles_go_once_round(name):
    for loop in loops(name, 150):
        assert len(loop.angles) == (len(loop.sequence) if len(loop.sequence) > 1 else 0)
        assert np.all((loop.angles >= 0.0) & (loop.angles < 2.0 * np.pi))
        lengths = np.mod(np.diff(loop.angles, append=loop.angles[:1]) + 1e-14, 2.0 * np.pi)
        assert np.sum(lengths) == pytest.approx(2.0 * np.pi if len(lengths) else 0.0, abs=1e-12), loop


def test_states_are_those_of_the_march():
    """At every step that is not within three steps of a transition, over three hundred random contacts."""
    n0, b, phi = points("linear", 300)
    theta, _, marched_states = marched.march(n0, b, phi, steps=1500)
    for i, x in enumerate(zip(n0, b, phi, strict=True)):
        loop = hysteresis_loop(*x)
        apart = np.abs(np.mod(theta[:, None] - loop.angles + np.pi, 2.0 * np.pi) - np.pi)
        clear = np.all(apart > 3.0 * theta[1], axis=1)
        assert loop.states(theta)[clear].tolist() == marched_states[clear, i].tolist(), loop


def test_force_is_that_of_the_march():
    n0, b, phi = points("near_boundaries", 300)
    theta, forces, _ = marched.march(n0, b, phi, steps=1500)
    for i, x in enumerate(zip(n0, b, phi, strict=True)):
        difference = np.abs(hysteresis_loop(*x).force(theta) - forces[:, i])
        assert np.max(difference) <= theta[1] + 2.0 * (1.0 + b[i]) * theta[1] ** 2


def test_slip_motion_is_held_while_sticking():
    loop = hysteresis_loop(0.8, 1.0, 0.5)
    assert loop.sequence == "SEPEN"
    assert np.isnan(loop.slip_motion).tolist() == [True, False, True, False, True]
    stick = loop.angles[1] + 1e-3
    assert loop.force(stick) == pytest.approx(np.sin(stick) - loop.slip_motion[1], abs=1e-16)


def test_shape_of_what_is_asked():
    loop = hysteresis_loop(0.8, 1.0, 0.5)
    assert loop.force(0.0).shape == ()
    assert loop.force(np.zeros((2, 3))).shape == (2, 3)
    assert loop.states([[0.0, 1.0]]).shape == (1, 2)
