# SPDX-License-Identifier: Apache-2.0
# One seed, the same bits: with one thread as with all, uninterrupted as after a signal in three stages.
source "$(dirname "$0")/lib.sh"

# stopped SIGNAL CODE STAGE ARGUMENTS...: reconstruct gets the signal as soon as the state after the stage is saved,
# which is in the next stage, and exits with the code.
stopped() {
  local signal=$1 code=$2 finished="\"stage\":\"$3\",\"finished\":true" pid status=0
  shift 3
  "$program" reconstruct "$@" -o "$out/first" &
  pid=$!
  for ((i = 0; i < 2400; ++i)); do
    cat "$out"/first/base/*.ckpt.json 2>/dev/null | tr -d ' \n' | grep "$finished" >/dev/null && break
    [[ -e /proc/$pid ]] || break
    sleep 0.05
  done
  kill -"$signal" "$pid" || fail "the run was over before it got $signal"
  wait "$pid" || status=$?
  [[ $status == "$code" ]] || fail "exit code $status after $signal, expected $code"
  absent "$out/first/base/scene.json"
}

stopped KILL 137 start "$sample" "${small[@]}" --threads 1
refused 1 'resume' render "$out/first" -o "$out/nothing"
absent "$out/nothing"
stopped TERM 130 geometry --resume
stopped KILL 137 surface --resume
cei3d reconstruct -o "$out/first" --resume

"$program" edit "$out/first" paint --view r_055 --scribble "$sample/edits/paint/scribble.png" &
pid=$!
while [[ -e /proc/$pid ]] && ! compgen -G "$out/first/edits/*" >/dev/null; do sleep 0.01; done  # it is being stored
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
