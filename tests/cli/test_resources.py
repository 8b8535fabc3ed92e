"""What a run takes is counted before it is made, and refused where there is no room for it."""

from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from fcm import load_scene
from fcm.cli.limits import SENTENCES, RemarkOptions
from fcm.cli.messages import Messages
from fcm.cli.settings import Settings
from fcm.harmonic_balance.cost_model import seconds_of_curve
from fcm.response import trace
from fcm.results.size import SizeOptions, bytes_of_matrices, bytes_of_results, least_points
from fcm.scene import scene_from_dict
from fcm.scene.options import MessageOptions

SCENE = "yang1998-n5"
DRAWN = """
[modal]
dofs = ["u"]
frequency = [1.0]
damping = [0.01]
shapes = [[1.0]]
[[force]]
dof = "u"
amplitude = 1.0
[response]
frequency = [0.7, 1.7]
[sweep]
"force.u.amplitude" = { normal = [1.0, 0.01], count = 1000000 }
"""


@pytest.mark.parametrize("harmonics", [(1,), (1, 2, 3)])
def test_results_take_no_less_than_is_told(harmonics):
    scene = replace(load_scene(SCENE), max_step=0.2, harmonics=harmonics, curves=())
    (curve,) = trace(scene).curves
    arrays = [getattr(curve, one.name) for one in fields(curve)]
    taken = sum(one.nbytes for one in arrays if isinstance(one, np.ndarray))
    told = bytes_of_results(scene, harmonics, peaks_only=False, options=SizeOptions(of_curve=0))
    assert 0.01 * taken < told < taken
    assert least_points(scene, peaks_only=False) <= curve.points


def test_the_motions_of_many_contacts_in_many_harmonics_are_counted():
    scene, harmonics = replace(load_scene(SCENE), max_step=0.2, curves=()), tuple(range(1, 8))
    (curve,) = trace(scene, harmonics=harmonics).curves
    waves = curve.across.motion[0, :, :, 1:].nbytes  # of a point
    many = replace(scene, contacts=scene.contacts * 100)
    assert bytes_of_results(many, harmonics, peaks_only=False) > least_points(many, False) * 100 * waves


def test_more_of_anything_takes_more():
    scene = load_scene(SCENE)
    one = bytes_of_results(scene, (1,), False)
    assert bytes_of_results(replace(scene, max_step=1e-3, curves=()), (1,), False) > 20.0 * one
    assert bytes_of_results(replace(scene, curves=(scene,) * 10), (1,), False) == 10.0 * one
    assert bytes_of_results(scene, range(1, 51), False) > 4.0 * one
    assert bytes_of_results(scene, (1,), True) < one
    assert bytes_of_matrices(scene, range(1, 51)) == 3 * 8 * 202**2


def test_results_that_memory_does_not_hold_are_refused(fcm):
    little = {"memory": lambda: 5_000.0, "remarks": RemarkOptions(memory=1_000.0)}
    done = fcm("respond", SCENE, "--max-step", "0.001", "-o", "a.nc", **little)
    assert len(done.err.splitlines()) == 1  # what is refused is not told before
    assert (
        done.code == 2
        and "takes at least 2" in done.err
        and "5 kB are free: write the peaks alone" in done.err
    )
    done = fcm("respond", SCENE, "--harmonics", "20", "--peaks-only", **little)
    assert done.code == 2 and "give fewer harmonics" in done.err
    assert not list(Path().iterdir())


@pytest.mark.parametrize("option", ["-o", "--csv"])
def test_results_that_the_disk_does_not_hold_are_refused(fcm, option):
    name = "a.nc" if option == "-o" else "a.csv"
    done = fcm("respond", SCENE, option, name, disk=lambda _folder: 1_000.0)
    assert done.code == 2 and f"{name} takes at least" in done.err and "or write to another disk" in done.err
    assert not list(Path().iterdir())


def test_what_takes_much_is_told(fcm):
    few = ("--harmonics", "1", "--max-step", "0.5")
    done = fcm("respond", SCENE, *few, remarks=RemarkOptions(memory=1_000.0))
    assert done.code == 0 and "1 curve of 1 contact takes at least" in done.err


def many(contacts, modes):
    rng = np.random.default_rng(3)
    names = [f"{axis}{i}" for i in range(contacts) for axis in "uv"]
    contact = {"mu": 0.3, "k_u": 1.0, "k_v": 1.0, "n_0": 1.0}
    return scene_from_dict(
        {
            "modal": {
                "dofs": names,
                "frequency": np.linspace(1.0, 3.0, modes),
                "damping": [0.01] * modes,
                "shapes": rng.standard_normal((modes, 2 * contacts)),
            },
            "contact": [
                contact | {"name": f"c{i}", "tangential": f"u{i}", "normal": f"v{i}"} for i in range(contacts)
            ],
            "force": [{"dof": "u0", "amplitude": 1.0}],
            "response": {"frequency": [0.5, 1.5]},
        }
    )


def test_the_time_of_a_curve_grows_with_what_is_solved():
    """With the contacts where few modes answer to them, with their third power where as many do."""
    few = [seconds_of_curve(many(n, 10), 1) for n in (100, 200)]
    full = [seconds_of_curve(many(n, 2 * n), 1) for n in (100, 200)]
    assert 1.9 < few[1] / few[0] < 2.2 and full[1] > 4.0 * few[1]
    assert seconds_of_curve(many(100, 10), 3) > 2.0 * few[0]
    assert seconds_of_curve(replace(many(100, 10), max_step=1e-3), 1) > 4.0 * few[0]


def test_modes_far_above_the_range_take_no_time():
    near = many(200, 400)
    frequency = np.where(np.arange(400) < 10, near.modal.frequency, 100.0)
    far = replace(near, modal=replace(near.modal, frequency=frequency))
    assert seconds_of_curve(far, 1) < 0.5 * seconds_of_curve(near, 1)
    assert seconds_of_curve(far, 1) == seconds_of_curve(many(200, 10), 1)


def test_a_curve_that_takes_long_is_told_before_it_is_begun(fcm):
    every, one = RemarkOptions(long_curve=0.0), ("--harmonics", "1")
    assert "processor time" not in fcm("respond", SCENE, *one).err
    for options, said in (
        ((), "less with one harmonic (--harmonics 1), fewer contacts"),
        (one, "less with fewer contacts or fewer modes"),
    ):
        first = fcm("respond", SCENE, *options, remarks=every).err.splitlines()[0]
        assert (
            first.startswith("1 curve of 1 contact takes at least about 0 s of processor time")
            and said in first
        )
    level = fcm("respond", SCENE, "--level", "0.5:1", "--at", "1.1", remarks=every)
    assert "processor time" not in level.err


def test_a_million_draws_without_room_for_them_are_refused_when_read(fcm):
    Path("a.toml").write_text(DRAWN)
    done = fcm("respond", "a.toml", memory=lambda: 5e8)
    assert done.code == 2
    assert "asks for 1000000 curves, which take 1 GB of memory before they are traced" in done.err
    assert "500 MB are free: sweep or draw fewer values at a time" in done.err


def test_a_limit_on_addresses_is_one_on_memory(program):
    code = "from fcm import resources; print(resources.memory())"
    done = program.python("-c", f"import resource as r; r.setrlimit(r.RLIMIT_AS, (2 << 30,) * 2); {code}")
    out, _ = done.communicate()
    assert 0.0 < float(out) < 2 << 30


@pytest.mark.parametrize("options", [(), ("--peaks-only",)])
def test_a_million_draws_are_counted_before_their_curves_are_made(fcm, options):
    """Which alone takes half a minute."""
    Path("a.toml").write_text(DRAWN)
    done = fcm("respond", "a.toml", *options, "-o", "a.nc", disk=lambda _folder: 1e6)
    assert done.code == 2 and "1000000 curves of 0 contacts take at least" in done.err
    assert "1 MB are free on its disk" in done.err


def test_draws_that_take_long_are_told_before_they_are_drawn(fcm):
    slow = DRAWN.replace(
        "normal = [1.0, 0.01], count = 1000000", 'distribution = "lognorm", s = 0.1, count = 9'
    )
    Path("a.toml").write_text(slow)
    assert "take about" not in fcm("respond", "a.toml").err
    done = fcm("respond", "a.toml", reading=MessageOptions(seconds_of_draws=0.0))
    said = done.err.splitlines()[0]
    assert said == 'sweep."force.u.amplitude": 9 draws of this distribution take about 0 s'


def timed(*seconds, lines=float("inf")):
    """Messages by a clock that shows one after the other; the first line of progress after so long."""
    remarks = replace(SENTENCES, first_line=lines)
    return Messages(settings=Settings(clock=iter(seconds).__next__, remarks=remarks))


def test_the_time_of_curves_is_not_told_by_a_first_one_that_loads_what_all_need(capsys):
    messages = timed(0.0, 3.0, 5.5)
    messages.expect(40)
    for share in (1 / 40, 30 / 40):
        messages.progress(share)
    assert not capsys.readouterr().err


def test_how_long_all_curves_take_is_said_once_by_the_first(capsys):
    messages = timed(0.0, 1.0, 30.0, 40.0, 50.0)
    messages.expect(100)
    for share in (0.001, 0.02, 0.03, 0.04):
        messages.progress(share)
    said = "100 curves take about 25 minutes: 2 % of them took 30 s"
    assert capsys.readouterr().err.splitlines() == [said]


def test_progress_is_said_where_no_terminal_draws_it_ever_more_rarely(capsys):
    """A fit of a minute said nothing."""
    messages = timed(0.0, 19.0, 21.0, 41.0, 60.5, lines=20.0)
    for share in (0.0, 0.2, 0.3, 0.4, 0.5):
        messages.progress(share, "start 1 of at most 8")
    text = "start 1 of at most 8"
    assert capsys.readouterr().err.splitlines() == [f"30 % after 21 s: {text}", f"40 % after 41 s: {text}"]


def test_the_time_of_few_or_fast_curves_is_not_said(capsys):
    for curves, last in ((1, 1e4), (100, 0.1)):
        messages = timed(0.0, 0.0, last)
        messages.expect(curves)
        messages.progress(0.0)
        messages.progress(0.02)
    assert not capsys.readouterr().err


CHAIN = """
[structure]
dofs = ["a", "b", "c"]
mass = [1.0, 1.0, 1.0]
stiffness = [[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]]
damping = 0.01
[[contact]]
name = "one"
tangential = "b"
normal = "c"
mu = 0.3
k_u = 1.0
k_v = 1.0
n_0 = 1.0
[[force]]
dof = "a"
amplitude = 1.0
[response]
frequency = [0.1, 0.5]
"""


def test_flexibility_along_directions_that_memory_does_not_hold_is_refused(fcm):
    Path("a.toml").write_text(CHAIN)
    little = MessageOptions(memory=1_000.0)
    done = fcm("plot", "modes", "a.toml", reading=little)
    assert done.code == 0 and "takes" not in done.err  # there is no one to tell
    done = fcm("respond", "a.toml", reading=little)
    said = "structure: its flexibility along 3 directions of contacts and forces, at 3 rows, takes about 1 kB"
    assert done.code == 0 and done.err.splitlines()[0] == f"{said} of memory"
    done = fcm("respond", "a.toml", memory=lambda: 1_000.0)
    assert done.code == 2 and "takes 1 kB of memory, and 1 kB are free. Reduce it to the rows" in done.err
