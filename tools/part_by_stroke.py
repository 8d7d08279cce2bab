#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""part_by_stroke.py PROGRAM PROJECT CAPTURE PROMPTS MASKS: selects a part of a copy of the project by one stroke through the positive
clicks of PROMPTS, by both segmenters, and prints its IoU with the true masks of the test views, mean and worst, and the seconds.
PROMPTS: JSON with "view", "positive" (pixels of that view). MASKS: folder of PNGs named as the test views; those in which the
part has fewer than 20 pixels do not count. Needs NumPy and Pillow."""
import json
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

STROKE, MIN_PIXELS = 5, 20  # width of the stroke; of a part in a view


def mask(file):
    return np.asarray(Image.open(file).convert("L")) > 127


def scribble(size, clicks):
    """The clicks from left to right, joined by lines."""
    image = Image.new("RGBA", size, (0, 0, 0, 0))
    ImageDraw.Draw(image).line([tuple(c) for c in sorted(clicks)], fill=(200, 40, 40, 255), width=STROKE)
    return image


def ious(found, true):
    """Of the files in the folder `true`."""
    for file in sorted(Path(true).glob("*.png")):
        a, b = mask(Path(found) / file.name), mask(file)
        if b.sum() >= MIN_PIXELS:
            yield (a & b).sum() / (a | b).sum()


def select(program, project, capture, prompts, masks, segmenter):
    with tempfile.TemporaryDirectory() as folder:
        at = Path(folder)
        shutil.copytree(project, at / "copy")
        view = prompts["view"].removeprefix("./")
        scribble(Image.open(Path(capture) / f"{view}.png").size, prompts["positive"]).save(at / "scribble.png")
        begin = time.time()
        subprocess.run([program, "edit", at / "copy", "part", "--view", view, "--scribble", at / "scribble.png", "--name", "part",
                        "--segmenter", segmenter, "--quiet"], check=True)
        seconds = time.time() - begin
        subprocess.run([program, "parts", at / "copy", "--masks", f"{capture}:test", "-o", at / "masks", "--part", "part", "--quiet"],
                       check=True, stdout=subprocess.DEVNULL)
        all_masks = at / "masks/mask" if (at / "masks/mask").is_dir() else at / "masks"
        values = list(ious(all_masks, masks))
    print(f"{segmenter}: IoU {np.mean(values):.3f}, worst {min(values):.3f}, {seconds:.1f} s")


def main():
    program, project, capture, prompts, masks = sys.argv[1:]
    for segmenter in ("grow", "sam"):
        select(program, project, capture, json.loads(Path(prompts).read_text()), masks, segmenter)


if __name__ == "__main__":
    main()
