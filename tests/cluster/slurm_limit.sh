#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# An object that takes longer than the limit of a Slurm task: saved, requeued, and at the end the bits of an undisturbed run.
# As root.
source "$(dirname "$0")/lib.sh"
start_slurm
spots 1 "${3:-600}" 4 >"$out/m.jsonl"

echo "an undisturbed run here, one core"
begin=$(date +%s)
batch run "$out/m.jsonl" -o "$out/here" --jobs 1 --quiet
echo "  $(seconds_since "$begin") s"

echo "tasks of one minute, which Slurm asks to save after 10 to 40 s: no stage between two checkpoints may take longer"
begin=$(date +%s)
on_slurm "$out/limit" --limit 1m
wait_for_done "$out/limit" 1 1500
echo "  $(seconds_since "$begin") s, $(attempts "$out/limit") attempts"
(($(attempts "$out/limit") > 1)) || fail "no task ran into its limit"
same_bits "$out/here" "$out/limit" 1
expect leftovers "$(leftovers "$out/limit")" 0
echo "all fine"
