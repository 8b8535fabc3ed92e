"""What the site needs besides its settings: the navigation by the index page, equations as MathML."""

import re
from html import unescape
from pathlib import Path

from latex2mathml.converter import convert


def on_config(config):
    """A section for each heading of the index page, with the pages that are listed below it."""
    text = (Path(config["docs_dir"]) / "README.md").read_text(encoding="utf-8")
    config["nav"] = [{"The guide": "README.md"}]
    for part in re.split(r"^## ", text, flags=re.M)[1:]:
        pages = [{title: file} for title, file in re.findall(r"^\| \[(.*?)\]\((.*?)\)", part, re.M)]
        config["nav"] += [{part.split("\n")[0]: pages}] if pages else []
    return config


def on_page_content(html, **_given):
    """Browsers draw MathML themselves, so that no script comes from elsewhere."""
    html = re.sub(
        r'<span class="arithmatex">\\\((.*?)\\\)</span>',
        lambda found: convert(unescape(found[1])),
        html,
        flags=re.S,
    )
    return re.sub(
        r'<div class="arithmatex">\s*\\\[(.*?)\\\]\s*</div>',
        lambda found: convert(unescape(found[1]).strip(), display="block"),
        html,
        flags=re.S,
    )
