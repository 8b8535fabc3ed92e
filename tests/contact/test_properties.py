"""What holds for all arguments, left to hypothesis to break."""

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

from fcm import fourier_coefficients, hysteresis_loop
from fcm.contact.loop import sequences

from .cases import SEQUENCES

special = st.sampled_from([0.0, 1.0, 0.5, 2.0, 1.0 - 2.0**-53, 1.0 + 2.0**-52, 1e-12, 1e-300, 1e3])
b_bars = special | st.floats(0.0, 1e3)
n0_bars = special | special.map(lambda x: -x) | st.floats(-1e3, 1e3)
phis = st.sampled_from([k * np.pi / 2.0 for k in range(-4, 5)]) | st.floats(-10.0, 10.0)
contacts = st.tuples(n0_bars, b_bars, phis) | st.tuples(b_bars, phis).map(lambda x: (x[0], *x))


@given(contacts, contacts)
@example((1.6948237067274202e-16, 1.0, np.pi), (0.0, 1.0, np.pi))
def test_coefficients_move_no_more_than_the_load(one, other):
    """The slip motion follows its two limits without amplifying them, so |df| <= |dn| at every angle."""
    (n0, b, phi), (m0, c, psi) = one, other
    moved = abs(n0 - m0) + abs(b - c) + min(b, c) * abs(phi - psi)
    difference = np.abs(np.subtract(fourier_coefficients(*one), fourier_coefficients(*other)))
    assert np.all(difference <= 4.0 / np.pi * moved + 1e-14)


@given(contacts, st.floats(-17.0, -3.0), st.integers(0, 2))
def test_no_jump_anywhere(contact, exponent, axis):
    n0, b, phi = contact
    near = [n0, b, phi]
    near[axis] += 10.0**exponent
    step = abs(near[axis] - contact[axis]) * (b if axis == 2 else 1.0)
    difference = np.abs(np.subtract(fourier_coefficients(*contact), fourier_coefficients(*near)))
    assert np.all(difference <= 4.0 / np.pi * step + 1e-14)


@given(contacts, st.lists(st.floats(-10.0, 10.0), min_size=1, max_size=20))
def test_force_within_the_load(contact, theta):
    loop = hysteresis_loop(*contact)
    assert np.all(np.abs(loop.force(theta)) <= loop.normal_load(theta))


@given(contacts)
def test_sequence_is_known_and_the_same_from_both(contact):
    loop = hysteresis_loop(*contact)
    assert loop.sequence in SEQUENCES
    assert sequences(*contact).item() == loop.sequence
    assert len(loop.angles) == (len(loop.sequence) if len(loop.sequence) > 1 else 0)
    assert np.all((loop.angles >= 0.0) & (loop.angles < 2.0 * np.pi))
