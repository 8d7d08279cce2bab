# SPDX-License-Identifier: Apache-2.0
# The live editor: what the server refuses, and a first session in a browser. The latter needs what `./run web` installs.
source "$(dirname "$0")/lib.sh"

python3 tests/browser/refusals.py "$program" "$object" "$out/refusals"

browser=$(command -v chromium-headless-shell || command -v chromium || command -v google-chrome || true)
skip() { printf 'SKIP: the editor in a browser: %s\n' "$1"; exit 77; }
command -v node >/dev/null || skip "no node"
node tools/editor_keys.mjs docs/editor.md
[[ -n $browser ]] || skip "no Chromium (chromium-headless-shell)"
modules=build/web/node_modules
tools/install_web.sh >/dev/null 2>&1 || skip "no playwright-core and axe-core (./run web)"

cp -r "$object" "$out/spot"
NODE_PATH=$modules node tests/browser/editor.cjs "$program" "$out/spot" "$out/pictures" "$browser"

# The same strokes by the command line, with the camera and the scribble that the browser sent, are the same object.
cp -r "$object" "$out/again"
mapfile -t edits < <(cd "$out/spot/edits" && ls -d ./*-paint)
python3 - "$out/spot/edits/${edits[0]}/edit.json" "$out/camera.json" <<'PY'
import json, sys
stroke = json.load(open(sys.argv[1]))['params']['strokes'][0]
json.dump({'cameras': [dict(stroke['camera'], name='own')]}, open(sys.argv[2], 'w'))
PY
cei3d edit "$out/again" paint --camera "$out/camera.json" --scribble "$out/spot/edits/${edits[0]}/scribble.png"
objects() { grep -o '"object": *"[0-9a-f]*"' "$1"; }
[[ $(objects "$out/spot/edits/${edits[0]}/edit.json" | head -1) == $(objects "$out"/again/edits/*-paint/edit.json) ]] ||
  fail "browser and command line paint different objects"
