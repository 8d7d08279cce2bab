#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_isa.sh CXX: no weak symbol of the AVX objects may be shared with other objects: the linker would keep one copy of
# it, perhaps the one that this processor cannot run. A name that mentions Lanes<8> or Lanes<16> exists only there.
# Compiled without inlining, so that what an optimizer happens to hide is seen too.
set -euo pipefail
cd "$(dirname "$0")/.."
cxx=${1:-g++}
case $(uname -m) in x86_64 | amd64) ;; *) echo "SKIP: check_isa: not an x86 processor"; exit 77 ;; esac
object=$(mktemp --suffix .o)
trap 'rm -f "$object"' EXIT

check() {  # ISA WIDTH FLAGS...
  local isa=$1 width=$2 shared
  shift 2
  "$cxx" -std=c++20 -O1 -fno-inline -Wno-psabi -w "$@" -DCEI3D_ISA="$isa" -DCEI3D_WIDTH="$width" -Isrc \
    -c src/core/compute/cpu/run.cpp -o "$object"
  shared=$(nm -C "$object" | awk '$2 ~ /^[WVu]$/' | grep -v "Lanes<$width>\|cei3d::$isa::" || true)
  if [[ -n $shared ]]; then
    printf 'The %s object shares these symbols with others (make them HD, or local to it):\n%s\n' "$isa" "$shared"
    exit 1
  fi
}

check avx2 8 -mavx2 -mfma -mf16c
check avx512 16 -mavx512f -mavx512dq -mavx512bw -mavx512vl -mfma -mavx2
echo "isa: fine"
