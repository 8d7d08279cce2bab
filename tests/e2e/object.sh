# SPDX-License-Identifier: Apache-2.0
# Photographs to an object, looked at. The other tests copy it.
source "$(dirname "$0")/lib.sh"

cei3d check "$sample" | grep '50' >/dev/null || fail "check does not find the 50 training views"
cei3d reconstruct "$sample" -o "$object" "${small[@]}"
compgen -G "$object/cache/vertex-light-*" >/dev/null || fail "the first picture of the object has to wait for its light"
cei3d info "$object"
cei3d render "$object" -o "$out/views" --cameras "$sample:test" --channels rgb,albedo,diffuse,specular,normal,depth,mask --size 96x96
for channel in rgb albedo diffuse specular normal depth mask; do
  [[ $(ls "$out/views/$channel" | wc -l) == 8 ]] || fail "not 8 pictures in $out/views/$channel"
done
cei3d eval "$object" "$sample:test" --samples 1 --json "$out/eval.json"
refused 1 'has no val views; it has train, test' eval "$object" "$sample:val"
# A blurred cow from two seconds of training is about 21 dB on white; an empty picture is at 11, a wrong camera at 13.
psnr=$(grep -o '"psnr": *[0-9.]*' "$out/eval.json" | head -1 | grep -o '[0-9.]*$')
awk -v p="$psnr" 'BEGIN {exit !(p > 19)}' || fail "only $psnr dB"
