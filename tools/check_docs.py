#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks what comments and documents refer to: [Author Year] has an entry in docs/references.md, a link to a file or
to a heading leads somewhere, nothing cites a document outside the repository, the figures in README.md are those of
docs/results.md, and lines of documents are not too long. Prints each fault; exit code 1."""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SOURCES = [p for folder in ('src', 'tests', 'tools', 'bench', 'cmake') for p in (ROOT / folder).rglob('*')
           if p.suffix in ('.h', '.cpp', '.cu', '.py', '.sh', '.cmake') and p.resolve() != Path(__file__).resolve()]
DOCUMENTS = [*ROOT.glob('*.md'), *(ROOT / 'docs').rglob('*.md'), *(ROOT / 'samples').rglob('*.md'),
             *(ROOT / '.github').rglob('*.md')]

CITATION = re.compile(r'\[([^][(){}]*\b(?:1[89]|20)\d\d\b[^][]*)\]')
KEY = re.compile(r"[A-Z][\w'-]+(?: et al\.| and [A-Z][\w'-]+)? (?:1[89]|20)\d\d")
OUTSIDE = re.compile(r'\barchitecture \d\.\d|reference-facts|prototype-findings|goals\.md|\bmeasure\.py|\.\./shared')
HEADING_LINK = re.compile(r'(docs/[\w/-]+\.md)(#[\w-]+)?')
NUMBERED = re.compile(r'\b(decisions|notebook)/(\d{4})')
MARKDOWN_LINK = re.compile(r'\]\(([^)#\s]*)(#[^)\s]*)?\)')
COLUMNS = 130  # at most, except in tables, pictures and indented code
# Of .github because GitHub shows each line of a template as a line.
WIDER = ['docs/notebook', '.github']
NUMBER = re.compile(r'\d*\.\d+|\d+')
# What the rows of README's table begin with, and the row or column of docs/results.md that has their figures.
README_ROWS = {'spot': 'spot', 'kettle': 'kettle', 'DTU scan 24': 'dtu24', 'paint edit': 'paint',
               'change of roughness': 'roughness, on white'}


def anchor(heading):
    """The anchor that GitHub gives a heading."""
    return '#' + re.sub(r'[^\w\- ]', '', heading.strip().lower()).replace(' ', '-')


def anchors(path):
    return {anchor(line.lstrip('#')) for line in path.read_text().splitlines() if line.startswith('#')}


def target_fault(path, heading):
    if not path.exists():
        return f'no {path.name}'
    if heading and path.suffix == '.md' and heading not in anchors(path):
        return f'{path.name} has no heading {heading}'
    return None


def source_faults(path, keys):
    # A citation may go on in the next comment line.
    text = re.sub(r'\n\s*(?://|#) ?', ' ', path.read_text())
    for citation in CITATION.findall(text):
        for key in KEY.findall(citation):
            if key not in keys:
                yield f'[{key}] is not in docs/references.md'
    for match in OUTSIDE.findall(text):
        yield f'{match!r} is not in the repository'
    for name, heading in HEADING_LINK.findall(text):
        if fault := target_fault(ROOT / name, heading):
            yield fault
    yield from numbered_faults(text)


def numbered_faults(text):
    for folder, number in NUMBERED.findall(text):
        if not any((ROOT / 'docs' / folder).glob(f'{number}-*.md')):
            yield f'there is no docs/{folder}/{number}'


def document_faults(path):
    text = path.read_text()
    for name, heading in MARKDOWN_LINK.findall(text):
        if '://' in name:
            continue
        if fault := target_fault((path.parent / name) if name else path, heading):
            yield fault
    for match in OUTSIDE.findall(text):
        yield f'{match!r} is not in the repository'
    yield from numbered_faults(text)
    if not any(path.is_relative_to(ROOT / wider) for wider in WIDER):
        for number, line in enumerate(text.splitlines(), 1):
            if len(line) > COLUMNS and not line.startswith(('|', '![', '    ')):
                yield f'line {number} has {len(line)} columns, more than {COLUMNS}'


def tables(path):
    """Rows of each table: lists of cells, the column heads first."""
    for block in re.findall(r'(?:^\|.*\n)+', path.read_text(), re.M):
        yield [[cell.strip() for cell in line.strip().strip('|').split('|')] for line in block.splitlines()]


def figures_of(name, results):
    """All numbers in the rows and columns of that name."""
    for heads, _, *rows in results:
        for row in rows:
            cells = row[1:] if row[0] == name else [c for head, c in zip(heads, row) if head == name]
            yield from NUMBER.findall(' '.join(cells))


def figure_faults():
    """Each number of README's table is one that docs/results.md gives of the same thing, rounded to as many decimals."""
    results = list(tables(ROOT / 'docs/results.md'))
    for label, text in [(row[0], ' '.join(row)) for row in next(tables(ROOT / 'README.md'))[2:]]:
        name = next((n for n in README_ROWS if label.startswith(n)), None)
        if not name:
            yield f'no row or column of docs/results.md is known for {label!r} (README_ROWS in tools/check_docs.py)'
            continue
        known = list(figures_of(README_ROWS[name], results))
        for number in NUMBER.findall(text.removeprefix(name)):
            decimals = len(number.partition('.')[2])
            if float(number) not in [round(float(k), decimals) for k in known]:
                yield f'{number} is no figure of {README_ROWS[name]!r} in docs/results.md'


def main():
    keys = set(re.findall(r'^\*\*\[([^]]+)\]\*\*', (ROOT / 'docs/references.md').read_text(), re.M))
    faults = [f'{p.relative_to(ROOT)}: {f}' for p in SOURCES for f in source_faults(p, keys)]
    faults += [f'{p.relative_to(ROOT)}: {f}' for p in DOCUMENTS for f in document_faults(p)]
    faults += [f'README.md: {f}' for f in figure_faults()]
    print('\n'.join(sorted(set(faults))) or 'docs: fine')
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
