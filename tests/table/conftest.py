"""A table small enough to be built in every test run, and the shipped ones."""

import pytest

from fcm.table import build_table, open_table

TINY = (9, 5, 11, 9)


@pytest.fixture(scope="session")
def tiny_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("table") / "tiny.nc"
    build_table(path, TINY, points=10_000)
    return path


@pytest.fixture(scope="session")
def default():
    return open_table()


@pytest.fixture(scope="session")
def fast():
    from fcm.table.shipped import DEFAULT

    return open_table(DEFAULT.with_name("fast.nc"))
