#!/usr/bin/env bash
# Wall time, CPU time and peak memory of the main job, as a whole process, RUNS times (3): bench/main_job.sh [RUNS]
# Needs the Debian package `time`. Build first (./driftwright --version); nothing is built while the clock runs.
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/.."
command -v /usr/bin/time >/dev/null || { echo "bench/main_job.sh: please apt-get install time" >&2; exit 1; }
./driftwright --version >/dev/null
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
printf '%8s %8s %10s\n' 'wall s' 'cpu s' 'peak MiB'
for _ in $(seq "${1:-3}"); do
  /usr/bin/time -a -o "$out/times" -f '%e %U %S %M' build/release/app/driftwright run scenarios/fp3_spindle.yaml -o "$out/results" >/dev/null
  tail -n 1 "$out/times" | awk '{printf "%8.1f %8.1f %10.0f\n", $1, $2 + $3, $4 / 1024}'
done
sort -n "$out/times" | awk '{w[NR] = $1} END {printf "median wall time %.1f s of %d runs\n", w[int((NR + 1) / 2)], NR}'
