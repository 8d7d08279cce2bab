# SPDX-License-Identifier: Apache-2.0
# Shared by the tests of packages, which need root: they unpack and run the program in trees of their own.
set -euo pipefail
export LC_ALL=C.UTF-8

fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }
skip() { printf 'SKIP: %s: %s\n' "$(basename "$0" .sh)" "$*"; exit 77; }
say() { printf '== %s\n' "$*"; }

[[ $(id -u) == 0 ]] || skip "needs root, for chroot"

tree=$(mktemp -d)
readonly tree
leave() {
  umount "$tree/proc" 2>/dev/null || true
  mountpoint -q "$tree/proc" || rm -rf "$tree"
}
trap leave EXIT

enter() { chroot "$tree" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 "$@"; }

# What `cei3d demo` leaves behind, of the size that pictures and models have.
check_demo() { # FOLDER
  local file
  for file in index.html spot.{glb,gltf,obj,usdz,ply,html} spot.env.{hdr,exr,json} painted/rgb/r_004.png relit/rgb/r_034.png; do
    [[ $(stat -c %s "$1/$file" 2>/dev/null || echo 0) -gt 1000 ]] || fail "the demo left no $file"
  done
  [[ $(head -c 4 "$1/spot.glb") == glTF ]] || fail "spot.glb is no glTF"
  for file in spot.gltf spot_normal.png spot.env.exr; do
    grep -q "href=\"$file\"" "$1/index.html" || fail "the demo's page has no link to $file"
  done
}
