#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# install_web.sh: the npm packages of tests/web, which lint and tests of pages and assets use, into build/web. Exit code 1
# without npm or network.
set -euo pipefail
cd "$(dirname "$0")/.."

readonly folder=build/web
command -v npm >/dev/null || { echo "install_web: npm is not installed" >&2; exit 1; }
mkdir -p "$folder"
exec 9>"$folder/lock"  # tests that run side by side ask for them at the same time
flock 9
if [[ -d $folder/node_modules ]] && cmp -s tests/web/package-lock.json "$folder/package-lock.json"; then exit 0; fi
cp tests/web/package.json "$folder/package.json"
cp tests/web/package-lock.json "$folder/package-lock.json.new"
mv "$folder/package-lock.json.new" "$folder/package-lock.json"
npm ci --silent --no-audit --no-fund --ignore-scripts --prefix "$folder" || { rm -f "$folder/package-lock.json"; exit 1; }
