"""The one place through which text goes to a terminal: names in it cannot command it."""

from __future__ import annotations

import os
import re
import sys
from typing import Any, TextIO

# controls, what cannot be seen, ends of lines, directions of writing, halves of characters, tags
_ACTED_UPON = (
    "\x00-\x09\x0b-\x1f\x7f-\x9f\xad\u061c\u180e\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"
    "\ud800-\udfff\U000e0000-\U000e007f"
)
_IN_TEXT = re.compile(f"[{_ACTED_UPON}]")
_IN_NAME = re.compile(f"[{_ACTED_UPON}\n]")


def plain(name: object, several_lines: bool = False) -> str:
    r"""A name without characters that a terminal acts upon; they are escaped instead.

    >>> print(plain("a\x1b[31m\nb"))
    a\x1b[31m\nb
    """
    return (_IN_TEXT if several_lines else _IN_NAME).sub(_escaped, str(name))


def _escaped(found: re.Match[str]) -> str:
    return found[0].encode("unicode_escape", "surrogatepass").decode()


class Terminal:
    """A stream as it was, but for what is written to it."""

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream

    def write(self, text: str) -> int:
        """Write text of several lines."""
        if not isinstance(text, str):  # click tries whether it takes bytes
            raise TypeError(f"text is written here, not {type(text).__name__}")
        self.stream.write(plain(text, several_lines=True))
        return len(text)

    def redraw(self, text: str) -> None:
        """Write over the line that was written last."""
        self.stream.write("\r" + plain(text))
        self.stream.flush()

    def __getattr__(self, name: str) -> Any:
        return getattr(self.stream, name)


def streams() -> None:
    """Standard output and error as such streams; where the shell has closed one, it leads nowhere.

    A file that is opened later would otherwise get the number of a closed one, and what libraries say.
    """
    while (number := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(number, True)
    os.close(number)
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name) or open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123, SIM115
        if isinstance(stream, Terminal):
            continue
        if hasattr(stream, "reconfigure"):  # characters that the terminal does not have are escaped as well
            stream.reconfigure(errors="backslashreplace")
        setattr(sys, name, Terminal(stream))


def give_back() -> None:
    """Restores the streams."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if isinstance(stream, Terminal):
            setattr(sys, name, stream.stream)
