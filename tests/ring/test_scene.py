"""What a scene of a ring may say, what it may be asked, and what is drawn of it."""

from __future__ import annotations

import copy
import json

import numpy as np
import pytest
import scipy.linalg

import fcm
from fcm.cli.curves import as_table
from fcm.harmonic_balance.system import System
from fcm.plot.campbell import DrawnRing, draw_campbell, folded
from fcm.response.request import ResponseError
from fcm.scene import SceneError, load_scene, scene_from_dict
from fcm.stability.options import StabilityOptions, StructureOptions
from fcm.stability.ring_multipliers import stability_unknown

from ..program import called
from . import rings

MODAL = {
    "dofs": rings.DOFS, "damping": 0.01, "frequency": [100.0, 200.0, 300.0], "nodal_diameter": [0, 1, 1],
    "shapes": [[1, 1, 1], [1, 0.5, [0.2, 0.3]], [1.0, [1, 2], 0]],
}  # fmt: skip
BASE = {"acceleration": 1.0, "direction": {"tip": 1.0}}
STILL = {"sectors": 6, "engine_order": 0}
WHOLE = "a simulation in time needs the whole ring"


def wrong(**tables):
    """The mistakes of a scene of six sectors with some tables changed; None takes a table away."""
    data = copy.deepcopy(rings.sector(6, 1)) | tables
    with pytest.raises(SceneError) as caught:
        scene_from_dict({key: value for key, value in data.items() if value is not None}, "ring.toml")
    return list(caught.value.mistakes)


@pytest.mark.parametrize(
    ("tables", "said"),
    [
        ({"cyclic": {"sectors": 1, "engine_order": 1}}, ["cyclic.sectors: must be a whole number from 2 to"]),
        ({"cyclic": {"sectors": 6.5, "engine_order": 0.5}}, ["cyclic.sectors: must be a whole", "is 0.5"]),
        ({"cyclic": {}}, ["cyclic.sectors: missing", "cyclic.engine_order: missing"]),
        ({"cyclic": None}, ["structure.coupling: couples the", '"next.tip"', '"next.blade"']),
        ({"force": [{"dof": "next.tip", "amplitude": 1.0}]}, ['force[0].dof: is of the next']),
        ({"schedule": [{"frequency": 1.0, "cycles": 2}]}, [f"schedule: cannot be beside [cyclic]: {WHOLE}"]),
        ({"base": BASE}, ["base: cannot be beside [cyclic]"]),
        ({"base": BASE, "cyclic": STILL, "sweep": {"cyclic.engine_order": [0, 1]}},
         ["base: cannot be beside [cyclic] with an engine_order other than 0"]),
        ({"response": {"frequency": [50.0, 300.0], "output": ["tip@0"]}}, ["is that of all sectors"]),
        ({"contact": [rings.SHROUD | {"tangential": "next.tp"}]}, ['unknown degree of freedom "next.tp"']),
        ({"sweep": {"cyclic.engine_order": [1, 1.5]}}, ['"cyclic.engine_order"[1]: must be a whole number']),
        ({"sweep": {"cyclic.sectors": [5, 6]}}, ['did you mean "cyclic.engine_order"?']),
        ({"structure": rings.STRUCTURE | {"coupling": {"stiffness": [[1.0]]}}}, ["has 1 row, but"]),
        ({"structure": rings.STRUCTURE | {"stiffness": [1.0, 1.0, 1.0]}}, ["negative eigenvalue"]),
        ({"structure": None, "modal": MODAL | {"nodal_diameter": [0, 1]}}, ["has 2 numbers, but"]),
        ({"structure": None, "modal": MODAL | {"nodal_diameter": [0, 1, 4]}}, ["[2]: is 4, but those"]),
        ({"structure": None, "modal": MODAL | {"nodal_diameter": [0, 2, 2]}}, ["diameter 1, which harm"]),
        ({"structure": None, "modal": MODAL | {"nodal_diameter": [1, 1, 1]}}, ["diameter 0, which the"]),
        ({"structure": None, "modal": MODAL | {"nodal_diameter": [1, 1, 0]}}, ["of diameter 0, so it"]),
        ({"structure": None, "modal": MODAL | {"pairs": True}}, ["frequencies differ, 200 and 300"]),
        ({"structure": None, "modal": MODAL | {"pairs": True, "damping": [0.01, 0.01]}},
         ["damping: has 2 numbers, but"]),
        ({"structure": None, "cyclic": None, "modal": MODAL, "contact": None},
         ["shapes[1][2]: must be a number", "shapes[2][1]", "modal.nodal_diameter: is of the modes of"]),
    ],
)  # fmt: skip
def test_mistakes_are_named(tables, said):
    found = wrong(**tables)
    assert len(found) == len(said)
    for mistake, part in zip(found, said, strict=True):
        assert part in mistake


@pytest.mark.parametrize("ask", [{"method": "exact"}, {"method": "exact", "at": [190.0]}])
def test_the_exact_motion_needs_the_whole_ring(ask):
    with pytest.raises(ResponseError, match="needs the whole ring: write all its sectors out"):
        fcm.respond(scene_from_dict(rings.sector(6, 1)), **ask)


def test_harmonics_without_modes_are_refused_and_their_absence_is_said():
    data = rings.sector(6, 1)
    del data["structure"]
    scene = scene_from_dict(data | {"modal": MODAL})
    with pytest.raises(ResponseError, match="no modes of nodal diameter 2, which harmonic 2"):
        fcm.respond(scene, harmonics=2)
    with pytest.raises(ResponseError, match="give its modes, or the harmonics"):
        fcm.respond(scene, accuracy=0.01)
    response = fcm.respond(scene, harmonics=1)
    summary = json.loads(response.attrs["summary"])
    assert any("stability: there are no modes of nodal diameter 2, 3" in text for text in summary["left_out"])
    assert np.isnan(response.stable.values).any()
    said = as_table(summary, "rad/s")
    assert '"left out" says why' in said and "more harmonics may" not in said
    assert "more harmonics may" in as_table(summary | {"without_stability": False}, "rad/s")


def test_too_many_disturbances_are_said_with_what_helps():
    system = System(scene_from_dict(rings.sector(6, 1)), (1,))
    options = StabilityOptions(structure=StructureOptions(max_disturbances=3))
    why = stability_unknown(system, 100.0, options)
    assert "too many; up to 3 are looked at. structure.modes may take fewer modes" in why


def test_resonances_of_the_diameters_that_forces_meet_are_said():
    """Harmonic 1 of order 2 meets the diameter 2, harmonic 3 of 7 sectors the diameter 1."""
    data = rings.sector(7, 2)
    data["force"][1]["harmonic"] = 3
    found = [one for one in scene_from_dict(data).notes if "which harmonic" in one]
    ring = rings.matrices(data)
    turn = [np.exp(2j * np.pi * number * np.arange(7) / 7) for number in (1, 2)]
    for text, number, harmonic, phases in zip(found, (1, 2), (3, 1), turn, strict=True):
        basis = np.kron(phases[:, None], np.eye(3)) / np.sqrt(7.0)
        mass, stiffness = (basis.conj().T @ one @ basis for one in ring)
        opened = np.sqrt(scipy.linalg.eigh(stiffness, mass, eigvals_only=True)) / (2.0 * np.pi)
        assert f"nodal diameter {number}, which harmonic {harmonic} of engine order 2 meets" in text
        assert f"all contacts open: {', '.join(f'{one:.5g}' for one in opened)} Hz; with all stuck" in text


@pytest.mark.slow
def test_engine_orders_are_swept():
    """Each curve as if it were alone, and those of a number beyond the sectors as that of the remainder."""
    data = rings.sector(5, 1, harmonics=1, max_step=0.3)
    found = fcm.respond(scene_from_dict(data | {"sweep": {"cyclic.engine_order": [1, 2, 7]}}))
    assert found["cyclic.engine_order"].values.tolist() == [1, 2, 7]
    alone = fcm.respond(scene_from_dict(rings.sector(5, 2, harmonics=1, max_step=0.3)))
    assert found.peak_amplitude.values[1:] == pytest.approx(np.tile(alone.peak_amplitude.values, (2, 1)))
    assert abs(found.peak_frequency.values[0] / alone.peak_frequency.values[0] - 1.0).max() > 0.01


@pytest.mark.parametrize(
    "options, what",
    [
        (["--sensitivity"], "sensitivities"),
        (["--mode", "1", "--level", "1:2"], "nonlinear modes"),
        (["--track", "peaks", "--over", "level", "--from", "1", "--to", "2"], "tracked points"),
    ],
)
def test_what_is_not_computed_of_a_ring_is_refused_at_once(tmp_path, options, what):
    code, out, err = called("respond", "bladed-disk", "-o", tmp_path / "a.nc", *options)
    assert code == 2 and not out and not list(tmp_path.iterdir())
    assert f"bladed-disk: cyclic: {what} of a ring of sectors are not computed. Write all" in err


def test_a_sector_keeps_its_own_degree_of_freedom_of_a_next_one_that_is_used():
    """Curves that are made again of a scene at the degrees of freedom in use are those made of the whole."""
    data = rings.sector(5, 1, harmonics=1) | {"sweep": {"cyclic.engine_order": [1, 2]}}
    data["response"]["output"] = ["blade"]
    scene = scene_from_dict(data).in_use()
    for curve in scene.curves:
        again = scene.draft.curve(scene, curve.parameters, {("modal", "damping", 0): 0.5})
        assert again.ring.engine_order == curve.ring.engine_order
        assert again.ring.shapes == pytest.approx(curve.ring.shapes)
        assert (again.ring.damping != curve.ring.damping).sum() == 1


@pytest.mark.parametrize(
    ("coupled", "contact", "asked"), [(True, False, 0), (False, True, 0), (False, False, 1)]
)
def test_sectors_that_nothing_joins_are_asked_about(coupled, contact, asked):
    alone = rings.SHROUD | {"tangential": "tip", "normal": "blade"}
    data = rings.sector(5, 1, contacts=[rings.SHROUD if contact else alone], harmonics=1)
    if not coupled:
        del data["structure"]["coupling"]
    notes = scene_from_dict(data).notes
    assert sum("Nothing joins the sectors" in one for one in notes) == asked


def test_campbell_in_numbers():
    code, out, err = called("plot", "campbell", "bladed-disk", "--json")
    found = json.loads(out)
    assert code == 0 and "stability" not in err  # a list of frequencies has none
    assert any("disturbances of the same travelling wave" in one for one in load_scene("bladed-disk").notes)
    (order,) = found["engine_orders"]
    assert order["nodal_diameters"] == [0, 3, 6, 9, 12, 9, 6, 3, 0, 3, 6] and order["speeds"] == [60.0, 80.0]
    assert found["diameters"][2]["open"][0] == pytest.approx(189.3018526, rel=1e-9)
    for one in found["diameters"]:
        assert all(stuck > free for stuck, free in zip(one["stuck"], one["open"], strict=True))
    assert order["resonances"]["stuck"] == found["diameters"][3]["stuck"][:1]


def test_campbell_draws_and_refuses(tmp_path):
    picture = tmp_path / "disk.svg"
    assert called("plot", "campbell", "bladed-disk", "-o", picture).code == 0
    assert picture.stat().st_size > 10_000
    code, _, err = called("plot", "campbell", "yang1998")
    assert code == 2 and err.startswith("fcm: error: yang1998: has no [cyclic]") and "Usage" not in err


def test_campbell_needs_no_range(tmp_path):
    structure = '[structure]\ndofs = ["x"]\nmass = [1.0]\nstiffness = [4.0]\ndamping = 0.01\n'
    coupling = "coupling = { stiffness = [-1.0] }\n[cyclic]\nsectors = 6\nengine_order = 2\n"
    (tmp_path / "s.toml").write_text(structure + coupling)
    found = json.loads(called("plot", "campbell", tmp_path / "s.toml", "--json").out)
    exact = [np.sqrt(4.0 - 2.0 * np.cos(np.pi * d / 3.0)) for d in range(4)]
    assert [one["open"] for one in found["diameters"]] == [[pytest.approx(w)] for w in exact]
    (order,) = found["engine_orders"]
    assert found["range"] is None and order["speeds"] is None and order["resonances"] is None
    assert called("plot", "campbell", tmp_path / "s.toml").code == 0
    assert (tmp_path / "s-campbell.png").stat().st_size > 10_000


def test_bars_of_orders_that_meet_one_diameter_stand_side_by_side():
    levels = tuple(np.array([200.0, 700.0]) for _ in range(13))
    orders = (3, 21, 27, 8, 45, 0, 51)
    ring = DrawnRing("", 24, orders, (100.0, 350.0), "Hz", tuple(range(13)), levels, levels)
    figure = draw_campbell(ring)
    (axes,) = figure.axes
    bars = [
        (b.get_x(), b.get_x() + b.get_width(), b.get_y(), b.get_y() + b.get_height()) for b in axes.patches
    ]
    top = axes.get_ylim()[1]
    assert len(bars) == 6 * sum(100.0 * h < top for h in range(1, 6))
    for i, (left, right, low, high) in enumerate(bars):
        nearest = round(0.5 * (left + right))
        assert nearest - 0.5 < left < right < nearest + 0.5 and high == pytest.approx(3.5 * low)
        for other_left, other_right, other_low, other_high in bars[:i]:
            apart = right <= other_left + 1e-9 or other_right <= left + 1e-9
            assert apart or high <= other_low or other_high <= low
    named = {text.get_text() for text in figure.legends[0].get_texts()}
    assert {f"order {n}, numbers: its harmonics" for n in orders[:6]} <= named
    assert axes.get_title(loc="right") == "24 sectors; the first 6 of 7 engine orders"


def test_numbers_of_harmonics_stand_clear_of_modes():
    opened = tuple(np.array([400.0, 480.0 + 3.0 * d, 700.0]) for d in range(13))
    stuck = tuple(one + 12.0 for one in opened)
    ring = DrawnRing("", 24, (3, 4, 5, 6, 7), (180.0, 240.0), "Hz", tuple(range(13)), opened, stuck)
    (axes,) = draw_campbell(ring).axes
    top, numbers = axes.get_ylim()[1], [one for one in axes.texts if one.get_text().isdecimal()]
    assert len(numbers) >= 10 and all(one.get_path_effects() for one in numbers)
    for one in numbers:
        x, foot = one.xy
        assert 0.0 < foot <= 0.95 * top
        if abs(x - round(x)) < 0.1:  # its letters are 0.03 of the axis high
            of_diameter = np.concatenate((opened[round(x)], stuck[round(x)]))
            assert not ((of_diameter > foot) & (of_diameter < foot + 0.03 * top)).any()


def test_lines_of_engine_orders_run_up_and_down():
    turns = np.arange(0, 30)
    phases = np.exp(2j * np.pi * np.outer(turns, range(7)) / 7)  # as sectors see them
    for order, seen in zip(turns.tolist(), phases, strict=True):
        number = folded(order, 7)
        assert 0 <= number <= 3
        assert seen.real == pytest.approx(np.cos(2.0 * np.pi * number * np.arange(7) / 7), abs=1e-9)


def test_modes_are_listed_by_diameter():
    code, out, _ = called("plot", "modes", "bladed-disk", "--json")
    modes = json.loads(out)["modes"]
    assert code == 0 and len(modes) == 39
    assert [mode["nodal_diameter"] for mode in modes[:4]] == [0, 0, 0, 1]
    for number in range(13):
        shares = [m["participation"]["force.tip"] for m in modes if m["nodal_diameter"] == number]
        assert sum(shares) == pytest.approx(1.0)
