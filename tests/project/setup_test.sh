#!/usr/bin/env bash
# ./driftwright and ./test of a folder of their own, with stand-ins for dpkg-query, apt-get, cmake and ninja: what they install, what they build and
# what they run where that is impossible. setup_test.sh FOLDER_OF_THE_PROJECT
set -eu
source="$1"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/bin"
export PATH="$folder/bin:$PATH" STATE="$folder/state"

stand_in() { { echo '#!/bin/bash'; cat; } >"$folder/bin/$1"; chmod +x "$folder/bin/$1"; }
# Files in $STATE: removes (what apt would take away), no_apt, no_cmake, no_compile, installed/<package>, calls.
stand_in dpkg-query <<'S'
[ -f "$STATE/installed/${!#}" ] && echo -n installed || exit 1
S
stand_in apt-get <<'S'
echo "apt-get $*" >>"$STATE/calls"
[ ! -f "$STATE/no_apt" ] || exit 100
[ "$1" = install ] || exit 0
if [ "$2" = -s ]; then [ ! -f "$STATE/removes" ] || echo "Remv $(cat "$STATE/removes") [5.11.0]"; exit 0; fi
for word in "$@"; do case "$word" in install | -*) ;; *) touch "$STATE/installed/$word" ;; esac; done
S
stand_in cmake <<'S'
echo "cmake $*" >>"$STATE/calls"
[ ! -f "$STATE/no_cmake" ] || { echo "CMake Error: no VTK"; exit 1; }
mkdir -p build/release && touch build/release/build.ninja
S
stand_in ninja <<'S'
echo "ninja $*" >>"$STATE/calls"
case "${!#}" in
  build.ninja) [ ! -f "$STATE/no_cmake" ] || { echo "CMake Error: no VTK"; exit 1; } ;;
  *)
    if [ "$3" = -n ]; then [ -f "$STATE/work" ] && echo "[1/1] main.cpp" || echo "ninja: no work to do."; exit 0; fi
    [ ! -f "$STATE/no_compile" ] || { echo "error: expected ';'"; exit 1; }
    mkdir -p "$2/app"
    printf '#!/bin/bash\nflock -n "$(dirname "$0")/../lock" true || echo locked\necho "ran $*"; exit 4\n' >"$2/app/driftwright"
    chmod +x "$2/app/driftwright"
    rm -f "$STATE/work"
    ;;
esac
S
stand_in ctest <<'S'
echo "ctest $*" >>"$STATE/calls"
S
stand_in sudo <<'S'
"$@"
S

# fresh: a clone with nothing installed and nothing built.
fresh() {
  rm -rf "$folder/clone" "$STATE"
  mkdir -p "$folder/clone/cmake" "$STATE/installed"
  cp "$source/driftwright" "$source/test" "$source/packages.txt" "$source/packages-tests.txt" "$source/packages-python.txt" "$folder/clone"
  cp "$source/cmake/setup.sh" "$source/cmake/threads.sh" "$folder/clone/cmake"
  touch "$STATE/work" "$STATE/calls"
}
# call COMMAND ARGUMENTS: $outcome, $out and $words.
call() {
  outcome=0
  out=$("$folder/clone/$1" "${@:2}" 2>"$folder/words" </dev/null) || outcome=$?
  words=$(cat "$folder/words")
}
wrong() {
  printf '%s: %s\nexit code %s, output: %s\n%s\n' "$what" "$1" "$outcome" "$out" "$words"
  exit 1
}
called() { grep -q -- "$1" "$STATE/calls"; }
runs() { [ "$outcome" -eq 4 ] && [ "$out" = "ran check a b.yaml" ] || wrong "does not run the program as it was called"; }
# program_stands: built and run once, with all packages.
program_stands() { fresh; call driftwright check 'a b.yaml'; : >"$STATE/calls"; }

what="a fresh clone"
fresh
call driftwright check 'a b.yaml'
runs
[ -f "$STATE/installed/libvtk9-dev" ] || wrong "does not install what packages.txt lists"
[ ! -f "$STATE/installed/libgtest-dev" ] || wrong "installs what tests alone need"
: >"$STATE/calls"
call driftwright check 'a b.yaml'
runs
! called apt-get && ! called cmake && [ -z "$words" ] || wrong "has something to do or to say a second time"
call test -L unit
[ -f "$STATE/installed/libgtest-dev" ] || wrong "./test does not install what tests need"
called "cmake --preset release" || wrong "./test does not configure for what it has installed"
called "ctest .*-L unit" || wrong "./test runs no tests"

what="a package that would take another away"
fresh
echo python3-paraview >"$STATE/removes"
call driftwright check 'a b.yaml'
[ "$outcome" -eq 1 ] && [ -z "$out" ] || wrong "with nothing built, something is run"
[[ "$words" == *libvtk9-dev*"cannot stand beside python3-paraview"* ]] || wrong "does not say what conflicts"
! called "apt-get install -q" || wrong "installs all the same"

what="a package taken away from a built program"
program_stands
rm "$STATE/installed/libvtk9-dev"
touch "$STATE/no_cmake"
echo python3-paraview >"$STATE/removes"
call driftwright check 'a b.yaml'
runs
[[ "$words" == *"libvtk9-dev cannot stand beside python3-paraview"*"running the program as it was built"* ]] || wrong "does not say what it runs and why"
! called "apt-get install -q" || wrong "installs all the same"

what="its header taken away from a built program"
program_stands
rm "$STATE/installed/libvtk9-dev"
touch "$STATE/work" "$STATE/no_compile" "$STATE/no_apt"
call driftwright check 'a b.yaml'
runs

what="a package taken away that can come back"
program_stands
rm "$STATE/installed/libvtk9-dev"
touch "$STATE/work"
sed -i 's|\[ ! -f "$STATE/no_compile" \]|[ -f "$STATE/installed/libvtk9-dev" ]|' "$folder/bin/ninja"
call driftwright check 'a b.yaml'
runs
[ -f "$STATE/installed/libvtk9-dev" ] && [[ "$words" != *"as it was built"* ]] || wrong "is not installed again"
sed -i 's|\[ -f "$STATE/installed/libvtk9-dev" \]|[ ! -f "$STATE/no_compile" ]|' "$folder/bin/ninja"

what="a file that does not compile"
program_stands
touch "$STATE/work" "$STATE/no_compile"
call driftwright check 'a b.yaml'
[ "$outcome" -eq 1 ] && [ -z "$out" ] && [[ "$words" == *"expected ';'"* ]] || wrong "the program of before is run, or no error shown"

what="a network that is down, a list of packages that has grown"
program_stands
echo libnew-dev >>"$folder/clone/packages.txt"
touch "$STATE/no_apt"
call driftwright check 'a b.yaml'
runs
call test
[ "$outcome" -eq 1 ] && ! called ctest || wrong "./test tests without its packages"

what="CMake that gives up for another reason"
program_stands
touch "$STATE/no_cmake"
call driftwright check 'a b.yaml'
runs
[[ "$words" == *"no VTK"*"configuring failed"* ]] || wrong "does not say what CMake said"
