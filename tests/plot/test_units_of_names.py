"""Units of swept values in the names of curves."""

import csv
from dataclasses import replace

import pytest

from fcm.plot import draw_response, read_response
from fcm.plot.peak import draw_peak, read_peaks
from fcm.plot.sensitivity import draw_sensitivity, read_sensitivity
from fcm.plot.tracked import draw_tracked, read_tracked
from fcm.response import trace
from fcm.response.exact import trace_exact
from fcm.response.level import LevelRequest, trace_levels
from fcm.response.mode import ModeRequest, trace_modes
from fcm.response.optimum import optimise
from fcm.response.sensitivity import add_sensitivities
from fcm.response.track import TrackRequest, track
from fcm.results.csv_file import write_csv
from fcm.results.output import write_netcdf
from fcm.scene import scene_from_dict

SCENE = {
    "modal": {"dofs": ["v", "u"], "frequency": [1.0], "damping": [0.02], "shapes": [[1.0, 0.2]]},
    "contact": [{"name": "c", "tangential": "u", "normal": "v", "mu": 0.4, "k_u": 1, "k_v": 1, "n_0": 2}],
    "force": [{"dof": "u", "amplitude": 1.0}],
    "response": {"frequency": [0.7, 1.6]},
}  # fmt: skip
UNITS = {"units": {"length": "mm", "force": "N"}}


def written(figure):
    """What is written beside curves and points."""
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    texts += [axes.get_title(loc="right") for axes in figure.axes]
    return texts + [text.get_text() for legend in figure.legends for text in legend.get_texts()]


@pytest.mark.slow
@pytest.mark.parametrize("unit", ["Hz", "rad/s"])
def test_where_the_level_was_varied_is_said_in_its_unit(tmp_path, unit):
    found = trace_levels(scene_from_dict(SCENE | {"frequency_unit": unit}), LevelRequest([1.2], (0.0, 2.0)))
    write_netcdf(found, tmp_path / "level.nc")
    names = written(draw_response(read_response(tmp_path / "level.nc")))
    assert any(f"= 1.2 {unit}" in name for name in names)


def test_swept_values_have_the_unit_that_the_scene_says(tmp_path):
    swept = SCENE | UNITS | {"sweep": {"contact.c.n_0": [1.0, 2.0, 3.0]}}
    found = trace(scene_from_dict(swept))
    write_netcdf(found, tmp_path / "swept.nc")
    for figure in (
        draw_response(read_response(tmp_path / "swept.nc")),
        draw_peak(read_peaks(tmp_path / "swept.nc")),
    ):
        assert any(name.partition("$n_{0}$ = ")[2][1:].startswith(" N") for name in written(figure))


WAYS = {
    "trace": lambda scene: trace(scene),
    "exact": lambda scene: trace_exact(scene, only="peaks"),
    "at": lambda scene: trace_exact(scene, [0.8]),
    "level": lambda scene: trace_levels(scene, LevelRequest([0.8], (0.0, 2.0))),
    "mode": lambda scene: trace_modes(scene, ModeRequest(1, (1e-3, 1e-2))),
    "track": lambda scene: track(scene, TrackRequest("peaks", "contact.c.n_0", (2.0, 2.1)), harmonics=1),
    "optimum": lambda scene: optimise(scene, harmonics=1),
}


@pytest.mark.parametrize("way", WAYS)
def test_every_response_has_the_units_of_its_scene(way):
    aim = {"optimum": {"minimise": "peak.u", "vary": ["contact.c.n_0"], "bounds": [[2.0, 2.1]]}}
    scene = scene_from_dict(SCENE | UNITS | (aim if way == "optimum" else {}))
    assert WAYS[way](scene).units == ("mm", "N")


def test_swept_values_in_tables_have_their_unit_at_the_head(tmp_path):
    keys = ["contact.c.n_0", "contact.c.k_u", "contact.c.mu", "modal.frequency.0"]
    swept = SCENE | UNITS | {"frequency_unit": "Hz", "sweep": {key: [1.0, 1.1] for key in keys}}
    write_csv(trace_levels(scene_from_dict(swept), LevelRequest([1.2], (0.0, 0.1))), tmp_path / "levels.csv")
    with (tmp_path / "levels.csv").open(newline="") as file:
        heads = next(csv.reader(file))
    assert heads[2:7] == [
        "contact.c.n_0 [N]",
        "contact.c.k_u [N/mm]",
        "contact.c.mu",
        "modal.frequency.0 [Hz]",
        "excitation.frequency [Hz]",
    ]


def test_the_title_of_sensitivities_has_the_unit_of_what_was_swept(tmp_path):
    scene = scene_from_dict(SCENE | UNITS | {"sweep": {"contact.c.n_0": [1.0, 2.0]}})
    found = trace(scene, harmonics=1)
    add_sensitivities(found, scene)
    write_netcdf(found, tmp_path / "rates.nc")
    title = draw_sensitivity(read_sensitivity(tmp_path / "rates.nc"), curve=1).get_suptitle()
    assert "contact.c.n_0 = 2 N" in title


def test_sensitivities_are_of_the_degree_of_freedom_that_the_scene_asks_for(tmp_path):
    scene = scene_from_dict(SCENE | UNITS)
    asked = scene.modal.dofs[-1]
    found = trace(replace(scene, output=(asked,)), harmonics=1)
    add_sensitivities(found, scene)
    write_netcdf(found, tmp_path / "rates.nc")
    title = draw_sensitivity(read_sensitivity(tmp_path / "rates.nc")).get_suptitle()
    assert len(scene.modal.dofs) > 1 and title.split()[0].rstrip(",:") == asked


def test_a_higher_peak_that_was_not_followed_is_said_above_the_picture(tmp_path):
    aim = {"optimum": {"minimise": "peak.u", "vary": ["contact.c.n_0"], "bounds": [[2.0, 2.1]]}}
    found = optimise(scene_from_dict(SCENE | aim), harmonics=1)
    found.tracking.optima = [replace(one, higher=("peak.u", 123.0)) for one in found.tracking.optima]
    write_netcdf(found, tmp_path / "optimum.nc")
    said = written(draw_tracked(read_tracked(tmp_path / "optimum.nc")))
    assert any("one of 123 that was not followed" in text for text in said)
