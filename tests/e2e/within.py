#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""within.py FOLDER FOLDER: the PNGs of the first folder are in the second, too, and differ by 1/255 at most."""
import pathlib
import struct
import sys
import zlib


def chunks(data):
    at = 8
    while at < len(data):
        length, kind = struct.unpack('>I4s', data[at:at + 8])
        yield kind, data[at + 8:at + 8 + length]
        at += length + 12


def unfiltered(kind, row, above, step):
    """The bytes of a row; PNG specification, section 9."""
    row = bytearray(row)
    for i in range(len(row)):
        a = row[i - step] if i >= step else 0
        b, c = above[i], above[i - step] if i >= step else 0
        nearest = min((a, b, c), key=lambda v: abs(a + b - c - v))
        row[i] = row[i] + (0, a, b, (a + b) // 2, nearest)[kind] & 255
    return row


def read_png(path):
    """Size, and samples in [0, 1]; not interlaced, 8 or 16 bit."""
    data = path.read_bytes()
    parts = list(chunks(data))
    width, height, depth, color = struct.unpack('>IIBB', parts[0][1][:10])
    sample = depth // 8
    step = {0: 1, 2: 3, 4: 2, 6: 4}[color] * sample
    raw = zlib.decompress(b''.join(body for kind, body in parts if kind == b'IDAT'))
    above, samples = bytes(width * step), []
    for y in range(height):
        at = y * (width * step + 1)
        above = unfiltered(raw[at], raw[at + 1:at + 1 + width * step], above, step)
        samples += [int.from_bytes(above[i:i + sample], 'big') / (256**sample - 1) for i in range(0, len(above), sample)]
    return (width, height, step), samples


def main(first, second):
    pictures = sorted(pathlib.Path(first).rglob('*.png'))
    if not pictures:
        sys.exit(f'no pictures in {first}')
    for path in pictures:
        size, a = read_png(path)
        other_size, b = read_png(pathlib.Path(second) / path.relative_to(first))
        if size != other_size:
            sys.exit(f'{path}: another size')
        worst = max(abs(x - y) for x, y in zip(a, b))
        if worst > 1.001 / 255:
            wrong = sum(abs(x - y) > 1.001 / 255 for x, y in zip(a, b))
            sys.exit(f'{path}: {wrong} of {len(a)} values differ, by up to {255 * worst:.1f}/255')


main(*sys.argv[1:])
