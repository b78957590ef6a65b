#!/usr/bin/env bash
# What a cyclogram costs on reduced models: bench/reduced.sh [SCENARIO CYCLOGRAM]...
# Without arguments: the FP3 with all it has, with constant films, and with oil that thins as the bearings warm.
# BEFORE=PROGRAM: also by this reduced_bench of another commit, in turn and on the same reduced machines.
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/.."
top=$PWD
./driftwright --version >/dev/null
ninja -C build/release reduced_bench >/dev/null
. cmake/threads.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [ $# -eq 0 ]; then
  cp scenarios/fp3_spindle.yaml "$work/all.yaml"
  grep -vE 'type: (forced_convection|rotating_cylinder)' scenarios/fp3_spindle.yaml >"$work/constant_films.yaml"
  sed 's/viscosity: 15 mm^2\/s.*/viscosity_40: 15 mm^2\/s\n    viscosity_100: 4 mm^2\/s/' scenarios/fp3_spindle.yaml >"$work/thinning_oil.yaml"
  set -- "$work/constant_films.yaml" chaotic "$work/all.yaml" chaotic "$work/thinning_oil.yaml" chaotic
fi
while [ $# -gt 1 ]; do
  for program in ${BEFORE:-} build/release/bench/reduced_bench ${BEFORE:-} build/release/bench/reduced_bench; do
    echo "$program"
    "$program" "$1" "$2" "$work/kept"
  done
  shift 2
done
