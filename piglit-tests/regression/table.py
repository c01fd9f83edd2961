#!/usr/bin/env python3
# Copyright © 2026 The mesa-kbuffer authors
# SPDX-License-Identifier: MIT
"""table.py OUT.html TITLE JUDGEMENT.json...

A page of what compare.py found out: totals for each driver and side, and every
difference."""
import json
import os
import sys
from html import escape

from compare import FAILURES, STATUSES

STYLE = '''
body { font: 16px/1.5 system-ui, sans-serif; max-width: 70rem; margin: 0 auto; padding: 1rem; }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
th, td { padding: .15rem .5rem; text-align: left; vertical-align: top; overflow-wrap: anywhere; }
th { border-bottom: 1px solid #888; } td.number { text-align: right; }
tbody tr:nth-child(even) { background: #f4f4f4; } tr.failure td { font-weight: 600; }
'''


def row(cells, kind=''):
    texts = ''.join(f'<td{" class=number" if isinstance(c, int) else ""}>{escape(str(c))}</td>'
                    for c in cells)
    return f'<tr{f" class={kind}" if kind else ""}>{texts}</tr>'


def table(heads, rows):
    heads = ''.join(f'<th>{escape(h)}</th>' for h in heads)
    return f'<table><thead><tr>{heads}</tr></thead><tbody>{"".join(rows)}</tbody></table>'


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    out, heading = sys.argv[1:3]
    judgements = []
    for path in sys.argv[3:]:
        with open(path, encoding='utf-8') as file:
            judgements.append(json.load(file))
    totals = [row([j['driver'], side, j['tests'], *(j[side].get(s, 0) for s in STATUSES)])
              for j in judgements for side in ('stock', 'ours')]
    differences = [row([j['driver'], r['verdict'], r['name'], ' '.join(r['stock']),
                        ' '.join(r['ours'])], 'failure' if r['verdict'] in FAILURES else '')
                   for j in judgements for r in j['rows']]
    counts = '; '.join(f"{j['driver']}: {j['passed']} pass on both, {j['failed']} are worse on ours"
                       for j in judgements)
    page = (f'<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>{escape(heading)}</title>'
            f'<style>{STYLE}</style><h1>{escape(heading)}</h1>'
            f'<p>Tests of piglit on stock Mesa and on ours (with the extensions, which the tests '
            f'do not use). Results of tests and subtests: {counts}.</p>'
            + table(['driver', 'Mesa', 'tests', *STATUSES], totals)
            + '<h2>Differences</h2>'
            + (table(['driver', 'verdict', 'test', 'stock', 'ours'], differences) if differences
               else '<p>None.</p>')
            + '<p>Where there are several results, the first is that of the whole run, the others '
            'are those of runs again that tell a flake from a regression.</p></html>\n')
    with open(out + '.new', 'w', encoding='utf-8') as file:
        file.write(page)
    os.replace(out + '.new', out)


main()
