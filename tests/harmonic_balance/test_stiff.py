"""Displacements at contacts that are much stiffer than the structure, against fifty digits (mpmath)."""

from __future__ import annotations

from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest

from fcm.model.scene import Contact, Force, Modal
from fcm.response import trace
from fcm.scene import load_scene

YANG = load_scene("yang1998-n5")


def stuck(K, *forces):
    """The paper's oscillator on a contact that never slips."""
    contact = replace(YANG.contacts[0], k_u=K, k_v=K, n_0=1e4 * max(1.0, 1e-12 * K))
    return replace(YANG, contacts=(contact,), forces=forces or YANG.forces[:1])


def exact(scene, omega):
    """Amplitudes (dof,) of a scene whose contacts are springs."""
    with mp.workdps(50):
        modal, w = scene.modal, mp.mpf(omega)
        shapes = mp.matrix(modal.shapes.tolist())
        matrix, right = mp.zeros(len(modal.mass)), mp.zeros(len(modal.mass), 1)
        for i, (m, w_i, zeta) in enumerate(zip(modal.mass, modal.frequency, modal.damping, strict=True)):
            w_i = mp.mpf(w_i)
            matrix[i, i] = m * (w_i**2 - w**2 + 2j * mp.mpf(zeta) * w_i * w)
        for c in scene.contacts:
            for k, direction in ((c.k_u, c.tangential), (c.k_v, c.normal)):
                port = shapes * mp.matrix(direction.tolist())
                matrix += mp.mpf(k) * port * port.T
        for f in scene.forces:
            right += f.amplitude * mp.expj(mp.mpf(f.phase)) * (shapes * mp.matrix(f.direction.tolist()))
        return [abs(x) for x in shapes.T * mp.lu_solve(matrix, right)]


def off(scene, curve):
    """Relative errors of the amplitudes (point, dof), and what is said of them."""
    each = range(0, curve.points, 3)
    true = [exact(scene, curve.frequency[i]) for i in each]
    wrong = [[abs(float(x / t - 1)) for x, t in zip(curve.amplitude[i], row, strict=True)]
             for i, row in zip(each, true, strict=True)]  # fmt: skip
    return np.array(wrong), curve.error[::3]


@pytest.mark.parametrize("K", [1e8, 1e12, 1e16, 1e20])
@pytest.mark.parametrize("harmonics", [1, 3])
def test_a_displacement_far_below_the_other_keeps_its_digits(K, harmonics):
    scene = stuck(K)
    (curve,) = trace(scene, harmonics=harmonics).curves
    assert curve.complete and not curve.folds and curve.points < 100
    wrong, said = off(scene, curve)
    assert wrong.max() < 1e-12 and (wrong <= said + 1e-15).all()
    assert curve.peaks["v"].amplitude == pytest.approx(4.400046 * 10 / K**2 * 1.0, rel=1e-4, abs=0.0)


@pytest.mark.slow
def test_what_no_digits_are_left_of_says_so():
    """A force that no contact's direction has, but with another from the side: v is known to its rounding."""
    modal = Modal(("u", "v", "w"), np.array([0.7, 1.3, 2.0]), np.array([1.0, 10.0, 3.0]), np.full(3, 0.01),
                  np.array([[0.707, 0.707, 0.3], [1.0, -0.5, 0.2], [0.4, 0.1, 1.0]]))  # fmt: skip
    tangential, normal, free = np.eye(3)
    contact = Contact("c", tangential, normal, 0.4, 1e12, 1e12, 1e5)
    scene = replace(YANG, modal=modal, contacts=(contact,), forces=(Force(tangential, 0.3, 0.7),))
    for forces in (scene.forces, (*scene.forces, Force(free, 1e-9, 0.0))):
        loaded = replace(scene, forces=forces)
        wrong, said = off(loaded, trace(loaded).curves[0])
        assert (wrong <= said + 1e-12).all()
    bound = replace(scene, contacts=(replace(contact, normal=0.5 * tangential + normal),))
    wrong, said = off(bound, trace(bound).curves[0])
    assert (wrong <= said + 1e-12).all()


def test_a_contact_that_slips_beside_a_stiff_one_says_what_rounding_leaves():
    """A stiff contact's displacement is its force over its stiffness, whatever the other contact does."""
    modal = Modal(("u", "v", "w"), np.ones(3), np.array([1.0, 10.0, 3.0]), np.full(3, 0.02),
                  np.array([[0.7, 0.7, 0.3], [1.0, -0.5, 0.2], [0.4, 0.1, 1.0]]))  # fmt: skip
    u, v, w = np.eye(3)
    soft, stiff = Contact("soft", u, v, 0.4, 1.0, 0.0, 0.5), Contact("stiff", w, v, 0.4, 1e10, 0.0, 1e5)
    scene = replace(YANG, modal=modal, contacts=(soft, stiff), forces=(Force(u, 1.0, 0.0),))
    (curve,) = trace(scene, harmonics=1).curves
    rigid = replace(scene, contacts=(soft, replace(stiff, k_u=1e6)))
    (other,) = trace(rigid, harmonics=1).curves
    assert "P" in "".join(curve.regime[:, 0])
    force, softer = 1e10 * curve.peaks["w"].amplitude, 1e6 * other.peaks["w"].amplitude
    assert force == pytest.approx(softer, rel=1e-5 + curve.peaks["w"].error)
