#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# growth.sh PROGRAM FOLDER [OBJECTS]: times and memory of a catalog of many objects whose only step is a stub; each stands in
# the manifest, in the scripts of job arrays, in the status and in the index.
source "$(dirname "$0")/lib.sh"
readonly n=${3:-5000}
measure() {
  local name=$1
  shift
  python3 - "$name" "$@" <<'PY'
import resource, subprocess, sys, time
start = time.time()
code = subprocess.call(sys.argv[2:], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
use = resource.getrusage(resource.RUSAGE_CHILDREN)
print(f'{sys.argv[1]:<28}{time.time() - start:8.2f} s {use.ru_maxrss / 1024:8.0f} MiB   code {code}', flush=True)
PY
}
seq 0 $((n - 1)) | awk 'BEGIN {print "id,steps,tag.shelf"} {print "object-" $1 ",stub," $1 % 97}' >"$out/objects.csv"
measure plan "$program" batch plan "$out/objects.csv" -o "$out/objects.jsonl"
measure 'prepare and write arrays' "$program" batch run "$out/objects.jsonl" -o "$out/catalog" --engine slurm --dry-run
measure 'status, nothing done' "$program" batch status "$out/catalog"
measure 'work --claim, one process' "$program" batch work "$out/objects.jsonl" -o "$out/catalog" --claim
measure 'status, all done' "$program" batch status "$out/catalog"
measure 'index .html' "$program" batch index "$out/catalog" -o "$out/catalog/index.html"
measure 'index .csv' "$program" batch index "$out/catalog" -o "$out/index.csv"
expect planned "$(wc -l <"$out/objects.jsonl")" "$n"
expect "tasks of arrays" "$(sed -n 's/^#SBATCH --array=0-\([0-9]*\)$/\1/p' "$out"/catalog/slurm/*.sh | awk '{ n += $1 + 1 } END { print n }')" "$n"
expect finished "$(count "$out/catalog" "done")" "$n"
expect "objects in pages" "$(cat "$out"/catalog/index*.html | grep -c '<tr id="object-')" "$n"
expect "lines of the table" "$(wc -l <"$out/index.csv")" $((n + 1))
printf 'inodes: %s; ' "$(find "$out/catalog/items" | wc -l)"
du -sh "$out/catalog" | cut -f1
