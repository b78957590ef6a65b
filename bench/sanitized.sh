#!/bin/bash
# Each verb once by a program with sanitizers in it, and what they report (faults.py --sanitized).
#
#     bench/sanitized.sh asan|tsan [--meshed] [--verbs simulate,diagnose,...]
#
# asan: addresses and undefined behaviour, GCC. On one thread, for its allocator stands still where a process forks beside others (`sweep`).
# tsan: data races, GCC's, with LLVM's OpenMP library in place of GCC's, whose barriers it would not know (package libomp-16-dev).
# The first build takes three quarters of an hour on two cores.
set -eu
top=$(cd "$(dirname "$0")/.." && pwd)
kind=${1:?asan or tsan}
shift
cd "$top"
[ -d "build/$kind" ] || cmake --preset "$kind"
cmake --build "build/$kind" --target driftwright
if [ "$kind" = asan ]; then
  export ASAN_OPTIONS=detect_leaks=0 OMP_NUM_THREADS=1
  exec python3 bench/faults.py "build/asan/app/driftwright" --sanitized "$@"
fi
llvm=/usr/lib/llvm-16/lib
[ -e "$llvm/libarcher.so" ] || { echo "apt-get install libomp-16-dev: $llvm/libarcher.so tells the sanitizer what OpenMP does" >&2; exit 2; }
instead=$(mktemp -d)
trap 'rm -rf "$instead"' EXIT
ln -s "$llvm/libomp.so.5" "$instead/libgomp.so.1"
export LD_LIBRARY_PATH="$instead:$llvm" OMP_NUM_THREADS=2 TSAN_OPTIONS="suppressions=$top/bench/thread_sanitizer.supp"
setarch -R python3 bench/faults.py "build/tsan/app/driftwright" --sanitized "$@"  # -R: its shadow memory wants addresses that are not drawn
