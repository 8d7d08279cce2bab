#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""compare_asset.py ASSET.glb RENDERED [MASKS]: does the base color of an exported asset look like the albedo that
`cei3d render PROJECT -o RENDERED --channels albedo` wrote? A reader and rasterizer of its own; needs NumPy and Pillow.

Prints one line a view and the mean: PSNR of display-encoded colors over the pixels that both cover fully. MASKS: a folder
of gray pictures named like the views; only pixels where they are white count.
"""
import io
import json
import math
import os
import struct
import sys

import numpy as np
from PIL import Image

from srgb import linear_from_srgb, srgb_from_linear

FINE = 4  # samples of a pixel's side


def read_glb(path):
    data = open(path, 'rb').read()
    magic, version, total, size, kind = struct.unpack_from('<IIIII', data, 0)
    assert (magic, version, kind) == (0x46546c67, 2, 0x4e4f534a) and total == len(data), 'not a GLB 2.0'
    gltf = json.loads(data[20:20 + size])
    return gltf, data[28 + size:]


def accessor(gltf, binary, index):
    a = gltf['accessors'][index]
    view = gltf['bufferViews'][a['bufferView']]
    width = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4}[a['type']]
    kind = {5126: np.float32, 5125: np.uint32, 5123: np.uint16}[a['componentType']]
    start = view.get('byteOffset', 0) + a.get('byteOffset', 0)
    return np.frombuffer(binary, kind, a['count'] * width, start).reshape(a['count'], width)


def base_color(gltf, binary):
    texture = gltf['materials'][0]['pbrMetallicRoughness']['baseColorTexture']['index']
    view = gltf['bufferViews'][gltf['images'][gltf['textures'][texture]['source']]['bufferView']]
    start = view.get('byteOffset', 0)
    picture = Image.open(io.BytesIO(binary[start:start + view['byteLength']])).convert('RGB')
    return linear_from_srgb(np.asarray(picture, np.float32) / 255)


def lookup(texture, uv):
    """Bilinear."""
    h, w, _ = texture.shape
    x, y = uv[:, 0] * w - 0.5, uv[:, 1] * h - 0.5
    x0, y0 = np.floor(x).astype(int), np.floor(y).astype(int)
    fx, fy = (x - x0)[:, None], (y - y0)[:, None]
    at = lambda i, j: texture[np.clip(j, 0, h - 1), np.clip(i, 0, w - 1)]
    return (at(x0, y0) * (1 - fx) + at(x0 + 1, y0) * fx) * (1 - fy) + \
        (at(x0, y0 + 1) * (1 - fx) + at(x0 + 1, y0 + 1) * fx) * fy


def project(points, camera):
    """Pixel x, y and depth. The node's rotation is left out: vertices are in the capture's frame."""
    local = (points - np.array(camera['center'])) @ np.array(camera['world_from_cam'])
    return (camera['fx'] * local[:, 0] / local[:, 2] + camera['cx'],
            camera['fy'] * local[:, 1] / local[:, 2] + camera['cy'], local[:, 2])


def visible_triangles(points, triangles, camera):
    """For every sample of the picture: the nearest triangle (-1: none) and its perspective-correct barycentrics."""
    w, h = camera['width'] * FINE, camera['height'] * FINE
    x, y, z = project(points, camera)
    x, y = x * FINE, y * FINE
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    area = (x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a])
    x0 = np.ceil(np.minimum(np.minimum(x[a], x[b]), x[c]) - 0.5).astype(int)
    y0 = np.ceil(np.minimum(np.minimum(y[a], y[b]), y[c]) - 0.5).astype(int)
    x1 = np.floor(np.maximum(np.maximum(x[a], x[b]), x[c]) - 0.5).astype(int)
    y1 = np.floor(np.maximum(np.maximum(y[a], y[b]), y[c]) - 0.5).astype(int)
    depth = np.full(w * h, np.inf)
    owner = np.full(w * h, -1)
    weights = np.zeros((w * h, 3))
    faces = np.nonzero((area != 0) & (z[a] > 0) & (z[b] > 0) & (z[c] > 0) & (x1 >= x0) & (y1 >= y0))[0]
    for dy in range(int((y1 - y0)[faces].max()) + 1):
        row = faces[(y0 + dy <= y1)[faces]]
        for dx in range(int((x1 - x0)[row].max()) + 1 if len(row) else 0):
            f = row[(x0 + dx <= x1)[row]]
            px, py = x0[f] + dx, y0[f] + dy
            inside = (px >= 0) & (px < w) & (py >= 0) & (py < h)
            f, px, py = f[inside], px[inside], py[inside]
            ax, ay = x[a[f]], y[a[f]]
            qx, qy = px + 0.5 - ax, py + 0.5 - ay
            b1 = (qx * (y[c[f]] - ay) - (x[c[f]] - ax) * qy) / area[f]
            b2 = ((x[b[f]] - ax) * qy - qx * (y[b[f]] - ay)) / area[f]
            hit = (b1 >= 0) & (b2 >= 0) & (b1 + b2 <= 1)
            f, px, py, b1, b2 = f[hit], px[hit], py[hit], b1[hit], b2[hit]
            inverse = (1 - b1 - b2) / z[a[f]] + b1 / z[b[f]] + b2 / z[c[f]]
            at = py * w + px
            order = np.lexsort((f, 1 / inverse))[::-1]  # the nearest is written last
            f, at, b1, b2, inverse = f[order], at[order], b1[order], b2[order], inverse[order]
            nearer = 1 / inverse < depth[at]
            f, at, b1, b2, inverse = f[nearer], at[nearer], b1[nearer], b2[nearer], inverse[nearer]
            depth[at] = 1 / inverse
            owner[at] = f
            weights[at] = np.stack([(1 - b1 - b2) / z[a[f]], b1 / z[b[f]], b2 / z[c[f]]], 1) / inverse[:, None]
    return owner, weights


def tent(picture, h, w):
    """Pixels as the renderer has them: samples within one pixel of the center, weighted by a tent."""
    offsets = (np.arange(2 * FINE) + 0.5) / FINE - 1
    kernel = 1 - np.abs(offsets)
    kernel /= kernel.sum()
    half = FINE // 2
    padded = np.pad(picture, ((half, half), (half, half), (0, 0)))
    rows = sum(k * padded[i:i + h * FINE:FINE] for i, k in enumerate(kernel))
    return sum(k * rows[:, i:i + w * FINE:FINE] for i, k in enumerate(kernel))


def render(points, uv, triangles, texture, camera):
    """RGB linear and coverage."""
    h, w = camera['height'], camera['width']
    owner, weights = visible_triangles(points, triangles, camera)
    hit = np.nonzero(owner >= 0)[0]
    t = triangles[owner[hit]]
    at = sum(uv[t[:, k]] * weights[hit, k:k + 1] for k in range(3))
    fine = np.zeros((h * FINE * w * FINE, 4))
    fine[hit, :3] = lookup(texture, at)
    fine[hit, 3] = 1
    out = tent(fine.reshape(h * FINE, w * FINE, 4), h, w)
    return out[..., :3] / np.maximum(out[..., 3:], 1e-6), out[..., 3]


def psnr(a, b):
    return 10 * math.log10(1 / max(float(np.mean((a - b) ** 2)), 1e-12))


def main(asset, rendered, masks=None):
    gltf, binary = read_glb(asset)
    primitives = [p for mesh in gltf['meshes'] for p in mesh['primitives']]  # of all parts, which share vertices
    primitive = primitives[0]
    points = accessor(gltf, binary, primitive['attributes']['POSITION']).astype(np.float64)
    uv = accessor(gltf, binary, primitive['attributes']['TEXCOORD_0']).astype(np.float64)
    triangles = np.concatenate([accessor(gltf, binary, p['indices']).reshape(-1, 3) for p in primitives]).astype(int)
    texture = base_color(gltf, binary)
    scores = []
    for camera in json.load(open(os.path.join(rendered, 'render.json')))['cameras']:
        ours = np.asarray(Image.open(os.path.join(rendered, 'albedo', camera['file'])).convert('RGBA'), np.float64) / 255
        color, cover = render(points, uv, triangles, texture, camera)
        inside = (ours[..., 3] > 0.999) & (cover > 0.999)
        if masks:
            path = os.path.join(masks, os.path.basename(camera['file']))
            if not os.path.exists(path):
                continue
            inside &= np.asarray(Image.open(path).convert('L')) > 250
        if not inside.any():
            continue
        scores.append(psnr(srgb_from_linear(np.clip(color, 0, 1))[inside], ours[..., :3][inside]))
        print(f"{camera['file']:24} {scores[-1]:.2f} dB, {int(inside.sum())} pixels")
    print(f'mean of {len(scores)} views: {np.mean(scores):.2f} dB, least {np.min(scores):.2f} dB')


if __name__ == '__main__':
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(*sys.argv[1:])
