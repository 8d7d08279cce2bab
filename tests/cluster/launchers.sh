#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Several launchers and workers at once, and a launcher that is killed: every object is made once.
source "$(dirname "$0")/lib.sh"

echo "two launchers at once"
stubs 20 0.1 >"$out/m.jsonl"
batch run "$out/m.jsonl" -o "$out/two" --jobs 2 --quiet & first=$!
batch run "$out/m.jsonl" -o "$out/two" --jobs 2 --quiet & second=$!
wait "$first"
wait "$second"
expect finished "$(count "$out/two" "done")" 20
expect attempts "$(attempts "$out/two")" 20
expect leftovers "$(leftovers "$out/two")" 0

echo "two workers that want the same object"
stubs 1 1 >"$out/m.jsonl"
batch run "$out/m.jsonl" -o "$out/race" --dry-run --quiet
codes=()
batch work "$out/m.jsonl" -o "$out/race" --index 0 --quiet 2>/dev/null & first=$!
batch work "$out/m.jsonl" -o "$out/race" --index 0 --quiet 2>/dev/null & second=$!
for worker in "$first" "$second"; do
  code=0
  wait "$worker" || code=$?
  codes+=("$code")
done
expect "exit codes" "$(printf '%s\n' "${codes[@]}" | sort -n | xargs)" "0 75"
expect attempts "$(attempts "$out/race")" 1

echo "eight workers that take what is free"
stubs 20 0.1 >"$out/m.jsonl"
batch run "$out/m.jsonl" -o "$out/claim" --dry-run --quiet
workers=()
for ((w = 0; w < 8; ++w)); do
  batch work "$out/m.jsonl" -o "$out/claim" --claim --quiet & workers+=($!)
done
for worker in "${workers[@]}"; do wait "$worker"; done
expect finished "$(count "$out/claim" "done")" 20
expect attempts "$(attempts "$out/claim")" 20

echo "a launcher that is killed"
stubs 6 1 >"$out/m.jsonl"
"$program" batch run "$out/m.jsonl" -o "$out/parent" --jobs 2 --quiet & first=$!
for ((i = 0; i < 200; ++i)); do compgen -G "$out/parent/items/*/*/state.json" >/dev/null && break; sleep 0.1; done
sleep 0.4 # the next ones have begun
kill -9 "$first"
wait "$first" 2>/dev/null || true
finished=$(grep -l '"state":"done"' "$out"/parent/items/*/*/state.json)
# shellcheck disable=SC2086 # a list of files
sha256sum $finished >"$out/parent.sums"
batch run "$out/m.jsonl" -o "$out/parent" --jobs 2 --quiet
expect finished "$(count "$out/parent" "done")" 6
sha256sum --check --quiet "$out/parent.sums" || fail "an object that was done was made again"
(($(attempts "$out/parent") > 6)) || fail "it was killed while nothing was being made"
echo "  $(wc -l <"$out/parent.sums") were done when it was killed; attempts $(attempts "$out/parent")"
echo "all fine"
