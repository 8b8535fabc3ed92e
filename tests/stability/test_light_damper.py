"""Two blades with a shroud and a light damper that is thrown against both.

The damper floats, and its contacts are far stiffer than the blades: a balance with nine harmonics lacks as
much as that with three.
"""

from io import StringIO
from math import pi

import numpy as np
import pytest

from fcm.model.scene import FloatArray, Scene
from fcm.response import trace
from fcm.scene import scene_from_dict

DOFS = [
    *("shroud_t", "shroud_n", "left_x", "left_t", "left_n"),
    *("right_x", "right_t", "right_n", "force_1", "force_2"),
]
# [Hz] of a mode of unit modal mass, and what it moves each degree of freedom by
MODES = np.loadtxt(
    StringIO("""
0 0 0 0 7.906 -4.564 0 7.906 4.564 0 0
0 0 0 0 4.564 7.906 0 -4.564 7.906 0 0
164.1996 -4.147 2.334 0.08496 -0.05452 0.3014 0 0 0 1.339 0
166.6443 -4.147 2.334 0 0 0 -0.08496 0.05452 0.3014 0 -1.339
251.6461 0 0 9.129 0 0 9.129 0 0 0 0
658.0804 -5.009 -1.821 -0.1753 0.249 -0.995 0 0 0 -1.901 0
667.8696 5.01 1.821 0 0 0 -0.1753 0.249 0.995 0 -1.901
1077.553 -5.046 -4.073 1.078 -0.1323 0.4503 0 0 0 0.4076 0
1093.567 5.048 4.074 0 0 0 1.078 -0.1324 -0.4504 0 0.4077
1644.055 -1.438 3.198 0.03752 -0.2649 0.6271 0 0 0 1.026 0
1684.451 -1.415 3.303 -0.004083 -0.007362 0.02067 -0.02745 0.241 0.5613 -0.009409 -1.083
1962.804 -3.324 -2.844 0.3065 -0.6368 1.625 -0.127 0.3838 0.9896 -0.8505 0.4796
2078.705 0.9913 0.4885 0.4808 -0.4836 1.181 0.5451 -0.7379 -1.83 -0.663 -0.8864
2801.67 9.01 6 2.693 -0.2646 0.3934 -2.474 0.2992 0.4841 -0.6332 0.6229
3257.546 -0.4326 0.02819 3.408 0.3197 -0.6528 3.463 0.2468 0.577 -0.2957 -0.3744
3756.62 -0.724 -2.145 0.8416 -1.214 1.408 0.3929 1.084 1.389 -0.1371 0.07884
3934.151 0.1343 -0.1512 -2.826 0.9108 -0.8232 -2.712 1.177 1.162 0.04967 0.1064
4580.585 -6.48 -4.267 4.258 0.05562 -0.345 -4.507 -0.05107 -0.374 0.4562 -0.4155
""")
)
SPAN = (183.2, 183.8)  # [Hz]


def blades(harmonics: int) -> Scene:
    contacts = [
        ("shroud", "shroud_t", "shroud_n", 0.25, 4e6, 6e6, 60.0),
        ("left", ["left_x", "left_t"], "left_n", 0.3, 5e6, 8e6, 100.0),
        ("right", ["right_x", "right_t"], "right_n", 0.3, 5e6, 8e6, 100.0),
    ]
    keys = ("name", "tangential", "normal", "mu", "k_u", "k_v", "n_0")
    modal = {
        "dofs": DOFS, "mass": [1.0] * len(MODES), "frequency": MODES[:, 0].tolist(),
        "damping": [0.002] * len(MODES), "shapes": MODES[:, 1:].tolist(),
    }  # fmt: skip
    return scene_from_dict(
        {
            "frequency_unit": "Hz",
            "modal": modal,
            "contact": [dict(zip(keys, one, strict=True)) for one in contacts],
            "force": [
                {"dof": "force_1", "amplitude": 3.0},
                {"dof": "force_2", "amplitude": 3.0, "phase": "36deg"},
            ],
            "response": {"frequency": list(SPAN), "harmonics": harmonics},
        }
    )


def march(scene: Scene, frequency: float, steps: int, periods: int) -> FloatArray:
    """Displacements and velocities of the modes (period, 2 mode) from rest, each as a period [Hz] begins.

    Central differences; in a step the friction comes back on its circle.
    """
    shapes, natural, damping = (getattr(scene.modal, name) for name in ("shapes", "frequency", "damping"))
    h = 1.0 / frequency / steps
    ports = np.concatenate([shapes @ np.array(one.directions).T for one in scene.contacts], axis=1)
    turn = np.exp(2j * pi * np.arange(steps) / steps)
    push = sum(
        np.outer((turn * one.amplitude * np.exp(1j * one.phase)).imag, shapes @ one.direction)
        for one in scene.forces
    )
    damped, stiff = h * damping * natural, natural**2
    q, p, found = np.zeros(len(natural)), np.zeros(len(natural)), []
    sliders = [np.zeros(len(one.directions) - 1) for one in scene.contacts]
    for step in range(periods * steps):
        if step % steps == 0:
            found.append(np.concatenate((q, p / (2.0 * pi * frequency))))
        u, force, first = q @ ports, np.zeros(ports.shape[1]), 0
        for one, w in zip(scene.contacts, sliders, strict=True):
            along = slice(first, first + len(w))
            n = max(one.n_0 + one.k_v * u[along.stop], 0.0)
            friction = one.k_u * (u[along] - w)
            size = float(np.sqrt(friction @ friction))
            if size > one.mu * n:
                friction *= one.mu * n / size
                w[:] = u[along] - friction / one.k_u
            force[along], force[along.stop] = friction, n - one.n_0
            first = along.stop + 1
        p = ((1.0 - damped) * p + h * (push[step % steps] - stiff * q - ports @ force)) / (1.0 + damped)
        q = q + h * p
    return np.array(found)


@pytest.mark.slow
def test_what_the_motion_with_further_harmonics_lacks_itself_makes_nothing_unstable():
    """The march settles on a steady motion, which is stable by that; the balance may only leave it open."""
    scene = blades(3)
    states = march(scene, float(np.mean(SPAN)), 500, 160)
    change = np.linalg.norm(np.diff(states, axis=0), axis=1) / np.linalg.norm(states[-1])
    assert change[-1] < 1e-4
    assert change[-1] < 0.5 * change[-81]
    curve = trace(scene, method="closed-form").curves[0]
    assert curve.complete
    assert not (curve.stable == 0.0).any()
