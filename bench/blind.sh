#!/usr/bin/env bash
# Makes blind cases (tests/blind), diagnoses each, and scores: bench/blind.sh [-n CASES] [-o DIR] [-j JOBS] [-t SECONDS] [-s i/n]
# An ambiguous case gets one more record with the cyclogram proposed (further.csv) and is diagnosed again (resolved/).
# -s i/n does the i-th of n parts alone, on this machine or another that shares the folder, and does not score; run without -s when all have ended.
# 400 cases into /tmp/driftwright_blind, one process a core, at most 300 s a case. What is there is kept: a run that was cut short goes
# on, and a case with a diagnosis.json is not diagnosed again. A diagnosis that fails or takes too long is a miss; diagnosis.log says why.
set -eu
n=400 out=/tmp/driftwright_blind jobs=$(nproc) cap=300 shard=1/1
while getopts n:o:j:t:s: option; do
  case $option in
    n) n=$OPTARG ;;
    o) out=$OPTARG ;;
    j) jobs=$OPTARG ;;
    t) cap=$OPTARG ;;
    s) shard=$OPTARG ;;
    *) exit 2 ;;
  esac
done
if ! [[ $shard =~ ^([1-9][0-9]*)/([1-9][0-9]*)$ ]] || ((BASH_REMATCH[1] > BASH_REMATCH[2])); then
  echo "-s $shard must be i/n with 1 <= i <= n, such as 3/8" >&2
  exit 2
fi
part=$((BASH_REMATCH[1] - 1)) parts=${BASH_REMATCH[2]}
mkdir -p "$out"
out=$(cd "$out" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
ninja -C build/release driftwright blind_cases >/dev/null
. cmake/threads.sh
export OMP_NUM_THREADS=1 XDG_CACHE_HOME="$out/cache" cap
export program=$PWD/build/release/app/driftwright cases=$PWD/build/release/tests/blind/blind_cases

pids=()
for ((job = 0; job < jobs; ++job)); do
  "$cases" --from 0 --to $((n - 1)) --every $((jobs * parts)) --offset $((job * parts + part)) -o "$out" 2>>"$out/cases_${part}_$job.log" &
  pids+=($!)
done
for pid in "${pids[@]}"; do wait "$pid"; done

# diagnose CASE NAME RECORD...: into CASE/NAME, log in CASE/NAME.log
diagnose_into() {
  case_dir=$1 name=$2
  [ -f "$case_dir/$name/diagnosis.json" ] && return 0
  arguments=()
  for record in "${@:3}"; do arguments+=(--measured "$record"); done
  without=$(sed -n 's/^  "without": "\(.*\)",$/\1/p' "$case_dir/truth.json")
  [ -n "$without" ] && arguments+=(--without "$without")
  # Into a folder of its own first: only what is complete is called by the name.
  rm -rf "$case_dir/$name.part"
  if timeout "$cap" "$program" diagnose "$case_dir/scenario.yaml" "${arguments[@]}" --as-recorded -o "$case_dir/$name.part" \
    >"$case_dir/$name.log" 2>&1; then
    rm -rf "${case_dir:?}/$name"
    mv "$case_dir/$name.part" "$case_dir/$name"
  else
    echo "$(basename "$case_dir"): exit $? (log: $case_dir/$name.log)" >&2
  fi
}
# What cannot be told apart: one more record, with the cyclogram proposed, and all records diagnosed again.
diagnose() {
  diagnose_into "$1" diagnosis "$1"/measured_*.csv
  [ -f "$1/diagnosis/diagnosis.json" ] || return 0
  [ -f "$1/further.csv" ] || "$cases" --further "$1" --diagnosis "$1/diagnosis/diagnosis.json" -o "$1/further.csv"
  [ ! -f "$1/further.csv" ] || diagnose_into "$1" resolved "$1"/measured_*.csv "$1/further.csv"
}
export -f diagnose diagnose_into
seq -f "$out/case_%04g" "$part" "$parts" $((n - 1)) | xargs -P "$jobs" -I{} bash -c 'diagnose {}'
if ((parts == 1)); then
  python3 bench/blind/score.py "$out"
else
  echo "part $shard is done; bench/blind.sh without -s scores when all are"
fi
