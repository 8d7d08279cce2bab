#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Disks that are full and file systems that go away: nothing half is published, and when they are back, objects have the
# bits of an undisturbed run. As root, because file systems are mounted.
source "$(dirname "$0")/lib.sh"
[[ $(id -u) == 0 ]] || skip "disks and file systems of catalogs: needs root, to mount"
readonly disk=$out/disk
mkdir "$disk"
mount -t tmpfs -o size=600k none "$disk" || skip "disks and file systems of catalogs: cannot mount"
unmount_all() {
  umount -l "$out/share" 2>/dev/null || true
  umount -l "$disk" 2>/dev/null || true
}
trap unmount_all EXIT

echo "a full disk"
stubs 4 0 >"$out/m.jsonl"
batch run "$out/m.jsonl" -o "$disk/catalog" --dry-run --quiet
head -c 10M /dev/zero >"$disk/filler" 2>/dev/null || true
expect "exit code" "$(code_of batch work "$out/m.jsonl" -o "$disk/catalog" --index 0:4 --quiet)" 75
grep -i 'full\|space' "$out/said" >/dev/null || fail "no word of the disk: $(cat "$out/said")"
expect states "$(find "$disk/catalog/items" -name state.json | wc -l)" 0
rm "$disk/filler"
batch run "$out/m.jsonl" -o "$disk/catalog" --quiet
expect finished "$(count "$disk/catalog" "done")" 4

echo "a catalog that is renamed under a worker, and comes back"
stubs 1 2 >"$out/m.jsonl"
batch run "$out/m.jsonl" -o "$disk/gone" --beat 0.2 --dry-run --quiet
code=0
"$program" batch work "$out/m.jsonl" -o "$disk/gone" --index 0 --quiet 2>"$out/said" & first=$!
sleep 0.6
mv "$disk/gone" "$disk/away"
wait "$first" || code=$?
expect "exit code" "$code" 75
rm -rf "$disk/gone"
mv "$disk/away" "$disk/gone"
batch run "$out/m.jsonl" -o "$disk/gone" --beat 0.2 --quiet
expect finished "$(count "$disk/gone" "done")" 1

echo "an undisturbed run"
spots 1 20 4 >"$out/m.jsonl"
batch run "$out/m.jsonl" -o "$out/calm" --quiet

echo "a disk that fills up in a reconstruction"
rm -rf "${disk:?}"/*
mount -o remount,size=2m "$disk"
batch run "$out/m.jsonl" -o "$disk/real" --dry-run --quiet
expect "exit code" "$(code_of batch work "$out/m.jsonl" -o "$disk/real" --index 0 --quiet)" 75
grep -i 'full\|space' "$out/said" >/dev/null || fail "no word of the disk: $(cat "$out/said")"
expect "published projects" "$(find "$disk"/real/items/*/s0 -maxdepth 1 -name project | wc -l)" 0
mount -o remount,size=200m "$disk"
batch run "$out/m.jsonl" -o "$disk/real" --quiet
same_bits "$out/calm" "$disk/real" 1

echo "a file system that goes away in a reconstruction, and comes back"
mkdir "$out/server" "$out/share"
mount --bind "$out/server" "$out/share"
batch run "$out/m.jsonl" -o "$out/share/catalog" --beat 0.2 --dry-run --quiet
code=0
"$program" batch work "$out/m.jsonl" -o "$out/share/catalog" --index 0 --quiet 2>"$out/said" & first=$!
for ((i = 0; i < 3000; ++i)); do compgen -G "$out/server/catalog/items/*/s0/work-*/project/base/*.ckpt.json" >/dev/null && break; sleep 0.1; done
umount -l "$out/share"
wait "$first" || code=$?
expect "exit code" "$code" 75
grep 'file system\|share' "$out/said" >/dev/null || fail "no word of the file system: $(cat "$out/said")"
expect "states below the place where it was mounted" "$(find "$out/share" -name state.json -o -name 'scene.json' | wc -l)" 0
mount --bind "$out/server" "$out/share"
expect states "$(find "$out/share/catalog/items" -name state.json | wc -l)" 0
batch run "$out/m.jsonl" -o "$out/share/catalog" --beat 0.2 --quiet
same_bits "$out/calm" "$out/share/catalog" 1
echo "all fine"
