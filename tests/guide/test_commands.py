"""The pages do what they say: every command is run, every output shown is compared, Python as well."""

import doctest
import re
import tomllib

import pytest

from fcm.scene.keys import TABLES

from ..program import shell
from .pages import PAGES, README, ROOT, blocks, commands, files, name_of

TAUGHT = [page for page in PAGES if commands(page)]


def run(command, folder):
    if command.startswith("make "):  # that the target exists; tests do not call what calls them
        command, folder = command.replace("make ", "make -n ", 1), ROOT
    return shell(command, folder)


@pytest.mark.slow
@pytest.mark.parametrize("page", TAUGHT, ids=name_of)
def test_every_command_runs_and_prints_what_is_shown(page, tmp_path):
    """In a new folder, as a reader has it who has saved the files of the page and the scene of the first."""
    given = files(README) | files(page)
    for name, text in given.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    for command, shown in commands(page):
        done = run(command, tmp_path)
        assert done.code == 0, f"{command}\n{done.out}{done.err}"
        if shown is not None:
            assert_shown(done.out + done.err, shown)
    written = {path.name for path in tmp_path.iterdir()}
    lines = [line for line, _ in commands(page)]
    named = {name for line in lines for name in re.findall(r"(?:-o|--csv|>) (\S+)", line)}
    scripts = [name for name in files(page) if f"python {name}" in lines]
    made = {name for script in scripts for name in re.findall(r'"(\w+\.(?:npz|txt|csv))"', given[script])}
    assert written == {*given, *named, *made}


def assert_shown(printed, shown):
    """The lines that are shown are the first printed; after `...` they may stand anywhere behind."""
    ours, at = printed.splitlines(), 0
    for number, part in enumerate(re.split(r"^\.\.\.\n", shown, flags=re.M)):
        theirs = part.splitlines()
        places = range(at, len(ours) - len(theirs) + 1) if number else [0]
        found = next((i for i in places if same(ours[i : i + len(theirs)], theirs)), None)
        assert found is not None, f"shown:\n{part}\nprinted:\n{printed}"
        at = found + len(theirs)


def same(printed, shown):
    """Line by line, with the header above a row known: points and times are not compared."""
    heading = ""
    for ours, theirs in zip(printed, shown, strict=False):
        heading = theirs if re.search(r"\bpoints\b|\bjump\b", theirs) else heading if theirs else ""
        if cells(ours, heading) != cells(theirs, heading):
            return False
    return len(printed) == len(shown)


def cells(line, heading):
    """The words of a line, numbers to what they may change by; a jump begins at a point, which may change."""
    found, columns = (re.split(r"  +", one.strip()) for one in (line, heading))
    if "points" in columns and line.split() != heading.split():
        at = columns.index("points")
        del found[at : at + 1 + ("time [s]" in columns[at + 1 : at + 2])]
    jump = "jump" in heading
    text = re.sub(r"\b[\d.]+ (?:ms|s)\b", "TIME", " ".join(found)).split()
    return [cell(word, jump) for word in text]


def cell(word, jump):
    """A number, to what it may change by; the errors of peaks are estimates, of two digits."""
    number = re.fullmatch(r"\(?(-?\d[\d.]*(?:e[-+]?\d+)?)([,;:.%)]*)", word)
    if not number:
        return word
    within = 0.3 if re.fullmatch(r"\d\.\de-\d+", number[1]) else 0.02 if jump else 2e-5
    return pytest.approx(float(number[1].rstrip(".")), rel=within), number[2]


@pytest.mark.slow
@pytest.mark.parametrize(
    "page", [page for page in PAGES if any(b.kind == "pycon" for b in blocks(page))], ids=name_of
)
def test_the_python_prints_what_it_shows(page, monkeypatch):
    monkeypatch.chdir(ROOT)
    text = "\n".join(block.text for block in blocks(page) if block.kind == "pycon")
    examples = doctest.DocTestParser().get_doctest(text, {}, name_of(page), None, 0)
    report = []
    failed, tried = doctest.DocTestRunner(verbose=False).run(examples, out=report.append)
    assert tried and failed == 0, "".join(report)


def test_the_tables_of_scenes_that_are_shown_have_keys_that_there_are():
    shown = [block.text for page in PAGES for block in blocks(page) if block.kind == "toml"]
    assert len(shown) > 5
    for table, keys in (pair for block in shown for pair in tables_in(tomllib.loads(block))):
        if table not in ("sweep", "sweep.paired"):  # whose keys are paths
            assert set(keys) <= set(TABLES[table]), table


def tables_in(data, path=""):
    """Paths and keys of all tables within one."""
    for key, value in data.items():
        inner = value if isinstance(value, list) else [value]
        for one in (one for one in inner if isinstance(one, dict)):
            if f"{path}{key}" in TABLES:
                yield (f"{path}{key}", list(one))
                yield from tables_in(one, f"{path}{key}.")


def test_every_block_is_of_a_kind_that_is_tested():
    assert {b.kind for page in PAGES for b in blocks(page) if not b.file} <= {"sh", "toml", "text", "pycon"}
