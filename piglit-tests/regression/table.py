#!/usr/bin/env python3
# Copyright © 2026 The mesa-kbuffer authors
# SPDX-License-Identifier: MIT
"""table.py OUT.html TITLE JUDGEMENT.json...

Makes a page of what compare.py found out: the totals of each driver, on stock Mesa and on ours, and
every difference."""
import os
import sys

from compare import FAILURES, STATUSES

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../scripts/lib'))
from report import documents, render  # noqa: E402 # pylint: disable=wrong-import-position


def totals(judgements):
    head = [('driver', 'text'), ('Mesa', 'text'), ('tests', ''), *((s, '') for s in STATUSES)]
    lines = [('', [j['driver'], side, str(j['tests']), *(str(j[side].get(s, 0)) for s in STATUSES)])
             for j in judgements for side in ('stock', 'ours')]
    return render.table('', head, lines)


def differences(judgements):
    head = [('driver', 'text'), ('verdict', 'text'), ('test', 'prose'), ('stock', 'text'),
            ('ours', 'text')]
    lines = [('failure' if r['verdict'] in FAILURES else '',
              [j['driver'], r['verdict'], r['name'], ' '.join(r['stock']), ' '.join(r['ours'])])
             for j in judgements for r in j['rows']]
    return render.table('', head, lines)


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    out, heading, *paths = sys.argv[1:]
    judgements = []
    for path in paths:
        try:
            judgements.append(documents.read(path))
        except (OSError, documents.Malformed) as error:
            sys.exit(f'{path}: {documents.reason(error)}')
    try:
        page = render.page('regression', heading=heading, judgements=judgements,
                           totals=totals(judgements), differences=differences(judgements))
    except KeyError as error:
        sys.exit(f'{" ".join(paths)}: there is no {error}')
    except documents.Malformed as error:
        sys.exit(f'{" ".join(paths)}: {error}')
    render.write_whole(out, page)


main()
