# Sourced by ./driftwright and ./test: installs missing Debian packages, configures and builds. Speaks on standard error
# only, asks nothing, and costs a few hundredths of a second when there is nothing to do.

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
preset=${driftwright_preset:-release}
build="$top/build/$preset"

say() { printf '%s\n' "$*" >&2; }

# missing_packages LIST...: the packages of these lists that are not installed.
missing_packages() {
  local package
  (cd "$top" && cat "$@") | grep -v '^#' | while read -r package; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || printf '%s ' "$package"
  done
}

# install LIST...: what is missing of these lists, where apt takes nothing away for it. Fails with words.
install() {
  local missing as_root=() removed log="$build/packages.log"
  read -ra missing <<<"$(missing_packages "$@")"
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { say "driftwright: as root, please: apt-get install ${missing[*]}"; return 1; }
    as_root=(sudo)
    [ -t 0 ] || as_root=(sudo -n)   # in a pipe nobody can type a password
  fi
  say "driftwright: installing ${#missing[@]} Debian packages and what they need, in a minute or two: ${missing[*]}"
  if ! "${as_root[@]}" apt-get update -q >"$log" 2>&1 </dev/null; then
    tail -n 15 "$log" >&2
    say "driftwright: the lists of packages could not be read; the whole story is in $log"
    return 1
  fi
  removed=$(apt-get install -s --no-install-recommends "${missing[@]}" 2>/dev/null </dev/null | sed -n 's/^Remv \([^ ]*\).*/\1/p' | tr '\n' ' ')
  if [ -n "$removed" ]; then
    say "driftwright: ${missing[*]} cannot stand beside ${removed% }, which apt would remove for it; it was left as it is"
    say "driftwright: where you can do without: apt-get install --no-install-recommends ${missing[*]}"
    return 1
  fi
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
       apt-get install -q -y --no-install-recommends "${missing[@]}" >>"$log" 2>&1 </dev/null; then
    tail -n 15 "$log" >&2
    say "driftwright: the packages could not be installed; the whole story is in $log"
    return 1
  fi
}

# install_once LIST...: as install, for the lists that have changed since; what has been installed is configured for.
install_once() {
  local list changed=()
  for list in "$@"; do cmp -s "$top/$list" "$build/$list.stamp" || changed+=("$list"); done
  [ ${#changed[@]} -gt 0 ] || return 0
  if command -v dpkg-query >/dev/null; then
    install "${changed[@]}" || return 1
  else
    say "driftwright: no dpkg here; install by hand what ${changed[*]} lists (names of Debian 12)"
  fi
  configured=no
  for list in "${changed[@]}"; do cp "$top/$list" "$build/$list.stamp"; done
}

# configure: for the first time, for new packages, and where CMake's files have changed or gone.
configure() {
  if [ "$configured" = yes ] && [ -f "$build/build.ninja" ]; then
    ninja -C "$build" build.ninja >"$log" 2>&1 && return 0
  else
    say "driftwright: configuring (Release)"
    (cd "$top" && cmake --preset "$preset") >"$log" 2>&1 && return 0
  fi
  tail -n 30 "$log" >&2
  say "driftwright: configuring failed; see $log"
  return 1
}

# show_progress WHAT: of Ninja's lines "FINISHED ALL ...", on a terminal one line that moves: how far it is, and about how long it takes yet.
show_progress() {
  local line began=$SECONDS finished all rest words
  while IFS= read -r line; do
    [ -t 2 ] && [[ "$line" =~ ^([0-9]+)\ ([0-9]+)\  ]] || continue
    finished=${BASH_REMATCH[1]} all=${BASH_REMATCH[2]} words=""
    if [ "$finished" -gt 4 ]; then
      rest=$(((SECONDS - began) * (all - finished) / finished))
      words=", about $(((rest + 59) / 60)) min left"
    fi
    printf '\r\033[Kdriftwright: building %s (Release), %d %%%s' "$1" $((100 * finished / all)) "$words" >&2
  done
  [ ! -t 2 ] || printf '\r\033[K' >&2
}

# build TARGET: what Ninja finds to do. A dry run tells whether there is work; only then is there anything to see.
build() {
  ninja -C "$build" -n "$1" 2>/dev/null | grep -q 'no work to do' && return 0
  say "driftwright: building $1 (Release); the first time it takes minutes"
  (set -o pipefail; NINJA_STATUS='%f %t ' ninja -C "$build" "$1" 2>&1 | tee "$log" | show_progress "$1") && return 0
  tail -n 40 "$log" >&2
  say "driftwright: the build failed; see $log"
  return 1
}

configure_and_build() {
  configure || return 3
  build "$1"
}

# build_target TARGET LIST...: with the packages of these lists, configures where needed, then lets Ninja look at what has changed. Ends with 3
# where packages or CMake do not let it build, with 1 where a file does not compile.
build_target() {
  local target="$1" outcome=0 log="$build/build.log" configured=yes
  shift
  mkdir -p "$build"
  exec 9>"$build/lock" && flock 9   # two calls at once build one after the other
  if ! install_once "$@"; then
    outcome=3
  else
    configure_and_build "$target" || outcome=$?
    # A package may have gone since.
    if [ "$outcome" -ne 0 ] && command -v dpkg-query >/dev/null && [ -n "$(missing_packages "$@")" ]; then
      outcome=3
      if install "$@"; then
        configured=no outcome=0
        configure_and_build "$target" || outcome=$?
      fi
    fi
  fi
  exec 9>&-
  return "$outcome"
}
