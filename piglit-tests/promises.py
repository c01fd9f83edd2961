#!/usr/bin/env python3
# Copyright © 2026 The mesa-kbuffer authors
# SPDX-License-Identifier: MIT
"""promises.py PROMISES.md RESULTS_DIR

Every test and subtest that PROMISES.md names was run, and every test that was
run, but those of the tester, is named. Prints what is not so and last
`promises: N passed, N failed, N skipped`."""
import re
import sys

import judge


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding='utf-8') as file:
        named = set(re.findall(r'`((?:kbuffer|peel)-[a-z0-9-]+(?:@[a-z0-9_-]+)?)`', file.read()))
    run = {name for name, _ in judge.load_results(sys.argv[2])}
    tests = {name.split('@')[0] for name in run}
    bad = [f'{name}: in the list, but was not run' for name in sorted(named - run - tests)]
    bad += [f'{test}: proves no promise of the list'
            for test in sorted(tests - {name.split('@')[0] for name in named})
            if not test.startswith('expect-')]
    for line in bad:
        print('  promises: ' + line)
    print(f'promises: {len(named | tests) - len(bad)} passed, {len(bad)} failed, 0 skipped')
    sys.exit(1 if bad else 0)


main()
