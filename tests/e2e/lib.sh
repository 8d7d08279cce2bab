# SPDX-License-Identifier: Apache-2.0
# Shared by the end-to-end tests: TEST.sh PROGRAM FOLDER. The folder is emptied; `object` is the one that object.sh made.
set -euo pipefail

readonly program=$1 out=$2 sample=samples/spot
readonly object=${out%/*}/object/object
# Small enough for a test, long enough that a cow comes out.
# Without a correction, since pictures are compared with those that pages draw, which have none.
readonly small=(--iterations 60 --downscale 2 --seed 7 --set max_residual_pixels=0)

rm -rf "$out"
mkdir -p "$out"

fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }

cei3d() { "$program" "$@"; }

# The project as it is for everybody who compares: what it holds, not when or where it was made.
contents() {
  (cd "$1" && find objects -type f | sort && cat stack.json)
}

same() { cmp -s "$1" "$2" || fail "$1 and $2 differ"; }

# same_pictures DIR DIR: the same files with the same bytes, but for the record of the run.
same_pictures() { diff -rq -x render.json "$1" "$2" || fail "$1 and $2 differ"; }

# refused CODE PATTERN ARGUMENTS...: the program exits with the code, says one sentence that matches, and no more.
refused() {
  local code=$1 pattern=$2 status=0
  shift 2
  cei3d "$@" >"$out/stdout" 2>"$out/stderr" || status=$?
  [[ $status == "$code" ]] || fail "exit code $status, expected $code: cei3d $* -- $(cat "$out/stderr")"
  grep -Eqi -- "$pattern" "$out/stderr" || fail "no /$pattern/ in what cei3d $* says: $(cat "$out/stderr")"
  ! grep -Eq 'terminate called|what\(\)|Assertion' "$out/stderr" || fail "cei3d $* crashed: $(cat "$out/stderr")"
  [[ ! -s $out/stdout ]] || fail "cei3d $* failed and still printed: $(cat "$out/stdout")"
}

absent() { [[ ! -e $1 ]] || fail "$1 was written"; }
