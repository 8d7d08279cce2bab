#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""coverage_summary.py COVERAGE.json: lines run, of all of src and of its groups, from what gcovr --json wrote."""
import json
import re
import sys

GROUPS = {
    'src': r'src/',
    'training core': r'src/engine/reconstruct/geometry/|src/core/math/(volume|loss)\.h',
    'shading': r'src/engine/render/|src/core/math/(brdf|sg|shading)\.h',
}


def files_of(path):
    """Lines run and lines in all by file."""
    counts = {}
    for file in json.load(open(path))['files']:
        run = {}
        for line in file['lines']:
            if not line.get('gcovr/noncode'):
                run[line['line_number']] = run.get(line['line_number'], False) or line['count'] > 0
        if run:
            counts[file['file']] = (sum(run.values()), len(run))
    return counts


def main(path):
    counts = files_of(path)
    folders = sorted({'/'.join(f.split('/')[:3]) + '/' for f in counts})
    for name, pattern in [*GROUPS.items(), *((f, re.escape(f)) for f in folders)]:
        chosen = [c for f, c in counts.items() if re.match(pattern, f)]
        run, total = sum(c[0] for c in chosen), sum(c[1] for c in chosen)
        print(f'{name:32} {100 * run / max(total, 1):5.1f} %   {run} of {total} lines')
    print('\nMost lines not run:')
    for file, (run, total) in sorted(counts.items(), key=lambda f: f[1][0] - f[1][1])[:25]:
        print(f'{total - run:6} of {total:5}   {file}')


main(sys.argv[1])
