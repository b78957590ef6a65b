#!/usr/bin/env bash
# What 8 h with 1,000 moves cost on a reduced model over the travel of an axis: bench/travel.sh
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/.."
./driftwright --version >/dev/null
ninja -C build/release travel_bench >/dev/null
. cmake/threads.sh
for n_poses in 20 1000; do
  build/release/bench/travel_bench scenarios/moving_mill.yaml x $n_poses
  build/release/bench/travel_bench scenarios/rotary_mill.yaml x $n_poses
done
