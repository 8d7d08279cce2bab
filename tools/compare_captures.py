#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""compare_captures.py MADE TRUE: how far the poses and masks of a capture by `cei3d capture` are from true ones.

MADE: a folder with sparse/ and masks/. TRUE: a folder with transforms.json and masks. The camera centers are moved,
turned and scaled onto the true ones; distances are shares of the median distance of a true camera from the center of
the object, and of the object's radius where --radius gives it. Needs python3-numpy and python3-pil.
"""
import argparse
import json
import os
import struct

import numpy
from PIL import Image


def read_colmap_images(path):
    """Camera centers and viewing directions by the stem of the image."""
    found = {}
    with open(path, "rb") as f:
        (count,) = struct.unpack("<Q", f.read(8))
        for _ in range(count):
            f.read(4)
            w, x, y, z, *t = struct.unpack("<7d", f.read(56))
            f.read(4)
            name = b"".join(iter(lambda: f.read(1), b"\0")).decode()
            (points,) = struct.unpack("<Q", f.read(8))
            f.read(24 * points)
            r = numpy.array([
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ])
            found[os.path.splitext(os.path.basename(name))[0]] = (-r.T @ numpy.array(t), r[2])
    return found


def read_transforms(folder):
    with open(os.path.join(folder, "transforms.json"), encoding="utf-8") as f:
        frames = json.load(f)["frames"]
    found, masks = {}, {}
    for frame in frames:
        m = numpy.array(frame["transform_matrix"])
        stem = os.path.splitext(os.path.basename(frame["file_path"]))[0]
        found[stem] = (m[:3, 3], -m[:3, 2])
        if "mask_path" in frame:
            masks[stem] = os.path.join(folder, frame["mask_path"])
    return found, masks


def similarity(a, b):
    """The scale, rotation and shift that move the points a onto b [Umeyama 1991]."""
    ca, cb = a.mean(0), b.mean(0)
    u, s, v = numpy.linalg.svd((b - cb).T @ (a - ca))
    d = numpy.diag([1, 1, numpy.sign(numpy.linalg.det(u @ v))])
    r = u @ d @ v
    scale = (s * numpy.diag(d)).sum() / ((a - ca) ** 2).sum()
    return scale, r, cb - scale * r @ ca


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("made")
    parser.add_argument("true")
    parser.add_argument("--radius", type=float, help="of the object, in units of TRUE")
    o = parser.parse_args()
    model = max((os.path.join(o.made, "sparse", m, "images.bin") for m in os.listdir(os.path.join(o.made, "sparse"))),
                key=os.path.getsize)
    made = read_colmap_images(model)
    true, masks = read_transforms(o.true)
    names = sorted(set(made) & set(true))
    a, b = (numpy.array([x[n][0] for n in names]) for x in (made, true))
    scale, r, shift = similarity(a, b)
    off = numpy.linalg.norm(scale * a @ r.T + shift - b, axis=1)
    turned = [numpy.degrees(numpy.arccos(numpy.clip((r @ made[n][1]) @ true[n][1], -1, 1))) for n in names]
    print(f"{len(names)} of {len(true)} true cameras are in the model")
    span = numpy.median(numpy.linalg.norm(b - b.mean(0), axis=1))
    for what, size in (("the cameras' median distance from their mean", span), ("the radius", o.radius)):
        if size:
            share = off / size
            print(f"centers off, shares of {what}: median {numpy.median(share):.4f}, worst {share.max():.4f}; "
                  f"within .02: {(share < .02).sum()} of {len(true)}")
    print(f"axes off: median {numpy.median(turned):.3f} degrees, worst {max(turned):.3f}")
    shared = {}
    for n in sorted(masks):
        file = os.path.join(o.made, "masks", n + ".png")
        want = numpy.asarray(Image.open(masks[n]).convert("L")) > 127
        have = numpy.asarray(Image.open(file).convert("L")) > 127 if os.path.exists(file) else numpy.zeros_like(want)
        shared[n] = (want & have).sum() / max((want | have).sum(), 1)
    if shared:
        worst = sorted(shared, key=shared.get)[:5]
        print(f"masks, IoU: mean {numpy.mean(list(shared.values())):.4f}, median "
              f"{numpy.median(list(shared.values())):.4f}, worst " + ", ".join(f"{n} {shared[n]:.3f}" for n in worst))


if __name__ == "__main__":
    main()
