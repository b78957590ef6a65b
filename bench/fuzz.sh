#!/usr/bin/env bash
# Fuzzes the readers for as long as asked, each format in turn, from a new seed each time; inputs that are findings stay in a folder.
# bench/fuzz.sh [SECONDS [FOLDER [BUILD]]]     default: an hour, results/fuzz, build/release (build/asan: under sanitizers)
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/.."
seconds="${1:-3600}" keep="${2:-results/fuzz}" build="${3:-build/release}"
cmake --build "$build" --target fuzz_record fuzz_program fuzz_correction fuzz_scenario fuzz_sweep fuzz_predictor fuzz_mesh
seed="$(date +%s)" status=0
for format in record program correction scenario sweep predictor mesh "mesh step"; do
  # shellcheck disable=SC2086  # the second word is an argument
  set -- $format; name="$1"; shift
  "$build/tests/fuzz/fuzz_$name" "$@" --seed "$seed" --seconds "$((seconds / 8))" --keep "$keep" || status=1
done
exit "$status"
