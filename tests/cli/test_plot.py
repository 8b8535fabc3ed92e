"""``fcm plot response``: from a response file to a picture, or to one message."""

import netCDF4
import pytest

from fcm.cli.drawing import save_picture
from fcm.plot import draw_response, read_response


@pytest.fixture
def result(fcm, scene, tmp_path):
    path = tmp_path / "result.nc"
    assert fcm("respond", scene, "-o", path).code == 0
    return path


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "begin"), [("a.png", b"\x89PNG"), ("a.svg", b"<?xml"), ("a.pdf", b"%PDF"), ("A.PNG", b"\x89PNG")]
)
def test_the_ending_is_the_format(fcm, result, tmp_path, name, begin):
    done = fcm("plot", "response", result, "-o", name)
    assert (done.code, done.out, done.err) == (0, "", f"wrote {name}\n")
    assert (tmp_path / name).read_bytes().startswith(begin)


@pytest.mark.slow
def test_without_a_name_the_picture_is_beside_the_file(fcm, result, tmp_path):
    assert fcm("plot", "response", result).code == 0
    assert (tmp_path / "result.png").exists()


@pytest.mark.slow
def test_options_reach_the_picture(fcm, result, tmp_path):
    options = ("--dof", "v", "--log", "--no-errors")
    assert fcm("plot", "response", result, *options, "-o", "a.svg").code == 0
    assert fcm("plot", "response", result, *options[:-1], "-o", "b.svg").code == 0
    save_picture(
        draw_response(read_response(result), dof="v", log=True, errors=False, points=None), tmp_path / "c.svg"
    )
    made, other, drawn = ((tmp_path / name).read_bytes() for name in ("a.svg", "b.svg", "c.svg"))
    assert made == drawn != other


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (["-o", "a.jpg"], ".png or .svg or .pdf"),
        (["-o", "a"], ".png or .svg or .pdf"),
        (["-o", "no/a.png"], "there is no folder"),
        (["--dof", "w"], 'no degree of freedom "w"; the file has "u", "v"'),
    ],
)
def test_wrong_options_write_nothing(fcm, result, tmp_path, args, said):
    done = fcm("plot", "response", result, *args)
    assert done.code == 2 and said in done.err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["result.nc", "scene.toml"]


@pytest.mark.parametrize("content", [b"", b"text", b"\x89HDF\r\n\x1a\n" + bytes(100), b"CDF\x01" + bytes(20)])
def test_a_file_that_is_not_netcdf(fcm, tmp_path, content):
    (tmp_path / "a.nc").write_bytes(content)
    done = fcm("plot", "response", "a.nc")
    assert done.code == 2 and len(done.err.splitlines()) == 1
    assert not (tmp_path / "a.png").exists()


def test_a_netcdf_file_that_is_no_response(fcm, tmp_path):
    netCDF4.Dataset(tmp_path / "a.nc", "w").close()
    done = fcm("plot", "response", "a.nc")
    assert done.code == 2
    assert done.err == "fcm: error: a.nc: not a response file: it has no variable frequency, amplitude, dof\n"


def test_a_response_of_the_wrong_shape(fcm, tmp_path):
    with netCDF4.Dataset(tmp_path / "a.nc", "w") as data:
        data.createDimension("x", 3)
        for name in ("frequency", "amplitude", "dof"):
            data.createVariable(name, "f8", ("x",))[:] = 1.0
    done = fcm("plot", "response", "a.nc")
    assert (
        done.code == 2
        and "a.nc: not a response file: frequency is by (x), not by (curve, point)\n" in done.err
    )


def test_a_file_that_is_not_there(fcm):
    done = fcm("plot", "response", "nothing.nc")
    assert done.code == 2 and "nothing.nc" in done.err


def test_reading_gives_what_was_written(fcm, tmp_path):
    assert fcm("respond", "yang1998", "-o", "a.nc").code == 0
    response = read_response(tmp_path / "a.nc")
    assert response.dofs == ("u", "v") and response.frequency_unit == "rad/s"
    swept = [curve.parameters for curve in response.curves]
    assert swept == [{"contact.shroud.n_0": n} for n in (100, 50, 20, 10, 5, 2, 0, -5, -20, -60)]
    first, *_, last = response.curves
    assert first.regimes == {"E"} and last.regimes == {"S"}
    assert first.amplitude.shape == (len(first.frequency), 2) and first.frequency[0] == pytest.approx(0.7)
    with netCDF4.Dataset(tmp_path / "a.nc") as data:
        assert max(len(curve.frequency) for curve in response.curves) == data.dimensions["point"].size


@pytest.mark.parametrize("command", ["response", "peak"])
def test_a_picture_in_the_place_of_a_file_of_results_is_told(fcm, tmp_path, command):
    ending = {"response": ".png", "peak": "-peak.png"}[command]
    picture = tmp_path / f"fit{ending}"
    picture.write_bytes(b"\x89PNG")
    done = fcm("plot", command, picture)
    assert done.code != 0 and "a netCDF file" in done.err and "fcm respond SCENE -o" in done.err
    assert "overwrite" not in done.err and picture.read_bytes() == b"\x89PNG"
