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

cei3d export "$project" -o "$out/by_vertex.glb" --texture 0 --faces 2000

# What others say.
if command -v node >/dev/null; then
  status=0
  node tools/check_gltf.cjs "$out/web.glb" "$out/by_vertex.glb" || status=$?
  [[ $status == 0 || $status == 77 ]] || fail "the validator is not content"
else
  echo "SKIPPED: no node to run the glTF validator with"
fi
