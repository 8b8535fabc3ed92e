"""The only place that writes text to a terminal: names in the text cannot send it control codes."""

from __future__ import annotations

import os
import re
import sys
from typing import Any, TextIO

# controls, invisible characters, line ends, writing directions, surrogates, tags
_ACTED_UPON = (
    "\x00-\x09\x0b-\x1f\x7f-\x9f\xad\u061c\u180e\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"
    "\ud800-\udfff\U000e0000-\U000e007f"
)
_IN_TEXT = re.compile(f"[{_ACTED_UPON}]")
_IN_NAME = re.compile(f"[{_ACTED_UPON}\n]")


def plain(name: object, several_lines: bool = False) -> str:
    r"""The name with characters that a terminal acts upon escaped.

    >>> print(plain("a\x1b[31m\nb"))
    a\x1b[31m\nb
    """
    return (_IN_TEXT if several_lines else _IN_NAME).sub(_escaped, str(name))


def _escaped(found: re.Match[str]) -> str:
    return found[0].encode("unicode_escape", "surrogatepass").decode()


class Terminal:
    """A stream that escapes the text written to it."""

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream

    def write(self, text: str) -> int:
        """Write text of several lines."""
        if not isinstance(text, str):  # click tests whether it accepts bytes
            raise TypeError(f"text is written here, not {type(text).__name__}")
        self.stream.write(plain(text, several_lines=True))
        return len(text)

    def redraw(self, text: str) -> None:
        """Overwrite the last line."""
        self.stream.write("\r" + plain(text))
        self.stream.flush()

    def __getattr__(self, name: str) -> Any:
        return getattr(self.stream, name)


def streams() -> None:
    """Make standard output and error such streams; a stream closed by the shell becomes the null device.

    Otherwise a file opened later would get the number of a closed stream, and the prints of libraries.
    """
    while (number := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(number, True)
    os.close(number)
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name) or open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123, SIM115
        if isinstance(stream, Terminal):
            continue
        if hasattr(stream, "reconfigure"):  # escapes characters that the terminal lacks, too
            stream.reconfigure(errors="backslashreplace")
        setattr(sys, name, Terminal(stream))


def give_back() -> None:
    """Restore the streams."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if isinstance(stream, Terminal):
            setattr(sys, name, stream.stream)
