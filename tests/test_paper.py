"""The page of the paper's figures: the numbers on it, from the commands that the Makefile runs."""

import re
import shlex
from dataclasses import replace
from html import escape
from pathlib import Path

import numpy as np
import pytest
import xarray

import fcm
from fcm.shooting import periodic

from .program import AS_A_MODULE, called, ended, python
from .report import contact_figures, response_figures
from .report import paper as page_of_paper
from .report.page import Page, Section, Table, render
from .report.paper import FIGURES, commands, paper
from .report.rows import near

ROOT = Path(__file__).parents[1]
# what every run of the program imports, or has no part in a result
FRAME = re.compile(r"src/fcm/(files|threads|cli/(?!loop|coefficients|drawing|history)\w+)\.py")
PLOT = {f"src/fcm/plot/{name}.py" for name in ("errors", "response", "place", "error_panel", "points")}
SLOW = "figure10.png", "figure11.png", "figure13.png"  # pictures drawn by other tests too


def planned(*args):
    """The lines that make would run, all of them."""
    done = ended("make", "--no-print-directory", "-nB", "VENV=none", *args, cwd=ROOT)
    assert done.code == 0, done.err
    return done.out.splitlines()


def arguments(line):
    """What a line of make gives to fcm, for a folder of its own, and the file for its output if any."""
    command, _, output = line.removeprefix("none/bin/fcm ").replace("build/paper/", "").partition(" > ")
    return shlex.split(command.replace("0.7:1.7:41", "1.4:1.6:3 --jobs 1")), output  # fewer points, for time


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """What ``make figures`` makes, by the commands of the Makefile run here."""
    folder = tmp_path_factory.mktemp("paper")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for line in planned("figures"):
            if line.startswith("none/bin/fcm "):
                _run(*arguments(line))
            elif line.startswith("echo "):
                _, text, _, name = shlex.split(line)
                Path(name.replace("build/paper/", "")).write_text(text)
    return folder


def _run(args, output):
    made = Path(args[args.index("-o") + 1])
    if made.name in SLOW:
        made.write_bytes(b"\x89PNG" + bytes(20))
        return
    done = called(*args)
    assert done.code == 0, done.err
    if output:
        Path(output).write_text(done.out)


@pytest.mark.slow
@pytest.mark.parametrize("figure", FIGURES, ids=lambda figure: str(figure.number))
def test_every_number_agrees_with_the_paper(folder, figure):
    rows = figure.rows(folder)
    assert any(row.agrees for row in rows) and [row for row in rows if row.agrees is False] == []


def test_figure_5_has_the_printed_angles(folder):
    (loop,) = contact_figures.read_loops(folder / "figure5.json")
    assert contact_figures.slip_ends(loop) == pytest.approx((22.9, 159.7), abs=0.05)
    assert contact_figures.motion_of_ends(22.9, 159.7) == pytest.approx((0.4, 80.5), abs=0.05)


def test_figure_14_has_two_states_where_the_paper_has_them(folder):
    with xarray.open_dataset(folder / "figure14-points.nc") as file:
        points = file.isel(curve=0, dof=0).load()
    several = response_figures.several_states(points)
    assert (several[0], several[-1]) == pytest.approx((1.195, 1.235)) and len(several) == 9


def test_the_motion_of_two_angles_gives_these_angles():
    """The other way round by the loop itself."""
    b_bar, phi = contact_figures.motion_of_ends(30.0, 140.0)
    loop = fcm.hysteresis_loop(0.5 * (1.0 + b_bar), b_bar, np.radians(phi))
    assert loop.sequence == "EPEN"
    assert np.degrees(loop.angles[[2, 0]]) - 90.0 == pytest.approx([30.0, 140.0], abs=1e-9)


def test_constant_load_is_the_work_of_a_parallelogram():
    """F_c from the area of the loop, 4 n (1 - n); F_s from its own points."""
    n0_bar = np.linspace(0.05, 0.95, 10)
    F_s, F_c = contact_figures.constant_load(n0_bar)
    np.testing.assert_allclose(F_c, 4.0 * n0_bar * (1.0 - n0_bar) / np.pi, rtol=1e-12)
    theta = np.linspace(0.0, 2.0 * np.pi, 20_000, endpoint=False)
    for n, F in zip(n0_bar, F_s, strict=True):
        force = fcm.hysteresis_loop(n, 0.0, 0.0).force(theta)
        assert 2.0 * np.mean(force * np.sin(theta)) == pytest.approx(F, abs=1e-6)


def exact_amplitude(n_0, omega):
    scene = fcm.load_scene("yang1998-n5")
    contact = replace(scene.contacts[0], n_0=n_0)
    return periodic(replace(scene, contacts=(contact,)), omega).measure.amplitude[0]


def test_beyond_the_limits_of_figure_13_the_exact_motion_does_not_depend_on_the_preload():
    above, below = response_figures.stuck_above(), response_figures.open_below()
    for beyond, within, far, omega in (
        (above + 0.1, above - 2.0, 120.0, 1.4134),
        (below - 0.1, below + 1.0, -120.0, 0.9999),
    ):
        linear = exact_amplitude(far, omega)
        assert exact_amplitude(beyond, omega) == pytest.approx(linear, rel=1e-9)
        assert exact_amplitude(within, omega) < (1.0 - 1e-4) * linear


def test_the_page_shows_each_figure_with_its_commands_and_numbers(folder, capsys):
    paper.main([str(folder)], standalone_mode=False)
    said = capsys.readouterr().err
    text = (folder / "index.html").read_text(encoding="utf-8")
    count = text.count('class="yes"')
    assert f"{count} of {count} numbers agree" in said and count > 25
    for figure in FIGURES:
        assert f'<img src="figure{figure.number}.png"' in text and escape(figure.caption) in text
        shown = commands(folder, figure.number)
        assert shown and shown[-1].startswith("fcm plot ") and str(folder) not in "".join(shown)
        assert all(escape(command) in re.sub("</?span>", "", text) for command in shown)
    assert not re.search(r'(?:src|href)="(?!figure|#)', text)  # nothing from elsewhere


def test_a_number_that_differs_is_shown_and_said(folder, capsys, monkeypatch):
    row = near("angle", 22.9, 23.1, within=0.05, form=".1f", unit="°")
    monkeypatch.setattr(page_of_paper, "FIGURES", (replace(FIGURES[0], rows=lambda _folder: [row]),))
    paper.main([str(folder)], standalone_mode=False)
    said = capsys.readouterr().err
    assert "fcm: warning: angle: 23.1°, in the paper 22.9°" in said and "0 of 1 numbers agree" in said
    assert '<td class="no">differs</td>' in (folder / "index.html").read_text(encoding="utf-8")


def test_names_are_not_read_as_html():
    table = Table(("a < b",), [("<i>",)], [False])
    text = render(Page("<x>", (), [Section("<s>", caption="&", picture='".png', tables=(table,))]))
    assert "<x>" not in text and "<s>" not in text and "<i>" not in text and '""' not in text


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["figure5.png", "figure12.png", "figure14.nc", "figure14.png", "figure15.png"]
)
def test_a_figure_is_made_again_when_what_it_uses_changes(folder, name):
    """What a command imports is among the prerequisites of its target, but for the frame of the program."""
    database = ended("make", "-npq", "VENV=none", "figures", cwd=ROOT).out
    (prerequisites,) = re.findall(rf"^build/paper/{name}: (.*)$", database, re.M)
    (line,) = (one for one in planned("figures") if re.match(rf"none/bin/fcm .*-o build/paper/{name}\b", one))
    done = python("-X", "importtime", *AS_A_MODULE, *arguments(line)[0], cwd=folder)
    assert done.code == 0
    imported = re.findall(r"^import time:.*\| +(fcm[\w.]*)$", done.err, re.M)
    needed = {f"src/{module.replace('.', '/')}.py" for module in imported} - PLOT
    needed -= {path for path in needed if name.endswith(".nc") and path.startswith("src/fcm/plot/")}
    modules = {path for path in needed if (ROOT / path).is_file() and not FRAME.match(path)}
    assert modules and modules - set(prerequisites.split()) == set()
