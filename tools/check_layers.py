#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_layers.py [ROOT]: do the includes below src/ respect tools/layers.txt, is every permission in it used, and do only
the apps name options of the command line? Prints each fault; exit 1."""
import fnmatch
import os
import re
import sys
from pathlib import Path

STRING = re.compile(r'"((?:[^"\\]|\\.)*)"')
OPTION = re.compile(r'(?<![-\w])--[a-z][a-z-]*')
INCLUDE = re.compile(r'\s*#\s*include\s*(?:"([^"]+)"|(<[^>]+>))')


def matching(patterns, modules):
    """What each name or "folder/*" stands for: modules read so far, as in cmake/layers.cmake."""
    return {p: fnmatch.filter(modules, p) for p in patterns}


def read_rules(path):
    """Modules, each with what it and what its tests may include; third parties, each with its files."""
    modules, third_parties = {}, {}
    for line in Path(path).read_text().splitlines():
        line = line.split('#')[0].strip()
        if not line:
            continue
        name, _, rest = line.partition(':')
        if name.startswith('<'):
            third_parties[name] = rest.partition(': ')[2].split()
        else:
            deps, _, test_deps = rest.partition('|')
            modules[name] = matching(deps.split(), modules), matching(test_deps.split(), modules)
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


def includes(root):
    """(file, line, the module's own header or None, the system's header or None) of every include."""
    for path in sources(root):
        for number, line in enumerate(Path(root, path).read_text().splitlines(), 1):
            if match := INCLUDE.match(line):
                yield path, number, *match.groups()


def allows(permissions, module):
    return any(module in below for below in permissions.values())


def forbidden(root, modules, third_parties):
    for path, number, own, system in includes(root):
        module = module_of(path[len('src/'):])
        deps, test_deps = modules.get(module, ({}, {}))
        if own and module_of(own) != module and not (
                allows(deps, module_of(own)) or is_test(path) and allows(test_deps, module_of(own))):
            yield f'{path}:{number}: {module} may not include {module_of(own)} ({own})'
        for prefix, files in third_parties.items():
            if system and system.startswith(prefix) and path not in files:
                yield f'{path}:{number}: {system} belongs behind {", ".join(files)}'


def used_modules(path, own_includes):
    """What a file includes, and what the test headers need that it includes: its program is linked to that, too."""
    for own in own_includes.get(path, ()):
        yield module_of(own)
        if is_test(own):
            yield from used_modules(own, own_includes)


def unused(root, modules):
    own_includes = {}
    for path, _, own, _ in includes(root):
        if own:
            own_includes.setdefault(path[len('src/'):], []).append(own)
    used = {(module_of(path), module) for path in own_includes for module in used_modules(path, own_includes)}
    for module, (deps, test_deps) in modules.items():
        for pattern, below in [*deps.items(), *test_deps.items()]:
            if not any((module, m) in used for m in below):
                yield f'tools/layers.txt: {module} does not use {pattern}'


# Arguments of other programs, and of this one when it calls itself.
OPTIONS_ALLOWED = ('src/apps/', 'src/engine/batch/', 'src/engine/photos/colmap_run.cpp')


def named_options(root):
    """Sentences of the engine reach the editor, too, where options mean nothing; `commands` may be quoted."""
    for path in sources(root):
        if path.startswith(OPTIONS_ALLOWED) or is_test(path):
            continue
        for number, line in enumerate(Path(root, path).read_text().splitlines(), 1):
            for text in STRING.findall(line):
                if match := OPTION.search(re.sub('`[^`]*`', '', text)):
                    yield f'{path}:{number}: a sentence names the option {match.group()}, which only apps know'


def problems(root, modules, third_parties):
    for module in sorted({module_of(path[len('src/'):]) for path in sources(root)} - set(modules)):
        yield f'src/{module}: not listed in tools/layers.txt'
    yield from forbidden(root, modules, third_parties)
    yield from unused(root, modules)
    yield from named_options(root)


def main(root):
    found = list(problems(root, *read_rules(os.path.join(root, 'tools/layers.txt'))))
    print('\n'.join(found) if found else 'layers: fine')
    return 1 if found else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
