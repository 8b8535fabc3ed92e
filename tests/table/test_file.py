"""The file: a CF grid that any program reads, written whole, refused when it is not sound."""

import os
import random
import sys
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray

import fcm
from fcm.table import TableError, build_table, file_checksum, open_table, shipped, store
from fcm.table.arrays import encode

from ..interrupted import interrupted_beyond
from ..program import ended


def refused(path, match):
    with pytest.raises(TableError, match=match) as caught:
        open_table(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.fixture
def copy(tiny_file, tmp_path):
    path = tmp_path / "copy.nc"
    path.write_bytes(tiny_file.read_bytes())
    return path


def test_open_table_is_found_at_the_top():
    assert fcm.open_table().resolution == open_table(str(shipped.DEFAULT)).resolution


@pytest.mark.parametrize(("name", "size"), [("default", 12e6), ("fast", 1e6)])
def test_shipped_files_are_small(name, size):
    assert shipped.DEFAULT.with_name(f"{name}.nc").stat().st_size <= size


@pytest.mark.slow
def test_the_splines_beside_the_shipped_table_are_those_of_its_file():
    """But for rounding: scipy makes splines by BLAS, whose sums hang on the processor."""
    ready, file = shipped.read(shipped.DEFAULT), open_table(shipped.DEFAULT)
    size = np.abs(file.coefficients).max()
    assert ready.coefficients == pytest.approx(
        file.coefficients, rel=0.0, abs=8.0 * np.finfo(float).eps * size
    )
    assert (ready.error, ready.part, ready.resolution) == (file.error, file.part, file.resolution)


def test_splines_that_are_damaged_or_of_another_table_are_not_used(tiny_file, copy):
    assert shipped.read(copy) is None
    table = open_table(copy)
    shipped.write(table, copy)
    assert shipped.read(copy)(0.3, 0.5, 1.0) == table(0.3, 0.5, 1.0)
    splines = copy.with_suffix(shipped.SPLINES)
    sound = splines.read_bytes()
    for position in (
        *range(0, 600, 7),
        shipped.HEADER - 1,
        shipped.HEADER + 3,
        len(sound) // 2,
        len(sound) - 1,
    ):
        damaged = bytearray(sound)
        damaged[position] ^= 0x10
        splines.write_bytes(damaged)
        assert shipped.read(copy) is None
    for cut in (0, 100, shipped.HEADER, len(sound) - 4):
        splines.write_bytes(sound[:cut])
        assert shipped.read(copy) is None
    splines.write_bytes(sound)
    build_table(copy, (5, 5, 5, 7), points=10_000)
    assert shipped.read(copy) is None


def test_xarray_opens_it_with_the_coefficients_at_every_node(tiny_file):
    with xarray.open_dataset(tiny_file) as data:
        assert set(data.coords) == {"n0_bar", "b_bar", "phi"}
        assert data.attrs["Conventions"].startswith("CF-1.")
        assert {"title", "source", "history", "resolution", "layout", "measured_error", "checksum"} <= set(
            data.attrs
        )
        assert all({"long_name", "units"} <= set(data[name].attrs) for name in data.variables)
        exact = fcm.fourier_coefficients(data.n0_bar.values, data.b_bar.values, data.phi.values)
        for name, values in zip(("F_b", "F_s", "F_c"), exact, strict=True):
            assert np.abs(data[name].values - values).max() < 1e-6


@pytest.mark.slow
def test_cf_checker_has_nothing_to_say(tiny_file):
    checker = Path(sys.executable).with_name("compliance-checker")
    assert checker.exists(), "compliance-checker is one of the development packages"
    done = ended(checker, "--test=cf:1.8", tiny_file)
    assert "All tests passed" in done.out, done.out + done.err


def test_missing_file(tmp_path):
    refused(tmp_path / "none.nc", "no such file")


def test_folder(tmp_path):
    refused(tmp_path, "is a folder")


def test_pipe_and_loop_of_links(tmp_path):
    os.mkfifo(tmp_path / "pipe.nc")
    refused(tmp_path / "pipe.nc", r"is a pipe \(fifo\), not a file")
    (tmp_path / "loop.nc").symlink_to("loop.nc")
    refused(tmp_path / "loop.nc", "is a loop of symbolic links")


@pytest.mark.parametrize("content", [b"", b"x", b"plain text\n" * 50, file_checksum.START + b"00000000\n"])
def test_not_netcdf(tmp_path, content):
    path = tmp_path / "other.nc"
    path.write_bytes(content)
    refused(path, "not a netCDF file|damaged")


def test_netcdf_of_another_program(tmp_path):
    path = tmp_path / "other.nc"
    xarray.Dataset({"F_b": ("x", [1.0, 2.0])}, attrs={"title": "weather"}).to_netcdf(path)
    refused(path, "not a table made by fcm tabulate")


def test_another_layout(copy):
    with netCDF4.Dataset(copy, "r+") as file:
        file.layout = np.int32(99)
    refused(copy, "damaged, it was changed or cut off after it was written")
    file_checksum.attach(copy)
    refused(copy, "layout 99")


def test_values_that_are_not_finite(copy):
    with netCDF4.Dataset(copy, "r+") as file:
        file["F_c"][1, 1, 1] = np.nan
    file_checksum.attach(copy)
    refused(copy, "F_c holds values that are not finite")


def test_not_finite_even_if_sealed(tmp_path, tiny_file):
    separation, slip, error, _ = store.load(tiny_file)
    slip[0, 2, 2, 2] = np.inf
    path = tmp_path / "t.nc"
    store.write(path, encode(separation, slip), error, "test")
    refused(path, "not finite")


def test_values_that_were_changed(copy):
    with netCDF4.Dataset(copy, "r+") as file:
        file["F_s"][1, 1, 1] = 0.123
    refused(copy, "damaged, it was changed or cut off after it was written")
    file_checksum.attach(copy)
    refused(copy, "checksum")


def test_the_library_never_sees_a_file_that_is_not_whole(tmp_path, tiny_file, monkeypatch):
    """On damaged bytes it may end this process, or never return."""
    monkeypatch.setattr(netCDF4, "Dataset", None)
    content = tiny_file.read_bytes()
    rng = random.Random(0)
    for number in range(60):
        damaged = bytearray(content if number % 2 else content[: -file_checksum.LENGTH])
        for _ in range(2 ** rng.randrange(8)):
            damaged[rng.randrange(min(len(damaged), 10 ** rng.randrange(2, 7)))] ^= 0x55
        if number % 3 == 0:
            damaged = damaged[: rng.randrange(len(damaged))]
        (tmp_path / "t.nc").write_bytes(damaged)
        refused(tmp_path / "t.nc", "damaged|not a netCDF file|not a table")


def test_every_cut_is_refused(tmp_path, tiny_file):
    content = tiny_file.read_bytes()
    for k, size in enumerate(
        [1, 7, 8, 100, *range(1000, len(content), 4999), len(content) - 27, len(content) - 1]
    ):
        path = tmp_path / f"cut{k}.nc"
        path.write_bytes(content[:size])
        refused(path, "damaged|not a netCDF")


def test_every_flipped_byte_is_refused(tmp_path, tiny_file):
    content = tiny_file.read_bytes()
    for position in range(0, len(content) - file_checksum.LENGTH, 301):
        flipped = bytearray(content)
        flipped[position] ^= 0x10
        path = tmp_path / f"flip{position}.nc"
        path.write_bytes(flipped)
        refused(path, "damaged")


def test_shipped_table_with_a_flipped_byte(tmp_path):
    content = bytearray(shipped.DEFAULT.read_bytes())
    content[len(content) // 2] ^= 1
    path = tmp_path / "flipped.nc"
    path.write_bytes(content)
    refused(path, "damaged, its bytes do not match their checksum")


def test_failed_write_leaves_the_old_file_and_nothing_else(copy, monkeypatch):
    before = copy.read_bytes()

    def fail(path, *_, **__):
        Path(path).write_bytes(b"half")
        raise RuntimeError("NetCDF: HDF error")

    monkeypatch.setattr(netCDF4, "Dataset", fail)
    with pytest.raises(OSError, match="could not be written"):
        build_table(copy, (5, 5, 5, 5), points=10_000)
    assert copy.read_bytes() == before
    assert list(copy.parent.iterdir()) == [copy]


def test_interrupted_build_leaves_nothing(tmp_path):
    with pytest.raises(KeyboardInterrupt):
        build_table(tmp_path / "table.nc", (5, 5, 5, 5), points=10_000, progress=interrupted_beyond(0.5))
    assert not list(tmp_path.iterdir())


def test_folder_that_does_not_exist(tmp_path):
    with pytest.raises(FileNotFoundError):
        build_table(tmp_path / "none" / "table.nc", (5, 5, 5, 5), points=10_000)


def test_written_through_a_link(copy, tmp_path):
    link = tmp_path / "link.nc"
    link.symlink_to(copy)
    build_table(link, (5, 5, 5, 5), points=10_000)
    assert link.is_symlink() and open_table(copy).resolution == (5, 5, 5, 5)


def test_how_numpy_prints_does_not_matter():
    """As other packages set it, for all the process."""
    expected = open_table(shipped.DEFAULT)(1.0, 0.5, 0.3)
    with np.printoptions(legacy="1.25"):
        found = open_table(shipped.DEFAULT)(1.0, 0.5, 0.3)
    assert found == expected
