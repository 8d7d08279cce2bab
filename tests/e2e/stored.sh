# SPDX-License-Identifier: Apache-2.0
# A project that an earlier program stored opens and renders as it did then, to 1/255, with its edits and without them.
# tests/e2e/data/stored is made by: cei3d_engine_session_test --gtest_also_run_disabled_tests --gtest_filter='StoredProject.*'
source "$(dirname "$0")/lib.sh"

readonly stored=tests/e2e/data/stored
project=$out/project
cp -r "$stored/project" "$project"
as_stored() { # NAME DEVICE
  cei3d render "$project" -o "$out/$1-${2/\//-}" --channels rgb,albedo,normal,roughness --device "$2"
  python3 tests/e2e/within.py "$stored/$1" "$out/$1-${2/\//-}" || fail "$1 by $2 is not as it was stored"
}

cei3d info "$project"
[[ $(cei3d log "$project" | grep -c ' on ') == 5 ]] || fail "not five edits in the log"
as_stored edited auto
as_stored edited cpu/scalar
# Each is undone and made again, which needs what is stored of it.
for id in 0001-paint 0002-material 0003-part 0004-deform 0005-light; do
  cei3d toggle "$project" "$id"
done
as_stored plain auto
for id in 0005-light 0004-deform 0003-part 0002-material 0001-paint; do
  cei3d toggle "$project" "$id"
done
as_stored edited auto
