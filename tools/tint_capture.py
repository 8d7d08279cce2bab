#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tint_capture.py CAPTURE OUT R,G,B: a copy of a NeRF-synthetic capture as if its light had that factor per channel.

Light is additive, so every training picture is multiplied in linear light; test pictures and maps stay as they are. Needs python3-numpy
and python3-pil.
"""
import glob
import os
import shutil
import sys

import numpy
from PIL import Image

from srgb import linear_from_srgb, srgb_from_linear


def tint(path, factors):
    pixels = numpy.asarray(Image.open(path).convert('RGBA')).astype(float) / 255
    pixels[..., :3] = srgb_from_linear(numpy.clip(linear_from_srgb(pixels[..., :3]) * factors, 0, 1))
    Image.fromarray(numpy.round(pixels * 255).astype(numpy.uint8)).save(path)


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    capture, out, factors = sys.argv[1], sys.argv[2], numpy.array([float(x) for x in sys.argv[3].split(',')])
    shutil.copytree(capture, out)
    pictures = glob.glob(os.path.join(out, 'train', '*.png'))
    for path in pictures:
        tint(path, factors)
    print(f'{out}: {len(pictures)} training pictures')


main()
