"""The pages are whole: what they name exists, and they can be read."""

import re

import pytest

from .pages import (
    GUIDE,
    OTHERS,
    PAGES,
    README,
    ROOT,
    anchors,
    files,
    links,
    name_of,
    prose,
    read,
    sentences,
    too_long,
    words,
)

SOURCES = {str(path.relative_to(ROOT / "src/fcm")) for path in (ROOT / "src/fcm").rglob("*.py")}
KINDS = ("tutorials", "howto", "theory", "reference", "validation")


@pytest.mark.parametrize("page", [*PAGES, *OTHERS], ids=name_of)
def test_files_and_headings_that_a_page_links_to_exist(page):
    for file, heading in links(page):
        target = page.parent / file if file else page
        assert target.is_file() or (target / "README.md").is_file(), file
        assert not heading or heading in anchors(target), f"{file}#{heading}"


def test_every_page_is_of_a_kind_and_in_the_index():
    index = GUIDE / "README.md"
    listed = {(GUIDE / file).resolve() for file, _ in links(index)}
    others = [page for page in PAGES if page not in (README, index)]
    assert {page.parent.name for page in others} <= {*KINDS, "guide"}
    assert not [name_of(page) for page in others if page.resolve() not in listed]
    assert (".github/guide/README.md", "") in links(README)


@pytest.mark.parametrize("page", [*PAGES, *OTHERS], ids=name_of)
def test_sentences_and_paragraphs_are_short(page):
    """Under 25 and 100 words, lists and tables, too; `python -m tests.guide.pages -v` shows longer ones."""
    assert too_long(page) == []


def test_a_file_may_be_another_with_one_table_replaced(tmp_path):
    page = tmp_path / "page.md"
    whole = "Save this as `a.toml`:\n\n```toml\n[one]\nx = 1\n\n[sweep]\ny = [2]\n\n[last]\nz = 3\n```\n"
    part = (
        "Replace `[sweep]` of `a.toml` by this, and\nsave it as `b.toml`:\n\n```toml\n[optimum]\nu = 4\n```\n"
    )
    page.write_text(f"{whole}\n{part}", encoding="utf-8")
    assert files(page)["b.toml"] == "[one]\nx = 1\n\n[optimum]\nu = 4\n[last]\nz = 3\n"


def test_headings_items_and_cells_are_read_and_code_is_not(tmp_path):
    page = tmp_path / "page.md"
    text = (
        "# One\ntwo\n\n- three\n    four\n\n    code\n    more\n\n1. five\n\n| six | seven |\n| --- | --- |\n"
    )
    page.write_text(f"{text}\n```sh\neight\n```\n", encoding="utf-8")
    assert prose(page) == ["One", "two", "three\n    four", "five"]
    assert prose(page, cells=True) == ["six", "seven"]


def test_words_and_sentences_are_counted():
    text = "A load of 3.5 N, say. It is *small* (see X). 9 of 10 are."
    assert [words(one) for one in sentences(text)] == [6, 5, 4]


@pytest.mark.parametrize("page", sorted((GUIDE / "theory").glob("*.md")), ids=name_of)
def test_a_page_of_theory_has_equations_a_figure_its_modules_and_its_sources(page):
    text = read(page)
    assert re.search(r"^\$\$.+?\$\$$", text, re.M | re.S)
    assert any(file.startswith("../figures/") for file, _ in links(page))
    (code,) = re.findall(r"^In the code: (.*?)\n\n", text, re.M | re.S)
    assert {f"{name}.py" for name in re.findall(r"`([\w/]+)`", code)} <= SOURCES
    sources = re.split(r"^- ", text.partition("\n## Sources\n")[2], flags=re.M)[1:]
    assert sources and all(re.search(r"\b(?:18|19|20)\d\d\b", one) for one in sources)


@pytest.mark.parametrize("page", sorted((GUIDE / "theory").glob("*.md")), ids=name_of)
def test_each_source_of_a_page_of_theory_stands_where_it_is_used(page):
    """By its first author and the year behind: Woodbury 1950, Den Hartog (1931)."""
    body, _, sources = " ".join(read(page).split()).partition(" ## Sources - ")
    for one in re.split(r" - (?=\S*[A-Z]\S*\.)", sources):
        author, _, rest = one.partition(",")
        name = re.sub(r"^(?:\S*\. ?-?)+", "", author)
        years = re.findall(r"\b(?:18|19|20)\d\d\b", rest)
        assert any(re.search(rf"{name}\b[^.;()]*[ (]{year}\b", body) for year in years), one


def test_every_picture_is_shown():
    shown = {(page.parent / file).resolve() for page in PAGES for file, _ in links(page)}
    assert not [path.name for path in (GUIDE / "figures").rglob("*.*") if path.resolve() not in shown]


def test_pictures_are_small():
    """A page of them comes over any network."""
    assert sum(path.stat().st_size for path in (GUIDE / "figures/gallery").iterdir()) < 400_000


def test_modules_and_programs_that_a_page_names_exist():
    text = "\n".join(read(page) for page in [*PAGES, *OTHERS])
    modules = {name for name in re.findall(r"`([a-z_]+/[a-z_/]+)`", text) if not name.startswith("build/")}
    assert len(modules) > 20
    assert not [
        name
        for name in modules
        if not (ROOT / "src/fcm" / f"{name}.py").is_file()
        and not any((root / name).is_dir() for root in (ROOT / "src/fcm", ROOT))
    ]
    programs = re.findall(r"\b(?:tests|src)/[\w/]+\.py", text.replace("NAME", "__init__"))
    programs += [name.replace(".", "/") for name in re.findall(r"-m (tests\.[\w.]*\w)", text)]
    places = [(ROOT / name, ROOT / f"{name}.py", ROOT / name / "__main__.py") for name in programs]
    assert len(places) > 5 and all(any(one.is_file() for one in three) for three in places)


def test_bundled_scenes_are_named():
    text = "\n".join(map(read, PAGES))
    assert all(f"`{path.stem}`" in text for path in (ROOT / "src/fcm/scenes").glob("*.toml"))


def test_files_that_the_makefile_names_exist():
    """Targets whose sources were moved are found only when they are made."""
    named = set(re.findall(r"\b(?:src|tests)/[\w/]+\.(?:py|txt)\b", read(ROOT / "Makefile")))
    assert len(named) > 10 and not [name for name in named if not (ROOT / name).is_file()]


def test_targets_that_a_page_makes_exist():
    """Each that stands in a line of text, too: numbers of validation are those of such commands."""
    targets = set(re.findall(r"^([a-z-]+):", read(ROOT / "Makefile"), re.M))
    named = {name for page in [*PAGES, *OTHERS] for name in re.findall(r"`make ([a-z-]+)", read(page))}
    assert len(named) > 10 and not named - targets
