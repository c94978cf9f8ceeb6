"""Settings of the site: `sphinx-build -W docs site` builds it, without a network."""

import re
from typing import Any

from docutils.nodes import SkipNode
from latex2mathml.converter import convert

from dembound.version import __version__

project = "dembound"
author = "the dembound developers"
copyright = "2026, the dembound developers"
version = release = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_copybutton", "sphinx_design"]
myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
exclude_patterns = ["zh/_*"]

html_theme = "furo"
html_title = "dembound"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_math_renderer = "mathml"
autodoc_typehints = "signature"
autodoc_member_order = "bysource"
default_role = "code"

FIELDS = {"Parameters": "param", "Attributes": "ivar"}
ITEM = re.compile(r"(?:^|(?<=[.;]) )(\w+(?:, \w+)*) : ")


def in_fields(app: Any, what: str, name: str, item: Any, options: Any, lines: list[str]) -> None:
    """Turn sections of a docstring with entries "name : meaning" into fields; else meanings are taken for types."""
    text = "\n".join(lines)
    for section, kind in FIELDS.items():
        head, found, rest = text.partition(f"{section}\n{'-' * len(section)}\n")
        if found:
            body, _, rest = rest.partition("\n\n")
            _, *parts = ITEM.split(" ".join(body.split()))
            fields = [
                f":{kind} {names.replace(', ', '/')}: {meaning}"
                for names, meaning in zip(parts[::2], parts[1::2], strict=True)
            ]
            text = "\n".join([head, *fields, "", rest])
    lines[:] = text.split("\n")


def in_line(writer: Any, node: Any) -> None:
    """Write an equation within a line as MathML, which browsers draw without a script."""
    writer.body.append(convert(node.astext()))
    raise SkipNode


def displayed(writer: Any, node: Any) -> None:
    """Write a displayed equation as MathML."""
    writer.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>')
    raise SkipNode


def setup(app: Any) -> None:
    """Have the sections of docstrings read, and equations written as MathML."""
    app.connect("autodoc-process-docstring", in_fields)
    app.add_html_math_renderer("mathml", (in_line, None), (displayed, None))
