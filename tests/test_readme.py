"""README.md and the pages of its guide do what they say: every command is run, every output compared."""

import doctest
import json
import re
import sys
import sysconfig
import tomllib
from pathlib import Path

import pytest

import fcm
from fcm.compare.exact import exact_lines
from fcm.response import trace
from fcm.scene.keys import TABLES

from .program import shell
from .report.convergence import greatest_error

ROOT = Path(__file__).parents[1]
README = ROOT / "README.md"
PAGES = [README, *sorted((ROOT / ".github/guide").glob("*.md"))]
SCENE = "shroud.toml"  # the name under which the README lets its scene be saved


def text_of(pages=PAGES):
    return "\n".join(page.read_text(encoding="utf-8") for page in pages)


def blocks(kind, pages=PAGES):
    """The fenced blocks of a kind, in their order."""
    return re.findall(rf"^```{kind}\n(.*?)^```", text_of(pages), re.M | re.S)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A new folder, as a reader has it who has saved the scene."""
    folder = tmp_path_factory.mktemp("reader")
    (scene,) = blocks("toml", [README])
    (folder / SCENE).write_text(scene, encoding="utf-8")
    return folder


def run(command, folder):
    if command.startswith("make "):  # that the target exists; tests do not call what calls them
        command, folder = command.replace("make ", "make -n ", 1), ROOT
    return shell(command, folder)


def commands():
    lines = [line for block in blocks("sh") for line in block.splitlines()]
    return list(dict.fromkeys(line for line in lines if line and not line.startswith("#")))


def test_every_command_runs(folder):
    assert len(commands()) >= 20
    for command in commands():
        done = run(command, folder)
        assert done.code == 0, f"{command}\n{done.out}{done.err}"
    written = {path.name for path in folder.iterdir()}
    named = {name for line in commands() for name in re.findall(r"(?:-o|--csv) (\S+)", line)}
    assert named and written == {SCENE, *named}


def test_the_output_shown_is_what_the_command_prints(folder):
    (shown,) = blocks("text")
    printed = run(next(line for line in commands() if line.startswith(f"fcm respond {SCENE}")), folder).out
    for ours, theirs in zip(printed.split("\n\n"), shown.split("\n\n"), strict=True):
        header, *rows = theirs.splitlines()
        assert ours.splitlines()[0] == header
        assert [cells(row, header) for row in ours.splitlines()[1:]] == [cells(row, header) for row in rows]


def cells(row, header):
    """The cells of a row, without points and time; a jump begins at one of the points, which may change."""
    words = row.split()
    jump = "jump" in header
    if not jump:
        del words[8:10]
    return [cell(word, jump) for word in words]


def cell(word, jump):
    """A number, to what it may change by; the errors of peaks are estimates, of two digits."""
    if not re.fullmatch(r"-?[\d.]+(e-?\d+)?", word):
        return word
    return pytest.approx(float(word), rel=0.3 if "e-" in word else 0.02 if jump else 2e-5)


def test_the_python_prints_what_it_shows():
    examples = doctest.DocTestParser().get_doctest("\n".join(blocks("pycon")), {}, "pages", None, 0)
    assert len(examples.examples) >= 5
    report = []
    failed, _tried = doctest.DocTestRunner(verbose=False).run(examples, out=report.append)
    assert failed == 0, "".join(report)


def test_the_errors_are_as_claimed(folder):
    (claim,) = re.findall(r"moves no point by more than (\S+) of", text_of())
    curves = json.loads(run("fcm respond yang1998 --json", folder).out)["curves"]
    table, harmonic = (max(curve[name] for curve in curves) for name in ("table_error", "truncation_error"))
    assert 0 < table < float(claim) and harmonic > 100 * table  # "by far the larger error"


def test_the_tables_of_scenes_that_are_shown_have_keys_that_there_are():
    shown = blocks("toml", PAGES[1:])
    for table, keys in (pair for block in shown for pair in tables_in(tomllib.loads(block))):
        assert set(keys) <= set(TABLES[table]), table


def tables_in(data, path=""):
    """Paths and keys of all tables within one."""
    for key, value in data.items():
        inner = value if isinstance(value, list) else [value]
        for one in (one for one in inner if isinstance(one, dict)):
            yield (f"{path}{key}", list(one))
            yield from tables_in(one, f"{path}{key}.")


def test_every_block_is_of_a_kind_that_is_tested():
    kinds = re.findall(r"^```(\S+)$", text_of(), re.M)
    assert set(kinds) <= {"sh", "toml", "text", "pycon", "mermaid"}


OTHERS = [ROOT / ".github/CHANGELOG.md", ROOT / ".github/CONTRIBUTING.md"]


@pytest.mark.parametrize("page", [*PAGES, *OTHERS], ids=lambda page: page.name)
def test_files_and_headings_that_a_page_names_exist(page):
    for name, _, heading in re.findall(r"\]\(([^)#]+)(#([\w-]+))?\)", page.read_text(encoding="utf-8")):
        if name.startswith("https://"):
            continue
        assert (page.parent / name).is_file(), name
        titles = re.findall(r"^#+ (.*)$", (page.parent / name).read_text("utf-8"), re.M) if heading else []
        assert not heading or heading in {re.sub(r"[^\w -]", "", t).lower().replace(" ", "-") for t in titles}


def test_modules_and_programs_that_a_page_names_exist():
    modules = re.findall(r"`([a-z_]+/[a-z_/]+)`", text_of([ROOT / ".github/guide/work.md"]))
    assert len(modules) > 20
    assert all((ROOT / "src/fcm" / f"{name}.py").is_file() or (ROOT / name).is_dir() for name in modules)
    programs = re.findall(
        r"\b(?:tests|src)/[\w/]+\.py", text_of([*PAGES, *OTHERS]).replace("NAME", "__init__")
    )
    assert programs and all((ROOT / name).is_file() for name in programs)


def test_the_readme_is_read_in_minutes():
    assert len(README.read_text(encoding="utf-8").splitlines()) <= 240
    assert all(f"]({page.relative_to(ROOT)})" in text_of([README]) for page in PAGES[1:])


def test_the_table_of_methods_has_the_errors_of_the_methods():
    """Those of `make convergence`, as it computes them."""
    rows = re.findall(r"^\| .*\| `--harmonics (\d+)` \| (\S+) \|", text_of([README]), re.M)
    scene = fcm.load_scene("yang1998-n5")
    peaks = {dof: height for dof, (height, _) in exact_lines(scene)[0].peaks.items()}
    for harmonics, shown in rows:
        (curve,) = trace(scene, "closed-form", harmonics=int(harmonics)).curves
        assert greatest_error(curve, peaks) == pytest.approx(float(shown), rel=0.05)
    assert [int(harmonics) for harmonics, _ in rows] == [1, 3, 5, 9, 15]


def test_bundled_scenes_are_named():
    assert all(f"`{path.stem}`" in text_of() for path in (ROOT / "src/fcm/scenes").glob("*.toml"))


def test_python_of_this_test_is_the_one_with_fcm():
    assert Path(sysconfig.get_path("scripts"), "fcm").exists(), f"{sys.prefix} has no fcm"
