# SPDX-License-Identifier: Apache-2.0
# The paper's evaluation in one command: a report, kept rows, an interruption, and an object from smaller photographs.
source "$(dirname "$0")/lib.sh"

paint=(--view train/r_055 --scribble "$sample/edits/paint/scribble.png" --truth "$sample/edits/paint/gt"
       --mask "$sample/edits/paint/mask")
evaluate() {
  cei3d evaluate "$sample" -o "$out/report" --project "$object" "${paint[@]}" --samples 1 --iterations 10 --seed 7 \
    --views 500 --downscales 8 "$@"
}

evaluate --only paint >"$out/first.md"
[[ -s $out/report/rows/paint-none.json ]] || fail "the ablation was not run"
[[ -s $out/report/pictures/paint-none/r_004.png ]] || fail "no pictures of the edits"
cp "$out/report/rows/paint.json" "$out/paint.json"

evaluate --only sizes,views >"$out/second.md" 2>"$out/stderr"
same "$out/paint.json" "$out/report/rows/paint.json"
grep -Eq '500.*50' "$out/stderr" || fail "says nothing of the views that are not there"
grep -q '1/8' "$out/report/report.md" || fail "no smaller photographs in the report"
evaluate --only sizes,views --json >"$out/third.json"
python3 - "$out/third.json" "$out/report/report.json" <<'PY' || fail "what was finished was made again"
import json, sys
answer, file = (json.load(open(f)) for f in sys.argv[1:])
assert answer == file
assert answer['sizes'][0]['scores']['psnr'] > 10 and answer['paint'][0]['scores']['edit']['iou'] > 0.5
PY
cei3d log "$object" --json | grep '"edits": \[\]' >/dev/null || fail "the object that was evaluated was edited"

refused 2 'shapes' evaluate "$sample" -o "$out/none" --only paint,shapes
refused 2 '--scribble' evaluate "$sample" -o "$out/none" --view train/r_055
refused 2 '--part-mask' evaluate "$sample" -o "$out/none" "${paint[@]}" --part-truth "$sample/gt"
refused 2 '--views' evaluate "$sample" -o "$out/none" --views 10,0
refused 2 'r_999' evaluate "$sample" -o "$out/none" --view r_999 --scribble "$sample/edits/paint/scribble.png"
absent "$out/none"
