"""A page of sections: a picture with its caption, the commands that made it, tables of numbers; as HTML."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

_STYLE = """
:root { --ink: #1a1a1a; --soft: #5a5a5a; --line: #d8d8d8; --good: #0b6e4f; --bad: #b3261e; }
body { font: 16px/1.5 Georgia, "Times New Roman", serif; color: var(--ink); background: #fff;
  max-width: 47rem; margin: 2.5rem auto; padding: 0 1.25rem; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: 0 0 .5rem; }
h2 { font-size: 1.2rem; margin: 3rem 0 .75rem; padding-top: 1rem; border-top: 1px solid var(--line); }
p { margin: .6rem 0; }
nav a { margin-right: .9rem; white-space: nowrap; }
a { color: #0b5394; }
figure { margin: 1rem 0; }
figure img { max-width: 100%; height: auto; display: block; margin: 0 auto; }
figcaption { color: var(--soft); font-size: .92rem; margin-top: .5rem; }
pre { background: #f5f5f2; padding: .6rem .8rem; font-size: .8rem; line-height: 1.45; white-space: pre-wrap; }
pre span { white-space: nowrap; }
pre.printed { white-space: pre; font-size: .7rem; width: max-content; max-width: calc(100vw - 4rem);
  box-sizing: border-box; overflow-x: auto; position: relative; left: 50%; transform: translateX(-50%); }
table { border-collapse: collapse; width: 100%; font-size: .9rem; margin: .8rem 0; }
th, td { text-align: left; vertical-align: top; padding: .3rem .8rem .3rem 0;
  border-bottom: 1px solid var(--line); }
th { font-weight: normal; color: var(--soft); border-bottom-color: #999; }
td:nth-child(2) { min-width: 6.5rem; }
td.yes { color: var(--good); } td.no { color: var(--bad); font-weight: bold; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .1rem 1rem; font-size: .85rem;
  color: var(--soft); }
dd { margin: 0; }
@media print { body { margin: 0 auto; } section { break-inside: avoid; } }
"""


@dataclass(frozen=True)
class Table:
    """Rows of texts; ``agrees`` adds a column: of each row whether it is as expected, None if nothing is."""

    columns: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    agrees: Sequence[bool | None] | None = None


@dataclass(frozen=True)
class Section:
    """What is shown under one heading, in this order."""

    title: str
    text: tuple[str, ...] = ()
    picture: str = ""  # beside the page
    width: float = 170.0  # [mm] of the picture
    caption: str = ""
    commands: tuple[str, ...] = ()
    printed: str = ""  # by the last of the commands, its lines not broken
    tables: tuple[Table, ...] = ()
    after: tuple[str, ...] = ()  # what the tables show


@dataclass(frozen=True)
class Page:
    """A title, what the page is, the facts of its making, and the sections."""

    title: str
    text: tuple[str, ...]
    sections: Sequence[Section]
    facts: Sequence[tuple[str, str]] = ()
    facts_first: bool = False  # below the title instead of at the end


def render(page: Page) -> str:
    """The page as HTML, with everything in it but the pictures.

    >>> "<h1>Loops &amp; curves</h1>" in render(Page("Loops & curves", (), ()))
    True
    """
    links = "".join(f'<a href="#{_anchor(s)}">{escape(s.title)}</a> ' for s in page.sections)
    facts = "".join(f"<dt>{escape(name)}</dt><dd>{escape(value)}</dd>" for name, value in page.facts)
    facts = f"<dl>{facts}</dl>" if facts else ""
    parts = [
        "<!DOCTYPE html>",
        '<html lang="en">',
        f'<head><meta charset="utf-8"><title>{escape(page.title)}</title>',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<style>{_STYLE}</style></head>",
        f"<body><h1>{escape(page.title)}</h1>",
        facts if page.facts_first else "",
        *_paragraphs(page.text),
        f"<nav>{links}</nav>",
        *(_section(section) for section in page.sections),
        f"<h2>How this page was made</h2>{facts}" if facts and not page.facts_first else "",
        "</body></html>",
    ]
    return "\n".join(part for part in parts if part) + "\n"


def _anchor(section: Section) -> str:
    return "".join(c if c.isalnum() else "-" for c in section.title.lower())


def _paragraphs(texts: Sequence[str]) -> list[str]:
    return [f"<p>{escape(text)}</p>" for text in texts]


def _section(section: Section) -> str:
    parts = [f'<section id="{_anchor(section)}"><h2>{escape(section.title)}</h2>', *_paragraphs(section.text)]
    if section.picture:
        name, caption = escape(section.picture, quote=True), escape(section.caption)
        parts.append(
            f'<figure><img src="{name}" alt="{escape(section.title, quote=True)}" '
            f'style="width: {section.width:g}mm"><figcaption>{caption}</figcaption></figure>'
        )
    if section.commands:
        parts.append("<pre>" + "\n".join(map(_command, section.commands)) + "</pre>")
    if section.printed:
        parts.append(f'<pre class="printed">{escape(section.printed)}</pre>')
    parts += [_table(table) for table in section.tables] + _paragraphs(section.after)
    return "\n".join([*parts, "</section>"])


def _command(line: str) -> str:
    """A line whose words stay whole: browsers break them at hyphens."""
    return " ".join(f"<span>{escape(word)}</span>" for word in line.split(" "))


def _table(table: Table) -> str:
    columns = table.columns if table.agrees is None else (*table.columns, "")
    lines = [
        "<table><thead><tr>" + "".join(f"<th>{escape(c)}</th>" for c in columns) + "</tr></thead><tbody>"
    ]
    for i, row in enumerate(table.rows):
        cells = "".join(f"<td>{escape(cell)}</td>" for cell in row)
        lines.append(f"<tr>{cells}{'' if table.agrees is None else _verdict(table.agrees[i])}</tr>")
    return "\n".join([*lines, "</tbody></table>"])


def _verdict(agrees: bool | None) -> str:
    if agrees is None:
        return "<td></td>"
    return '<td class="yes">agrees</td>' if agrees else '<td class="no">differs</td>'
