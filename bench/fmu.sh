#!/usr/bin/env bash
# What five hours of the FP3 cost as a functional mock-up unit, at steps of 60 s and of 1 s: bench/fmu.sh
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
./driftwright export scenarios/fp3_spindle.yaml --fmu -o "$work/fp3.fmu" >/dev/null
(cd "$work" && cmake -E tar xf fp3.fmu)
cc -std=c99 -O2 -I. -o "$work/fmu" bench/fmu.c -ldl -lm
guid=$(sed -n 's/.* guid="\([^"]*\)".*/\1/p' "$work/modelDescription.xml")
for step_s in 60 1; do "$work/fmu" "$work/binaries/linux64/fp3_spindle.so" "$guid" $step_s; done
