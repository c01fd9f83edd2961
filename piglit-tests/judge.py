#!/usr/bin/env python3
# Copyright © 2026 The mesa-kbuffer authors
# SPDX-License-Identifier: MIT
"""judge.py [--whole] RUN RESULTS_DIR KNOWN_DIR

Compares the results of a piglit run with what is expected and prints

    RUN: N passed, N failed, N skipped

after a line for each result that is not as expected. The unit is the subtest,
or the test where it has none. Expected is

  - `pass`;
  - of tests named expect-STATUS-* exactly that STATUS, of each of their subtests but
    one that is named `passes`;
  - what KNOWN_DIR's failures.txt and skips.txt list: `fail` and `skip`. Where
    flakes.txt lists it, a failure is reported but counts as a skip.

A line of the lists is `WHERE TEST[@SUBTEST]  # reason`; WHERE is a word of RUN,
whose words are separated by dashes: a driver, a kind of context. A skip that is
not listed is a failure, as an extension that is missing must not look like
success; so is what is listed and not run, for all tests with --whole, else for
the subtests of those that were run. Exit status 1 if something failed."""
import argparse
import json
import os
import sys

LISTS = {'failures.txt': 'fail', 'skips.txt': 'skip', 'flakes.txt': 'flake'}


def load_known(directory, run):
    """{name: status} of the lines that are about this run"""
    known = {}
    for list_name, status in LISTS.items():
        with open(os.path.join(directory, list_name), encoding='utf-8') as file:
            for line in file:
                words = line.split('#')[0].split()
                if words:
                    where, name = words
                    if where in run.split('-'):
                        known[name] = status
    return known


def load_results(directory):
    """Yields (name, status); name is test or test@subtest."""
    with open(os.path.join(directory, 'results.json'), encoding='utf-8') as file:
        tests = json.load(file)['tests']
    for path, test in tests.items():
        name = path.split('@')[-1]
        subtests = {k: v for k, v in (test.get('subtests') or {}).items()
                    if k != '__type__'}
        for subtest, status in subtests.items():
            yield name + '@' + subtest, status
        # A crash between two subtests shows only in the test's own status, an end in the middle
        # that the test itself reports only in the exit status.
        if test['result'] not in subtests.values():
            yield name, test['result']
        elif test.get('returncode') and set(subtests.values()) <= {'pass', 'skip'}:
            yield name, 'fail'


def expectation(name, known):
    """The status that a result has to have, and the line of the lists that says so"""
    test = name.split('@')[0]
    for key in (name, test):
        if key in known:
            return known[key], key
    if test.startswith('expect-') and not name.endswith('@passes'):
        return test.split('-')[1], None
    return 'pass', None


def judge(run, results, known, whole):
    """The counts, and a line for each result that is not as expected"""
    counts = {'passed': 0, 'failed': 0, 'skipped': 0}
    lines = []
    seen = set()
    tests_seen = set()
    for name, status in sorted(results):
        wanted, key = expectation(name, known)
        seen.add(key)
        tests_seen.add(name.split('@')[0])
        if wanted == 'flake' and status in ('pass', 'fail'):
            outcome = 'passed' if status == 'pass' else 'skipped'
            if status == 'fail':
                lines.append(f'{name}: fail, a known flake')
        elif status != wanted:
            outcome = 'failed'
            lines.append(f'{name}: {status}, expected {wanted}')
        elif key and status == 'skip':
            outcome = 'skipped'
        else:
            outcome = 'passed'
        counts[outcome] += 1
    for name in sorted(set(known) - seen):
        if whole or name.split('@')[0] in tests_seen:
            counts['failed'] += 1
            lines.append(f'{name}: listed but not run')
    if counts['passed'] == 0:
        counts['failed'] += 1
        lines.append('nothing passed')
    return counts, [f'  {run}: {line}' for line in lines]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--whole', action='store_true')
    parser.add_argument('run')
    parser.add_argument('results')
    parser.add_argument('known')
    arguments = parser.parse_args()
    counts, lines = judge(arguments.run, load_results(arguments.results),
                          load_known(arguments.known, arguments.run), arguments.whole)
    for line in lines:
        print(line)
    print(f'{arguments.run}: ' + ', '.join(f'{n} {what}' for what, n in counts.items()))
    sys.exit(1 if counts['failed'] else 0)


if __name__ == '__main__':
    main()
