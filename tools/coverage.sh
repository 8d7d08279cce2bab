#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# coverage.sh FOLDER: what the programs of a build with counters have run. Prints the lines of src that were run: of all, of
# the groups below and of the files with the most lines that were not. FOLDER/report/index.html shows each line.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$1
mkdir -p "$folder/report"
gcovr --root . --object-directory "$folder" --filter 'src/' --exclude '.*_test\.cpp' --exclude '.*/test_[a-z_]*\.h' \
  --exclude-throw-branches --gcov-ignore-parse-errors -j "$(nproc)" --json "$folder/report/coverage.json" \
  --html-details "$folder/report/index.html" "$folder"
python3 tools/coverage_summary.py "$folder/report/coverage.json"
