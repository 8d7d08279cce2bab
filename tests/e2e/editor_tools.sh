# SPDX-License-Identifier: Apache-2.0
# The editor's tools for parts, shape, light and decals in a browser, and the same edits by commands. Needs what `./run web`
# installs.
source "$(dirname "$0")/lib.sh"

browser=$(command -v chromium-headless-shell || command -v chromium || command -v google-chrome || true)
skip() { printf 'SKIP: the tools of the editor in a browser: %s\n' "$1"; exit 77; }
command -v node >/dev/null || skip "no node"
[[ -n $browser ]] || skip "no Chromium (chromium-headless-shell)"
modules=build/web/node_modules
tools/install_web.sh >/dev/null 2>&1 || skip "no playwright-core and axe-core (./run web)"

cp -r "$object" "$out/spot"
cp -r "$object" "$out/again"
NODE_PATH=$modules node tests/browser/tools.cjs "$program" "$out/spot" "$out/pictures" "$browser"
python3 tests/browser/as_commands.py "$program" "$out/spot" "$out/again"
cp -r "$sample" "$out/capture"
mkdir "$out/places" "$out/places/empty"
cp -r "$object" "$out/places/object"
cp -r "$object" "$out/places/broken"
printf '{' > "$out/places/broken/base/scene.json"
NODE_PATH=$modules node tests/browser/states.cjs "$program" "$out/places" "$out/pictures" "$browser"
NODE_PATH=$modules node tests/browser/making.cjs "$program" "$out/capture" "$out/pictures" "$browser"
