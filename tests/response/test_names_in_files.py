"""Names of contacts that netCDF, CF or a list of coordinates cannot hold: other programs find them."""

import json
import re

import numpy as np
import pytest
import xarray

import fcm
from fcm.plot.read import read_response
from fcm.results.variable_meanings import variable_names

NAMES = (
    "left shroud", " x", "a,b", 'say "so"', "o'clock", "a/b", "/", "9 lives", "Öffnung", "é", "接触", "a:b",
    "a=b", "[0]", "coordinates", "curve", "a" * 100,
)  # fmt: skip
LISTED = re.compile(r"[A-Za-z][A-Za-z0-9_.+@-]*")  # of netCDF's guide, without blanks
VALUES = [5.0, 20.0]


def text_of(*names, more=""):
    """A scene with a contact of each name, of the first of which the preload is swept."""
    contacts = "".join(
        f'[[contact]]\nname = {json.dumps(name)}\ntangential = "u v"\nnormal = "v/1"\nmu = 0.4\n'
        "k_u = 1.0\nk_v = 1.0\nn_0 = 5.0\n"
        for name in names
    )
    swept = "".join(f"{json.dumps(f'contact.{name}.n_0')} = {VALUES}\n" for name in names)
    return (
        '[modal]\ndofs = ["u v", "v/1"]\nfrequency = [1.0, 10.0]\ndamping = 0.05\n'
        f'shapes = [[0.707, 0.707], [1.0, -0.5]]\n{contacts}[[force]]\ndof = "u v"\namplitude = 1.0\n'
        f"[response]\nfrequency = [0.9, 1.6]\nmax_step = 0.3\nharmonics = 1\n[sweep]\n{swept}{more}"
    )


def swept_coordinates(data, dim="curve"):
    """Values of the coordinates of curves, by the keys that they say they are."""
    return {
        one.attrs["key"]: (name, one.values.tolist())
        for name, one in data.coords.items()
        if one.dims == (dim,)
    }


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_swept_values_are_coordinates_whatever_the_contact_is_called(fcm, tmp_path, name):
    (tmp_path / "a.toml").write_text(text_of(name), encoding="utf-8")
    done = fcm("respond", "a.toml", "-o", "a.nc", "--csv", "a.csv", "--json")
    assert done.code == 0, done.err
    key = f"contact.{name}.n_0"
    assert [one["parameters"] for one in json.loads(done.out)["curves"]] == [{key: x} for x in VALUES]
    with xarray.open_dataset("a.nc") as data:
        (variable,) = (name for name, _ in swept_coordinates(data).values())
        assert swept_coordinates(data) == {key: (variable, VALUES)}
        assert LISTED.fullmatch(variable) and key in data[variable].attrs["long_name"]
        assert variable in data["amplitude"].coords and variable in data["peak_amplitude"].coords
        assert data["contact"].values.tolist() == [name] and data["dof"].values.tolist() == ["u v", "v/1"]
    assert [curve.parameters for curve in read_response(tmp_path / "a.nc").curves] == [
        {key: x} for x in VALUES
    ]


@pytest.mark.slow
def test_names_that_would_become_one_are_told_apart(fcm, tmp_path):
    names = ("a b", "a_b", "a/b")
    (tmp_path / "a.toml").write_text(text_of(*names))
    assert fcm("respond", "a.toml", "-o", "a.nc").code == 0
    with xarray.open_dataset("a.nc") as data:
        found = swept_coordinates(data)
        assert found.keys() == {f"contact.{name}.n_0" for name in names}
        assert found["contact.a_b.n_0"][0] == "contact.a_b.n_0"
        assert len({variable for variable, _ in found.values()}) == 3
        grid = np.array([values for _, values in found.values()]).T
        assert sorted(map(tuple, grid)) == sorted((x, y, z) for x in VALUES for y in VALUES for z in VALUES)


def test_the_dataset_in_memory_has_the_same_names(fcm_scene):
    data = fcm.respond(fcm_scene("left shroud"), "closed-form")
    assert swept_coordinates(data) == {"contact.left shroud.n_0": ("contact.left_shroud.n_0", VALUES)}


@pytest.fixture
def fcm_scene(tmp_path):
    def loaded(name):
        (tmp_path / "a.toml").write_text(text_of(name))
        return fcm.load_scene(tmp_path / "a.toml")

    return loaded


@pytest.mark.slow
def test_tracked_curves_and_histories_have_them_too(fcm, tmp_path):
    schedule = "[[schedule]]\nfrequency = 1.1\ncycles = 3\n"
    (tmp_path / "a.toml").write_text(text_of("left shroud", more=schedule))
    (tmp_path / "b.toml").write_text(text_of("left shroud").replace(str(VALUES), "[5.0]"))
    assert fcm("respond", "a.toml", "-o", "a.nc").code == 0
    over = ("--track", "peaks", "--over", "contact.left shroud.mu", "--from", 0.39, "--to", 0.4)
    assert fcm("respond", "b.toml", *over, "-o", "b.nc").code == 0
    with xarray.open_dataset("a.nc") as data:
        assert swept_coordinates(data)["contact.left shroud.n_0"][1] == VALUES
        assert "contact.left_shroud.n_0" in data["cycle_amplitude"].coords
    with xarray.open_dataset("b.nc") as data:
        ((variable, values),) = swept_coordinates(data, "track").values()
        assert set(values) == {5.0} and variable in data["tracked_frequency"].coords
        assert data["tracked_number"].attrs["key"] == "contact.left shroud.mu"
    for what, file in (("response", "a.nc"), ("peak", "a.nc"), ("history", "a.nc"), ("peak", "b.nc")):
        assert fcm("plot", what, file, "-o", "a.svg").code == 0


def test_names_that_can_be_held_stay_as_they_are():
    keys = ["contact.shroud.n_0", "modal.shapes.0.u", "excitation.frequency", "contact.a-1.gap"]
    assert variable_names(keys) == {key: key for key in keys}
