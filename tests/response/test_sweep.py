"""Sweeps: the same curves whatever the groups and cores, after a failure and after an interruption."""

import os
import signal
import subprocess
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import netCDF4
import numpy as np
import pytest

import fcm
from fcm.response.options import ResponseOptions, SweepOptions
from fcm.response.sweep import trace
from fcm.results.result import NOT_BEGUN
from fcm.run import Execution, place_of

from ..computed import Interrupted, by
from ..interrupted import interrupted_beyond
from ..oscillator import oscillator
from ..program import called, python

PRELOADS = np.linspace(-20.0, 60.0, 6)
PAIRS = ResponseOptions(sweep=SweepOptions(batch=2))


def curve_with(scene, n_0):
    (contact,) = scene.contacts
    return replace(scene, contacts=(replace(contact, n_0=n_0),), parameters={"n_0": n_0})


@pytest.fixture(scope="module")
def scene():
    one = replace(fcm.load_scene("yang1998-n5"), max_step=0.2)
    return replace(one, curves=tuple(curve_with(one, n_0) for n_0 in PRELOADS))


@pytest.fixture(scope="module")
def whole(scene):
    return trace(scene, "closed-form")


def same(response, other):
    for one, two in zip(response.curves, other.curves, strict=True):
        assert one.parameters == two.parameters
        assert one.complete == two.complete
        for name in ("frequency", "amplitude", "mean", "table_error"):
            np.testing.assert_array_equal(getattr(one, name), getattr(two, name))
        assert one.peaks == two.peaks and one.folds == two.folds


def test_groups_give_the_curves_of_the_whole(scene, whole):
    response = trace(scene, "closed-form", options=PAIRS)
    for one, two in zip(response.curves, whole.curves, strict=True):
        assert one.parameters == two.parameters
        assert one.peaks["u"][:2] == pytest.approx(two.peaks["u"][:2], rel=1e-9)
        assert one.folds == pytest.approx(two.folds, rel=1e-9)


class CountingExecutor(ThreadPoolExecutor):
    """One thread that counts what it is asked for."""

    count = 0

    def submit(self, *task, **further):
        self.count += 1
        return super().submit(*task, **further)


@pytest.mark.parametrize(("batch_seconds", "batches"), [(60.0, 1), (1e-3, len(PRELOADS))])
def test_curves_that_take_long_are_batches_of_their_own(scene, batch_seconds, batches):
    """So a few of them are shared by the cores."""
    options = ResponseOptions(sweep=SweepOptions(batch_seconds=batch_seconds))
    with CountingExecutor(1) as executor:
        response = trace(scene, "closed-form", Execution(place=place_of(executor)), options=options)
    assert executor.count == batches and len(response.curves) == len(PRELOADS)


@pytest.mark.slow
def test_two_cores_give_what_one_gives(scene):
    shown = []
    show = lambda share, _: shown.append(share)  # noqa: E731
    response = trace(scene, "closed-form", execution=Execution(jobs=2, progress=show), options=PAIRS)
    same(response, trace(scene, "closed-form", options=PAIRS))
    assert shown[-1] == 1.0 and shown == sorted(shown)


def test_a_curve_that_fails_loses_no_other(scene, whole):
    def fails(compute, batch, report):
        if any(one.parameters["n_0"] == PRELOADS[3] for one in batch):
            raise MemoryError("too much")
        return compute(batch, report)

    response = trace(scene, "closed-form", execution=Execution(place=by(fails)))
    lost = response.curves[3]
    assert not lost.complete and lost.reason == "MemoryError: too much" and lost.points == 0
    others = [c for i, c in enumerate(response.curves) if i != 3]
    assert [c.complete for c in others] == [True] * 5
    assert others[-1].peaks["u"][:2] == pytest.approx(whole.curves[-1].peaks["u"][:2], rel=1e-9)


def test_an_interrupted_sweep_is_continued(scene, tmp_path):
    reference = trace(scene, "closed-form", options=PAIRS)
    keep, last = tmp_path / "a.nc.unfinished", Interrupted()
    part = trace(scene, "closed-form", execution=Execution(place=Interrupted(4), keep=keep), options=PAIRS)
    assert part.interrupted and keep.is_file()
    assert [c.reason for c in part.curves] == [""] * 4 + [NOT_BEGUN] * 2
    resumed = trace(
        scene, "closed-form", execution=Execution(place=last, keep=keep, resume=True), options=PAIRS
    )
    assert last.begun == 2  # only the last group
    same(resumed, reference)
    assert not keep.exists()


@pytest.mark.parametrize("slow", [False, True])
def test_what_is_finished_of_a_group_is_not_traced_again(scene, tmp_path, slow):
    """Be it saved when the interruption comes, or before, as the curves take long."""
    often = SweepOptions(batch=2, save_interval=0.0 if slow else np.inf)
    options, last = ResponseOptions(sweep=often), Interrupted()
    reference = trace(scene, "closed-form", options=options)
    keep = tmp_path / "a.nc.unfinished"
    part = trace(scene, "closed-form", execution=Execution(place=Interrupted(5), keep=keep), options=options)
    assert part.interrupted and [c.reason for c in part.curves] == [""] * 5 + [NOT_BEGUN]
    resumed = trace(
        scene, "closed-form", execution=Execution(place=last, keep=keep, resume=True), options=options
    )
    assert last.begun == 1
    same(resumed, reference)


def test_another_scene_does_not_take_what_was_kept(scene, tmp_path):
    keep, every = tmp_path / "a.nc.unfinished", Interrupted()
    trace(scene, "closed-form", execution=Execution(place=Interrupted(4), keep=keep), options=PAIRS)
    other = replace(scene, curves=tuple(replace(c, frequency_range=(0.8, 1.2)) for c in scene.curves))
    with pytest.warns(UserWarning, match="of another scene.*moved to a.nc.unfinished.1"):
        trace(other, "closed-form", execution=Execution(place=every, keep=keep, resume=True), options=PAIRS)
    assert every.begun == 6


def test_interrupted_before_anything_is_finished(scene, tmp_path):
    keep = tmp_path / "a.nc.unfinished"
    with pytest.raises(KeyboardInterrupt):
        trace(scene, "closed-form", execution=Execution(place=Interrupted(0), keep=keep), options=PAIRS)
    assert not keep.exists()


SCENE = oscillator("""
[response]
frequency = [0.7, 1.7]
max_step = 0.2
[sweep]
"contact.shroud.mu" = { normal = [0.4, 0.05], count = 90, seed = 1 }
"contact.shroud.n_0" = { normal = [10, 3], count = 90, seed = 1 }
""")
GROUPS = """
from fcm.response.options import ResponseOptions, SweepOptions
def messages():
    from fcm.cli.messages import Messages
    from fcm.cli.settings import Settings
    return Messages(settings=Settings(response=ResponseOptions(sweep=SweepOptions(batch=5))))
"""


@pytest.mark.slow
def test_ctrl_c_and_resume_give_the_same_file(program, tmp_path):
    program.write("scene.toml", SCENE)
    command = ["respond", "scene.toml", "--jobs", "2", "-o"]
    assert program(*command, "whole.nc", before=GROUPS).returncode == 0
    run = program.start(*command, "a.nc", before=GROUPS, stdout=subprocess.DEVNULL)
    program.until(program.kept)
    os.kill(run.pid, signal.SIGINT)
    _, said = run.communicate(timeout=50)
    assert run.returncode == 3 and "Traceback" not in said
    assert "a.nc.unfinished: continue with --resume" in said
    assert "curves stopped early" in said or "curves were not begun" in said
    with netCDF4.Dataset(tmp_path / "a.nc") as part:
        assert 0 < part["complete"][:].sum() < part.dimensions["curve"].size
    assert program(*command, "a.nc", "--resume", before=GROUPS).returncode == 0
    assert not (tmp_path / "a.nc.unfinished").exists()
    with netCDF4.Dataset(tmp_path / "a.nc") as one, netCDF4.Dataset(tmp_path / "whole.nc") as two:
        assert set(one.variables) == set(two.variables)
        for name in one.variables:
            np.testing.assert_array_equal(one[name][...], two[name][...])


DEADLY = """
import os
from fcm.contact.closed_form import ClosedForm

class Deadly:
    outside = 0

    def law(self):
        import inspect
        system = inspect.currentframe().f_back.f_locals["self"]
        if system.scene.contacts[0].n_0 > 1e9:
            os._exit(9)
        return ClosedForm()
"""
SCRIPT = """
from dataclasses import replace
import fcm
from deadly import Deadly
from fcm.response.options import ResponseOptions, SweepOptions
from fcm.response.sweep import trace
from fcm.run import Execution, place_of

scene = replace(fcm.load_scene("yang1998-n5"), max_step=0.3)
curves = [replace(scene, contacts=(replace(scene.contacts[0], n_0=n),)) for n in (50.0, 1e12, 60.0)]
one = ResponseOptions(sweep=SweepOptions(batch=1))
several = replace(scene, curves=tuple(curves))
response = trace(several, Deadly(), Execution(jobs=2), options=one)
print([(curve.complete, curve.reason[:31]) for curve in response.curves])
"""


@pytest.mark.slow
def test_a_process_that_dies_loses_no_other_curve(tmp_path):
    """Nor does a script need a guard against being imported by the processes: they do not."""
    (tmp_path / "deadly.py").write_text(DEADLY)
    (tmp_path / "script.py").write_text(SCRIPT)
    done = python("script.py", cwd=tmp_path)
    assert done.out == "[(True, ''), (False, 'its process ended unexpectedly,'), (True, '')]\n", done.err


def test_resume_needs_a_file():
    done = called("respond", "yang1998", "--resume")
    assert done.code == 2 and "--resume needs the -o FILE" in done.err


def test_an_interrupted_sweep_is_not_continued_with_other_harmonics(scene, tmp_path):
    few = replace(scene, curves=tuple(replace(one, frequency_range=(1.3, 1.5)) for one in scene.curves))

    keep = tmp_path / "kept"
    stop = interrupted_beyond(0.4)
    part = trace(
        few, "closed-form", harmonics=1, execution=Execution(keep=keep, progress=stop), options=PAIRS
    )
    assert part.interrupted
    with pytest.warns(UserWarning, match="other options"):
        done = trace(
            few, "closed-form", harmonics=2, execution=Execution(keep=keep, resume=True), options=PAIRS
        )
    assert [curve.harmonics for curve in done.curves] == [(1, 2)] * len(few.curves)
