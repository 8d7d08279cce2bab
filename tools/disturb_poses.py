#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""disturb_poses.py CAPTURE OUT DEGREES PERCENT [SEED [SHORT]]: a copy of a NeRF-synthetic capture whose training poses are a little wrong.

Each training camera is turned about its center by a random rotation vector, and shifted by a random vector; DEGREES and PERCENT (of
its distance from the origin) are standard deviations of the whole vectors. Test poses stay as they are. The focal length of all views is
given SHORT percent too short. Needs python3-numpy.
"""
import json
import os
import shutil
import sys

import numpy


def rotation(vector):
    angle = numpy.linalg.norm(vector)
    k = vector / max(angle, 1e-12)
    cross = numpy.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    return numpy.eye(3) + numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * cross @ cross


def shorten(capture, percent):
    for split in ('train', 'val', 'test'):
        path = os.path.join(capture, f'transforms_{split}.json')
        if not os.path.exists(path):
            continue
        with open(path, encoding='utf-8') as file:
            transforms = json.load(file)
        half = numpy.tan(transforms['camera_angle_x'] / 2)
        transforms['camera_angle_x'] = 2 * float(numpy.arctan(half * (1 + percent / 100)))
        with open(path, 'w', encoding='utf-8') as file:
            json.dump(transforms, file, indent=1)


def main():
    if len(sys.argv) not in (5, 6, 7):
        sys.exit(__doc__)
    capture, out, degrees, percent = sys.argv[1], sys.argv[2], float(sys.argv[3]), float(sys.argv[4])
    random = numpy.random.default_rng(int(sys.argv[5]) if len(sys.argv) > 5 else 1)
    shutil.copytree(capture, out)
    path = os.path.join(out, 'transforms_train.json')
    with open(path, encoding='utf-8') as file:
        transforms = json.load(file)
    for frame in transforms['frames']:
        pose = numpy.array(frame['transform_matrix'])
        distance = numpy.linalg.norm(pose[:3, 3])
        pose[:3, :3] = rotation(random.normal(size=3) * numpy.radians(degrees) / 3 ** 0.5) @ pose[:3, :3]
        pose[:3, 3] += random.normal(size=3) * distance * percent / 100 / 3 ** 0.5
        frame['transform_matrix'] = pose.tolist()
    with open(path, 'w', encoding='utf-8') as file:
        json.dump(transforms, file, indent=1)
    if len(sys.argv) > 6:
        shorten(out, float(sys.argv[6]))
    print(f"{out}: {len(transforms['frames'])} training poses")


main()
