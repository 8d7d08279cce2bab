#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""compare_pictures.py DIR DIR [--least DB]: PSNR of pictures of the same name, in display-encoded color. Prints one line a
picture and the means: on white, and over the pixels that both cover fully. Exit code 1 when the latter is below --least.
Needs NumPy and Pillow."""
import argparse
import math
import os
import sys

import numpy as np
from PIL import Image


def read(path):
    return np.asarray(Image.open(path).convert('RGBA'), np.float64) / 255


def psnr(a, b):
    return 10 * math.log10(1 / max(float(np.mean((a - b) ** 2)), 1e-12))


def on_white(p):
    return p[..., :3] * p[..., 3:] + 1 - p[..., 3:]


def main(one, other, least):
    names = sorted(n for n in os.listdir(one) if n.endswith('.png') and os.path.exists(os.path.join(other, n)))
    if not names:
        sys.exit(f'{one} and {other} have no picture of the same name')
    scores = []
    for name in names:
        a, b = read(os.path.join(one, name)), read(os.path.join(other, name))
        inside = (a[..., 3] > 0.999) & (b[..., 3] > 0.999)
        scores.append((psnr(on_white(a), on_white(b)), psnr(a[inside][:, :3], b[inside][:, :3])))
        print(f'{name:24} {scores[-1][0]:.2f} dB on white, {scores[-1][1]:.2f} dB inside')
    white, within = np.mean(scores, 0)
    print(f'mean of {len(scores)}: {white:.2f} dB on white, {within:.2f} dB inside')
    if not within >= least:
        sys.exit(f'less than {least} dB inside')


if __name__ == '__main__':
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('one')
    parser.add_argument('other')
    parser.add_argument('--least', type=float, default=-math.inf)
    args = parser.parse_args()
    main(args.one, args.other, args.least)
