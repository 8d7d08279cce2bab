#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""enlarge_capture.py CAPTURE OUT SIDE: the training views of a NeRF-synthetic capture with images of SIDE x SIDE pixels, to measure what
large photographs need in time and memory. Needs python3-pil.
"""
import json
import os
import sys

from PIL import Image


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    capture, out, side = sys.argv[1], sys.argv[2], int(sys.argv[3])
    with open(os.path.join(capture, 'transforms_train.json'), encoding='utf-8') as file:
        transforms = json.load(file)
    for frame in transforms['frames']:
        path = frame['file_path'] + '.png'
        os.makedirs(os.path.dirname(os.path.join(out, path)), exist_ok=True)
        image = Image.open(os.path.join(capture, path)).resize((side, side), Image.BICUBIC)
        image.save(os.path.join(out, path), compress_level=1)
    with open(os.path.join(out, 'transforms_train.json'), 'w', encoding='utf-8') as file:
        json.dump(transforms, file, indent=1)
    print(f"{out}: {len(transforms['frames'])} images of {side} x {side}")


if __name__ == '__main__':
    main()
