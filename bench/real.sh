#!/usr/bin/env bash
# The scoreboard of measured records: bench/real.sh [-d DATA] [-o DIR] [-t SECONDS] [RECORD...]
# Strategies, diagnosed models and plain baselines side by side, each by its error on data kept out. DATA is ../shared/data; the records are
# no part of the project. RECORD keeps the records whose names begin so (bench/real/records.py). A diagnosis that takes more than SECONDS (1800) counts as none, and
# the notes say so. About 30 min on two cores, half of it the diagnosis of the lathe's days.
set -eu
data=../shared/data out=/tmp/driftwright_real cap=1800
while getopts d:o:t: option; do
  case $option in
    d) data=$OPTARG ;;
    o) out=$OPTARG ;;
    t) cap=$OPTARG ;;
    *) exit 2 ;;
  esac
done
shift $((OPTIND - 1))
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[ -d "$data" ] || { echo "bench/real.sh: no measured records in $data (-d DATA)" >&2; exit 2; }
[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
ninja -C build/release driftwright >/dev/null
. cmake/threads.sh
mkdir -p "$out"
export cap
python3 bench/real/score.py build/release/app/driftwright "$data" "$out" "$@"
