# SPDX-License-Identifier: Apache-2.0
# Paint, undo, redo, other light, export.
source "$(dirname "$0")/lib.sh"

project=$out/object
cp -r "$object" "$project"
views() { cei3d render "$project" -o "$1" --cameras "$sample:test" --size 96x96 --samples 1 "${@:2}"; }

views "$out/before"
cei3d edit "$project" paint --view train/r_055 --scribble "$sample/edits/paint/scribble.png"
cei3d log "$project" | grep '0001-paint .*on' >/dev/null || fail "the edit is not in the log"
views "$out/painted"
! diff -rq -x render.json "$out/before" "$out/painted" >/dev/null || fail "painting changed nothing"
cei3d eval "$project" "$sample:test" --samples 1 --edit 0001-paint --truth "$sample/edits/paint/gt" \
  --mask "$sample/edits/paint/mask" --json "$out/eval.json"
cei3d eval "$project" --samples 1 --edit 0001-paint | grep -i 'edited' >/dev/null || fail "no score of the area not edited"
refused 2 '--edit' eval "$project" --truth "$sample/edits/paint/gt" --mask "$sample/edits/paint/mask"
refused 2 'fid-model' eval "$project" --fid-model "$out/missing.onnx"
refused 1 'scribble.png|ONNX Runtime' eval "$project" --lpips-model "$sample/edits/paint/scribble.png"

cei3d undo "$project"
views "$out/undone"
same_pictures "$out/before" "$out/undone"
refused 2 'nothing' undo "$project"
cei3d redo "$project"
views "$out/redone"
same_pictures "$out/painted" "$out/redone"
cei3d toggle "$project" 0001-paint
views "$out/toggled"
same_pictures "$out/before" "$out/toggled"
cei3d toggle "$project" 0001-paint

cei3d edit "$project" material --roughness 0.6 --color '#8090a0'
cei3d edit "$project" light --rotate 90 --scale 1.5 --picture "$out/light.png" --json >"$out/light.json"
grep -q '"changed_outside": 0' "$out/light.json" || fail "no report of what changed"
[[ -s $out/light.png ]] || fail "no picture of what changed"
cei3d log "$project" | grep '0003-light .*on .*rotate' >/dev/null || fail "the light is not in the log"
views "$out/matt"
cei3d toggle "$project" 0002-material
cei3d undo "$project"
views "$out/plain"
same_pictures "$out/painted" "$out/plain"
cei3d redo "$project"
cei3d toggle "$project" 0002-material
views "$out/again"
same_pictures "$out/matt" "$out/again"
cp -r "$object" "$out/other"
cei3d replay "$project" --on "$out/other"
cei3d render "$out/other" -o "$out/replayed" --cameras "$sample:test" --size 96x96 --samples 1
same_pictures "$out/matt" "$out/replayed"
contents "$project" >"$out/before.txt"
refused 2 'roughness|1.5' edit "$project" material --roughness 1.5
refused 2 'ear' edit "$project" material --part ear --roughness 0.5
refused 2 'gold' edit "$project" material --material gould
refused 2 '--env|change' edit "$project" light
refused 2 'PNG' edit "$project" light --scale 2 --picture "$out/light.jpg"
refused 2 '--scribble' edit "$project" paint --view train/r_055 --scribble "$sample/edits/paint/scribble.png" --view r_001
refused 1 'scribble.png|wide' edit "$project" light --env "$sample/edits/paint/scribble.png"
contents "$project" >"$out/after.txt"
same "$out/before.txt" "$out/after.txt"
cei3d undo "$project"
cei3d undo "$project"

cei3d edit "$project" paint --view train/r_055 --scribble "$sample/edits/paint/scribble.png" --material gold
cei3d log "$project" | grep 'paint .*material gold' >/dev/null || fail "the material is not in the log"
cei3d edit "$project" paint --view train/r_055 --scribble "$sample/edits/paint/scribble.png" --erase
views "$out/erased"
same_pictures "$out/before" "$out/erased"
cei3d undo "$project"
cei3d undo "$project"

views "$out/relit" --env "$sample/envs/venice.hdr"
views "$out/turned" --env "$sample/envs/venice.hdr" --env-rotate 90
! diff -rq -x render.json "$out/relit" "$out/turned" >/dev/null || fail "turning the light changed nothing"
cei3d render "$project" -o "$out/turntable" --turntable 3 --size 64x64 --samples 1
[[ $(ls "$out/turntable/rgb" | wc -l) == 3 ]] || fail "not 3 pictures on the turntable"

cei3d export "$project" -o "$out/spot.glb" --faces 5000 --texture 512
[[ $(head -c 4 "$out/spot.glb") == glTF ]] || fail "spot.glb is no GLB"
cei3d export "$project" -o "$out/spot.ply"
head -1 "$out/spot.ply" | grep '^ply' >/dev/null || fail "spot.ply is no PLY"
cei3d export "$project" -o "$out/points.ply" --points
cei3d export "$project" -o "$out/light.npy"
head -c 6 "$out/light.npy" | grep NUMPY >/dev/null || fail "light.npy is no NPY"
