# SPDX-License-Identifier: MIT
"""Pages from templates, and files that are there whole or not at all."""

import dataclasses
import os
import sys

import jinja2
import output_file

from .documents import Malformed

# All that a page shows is escaped, and a name that a template does not find ends it.
_TEMPLATES = jinja2.Environment(
    loader=jinja2.FileSystemLoader(os.path.join(os.path.dirname(__file__), "templates")),
    autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True,
    keep_trailing_newline=True)


@dataclasses.dataclass(frozen=True)
class Table:
    """What templates/table.html.j2 makes a table of. Classes are those of templates/style.css."""

    caption: str
    head: list  # of (title, classes)
    rows: list  # of (class, cells), the cells being (text, classes)


def table(caption, head, lines):
    """A Table from `head`, which is (title, class) for each column, and `lines`, each of which is
    (class of the row, cells). A cell is a text, or (text, a class on top of that of the column)."""
    rows = []
    for row_class, values in lines:
        cells = []
        for value, (_, kind) in zip(values, head, strict=True):
            text, more = (value, "") if isinstance(value, str) else value
            cells.append((text, " ".join(filter(None, (kind, more)))))
        rows.append((row_class, cells))
    return Table(caption, head, rows)


def page(template, **values):
    """The text of a page: templates/TEMPLATE.html.j2 with these values. Raises Malformed when the
    template needs a key that the values have not."""
    try:
        return _TEMPLATES.get_template(template + ".html.j2").render(values)
    except jinja2.UndefinedError as error:
        raise Malformed(f"a key is missing: {error.message}") from error


def write_whole(target, text):
    """Writes a text as a whole file or not at all. Ends the program if it cannot be written."""
    try:
        with output_file.written(target) as made, open(made, "w", encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        sys.exit(f"{target}: {error.strerror}")
