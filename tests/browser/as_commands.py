# SPDX-License-Identifier: Apache-2.0
"""as_commands.py PROGRAM EDITED FRESH: makes the edits of a project by commands on a copy of the object, and compares results.

EDITED was edited in the browser, FRESH is the object before that. The objects, by hash, must be the same."""
import json
import pathlib
import subprocess
import sys
import tempfile

program, edited, fresh = sys.argv[1], *map(pathlib.Path, sys.argv[2:4])
scratch = pathlib.Path(tempfile.mkdtemp())


def numbers(values):
    return ','.join(repr(v) for v in values)


def place(params):
    file = scratch / 'camera.json'
    file.write_text(json.dumps({'cameras': [dict(params['camera'], name='own')]}))
    return ['--camera', file]


def paint(folder, params):
    (stroke,) = params['strokes']
    return place(stroke) + ['--scribble', folder / 'scribble.png'] + (['--erase'] if params.get('erase') else [])


def part(folder, params):
    arguments = place(params) + ['--mask', folder / 'mask.png', '--name', params['name']]
    if params.get('in_view'):
        arguments.append('--in-view')
    for key in ('add', 'subtract', 'intersect'):
        if key in params:
            arguments += ['--' + key, params[key]]
    return arguments


def light(_, params):
    sun = params['sun']
    return ['--sun=' + numbers(sun['direction']), '--sun-strength', repr(sun['strength'])]


def deform(_, params):
    handles = [params] + params.get('more', [])
    arguments = ['--radius', repr(params['radius'])]
    for handle in handles:
        arguments += ['--from=' + numbers(handle['from']), '--to=' + numbers(handle['to'])]
        arguments.append('--turn=' + numbers(handle.get('turn', [0, 0, 0])))
    return arguments + ['--pin=' + numbers(pin) for pin in params.get('pins', [])]


def records(project):
    ids = [e['id'] for e in json.loads((project / 'stack.json').read_text())['edits']]
    return [(project / 'edits' / i, json.loads((project / 'edits' / i / 'edit.json').read_text())) for i in ids]


def objects(record):
    return [(r['object'], r['head']) for r in record['results'].values()]


for k, (folder, record) in enumerate(records(edited)):
    arguments = {'paint': paint, 'part': part, 'light': light, 'deform': deform}[record['op']](folder, record['params'])
    subprocess.run([program, 'edit', fresh, record['op'], *arguments, '--quiet'], check=True)
    same = objects(records(fresh)[k][1]) == objects(record)
    print(record['id'] if 'id' in record else folder.name, 'is the same by browser and by command' if same else 'differs')
    if not same:
        sys.exit(f'FAILED: {folder} and {records(fresh)[k][0]} hold different objects')
