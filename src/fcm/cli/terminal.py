"""The one place through which text goes to a terminal: names in it cannot command it."""

from __future__ import annotations

import os
import sys
import unicodedata
from typing import Any, TextIO

_KINDS = {"Cc", "Cf", "Cs", "Zl", "Zp"}  # control, format (as right-to-left), half of a character, line ends


def plain(name: object, keep: str = "") -> str:
    r"""A name without characters that a terminal acts upon; they are escaped instead.

    >>> print(plain("a\x1b[31m\nb"))
    a\x1b[31m\nb
    """
    text = str(name)
    if text.isprintable():
        return text
    return "".join(c if c in keep or unicodedata.category(c) not in _KINDS else _escaped(c) for c in text)


def _escaped(character: str) -> str:
    return character.encode("unicode_escape", "surrogatepass").decode()


class Terminal:
    """A stream as it was, but for what is written to it."""

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream

    def write(self, text: str) -> int:
        """Write text of several lines."""
        if not isinstance(text, str):  # click tries whether it takes bytes
            raise TypeError(f"text is written here, not {type(text).__name__}")
        self.stream.write(plain(text, keep="\n"))
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
    """The streams as they were."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if isinstance(stream, Terminal):
            setattr(sys, name, stream.stream)
