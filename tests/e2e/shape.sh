# SPDX-License-Identifier: Apache-2.0
# Deform: by points and by pixels, undo, paint that follows, export; drags that are refused change nothing.
source "$(dirname "$0")/lib.sh"

project=$out/object
cp -r "$object" "$project"
views() { cei3d render "$project" -o "$1" --cameras "$sample:test" --size 64x64 --samples 1; }
differ() { ! diff -rq -x render.json "$1" "$2" >/dev/null || fail "$1 and $2 are the same"; }

contents "$project" >"$out/contents"
refused_edit() {
  refused "$@"
  contents "$project" | cmp -s - "$out/contents" || fail "a refused edit changed the project"
}
seen=(--view train/r_055 --pixel 96,96)
refused_edit 2 'from|view' edit "$project" deform
refused_edit 2 'from|view' edit "$project" deform --from 0,0,0 --view train/r_055
refused_edit 2 '--from' edit "$project" deform --from 0,zero,0 --to 0,0,1
refused_edit 2 '--drag' edit "$project" deform "${seen[@]}" --drag 1,2,3
refused_edit 1 'surface' edit "$project" deform --from 0,0,0 --to 0,0,0.5
refused_edit 1 'background' edit "$project" deform --view train/r_055 --pixel 1,1 --drag 9,0
refused_edit 2 'r_055' edit "$project" deform --view train/r_055 --pixel 1000,1 --drag 9,0
refused_edit 1 'sphere' edit "$project" deform "${seen[@]}" --drag 5000,0
refused_edit 2 'drag' edit "$project" deform "${seen[@]}" --drag 0,0
refused_edit 2 'radius' edit "$project" deform "${seen[@]}" --drag 9,0 --radius -1
refused_edit 1 'whole|radius' edit "$project" deform "${seen[@]}" --drag 9,0 --radius 50
refused_edit 2 'ear' edit "$project" deform "${seen[@]}" --drag 9,0 --part ear
refused_edit 2 'ear' edit "$project" remove --part ear

views "$out/before"
cei3d edit "$project" paint --view train/r_055 --scribble "$sample/edits/paint/scribble.png"
views "$out/painted"
cei3d export "$project" -o "$out/painted.ply"
cei3d edit "$project" deform "${seen[@]}" --drag 12,-8 --json >"$out/deform.json"
grep -q '"vertices"' "$out/deform.json" || fail "no report of the deformation"
views "$out/deformed"
differ "$out/painted" "$out/deformed"
cei3d export "$project" -o "$out/deformed.ply"
! cmp -s "$out/painted.ply" "$out/deformed.ply" || fail "the exported mesh is not deformed"
cei3d undo "$project"
views "$out/undone"
same_pictures "$out/painted" "$out/undone"
cei3d redo "$project"
views "$out/redone"
same_pictures "$out/deformed" "$out/redone"

# The field can follow instead of the mesh, with the paint; a part of it is removed and comes back.
cei3d undo "$project"
cei3d edit "$project" part --view train/r_055 --positive 96,96 --name patch
cei3d edit "$project" deform "${seen[@]}" --drag 12,-8 --geometry field
views "$out/field"
differ "$out/painted" "$out/field"
cei3d edit "$project" remove --part patch
views "$out/removed"
differ "$out/field" "$out/removed"
cei3d undo "$project"
views "$out/put_back"
same_pictures "$out/field" "$out/put_back"
