#!/bin/bash
# The Debian packages where nothing else is: a bare Debian 12 (debootstrap, as root), the packages installed by apt with what they ask for, and the
# main job: bench/package.sh [FOLDER]   (2 GB; packages of `cmake --preset package`, or of the build that BUILD names)
set -eu
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
bare=${1:-$(mktemp -d)}/bare
mirror=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null | sed -n 's/^\(deb\|URIs:\) *\(\[[^]]*\] \)\?\(http[^ ]*\).*/\3/p' | head -n 1)
cd "$top"
build=${BUILD:-build/package}
[ -n "${BUILD:-}" ] || cmake --preset package >/dev/null
cmake --build "$build" --target package
[ -d "$bare/usr" ] || debootstrap --variant=minbase bookworm "$bare" "$mirror"
cp /etc/apt/apt.conf.d/*proxy* "$bare/etc/apt/apt.conf.d/" 2>/dev/null || true
cp "$build"/*.deb "$bare/tmp/"
chroot "$bare" bash -ec '
  apt-get update -q >/dev/null
  time apt-get install -q -y --no-install-recommends /tmp/driftwright_*.deb >/tmp/apt.log
  cp -r /usr/share/driftwright/scenarios /tmp/scenarios
  cd /tmp
  time driftwright run scenarios/fp3_spindle.yaml -o results --force
  ls -l results/report.html results/fields.pvd
  apt-get install -q -y --no-install-recommends /tmp/libdriftwright*.deb >>/tmp/apt.log
  apt-get purge -q -y driftwright libdriftwright-dev >>/tmp/apt.log
  [ ! -e /usr/share/driftwright ] && [ ! -e /usr/bin/driftwright ]'
echo "package: installs, runs the main job and leaves nothing behind"
