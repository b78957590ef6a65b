#!/usr/bin/env bash
# What choosing sensors costs: sets judged per second, and ranking, stability and regression of a long record.
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/.."
./driftwright --version >/dev/null
ninja -C build/release selection_bench >/dev/null
build/release/bench/selection_bench
