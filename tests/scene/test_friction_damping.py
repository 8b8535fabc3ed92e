"""How much friction can damp a resonance, estimated before anything is solved."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import fcm
from fcm.cli.modes import as_table
from fcm.response.mode import ModeRequest, trace_modes
from fcm.scene import scene_from_dict
from fcm.scene.friction_damping import friction_damping
from fcm.scene.listing import listing

from ..program import called

ONE = """
[modal]
dofs = ["u", "v"]
mass = [2.0, 1.0]
frequency = [1.0, 2.0]
damping = [0.0, 0.01]
shapes = [[1.0, 0.0], [0.0, 1.0]]
[[contact]]
name = "damper"
tangential = "u"
normal = "v"
mu = 0.3
k_u = 1.4
k_v = 1
n_0 = 1
[[force]]
dof = "u"
amplitude = 0.1
[response]
frequency = [0.5, 2]
harmonics = 1
"""


def scene(tmp_path, text):
    (tmp_path / "scene.toml").write_text(text)
    return fcm.load_scene(tmp_path / "scene.toml")


def greatest(stiffness):
    """Of m = 1, k = 1 and a Jenkins element of k_u = stiffness: the damping ratio of its loss for a cycle."""

    return best_of(stiffness)[1]


def best_of(stiffness):
    """The amplitude, in multiples of that at which it slips, of the greatest damping ratio; this; omega^2."""

    def ratio(amplitude):  # in multiples of the displacement at which it slips
        loss = 4.0 * stiffness * (amplitude - 1.0)
        cosine = 1.0 - 2.0 / amplitude
        theta = np.arccos(cosine)
        real = stiffness * (theta - np.sin(theta) * cosine) / np.pi
        return loss / (2.0 * np.pi * amplitude**2 * (1.0 + real)), 1.0 + real

    best = minimize_scalar(lambda x: -ratio(x)[0], bounds=(1.0, 60.0), method="bounded").x
    return best, *ratio(best)


def test_of_one_degree_of_freedom_it_is_the_loss_of_a_cycle_at_the_best_amplitude(tmp_path):
    first, second = friction_damping(scene(tmp_path, ONE))
    assert first["friction_damping"] == pytest.approx(greatest(0.7), rel=5e-3)
    assert (first["open"], first["stuck"]) == (1.0, pytest.approx(np.sqrt(1.7)))
    assert second["friction_damping"] == 0.0  # it moves along the normal alone
    # so stiff that it is the second while it sticks: it is followed past the other
    _, stiff = friction_damping(scene(tmp_path, ONE.replace("k_u = 1.4", "k_u = 40")))
    assert (stiff["open"], stiff["stuck"]) == (1.0, pytest.approx(np.sqrt(21.0)))
    assert stiff["friction_damping"] == pytest.approx(greatest(20.0), rel=5e-3)


def test_the_preload_is_that_with_which_the_resonance_has_the_best_amplitude(tmp_path):
    """X = F / (2 zeta omega^2) of m = 2, and X = A mu n_0 / k_u, with A the best multiple of slip.

    The angles theta are 13 % apart, so that the best of them is off by 6 %.
    """
    multiple, ratio, square = best_of(0.7)
    moved = 0.1 / 2.0 / (2.0 * ratio * square)
    one = friction_damping(scene(tmp_path, ONE))[0]
    assert one["preload"]["damper"] == pytest.approx(moved / multiple * 1.4 / 0.3, rel=0.07)
    unmoved = ONE.replace('dof = "u"', 'dof = "v"')
    assert friction_damping(scene(tmp_path, unmoved))[0]["preload"] == {"damper": 0.0}


def test_it_is_the_greatest_damping_of_the_nonlinear_mode(tmp_path):
    of_mode = trace_modes(scene(tmp_path, ONE), ModeRequest(1, (0.01, 20.0))).curves[0].mode
    greatest_there = of_mode.damping.max()
    assert friction_damping(scene(tmp_path, ONE))[0]["friction_damping"] == pytest.approx(
        greatest_there, rel=1e-2
    )


def test_shares_are_of_contacts_that_rub(tmp_path):
    contact = ONE[ONE.index("[[contact]]") : ONE.index("[[force]]")]
    smooth = contact.replace("damper", "smooth").replace("0.3", "0")
    soft = contact.replace("damper", "soft").replace("1.4", "0.35")
    one = friction_damping(scene(tmp_path, ONE.replace("[[force]]", f"{smooth}{soft}[[force]]")))[0]
    assert one["by_contact"] == pytest.approx({"damper": 0.8, "smooth": 0.0, "soft": 0.2})


@pytest.mark.parametrize(("times", "opens"), [(0.8, []), (1.25, ["damper"])])
def test_contacts_that_open_with_the_preload_are_named(tmp_path, times, opens):
    """One mode that moves v by half of u: k_v X / 2 against n_0 = k_u X / (mu A), A the best multiple."""
    k_v = 1.0
    for _ in range(50):  # which makes the mode stiffer, so that A depends on it
        multiple, *_ = best_of(1.4 / (2.0 + 0.25 * k_v))
        k_v = 2.0 * 1.4 / (0.3 * multiple)
    one_mode = ONE.replace("mass = [2.0, 1.0]", "mass = [2.0]").replace("[1.0, 2.0]", "[1.0]")
    one_mode = one_mode.replace("[0.0, 0.01]", "[0.0]").replace("[[1.0, 0.0], [0.0, 1.0]]", "[[1.0, 0.5]]")
    made = scene(tmp_path, one_mode.replace("k_v = 1", f"k_v = {times * k_v}"))
    (found,) = friction_damping(made)
    assert found["opens"] == opens
    out = called("plot", "modes", tmp_path / "scene.toml").out
    assert ("contacts would open with this preload" in out) == bool(opens)
    (row,) = [line for line in out.splitlines() if "damper   100 %" in line]
    assert row.endswith("*") == bool(opens)


def symmetric(k_u):
    """Nine masses between walls, with stiff ends and a contact at each, pushed in the middle."""
    springs = np.array([1e4, 9.0, 3.0, 7.0, 2.0])
    every = np.concatenate((springs, springs[::-1]))
    stiffness = np.diag(every[:-1] + every[1:]) - np.diag(every[1:-1], 1) - np.diag(every[1:-1], -1)
    dofs = [f"x{i}" for i in range(9)]
    contacts = [
        {"name": name, "tangential": dof, "normal": dof, "mu": 0.3, "k_u": k_u, "k_v": 0.0, "n_0": 1.0}
        for name, dof in (("left", "x3"), ("right", "x5"))
    ]
    structure = {"dofs": dofs, "mass": [1.0] * 9, "stiffness": stiffness.tolist(), "damping": 0.01}
    force = [{"dof": "x4", "amplitude": 1.0}]
    response = {"frequency": [0.1, 9.0]}
    return {"structure": structure, "contact": contacts, "force": force, "response": response}


def test_modes_that_forces_do_not_move_but_for_rounding_have_no_preload():
    """Antisymmetric modes had 1e-15 and less."""
    every = friction_damping(scene_from_dict(symmetric(1.0)))[:7]  # those of the ends are of one frequency
    assert [one["excited"] for one in every] == [i % 2 == 0 for i in range(7)]
    for one in every:
        assert all((force > 0.0) == one["excited"] for force in one["preload"].values())


def test_overdamped_modes_that_forces_do_not_move_have_no_damping():
    found = listing(scene_from_dict(symmetric(1e3)))
    still = [one["friction_damping"] >= 1.0 and not one["excited"] for one in found["resonances"]]
    assert any(still)
    lines = as_table(found).splitlines()
    head = next(i for i, line in enumerate(lines) if line.startswith("resonance"))
    rows = [line.split() for line in lines[head + 1 : head + 1 + len(still)]]
    assert [row[4] == "-" for row in rows] == still
    assert "- of n_0: the scene's forces do not move the mode" in as_table(found)
    free = symmetric(1e3)
    del free["force"]
    free = listing(scene_from_dict(free, solved=False))
    assert "do not move" not in as_table(free) and "overdamped" in as_table(free)
