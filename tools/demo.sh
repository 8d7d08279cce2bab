#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# demo.sh PROGRAM OUT: photographs to object, a painted edit, another light, a model file; then a page with the pictures.
set -euo pipefail

readonly program=$1 out=$2 sample=samples/spot time=${CEI3D_DEMO_TIME:-90s}
readonly object=$out/object

step() { printf '\n== %s\n' "$1"; shift; printf '   cei3d %s\n' "$*"; "$program" "$@"; }

# figure FILE CAPTION
figure() { printf '<figure><img src="%s"><figcaption>%s</figcaption></figure>\n' "$1" "$2"; }

# row TITLE, then figures on standard input
row() { printf '<h2>%s</h2><div>\n' "$1"; cat; printf '</div>\n'; }

page() {
  cat <<'HTML'
<!doctype html><meta charset="utf-8"><title>CEI-3D demo</title>
<style>body{font:16px sans-serif;margin:2em;max-width:70em}div{display:flex;flex-wrap:wrap;gap:1em}
figure{margin:0}img{width:192px;background:#fff;border:1px solid #ddd}figcaption{font-size:80%}
iframe{width:100%;height:30em;border:1px solid #ddd}</style>
<h1>Spot: photographs to an editable object</h1>
<iframe src="spot.html" title="The painted object, live"></iframe>
<p><a href="spot.html">The painted object, live</a> · <a href="spot.glb">spot.glb</a> · <a href="spot.env.hdr">its light</a></p>
HTML
  for v in r_004 r_034; do
    cp "$sample/test/$v.png" "$out/photo_$v.png"
    { figure "photo_$v.png" "photograph, held out"; figure "before/rgb/$v.png" "our render"
      figure "before/albedo/$v.png" "albedo"; figure "before/normal/$v.png" "normals"; } | row "Reconstruction, view $v"
    { figure "painted/rgb/$v.png" "painted"; figure "painted/albedo/$v.png" "its albedo"
      figure "relit/rgb/$v.png" "another light"; figure "turned/rgb/$v.png" "the same light, turned by 90 degrees"; } |
      row "Edits, view $v"
  done
  for f in "$out"/turntable/rgb/*.png; do figure "turntable/rgb/$(basename "$f")" "$(basename "$f" .png)"; done | row "Turntable"
}

mkdir -p "$out"
rm -rf "$object" "$out"/{before,painted,relit,turned,turntable}
step "Understanding the photographs" check "$sample"
step "Reconstructing ($time of training)" reconstruct "$sample" -o "$object" --time "$time"
step "Held-out views" render "$object" -o "$out/before" --cameras "$sample:test" --channels rgb,albedo,normal
step "How close they are" eval "$object" "$sample:test"
step "Painting on one view" edit "$object" paint --view train/r_055 --scribble "$sample/edits/paint/scribble.png"
step "The painted object in views nobody painted on" \
  render "$object" -o "$out/painted" --cameras "$sample:test" --channels rgb,albedo
step "Another light" render "$object" -o "$out/relit" --cameras "$sample:test" --env "$sample/envs/venice.hdr"
step "The same light, turned" render "$object" -o "$out/turned" --cameras "$sample:test" --env "$sample/envs/venice.hdr" --env-rotate 90
step "All around" render "$object" -o "$out/turntable" --turntable 12 --size 384x384
step "A model file" export "$object" -o "$out/spot.glb" --light fit
step "A page that shows it" export "$object" -o "$out/spot.html"
page >"$out/index.html"

cat <<TEXT

Done. Look at
  $out/index.html   all pictures on one page
  $out/painted/rgb  the painted object (take it back: $program undo $object)
  $out/turntable/rgb
  $out/spot.html    the object, live, in one file
  $out/spot.glb     the textured model, for Blender and the like; its light: $out/spot.env.hdr
  $object       the project: $program edit $object paint -h
TEXT
