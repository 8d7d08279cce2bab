#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""null_edit.py PROGRAM PROJECT: paints a disc of a copy of the project with the base color that is already there, and tells how many
pixels of other views change, and by how much. Nothing should."""
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

VIEWS, RADIUS = 3, 0.25  # of the turntable; of the disc, as a share of the object's width in the picture


def disc_of(albedo):
    """The scribble: the albedo where the object is, within a disc about its middle."""
    pixels = np.asarray(albedo).copy()
    inside = pixels[..., 3] == 255
    y, x = np.nonzero(inside)
    distance = np.hypot(*(np.indices(inside.shape) - np.array([y.mean(), x.mean()])[:, None, None]))
    pixels[..., 3] = np.where(inside & (distance < RADIUS * np.ptp(x)), 255, 0)
    return Image.fromarray(pixels)


def main():
    program, project = sys.argv[1:]

    def run(*arguments):
        subprocess.run([program, *map(str, arguments), "--quiet"], check=True)

    with tempfile.TemporaryDirectory() as folder:
        at = Path(folder)
        copy = at / "copy"
        shutil.copytree(project, copy)
        run("render", copy, "-o", at / "before", "--turntable", VIEWS, "--channels", "rgb,albedo")
        cameras = json.loads((at / "before/render.json").read_text())
        cameras["cameras"] = cameras["cameras"][:1]
        (at / "camera.json").write_text(json.dumps(cameras))
        first = sorted((at / "before/albedo").rglob("*.png"))[0]
        disc_of(Image.open(first).convert("RGBA")).save(at / "scribble.png")
        run("edit", copy, "paint", "--camera", at / "camera.json", "--scribble", at / "scribble.png")
        run("render", copy, "-o", at / "after", "--turntable", VIEWS)
        changed, largest, pixels = 0, 0, 0
        for path in sorted((at / "after/rgb").rglob("*.png")):
            before = np.asarray(Image.open(at / "before" / path.relative_to(at / "after"))).astype(int)
            change = np.abs(np.asarray(Image.open(path)).astype(int) - before).max(axis=2)
            changed += int((change > 0).sum())
            largest = max(largest, int(change.max()))
            pixels += int((before[..., 3] > 0).sum())
        print(f"{changed} of {pixels} pixels of the object change, by {largest}/255 at most")


main()
