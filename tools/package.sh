#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# package.sh BUILD [deb|tarball]: packages of what is built in the folder BUILD, into BUILD/package: a .deb for this release of the
# system, and a .tar.gz that brings its libraries along, for any Linux on x86-64 whose glibc is not older than this one.
# Packing the same build of the same commit again gives the same bytes.
set -euo pipefail
cd "$(dirname "$0")/.."
readonly build=$1 out=$1/package
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:[A-Z]*=//p' "$build/CMakeCache.txt")
readonly version
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || date +%s)}
export SOURCE_DATE_EPOCH
umask 022

die() { printf 'package: %s\n' "$*" >&2; exit 1; }

# What ships with glibc is the system's own.
bundled_libraries() { # PROGRAM: the files
  ldd "$1" | awk '/not found/ {print > "/dev/stderr"; exit 1} $3 ~ /^\// {print $3}' |
    grep -Ev '/(ld-linux-x86-64|lib(c|m|dl|rt|pthread|resolv|mvec|anl))\.so\.[0-9]$'
}

package_of() { # FILE: the package that it came with
  local file
  file=$(realpath "$1")
  dpkg-query -S "$file" "${file#/usr}" 2>/dev/null | head -1 | cut -d: -f1
}

# The licenses of libraries are what their packages say; texts that these refer to come along.
copy_license() { # PACKAGE FOLDER
  [[ -n $1 ]] || return 0
  cp -L "/usr/share/doc/$1/copyright" "$2/$1"
}

bundle() { # TREE
  local -r tree=$1 licenses=$1/share/doc/cei3d/licenses
  local library name
  mkdir -p "$tree/lib" "$licenses"
  while read -r library; do
    name=$(basename "$library")
    if [[ $name == libjbig.so.0 ]]; then
      cc -shared -fPIC -O2 -Wl,-soname,libjbig.so.0 tools/package/no_jbig.c -o "$tree/lib/$name"
      strip "$tree/lib/$name"
      continue
    fi
    cp -L "$library" "$tree/lib/$name"
    chmod 644 "$tree/lib/$name"
    copy_license "$(package_of "$library")" "$licenses"
  done < <(bundled_libraries "$tree/bin/cei3d")
  [[ -n $(ls "$licenses") ]] || die "no library has a license: is this a Debian?"
  cp LICENSE THIRD_PARTY.md "$tree/share/doc/cei3d"
  cp /usr/share/common-licenses/{Apache-2.0,LGPL-2.1,GPL-3} "$licenses"
  # The tag of old, which libraries that the libraries need are found by, too.
  patchelf --force-rpath --set-rpath "\$ORIGIN/../lib" "$tree/bin/cei3d"
}

tarball() {
  local -r name=cei3d-$version-linux-x86_64
  rm -rf "${out:?}/$name"
  cmake --install "$build" --prefix "$out/$name" --strip >/dev/null
  rm -rf "$out/$name/share/lintian"
  bundle "$out/$name"
  tar --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner -C "$out" -c "$name" |
    gzip -9n >"$out/$name.tar.gz"
  rm -rf "${out:?}/$name"
}

# The version stands in several files.
check_version() {
  [[ -x $build/cei3d ]] || die "there is no $build/cei3d; build it first"
  [[ $("$build/cei3d" --version) == "cei3d $version" ]] || die "src/engine/session/version.h is not of version $version"
  grep -q "^version: $version\$" CITATION.cff || die "CITATION.cff is not of version $version"
  grep -q "^## $version " CHANGELOG.md || die "CHANGELOG.md has no heading for version $version"
}

deb() {
  rm -rf "$out"/*.deb "$out/_CPack_Packages"
  (cd "$build" && cpack -G DEB >package.log 2>&1) || { cat "$build/package.log"; die "cpack failed"; }
  rm -rf "$out/_CPack_Packages"
}

check_version
mkdir -p "$out"
case ${2:-all} in
  deb) deb ;;
  tarball) tarball ;;
  all) deb; tarball ;;
  *) die "deb or tarball, not $2" ;;
esac
find "$out" -maxdepth 1 -type f \( -name '*.deb' -o -name '*.tar.gz' \) -printf '%p  %k KiB\n'
