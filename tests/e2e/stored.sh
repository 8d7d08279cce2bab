# SPDX-License-Identifier: Apache-2.0
# Projects that earlier programs stored, one of each format, open and render as they did then, to 1/255, with their edits
# and without them. Those of tests/e2e/data/formats are made, when the format changes, by:
# cei3d_engine_session_test --gtest_also_run_disabled_tests --gtest_filter='StoredProject.*'
source "$(dirname "$0")/lib.sh"

readonly formats=tests/e2e/data/formats

as_stored() { # FORMAT NAME DEVICE
  cei3d render "$project" -o "$out/$1-$2-${3/\//-}" --channels rgb,albedo,normal,roughness --device "$3"
  python3 tests/e2e/within.py "$formats/$1/$2" "$out/$1-$2-${3/\//-}" || fail "format $1: $2 by $3 is not as it was stored"
}

toggle() { # IDS...: each is undone or made again, which needs what is stored of it
  local id
  for id in "$@"; do cei3d toggle "$project" "$id"; done
}

all_files() { (cd "$project" && find . -type f ! -path './cache/*' ! -name .lock -exec sha256sum {} + | sort); }

try_format() { # FORMAT
  project=$out/project-$1
  cp -r "$formats/$1/project" "$project"
  [[ $(grep -o '"version": [0-9]*' "$project/project.json") == "\"version\": $1" ]] || fail "$project is not of format $1"
  all_files >"$out/before"
  cei3d info "$project"
  [[ $(cei3d log "$project" | grep -c ' on ') == 5 ]] || fail "format $1: not five edits in the log"
  as_stored "$1" edited auto
  as_stored "$1" edited cpu/scalar
  all_files >"$out/after"
  same "$out/before" "$out/after"
  toggle 0001-paint 0002-material 0003-part 0004-deform 0005-light
  as_stored "$1" plain auto
  toggle 0005-light 0004-deform 0003-part 0002-material 0001-paint
  as_stored "$1" edited auto
  cei3d edit "$project" material --roughness 0.9
  cei3d export "$project" -o "$out/format-$1.glb" --faces 500 --texture 64
}

# What each format brought.
set_aside() {
  cei3d log "$project" | grep '^0006-material *aside' >/dev/null || fail "format 5: nothing is set aside"
  cei3d log "$project" | grep '^0001-paint .*stripe' >/dev/null || fail "format 5: the edit has lost its name"
  cei3d restore "$project" 0006-material
  [[ $(cei3d log "$project" | grep -c ' on ') == 6 ]] || fail "format 5: what was set aside is not done again"
}

# Formats without a stored project: what a program of their day left is opened if it can be read, else refused with the name of
# the file; a newer format and none at all are refused. Nothing is changed.
other_formats() { # NEWEST
  local version
  project=$out/other
  cp -r "$formats/4/project" "$project"
  numbered() { sed -i "s/\"version\": [0-9]*/\"version\": $1/" "$project/project.json"; }
  for version in 1 2 3; do
    numbered "$version"
    cei3d info "$project" >/dev/null
  done
  sed -i '/"sphere_radius"/d; s/"output_activation": "none",/"output_activation": "none"/' "$project/base/scene.json"
  all_files >"$out/before"
  refused 1 'scene.json' render "$project" -o "$out/refused"
  numbered 0
  refused 1 'invalid format version 0' info "$project"
  numbered $(($1 + 1))
  refused 1 'newer' info "$project"
  refused 1 'newer' edit "$project" material --roughness 0.9
  numbered 3
  all_files >"$out/after"
  same "$out/before" "$out/after"
}

newest=$(sed -n 's/^inline constexpr int kProjectVersion = \([0-9]*\);$/\1/p' src/engine/project/project.h)
[[ -d $formats/$newest ]] || fail "no project of format $newest is stored in $formats"
for folder in "$formats"/*; do try_format "${folder##*/}"; done
set_aside
other_formats "$newest"
