# SPDX-License-Identifier: Apache-2.0
# One seed, the same bits: with one thread as with all, uninterrupted as after kill -9 in two stages.
source "$(dirname "$0")/lib.sh"

# killed_after STAGE ARGUMENTS...: reconstruct, dead as soon as the state after the stage is saved, in the next stage.
killed_after() {
  local stage=$1 pid
  shift
  "$program" reconstruct "$@" -o "$out/first" &
  pid=$!
  for ((i = 0; i < 2400; ++i)); do
    grep -qs "\"stage\": *\"$stage\"" "$out"/first/base/*.ckpt.json && break
    [[ -e /proc/$pid ]] || break
    sleep 0.05
  done
  kill -9 "$pid" 2>/dev/null || true
  wait "$pid" 2>/dev/null || true
  [[ ! -e $out/first/base/scene.json ]] || fail "the run was over before it could be killed after $stage"
}

killed_after start "$sample" "${small[@]}" --threads 1
refused 1 'resume' render "$out/first" -o "$out/nothing"
absent "$out/nothing"
killed_after surface --resume
cei3d reconstruct -o "$out/first" --resume

"$program" edit "$out/first" paint --view r_055 --scribble "$sample/edits/paint/scribble.png" &
pid=$!
sleep 0.3
kill -9 "$pid" 2>/dev/null || true
wait "$pid" 2>/dev/null || true
cei3d log "$out/first"  # it opens, with the edit or without

for p in "$out/first" "$object"; do
  cei3d render "$p" -o "$out/views_of_$(basename "$p")" --cameras "$sample:test" --size 64x64 --samples 1 --channels albedo,normal
done
[[ $(cei3d log "$out/first") != "No edits." ]] && cei3d undo "$out/first"
rm -rf "$out/views_of_first"
cei3d render "$out/first" -o "$out/views_of_first" --cameras "$sample:test" --size 64x64 --samples 1 --channels albedo,normal
same_pictures "$out/views_of_first" "$out/views_of_object"
scene() { grep -o '"[0-9a-f]\{16,\}"' "$1/base/scene.json"; }
[[ $(scene "$out/first") == $(scene "$object") ]] || fail "the objects differ: $(diff "$out/first/base/scene.json" "$object/base/scene.json")"
