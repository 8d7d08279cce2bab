# SPDX-License-Identifier: Apache-2.0
# deb.sh FILE.deb [TIME]: in a tree that holds nothing but a minimal system of this release, the package is installed by
# one command, and `cei3d demo` then makes an edited object. Removed again, it leaves nothing.
source "$(dirname "$0")/lib.sh"
readonly package=$1 time=${2:-20s}
[[ -f $package ]] || fail "no such file: $package"
command -v mmdebstrap >/dev/null || skip "no mmdebstrap"
# shellcheck source=/dev/null
release=$(. /etc/os-release && echo "$VERSION_CODENAME")

say "A minimal $release"
sources=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/debian.sources 2>/dev/null || true)
mmdebstrap --quiet --variant=apt "$release" "$tree" - <<<"$sources" || skip "no $release from the network"
mount -t proc proc "$tree/proc"
cp /etc/resolv.conf "$tree/etc/"
cp "$package" "$tree/root/cei3d.deb"
! enter cei3d --version 2>/dev/null || fail "the tree has a cei3d already"
enter find / -xdev -type f | sort >"$tree/root/before"

say "Installing"
started=$(date +%s)
enter apt-get update -qq
enter env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends /root/cei3d.deb >"$tree/root/log" 2>&1 ||
  { cat "$tree/root/log"; fail "apt-get install"; }
installed=$(date +%s)
enter cei3d doctor

say "cei3d demo"
enter sh -c "cd /root && cei3d demo --time $time"
check_demo "$tree/root/cei3d-demo"
say "$(grep -c '^Setting up' "$tree/root/log") packages installed in $((installed - started)) s, demo in $(($(date +%s) - installed)) s"

enter apt-get purge -y -qq cei3d >/dev/null
left=$(enter find / -xdev -name '*cei3d*' -not -path '/root/*' -not -path '/var/lib/dpkg/*')
[[ -z $left ]] || fail "left behind: $left"
