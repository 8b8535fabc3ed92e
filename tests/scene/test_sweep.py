"""Sweeps: where the values go, in which order, and what is refused."""

from __future__ import annotations

import tomllib
from itertools import product
from math import pi

import numpy as np
import pytest

from fcm.scene import SceneError, scene_from_dict


def swept(data, **sweep):
    """The curves of the scene with this sweep alone; _ in a name stands for a dot only through the dict."""
    return scene_from_dict(data | {"sweep": sweep}).curves


def parameters(curves):
    return [tuple(curve.parameters.values()) for curve in curves]


PATHS = [
    ("contact.shroud.n_0", lambda s: s.contacts[0].n_0),
    ("contact.0.n_0", lambda s: s.contacts[0].n_0),
    ("contact.shroud.mu", lambda s: s.contacts[0].mu),
    ("contact.1.k_u", lambda s: s.contacts[1].k_u),
    ("contact.shroud.k_v", lambda s: s.contacts[0].k_v),
    ("contact.damper.gap", lambda s: s.contacts[1].n_0 / -2.5),
    ("contact.damper.k_v", lambda s: s.contacts[1].n_0 / -3.0),  # the preload of a gap follows its stiffness
    ("contact.shroud.tangential.u", lambda s: s.contacts[0].tangential[0]),
    ("contact.shroud.normal.w.x", lambda s: s.contacts[0].normal[2]),
    ("force.0.amplitude", lambda s: s.forces[0].amplitude),
    ("force.u.amplitude", lambda s: s.forces[0].amplitude),
    ("force.1.phase", lambda s: s.forces[1].phase),
    ("force.1.dof.v", lambda s: s.forces[1].direction[1]),
    ("modal.mass.1", lambda s: s.modal.mass[1]),
    ("modal.frequency.0", lambda s: s.modal.frequency[0]),
    ("modal.damping.1", lambda s: s.modal.damping[1]),
    ("modal.damping", lambda s: s.modal.damping[0]),
    ("modal.shapes.1.2", lambda s: s.modal.shapes[1, 2]),
    ("modal.shapes.1.w.x", lambda s: s.modal.shapes[1, 2]),
]


@pytest.mark.parametrize("key, value", PATHS, ids=[key for key, _ in PATHS])
def test_a_value_goes_where_its_path_says_and_nowhere_else(data, key, value):
    base = scene_from_dict(data | {"sweep": {}})
    curves = swept(data, **{key: [0.25, 0.75]})
    assert [value(curve) for curve in curves] == pytest.approx([0.25, 0.75])
    assert [curve.parameters for curve in curves] == [{key: 0.25}, {key: 0.75}]
    assert differences(base, curves[0]) in (1, 2 if key in ("modal.damping", "contact.damper.k_v") else 1)


def differences(one, other):
    """How many numbers of two scenes differ."""

    def numbers(scene):
        modal = scene.modal
        yield from np.concatenate([modal.mass, modal.frequency, modal.damping, modal.shapes.ravel()])
        for contact in scene.contacts:
            yield from (contact.mu, contact.k_u, contact.k_v, contact.n_0)
            yield from (*contact.tangential, *contact.normal)
        for force in scene.forces:
            yield from (*force.direction, force.amplitude, force.phase)

    return sum(a != b for a, b in zip(numbers(one), numbers(other), strict=True))


def test_the_base_scene_stays_as_it_is_and_curves_share_what_is_equal(data):
    scene = scene_from_dict(data)
    assert scene.contacts[0].n_0 == 5 and scene.parameters == {}
    assert all(curve.modal is scene.modal and curve.forces is scene.forces for curve in scene.curves)
    assert all(curve.curves == () and curve.schedule == scene.schedule for curve in scene.curves)


def test_several_keys_are_their_product_in_the_order_of_the_file(data):
    keys = {"force.u.amplitude": [1, 2], "contact.shroud.n_0": [3, 4, 5], "contact.shroud.mu": [0.1, 0.2]}
    curves = swept(data, **keys)
    assert parameters(curves) == list(product([1, 2], [3, 4, 5], [0.1, 0.2]))
    assert list(curves[0].parameters) == list(keys)
    assert (curves[-1].forces[0].amplitude, curves[-1].contacts[0].n_0, curves[-1].contacts[0].mu) == (
        2,
        5,
        0.2,
    )


def test_swept_frequencies_are_in_the_scenes_unit(data):
    data["frequency_unit"] = "Hz"
    (curve,) = swept(data, **{"modal.frequency.0": [3.0]})
    assert curve.parameters == {"modal.frequency.0": 3.0}
    assert curve.modal.frequency == pytest.approx([6 * pi, 20 * pi])


def test_ranges(data):
    linear = swept(data, **{"contact.shroud.n_0": {"from": -1, "to": 2, "count": 7}})
    assert [curve.contacts[0].n_0 for curve in linear] == [-1, -0.5, 0, 0.5, 1, 1.5, 2]
    log = swept(data, **{"contact.shroud.k_u": {"from": 1, "to": 100, "count": 3, "log": True}})
    assert [curve.contacts[0].k_u for curve in log] == pytest.approx([1, 10, 100])
    assert log[-1].contacts[0].k_u == 100
    down = swept(data, **{"contact.shroud.n_0": {"from": 5, "to": 5.0, "count": 1}})
    assert parameters(down) == [(5,)]


@pytest.mark.slow
def test_draws_follow_their_distribution_and_their_seed(data):
    normal = {"normal": [5.0, 0.5], "count": 4000, "seed": 1}
    uniform = {"uniform": [0.2, 0.6], "count": 4000, "seed": 1}
    curves = swept(data, **{"contact.shroud.n_0": normal, "contact.shroud.mu": uniform})
    n_0, mu = np.array(parameters(curves)).T
    assert len(curves) == 4000  # drawn together
    assert (n_0.mean(), n_0.std()) == pytest.approx((5, 0.5), rel=0.03)
    assert (mu.min(), mu.max(), mu.mean()) == pytest.approx((0.2, 0.6, 0.4), abs=0.01)
    assert abs(np.corrcoef(n_0, mu)[0, 1]) < 0.05
    assert swept(data, **{"contact.shroud.n_0": normal})[7].parameters["contact.shroud.n_0"] == n_0[7]
    other = swept(data, **{"contact.shroud.n_0": normal | {"seed": 2}})
    assert other[7].parameters["contact.shroud.n_0"] != n_0[7]


def test_keys_drawn_alike_with_one_seed_are_independent(data):
    draw = {"normal": [5.0, 0.5], "count": 1000, "seed": 3}
    curves = swept(data, **{"contact.shroud.n_0": draw, "contact.shroud.k_u": draw})
    assert abs(np.corrcoef(np.array(parameters(curves)).T)[0, 1]) < 0.1


def test_draws_and_lists_are_a_product(data):
    draw = {"uniform": [1, 2], "count": 3}
    curves = swept(
        data, **{"contact.shroud.k_u": draw, "contact.shroud.n_0": [1, 2], "contact.shroud.k_v": draw}
    )
    k_u, n_0, k_v = np.array(parameters(curves)).T
    assert list(n_0) == [1, 2] * 3
    assert len(set(k_u)) == len(set(k_v)) == len(set(zip(k_u, k_v, strict=True))) == 3


def test_curves_share_what_is_not_swept(data):
    """A hundred thousand of them would not fit into memory otherwise."""
    draw = {"uniform": [0.1, 1], "count": 1000}
    keys = ["contact.shroud.n_0", "contact.shroud.k_u", "modal.damping", "force.u.amplitude"]
    curves = swept(data, **dict.fromkeys(keys, draw))
    assert len(curves) == 1000
    assert len({id(curve.modal.shapes) for curve in curves}) == 1
    assert len({id(contact.normal) for curve in curves for contact in curve.contacts}) == 2
    assert len({id(force.direction) for curve in curves for force in curve.forces}) == 2


REFUSED = [
    (
        "contact.shrud.n_0",
        [1],
        'there is no such number in the scene; did you mean "contact.shroud.n_0"?',
    ),
    ("contact.shroud.n0", [1], 'did you mean "contact.shroud.n_0"?'),
    ("contact.shroud.preload", [1], 'did you mean "contact.shroud.n_0"?'),
    ("contact.7.n_0", [1], 'there is no such number in the scene; contacts are "shroud"'),
    ("contact.shroud", [1], "there is no such number"),
    ("mu", [1], 'there is no such number in the scene; there are "contact.shroud.mu", "contact.damper.mu"'),
    ("contact.shroud.name", [1], "there is no such number"),
    ("modal.damping.2", [1], "there is no such number"),
    ("modal.damping.99999999999999999999", [1], "there is no such number"),
    ("modal.shapes.0.3", [1], "there is no such number"),
    ("modal.shapes.0.²", [1], "there is no such number"),
    ("", [1], "there is no such number"),
    ("contact.shroud.gap", [1], 'the contact is given by n_0; sweep "contact.shroud.n_0"'),
    ("contact.damper.n_0", [1], 'the contact is given by gap; sweep "contact.damper.gap"'),
    ("response.max_step", [1], "the range, the step and the schedule cannot be swept"),
    ("schedule.0.cycles", [1], "the range, the step and the schedule cannot be swept"),
    ("contact.shroud.n_0", [], "is an empty list; give at least one value"),
    ("contact.shroud.n_0", 5, "must be a list of numbers, { from = , to = , count = }"),
    ("contact.shroud.n_0", "5", "must be a list of numbers, { from = , to = , count = }"),
    ("contact.shroud.n_0", [1, "2"], 'n_0"[1]: must be a number, is the string "2"'),
    ("contact.shroud.n_0", [1, float("nan")], 'n_0"[1]: must be finite, is nan'),
    ("contact.shroud.k_u", [1, -2, 3], 'sweep."contact.shroud.k_u"[1]: must be at least 0, is -2'),
    ("contact.shroud.mu", [-1, -2], 'sweep."contact.shroud.mu"[0]: must be at least 0, is -1'),
    ("modal.mass.0", [1, 0], 'sweep."modal.mass.0"[1]: must be greater than 0, is 0'),
    ("modal.frequency.0", [-1], "must be at least 0, is -1"),
    (
        "contact.shroud.k_u",
        {"from": -1, "to": 1, "count": 3},
        "1 of its 3 values are not allowed; the first must",
    ),
    ("contact.shroud.k_u", {"normal": [0, 1], "count": 1000}, "of its 1000 values are not allowed"),
    ("contact.shroud.n_0", {}, "must be a list of numbers"),
    ("contact.shroud.n_0", {"form": 1, "to": 2, "count": 3}, 'did you mean "from"?'),
    ("contact.shroud.n_0", {"from": 1, "normal": [1, 2], "count": 3}, "must be a list of numbers"),
    ("contact.shroud.n_0", {"from": 1, "to": 2}, 'n_0".count: missing; give a whole number'),
    ("contact.shroud.n_0", {"from": 1, "count": 3}, 'n_0".to: missing; give a number'),
    ("contact.shroud.n_0", {"from": 1, "to": 2, "count": 0}, "must be a whole number of at least 1, is 0"),
    (
        "contact.shroud.n_0",
        {"from": 1, "to": 2, "count": 2.5},
        "must be a whole number of at least 1, is 2.5",
    ),
    ("contact.shroud.n_0", {"from": 1, "to": 2, "count": 10**12}, "1000000000000 is too many"),
    ("contact.shroud.n_0", {"from": 1, "to": 2, "count": 1 << 9999}, "an integer of 10000 bits is too many"),
    ("contact.shroud.n_0", {"from": 1, "to": 2, "count": 2, "step": 2}, 'n_0".step: unknown key'),
    ("contact.shroud.n_0", {"from": 0, "to": 2, "count": 2, "log": True}, "needs from and to greater than 0"),
    ("contact.shroud.n_0", {"from": 1, "to": 2, "count": 2, "log": 1}, "log: must be true or false"),
    (
        "contact.shroud.n_0",
        {"normal": [1], "count": 2},
        "must be two numbers, [mean, deviation], is a list of 1",
    ),
    ("contact.shroud.n_0", {"normal": [1, -1], "count": 2}, "the deviation must be at least 0, is -1"),
    ("contact.shroud.n_0", {"normal": 3, "count": 2}, "must be a list of numbers, is 3"),
    ("contact.shroud.n_0", {"uniform": [2, 1], "count": 2}, "goes down: [2, 1]; give the lower one first"),
    (
        "contact.shroud.n_0",
        {"uniform": [1, 2], "count": 2, "seed": -1},
        "must be a whole number of at least 0",
    ),
    ("contact.shroud.n_0", {"uniform": [1, 2], "count": 2, "seed": True}, "of at least 0, is true"),
    ("level", [1, 2], 'sweep "force.*.amplitude", or follow the level at one frequency by'),
]


@pytest.mark.parametrize("key, value, words", REFUSED)
def test_sweeps_that_are_refused(data, mistakes, key, value, words):
    data["sweep"] = {key: value}
    message = mistakes(data)
    assert f'sweep."{key}"' in message and words in message


def test_draws_that_are_not_allowed_take_one_line(data, mistakes):
    data["sweep"] = {"contact.shroud.k_u": {"normal": [0, 1], "count": 1000}}
    assert len(mistakes(data).splitlines()) == 1


@pytest.mark.parametrize(
    "one, other",
    [
        ("contact.0.n_0", "contact.shroud.n_0"),
        ("modal.damping", "modal.damping.1"),
        ("force.0.phase", "force.u.phase"),
    ],
)
def test_two_keys_for_one_number(data, mistakes, one, other):
    data["sweep"] = {one: [1], other: [1]}
    assert f'sweep."{other}": sets the same number as "{one}"' in mistakes(data)


def test_phases_in_degrees(data, mistakes):
    data["sweep"] = {"force.u.phase": ["0deg", "30deg", 0.2]}
    swept = [float(one.parameters["force.u.phase"]) for one in scene_from_dict(data).curves]
    assert swept == pytest.approx([0.0, np.pi / 6.0, 0.2])
    data["sweep"] = {"contact.shroud.mu": ["30deg"]}
    assert "write 0.523598775598" in mistakes(data)


def test_too_many_curves(data, mistakes):
    values = {"from": 1, "to": 2, "count": 1001}
    data["sweep"] = dict.fromkeys(["contact.shroud.n_0", "contact.shroud.k_u"], values)
    assert "sweep: asks for 1002001 curves; there can be 1000000" in mistakes(data)


def test_a_key_path_without_quotes(data, mistakes):
    data["sweep"] = tomllib.loads("contact.shroud.n_0 = [1, 2]")
    assert 'sweep."contact": put the whole key path in quotes' in mistakes(data)


def test_curves_that_make_no_sense_as_a_whole(data, mistakes):
    data["force"] = data["force"][:1]
    data["sweep"] = {"force.u.amplitude": [1.0, 0.0], "contact.shroud.tangential.u": [1.0, 0.0]}
    first, *lines = mistakes(data).splitlines()
    assert first == "test.toml: 4 mistakes" and len(lines) == 4
    assert (
        "sweep with force.u.amplitude = 0, contact.shroud.tangential.u = 1: force[0].amplitude is 0, so the"
        in lines[1]
    )
    assert 'contact "shroud" has only zero tangential weights' in lines[0]


def test_mistakes_elsewhere_do_not_hide_those_of_a_sweep(data, mistakes):
    data["contact"][0]["k_u"] = "x"
    data["modal"]["frequency"] = "x"
    data["sweep"] = {"contact.shroud.k_u": [1, -1], "contact.shroud.k_w": [1], "modal.damping.0": [1]}
    message = mistakes(data)
    assert 'k_u"[1]: must be at least 0' in message and 'sweep."contact.shroud.k_w"' in message
    assert len(message.splitlines()) == 5


def test_a_contact_named_like_an_index_goes_before_the_index(data):
    data["contact"][0]["name"] = "1"
    (curve,) = swept(data, **{"contact.1.mu": [0.9]})
    assert [contact.mu for contact in curve.contacts] == [0.9, 0.3]


def test_what_is_wrong_with_every_curve_is_said_once(data, mistakes):
    for force in data["force"]:
        force["amplitude"] = 0.0
    said = mistakes(data | {"sweep": {"contact.shroud.n_0": [1.0, 2.0, 3.0]}})
    zeros = " and ".join(f"force[{i}].amplitude" for i in range(len(data["force"])))
    assert said == f"test.toml: {zeros} are 0, so the response is zero"


def renamed(data, table, key, to):
    """The key of a table misspelled."""
    data[table][0][to] = data[table][0].pop(key)


HIDDEN = {  # a mistake elsewhere, and a number that is there without it
    "contacts under another key": (
        lambda data: data.update(contacts=data.pop("contact")),
        "contact.shroud.mu",
    ),
    "one contact as a table": (lambda data: data.update(contact=data["contact"][0]), "contact.shroud.mu"),
    "no name": (lambda data: renamed(data, "contact", "name", "nmae"), "contact.shroud.mu"),
    "nodes of no file": (lambda data: data["contact"][0].update(nodes="no.csv"), "contact.shroud_2.mu"),
    "forces under another key": (lambda data: data.update(froce=data.pop("force")), "force.u.amplitude"),
    "no direction": (lambda data: renamed(data, "force", "dof", "dfo"), "force.u.amplitude"),
    "a base under another key": (lambda data: data.update(bse={"acceleration": 1.0}), "base.acceleration"),
}


@pytest.mark.parametrize("case", HIDDEN)
@pytest.mark.parametrize("table", ["sweep", "optimum", "fit"])
def test_a_number_that_another_mistake_hides_is_no_mistake(data, mistakes, case, table):
    """It was said that there is no such number in the scene."""
    spoil, key = HIDDEN[case]
    spoil(data)
    del data["schedule"], data["sweep"]
    tables = {
        "sweep": {key: [1.0]},
        "optimum": {"vary": key, "bounds": [0.1, 1.0], "minimise": "peak.u"},
        "fit": {"vary": key, "data": []},
    }
    said = mistakes(data | {table: tables[table]})
    assert "no such number" not in said and said


def test_a_name_that_several_share_is_said_with_their_indices(data, mistakes):
    """It was taken for a misspelling of another force."""
    here, beside = data["force"][0], {"dof": {"u": 1.0, "v": 1.0}, "amplitude": 1.0}
    data["force"] = [here | {"dof": "u"}, here | {"dof": "u", "phase": 1.0}, beside]
    said = mistakes(data | {"sweep": {"force.u.amplitude": [1.0]}})
    meant = 'give the one that is meant: "force.0.amplitude", "force.1.amplitude"'
    assert f'sweep."force.u.amplitude": 2 forces act at "u"; {meant}' in said and "did you mean" not in said
    assert '"force.0.dof.v", "force.1.dof.v"' in mistakes(data | {"sweep": {"force.u.dof.v": [1.0]}})
    data["load"] = [{"dof": "u", "force": 1.0}, {"dof": "u", "force": 2.0}]
    said = mistakes(data | {"sweep": {"load.u.force": [1.0]}})
    assert '2 loads act at "u"; give the one that is meant: "load.0.force", "load.1.force"' in said


def test_a_misspelled_number_is_said_beside_other_mistakes(data, mistakes):
    data["contact"][0]["mu"] = "x"
    data["sweep"] = {"contact.shrod.n_0": [1.0]}
    assert 'no such number in the scene; did you mean "contact.shroud.n_0"?' in mistakes(data)


REPEATED = [
    ({"contact.shroud.n_0": [5, 20, 20.0, 80, 5]}, ['sweep."contact.shroud.n_0": has 5 more than once']),
    ({"contact.shroud.n_0": {"from": 3, "to": 3, "count": 2}}, ["has 3 more than once"]),
    (
        {"paired": [{"contact.shroud.n_0": [1, 1, 1], "contact.shroud.mu": [0.1, 0.2, 0.1]}]},
        ["sweep.paired[0]: has 1, 0.1 more than once"],
    ),
]


@pytest.mark.parametrize("sweep, said", REPEATED)
def test_a_value_that_is_there_twice_is_refused(data, sweep, said):
    with pytest.raises(SceneError) as error:
        scene_from_dict(data | {"sweep": sweep})
    assert all(text in str(error.value) for text in said), error.value


@pytest.mark.parametrize(
    "sweep",
    [
        {"paired": [{"contact.shroud.n_0": [1, 1], "contact.shroud.mu": [0.1, 0.2]}]},
        {"contact.shroud.n_0": {"normal": [5.0, 0.0], "count": 2}},
        {"contact.shroud.n_0": [1, 2], "contact.shroud.mu": [0.1, 0.2]},
    ],
)
def test_values_that_make_other_curves_or_are_drawn_may_be_there_twice(data, sweep):
    assert len(scene_from_dict(data | {"sweep": sweep}).curves) >= 2
