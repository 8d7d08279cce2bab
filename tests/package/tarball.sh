# SPDX-License-Identifier: Apache-2.0
# tarball.sh FILE.tar.gz [TIME]: in a tree that has nothing but glibc, the unpacked program finds all its libraries beside
# itself, wherever it is unpacked, and `cei3d demo` makes an edited object.
source "$(dirname "$0")/lib.sh"
readonly tarball=$1 time=${2:-20s}
name=$(basename "$tarball" .tar.gz)
readonly loader=/lib64/ld-linux-x86-64.so.2

say "A tree that has nothing but glibc"
mkdir -p "$tree"/{proc,tmp,root,lib64,usr/bin,usr/lib/x86_64-linux-gnu,opt,srv/other}
cp -L "$loader" "$tree/lib64"
ln -s usr/lib "$tree/lib"
for library in c m dl rt pthread resolv; do
  cp -L "$(ldconfig -p | awk -v "name=lib$library.so.[0-9]" '$1 ~ name && /x86-64/ {print $NF; exit}')" "$tree/usr/lib/x86_64-linux-gnu"
done
mount -t proc proc "$tree/proc"
tar -C "$tree/opt" -xzf "$tarball"
cp -r "$tree/opt/$name" "$tree/srv/other/cei3d"

for place in "/opt/$name" /srv/other/cei3d; do
  list=$(chroot "$tree" "$loader" --list "$place/bin/cei3d")
  ! grep 'not found' <<<"$list" || fail "libraries are missing"
  others=$(awk '$3 ~ /^\// {print $3}' <<<"$list" | grep -v "^$place/" | grep -Ev '/lib(c|m|dl|rt|pthread|resolv)\.so\.[0-9]$' || true)
  [[ -z $others ]] || fail "neither glibc nor beside the program: $others"
  say "$place: $(grep -c "=> $place/" <<<"$list") libraries beside the program"
done
for library in "$tree/opt/$name"/lib/*; do
  grep -q "$(basename "$library")" <<<"$list" || fail "$library is of no use"
done

# The newest symbols of glibc that are asked for.
symbols() { objdump -T "$tree/opt/$name/bin/cei3d" "$tree/opt/$name"/lib/* 2>/dev/null | grep '\*UND\*' | grep -o 'GLIBC_[0-9.]*' | sort -uV; }
say "needs glibc $(symbols | tail -1 | cut -d_ -f2) or newer"

say "cei3d demo"
run() { env -i PATH="$PATH" LC_ALL=C.UTF-8 HOME=/root chroot "$tree" "/srv/other/cei3d/bin/cei3d" "$@"; }
run doctor
run demo --time "$time" -o /root/demo
check_demo "$tree/root/demo"
