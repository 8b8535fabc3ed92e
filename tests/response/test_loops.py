"""The loop of every contact at every point of a response, against the displacements of the same point."""

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.response import respond, trace
from fcm.response.options import leaving_out


def relative_motion(curve, contact):
    """Complex amplitudes of u and v across a contact, and the mean of v."""
    X = curve.fundamental * np.exp(1j * curve.phase)
    return X @ contact.tangential, X @ contact.normal, curve.mean @ contact.normal


@pytest.mark.parametrize("name", ["yang1998-n5", "two-contacts"])
def test_the_loop_is_that_of_the_displacements(name):
    scene = fcm.load_scene(name)
    (curve,) = trace(scene, harmonics=1).curves
    for i, c in enumerate(scene.contacts):
        u, v, mean = relative_motion(curve, c)
        n0_bar, b_bar, phi, a, force = curve.loop[:, i].T
        np.testing.assert_allclose(a, np.abs(u), rtol=1e-9)
        np.testing.assert_allclose(force, c.k_u * np.abs(u), rtol=1e-9)
        np.testing.assert_allclose(n0_bar * force, c.mu * (c.n_0 + c.k_v * mean), rtol=1e-7, atol=1e-9)
        np.testing.assert_allclose(b_bar * force, c.mu * c.k_v * np.abs(v), rtol=1e-8)
        np.testing.assert_allclose(np.exp(1j * phi), v / u * np.abs(u / v), atol=1e-8)


def test_its_states_are_the_regime():
    (curve,) = trace(fcm.load_scene("yang1998-n5")).curves
    for k in range(0, len(curve.frequency), 7):
        assert fcm.hysteresis_loop(*curve.loop[k, 0, :3]).sequence == curve.regime[k, 0]


def test_a_contact_that_was_left_out_has_one():
    scene = fcm.load_scene("two-contacts")
    idle = replace(scene, contacts=(replace(scene.contacts[0], mu=0.0, k_v=0.0), scene.contacts[1]))
    without, whole = trace(idle), trace(idle, options=leaving_out(None))
    assert any("contact" in text for text in without.left_out) and not whole.left_out
    for end in (0, -1):  # of the range: the same frequency in both
        loops = [response.curves[0].loop[end] for response in (without, whole)]
        np.testing.assert_allclose(*loops, rtol=1e-5)


def test_the_file_names_its_parts():
    data = respond(fcm.load_scene("two-contacts"))
    for name in ("n0_bar", "b_bar", "phi", "tangential_amplitude", "spring_force"):
        assert data[name].dims == ("curve", "point", "contact")
    ratio = data.spring_force / data.tangential_amplitude
    assert ratio.isel(curve=0, point=0).values == pytest.approx([2.0e4, 5.0e4])  # k_u of the scene
