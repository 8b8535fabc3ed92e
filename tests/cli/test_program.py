"""The program around its commands: help, what it imports, how it ends."""

import json
import os
import re
import warnings

import click
import pytest
from click.testing import CliRunner

from fcm.cli import COMMANDS, main
from fcm.cli.commands import INSTEAD
from fcm.cli.guard import guarded, outdated_kernels
from fcm.cli.messages import Messages
from fcm.continuation import dense_solver
from fcm.model.question import Question
from fcm.scene.keys import TABLES

from ..program import AS_A_MODULE, called, python, shell

HEAVY = {"numpy", "scipy", "xarray", "netCDF4", "matplotlib", "pandas"}


def imported_by(*args):
    """The packages that a run of the program has imported when it ends."""
    code = (
        "import sys, json\n"
        "from fcm.cli import main\n"
        "try: main(sys.argv[1:], prog_name='fcm')\n"
        "except SystemExit: pass\n"
        "print(json.dumps(sorted({name.partition('.')[0] for name in sys.modules})))"
    )
    return set(json.loads(python("-c", code, *args).out.splitlines()[-1]))


@pytest.mark.parametrize(
    "args", [["--help"], ["--version"], ["plot", "--help"], ["respond", "--help"], ["tabulate", "--help"]]
)
def test_help_imports_no_numerics(args):
    """Which take ten times as long as the help."""
    assert not imported_by(*args) & HEAVY


@pytest.mark.slow
def test_what_only_few_commands_need_is_imported_by_them():
    """Of scipy, the optimisers and sparse matrices alone take as long as ten curves."""
    code = "import sys, fcm.cli.respond, fcm.results.output, fcm.response.sweep; print(*sys.modules)"
    imported = python("-c", code).out.split()
    heavy = {"scipy.optimize", "scipy.linalg", "scipy.sparse", "scipy.stats", "xarray", "distributed"}
    assert "fcm.response.sweep" in imported and not set(imported) & heavy


@pytest.mark.slow
@pytest.mark.skipif(
    dense_solver.__file__.endswith(".py"), reason="interpreted, LAPACK is faster from few unknowns on"
)
def test_the_curves_of_the_paper_are_traced_without_lapack():
    """Its import takes longer than all of them."""
    run = "from fcm.cli import main; main(['respond', 'yang1998'], standalone_mode=False)"
    done = python("-c", f"import sys\n{run}\nprint(*sys.modules)")
    assert "fcm.accuracy.embedded_pair" in done.out.split() and "scipy.linalg" not in done.out.split()


@pytest.mark.slow
def test_drawing_and_xarray_are_not_imported_by_respond(scene):
    assert not imported_by("respond", str(scene), "-o", str(scene.with_suffix(".nc"))) & {
        "matplotlib",
        "pandas",
        "xarray",
    }


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_exists_and_has_help(fcm, name):
    done = fcm(name, "--help")
    assert done.code == 0 and f"Usage: fcm {name}" in done.out
    assert "--quiet" in done.out and "--verbose" in done.out


@pytest.mark.parametrize("name", INSTEAD)
def test_a_command_that_there_is_not_is_told_by_another_name(fcm, name):
    """Each of a command, and of options, keys or pictures, that there are."""
    done = fcm(name, "scene.toml")
    assert done.code == 2 and f'No such command "{name}": it is fcm' in done.err
    command, *options = re.findall(r"fcm (\w+(?: modes)?)|(--\w+)|\[+(\w+)\]+", INSTEAD[name])
    helped = fcm(*command[0].split(), "--help").out
    for _, option, table in options:
        assert option in helped if option else table in TABLES


def test_help_lists_the_commands(fcm):
    done = fcm("--help")
    assert done.code == 0 and all(line in done.out for line in ("tabulate", "respond", "plot"))


def test_version(fcm):
    assert fcm("-V").out == fcm("--version").out == "fcm 0.1.0\n"


@pytest.mark.parametrize(
    "args", [["nonsense"], ["respond"], ["respond", "a", "b"], ["respond", "a", "--no"], ["plot", "nothing"]]
)
def test_a_wrong_command_line_is_wrong_input(fcm, args):
    done = fcm(*args)
    assert done.code == 2 and "Error:" in done.err and done.out == ""


def end_of(error, messages=None):
    """The exit code and what is said when a command raises the error."""

    def run(ctx):
        raise error

    with (
        click.Context(click.Command("x"), obj=messages or Messages()) as ctx,
        pytest.raises(click.exceptions.Exit) as end,
    ):
        guarded(run, ctx)
    return end.value.exit_code


def test_a_defect_is_one_line(capsys, monkeypatch):
    monkeypatch.delenv("FCM_DEBUG", raising=False)
    assert end_of(ZeroDivisionError("of zero")) == 1
    assert capsys.readouterr().err == "fcm: defect: ZeroDivisionError: of zero (-v shows where)\n"


def test_a_defect_names_kernels_older_than_their_sources(tmp_path):
    for name, time in (("new.py", 1), ("new.abi3.so", 2), ("old.py", 3), ("old.abi3.so", 2)):
        (tmp_path / name).touch()
        os.utime(tmp_path / name, (time, time))
    assert "old.abi3.so is older than its source: make kernels" in outdated_kernels(tmp_path)
    os.utime(tmp_path / "old.abi3.so", (4, 4))
    assert outdated_kernels(tmp_path) == ""


def test_a_defect_names_a_kernel_that_is_not_compiled_where_others_are(tmp_path):
    (tmp_path / "alone.py").write_text("import numpy\nimport cython\n")
    assert outdated_kernels(tmp_path) == ""  # all as Python
    (tmp_path / "other.abi3.so").touch()
    assert "alone.py is not compiled, where others are: make kernels" in outdated_kernels(tmp_path)


def test_a_defect_shows_its_place_on_request(capsys, monkeypatch):
    monkeypatch.delenv("FCM_DEBUG", raising=False)
    assert end_of(ZeroDivisionError("of zero"), Messages(verbosity=1)) == 1
    assert "Traceback" in capsys.readouterr().err
    monkeypatch.setenv("FCM_DEBUG", "1")
    assert end_of(ZeroDivisionError("of zero")) == 1
    assert "Traceback" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (KeyboardInterrupt(), "interrupted"),
        (click.Abort(), "interrupted"),
        (MemoryError(), "not enough memory"),
        (OSError(28, "No space left on device", "a.nc"), "a.nc: No space left on device"),
    ],
)
def test_what_could_not_be_completed(capsys, error, said):
    assert end_of(error) == 3
    captured = capsys.readouterr().err
    assert said in captured and "Traceback" not in captured


def test_a_warning_is_one_line_on_standard_error(capsys):
    def run(ctx):
        warnings.simplefilter("always")
        warnings.warn("mind the gap", stacklevel=1)

    with click.Context(click.Command("x"), obj=Messages()) as ctx:
        guarded(run, ctx)
    assert capsys.readouterr().err == "fcm: warning: mind the gap\n"


@pytest.mark.parametrize(
    ("note", "said"),
    [
        (Question("mu: is 40 right?"), "fcm: warning: mu: is 40 right?\n"),
        ("read: is it.mtx?", "read: is it.mtx?\n"),
    ],
)
def test_a_note_on_a_scene_is_a_warning_where_it_asks(capsys, note, said):
    Messages().note(note)
    assert capsys.readouterr().err == said


def test_what_a_scene_hardly_means_is_a_warning(fcm, scene):
    scene.write_text(scene.read_text().replace("damping = 0.05", "damping = 1.5"))
    assert re.findall("warning: (.*): is", fcm("plot", "modes", scene).err) == ["modal.damping"]


def test_names_that_the_terminal_cannot_show_are_escaped(scene):
    scene.write_text(scene.read_text().replace('"u"', '"ü位"'), encoding="utf-8")
    latin = {"env": {**os.environ, "PYTHONIOENCODING": "latin-1"}, "encoding": "latin-1"}
    assert "peak ü\\u4f4d" in python(*AS_A_MODULE, "respond", scene, **latin).out


@pytest.mark.slow
def test_a_reader_that_leaves_is_no_error():
    done = shell("fcm respond yang1998-n5 | true; echo ${PIPESTATUS[0]}")
    assert done.out == "0\n"
    assert "Traceback" not in done.err and "Exception" not in done.err


@pytest.mark.slow
def test_a_full_disk_under_standard_output_is_not_completed():
    done = shell("fcm respond yang1998-n5 > /dev/full || echo $?")
    assert done.out == "3\n"
    assert "Traceback" not in done.err and "Exception" not in done.err


@pytest.mark.parametrize(
    "words, found", [("fcm respond yang", "yang1998-n5"), ("fcm plot modes bladed", "bladed-disk")]
)
def test_a_shell_completes_bundled_scenes_and_files(words, found):
    """As the bash function of `_FCM_COMPLETE=bash_source fcm` asks: file is for bash to complete."""
    asked = {"_FCM_COMPLETE": "bash_complete", "COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
    completed = CliRunner().invoke(main, env=asked, prog_name="fcm").output.split()
    assert f"plain,{found}" in completed and f"file,{words.split()[-1]}" in completed


@pytest.mark.parametrize(
    ("args", "said"),
    [(["respnd", "x.toml"], "respond"), (["plot", "resonse"], "response"), (["Plot"], "plot")],
)
def test_a_misspelled_command_is_recognised(args, said):
    done = called(*args)
    assert done.code == 2 and f'did you mean "{said}"?' in done.err


@pytest.mark.parametrize("option", ["-o", "--csv"])
def test_an_empty_name_of_a_file_is_no_folder(option):
    """It was said that '.' is a folder."""
    done = called("respond", "yang1998", option, "")
    assert done.code == 2 and "as an empty name is: name a file to write" in done.err
