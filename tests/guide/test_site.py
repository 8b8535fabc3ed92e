"""The guide as a site: every page, with its equations, to be searched."""

import json
import re

import pytest

from ..program import python
from .pages import GUIDE, PAGES, README, ROOT, read


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    settings = ROOT / ".github/mkdocs.yml"
    done = python("-m", "mkdocs", "build", "--quiet", "--config-file", settings, "--site-dir", folder)
    assert done.code == 0, done.out + done.err
    return folder


def pages_of(site):
    """Each page of the guide with what it is in the site."""
    for page in PAGES:
        if page != README:
            there = site / page.relative_to(GUIDE).with_suffix(".html")
            yield page, read(there.with_name("index.html") if page.name == "README.md" else there)


@pytest.mark.slow
def test_every_page_is_in_the_site_and_in_its_navigation(site):
    index = read(site / "index.html")
    for page, html in pages_of(site):
        assert "<h1" in html
        if page.name != "README.md":
            assert f'href="{page.relative_to(GUIDE).with_suffix(".html")}"' in index


def test_equations_are_drawn_and_nothing_comes_from_elsewhere(site):
    drawn = 0
    for page, html in pages_of(site):
        assert "arithmatex" not in html, page
        drawn += html.count("<math")
        assert not re.search(r'(?:<script[^>]* src|<img[^>]* src|<link[^>]*stylesheet[^>]* href)="http', html)
    assert drawn > 100


def test_it_can_be_searched(site):
    words = json.loads((site / "search/search_index.json").read_text())["docs"]
    assert any("monodromy" in entry["text"] for entry in words)
