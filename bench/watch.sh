#!/bin/sh
# How often `follow --watch` cries wolf and how often it sees the wolf (docs/how-to/follow.md): watch.sh MODEL.json TOP_RPM
set -e
cd "$(dirname "$0")/.."
ninja -C build/release watch_bench
exec build/release/bench/watch_bench "$@"
