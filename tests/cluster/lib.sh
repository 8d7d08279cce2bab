# SPDX-License-Identifier: Apache-2.0
# Shared by the tests of catalogs: TEST.sh PROGRAM FOLDER. The folder is emptied.
set -euo pipefail

program=$(realpath "$1")
rm -rf "$2"
mkdir -p "$2"
out=$(realpath "$2")
readonly program out
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
readonly sample=$PWD/samples/spot

fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }
skip() { printf 'SKIP: %s\n' "$*"; exit 77; }
batch() { "$program" batch "$@"; }
expect() { [[ $2 == "$3" ]] || fail "$1: $2, expected $3"; } # WHAT FOUND EXPECTED

# code_of COMMAND...: its exit code; what it says on standard error is in $out/said.
code_of() {
  local code=0
  "$@" >/dev/null 2>"$out/said" || code=$?
  echo "$code"
}

# A number of `batch status`.
count() { # CATALOG NAME
  batch status "$1" --json | python3 -c 'import json,sys; print(json.load(sys.stdin)[sys.argv[1]])' "$2"
}

# The attempts of all objects of a catalog: their number, if nothing was done twice.
attempts() { cat "$1"/items/*/*/state.json | grep -o '"attempt":[0-9]*' | awk -F: '{ n += $2 } END { print n }'; }

leftovers() { find "$1"/items -name 'work-*' -o -name 'attempt-*' -o -name '*.tmp-*' | wc -l; }

stubs() { # N SECONDS: a manifest
  for ((i = 0; i < $1; ++i)); do printf '{"id":"o%s","steps":["stub"],"stub_seconds":%s}\n' "$i" "$2"; done
}

# A manifest of small objects s0, s1, ..., each of another seed.
spots() { # N ITERATIONS DOWNSCALE
  for ((i = 0; i < $1; ++i)); do
    printf '{"id":"s%s","capture":"%s","options":{"iterations":%s,"downscale":%s,"joint":0,"views":10,"light":"world","seed":%s},"steps":["reconstruct"]}\n' \
      "$i" "$sample" "$2" "$3" "$((i + 1))"
  done
}

# The bits of an object: the hashes of its tensors.
scene() { grep -o '"[0-9a-f]\{16,\}"' "$1"/items/*/"$2"/project/base/scene.json; } # CATALOG ID
same_bits() { # CATALOG CATALOG N
  for ((i = 0; i < $3; ++i)); do
    [[ -n $(scene "$1" "s$i") && $(scene "$1" "s$i") == "$(scene "$2" "s$i")" ]] || fail "s$i of $2 has other bits"
  done
}

# Slurm of two nodes of one core in $out/box, which ends with the test.
start_slurm() {
  command -v slurmctld >/dev/null || skip "catalogs on Slurm: not installed (./run cluster)"
  [[ $(id -u) == 0 ]] || skip "catalogs on Slurm: needs root"
  trap stop_slurm EXIT
  tools/slurm_box.sh start "$out/box"
  export SLURM_CONF=$out/box/slurm.conf
}

stop_slurm() {
  local -r code=$?
  if ((code != 0)); then
    squeue >&2 || true
    tail -n 5 "$out"/*/slurm/*.log >&2 || true
  fi
  scancel -u root 2>/dev/null || true
  tools/slurm_box.sh stop "$out/box"
}

on_slurm() { # CATALOG OPTIONS...: submits $out/m.jsonl
  batch run "$out/m.jsonl" -o "$1" --engine slurm --threads 1 --memory 1G --quiet "${@:2}"
}

wait_for_done() { # CATALOG N SECONDS
  for ((i = 0; i < $3; ++i)); do
    [[ $(count "$1" "done") == "$2" ]] && return
    sleep 1
  done
  fail "$1: $(count "$1" "done") of $2 after $3 s"
}

seconds_since() { echo $(($(date +%s) - $1)); }
