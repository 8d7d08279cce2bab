#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# slurm.sh PROGRAM FOLDER: a catalog on a Slurm of two nodes on this machine, of which a node and the controller are
# killed; the objects have the bits of an undisturbed run. As root.
set -euo pipefail
program=$(realpath "$1")
readonly program out=$2
command -v slurmctld >/dev/null || { echo "SKIP: Slurm is not installed (./run cluster)"; exit 77; }
rm -rf "$out"
mkdir -p "$out"
cd "$(dirname "$0")/../.."
fail() { printf 'FAILED: %s\n' "$*" >&2; squeue >&2 || true; tail -n 5 "$out"/*/slurm/*.log >&2 || true; exit 1; }
count() { "$program" batch status "$1" --json | python3 -c 'import json,sys; print(json.load(sys.stdin)[sys.argv[1]])' "$2"; }
wait_for_done() { # CATALOG N SECONDS
  for ((i = 0; i < $3; ++i)); do
    [[ $(count "$1" "done") == "$2" ]] && return
    sleep 1
  done
  fail "$1: $(count "$1" "done") of $2 after $3 s"
}
scene() { grep -o '"[0-9a-f]\{16,\}"' "$1"/items/*/"$2"/project/base/scene.json; }
same_bits() { # CATALOG CATALOG N
  for ((k = 0; k < $3; ++k)); do
    [[ $(scene "$1" "s$k") == "$(scene "$2" "s$k")" ]] || fail "s$k has other bits"
  done
}
spots() { # N ITERATIONS DOWNSCALE
  for ((k = 0; k < $1; ++k)); do
    printf '{"id":"s%s","capture":"%s","options":{"iterations":%s,"downscale":%s,"joint":0,"seed":%s},"steps":["reconstruct"]}\n' \
      "$k" "$PWD/samples/spot" "$2" "$3" "$((k + 1))"
  done
}

tools/slurm_box.sh start "$out/box"
export SLURM_CONF=$out/box/slurm.conf
trap 'scancel -u root 2>/dev/null || true; tools/slurm_box.sh stop "$out/box"' EXIT

echo "overhead: 20 stubs"
for ((k = 0; k < 20; ++k)); do echo "{\"id\":\"t$k\",\"steps\":[\"stub\"]}"; done >"$out/stubs.jsonl"
begin=$(date +%s%N)
"$program" batch run "$out/stubs.jsonl" -o "$out/stubs" --engine slurm --threads 1 --memory 500M
wait_for_done "$out/stubs" 20 60
echo "  $((($(date +%s%N) - begin) / 20000000)) ms an object"

echo "an undisturbed run here, one core an object"
spots 3 40 2 >"$out/m.jsonl"
begin=$(date +%s)
"$program" batch run "$out/m.jsonl" -o "$out/here" --jobs 2 --quiet
echo "  $(($(date +%s) - begin)) s"

echo "a node and the controller are killed"
"$program" batch run "$out/m.jsonl" -o "$out/nodes" --engine slurm --threads 1 --memory 1G
for ((i = 0; i < 100; ++i)); do compgen -G "$out/nodes/items/*/*/work-*/project/base/*.ckpt.json" >/dev/null && break; sleep 0.5; done
begin=$(date +%s)
# The node with all that runs on it: its daemon, and the processes of its tasks.
worker=$(cat "$out"/nodes/items/*/*/attempt-* | grep '"host":"n1"' | grep -o '"pid":[0-9]*' | cut -d: -f2 | head -1)
[[ -n $worker ]] || fail "nothing runs on n1"
script=$(ps -o ppid= -p "$worker" | tr -d ' ')
step=$(ps -o ppid= -p "$script" | tr -d ' ')
kill -9 "$(cat "$out/box/n1.pid")" "$step" "$script" "$worker"
kill -9 "$(cat "$out/box/slurmctld.pid")"
sleep 2
tools/slurm_box.sh controller "$out/box"
sleep 12
tools/slurm_box.sh node "$out/box" n1
wait_for_done "$out/nodes" 3 240
echo "  done $(($(date +%s) - begin)) s after the kill; attempts $(cat "$out"/nodes/items/*/*/state.json | grep -o '"attempt":[0-9]*' | xargs)"
same_bits "$out/here" "$out/nodes" 3
echo "all fine"
