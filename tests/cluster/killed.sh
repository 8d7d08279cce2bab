#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Workers that are killed, against an undisturbed run; captures that cannot be used among good ones.
source "$(dirname "$0")/lib.sh"
readonly n=6
spots $n 40 4 >"$out/m.jsonl"

echo "an undisturbed run"
batch run "$out/m.jsonl" -o "$out/calm" --jobs 2 --quiet

echo "three workers are killed"
batch run "$out/m.jsonl" -o "$out/wild" --jobs 2 --retries 10 --quiet >/dev/null 2>&1 & first=$!
killed=0
while ((killed < 3)) && kill -0 "$first" 2>/dev/null; do
  sleep 3
  victim=$(pgrep -f -- "batch work $out/wild/" | shuf -n 1 || true)
  [[ -n $victim ]] && kill -9 "$victim" && killed=$((killed + 1))
done
wait "$first" || fail "the run did not end well"
expect killed "$killed" 3
expect finished "$(count "$out/wild" "done")" $n
same_bits "$out/calm" "$out/wild" $n
expect attempts "$(attempts "$out/wild")" $((n + 3))
expect leftovers "$(leftovers "$out/wild")" 0
echo "  attempts $(attempts "$out/wild") instead of $(attempts "$out/calm"); the same bits"

echo "empty masks, a truncated file and a missing folder among six"
mkdir -p "$out/truncated"
head -c 900 "$sample/transforms_train.json" >"$out/truncated/transforms_train.json"
cp -r "$sample" "$out/empty"
for f in "$out"/empty/train/*.png; do cp tests/e2e/data/empty_192.png "$f"; done
for i in 0 1 2; do printf '{"id":"good%s","capture":"%s","steps":["check"]}\n' "$i" "$sample"; done >"$out/m.jsonl"
for i in empty truncated missing; do printf '{"id":"%s","capture":"%s/%s","steps":["check"]}\n' "$i" "$out" "$i"; done >>"$out/m.jsonl"
expect "exit code" "$(code_of batch run "$out/m.jsonl" -o "$out/bad" --jobs 2 --quiet)" 1
expect finished "$(count "$out/bad" "done")" 3
expect failed "$(count "$out/bad" failed)" 3
batch status "$out/bad" --failed >"$out/failed"
for said in 'empty: .*(mask|alpha|empty)' 'truncated: .*JSON' 'missing: .*(no such|not found|does not exist|capture)'; do
  grep -Ei "^$said" "$out/failed" >/dev/null || fail "no /$said/ in: $(cat "$out/failed")"
done
expect "exit code, again" "$(code_of batch run "$out/m.jsonl" -o "$out/bad" --jobs 2 --quiet)" 1
expect "attempts after the second run" "$(attempts "$out/bad")" 6
echo "all fine"
