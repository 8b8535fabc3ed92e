"""Units of swept values in the names of curves."""

import pytest

from fcm.plot import draw_response, read_response
from fcm.plot.peak import draw_peak, read_peaks
from fcm.response import trace
from fcm.response.level import trace_levels
from fcm.results.output import write_netcdf
from fcm.scene import scene_from_dict

SCENE = {
    "modal": {"dofs": ["v", "u"], "frequency": [1.0], "damping": [0.02], "shapes": [[1.0, 0.2]]},
    "contact": [{"name": "c", "tangential": "u", "normal": "v", "mu": 0.4, "k_u": 1, "k_v": 1, "n_0": 2}],
    "force": [{"dof": "u", "amplitude": 1.0}],
    "response": {"frequency": [0.7, 1.6]},
}  # fmt: skip


def written(figure):
    """What is written beside curves and points."""
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    texts += [axes.get_title(loc="right") for axes in figure.axes]
    return texts + [text.get_text() for legend in figure.legends for text in legend.get_texts()]


@pytest.mark.parametrize("unit", ["Hz", "rad/s"])
def test_where_the_level_was_varied_is_said_in_its_unit(tmp_path, unit):
    found = trace_levels(scene_from_dict(SCENE | {"frequency_unit": unit}), [1.2], (0.0, 2.0))
    write_netcdf(found, tmp_path / "level.nc")
    names = written(draw_response(read_response(tmp_path / "level.nc")))
    assert any(f"= 1.2 {unit}" in name for name in names)


def test_swept_values_have_the_unit_that_the_scene_says(tmp_path):
    swept = SCENE | {"sweep": {"contact.c.n_0": [1.0, 2.0, 3.0]}}
    found = trace(scene_from_dict(swept))
    found.units = ("mm", "N")
    write_netcdf(found, tmp_path / "swept.nc")
    for figure in (
        draw_response(read_response(tmp_path / "swept.nc")),
        draw_peak(read_peaks(tmp_path / "swept.nc")),
    ):
        assert any(name.partition("$n_{0}$ = ")[2][1:].startswith(" N") for name in written(figure))
