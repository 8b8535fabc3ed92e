"""Files of results that are damaged, or no files at all: one sentence, and never a defect."""

import os
import random
from dataclasses import replace
from pathlib import Path

import netCDF4
import numpy as np
import pytest

from fcm import load_scene
from fcm.model.scene import Aim, Optimum
from fcm.plot.errors import PlotError
from fcm.plot.read import opened
from fcm.response import trace
from fcm.response.optimum import optimise
from fcm.results.output import write_netcdf

KINDS = ("response", "peak", "loop", "mode", "history", "sensitivity", "accuracy")


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("damaged") / "whole.nc"
    scene = load_scene("yang1998")
    curves = tuple(replace(one, max_step=0.5, harmonics=(1,)) for one in scene.curves[3:5])
    write_netcdf(trace(replace(scene, curves=curves)), path)
    return path.read_bytes()


def refused(done, said=""):
    """Refused in a sentence."""
    assert done.code in (2, 3), done
    (line,) = [line for line in done.err.splitlines() if not line.startswith(("Usage", "Try", "wrote"))][-1:]
    assert said in line and "defect" not in done.err and "Traceback" not in done.err


@pytest.mark.parametrize("value", [1e300, -1e300, np.inf])
@pytest.mark.parametrize(("kind", "name"), [("response", "amplitude"), ("peak", "peak_amplitude")])
def test_a_number_that_is_no_result_is_said(fcm, whole, kind, name, value):
    Path("a.nc").write_bytes(whole)
    with netCDF4.Dataset("a.nc", "a") as data:
        data[name][0, 0] = value
    refused(fcm("plot", kind, "a.nc"), f"{name} holds {abs(value):.3g}")


@pytest.mark.parametrize("text", ["5", '{"1x": 1}', "[", '"1x"'])
@pytest.mark.parametrize("kind", ["response", "peak"])
def test_an_attribute_that_is_no_list_of_names_is_refused(fcm, whole, kind, text):
    Path("a.nc").write_bytes(whole)
    with netCDF4.Dataset("a.nc", "a") as data:
        data.output = text
    refused(fcm("plot", kind, "a.nc"), "a.nc: not ")


@pytest.mark.parametrize("text", ["5", '{"curves": [5]}', '{"curves": 5}', '{"curves": [{"mode": []}]}', "["])
def test_a_summary_that_is_not_of_nonlinear_modes_is_refused(fcm, text):
    with netCDF4.Dataset("a.nc", "w") as data:
        data.createDimension("curve", 1)
        data.createDimension("point", 2)
        for name in ("frequency", "modal_amplitude", "damping_ratio"):
            data.createVariable(name, "f8", ("curve", "point"))[:] = 1.0
        data.summary = "{}"
    assert fcm("plot", "mode", "a.nc").code == 0
    with netCDF4.Dataset("a.nc", "a") as data:
        data.summary = text
    refused(fcm("plot", "mode", "a.nc"), "a.nc: not ")


TRIED = ("5", "[]", '{"optimum": 3}', '{"optimum": [1]}', '{"optimum": [{"tried": [[null, 2]]}]}', "{")


@pytest.mark.slow
def test_a_summary_without_numbers_that_an_optimum_tried_is_refused(fcm):
    vary = Optimum(("contact.shroud.n_0",), ((5.0, 15.0),), (Aim("u"),))
    write_netcdf(optimise(replace(load_scene("yang1998-n5"), optimum=vary), harmonics=1), "a.nc")
    assert fcm("plot", "peak", "a.nc").code == 0
    for text in TRIED:
        with netCDF4.Dataset("a.nc", "a") as data:
            data.summary = text
        refused(fcm("plot", "peak", "a.nc"), "a.nc: not ")


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_a_file_that_was_cut_off_is_refused(fcm, whole, kind):
    rng = random.Random(kind)
    for _ in range(8):
        Path("a.nc").write_bytes(whole[: rng.randrange(len(whole))])
        refused(fcm("plot", kind, "a.nc"), "a.nc: ")


@pytest.mark.slow
def test_a_pipe_is_said_to_be_one(fcm):
    os.mkfifo("pipe.nc")
    for kind in KINDS:
        refused(fcm("plot", kind, "pipe.nc"), "pipe.nc: is a pipe (fifo), not a file")
    refused(fcm("plot", "loop", "-o", "pipe.nc"), "has to end in")
    os.mkfifo("pipe.png")
    refused(fcm("plot", "loop", "-o", "pipe.png"), "it is a pipe (fifo), not a file")


def test_an_output_that_is_a_loop_of_links_is_refused(fcm):
    for name in ("a.png", "b.png", "c.nc", "d.csv"):
        Path(name).symlink_to({"a.png": "b.png", "b.png": "a.png"}.get(name, name))
    refused(fcm("plot", "loop", "-o", "a.png"), "it is a loop of symbolic links")
    refused(fcm("respond", "yang1998-n5", "-o", "c.nc"), "it is a loop of symbolic links")
    refused(fcm("respond", "yang1998-n5", "--csv", "d.csv"), "it is a loop of symbolic links")
    refused(fcm("tabulate", "-o", "c.nc"), "it is a loop of symbolic links")


def test_a_defect_in_drawing_is_not_taken_for_damage(fcm, whole, monkeypatch):
    """Numbers are checked when they are read; what drawing raises after that is its own."""

    def fails(*_args, **_named):
        raise ValueError("of ours")

    Path("a.nc").write_bytes(whole)
    monkeypatch.setattr("fcm.plot.draw_response", fails)
    done = fcm("plot", "response", "a.nc")
    assert done.code == 1 and "defect: ValueError: of ours" in done.err


@pytest.mark.slow
@pytest.mark.parametrize("value", [9e99, -9e99, 1e-300, 5e-324, 0.0, np.nan])
@pytest.mark.parametrize("kind", ["response", "peak"])
def test_numbers_far_apart_are_drawn(fcm, whole, kind, value):
    Path("a.nc").write_bytes(whole)
    names = {"response": ("frequency", "amplitude", "error"), "peak": ("peak_amplitude", "peak_frequency")}
    with netCDF4.Dataset("a.nc", "a") as data:
        for name in names[kind]:
            data[name][0, 0] = value
    done = fcm("plot", kind, "a.nc")
    assert done.code == 0 or (done.code == 2 and "a.nc" in done.err)


def test_a_variable_that_is_looked_for_and_not_there_is_named(tmp_path):
    """Whatever variable that is, of whatever kind of file."""
    with netCDF4.Dataset(tmp_path / "a.nc", "w") as data:
        data.title = "a title"
    said = r"a\.nc: not a file: it has no variable tracked_trough$"
    with pytest.raises(PlotError, match=said), opened(tmp_path / "a.nc", "a file", ()) as held:
        assert held.title == "a title" and getattr(held, "units", "") == ""
        held["tracked_trough"]
