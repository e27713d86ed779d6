"""A page as one HTML file that asks nobody for anything."""

from __future__ import annotations

import re
from functools import cache

from jinja2 import Environment, PackageLoader, StrictUndefined, Template

from enpointe.report.blocks import Page

__all__ = ["render"]

_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


@cache
def _template() -> Template:
    environment = Environment(
        loader=PackageLoader("enpointe.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    # Ours, not anybody's: SVG that the charts and the stave drew, with their own escaping.
    environment.filters["trusted"] = environment.filters["safe"]
    return environment.get_template("report.html")


def render(page: Page) -> str:
    """The page as HTML that is XML too, so that any tool can read it."""
    return _NOT_XML.sub("\ufffd", _template().render(page=page)) + "\n"
