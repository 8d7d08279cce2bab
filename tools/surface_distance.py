#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""surface_distance.py ASSET.glb TRUTH.ply: how far the surface of an exported asset is from the true one, in the frame of
the input (vertices as they are in the file, without the node's turn). Points drawn evenly on the asset; their distances
from the planes of the nearest of 3 million points drawn on the truth. Needs NumPy.
"""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from compare_asset import accessor, read_glb

POINTS, TRUE_POINTS = 50_000, 3_000_000


def read_ply(path):
    data = open(path, 'rb').read()
    end = data.index(b'end_header\n') + 11
    head = data[:end].decode().split('\n')
    assert any('binary_little_endian' in line for line in head), 'not a binary little-endian PLY'
    kinds = {'float': 'f4', 'double': 'f8', 'uchar': 'u1', 'uint8': 'u1', 'int': 'i4', 'uint': 'u4', 'int32': 'i4', 'uint32': 'u4',
             'float32': 'f4', 'float64': 'f8'}
    counts, fields, lists, element = {}, [], None, None
    for line in (line.split() for line in head):
        if line[:1] == ['element']:
            element = line[1]
            counts[element] = int(line[2])
        elif line[:2] == ['property', 'list'] and element == 'face':
            lists = kinds[line[2]], kinds[line[3]]
        elif line[:1] == ['property'] and element == 'vertex':
            fields.append((line[2], kinds[line[1]]))
    vertices = np.frombuffer(data, np.dtype(fields), counts['vertex'], end)
    start = end + vertices.nbytes
    faces = np.frombuffer(data, np.dtype([('n', lists[0]), ('v', lists[1], 3)]), counts['face'], start)
    assert (faces['n'] == 3).all(), 'not triangles only'
    return np.stack([vertices[c] for c in 'xyz'], 1).astype(np.float64), faces['v'].astype(int)


def draw(points, triangles, count, rng):
    """Points drawn evenly, and unit normals."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    area = np.linalg.norm(normal, axis=1)
    f = rng.choice(len(triangles), count, p=area / area.sum())
    u, v = rng.random((2, count))
    flip = u + v > 1
    u, v = np.where(flip, 1 - u, u)[:, None], np.where(flip, 1 - v, v)[:, None]
    return a[f] * (1 - u - v) + b[f] * u + c[f] * v, normal[f] / area[f, None]


def cell_keys(points, low, cell):
    i = np.floor((points - low) / cell).astype(np.int64) + 1
    return (i[:, 0] << 42) + (i[:, 1] << 21) + i[:, 2]


def distances(points, truth, normals, cell):
    """From each point to the plane of the nearest true one; infinite where none is within a cell."""
    low = np.minimum(points.min(0), truth.min(0)) - cell
    keys = cell_keys(truth, low, cell)
    order = np.argsort(keys)
    keys, truth, normals = keys[order], truth[order], normals[order]
    nearest, out = np.full(len(points), np.inf), np.full(len(points), np.inf)
    for shift in np.ndindex(3, 3, 3):
        wanted = cell_keys(points + (np.array(shift) - 1) * cell, low, cell)
        first, last = np.searchsorted(keys, wanted), np.searchsorted(keys, wanted, 'right')
        at = np.nonzero(last > first)[0]
        k = 0
        while len(at):
            i = first[at] + k
            away = points[at] - truth[i]
            d = (away ** 2).sum(1)
            nearer = d < nearest[at]
            nearest[at[nearer]] = d[nearer]
            out[at[nearer]] = np.abs((away * normals[i]).sum(1))[nearer]
            k += 1
            at = at[first[at] + k < last[at]]
    return out


def main(asset, truth):
    gltf, binary = read_glb(asset)
    primitives = [p for mesh in gltf['meshes'] for p in mesh['primitives']]
    primitive = primitives[0]
    points = accessor(gltf, binary, primitive['attributes']['POSITION']).astype(np.float64)
    triangles = np.concatenate([accessor(gltf, binary, p['indices']).reshape(-1, 3) for p in primitives]).astype(int)
    rng = np.random.default_rng(1)
    true_points, true_triangles = read_ply(truth)
    radius = np.linalg.norm(true_points.max(0) - true_points.min(0)) / 2
    samples, _ = draw(points, triangles, POINTS, rng)
    d = distances(samples, *draw(true_points, true_triangles, TRUE_POINTS, rng), 0.02 * radius)
    far = np.isinf(d)
    print(f'{len(triangles)} triangles; distance / radius ({radius:.4f}): mean {100 * d[~far].mean() / radius:.3f} %, '
          f'95 % below {100 * np.percentile(d, 95) / radius:.3f} %; {100 * far.mean():.2f} % farther than 2 %')


if __name__ == '__main__':
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
