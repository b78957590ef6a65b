#!/bin/bash
# Runs `diagnose` on every case of a set, two at a time, and scores both files on the record that it was not given.
#
#     trial.sh DIR [PROGRAM]          DIR: folder of case_*; PROGRAM: driftwright (default: the one on the path)
#
# Per case: DIR/case_*/NAME (the results), NAME.log, NAME.exit (the exit code; 124: more than 120 s, or LIMIT_S on a machine that is shared) and NAME.heldout.json; NAME is
# `diagnosis` or the environment's NAME, so that several versions have their own. A case that has its NAME.exit is passed over, one
# that another run works on as well: a run may be broken off and taken up again, and several may share a set.
set -u
here=$(cd "$(dirname "$0")" && pwd)
dir=${1:?folder of cases}
program=$(command -v "${2:-driftwright}") || { echo "no program ${2:-driftwright}" >&2; exit 2; }
program=$(realpath "$program")
export name=${NAME:-diagnosis} program here

one_case() {
  cd "$1" || return
  exec 9> "$name.lock"
  flock -n 9 || return 0
  [ -e "$name.exit" ] && return 0
  measured=()
  for record in measured_*.csv; do measured+=(--measured "$record"); done
  rm -rf "./$name"
  begin=$(date +%s)
  timeout -k 5 "${LIMIT_S:-120}" "$program" diagnose scenario.yaml "${measured[@]}" --as-recorded -o "$name" > "$name.log" 2>&1 9>&-
  code=$?
  /usr/bin/python3 "$here/held_out.py" "$PWD" "$name" "$program" 9>&-
  echo "$code" > "$name.exit"
  echo "$(basename "$1") exit $code, $(( $(date +%s) - begin )) s"
}
export -f one_case
find "$(realpath "$dir")" -maxdepth 1 -name 'case_*' -type d | sort | xargs -P "${JOBS:-2}" -I{} bash -c 'one_case {}'
/usr/bin/python3 "$here/score.py" "$dir" --diagnoses "$name"
