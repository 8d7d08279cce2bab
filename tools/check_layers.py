#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_layers.py [ROOT]: do the includes below src/ respect tools/layers.txt? Prints every one that does not; exit 1."""
import fnmatch
import os
import re
import sys

INCLUDE = re.compile(r'\s*#\s*include\s*(?:"([^"]+)"|(<[^>]+>))')


def read_rules(path):
    modules, third_parties = {}, {}
    for line in open(path):
        line = line.split('#')[0].strip()
        if not line:
            continue
        name, _, rest = line.partition(':')
        if name.startswith('<'):
            third_parties[name] = rest.partition(': ')[2].split()
        else:
            deps, _, test_deps = rest.partition('|')
            modules[name] = deps.split(), test_deps.split()
    return modules, third_parties


def sources(root):
    for folder, _, files in os.walk(os.path.join(root, 'src')):
        for f in sorted(files):
            if f.endswith(('.h', '.cpp', '.cu')):
                yield os.path.relpath(os.path.join(folder, f), root)


def is_test(path):
    name = os.path.basename(path)
    return name.endswith('_test.cpp') or name.startswith('test_')


def module_of(path):
    return '/'.join(path.split('/')[:2])


def problems(root, modules, third_parties):
    for path in sources(root):
        module = module_of(path[len('src/'):])
        if module not in modules:
            yield f'{path}: module {module} is not listed in tools/layers.txt'
            continue
        deps, test_deps = modules[module]
        allowed = deps + test_deps if is_test(path) else deps
        for number, line in enumerate(open(os.path.join(root, path)), 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            own, system = match.groups()
            if own and module_of(own) != module and not any(fnmatch.fnmatch(module_of(own), m) for m in allowed):
                yield f'{path}:{number}: {module} may not include {module_of(own)} ({own})'
            for prefix, files in third_parties.items():
                if system and system.startswith(prefix) and path not in files:
                    yield f'{path}:{number}: {system} belongs behind {", ".join(files)}'


def main(root):
    found = list(problems(root, *read_rules(os.path.join(root, 'tools/layers.txt'))))
    print('\n'.join(found) if found else 'layers: fine')
    return 1 if found else 0


sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
