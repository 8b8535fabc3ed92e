"""Damaged files of results are read by a process of its own, which may die of them."""

import os
import random
import signal
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fcm import load_scene
from fcm.plot.errors import PlotError
from fcm.plot.options import ReadOptions
from fcm.plot.read import read_response
from fcm.plot.reader_process import apart
from fcm.response import trace
from fcm.results.output import write_netcdf

DAMAGED = 6


@apart
def dies(path):
    os.kill(os.getpid(), signal.SIGSEGV)


@apart
def circles(path):
    while True:
        pass


@apart
def answers(path, more=1):
    return os.getpid(), Path(path), np.arange(more)


@apart
def fails(path):
    raise {}[path]


@pytest.fixture(autouse=True)
def importable(monkeypatch):
    """This file can be imported there."""
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    for one in (dies, circles, answers, fails):
        monkeypatch.setattr(one.__wrapped__, "__module__", Path(__file__).stem)


def test_what_a_process_that_died_had_to_read_is_damaged():
    with pytest.raises(PlotError, match=r"^a\.nc: damaged: what it says of itself does not fit together$"):
        dies("a.nc")


@pytest.mark.slow
def test_a_file_that_is_read_without_end_is_damaged():
    """As the library does that follows a damaged file from place to place for ever."""
    with pytest.raises(PlotError, match=r"^a\.nc: damaged: "):
        apart(circles.__wrapped__, ReadOptions(seconds=1.0))("a.nc")


def test_what_is_read_comes_from_another_process():
    process, path, numbers = answers("a.nc", more=3)
    assert process != os.getpid() and path == Path("a.nc") and numbers.tolist() == [0, 1, 2]


def test_a_defect_there_is_one_here_with_its_traceback():
    with pytest.raises(KeyError) as raised:
        fails("a.nc")
    assert "raise {}[path]" in raised.value.__notes__[0]


@pytest.fixture(scope="module")
def response(tmp_path_factory):
    """The bytes of a file of one curve."""
    path = tmp_path_factory.mktemp("apart") / "whole.nc"
    scene = load_scene("yang1998-n5")
    write_netcdf(trace(replace(scene, max_step=0.5, harmonics=(1,), curves=())), path)
    return path.read_bytes()


@pytest.mark.slow
@pytest.mark.parametrize("number", range(DAMAGED))
def test_a_damaged_file_is_read_or_refused(tmp_path, response, number):
    """Bytes changed or set to zero, mostly where the file says how it is laid out; none ends this process."""
    rng, path = random.Random(number), tmp_path / "a.nc"
    whole = bytearray(response)
    for _ in range(2**number):
        whole[rng.randrange(len(whole) if number % 2 else 4096)] = rng.randrange(256)
    if number % 3 == 0:
        begin = rng.randrange(len(whole))
        whole[begin : begin + 512] = bytes(len(whole[begin : begin + 512]))
    path.write_bytes(whole)
    try:
        apart(read_response.__wrapped__, ReadOptions(seconds=2.0))(path)
    except PlotError as error:
        assert str(error).startswith(f"{path}: ") and "\n" not in str(error)
