#!/usr/bin/env python3
# Copyright © 2026 The mesa-kbuffer authors
# SPDX-License-Identifier: MIT
"""compare.py worse PROFILE STOCK OURS
compare.py judge DRIVER PROFILE FLAKES OUT.json STOCK OURS [STOCK OURS]...

Compares piglit's results on patched Mesa (the folder OURS) with those on stock
Mesa (STOCK).  A result is a test's, or a subtest's (test#subtest), and worse the
further right it stands:

    pass  warn  skip  fail  timeout  crash  missing

`worse` writes a profile of the tests that have a result that is worse on ours,
to be run again, and prints how many they are (the profile's name is PROFILE with
`-again` before `.xml.gz`).

`judge` tells regressions from flakes: the first STOCK and OURS are the run of
the whole PROFILE, the others are runs again.  A regression is what is worse on
ours and was so in a run again, worse than stock ever was; with no runs again,
everything that is worse.  What the list FLAKES names is none.  Prints a line for
each difference and last

    DRIVER: N passed, N failed, N skipped

where passed are the results that pass on both, failed the regressions; the rest,
above all what skips on both, is told before and not counted.  OUT.json gets it
all for the table.  Exit status 1 if something failed."""
import collections
import gzip
import json
import sys
import xml.etree.ElementTree as et

STATUSES = ['pass', 'warn', 'skip', 'fail', 'timeout', 'crash', 'missing']
# What piglit says of a test that the run was cut short in, or did not get to
NO_RESULT = {'incomplete', 'notrun'}
# The verdicts that fail; the others are 'better', 'flake' and 'listed flake'.
FAILURES = {'regression', 'no result', 'no result on stock'}


def rank(status):
    return STATUSES.index(status)


def checked(status, where):
    status = 'missing' if status in NO_RESULT else status
    if status not in STATUSES:
        sys.exit(f"{where}: unknown result '{status}'")
    return status


def load_results(directory):
    """{test: {'': status, subtest: status}}"""
    path = directory + '/results.json'
    try:
        with open(path, encoding='utf-8') as file:
            tests = json.load(file)['tests']
        return {name: {'': checked(test['result'], f'{path}: {name}')}
                | {k: checked(v, f'{path}: {name}')
                   for k, v in (test.get('subtests') or {}).items() if k != '__type__'}
                for name, test in tests.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        sys.exit(f'{path}: no results of piglit: {error!r}')


def load_profile(path):
    """The tests' XML elements by name."""
    try:
        with gzip.open(path) as file:
            return {t.get('name'): t for t in et.parse(file).iter('Test')}
    except (OSError, EOFError, et.ParseError) as error:
        sys.exit(f'{path}: no profile: {error}')


def load_flakes(path):
    """Names; a line reads `name  # reason`, where a name may have spaces and a #."""
    with open(path, encoding='utf-8') as file:
        lines = [line.strip() for line in file if not line.startswith('#')]
    for line in filter(None, lines):
        if '  # ' not in line:
            sys.exit(f'{path}: no reason: {line}')
    return {line.split('  # ')[0] for line in lines if line}


def status_of(results, test, subtest):
    return results.get(test, {}).get(subtest, 'missing')


def is_worse(stock, ours, key):
    return rank(status_of(ours, *key)) > rank(status_of(stock, *key))


def differences(names, stock, ours):
    """Yields (test, subtest) where the results differ.  Of a test that is worse as a whole,
    say by a crash, the subtests that it did not get to are not told one by one."""
    for test in names:
        subtests = (stock.get(test, {}).keys() | ours.get(test, {}).keys()) - {''}
        for subtest in ['', *sorted(subtests)]:
            not_reached = subtest and subtest not in ours.get(test, {})
            if status_of(stock, test, subtest) != status_of(ours, test, subtest) \
                    and not (not_reached and is_worse(stock, ours, (test, ''))):
                yield test, subtest


def is_repeated(stock_runs, ours_again, key):
    """A run again of ours was worse than every run of stock that got to the test."""
    worst = max(rank(status_of(stock, *key)) for stock in stock_runs
                if status_of(stock, key[0], '') != 'missing')
    return any(rank(status_of(ours, *key)) > worst for ours in ours_again)


def title(key):
    return '#'.join(filter(None, key))


def leaves(names, results):
    """(test, subtest) of the subtests, or of the test where it has none"""
    for test in names:
        statuses = results.get(test, {'': 'missing'})
        for subtest in statuses:
            if subtest or len(statuses) == 1:
                yield test, subtest


def write_worse(profile, stock_dir, ours_dir):
    tests = load_profile(profile)
    stock, ours = load_results(stock_dir), load_results(ours_dir)
    names = {key[0] for key in differences(tests, stock, ours) if is_worse(stock, ours, key)}
    root = et.Element('PiglitTestList', count=str(len(names)), name='again')
    root.extend(t for name, t in tests.items() if name in names)
    with gzip.open(profile.removesuffix('.xml.gz') + '-again.xml.gz', 'wb') as file:
        et.ElementTree(root).write(file, encoding='utf-8', xml_declaration=True)
    print(len(names))


def judge(driver, profile, flakes_path, out, *directories):
    names = sorted(load_profile(profile))
    flakes = load_flakes(flakes_path)
    runs = [load_results(d) for d in directories]
    stock_runs, our_runs = runs[0::2], runs[1::2]
    stock, ours = stock_runs[0], our_runs[0]

    rows = [{'name': name, 'verdict': 'no result', 'stock': ['missing'], 'ours': ['missing']}
            for name in names
            if status_of(stock, name, '') == status_of(ours, name, '') == 'missing']
    for key in differences(names, stock, ours):
        if status_of(stock, key[0], '') == 'missing':
            # Its silence would excuse everything.
            verdict = 'no result on stock'
        elif not is_worse(stock, ours, key):
            verdict = 'better'
        elif title(key) in flakes or key[0] in flakes:
            verdict = 'listed flake'
        elif our_runs[1:] and not is_repeated(stock_runs, our_runs[1:], key):
            verdict = 'flake'
        else:
            verdict = 'regression'
        rows.append({'name': title(key), 'verdict': verdict,
                     'stock': [status_of(s, *key) for s in stock_runs],
                     'ours': [status_of(o, *key) for o in our_runs]})

    totals = [collections.Counter(status_of(side, name, '') for name in names)
              for side in (stock, ours)]
    passed = sum(status_of(stock, *key) == status_of(ours, *key) == 'pass'
                 for key in leaves(names, stock))
    failed = sum(row['verdict'] in FAILURES for row in rows)
    for row in rows:
        print(f"  {driver}: {row['verdict']}: {row['name']}: "
              f"stock {' '.join(row['stock'])}, ours {' '.join(row['ours'])}")
    for side, total in zip(('stock', 'ours'), totals):
        print(f'  {driver}, {side}: {len(names)} tests: '
              + ', '.join(f'{total[s]} {s}' for s in STATUSES if total[s]))
    if passed == 0:
        failed += 1
        print(f'  {driver}: nothing passed')
    with open(out, 'w', encoding='utf-8') as file:
        json.dump({'driver': driver, 'tests': len(names), 'passed': passed, 'failed': failed,
                   'stock': totals[0], 'ours': totals[1], 'rows': rows}, file, indent=1)
    print(f'{driver}: {passed} passed, {failed} failed, 0 skipped')
    return 1 if failed else 0


def main():
    arguments = sys.argv[2:]
    if sys.argv[1:2] == ['worse'] and len(arguments) == 3:
        write_worse(*arguments)
    elif sys.argv[1:2] == ['judge'] and len(arguments) >= 6 and len(arguments) % 2 == 0:
        sys.exit(judge(*arguments))
    else:
        sys.exit(__doc__)


if __name__ == '__main__':
    main()
