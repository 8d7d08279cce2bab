#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# catalog_throughput.sh PROGRAM FOLDER [OBJECTS]: objects an hour of a catalog of small objects on this machine, whose cores are
# two Slurm nodes of one core, or are given to one object each, or all to one object after another. As root, with nothing else
# running; the bits of all are compared.
source "$(dirname "$0")/../tests/cluster/lib.sh"
readonly n=${3:-24}
spots "$n" 40 4 >"$out/m.jsonl"

# measure WHAT COMMAND...: sets `rate`, objects an hour.
measure() {
  local begin
  begin=$(date +%s%N)
  "${@:2}"
  rate=$(awk -v n="$n" -v ns="$(($(date +%s%N) - begin))" 'BEGIN { printf "%.1f", n * 3600e9 / ns }')
  printf '%-44s%8s objects an hour\n' "$1" "$rate"
}
# Looks seldom and cheaply: what looks takes time from the cores that are measured.
on_nodes() { # CATALOG OPTIONS...
  on_slurm "$out/$1" "${@:2}"
  while (($(cat "$out/$1"/items/*/*/state.json 2>/dev/null | grep -o '"state":"done"' | wc -l) < n)); do sleep 2; done
}
share() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.1f %%", 100 * a / b }'; }

batch run "$out/m.jsonl" -o "$out/warm" --jobs 2 --quiet --dry-run # reads the manifest: files are in memory for all
measure "one core an object, $(nproc) at once" batch run "$out/m.jsonl" -o "$out/many" --jobs "$(nproc)" --threads 1 --quiet
many=$rate
start_slurm
measure "two Slurm nodes of one core" on_nodes nodes
echo "Slurm against one core an object here: $(share "$rate" "$many")"
measure "the same, four objects a task (--pack 4)" on_nodes packed --pack 4
echo "packed: $(share "$rate" "$many")"
measure "all cores for one object after another" batch run "$out/m.jsonl" -o "$out/one" --jobs 1 --threads "$(nproc)" --quiet
echo "one core an object against all cores for one: $(share "$many" "$rate")"
for catalog in nodes packed one; do same_bits "$out/many" "$out/$catalog" "$n"; done
