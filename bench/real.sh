#!/usr/bin/env bash
# The scoreboard of measured records: builds the program and scores it beside plain baselines, and the entries of others if given, in one table.
#   bench/real.sh [-s SET] [-d DATA] [-o OUT] [--enter NAME FOLDER] [--diagnosis] [RECORD...]     all options: bench/real/score.py --help
# Some 10 min a set on two cores; with --diagnosis half an hour.
set -eu
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[ -f "$top/build/release/build.ninja" ] || (cd "$top" && cmake --preset release >/dev/null)
ninja -C "$top/build/release" driftwright >/dev/null
. "$top/cmake/threads.sh"
exec python3 "$top/bench/real/score.py" --program "$top/build/release/app/driftwright" "$@"
