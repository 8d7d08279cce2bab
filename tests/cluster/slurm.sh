#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Catalogs on Slurm, of which two are submitted at once and a node and the controller are killed: objects have the bits of an
# undisturbed run. As root.
source "$(dirname "$0")/lib.sh"
start_slurm

echo "overhead: 20 stubs"
stubs 20 0 >"$out/m.jsonl"
begin=$(date +%s%N)
on_slurm "$out/stubs"
wait_for_done "$out/stubs" 20 120
echo "  $((($(date +%s%N) - begin) / 20000000)) ms an object"

echo "the same catalog is submitted twice at once"
stubs 8 0.5 >"$out/m.jsonl"
on_slurm "$out/twice" & first=$!
on_slurm "$out/twice" & second=$!
wait "$first"
wait "$second"
wait_for_done "$out/twice" 8 120
expect attempts "$(attempts "$out/twice")" 8

echo "an undisturbed run here, one core an object"
spots 2 40 4 >"$out/m.jsonl"
begin=$(date +%s)
batch run "$out/m.jsonl" -o "$out/here" --jobs 2 --quiet
echo "  $(seconds_since "$begin") s"

wait_for_checkpoint() { # CATALOG: of s0
  for ((i = 0; i < 3000; ++i)); do
    compgen -G "$1/items/*/s0/work-*/project/base/*.ckpt.json" >/dev/null && return
    sleep 0.1
  done
  fail "$1: no checkpoint"
}

recorded() { grep -o "\"$3\":\"*[a-z0-9]*" "$1"/items/*/s0/"attempt-$2" | sed 's/.*[:"]//'; } # CATALOG ATTEMPT KEY

# Kills the node that works on s0 with all that runs on it: its daemon, and the processes of its task. Sets `node`.
kill_node() { # CATALOG
  local worker script step
  worker=$(recorded "$1" 0001 pid)
  node=$(recorded "$1" 0001 host)
  script=$(ps -o ppid= -p "$worker" | tr -d ' ')
  step=$(ps -o ppid= -p "$script" | tr -d ' ')
  kill -9 "$(cat "$out/box/$node.pid")" "$step" "$script" "$worker"
}

echo "a node is killed, the other one goes on with its object"
cp "$out/m.jsonl" "$out/two.jsonl"
head -n 1 "$out/two.jsonl" >"$out/m.jsonl"
on_slurm "$out/node"
wait_for_checkpoint "$out/node"
kill_node "$out/node"
begin=$(date +%s)
for ((i = 0; i < 600; ++i)); do compgen -G "$out/node/items/*/s0/attempt-0002" >/dev/null && break; sleep 0.1; done
echo "  begun again after $(seconds_since "$begin") s"
[[ $(recorded "$out/node" 0002 host) != "$node" ]] || fail "begun again on the node that was killed"
wait_for_done "$out/node" 1 1200
same_bits "$out/here" "$out/node" 1
grep -h '"do": *"resume"' "$out"/node/items/*/s0/project/history.jsonl >/dev/null || fail "the object was begun anew"
tools/slurm_box.sh node "$out/box" "$node"

echo "the controller is killed before it has written a job down; the same command again"
stubs 4 3 >"$out/m.jsonl"
on_slurm "$out/lost"
kill -9 "$(cat "$out/box/slurmctld.pid")"
sleep 2
tools/slurm_box.sh controller "$out/box"
on_slurm "$out/lost"
wait_for_done "$out/lost" 4 200

echo "the controller is killed"
cp "$out/two.jsonl" "$out/m.jsonl"
on_slurm "$out/controller"
wait_for_checkpoint "$out/controller"
sleep 6 # the controller writes down within 5 s that a job runs; it loses jobs that began after that
kill -9 "$(cat "$out/box/slurmctld.pid")"
sleep 5
tools/slurm_box.sh controller "$out/box"
wait_for_done "$out/controller" 2 1200
same_bits "$out/here" "$out/controller" 2
expect attempts "$(attempts "$out/controller")" 2

echo "all fine"
