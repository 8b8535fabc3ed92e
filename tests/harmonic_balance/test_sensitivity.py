"""Derivatives of peaks by the numbers of a scene against differences of peaks of ordinary runs."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.harmonic_balance.dense_jacobian import Amplitude, jacobian_of
from fcm.harmonic_balance.system import System
from fcm.model.scene import Aim, Optimum
from fcm.response.optimum import optimise
from fcm.response.sensitivity import add_sensitivities, remarks
from fcm.response.sweep import trace
from fcm.scene import load_scene, scene_from_dict
from fcm.sensitivity.parameter_derivatives import rates_of
from fcm.sensitivity.peak import PeakKind
from fcm.sensitivity.peaks import numbers_of, unswept

STEP = 1e-3  # of a number


def oscillator(numbers=(), **response):
    """The paper's, with numbers at key paths."""
    values = {
        "contact.c.mu": 0.4, "contact.c.k_u": 1.0, "contact.c.k_v": 1.0, "contact.c.n_0": 5.0,
        "force.u.amplitude": 1.0, "modal.frequency.0": 1.0, "modal.damping.0": 0.01,
        "modal.frequency.1": 10.0,
        "modal.damping.1": 0.01, "force.v.amplitude": 1.0,
    } | dict(numbers)  # fmt: skip

    def of(prefix):
        return [values[key] for key in values if key.startswith(prefix)]

    contact = {key.rpartition(".")[2]: value for key, value in values.items() if key.startswith("contact")}
    return scene_from_dict(
        {
            "modal": {
                "dofs": ["u", "v"], "frequency": of("modal.frequency"),
                "damping": of("modal.damping"), "shapes": [[0.707, 0.707], [1.0, -0.5]],
            },
            "contact": [{"name": "c", "tangential": "u", "normal": "v", **contact}],
            "force": [
                {"dof": "u", "amplitude": values["force.u.amplitude"]},
                {"dof": "v", "amplitude": values["force.v.amplitude"], "phase": 0.3},
            ],
            "response": {"frequency": [0.7, 1.7]} | response,
        }
    ), values  # fmt: skip


def run(scene, harmonics):
    return trace(scene, "closed-form", harmonics=harmonics)


def check(numbers, harmonics, kind, keys=None, **response):
    """Every derivative of both peaks against differences of the fourth order."""
    scene, values = oscillator(numbers, **response)
    found = run(scene, harmonics)
    add_sensitivities(found, scene)
    own = found.curves[0].sensitivity
    assert own.kind == (kind if isinstance(kind, tuple) else (kind, kind))
    for key in keys or values:
        step = STEP * abs(values[key])
        peaks = []
        for k in (2, 1, -1, -2):
            moved, _ = oscillator({**numbers, key: values[key] + k * step}, **response)
            peaks.append([one[:2] for one in run(moved, harmonics).curves[0].peaks.values()])
        p = np.array(peaks)
        by = (8.0 * (p[1] - p[2]) - (p[0] - p[3])) / (12.0 * step)
        n = own.numbers.index(key)
        size = np.array([one[:2] for one in found.curves[0].peaks.values()]) / abs(values[key])
        assert own.height[:, n] == pytest.approx(by[:, 0], rel=1e-6, abs=1e-8 * size[:, 0].max()), key
        assert own.frequency[:, n] == pytest.approx(by[:, 1], rel=1e-6, abs=1e-8 * size[:, 1].max()), key


FEW = ("contact.c.mu", "contact.c.n_0", "modal.damping.0")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("n_0", "harmonics", "keys"),
    [(10.0, 1, None), (-5.0, 1, FEW), (10.0, 3, ("contact.c.n_0", "modal.frequency.0"))],
)
def test_smooth_peaks(n_0, harmonics, keys):
    check({"contact.c.n_0": n_0}, harmonics, PeakKind.SMOOTH, keys)


def test_peaks_where_the_range_ends_are_of_the_amplitude_there():
    check({"contact.c.n_0": 10.0}, 1, PeakKind.EDGE, FEW, frequency=[0.7, 1.2])


def test_a_peak_at_a_corner_of_the_curve():
    numbers = {
        "modal.frequency.1": 1.59, "modal.damping.0": 0.065, "modal.damping.1": 0.065, "contact.c.mu": 0.348,
        "contact.c.k_u": 2.47, "contact.c.k_v": 1.9, "contact.c.n_0": 4.45, "force.v.amplitude": 0.0,
    }  # fmt: skip
    keys = ("contact.c.n_0", "contact.c.k_v", "modal.frequency.0")
    check(numbers, 1, (PeakKind.SMOOTH, PeakKind.CORNER), keys, frequency=[0.5, 3.0])


def test_a_narrow_peak_that_no_contact_has_a_part_in():
    """A = F / (2 m w0^2 z sqrt(1 - z^2)) at w0 sqrt(1 - 2 z^2); its steep sides were taken for a corner."""
    scene = load_scene("extreme/no-motion-at-all")
    found = run(scene, 1)
    add_sensitivities(found, scene)
    own, w0, z = found.curves[0].sensitivity, 1.2, 0.01
    n, d = own.numbers.index("modal.damping.2"), list(found.curves[0].peaks).index("w")
    height = 1.0 / (2.0 * w0**2 * z * np.sqrt(1.0 - z**2))
    assert own.height[d, n] == pytest.approx(-height * (1.0 - 2.0 * z**2) / (z * (1.0 - z**2)), rel=1e-6)
    assert own.frequency[d, n] == pytest.approx(-2.0 * z * w0 / np.sqrt(1.0 - 2.0 * z**2), rel=1e-6)


def reasons(scene, harmonics=1):
    found = run(scene, harmonics)
    add_sensitivities(found, scene)
    return [one for one in remarks(found, scene) if "unknown" in one], found.curves[0]


def test_of_contacts_that_change_their_states_at_once_the_reason_is_told():
    """The corner above with two halves of the contact: each of them has the margin that changes its sign."""
    numbers = {
        "modal.frequency.1": 1.59, "modal.damping.0": 0.065, "modal.damping.1": 0.065, "contact.c.mu": 0.348,
        "contact.c.k_u": 2.47 / 2, "contact.c.k_v": 1.9 / 2, "contact.c.n_0": 4.45 / 2,
        "force.v.amplitude": 0.0,
    }  # fmt: skip
    scene, _ = oscillator(numbers, frequency=[0.5, 3.0])
    half = scene.contacts[0]
    parts = dict(scene.draft.parts)
    parts["contact"] = [draft | {"name": name} for draft in parts["contact"] for name in ("c", "d")]
    two = tuple(replace(half, name=name) for name in ("c", "d"))
    scene = replace(scene, contacts=two, draft=replace(scene.draft, parts=parts))
    said, curve = reasons(scene)
    assert curve.sensitivity.kind == (PeakKind.SMOOTH, PeakKind.UNKNOWN)
    assert said == [
        "sensitivities of peaks (curve 0, v) are unknown: several contacts change their states there at "
        "once, so that each side has its own derivative. A [sweep] of two near values shows what a number "
        "does"
    ]
    of_v = curve.summary()["sensitivity"]["v"]
    assert of_v["unknown_because"].startswith("several contacts change")
    assert "unknown_because" not in curve.summary()["sensitivity"]["u"]


def test_of_a_number_that_moves_a_peak_out_of_reach_the_reason_is_told():
    """Modes a thousandth apart: a step of 1e-4 of a frequency is a tenth of that."""
    said, curve = reasons(load_scene("extreme/close-modes"))
    assert curve.sensitivity.kind == (PeakKind.SMOOTH, PeakKind.SMOOTH)
    assert said == [
        'sensitivities of peaks (curve 0, u) by "modal.frequency.1" are unknown: the peak is not found again '
        "with the number a little larger or smaller. A [sweep] of two near values shows what a number does"
    ]


def test_one_reason_of_several_peaks_is_told_once():
    said, curve = reasons(load_scene("extreme/undamped-open"), 1)
    assert curve.sensitivity.kind == (PeakKind.UNKNOWN, PeakKind.UNKNOWN)
    (one,) = said
    assert one.startswith("sensitivities of peaks (curve 0, u, and 1 more) are unknown: ")
    assert one.endswith("Another max_step may find it; a [sweep] of two near values shows what a number does")


def test_of_numbers_that_change_rigid_body_motions_the_reason_is_told():
    modal = {
        "dofs": ["u", "v"],
        "frequency": [0.0, 2.0],
        "damping": 0.05,
        "shapes": [[1.0, 1.0], [1.0, -1.0]],
    }
    contact = {"name": "c", "tangential": "u", "normal": "v", "mu": 0.4, "k_u": 1.0, "k_v": 0.0, "n_0": 5.0}
    force, response = [{"dof": "u", "amplitude": 1.0}], {"frequency": [0.5, 3.0]}
    said, _ = reasons(
        scene_from_dict({"modal": modal, "contact": [contact], "force": force, "response": response})
    )
    (one,) = said
    assert 'by "contact.c.k_v", "modal.frequency.0" and "modal.frequency.1" are unknown: the structure' in one
    assert "has rigid-body motions, which the number may change. A [sweep] of two near values" in one


def test_values_of_a_sweep_are_those_of_the_curve():
    swept = load_scene("yang1998")
    swept = replace(swept, curves=swept.curves[3:4])
    found = run(swept, 1)
    add_sensitivities(found, swept)
    own = found.curves[0].sensitivity
    assert own.values[own.numbers.index("contact.shroud.n_0")] == 10.0
    # with n_0 and the forces in proportion, so is the response
    n_0, u, v = (
        own.numbers.index(k) for k in ("contact.shroud.n_0", "force.u.amplitude", "force.v.amplitude")
    )
    scaled = 10.0 * own.height[:, n_0] + own.height[:, u] + own.height[:, v]
    peaks = [peak.amplitude for peak in found.curves[0].peaks.values()]
    assert scaled == pytest.approx(peaks, rel=1e-9)
    still = 10.0 * own.frequency[:, n_0] + own.frequency[:, u] + own.frequency[:, v]
    assert still == pytest.approx(0.0, abs=1e-8)


def test_a_group_of_contacts_is_one_number():
    scene = load_scene("two-contacts").in_use()
    found = run(scene, 1)
    add_sensitivities(found, scene)
    numbers = found.curves[0].sensitivity.numbers
    assert "contact.platform.gap" in numbers and "contact.platform.n_0" not in numbers
    assert len(set(numbers)) == len(numbers)


def pushed(phase=0.5, load=0.4):
    """A force whose phase against a moving base counts, and a static load that presses the contact."""
    return scene_from_dict(
        {
            "modal": {
                "dofs": ["u", "v"], "frequency": [1.0, 10.0], "damping": [0.01, 0.01],
                "shapes": [[0.707, 0.707], [1.0, -0.5]], "participation": [0.5, 0.2],
            },
            "base": {"acceleration": 1.0},
            "contact": [
                {"name": "c", "tangential": "u", "normal": "v", "mu": 0.4, "k_u": 1.0, "k_v": 1.0, "n_0": 5.0}
            ],
            "force": [{"dof": "u", "amplitude": 1.0, "phase": phase}],
            "load": [{"dof": "v", "force": load}],
            "response": {"frequency": [0.7, 1.7]},
        }
    )  # fmt: skip


def test_phases_against_a_base_and_static_loads():
    found, step = run(pushed(), 1), 1e-4
    add_sensitivities(found, pushed())
    own = found.curves[0].sensitivity
    for key, moved in {
        "force.u.phase": [pushed(phase=0.5 + step), pushed(phase=0.5 - step)],
        "load.v.force": [pushed(load=0.4 + step), pushed(load=0.4 - step)],
    }.items():
        more, less = (run(one, 1).curves[0].peaks["u"] for one in moved)
        by, n = (more.amplitude - less.amplitude) / (2.0 * step), own.numbers.index(key)
        assert abs(by) > 0.1
        assert own.height[0, n] == pytest.approx(by, rel=1e-5)
        assert own.frequency[0, n] == pytest.approx(
            (more.frequency - less.frequency) / (2.0 * step), rel=1e-3
        )


def test_phases_count_from_two_forces_on():
    """All of them together shift the time, and change no peak; of one force alone that is all it does."""
    two, _ = oscillator({"contact.c.n_0": 10.0})
    found = run(two, 1)
    add_sensitivities(found, two)
    own = found.curves[0].sensitivity
    first, second = (own.numbers.index(f"force.{name}.phase") for name in "uv")
    for of in (own.height, own.frequency):
        assert of[:, first] == pytest.approx(-of[:, second], rel=1e-9) and (np.abs(of[:, first]) > 1e-3).all()
    one = scene_from_dict(
        {
            "modal": {
                "dofs": ["u", "v"],
                "frequency": [1.0, 2.0],
                "damping": 0.01,
                "shapes": [[1, 0], [0, 1]],
            },
            "contact": [
                {"name": "c", "tangential": "u", "normal": "v", "mu": 0.4, "k_u": 1.0, "k_v": 1.0, "n_0": 5.0}
            ],
            "force": [{"dof": "u", "amplitude": 1.0}],
            "response": {"frequency": [0.7, 1.7]},
        }
    )
    assert not any("phase" in number.key for number in numbers_of(unswept(one)))


def test_nothing_is_said_of_peaks_that_are_not_reported():
    """Of which none are computed: as of the displacement that the motion of a base works on."""
    scene = replace(oscillator({"contact.c.n_0": 10.0})[0], reported=("v",))
    found = run(scene, 1)
    add_sensitivities(found, scene)
    assert found.curves[0].sensitivity.kind == (PeakKind.UNKNOWN, PeakKind.SMOOTH)
    assert remarks(found, scene) == []


def test_at_an_optimum_they_are_those_of_the_scene_with_the_numbers_chosen():
    aimed = replace(oscillator()[0], optimum=Optimum(("contact.c.n_0",), ((8.0, 12.0),), (Aim("u"),)))
    found = optimise(aimed, harmonics=1)
    add_sensitivities(found, aimed)
    given, _ = oscillator({"contact.c.n_0": found.tracking.optima[0].values["contact.c.n_0"]})
    expected = trace(given, harmonics=1)
    add_sensitivities(expected, given)
    one, other = (each.curves[0].sensitivity for each in (found, expected))
    assert one.values == pytest.approx(other.values)
    assert one.height[0] == pytest.approx(other.height[0], rel=1e-6, abs=1e-6)
    assert one.height[0][one.numbers.index("contact.c.n_0")] == pytest.approx(0.0, abs=1e-5)  # it is least


def test_a_condensed_balance_has_the_jacobian_of_its_differences():
    """Of many contacts on few modes, whose own Jacobian is never formed."""
    dofs = [f"{name}{i}" for i in range(20) for name in "uv"]
    shapes = np.random.default_rng(1).normal(size=(3, 40))
    numbers = {"mu": 0.4, "k_u": 1.0, "k_v": 1.0, "n_0": 1.0}
    scene = scene_from_dict({
        "modal": {"dofs": dofs, "frequency": [1.0, 2.0, 3.0], "damping": 0.01, "shapes": shapes},
        "contact": [
            {"name": f"c{i}", "tangential": f"u{i}", "normal": f"v{i}", **numbers}
            for i in range(20)
        ],
        "force": [{"dof": "u0", "amplitude": 1.0}],
        "response": {"frequency": [0.5, 4.0]},
    })  # fmt: skip
    balance = System(scene, (1, 2)).new_balance()
    assert balance.rank > 0
    z = np.append(0.5 * np.random.default_rng(2).normal(size=balance.unknowns), 1.3)
    balance.evaluate(z)
    found, direction = jacobian_of(balance), np.random.default_rng(3).normal(size=z.size)
    amplitude = Amplitude(balance, 2)
    amplitude.at(z)
    ahead, size = [], []
    for step in (1e-6, -1e-6):
        balance.evaluate(z + step * direction)
        balance.evaluate_outputs(z + step * direction, direction)
        ahead.append(np.array(balance.residual))
        size.append(balance.output[2])
    assert found @ direction == pytest.approx((ahead[0] - ahead[1]) / 2e-6, rel=1e-6, abs=1e-6)
    assert amplitude.slopes @ direction == pytest.approx((size[0] - size[1]) / 2e-6, rel=1e-6)


@pytest.mark.parametrize("harmonics", [(1,), (1, 2, 3, 5)])
@pytest.mark.parametrize("key", ["contact.c.mu", "contact.c.k_u", "contact.c.n_0"])
def test_rates_by_a_number_of_contacts_are_those_of_the_whole_system(key, harmonics):
    """They leave out the structure, of which nothing changes; w is a displacement of no contact."""
    shapes = [[0.7, 0.7, 0.3], [1.0, -0.5, 0.8], [0.2, 0.4, -0.9]]
    modal = {"dofs": ["u", "v", "w"], "frequency": [1.0, 3.0, 10.0], "damping": 0.01, "shapes": shapes}
    contact = {"name": "c", "tangential": "u", "normal": "v", "mu": 0.2, "k_u": 1.0, "k_v": 1.0, "n_0": 3.0}
    force, response = [{"dof": "w", "amplitude": 1.0}], {"frequency": [0.7, 1.7]}
    scene = unswept(
        scene_from_dict({"modal": modal, "contact": [contact], "force": force, "response": response})
    )
    system = System(scene, harmonics)
    balance = system.new_balance()
    z = np.append(np.random.default_rng(3).normal(size=balance.unknowns), 1.3)
    rates = rates_of(system, key)
    hardly = replace(rates.linear, damping=np.full_like(rates.linear.damping, 1e-300))  # but of the structure
    short, whole = rates.at(balance, z), replace(rates, linear=hardly).at(balance, z)
    for one, other in zip(short, whole, strict=True):
        assert np.abs(other).max() > 1e-3 and one == pytest.approx(other, rel=1e-12, abs=1e-14)
