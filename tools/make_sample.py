#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes samples/spot from the full-size ground-truth scene of Spot (256 px, 100 training views).

make_sample.py SCENE OUT

Pictures are averaged over areas in linear light, weighted by alpha; masks keep pixels that are covered by half or more;
normals are averaged and normalized. Needs python3-numpy and python3-pil. The program itself needs neither.
"""
import json
import os
import sys

import numpy as np
from PIL import Image

from srgb import linear_from_srgb, srgb_from_linear

SIZE = 192
TRAIN = range(1, 100, 2)                       # of the scene's 100; 55 is the painted one
TEST = [4, 6, 12, 20, 26, 28, 34, 36]          # of the scene's 40: those with a truth for paint and for light
LIGHT, LIGHT_SIZE = 'venice', (128, 64)


def weights(n, m):
    """m x n matrix that averages n texels to m by area."""
    edges = np.arange(m + 1) * n / m
    lo, hi = np.arange(n), np.arange(n) + 1
    overlap = np.clip(np.minimum(edges[1:, None], hi) - np.maximum(edges[:-1, None], lo), 0, None)
    return overlap * m / n


def shrink(a, width, height):
    return np.einsum('yj,jic,xi->yxc', weights(a.shape[0], height), a, weights(a.shape[1], width), optimize=True)


def read(path):
    return np.asarray(Image.open(path)).astype(np.float64) / 255


def write(path, a):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    Image.fromarray(np.round(np.clip(a, 0, 1) * 255).astype(np.uint8).squeeze()).save(path, optimize=True)


def color(source, target):
    a = read(source)
    premultiplied = np.concatenate([linear_from_srgb(a[..., :3]) * a[..., 3:], a[..., 3:]], 2)
    p = shrink(premultiplied, SIZE, SIZE)
    alpha = np.round(p[..., 3:] * 255) / 255
    straight = srgb_from_linear(p[..., :3] / np.maximum(p[..., 3:], 1e-9))
    write(target, np.concatenate([np.where(alpha > 0, straight, 0), alpha], 2))


def mask(source, target):
    write(target, shrink(read(source)[..., None], SIZE, SIZE) >= 0.5)


def normal(source, target):
    a = read(source)[..., :3]                  # PIL keeps the high byte of 16-bit pictures: 0.2 degrees
    hit = a.sum(2, keepdims=True) > 0
    p = shrink(np.concatenate([(a * 2 - 1) * hit, hit], 2), SIZE, SIZE)
    n = p[..., :3] / np.maximum(np.linalg.norm(p[..., :3], axis=2, keepdims=True), 1e-9)
    write(target, np.where(p[..., 3:] >= 0.5, (n + 1) / 2, 0))


def read_hdr(path):
    """Radiance RGBE: flat, or run-length coded by scanline and channel."""
    raw = open(path, 'rb').read()
    at = raw.index(b'\n\n') + 2
    end = raw.index(b'\n', at)
    _, h, _, w = raw[at:end].split()
    h, w, at = int(h), int(w), end + 1
    rows = np.zeros((h, 4, w), np.uint8)
    for y in range(h):
        if raw[at:at + 2] != b'\x02\x02':
            rows[y] = np.frombuffer(raw, np.uint8, 4 * w, at).reshape(w, 4).T
            at += 4 * w
            continue
        at += 4
        for c in range(4):
            x = 0
            while x < w:
                n = raw[at]
                run = n > 128
                n = n - 128 if run else n
                rows[y, c, x:x + n] = raw[at + 1] if run else np.frombuffer(raw, np.uint8, n, at + 1)
                at += 2 if run else 1 + n
                x += n
    rgbe = rows.transpose(0, 2, 1).astype(np.float64)
    return rgbe[..., :3] * np.where(rgbe[..., 3:] > 0, 2.0 ** (rgbe[..., 3:] - 136), 0)


def write_hdr(path, a):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    mantissa, exponent = np.frexp(np.maximum(a.max(2), 1e-30))
    scale = mantissa * 256 / np.maximum(a.max(2), 1e-30)
    rgbe = np.dstack([a * scale[..., None], exponent + 128]).astype(np.uint8)
    with open(path, 'wb') as f:
        f.write(b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n' % a.shape[:2])
        f.write(rgbe.tobytes())


def split(scene, out, name, views):
    t = json.load(open(os.path.join(scene, f'transforms_{name}.json')))
    scale = SIZE / t['w']
    t.update(w=SIZE, h=SIZE, fl_x=t['fl_x'] * scale, fl_y=t['fl_y'] * scale, cx=t['cx'] * scale, cy=t['cy'] * scale)
    t['frames'] = [t['frames'][v] for v in views]
    json.dump(t, open(os.path.join(out, f'transforms_{name}.json'), 'w'), indent=1)
    for v in views:
        color(f'{scene}/{name}/r_{v:03d}.png', f'{out}/{name}/r_{v:03d}.png')


def main(scene, out):
    os.makedirs(out, exist_ok=True)
    split(scene, out, 'train', TRAIN)
    split(scene, out, 'test', TEST)
    paint = json.load(open(scene + '/edits/paint/view.json'))
    color(scene + '/edits/paint/scribble.png', out + '/edits/paint/scribble.png')
    json.dump(dict(view=paint['view'], colors_srgb=paint['colors_srgb'], gt_test_views=TEST),
              open(out + '/edits/paint/view.json', 'w'), indent=1)
    for v in TEST:
        name = f'r_{v:03d}.png'
        color(f'{scene}/gt/albedo/{name}', f'{out}/gt/albedo/{name}')
        normal(f'{scene}/gt/normal/{name}', f'{out}/gt/normal/{name}')
        color(f'{scene}/edits/paint/gt/{name}', f'{out}/edits/paint/gt/{name}')
        mask(f'{scene}/edits/paint/mask/{name}', f'{out}/edits/paint/mask/{name}')
        color(f'{scene}/edits/relight/{LIGHT}/{name}', f'{out}/edits/relight/{LIGHT}/{name}')
    write_hdr(f'{out}/envs/{LIGHT}.hdr', shrink(read_hdr(f'{scene}/envs/{LIGHT}.hdr'), *LIGHT_SIZE))


if len(sys.argv) != 3:
    sys.exit(__doc__)
main(sys.argv[1].rstrip('/'), sys.argv[2].rstrip('/'))
