# SPDX-License-Identifier: Apache-2.0
# Parts: selected, listed, colored, shown as masks, taken back.
source "$(dirname "$0")/lib.sh"

project=$out/object
cp -r "$object" "$project"
scribble=$sample/edits/paint/scribble.png
views() { cei3d render "$project" -o "$1" --cameras "$sample:test" --size 96x96 --samples 1; }

cei3d parts "$project" --json | grep '"parts": \[\]' >/dev/null || fail "parts before there are any"
views "$out/before"
cei3d edit "$project" part --view train/r_055 --mask "$scribble" --name star --color '#3c8c46' --roughness 0.7 \
  --picture "$out/star.png" --json >"$out/star.json"
grep -q '"changed_outside": 0' "$out/star.json" || fail "the part's color left the part"
cei3d parts "$project" | grep '^star .*0001-part' >/dev/null || fail "the part is not listed"
views "$out/after"
! diff -rq -x render.json "$out/before" "$out/after" >/dev/null || fail "coloring a part changed nothing"
cei3d parts "$project" --masks "$sample:test" -o "$out/masks" --part star
[[ $(ls "$out/masks" | wc -l) == $(ls "$sample/test" | wc -l) ]] || fail "not a mask for every view"
cei3d edit "$project" material --part star --metalness 1
contents "$project" >"$out/before.txt"
refused 1 'background' edit "$project" part --view train/r_055 --positive 1,1
refused 2 'r_055' edit "$project" part --view train/r_055 --positive 128,1000
refused 2 'positive' edit "$project" part --view train/r_055
refused 2 '--positive' edit "$project" part --view train/r_055 --positive 12
refused 2 'ear' edit "$project" part --view train/r_055 --mask "$scribble" --add ear
refused 2 'ear' parts "$project" --masks "$sample:test" -o "$out/none" --part ear
absent "$out/none"
contents "$project" >"$out/after.txt"
same "$out/before.txt" "$out/after.txt"
cei3d undo "$project"
cei3d undo "$project"
views "$out/undone"
same_pictures "$out/before" "$out/undone"
cei3d edit "$project" part --view train/r_055 --mask "$scribble" --name star --remove
[[ $(cei3d log "$project" | grep -c 'star\|remove') -ge 2 ]] || fail "removing a part in one go made no two edits"
views "$out/gone"
! diff -rq -x render.json "$out/before" "$out/gone" >/dev/null || fail "the removed part is still there"
cei3d undo "$project"
cei3d undo "$project"
views "$out/back"
same_pictures "$out/before" "$out/back"
# A scribble of several colors as the prompt: the part gets its pattern.
cei3d edit "$project" part --view train/r_055 --scribble "$scribble" --name patterned --picture "$out/patterned.png" \
  --json >"$out/patterned.json"
grep -q '"changed_outside": 0' "$out/patterned.json" || fail "the part's pattern left the part"
views "$out/patterned"
! diff -rq -x render.json "$out/before" "$out/patterned" >/dev/null || fail "the pattern does not show"
cei3d undo "$project"
views "$out/unpatterned"
same_pictures "$out/before" "$out/unpatterned"
