#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_layers.py on source trees of a few lines whose faults are known."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True  # no __pycache__ in the repository
from check_layers import problems, read_rules

LAYERS = """
core/base:
engine/low: core/base
engine/middle: core/* engine/* | core/base
engine/high: engine/*
<png.h: PNG::PNG: src/engine/low/png_file.cpp
"""
# Every permission is used here.
FINE = {
    'core/base/error.h': '',
    'engine/low/a.cpp': '#include "core/base/error.h"',
    'engine/low/png_file.cpp': '#include <png.h>',
    'engine/middle/b.cpp': '#include "core/base/error.h"\n#include "engine/low/a.h"',
    'engine/high/c.cpp': '#include "engine/middle/b.h"',
}


class CheckLayers(unittest.TestCase):
    def found(self, changed):
        with tempfile.TemporaryDirectory() as root:
            for name, text in {**{'src/' + n: t for n, t in (FINE | changed).items()}, 'layers.txt': LAYERS}.items():
                path = Path(root, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return list(problems(root, *read_rules(Path(root, 'layers.txt'))))

    def test_nothing_is_wrong(self):
        self.assertEqual(self.found({}), [])

    def test_a_pattern_stands_for_the_modules_above_its_line(self):
        self.assertEqual(self.found({'engine/middle/d.cpp': '#include "engine/high/c.h"'}),
                         ['src/engine/middle/d.cpp:1: engine/middle may not include engine/high (engine/high/c.h)'])

    def test_a_permission_nobody_uses(self):
        self.assertEqual(self.found({'engine/low/a.cpp': ''}), ['tools/layers.txt: engine/low does not use core/base'])

    def test_a_permission_that_a_test_header_needs(self):
        self.assertEqual(self.found({'engine/middle/b.cpp': '#include "engine/low/a.h"',
                                     'engine/middle/b_test.cpp': '#include "engine/low/test_a.h"',
                                     'engine/low/test_a.h': '#include "core/base/error.h"'}), [])

    def test_a_module_that_is_not_listed(self):
        self.assertEqual(self.found({'engine/new/e.h': ''}), ['src/engine/new: not listed in tools/layers.txt'])

    def test_an_option_in_a_sentence(self):
        self.assertEqual(self.found({'engine/low/g.cpp': 'fail("Give `cei3d --all`, or --some of it.");'}),
                         ['src/engine/low/g.cpp:1: a sentence names the option --some, which only apps know'])

    def test_a_third_party_elsewhere(self):
        self.assertEqual(self.found({'engine/low/f.h': '#include <png.h>'}),
                         ['src/engine/low/f.h:1: <png.h> belongs behind src/engine/low/png_file.cpp'])


if __name__ == '__main__':
    unittest.main()
