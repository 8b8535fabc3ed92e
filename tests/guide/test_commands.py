"""The pages do what they say: every command is run, every output shown is compared, Python as well."""

import doctest
import re
import shlex
import sys
import tomllib

import click
import pytest

from fcm.cli import main as program
from fcm.scene.keys import TABLES

from ..program import shell
from .pages import FENCED, GUIDE, OTHERS, PAGES, README, ROOT, blocks, commands, files, name_of, read

OF_THEIR_OWN = {  # tests of commands that need files of other programs, or minutes; below which heading
    "howto/from-another-program.md": ("guide/test_from_another_program.py", None),
    "howto/contacts.md": ("guide/test_pairs.py", "Pairs from two sets of nodes"),
    "tutorials/best-preload.md": ("test_design.py", "Design"),
}


CONTRIBUTING = next(page for page in OTHERS if page.stem == "CONTRIBUTING")
OF_OTHERS = ("--samples",)  # of tests.benchmarks.many


def typed(page):
    """The commands of a page that are run here, with what is shown of their output."""
    _, heading = OF_THEIR_OWN.get(key(page), ("", ""))
    return [] if heading is None else commands(page, heading)


def key(page):
    return str(page.relative_to(GUIDE)) if page != README else ""


TAUGHT = [page for page in PAGES if typed(page)]


def run(command, folder):
    """Of what takes minutes only that it exists: targets of make, tests, and programs that measure."""
    name, _, rest = command.partition(" ")
    if name == "make":
        command, folder = f"make -n {rest}", ROOT
    elif name == ".venv/bin/python":
        if rest.startswith("-m pytest "):
            rest += " --collect-only -q"
        elif rest.startswith("-m tests.benchmarks."):
            rest = f"-m {rest.split()[1]} --help"
        command, folder = f"{shlex.quote(sys.executable)} {rest}", ROOT
    return shell(command, folder)


@pytest.mark.slow
@pytest.mark.parametrize("page", TAUGHT, ids=name_of)
def test_every_command_runs_and_prints_what_is_shown(page, tmp_path):
    """In a new folder, as a reader has it who has saved the files of the page and the scene of the first."""
    given = files(README) | files(page)
    for name, text in given.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    for command, shown in typed(page):
        done = run(command, tmp_path)
        assert done.code == 0, f"{command}\n{done.out}{done.err}"
        if shown is not None:
            assert_shown(done.out + done.err, shown)
    written = {path.name for path in tmp_path.iterdir()}
    lines = [line for line, _ in typed(page)]
    named = {name for line in lines for name in re.findall(r"(?:-o|--csv|>) (\S+)", line)}
    scripts = [name for name in files(page) if f"python {name}" in lines]
    made = {name for script in scripts for name in re.findall(r'"(\w+\.(?:npz|txt|csv))"', given[script])}
    assert written == {*given, *named, *made}


def assert_shown(printed, shown):
    """The lines that are shown are the first printed; after `...` they may stand anywhere behind."""
    ours, at, heading = printed.splitlines(), 0, ""
    for number, part in enumerate(re.split(r"^\.\.\.\n", shown, flags=re.M)):
        theirs = part.splitlines()
        headings = headings_of(theirs, heading)
        places = range(at, len(ours) - len(theirs) + 1) if number else [0]
        found = next((i for i in places if same(ours[i : i + len(theirs)], theirs, headings)), None)
        assert found is not None, f"shown:\n{part}\nprinted:\n{printed}"
        at, heading = found + len(theirs), headings[-1] if headings else ""


def headings_of(lines, before):
    """The header above each line, so that points and times are not compared; it holds beyond `...`."""
    found = []
    for line in lines:
        before = line if re.search(r"\bpoints\b|\bjump\b", line) else before if line else ""
        found.append(before)
    return found


def same(printed, shown, headings):
    """Whether each line is, as far as it is compared."""
    pairs = zip(printed, shown, headings, strict=False)
    return len(printed) == len(shown) and all(cells(a, head) == cells(b, head) for a, b, head in pairs)


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


def test_commands_stand_in_blocks_that_are_run():
    """None by indentation, where no test would find it; the usage of a command is none."""
    found = [
        line
        for page in PAGES
        for line in re.findall(r"^ +((?:fcm|make|python|pip) .*)$", outside(page), re.M)
    ]
    assert [line for line in found if "[OPTIONS]" not in line and " COMMAND" not in line] == []


@pytest.mark.parametrize(
    "page", [one for one in [*PAGES, CONTRIBUTING] if one != GUIDE / "reference/commands.md"], ids=name_of
)
def test_commands_in_running_text_have_options_and_values_that_there_are(page):
    """Words in capitals stand for others, and files need not exist. Options alone are of any command.

    The page of commands is what the program says of itself.
    """
    faults = []
    for text in re.findall(r"`((?:fcm|--[a-z])[^`]*)`", outside(page)):
        words = shlex.split(text)
        if words[0] != "fcm":
            fault = min((fault_of(one, words) for one in all_commands(program)), key=len)
        else:
            command, rest = program, words[1:]
            while isinstance(command, click.Group) and rest and rest[0] in command.list_commands(None):
                command, rest = command.get_command(None, rest[0]), rest[1:]
            fault = fault_of(command, rest)
        if fault and words[0] not in OF_OTHERS:
            faults.append(f"{text}: {fault}")
    assert faults == []


def all_commands(command):
    yield command
    if isinstance(command, click.Group):
        for name in command.list_commands(None):
            yield from all_commands(command.get_command(None, name))


def fault_of(command, words):
    """What is wrong with the arguments of a command, or nothing."""
    context = click.Context(command, **program.context_settings)  # click keeps the help option of the first
    try:
        last = [one for one in command.get_params(context) if words[-1:] and words[-1] in one.opts]
        values = [] if not last or last[0].is_flag else ["VALUE"] * last[0].nargs  # its name alone
        given, left, _ = command.make_parser(context).parse_args([*words, *values])
        if isinstance(command, click.Group) and left and not stands_for_another(left[0]):
            raise click.UsageError(f"no command {left[0]}")
        for one in command.get_params(context):
            value = given.get(one.name)
            if value and not isinstance(one.type, click.Path) and not stands_for_another(value):
                one.type_cast_value(context, value)
    except click.ClickException as error:
        return error.format_message()
    return ""


def stands_for_another(value):
    """A word in capitals, as FILE or FROM:TO:COUNT, or several words with one."""
    if isinstance(value, list | tuple):
        return any(map(stands_for_another, value))
    return isinstance(value, str) and re.search(r"\b[A-Z]+\b", value) is not None


def test_options_and_values_that_are_none_are_seen():
    respond = program.get_command(None, "respond")
    response = program.get_command(None, "plot").get_command(None, "response")
    assert fault_of(respond, ["SCENE", "--harmonics", "1-3", "--at", "F"]) == ""
    assert "No such option" in fault_of(respond, ["SCENE", "--harmonic-s", "3"])
    assert "closed-from" in fault_of(respond, ["SCENE", "--method", "closed-from"])
    assert "requires 2 arguments" in fault_of(response, ["FILE", "--band", "5"])
    assert "no command" in fault_of(program, ["resound", "SCENE"])


def outside(page):
    """The text of a page without its fenced blocks."""
    return FENCED.sub("", read(page))


def test_commands_with_a_test_of_their_own_are_run_by_it():
    for name, (test, heading) in OF_THEIR_OWN.items():
        assert heading is None or len(commands(GUIDE / name)) > len(typed(GUIDE / name))
        assert "shell(" in read(ROOT / "tests" / test)


def test_every_block_is_of_a_kind_that_is_tested():
    assert {b.kind for page in PAGES for b in blocks(page) if not b.file} <= {"sh", "toml", "text", "pycon"}
