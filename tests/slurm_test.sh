#!/usr/bin/env bash
# docs/array.sbatch as a job array on a Slurm of two nodes, started here on one machine for the purpose: shards of a sweep and of `place` give the bytes of
# one run, also when a task is cancelled and submitted again.
#
#     tests/slurm_test.sh PROGRAM      ends with 77, which CTest shows as skipped, where Slurm is not installed
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
SlurmParameters=allow_multiple_slurmd
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
CryptoType=crypto/munge
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
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
slurmd -D -N localhost -L "$work/slurmd.log" > /dev/null 2>&1 &
started+=($!)
node_is_idle() { [[ $(sinfo --noheader --format=%t) == idle ]]; }
wait_for 60 "the node" node_is_idle

export DRIFTWRIGHT=$program
study=scenarios/lumped_sweep.yaml
"$program" sweep "$study" -o "$work/whole" > "$work/whole.log" || fail "the whole run"
id=$(sbatch --parsable --array=1-4 --output="$work/task-%a.log" docs/sweep.sbatch 4 "$study" -o "$work/shards")
merge=$(sbatch --parsable --dependency="afterany:$id" --output="$work/merge.log" \
  --wrap "'$program' sweep '$study' -o '$work/shards' --merge")
queue_is_empty() { [[ -z $(squeue --noheader) ]]; }
wait_for 120 "the end of jobs $id and $merge" queue_is_empty
for shard in 1 2 3 4; do
  grep -q "shard $shard of 4, 12 members" "$work/task-$shard.log" || fail "task $shard did not simulate its 12 members"
done
cmp "$work/whole/sweep.csv" "$work/shards/sweep.csv" || fail "the merged table differs from that of one run"
echo "four tasks of a Slurm job array gave the table of one run, byte for byte"
