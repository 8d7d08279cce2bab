#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""bench/compare on reports whose changes are known."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

COMPARE = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'compare')


def figure(name, median, deviation=0.0, better='higher', group='kernels', subject='', of=None):
    return dict(name=name, median=median, deviation=deviation, better=better, group=group, subject=subject,
                of={'peak': 0.5} if of is None else of, unit='x', best=median, repeats=9)


class Compare(unittest.TestCase):
    def compare(self, before, after, *options):
        with tempfile.TemporaryDirectory() as folder:
            paths = []
            for name, figures in (('a', before), ('b', after)):
                paths.append(os.path.join(folder, name))
                with open(paths[-1], 'w', encoding='utf-8') as f:
                    f.write(figures if isinstance(figures, str) else json.dumps({'figures': figures}))
            return subprocess.run([sys.executable, COMPARE, *paths, *options], capture_output=True, text=True)

    def test_the_same_report_has_not_moved(self):
        a = [figure('k', 100, 1), figure('t', 2, 0.1, 'lower')]
        r = self.compare(a, a)
        self.assertEqual(r.returncode, 0)
        self.assertNotIn('faster', r.stdout)

    def test_direction(self):
        up, down = [figure('k', 100)], [figure('k', 80)]
        self.assertEqual(self.compare(up, down).returncode, 1)
        self.assertIn('faster', self.compare(down, up).stdout)
        up, down = [figure('t', 100, better='lower')], [figure('t', 80, better='lower')]
        self.assertIn('faster', self.compare(up, down).stdout)
        self.assertEqual(self.compare(down, up).returncode, 1)

    def test_noise_is_three_standard_deviations_of_both(self):
        # sqrt(2) * 3 * 1.4826 = 6.29: that many percent for deviations of one percent
        a = [figure('k', 100, 1)]
        self.assertEqual(self.compare(a, [figure('k', 94, 1)]).returncode, 0)
        self.assertEqual(self.compare(a, [figure('k', 93, 1)]).returncode, 1)
        self.assertEqual(self.compare(a, [figure('k', 94, 1)], '--sigmas', '2').returncode, 1)

    def test_the_drift_of_the_machine_is_allowed_for(self):
        peak = lambda v: figure('peak', v, group='machine', of={})
        self.assertEqual(self.compare([figure('k', 100)], [figure('k', 92)]).returncode, 1)
        r = self.compare([peak(10), figure('k', 100)], [peak(9), figure('k', 92)])
        self.assertEqual(r.returncode, 0)
        self.assertIn('drifted by 10.0 %', r.stdout)

    def test_other_subjects_are_not_compared(self):
        r = self.compare([figure('k', 100, subject='spot')], [figure('k', 10, subject='lego')])
        self.assertEqual(r.returncode, 0)
        self.assertIn('only before: spot', r.stdout)
        self.assertIn('only after: lego', r.stdout)

    def test_bad_files(self):
        for text in ('', '[]', '{"figures": [{}]}', '{"figures": 3}', '{"figures": [{"name": "k", "median": NaN}]}'):
            r = self.compare([figure('k', 1)], text)
            self.assertEqual(r.returncode, 2, text)
            self.assertNotIn('Traceback', r.stderr)
        self.assertEqual(subprocess.run([sys.executable, COMPARE, '/none', '/none'], capture_output=True).returncode, 2)


if __name__ == '__main__':
    unittest.main()
