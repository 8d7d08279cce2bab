#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""demo_picture.py OUT PICTURE: the README's picture from what `./run demo` left in OUT. Needs python3-pil."""
import sys

from PIL import Image

COLUMNS = ['samples/spot/test/{v}.png', '{out}/before/rgb/{v}.png', '{out}/before/albedo/{v}.png',
           '{out}/painted/rgb/{v}.png', '{out}/relit/rgb/{v}.png']
VIEWS = ['r_034', 'r_006']


def main(out, target):
    rows = [[Image.open(c.format(out=out, v=v)).convert('RGBA') for c in COLUMNS] for v in VIEWS]
    w, h = rows[0][0].size
    sheet = Image.new('RGB', (w * len(COLUMNS), h * len(VIEWS)), 'white')
    for y, row in enumerate(rows):
        for x, picture in enumerate(row):
            sheet.paste(picture, (x * w, y * h), picture)
    sheet.save(target, optimize=True)


if len(sys.argv) != 3:
    sys.exit(__doc__)
main(*sys.argv[1:])
