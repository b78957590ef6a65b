#!/usr/bin/env bash
# docs/array.sbatch as a job array on a Slurm of two nodes, started here on one machine for the purpose: shards of a sweep and of `place` give the bytes of
# one run, also when a task is cancelled and submitted again.
#
#     tests/app/slurm_test.sh PROGRAM      ends with 77, which CTest shows as skipped, where Slurm is not installed
set -eu
program=$(realpath "$1")
PATH=$PATH:/usr/sbin:/sbin
for needed in munged slurmctld slurmd sbatch; do
  if ! command -v "$needed" > /dev/null; then
    echo "skipped: $needed is not installed (packages slurmctld slurmd slurm-client munge)"
    exit 77
  fi
done

work=$(mktemp -d)
export XDG_CACHE_HOME=$work/cache
started=()
clean_up() {
  for pid in "${started[@]}"; do kill "$pid" 2> /dev/null || true; done
  for pid in "${started[@]}"; do wait "$pid" 2> /dev/null || true; done
  rm -rf "$work"
}
trap clean_up EXIT
fail() {
  echo "FAILED: $1"
  tail -n 20 "$work"/*.log || true
  exit 1
}
wait_for() {  # wait_for SECONDS WHAT COMMAND...: until it succeeds
  local seconds=$1 what=$2
  shift 2
  for ((i = 0; i < 5 * seconds; ++i)); do
    if "$@" > /dev/null 2>&1; then return; fi
    sleep 0.2
  done
  fail "$what did not come within $seconds s"
}

# Everything in a folder of its own, with ports of its own: a Slurm that runs on this machine is not touched.
chmod 700 "$work"
mkdir -m 700 "$work/munge" "$work/state" "$work/spool"
dd if=/dev/urandom of="$work/munge/key" bs=1024 count=1 status=none
chmod 600 "$work/munge/key"
munged --foreground --force --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
  --seed-file="$work/munge/seed" 2> "$work/munge.log" &
started+=($!)
wait_for 20 munged test -S "$work/munge/socket"

port=$((20000 + $$ % 20000))
cat > "$work/slurm.conf" << END
ClusterName=test
SlurmctldHost=localhost
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
SlurmctldPort=$port
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
CryptoType=crypto/munge
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool/%n
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd-%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
NodeName=first NodeHostname=localhost NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1 State=UNKNOWN
NodeName=second NodeHostname=localhost NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=1 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP
END
export SLURM_CONF=$work/slurm.conf
slurmctld -D -i -L "$work/slurmctld.log" > /dev/null 2>&1 &
started+=($!)
for node in first second; do
  mkdir -m 700 "$work/spool/$node"
  slurmd -D -N "$node" -L "$work/slurmd-$node.log" > /dev/null 2>&1 &
  started+=($!)
done
nodes_are_idle() { [[ $(sinfo --noheader --Node --format=%t | sort -u) == idle && $(sinfo --noheader --Node | wc -l) == 2 ]]; }
wait_for 60 "two nodes" nodes_are_idle

export DRIFTWRIGHT=$program
queue_is_empty() { [[ -z $(squeue --noheader) ]]; }
same() {  # same NAME: the merged folder has the files of the whole one, byte for byte but for the folder's own name in its report
  sed -i "s#$work/$1-whole#$work/$1#g" "$work/$1-whole/report.html"
  diff -r "$work/$1-whole" "$work/$1" > "$work/$1-diff.log" || fail "$1: merged, it differs from one run"
}
submit() { sbatch --parsable --array="$2" --output="$work/$1-%a.log" docs/array.sbatch "${@:3}" -o "$work/$1"; }
merge_behind() { sbatch --parsable --dependency="afterany:$1" --output="$work/$2-merge.log" --wrap "'$program' ${*:3} -o '$work/$2' --merge"; }

# A sweep and thermometers, each as an array and a merge behind it.
sweep=(sweep scenarios/lumped_sweep.yaml)
place=(place scenarios/first_machine.yaml --count 1)
for name in sweep place; do
  declare -n command=$name
  "$program" "${command[@]}" -o "$work/$name-whole" > "$work/$name-whole.log" || fail "$name in one run"
  id=$(submit "$name" 1-4 4 "${command[@]}")
  merge_behind "$id" "$name" "${command[@]}" > /dev/null
done
wait_for 240 "the end of the jobs" queue_is_empty
same sweep
same place
for shard in 1 2 3 4; do
  grep -q "shard $shard of 4, 12 members" "$work/sweep-$shard.log" || fail "task $shard did not simulate its 12 members"
done

# A test to plan, of which one task is cancelled on its way and submitted again.
plan=(plan-test scenarios/lumped_spindle.yaml --programmes 1500)
"$program" "${plan[@]}" -o "$work/plan-whole" > "$work/plan-whole.log" || fail "plan-test in one run"
id=$(submit plan 1-2 2 "${plan[@]}")
partial=$work/plan.parts/pieces.2of2.csv.partial
is_on_its_way() { [[ -f $partial && $(wc -l < "$partial") -ge 6 ]]; }
wait_for 60 "the first pieces of task 2" is_on_its_way
scancel "${id}_2"
wait_for 240 "the end of job $id" queue_is_empty
[[ -f $partial ]] || fail "task 2 ended before it was cancelled"
n_kept=$(($(wc -l < "$partial") - 2))
"$program" "${plan[@]}" -o "$work/plan" --merge > "$work/plan-early.log" 2>&1 && fail "a merge before all shards have ended is not refused"
id=$(submit plan 2 2 "${plan[@]}")
merge_behind "$id" plan "${plan[@]}" > /dev/null
wait_for 240 "the end of job $id" queue_is_empty
same plan
echo "job arrays on two nodes of a Slurm gave the bytes of one run: a sweep, places, and a planned test of which a task was cancelled behind $n_kept pieces"
