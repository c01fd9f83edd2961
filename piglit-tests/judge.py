#!/usr/bin/env python3
# Copyright © 2026 The mesa-kbuffer authors
# SPDX-License-Identifier: MIT
"""judge.py DRIVER RESULTS_DIR LIST...

Compares the results of a piglit run with what is expected and prints

    DRIVER: N passed, N failed, N skipped

after a line for each result that is not as expected.  The unit is the subtest,
or the test where it has none.  Expected is `pass`; for tests named expect-fail-*
`fail`; and what the LISTs say, in lines `name status  # reason`.  A skip that no
list allows is a failure: an extension that is missing must not look like
success.  Exit status 1 if something failed."""
import json
import sys


def load_lists(paths):
    """{name: status}"""
    expected = {}
    for path in paths:
        with open(path, encoding='utf-8') as file:
            for line in file:
                words = line.split('#')[0].split()
                if words:
                    name, status = words
                    expected[name] = status
    return expected


def load_results(directory):
    """Yields (name, status); name is test or test@subtest."""
    with open(directory + '/results.json', encoding='utf-8') as file:
        tests = json.load(file)['tests']
    for path, test in tests.items():
        name = path.split('@')[-1]
        subtests = {k: v for k, v in (test.get('subtests') or {}).items()
                    if k != '__type__'}
        for subtest, status in subtests.items():
            yield name + '@' + subtest, status
        # A crash between two subtests shows only in the test's own status.
        worst = test['result'] not in subtests.values()
        if not subtests or worst:
            yield name, test['result']


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    driver, directory, lists = sys.argv[1], sys.argv[2], sys.argv[3:]
    expected = load_lists(lists)
    counts = {'passed': 0, 'failed': 0, 'skipped': 0}
    seen = set()
    for name, status in sorted(load_results(directory)):
        test = name.split('@')[0]
        default = 'fail' if test.startswith('expect-fail-') else 'pass'
        key = name if name in expected else test
        wanted = expected.get(key, default)
        seen.add(key)
        if status != wanted:
            counts['failed'] += 1
            print(f'  {driver}: {name}: {status}, expected {wanted}')
        elif status == 'skip':
            counts['skipped'] += 1
        else:
            counts['passed'] += 1
    for name in sorted(set(expected) - seen):
        counts['failed'] += 1
        print(f'  {driver}: {name}: listed but not run')
    if counts['passed'] == 0:
        counts['failed'] += 1
        print(f'  {driver}: nothing passed')
    print(f'{driver}: ' + ', '.join(f'{n} {what}'
                                    for what, n in counts.items()))
    sys.exit(1 if counts['failed'] else 0)


main()
