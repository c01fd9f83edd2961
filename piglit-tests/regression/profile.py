#!/usr/bin/env python3
# Copyright © 2026 The mesa-kbuffer authors
# SPDX-License-Identifier: MIT
"""profile.py META_PROFILE INCLUDE EXCLUDE SHORT OUT.xml.gz

Writes a profile for piglit's runner of those tests of META_PROFILE (piglit's
quick.meta.xml) that match a regular expression of the file INCLUDE and one of
SHORT (all do if that is empty), and none of EXCLUDE, as `piglit run -t -x` would.
Same tests, same bytes: the file's checksum names the list.  Prints how many
they are."""
import gzip
import os
import re
import sys
import xml.etree.ElementTree as et


def load_patterns(path):
    """A function that tells whether a name matches one of the file's lines."""
    with open(path, encoding='utf-8') as file:
        lines = [line.rstrip('\n') for line in file]
    patterns = [line for line in lines if line and not line.startswith('#')]
    if not patterns:
        sys.exit(f'{path}: no regular expressions')
    try:
        compiled = [re.compile(p, re.IGNORECASE) for p in patterns]
    except re.error as error:
        sys.exit(f'{path}: {error.pattern}: {error}')
    return lambda name: any(c.search(name) for c in compiled)


def all_tests(meta):
    """The <Test> elements of the profiles that a meta profile names."""
    for part in et.parse(meta).iter('Profile'):
        path = os.path.join(os.path.dirname(meta), part.text + '.xml.gz')
        with gzip.open(path) as file:
            yield from et.parse(file).iter('Test')


def main():
    if len(sys.argv) != 6:
        sys.exit(__doc__)
    meta, include, exclude, short, out = sys.argv[1:]
    included, excluded = load_patterns(include), load_patterns(exclude)
    in_short = load_patterns(short) if short else lambda name: True
    tests = [t for t in all_tests(meta)
             if included(t.get('name')) and in_short(t.get('name'))
             and not excluded(t.get('name'))]
    if not tests:
        sys.exit(f'no test of {meta} matches')
    root = et.Element('PiglitTestList', count=str(len(tests)), name='regression')
    root.extend(tests)
    # No time in the header: the bytes depend on the tests alone.
    with open(out, 'wb') as file, gzip.GzipFile('', 'wb', fileobj=file, mtime=0) as packed:
        et.ElementTree(root).write(packed, encoding='utf-8', xml_declaration=True)
    print(len(tests))


main()
