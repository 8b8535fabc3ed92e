"""Links to other sites from the pages: each is requested once.

A page is gone if its site answers 404 or 410. Said are other refusals, too, and sites that are not reached:
some refuse programs, and here may be no network.

usage: python -m tests.guide.links, which ends with 1 if a page is gone
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass
from http.client import HTTPException
from urllib.error import HTTPError
from urllib.request import Request, urlopen

from .pages import FENCED, OTHERS, PAGES, name_of, read

TIMEOUT = 20.0  # s
GONE = 404, 410
EXTERNAL = re.compile(r"\]\((https?://[^)\s#]+)|<(https?://[^>\s#]+)|^\[[^]]+\]: (https?://[^\s#]+)", re.M)


@dataclass(frozen=True)
class Answer:
    """What came of a request: a status of HTTP, or why no site was reached."""

    address: str
    status: int | None
    reason: str = ""

    @property
    def gone(self) -> bool:
        return self.status in GONE

    @property
    def reached(self) -> bool:
        return self.status is not None


def external(pages: dict[str, str]) -> dict[str, list[str]]:
    """The addresses in the texts of pages, by names, each with the pages that link to it."""
    found: dict[str, list[str]] = {}
    for name, text in pages.items():
        for address in {next(filter(None, one)) for one in EXTERNAL.findall(FENCED.sub("", text))}:
            found.setdefault(address, []).append(name)
    return found


def requested(address: str) -> Answer:
    """The answer to HEAD, or to GET where that is refused: some sites have no HEAD."""
    answer = asked(address, "HEAD")
    return answer if answer.status is None or answer.status < 400 else asked(address, "GET")


def asked(address: str, method: str) -> Answer:
    request = Request(address, method=method, headers={"User-Agent": "Mozilla/5.0 (links of fcm)"})
    try:
        with urlopen(request, timeout=TIMEOUT) as page:
            return Answer(address, page.status)
    except HTTPError as answer:
        return Answer(address, answer.code, answer.reason)
    except (OSError, HTTPException) as error:
        return Answer(address, None, str(getattr(error, "reason", error)))


def report(answers: list[Answer], pages: dict[str, list[str]]) -> tuple[list[str], int]:
    """A line for each address that did not answer well, one for all; the status with which to end."""
    lines = []
    for one in answers:
        if not one.reached:
            lines.append(f"not reached: {one.address} ({one.reason}); in {', '.join(pages[one.address])}")
        elif one.status is not None and one.status >= 400:
            said = "gone" if one.gone else "refused"
            lines.append(f"{said}: {one.address} ({one.status}); in {', '.join(pages[one.address])}")
    lines.append(f"{len(answers) - len(lines)} of {len(answers)} links to other sites answer")
    return lines, int(any(one.gone for one in answers))


def main(pages: dict[str, str]) -> int:
    found = external(pages)
    lines, status = report([requested(address) for address in sorted(found)], found)
    print("\n".join(lines))
    return status


if __name__ == "__main__":
    sys.exit(main({name_of(page): read(page) for page in [*PAGES, *OTHERS]}))
