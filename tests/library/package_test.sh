#!/bin/bash
# The Debian packages: whole by lintian, and a program that runs from where they put it: package_test.sh BUILD_FOLDER FOLDER_OF_THE_PROJECT
set -eu
build=$1 top=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$*"; exit 1; }
(cd "$build" && cpack -G DEB -B "$work" >"$work/log" 2>&1) || { tail -n 30 "$work/log"; exit 1; }
packages=("$work"/*.deb)
[ ${#packages[@]} = 3 ] || fail "these packages came out: ${packages[*]}"
# There is no address yet; CPack still calls ldconfig, beside the trigger.
lintian --fail-on error,warning --suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog,maintscript-calls-ldconfig \
  --allow-root "${packages[@]}" || fail "lintian objects"
for package in "${packages[@]}"; do dpkg-deb -x "$package" "$work/root"; done
for file in bin/driftwright share/man/man1/driftwright.1.gz share/bash-completion/completions/driftwright share/zsh/vendor-completions/_driftwright \
            share/driftwright/scenarios/lumped_spindle.yaml include/driftwright/driftwright.hpp; do
  [ -f "$work/root/usr/$file" ] || fail "no package has /usr/$file"
done
MANROFFSEQ='' man --warnings -l "$work/root/usr/share/man/man1/driftwright.1.gz" >/dev/null 2>"$work/man"
[ ! -s "$work/man" ] || fail "$(cat "$work/man")"
# One example: `installed` builds and runs all.
cmake -S "$top/examples" -B "$work/examples" -DCMAKE_PREFIX_PATH="$work/root/usr" >"$work/log" 2>&1 &&
  cmake --build "$work/examples" --target what_is_wrong >>"$work/log" 2>&1 ||
  { tail -n 30 "$work/log"; fail "an example does not build against the packages"; }
cd "$work"
"$work/root/usr/bin/driftwright" run "$work/root/usr/share/driftwright/scenarios/fp3_spindle.yaml" -o "$work/results" >"$work/said" || fail "$(cat "$work/said")"
[ -f "$work/results/report.html" ] || fail "no report"
dpkg-deb -f "$work"/driftwright_*.deb Depends | grep -q libvtk9.1 || fail "the program's package does not ask for what it needs"
echo "package: all pass"
