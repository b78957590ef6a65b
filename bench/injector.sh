#!/usr/bin/env bash
# Edges per second through the pulse injector, in the program and as a filter of text: bench/injector.sh
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/.."
./driftwright --version >/dev/null
ninja -C build/release injector_bench >/dev/null
build/release/bench/injector_bench
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
printf 'row,drift_um\n1,1000\n' >"$work/correction.csv"
python3 -c 'import sys; [sys.stdout.write("1 0\n1 1\n0 1\n0 0\n" * 100000) for i in range(50)]' >"$work/rows.txt"
echo "  as a filter, 20 million rows of text from a file to /dev/null:"
time build/release/app/driftwright inject --period '1 um' --correction "$work/correction.csv" <"$work/rows.txt" >/dev/null
