#!/bin/bash
# Writes the cases, runs `diagnose` behind both tests of each, scores them.
#
#     trial.sh FOLDER PROGRAM [CASES]          one after another; a case that is there is passed over
#     STEPPED=1 trial.sh ...                   then the same behind the stepped test
set -u
here=$(cd "$(dirname "$0")" && pwd)
folder=${1:?folder}
program=$(realpath "${2:?program}")
cases=${3:-75}
for ((i = 0; i < cases; ++i)); do
  /usr/bin/python3 "$here/cases.py" "$folder" --program "$program" --only "$i" || continue
  for test in usual planned; do
    at=$(printf '%s/case_%03d/%s' "$folder" "$i" "$test")
    [ -e "$at/exit" ] && continue
    (cd "$at" && timeout -k 5 "${LIMIT_S:-180}" "$program" diagnose scenario.yaml --measured measured_1.csv -o diagnosis --quiet > log 2>&1; echo $? > exit)
  done
done
for ((i = 0; i < cases && ${STEPPED:-0}; ++i)); do
  at=$(printf '%s/case_%03d/stepped' "$folder" "$i")
  [ -e "$at/exit" ] && continue
  /usr/bin/python3 "$here/cases.py" "$folder" --program "$program" --stepped --only "$i" || continue
  (cd "$at" && timeout -k 5 "${LIMIT_S:-180}" "$program" diagnose scenario.yaml --measured measured_1.csv -o diagnosis --quiet > log 2>&1; echo $? > exit)
done
/usr/bin/python3 "$here/score.py" "$folder" --list
