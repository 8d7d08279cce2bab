#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# local.sh PROGRAM FOLDER: catalogs on this machine whose workers and launchers are killed, stopped, or run out of disk.
# As root: a small file system is mounted.
set -euo pipefail
readonly program=$1 out=$2
rm -rf "$out"
mkdir -p "$out"
fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }
batch() { "$program" batch "$@"; }
count() { batch status "$1" --json | python3 -c 'import json,sys; print(json.load(sys.stdin)[sys.argv[1]])' "$2"; }
expect() { [[ $2 == "$3" ]] || fail "$1: $2, expected $3"; }
stubs() { # FILE N SECONDS
  for ((i = 0; i < $2; ++i)); do printf '{"id":"o%s","steps":["stub"],"stub_seconds":%s}\n' "$i" "$3"; done >"$1"
}
# The attempts of all objects of a catalog: their number, if nothing was done twice.
attempts() { cat "$1"/items/*/*/state.json | grep -o '"attempt":[0-9]*' | cut -d: -f2 | paste -sd+ | bc; }
workers_of() { pgrep -f -- "batch work $1" || true; }

echo "two launchers at once"
stubs "$out/m.jsonl" 20 0.1
"$program" batch run "$out/m.jsonl" -o "$out/two" --jobs 2 --quiet & first=$!
"$program" batch run "$out/m.jsonl" -o "$out/two" --jobs 2 --quiet & second=$!
wait "$first" "$second"
expect finished "$(count "$out/two" "done")" 20
expect attempts "$(attempts "$out/two")" 20

echo "a launcher that is killed, and its workers with it"
stubs "$out/m.jsonl" 6 1
"$program" batch run "$out/m.jsonl" -o "$out/parent" --jobs 2 --quiet & first=$!
sleep 1.5
kill -9 "$first"
wait "$first" 2>/dev/null || true
done_before=$(count "$out/parent" "done")
batch run "$out/m.jsonl" -o "$out/parent" --jobs 2 --quiet
expect finished "$(count "$out/parent" "done")" 6
echo "  $done_before were done when it was killed; attempts $(attempts "$out/parent")"

echo "a worker that is stopped, replaced, and goes on"
stubs "$out/m.jsonl" 1 3
batch run "$out/m.jsonl" -o "$out/brain" --beat 0.2 --dry-run --quiet
code=0
"$program" batch work "$out/m.jsonl" -o "$out/brain" --index 0 --quiet 2>"$out/brain.first" & first=$!
sleep 0.5
kill -STOP "$first"
sleep 1.5
"$program" batch work "$out/m.jsonl" -o "$out/brain" --index 0 --quiet & second=$!
sleep 1
kill -CONT "$first"
wait "$first" || code=$?
expect "exit code of the first" "$code" 75
wait "$second"
expect finished "$(count "$out/brain" "done")" 1
expect attempt "$(attempts "$out/brain")" 2
expect leftovers "$(find "$out"/brain/items -name 'work-*' -o -name 'attempt-*' | wc -l)" 0

echo "a full disk"
mkdir "$out/disk"
mount -t tmpfs -o size=600k none "$out/disk"
trap 'umount "$out/disk" 2>/dev/null || true' EXIT
stubs "$out/m.jsonl" 4 0
batch run "$out/m.jsonl" -o "$out/disk/catalog" --dry-run --quiet
head -c 10M /dev/zero >"$out/disk/filler" 2>/dev/null || true
code=0
batch work "$out/m.jsonl" -o "$out/disk/catalog" --index 0:4 --quiet 2>"$out/disk.said" || code=$?
expect "exit code on a full disk" "$code" 75
grep -i 'full\|space' "$out/disk.said" >/dev/null || fail "no word of the disk: $(cat "$out/disk.said")"
expect states "$(find "$out/disk/catalog/items" -name state.json | wc -l)" 0
rm "$out/disk/filler"
batch run "$out/m.jsonl" -o "$out/disk/catalog" --quiet
expect finished "$(count "$out/disk/catalog" "done")" 4

echo "a file system that goes away under a worker"
stubs "$out/m.jsonl" 1 2
batch run "$out/m.jsonl" -o "$out/disk/gone" --beat 0.2 --dry-run --quiet
code=0
"$program" batch work "$out/m.jsonl" -o "$out/disk/gone" --index 0 --quiet 2>"$out/gone.said" & first=$!
sleep 0.6
mv "$out/disk/gone" "$out/disk/away"
wait "$first" || code=$?
expect "exit code without a catalog" "$code" 75
rm -rf "$out/disk/gone"
mv "$out/disk/away" "$out/disk/gone"
batch run "$out/m.jsonl" -o "$out/disk/gone" --beat 0.2 --quiet
expect finished "$(count "$out/disk/gone" "done")" 1

echo "a clock that jumps by an hour while a worker lives"
stubs "$out/m.jsonl" 1 2
batch run "$out/m.jsonl" -o "$out/clock" --beat 0.2 --dry-run --quiet
"$program" batch work "$out/m.jsonl" -o "$out/clock" --index 0 --quiet & first=$!
sleep 0.5
touch -d '1 hour ago' "$out"/clock/items/*/o0/attempt-0001
code=0
batch work "$out/m.jsonl" -o "$out/clock" --index 0 --quiet 2>/dev/null || code=$?
expect "exit code of the second" "$code" 75
wait "$first"
expect attempt "$(attempts "$out/clock")" 1

echo "captures that cannot be used, and workers that are killed, against an undisturbed run"
options='"options":{"iterations":20,"downscale":4,"views":10,"joint":0},"steps":["check","reconstruct"]'
for i in 0 1; do printf '{"id":"spot%s","capture":"%s",%s}\n' "$i" "$PWD/samples/spot" "$options"; done >"$out/m.jsonl"
mkdir -p "$out/truncated"; head -c 900 samples/spot/transforms_train.json >"$out/truncated/transforms_train.json"
printf '{"id":"missing","capture":"%s"}\n{"id":"truncated","capture":"%s"}\n' "$out/missing" "$out/truncated" >>"$out/m.jsonl"
code=0
batch run "$out/m.jsonl" -o "$out/calm" --jobs 2 --quiet >"$out/calm.said" 2>&1 || code=$?
expect "exit code with bad captures" "$code" 1
expect finished "$(count "$out/calm" "done")" 2
expect failed "$(count "$out/calm" failed)" 2
"$program" batch run "$out/m.jsonl" -o "$out/wild" --jobs 2 --retries 10 --quiet >"$out/wild.said" 2>&1 & first=$!
for pause in 5 4 6; do
  sleep "$pause"
  victim=$(pgrep -f -- "batch work $out/wild/" | shuf -n 1 || true)
  [[ -z $victim ]] || kill -9 "$victim" || true
done
wait "$first" || true
expect finished "$(count "$out/wild" "done")" 2
scene() { grep -o '"[0-9a-f]\{16,\}"' "$1"/items/*/"$2"/project/base/scene.json; }
for id in spot0 spot1; do
  [[ $(scene "$out/calm" $id) == "$(scene "$out/wild" $id)" ]] || fail "$id: other bits after workers were killed"
done
echo "  attempts $(attempts "$out/wild") instead of $(attempts "$out/calm"); the same bits"
echo "all fine"
