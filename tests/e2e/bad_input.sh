# SPDX-License-Identifier: Apache-2.0
# Bad input gets a sentence and an exit code, and nothing is written.
source "$(dirname "$0")/lib.sh"

# A capture to spoil.
fresh() {
  rm -rf "$out/capture"
  mkdir -p "$out/capture"
  cp -r "$sample"/{train,test,transforms_train.json,transforms_test.json} "$out/capture"
}

# spoiled CODE PATTERN: neither check nor reconstruct accepts the capture; no project appears.
spoiled() {
  refused_by_check "$2"
  refused "$1" "$2" reconstruct "$out/capture" -o "$out/project" --iterations 1
  absent "$out/project"
}

# check answers on standard output and fails.
refused_by_check() {
  local status=0
  cei3d check "$out/capture" >"$out/stdout" 2>"$out/stderr" || status=$?
  [[ $status == 1 ]] || fail "check: exit code $status"
  grep -Eqi -- "$1" "$out/stdout" "$out/stderr" || fail "check does not say /$1/: $(cat "$out/stdout" "$out/stderr")"
}

refused 2 '50' reconstruct "$sample" -o "$out/project" --views 51
absent "$out/project"
refused 2 'geometry.loss.eikonal' reconstruct "$sample" -o "$out/project" --set geometry.loss.eikonol=0.1
refused 2 '0 to 100' reconstruct "$sample" -o "$out/project" --set geometry.loss.eikonal=-1
refused 2 'random:0.1' reconstruct "$sample" -o "$out/project" --split half
refused 2 'split of its own' reconstruct "$sample" -o "$out/project" --split random:0.1
absent "$out/project"
cei3d reconstruct --list-settings --preset paper | grep '^geometry.sdf.hidden_layers = 8' >/dev/null || fail "the settings of a preset"
fresh; rm "$out/capture/train/r_011.png"
refused 1 'missing.*r_011' reconstruct "$out/capture" -o "$out/project" --iterations 1 --strict
absent "$out/project"
cei3d check "$out/capture" | grep 'warning: 1 of .* images are missing.*r_011' >/dev/null || fail 'no warning of r_011'
fresh; head -c 900 "$sample/train/r_013.png" >"$out/capture/train/r_013.png"
spoiled 1 'r_013'
fresh; sed -i 's/0.712988874/NaN/' "$out/capture/transforms_train.json"
spoiled 1 'r_001'
fresh; echo '{"frames": []}' >"$out/capture/transforms_train.json"
spoiled 1 'frames|views|field of view|focal'
fresh; echo 'not json' >"$out/capture/transforms_train.json"
spoiled 1 'JSON'
fresh; sed -i 's/"h": 192/"h": 150/' "$out/capture/transforms_train.json"
spoiled 1 'should have 192 x 150'
fresh; for f in "$out"/capture/train/*.png; do cp tests/e2e/data/empty_192.png "$f"; done
spoiled 1 'mask|empty|alpha'
rm -rf "$out/capture"
refused 1 'capture|no such|not found|does not exist' reconstruct "$out/capture" -o "$out/project"
absent "$out/project"

# Edits: the project stays as it was.
project=$out/object
cp -r "$object" "$project"
contents "$project" >"$out/contents"
refused_edit() {
  refused "$@"
  contents "$project" | cmp -s - "$out/contents" || fail "a refused edit changed the project"
}
paint() { printf '%s\n' edit "$project" paint --view train/r_055 --scribble "$1"; }
mapfile -t a < <(paint tests/e2e/data/other_size.png); refused_edit 1 '48x48' "${a[@]}"
mapfile -t a < <(paint tests/e2e/data/empty_192.png); refused_edit 1 'opaque' "${a[@]}"
mapfile -t a < <(paint tests/e2e/data/corner_192.png); refused_edit 1 'on the object|surface' "${a[@]}"
mapfile -t a < <(paint tests/e2e/data/rgb_192.png); refused_edit 1 'alpha' "${a[@]}"
mapfile -t a < <(paint "$out/no_such.png"); refused_edit 1 'no_such.png' "${a[@]}"
refused_edit 2 'branch.steps' edit "$project" paint --view train/r_055 --scribble "$sample/edits/paint/scribble.png" --set branch.step=9
refused_edit 2 'handle_share' edit "$project" deform --from 0,0,0 --to 0,0,1 --set handle_shore=0.2
refused_edit 2 '0.01 to 0.9' edit "$project" deform --from 0,0,0 --to 0,0,1 --set handle_share=2
refused_edit 2 'like.roughness' edit "$project" part --view train/r_055 --like 96,96 --set like.roughnes=0.2
part() { printf '%s\n' edit "$project" part --view train/r_055 --scribble "$1"; }
mapfile -t a < <(part tests/e2e/data/other_size.png); refused_edit 2 '48x48' "${a[@]}"
mapfile -t a < <(part tests/e2e/data/empty_192.png); refused_edit 1 'no stroke' "${a[@]}"
mapfile -t a < <(part tests/e2e/data/corner_192.png); refused_edit 1 'nothing of the object' "${a[@]}"
mapfile -t a < <(part tests/e2e/data/rgb_192.png); refused_edit 1 'alpha' "${a[@]}"
refused_edit 2 'views' edit "$project" part --view train/r_055 --positive 100,100 --views none
head -c 500 "$sample/edits/paint/scribble.png" >"$out/truncated.png"
mapfile -t a < <(paint "$out/truncated.png"); refused_edit 1 'truncated.png' "${a[@]}"
refused_edit 2 'r_555|view' edit "$project" paint --view r_555 --scribble "$sample/edits/paint/scribble.png"

# Renders and exports.
refused 1 'no_such|project' render "$out/no_such" -o "$out/pictures"
absent "$out/pictures"
refused 2 'channel' render "$project" -o "$out/pictures" --channels rgb,smell
absent "$out/pictures"
refused 2 'glb|ply|npy|format|suffix' export "$project" -o "$out/spot.doc"
absent "$out/spot.doc"
refused 2 'texture' export "$project" -o "$out/spot.glb" --texture 1000000
refused 2 'faces' export "$project" -o "$out/spot.glb" --faces 0
refused 2 'size' export "$project" -o "$out/spot.glb" --size 3km
refused 2 'glb|ply' export "$project" -o "$out/spot.obj" --texture 0
refused 2 'texture' export "$project" -o "$out/spot.html" --texture 512
refused 2 'no place for size' export "$project" -o "$out/spot.html" --size 30cm
refused 2 'holds it already' export "$project" -o "$out/spot.html" --light fit
refused 2 'unit scale' export "$project" -o "$out/spot.glb" --unit-scale 1e300
refused 2 'webp' export "$project" -o "$out/spot.usdz" --image webp
refused 1 'not a folder' export "$project" -o "$out/truncated.png/spot.glb"
absent "$out/spot.glb"
# A limit on the size of files stands in for a full disk: nothing half-written stays.
for kind in html glb gltf obj usdz ply hdr exr; do
  mkdir "$out/full"
  size=(--faces 2000)
  [[ $kind == html || $kind == ply ]] || size+=(--texture 256)
  (trap '' XFSZ; ulimit -f 16; refused 1 'too large|space' export "$project" -o "$out/full/spot.$kind" "${size[@]}") || exit 1
  [[ -z $(ls -A "$out/full") ]] || fail "left behind by a failed export: $(ls -A "$out/full")"
  rmdir "$out/full"
done
# Of several files, the first of which has room, none is written.
mkdir "$out/full"
(trap '' XFSZ; ulimit -f 16; refused 1 'too large|space' export "$project" -o "$out/full/light.npy" -o "$out/full/spot.ply") || exit 1
[[ -z $(ls -A "$out/full") ]] || fail "left behind by a failed export of two files: $(ls -A "$out/full")"
refused 2 'smell' smell

# A project of a newer format, a damaged one.
sed -i 's/"version": *[0-9]*/"version": 99/; s/"format": *1/"format": 99/' "$project/project.json"
grep -q 99 "$project/project.json" || fail "the format version is not where this test looks for it"
refused 1 'newer' render "$project" -o "$out/pictures"
refused 1 'newer' edit "$project" paint --view r_055 --scribble "$sample/edits/paint/scribble.png"
rm -rf "$project"; cp -r "$object" "$project"
hash=$(grep -o '"object": *"[0-9a-f]*"' "$project/base/scene.json" | grep -o '[0-9a-f]\{16,\}')
truncate -s 1000 "$project/objects/${hash:0:2}/${hash:2}.safetensors"
refused 1 'damaged|truncated|bytes|objects' render "$project" -o "$out/pictures"
absent "$out/pictures"

# A full disk, played by a limit on the size of files: the edit fails, the project stays as it was and works.
rm -rf "$project"; cp -r "$object" "$project"
(
  trap '' XFSZ
  ulimit -f 64
  refused 1 'write|space|large|disk' edit "$project" paint --view r_055 --scribble "$sample/edits/paint/scribble.png"
) || exit 1
contents "$project" | cmp -s - "$out/contents" || fail "an edit that could not be stored changed the project"
cei3d log "$project" --json | grep '"edits": \[\]' >/dev/null || fail "an edit that could not be stored is in the log"
