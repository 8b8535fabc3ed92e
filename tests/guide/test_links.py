"""Links to other sites: found on a page, requested once, and said; here from a server of the test."""

import threading
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest

from . import links
from .pages import OTHERS, PAGES, read


class Site(BaseHTTPRequestHandler):
    """/there answers, /no-head to GET alone; /gone, /withdrawn and /closed as they say."""

    def answer(self):
        self.server.requests.append((self.command, self.path))
        status = {"/there": 200, "/gone": 404, "/withdrawn": 410, "/closed": 403}.get(self.path, 200)
        if self.path == "/no-head" and self.command == "HEAD":
            status = 404
        self.send_response(status)
        self.end_headers()

    do_HEAD = do_GET = answer

    def log_message(self, *_given):
        """Says nothing."""


@pytest.fixture
def site():
    with HTTPServer(("127.0.0.1", 0), Site) as server:
        server.requests = []
        thread = threading.Thread(target=server.serve_forever, daemon=True)
        thread.start()
        server.address = f"http://127.0.0.1:{server.server_port}"
        yield server
        server.shutdown()
        thread.join()


def said(capsys, text):
    """What is printed of a page with that text, and the status."""
    status = links.main({"page.md": text})
    return capsys.readouterr().out.splitlines(), status


def test_each_link_is_requested_once_and_by_get_where_head_is_refused(site, capsys):
    there = f"{site.address}/there"
    text = f"[a]({there}), [b]({there}#part), <{there}> and [c]({site.address}/no-head), [d](other.md)\n"
    assert said(capsys, text) == (["2 of 2 links to other sites answer"], 0)
    assert site.requests == [("HEAD", "/no-head"), ("GET", "/no-head"), ("HEAD", "/there")]


def test_a_page_that_is_gone_is_named_with_where_it_is_linked(site, capsys):
    gone, withdrawn = f"{site.address}/gone", f"{site.address}/withdrawn"
    lines, status = said(capsys, f"![picture]({gone})\n\n[a]: {withdrawn}\n")
    assert status == 1
    assert lines == [
        f"gone: {gone} (404); in page.md",
        f"gone: {withdrawn} (410); in page.md",
        "0 of 2 links to other sites answer",
    ]


def test_a_refusal_and_a_site_that_is_not_reached_are_said_and_nothing_is_gone(site, capsys):
    closed, nowhere = f"{site.address}/closed", "http://127.0.0.1:1/"  # where nothing listens
    (first, second, last), status = said(capsys, f"[a]({closed}) [b]({nowhere})")
    assert status == 0
    assert first.startswith(f"not reached: {nowhere} (") and "refused" in first
    assert (second, last) == (f"refused: {closed} (403); in page.md", "0 of 2 links to other sites answer")


def test_code_has_no_links():
    assert links.external({"page.md": "```text\n[a](https://example.org)\n```\n"}) == {}


def test_the_pages_have_links_to_other_sites():
    assert len(links.external({page.name: read(page) for page in [*PAGES, *OTHERS]})) >= 2
