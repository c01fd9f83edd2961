#!/usr/bin/env python3
# Copyright © 2026 The mesa-kbuffer authors
# SPDX-License-Identifier: MIT
"""Tests of judge.py: each wrong outcome of a run is a failure, and only that.
Last line: `judge: N passed, N failed, N skipped`."""
import json
import os
import sys
import tempfile
import unittest

import judge


def verdict(results, known=None, whole=False):
    """(passed, failed, skipped)"""
    return tuple(judge.judge('run', results, known or {}, whole)[0].values())


class Verdicts(unittest.TestCase):
    def test_each_status_but_pass_is_a_failure(self):
        for status in ('fail', 'skip', 'crash', 'timeout', 'warn', 'notrun', 'incomplete'):
            self.assertEqual(verdict([('a', 'pass'), ('b@c', status)]), (1, 1, 0), status)

    def test_expected_status_is_met_exactly(self):
        for wanted in ('fail', 'skip', 'crash', 'timeout'):
            for status in ('pass', 'fail', 'skip', 'crash', 'timeout', 'warn', 'notrun'):
                met = status == wanted
                self.assertEqual(
                    verdict([('a', 'pass'), (f'expect-{wanted}-x@y', status)]),
                    (1 + met, 1 - met, 0), f'{status} for {wanted}')
            self.assertEqual(verdict([(f'expect-{wanted}-x@passes', 'pass')]), (1, 0, 0))
            self.assertEqual(verdict([('a', 'pass'), (f'expect-{wanted}-x@passes', wanted)]),
                             (1, 1, 0))

    def test_listed_skip_is_a_skip(self):
        self.assertEqual(verdict([('a', 'pass'), ('b@c', 'skip')], {'b@c': 'skip'}), (1, 0, 1))
        self.assertEqual(verdict([('a', 'pass'), ('b@c', 'skip')], {'b': 'skip'}), (1, 0, 1))
        self.assertEqual(verdict([('a', 'pass'), ('b@c', 'skip')], {'b@d': 'skip'}), (1, 2, 0))

    def test_listed_but_passing_is_a_failure(self):
        self.assertEqual(verdict([('a', 'pass'), ('b', 'pass')], {'b': 'skip'}), (1, 1, 0))
        self.assertEqual(verdict([('a', 'pass'), ('b', 'pass')], {'b': 'fail'}), (1, 1, 0))

    def test_listed_but_not_run_is_a_failure_of_a_whole_run(self):
        self.assertEqual(verdict([('a', 'pass')], {'b': 'skip'}, whole=True), (1, 1, 0))
        self.assertEqual(verdict([('a', 'pass')], {'b': 'skip'}), (1, 0, 0))
        self.assertEqual(verdict([('a@b', 'pass')], {'a@c': 'skip'}), (1, 1, 0))

    def test_flake_may_fail_but_not_crash(self):
        known = {'b': 'flake'}
        self.assertEqual(verdict([('a', 'pass'), ('b', 'pass')], known), (2, 0, 0))
        self.assertEqual(verdict([('a', 'pass'), ('b', 'fail')], known), (1, 0, 1))
        self.assertEqual(verdict([('a', 'pass'), ('b', 'crash')], known), (1, 1, 0))

    def test_nothing_passed_is_a_failure(self):
        self.assertEqual(verdict([]), (0, 1, 0))
        self.assertEqual(verdict([('b', 'skip')], {'b': 'skip'}), (0, 1, 1))


class Files(unittest.TestCase):
    def test_results_of_an_end_after_subtests(self):
        tests = {'spec@x@a': {'result': 'crash', 'returncode': -11,
                              'subtests': {'__type__': 'Subtests', 'b': 'pass'}},
                 'spec@x@c': {'result': 'pass', 'returncode': 0, 'subtests': {'d': 'pass'}},
                 'spec@x@e': {'result': 'skip', 'returncode': 0},
                 'spec@x@f': {'result': 'pass', 'returncode': 1, 'subtests': {'g': 'pass'}},
                 'spec@x@h': {'result': 'fail', 'returncode': 1, 'subtests': {'i': 'fail'}}}
        with tempfile.TemporaryDirectory() as directory:
            with open(directory + '/results.json', 'w', encoding='utf-8') as file:
                json.dump({'tests': tests}, file)
            self.assertEqual(sorted(judge.load_results(directory)),
                             [('a', 'crash'), ('a@b', 'pass'), ('c@d', 'pass'), ('e', 'skip'),
                              ('f', 'fail'), ('f@g', 'pass'), ('h@i', 'fail')])

    def test_lists_by_words_of_the_run(self):
        with tempfile.TemporaryDirectory() as directory:
            for name in judge.LISTS:
                with open(os.path.join(directory, name), 'w', encoding='utf-8') as file:
                    file.write(f'# {name}\n\nsoftpipe {name}@a  # reason\nglx b-{name}\n')
            self.assertEqual(judge.load_known(directory, 'softpipe-osmesa'),
                             {name + '@a': status for name, status in judge.LISTS.items()})
            self.assertEqual(len(judge.load_known(directory, 'softpipe-glx')), 6)
            self.assertEqual(judge.load_known(directory, 'llvmpipe-osmesa'), {})


if __name__ == '__main__':
    outcome = unittest.main(argv=sys.argv[:1], exit=False, verbosity=0).result
    bad = len(outcome.failures) + len(outcome.errors)
    print(f'judge: {outcome.testsRun - bad} passed, {bad} failed, {len(outcome.skipped)} skipped')
    sys.exit(bad > 0)
