# SPDX-License-Identifier: Apache-2.0
# An exported object under its exported light in Blender, whose path tracer must see it as we do.
source "$(dirname "$0")/lib.sh"

readonly python=/usr/bin/python3  # for which ./run blender installs NumPy and Pillow
skip() { printf 'SKIP: exported assets in Blender: %s is not installed (./run blender)\n' "$1"; exit 77; }
command -v blender >/dev/null || skip Blender
$python -c 'import numpy, PIL' 2>/dev/null || skip "NumPy or Pillow"

cei3d export "$object" -o "$out/spot.glb" --faces 6000 --texture 512 --light fit
cei3d render "$object" -o "$out/ours" --cameras "$sample:test" --size 96x96 --no-residual
view=$(cd "$out/ours/rgb" && ls | head -1)
blender -b --factory-startup --python-exit-code 1 -P tools/blender_open.py -- "$out/spot.glb" "$out/spot.env.hdr" \
  --cameras "$out/ours/render.json" --view "test/${view%.png}" --samples 64 -o "$out/cycles" >"$out/blender.log" 2>&1 ||
  fail "Blender: $(tail -5 "$out/blender.log")"
[[ $(ls "$out/cycles") == "$view" ]] || fail "Blender renders $(ls "$out/cycles"), not $view"
$python tools/compare_pictures.py "$out/ours/rgb" "$out/cycles" --least 28
