#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""disturb_exposures.py CAPTURE OUT EXPOSURE BALANCE [SEED]: a copy of a NeRF-synthetic capture whose training images are of
different exposures, as by a camera that chooses them itself.

The linear channels of each training image are multiplied by exp(a random number), of the standard deviation EXPOSURE for all
three and BALANCE for each by itself; the factors are listed in OUT/exposures.json. Channels are clipped at white as those of a
photograph. Test images stay as they are. Needs python3-numpy and python3-pil.
"""
import json
import os
import shutil
import sys

import numpy
from PIL import Image

from srgb import linear_from_srgb, srgb_from_linear


def main():
    if len(sys.argv) not in (5, 6):
        sys.exit(__doc__)
    capture, out, exposure, balance = sys.argv[1], sys.argv[2], float(sys.argv[3]), float(sys.argv[4])
    random = numpy.random.default_rng(int(sys.argv[5]) if len(sys.argv) > 5 else 1)
    shutil.copytree(capture, out)
    with open(os.path.join(out, 'transforms_train.json'), encoding='utf-8') as file:
        frames = json.load(file)['frames']
    factors = {}
    for frame in frames:
        path = os.path.join(out, frame['file_path'] + '.png')
        factor = numpy.exp(exposure * random.normal() + balance * random.normal(size=3))
        image = numpy.asarray(Image.open(path)).astype(float) / 255
        image[..., :3] = srgb_from_linear(numpy.minimum(linear_from_srgb(image[..., :3]) * factor, 1))
        Image.fromarray((image * 255 + .5).astype(numpy.uint8)).save(path)
        factors[frame['file_path']] = factor.tolist()
    with open(os.path.join(out, 'exposures.json'), 'w', encoding='utf-8') as file:
        json.dump(factors, file, indent=1)
    print(f'{out}: {len(frames)} training images')


if __name__ == '__main__':
    main()
