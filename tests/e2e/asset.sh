# SPDX-License-Identifier: Apache-2.0
# Textured assets in every format, of the object as it was made, painted, and with a part removed.
source "$(dirname "$0")/lib.sh"

readonly project=$out/object
cp -r "$object" "$project"
cei3d edit "$project" paint --view train/r_055 --scribble "$sample/edits/paint/scribble.png"

readonly sizes=(--faces 2000 --texture 256)
for kind in gltf obj usdz; do
  mkdir "$out/$kind"
  cei3d export "$project" -o "$out/$kind/spot.$kind" "${sizes[@]}"
done
[[ $(ls "$out/gltf" | wc -l) == 5 ]] || fail "not 5 files of a .gltf: $(ls "$out/gltf")"
[[ $(ls "$out/obj" | wc -l) == 7 ]] || fail "not 7 files of an .obj: $(ls "$out/obj")"
[[ $(ls "$out/usdz" | wc -l) == 1 ]] || fail "not 1 file of a .usdz: $(ls "$out/usdz")"
python3 -m zipfile -t "$out/usdz/spot.usdz" >/dev/null || fail "spot.usdz is no ZIP archive"

# The same bits every time, whatever the number of threads.
cei3d export "$project" -o "$out/web.glb" --for web --size 30cm --origin base --light fit
cei3d export "$project" -o "$out/again/web.glb" --for web --size 30cm --origin base --threads 1
same "$out/web.glb" "$out/again/web.glb"
cei3d export "$project" -o "$out/sky.hdr"
same "$out/sky.hdr" "$out/web.env.hdr"
cei3d export "$project" -o "$out/sky.exr"
cei3d export "$project" -o "$out/light.json"
python3 -m json.tool "$out/light.json" >/dev/null || fail "light.json is no JSON"

# Objects that are written in other ways: without textures, other pictures, several nodes, holes, other shapes, no light.
cei3d export "$project" -o "$out/by_vertex.glb" --texture 0 --faces 2000
cei3d export "$project" -o "$out/webp.glb" --image webp "${sizes[@]}"
edited() { # NAME EDIT...: the object after this edit alone, as NAME.glb
  local -r name=$1
  shift
  cp -r "$object" "$out/$name"
  cei3d edit "$out/$name" "$@"
  cei3d export "$out/$name" -o "$out/$name.glb" "${sizes[@]}"
}
readonly star=(part --view train/r_055 --mask "$sample/edits/paint/scribble.png" --name star)
edited parts "${star[@]}" --color '#3c8c46'
edited removed "${star[@]}" --remove
edited bent deform --view train/r_055 --pixel 96,96 --drag 12,-8
python3 - "$out/no_light.npy" <<'PYTHON'
import struct, sys
head = b"{'descr': '<f4', 'fortran_order': False, 'shape': (1, 7), }".ljust(117) + b'\n'
lobe = struct.pack('<7f', 0, 0, 1, 2, 0, 0, 0)
open(sys.argv[1], 'wb').write(b'\x93NUMPY\1\0' + len(head).to_bytes(2, 'little') + head + lobe)
PYTHON
edited dark light --env "$out/no_light.npy"
cei3d export "$out/dark" -o "$out/dark.html"
cei3d export "$out/dark" -o "$out/dark.hdr"

# In several formats at once, and again one by one.
mkdir "$out/standing" "$out/input"
files=()
for kind in glb gltf obj usdz; do files+=(-o "$out/standing/spot.$kind"); done
cei3d export "$project" "${files[@]}" "${sizes[@]}" --size 30cm --origin base --json >"$out/standing.json"
cei3d export "$project" -o "$out/alone/spot.usdz" "${sizes[@]}" --size 30cm --origin base
same "$out/alone/spot.usdz" "$out/standing/spot.usdz"
cei3d export "$project" -o "$out/input/spot.obj" "${sizes[@]}" --json >"$out/input_obj.json"
cei3d export "$project" -o "$out/input/spot.ply" --faces 2000 --json >"$out/input_ply.json"

# How far a simplified object is from the whole one is said whatever it is written as.
cei3d export "$project" -o "$out/input/whole.ply" -o "$out/input/light.npy" --json >"$out/whole.json"
cei3d export "$project" -o "$out/input/spot.html" -o "$out/input/spot.glb" --faces 2000 --texture 0 --json >"$out/faces.json"
python3 - "$out"/{standing,input_obj,input_ply,faces,whole}.json <<'PYTHON'
import json, sys

def reports(file):
    report = json.load(open(file))
    return report.get('exports', [report])

simplified = [r for file in sys.argv[1:-1] for r in reports(file)]
errors = {r['simplification_error'] for r in simplified}
assert len(simplified) == 8 and len(errors) == 1 and errors.pop() > 0, errors
assert not any('simplification_error' in r for r in reports(sys.argv[-1]))
atlas = simplified[0]['texture']
assert atlas['flipped'] == atlas['overlapping'] == 0 and .5 < atlas['used'] < 1 and 1 <= atlas['stretch'] < 1.3, atlas
PYTHON

# What others say.
skip() { printf 'SKIP: exported assets by other programs: %s\n' "$1"; exit 77; }
command -v node >/dev/null || skip "no node"
tools/install_web.sh >/dev/null 2>&1 || skip "no npm packages (./run web)"
node tools/check_gltf.cjs "$out"/*.glb "$out/gltf/spot.gltf"
node tools/check_readers.cjs "$out"/input_{obj,ply}.json
node tools/check_readers.cjs --standing 0.3 "$out/standing.json"
