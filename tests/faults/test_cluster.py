"""Sweeps on the workers of a real dask scheduler, and on executors: what is lost with whom."""

import re
import signal
import socket
import subprocess
import time
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest
import xarray

import fcm
from fcm.response.options import ResponseOptions, SweepOptions
from fcm.run import Lost, PlaceClosed, cluster, compute_batches, place_of
from fcm.run.options import RunOptions

from .conftest import FEW, SWEEP, session, variables

SCHEDULER = """
import asyncio
from distributed import Scheduler
async def main():
    async with Scheduler(host="tcp://127.0.0.1", port=0, dashboard=False) as scheduler:
        print(scheduler.address, flush=True)
        await scheduler.finished()
asyncio.run(main())
"""
WORKER = """
import asyncio, sys
from distributed import Worker
{before}
async def main():
    async with Worker(sys.argv[1], nthreads=1, dashboard=False) as worker:
        print(worker.address, flush=True)
        await worker.finished()
asyncio.run(main())
"""
SLOW = """
import time, fcm.response, fcm.response.curve_batches as groups
real = groups.traced_curve
def slow(*args, **more):
    time.sleep(0.1)
    return real(*args, **more)
groups.traced_curve = slow
"""
OLDER = "import fcm\nfcm.__version__ = '0.0.9'\n"
MANY = SWEEP.replace("count = 12", "count = 20")


class Cluster:
    """A scheduler and workers, each a process that says its address."""

    def __init__(self, program):
        self.program = program
        self.scheduler = self.begin(SCHEDULER)
        self.address = self.said_by(self.scheduler)

    def begin(self, code, *args):
        return self.program.python("-c", code, *args, stderr=subprocess.DEVNULL)

    def worker(self, before=SLOW):
        return self.begin(WORKER.format(before=before), self.address)

    @staticmethod
    def said_by(run):
        return run.stdout.readline().strip()


@pytest.fixture
def dask(program):
    return Cluster(program)


@pytest.mark.slow
def test_a_worker_dies_another_is_refused_and_at_last_the_scheduler_is_lost(program, dask):
    """The whole story of a run that others take turns in, each time to the same bits as in one process."""
    other, doomed, last = dask.worker(OLDER), dask.worker(), dask.worker()
    older = dask.said_by(other)
    program.write("sweep.toml", MANY)
    assert program("respond", "sweep.toml", "-o", "whole.nc", "--jobs", "1", before=FEW).returncode == 0
    on_cluster = ("respond", "sweep.toml", "-o", "a.nc", "--cluster", dask.address)
    assert all(map(dask.said_by, (doomed, last)))

    run = program.start(*on_cluster, before=FEW)
    program.until(program.kept)
    doomed.kill()
    run.out, run.err = run.communicate(timeout=60)
    assert run.returncode == 0, run.err
    refused = f"fcm: warning: worker {older} is refused: it has fcm 0.0.9, and this is fcm {fcm.__version__}"
    assert run.err.splitlines()[0] == refused
    assert [line.split()[0] for line in run.err.splitlines()[1:]] == ["wrote", "20", "largest", "result:"]
    assert variables(program.folder / "a.nc") == variables(program.folder / "whole.nc")

    (program.folder / "a.nc").unlink()
    run = program.start(*on_cluster, before=FEW)
    program.until(program.kept)
    dask.scheduler.kill()
    run.out, run.err = run.communicate(timeout=60)
    assert run.returncode == 3 and not session(run.pid)
    said = [line for line in run.err.splitlines() if line.startswith("fcm: ")]
    assert said[1] == f"fcm: warning: the scheduler at {dask.address} was lost"
    assert "what is finished is kept in a.nc.unfinished: continue with --resume" in said[2]
    assert (
        re.fullmatch(r"fcm: error: \d+ of 20 curves (stopped early|were not begun); .*", said[3])
        and len(said) == 4
    )
    counted = FEW + (
        "import fcm.response.curve_batches as groups\nreal = groups.traced_curve\n"
        "def one(*args, **more):\n    print('traced')\n    return real(*args, **more)\n"
        "groups.traced_curve = one\n"
    )
    (program.folder / "a.nc").unlink()
    done = program(*on_cluster[:4], "--resume", "--jobs", "1", before=counted)
    assert done.returncode == 0 and 0 < done.out.count("traced") < 20
    assert variables(program.folder / "a.nc") == variables(program.folder / "whole.nc")


@pytest.mark.slow
def test_what_stands_in_the_way_of_a_cluster_is_said_in_one_line(program, monkeypatch):
    address = "tcp://127.0.0.1:9"  # where nobody listens
    at_once = FEW + "import fcm.run.cluster as cluster\ncluster.ANSWER = 0.3\n"
    nobody = program("respond", "one.toml", "-o", "a.nc", "--cluster", address, before=at_once)
    assert nobody.returncode == 2 and nobody.out == "" and nobody.err.count("\n") == 1
    assert f'no dask scheduler answers at "{address}"' in nobody.err
    without = FEW + "import sys\nsys.modules['distributed'] = None\n"
    missing = program("respond", "one.toml", "--cluster", address, before=without)
    assert missing.returncode == 2 and missing.err.count("\n") == 1
    assert missing.err.endswith("not installed: pip install distributed\n")
    for more, why in (
        ("--jobs 2", "--jobs is of no use"),
        ("--level 0:1 --at 1.2", "of no use with --level"),
    ):
        other = program("respond", "one.toml", "--cluster", address, *more.split())
        assert other.returncode == 2 and why in other.err
    assert program.files == ["one.toml", "sweep.toml"]


@pytest.mark.parametrize(
    ("address", "why"),
    [
        ("127.0.0.1", "an address is such as tcp://127.0.0.1:8786"),
        ("http://127.0.0.1:8786", "an address is such as tcp://127.0.0.1:8786"),
        ("tcp://127.0.0.1:0", "a port is from 1 to 65535, is 0"),
        ("tcp://127.0.0.1:99999", "a port is from 1 to 65535, is 99999"),
        ("tcp://127.0.0.300:8786", "each of its four numbers is 255 at most"),
        ("tcp://255.255.255.255:8786", "is the address of no single host"),
        ("tcp://[ff02::1]:8786", "is the address of no single host"),
        ("tcp://no-such-host.invalid:8786", "no-such-host.invalid"),
        ("tcp://127.0.0.1:9", "nothing listens there"),
    ],
)
def test_addresses_where_no_scheduler_can_be(address, why):
    """None is given to distributed, which tries for as long as it is let."""
    with pytest.raises(cluster.ClusterError, match=re.escape(why)), cluster.connected(address):
        pass


@pytest.fixture
def silent():
    """The address of what accepts a connection and says nothing."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield f"tcp://127.0.0.1:{server.getsockname()[1]}"


def test_a_port_that_is_silent_is_left_in_the_time_that_is_said(silent):
    soon = cluster.connected(silent, RunOptions(scheduler_answer=0.5))
    with pytest.raises(cluster.ClusterError, match=r"within 0\.5 s"), soon:
        pass


@pytest.mark.slow
@pytest.mark.parametrize("which", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_the_wait_for_a_port_that_is_silent(program, silent, which):
    """Long before the ten minutes for which it would be waited for here."""
    patient = (
        "from fcm.cli.messages import Messages\nfrom fcm.cli.settings import Settings\n"
        "from fcm.run.options import RunOptions\n"
        "messages = lambda: Messages(settings=Settings(run=RunOptions(scheduler_answer=600.0)))\n"
        "print('now', flush=True)\n"
    )
    run = program.start("respond", "one.toml", "-o", "a.nc", "--cluster", silent, before=patient)
    assert run.stdout.readline().strip() == "now"
    time.sleep(2.0)
    run.send_signal(which)
    run.out, run.err = run.communicate(timeout=60)
    assert run.returncode not in (0, 1) and "Traceback" not in run.err and not session(run.pid)


@pytest.mark.slow
def test_a_scheduler_without_a_worker_of_this_fcm(dask):
    soon = RunOptions(first_worker=0.1)
    with (
        pytest.raises(cluster.ClusterError, match="has no workers; one is started with"),
        cluster.connected(dask.address, soon),
    ):
        pass
    dask.said_by(dask.worker(OLDER))
    with (
        pytest.warns(UserWarning, match=r"is refused: it has fcm 0\.0\.9"),
        pytest.raises(cluster.ClusterError, match="has no worker with this fcm"),
        cluster.connected(dask.address, soon),
    ):
        pass


# any executor


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    path = tmp_path_factory.mktemp("swept") / "sweep.toml"
    path.write_text(SWEEP)
    return fcm.load_scene(path)


@pytest.fixture(scope="module")
def alone(swept):
    return fcm.respond(swept)


@pytest.mark.slow
@pytest.mark.parametrize("kind", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_any_executor_gives_the_same(swept, alone, kind):
    with kind(2) as executor:
        xarray.testing.assert_equal(fcm.respond(swept, executor=executor), alone)
        assert executor.submit(abs, -1).result() == 1  # it is still its owner's


class Breaks(Executor):
    """Computes so many batches, then nothing any more."""

    def __init__(self, count):
        self.count = count

    def submit(self, function, /, *args, **more):
        future = Future()
        self.count -= 1
        if self.count < 0:
            future.set_exception(BrokenExecutor("for a test"))
        else:
            future.set_result(function(*args, **more))
        return future


def test_an_executor_that_breaks_leaves_what_is_finished(swept, alone):
    fours = ResponseOptions(sweep=SweepOptions(batch=4, batch_seconds=np.inf))
    with pytest.warns(UserWarning, match="computes nothing any more .BrokenExecutor: for a test"):
        part = fcm.respond(swept, executor=Breaks(1), options=fours)
    assert part.complete.values.tolist() == [1] * 4 + [0] * 8
    np.testing.assert_array_equal(part.peak_amplitude[:4], alone.peak_amplitude[:4])
    with pytest.raises(PlaceClosed, match="nothing any more"):
        fcm.respond(swept, executor=Breaks(0), options=fours)


def test_what_does_not_get_to_an_executor_is_lost_alone():
    def local(batch, report):  # cannot be pickled
        return batch

    with ProcessPoolExecutor(1) as executor:
        (lost,) = compute_batches(local, [[1]], place_of(executor)).results[0]
    assert isinstance(lost, Lost) and lost.reason.startswith("the executor did not compute it: ")


def test_an_executor_with_another_fcm_is_refused():
    with ThreadPoolExecutor(1) as executor:
        place = place_of(executor)(abs, 1)
        place.asked_by = "0.0.9", place.asked_by[1]
        with pytest.raises(PlaceClosed, match=r"refused: it has fcm .*, and this is fcm 0\.0\.9"):
            compute_batches(abs, [[1]], lambda *_: place)


def test_one_thread_of_linear_algebra_on_whatever_worker():
    from threadpoolctl import threadpool_info

    def threads(*_):
        return [pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"]

    before = threads()
    with ThreadPoolExecutor(2) as executor:
        counts = compute_batches(lambda *_: [threads()], [[1], [2]], place_of(executor)).results
    assert before and counts == {0: [[1] * len(before)], 1: [[1] * len(before)]}
    assert threads() == before


def test_one_thread_of_linear_algebra_in_a_program_that_says_nothing_of_it(monkeypatch):
    """Threads that wait for one another make a scene with many contacts ten times slower."""
    from threadpoolctl import threadpool_info, threadpool_limits

    def threads(*_):
        return [[pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"]]

    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        monkeypatch.delenv(name, raising=False)
    with threadpool_limits(2, user_api="blas"):
        (before,) = threads()
        assert set(before) == {2}
        assert compute_batches(threads, [[1]]).results == {0: [[1] * len(before)]}
        monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")  # the user's own number
        assert compute_batches(threads, [[1]]).results == {0: [before]}
