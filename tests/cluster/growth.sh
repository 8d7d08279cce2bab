#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# growth.sh PROGRAM FOLDER [OBJECTS]: times and memory of a catalog of many objects whose only step is a stub.
set -euo pipefail
readonly program=$1 out=$2 n=${3:-100000}
rm -rf "$out"
mkdir -p "$out"
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
printf 'objects done: %s; inodes: %s; ' "$("$program" batch status "$out/catalog" --json | python3 -c 'import json,sys; print(json.load(sys.stdin)["done"])')" "$(find "$out/catalog/items" | wc -l)"
du -sh "$out/catalog" | cut -f1
