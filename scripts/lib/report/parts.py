# SPDX-License-Identifier: MIT
"""What the report's pages have in common: their look, tables, the frame of a document."""

import os
import sys
from html import escape

sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import output_file  # noqa: E402 # pylint: disable=wrong-import-position

STYLE = """
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, sans-serif; color: #1a1a1a; background: #fff;
       max-width: 78rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.6rem; line-height: 1.2; } h2 { margin-top: 2.5rem; border-top: 1px solid #bbb;
     padding-top: 1rem; }
p, ul, dl { max-width: 46rem; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 0 1rem; }
dt { color: #555; } dd { margin: 0; overflow-wrap: anywhere; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 22rem), 1fr));
           gap: 1.5rem 1rem; }
figure { margin: 0; } figure svg { width: 100%; height: auto; }
figcaption { font-size: .9rem; color: #333; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
.caption { font-size: .9rem; }
th, td { padding: .15rem .5rem; text-align: right; white-space: nowrap; }
th { white-space: normal; vertical-align: bottom; border-bottom: 1px solid #888; font-weight: 600; }
th.text, td.text { text-align: left; }
tbody tr:nth-child(even) { background: #f4f4f4; } td.range { color: #555; }
tr.ours td.text { font-weight: 600; }
td.wrong { background: #f7d4c8; } td.prose { white-space: normal; min-width: 16rem; text-align: left; }
th.prose { text-align: left; }
@media print {
  body { font-size: 9pt; padding: 0; max-width: none; } table { font-size: 6.5pt; }
  th, td { padding: .05rem .25rem; } .scroll { overflow: visible; }
  .figures { display: block; } figure { display: inline-block; width: 49%; }
  figure, tr { break-inside: avoid; } h2, h2 + p { break-after: avoid; }
}
"""


def _classes(*names):
    text = " ".join(filter(None, names))
    return f' class="{text}"' if text else ""


def table(caption, head, lines):
    """`head`: (title, class); `lines`: (class of the row, cells). A cell is a text, or (text, a
    class on top of that of the column)."""
    cells = "".join(f"<th scope=\"col\"{_classes(kind)}>{escape(title)}</th>"
                    for title, kind in head)
    body = ""
    for row_class, values in lines:
        columns = ""
        for value, (_, kind) in zip(values, head, strict=True):
            text, more = (value, "") if isinstance(value, str) else value
            columns += f"<td{_classes(kind, more)}>{escape(text)}</td>"
        body += f'<tr class="{row_class}">{columns}</tr>\n'
    return (f'<p class="caption">{caption}</p>\n<div class="scroll"><table>'
            f"<thead><tr>{cells}</tr></thead>\n<tbody>\n{body}</tbody></table></div>\n")


def document(title, body):
    """A whole page with all that it needs in it. `body` is HTML."""
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(title)}</title>
<style>{STYLE}</style>
</head>
<body>
<h1>{escape(title)}</h1>
{body.strip()}
</body>
</html>
"""


def write_whole(target, text):
    """There is a whole file or none. Ends the program if it cannot be written."""
    try:
        with output_file.written(target) as made, open(made, "w", encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        sys.exit(f"{target}: {error.strerror}")
