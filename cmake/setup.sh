# Sourced by ./driftwright and ./test: installs missing Debian packages, configures and builds. Speaks on standard error
# only, asks nothing, and costs a few hundredths of a second when there is nothing to do.

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build="$top/build/release"

say() { printf '%s\n' "$*" >&2; }

install_packages() {
  local stamp="$build/packages.stamp" wanted missing=() as_root=()
  cmp -s "$top/packages.txt" "$stamp" && return 0
  command -v dpkg-query >/dev/null || { say "driftwright: no dpkg here; install by hand what packages.txt lists (names of Debian 12)"; return 0; }
  wanted=$(grep -v '^#' "$top/packages.txt")
  for package in $wanted; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
  done
  if [ ${#missing[@]} -gt 0 ]; then
    if [ "$(id -u)" -ne 0 ]; then
      command -v sudo >/dev/null || { say "driftwright: as root, please: apt-get install ${missing[*]}"; exit 1; }
      as_root=(sudo)
      [ -t 0 ] || as_root=(sudo -n)   # in a pipe nobody can type a password
    fi
    say "driftwright: installing Debian packages: ${missing[*]}"
    local log="$build/packages.log"
    mkdir -p "$build"
    if ! { "${as_root[@]}" apt-get update -q && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
           apt-get install -q -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1 </dev/null; then
      tail -n 15 "$log" >&2
      say "driftwright: the packages could not be installed; the whole story is in $log"
      exit 1
    fi
  fi
  mkdir -p "$build" && cp "$top/packages.txt" "$stamp"
}

# build_target TARGET: configures once, then lets Ninja look at what has changed.
build_target() {
  local log="$build/build.log"
  mkdir -p "$build"
  exec 9>"$build/lock" && flock 9   # two calls at once build one after the other
  install_packages
  if [ ! -f "$build/build.ninja" ]; then
    say "driftwright: configuring (Release)"
    (cd "$top" && cmake --preset release) >"$log" 2>&1 || { tail -n 30 "$log" >&2; say "driftwright: configuring failed; see $log"; exit 1; }
  fi
  if [ -t 2 ]; then
    # A dry run tells whether there is work: Ninja's progress line appears only then.
    if ! ninja -C "$build" -n "$1" | grep -q 'no work to do'; then
      say "driftwright: building (Release)"
      ninja -C "$build" "$1" >&2 || { say "driftwright: the build failed"; exit 1; }
    fi
  else
    ninja -C "$build" "$1" >"$log" 2>&1 || { tail -n 40 "$log" >&2; say "driftwright: the build failed; see $log"; exit 1; }
  fi
  exec 9>&-
}
