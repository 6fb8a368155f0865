#!/bin/bash
# Drives a campaign by a Slurm of the test's own: munged, slurmctld and two slurmd on loopback, one of
# which is killed in the middle. The merged bytes are those of one process, nothing is lost or doubled.
# campaign_on_slurm.sh VIGIA CAMPAIGN FOLDER [SHARDS [SECONDS]] gives up after so many seconds, and ends with 77
# (skipped) where there is no Slurm.
set -euo pipefail
vigia=$1
campaign=$2
folder=$3
shards=${4:-6}
patience=${5:-450}

skip() { echo "campaign_on_slurm: $*"; exit 77; }
fail() { echo "campaign_on_slurm: $*" >&2; tail -n 20 "$folder"/*.log >&2; exit 1; }

export PATH=$PATH:/usr/sbin:/sbin
for tool in munged slurmctld slurmd sbatch squeue scontrol; do
  command -v "$tool" >/dev/null || skip "no $tool here: apt-get install slurm-wlm munge"
done
[ "$(id -u)" = 0 ] || skip "its daemons are started as root"

rm -rf "$folder"
# Its sockets' names are short, whatever the folder's is; its daemons want folders that no other can write.
run=$(mktemp -d /tmp/vigia-slurm-XXXXXX)
mkdir -p "$folder" "$run/state"
chmod 755 "$run"
free_port() {
  local port
  while :; do
    port=$((20000 + RANDOM % 20000))
    (: <"/dev/tcp/127.0.0.1/$port") 2>/dev/null || { echo "$port"; return; }
  done
}
daemons=()
# ours PID: whether the process was started by this Slurm.
ours() { { tr '\0' '\n' <"/proc/$1/environ" | grep -qx "SLURM_CONF=$run/slurm.conf"; } 2>/dev/null; }
finish() {
  # A slurmd waits for what it runs: that ends first.
  local process
  for process in $(pgrep -f 'slurm|run-shard'); do
    if ours "$process"; then kill -KILL "$process" 2>/dev/null || true; fi
  done
  kill "${daemons[@]}" 2>/dev/null || true
  wait "${daemons[@]}" 2>/dev/null || true
  rm -rf "$run"
}
trap finish EXIT

dd if=/dev/urandom of="$run/munge.key" bs=1024 count=1 status=none
chmod 400 "$run/munge.key"
munged --foreground --force --key-file="$run/munge.key" --socket="$run/munge.sock" \
  --pid-file="$run/munged.pid" --log-file="$folder/munged.log" --seed-file="$run/munge.seed" &
daemons+=($!)

cat >"$run/slurm.conf" <<CONF
ClusterName=vigia
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$run/munge.sock
CryptoType=crypto/munge
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
StateSaveLocation=$run/state
SlurmdSpoolDir=$run/spool%n
SlurmctldPidFile=$run/slurmctld.pid
SlurmdPidFile=$run/slurmd.%n.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.%n.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_min_interval=100000,requeue_delay=1
SlurmdTimeout=10
InactiveLimit=0
KillWait=2
ReturnToService=2
JobRequeue=1
NodeName=n1 NodeAddr=127.0.0.1 NodeHostname=$(hostname -s) Port=$(free_port) CPUs=1 RealMemory=4000
NodeName=n2 NodeAddr=127.0.0.1 NodeHostname=$(hostname -s) Port=$(free_port) CPUs=1 RealMemory=4000
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
cp "$run/slurm.conf" "$folder/slurm.conf"
export SLURM_CONF=$run/slurm.conf
for ((i = 0; i < 100; ++i)); do [ -S "$run/munge.sock" ] && break; sleep 0.1; done
slurmctld -D -c -f "$SLURM_CONF" >"$folder/ctld.log" 2>&1 &
daemons+=($!)
start_node() { setsid slurmd -D -N "$1" -f "$SLURM_CONF" >"$folder/$1.log" 2>&1 & }
start_node n1; daemons+=($!)
start_node n2; node2=$!; daemons+=($!)
for ((i = 0; i < 150; ++i)); do
  [ "$(sinfo --noheader --Node --states=idle --format=%N 2>/dev/null | wc -l)" = 2 ] && break
  sleep 0.2
done
[ "$(sinfo --noheader --Node --states=idle --format=%N 2>/dev/null | wc -l)" = 2 ] || {
  sinfo || true
  fail "the nodes did not get ready"
}

big="$folder/a campaign's shards"
"$vigia" campaign plan "$campaign" --shards "$shards" --out "$big" --slurm >"$folder/plan.txt"
begun=$SECONDS
sbatch --parsable "$big/slurm.sh" >"$folder/job.txt" || fail "sbatch refused the script"

# Once the second node drives a shard and a shard is whole, it is killed with all that runs on it.
whole() { find "$big/shards" -name '*.jsonl' | wc -l; }
while [ "$SECONDS" -lt "$patience" ]; do
  [ "$(whole)" -ge 1 ] && squeue --noheader --states=running --nodelist=n2 | grep -q . && break
  sleep 0.1
done
victims=$(squeue --noheader --states=running --nodelist=n2 --format=%A)
[ -n "$victims" ] || fail "the second node had no shard to drive"
kill -KILL "$node2"
for job in $victims; do
  for step in $(pgrep -f "slurmstepd: \[$job.batch\]"); do
    if ours "$step"; then kill -KILL "$step"; fi
  done
  for process in $(pgrep -f "campaign's shards|slurm_script"); do
    if ours "$process" && tr '\0' '\n' <"/proc/$process/environ" | grep -qx "SLURM_JOB_ID=$job"; then
      kill -KILL "$process" 2>/dev/null || true
    fi
  done
done
echo "killed node n2, which drove job $victims; $(whole) of $shards shards were whole"
sleep 12
start_node n2; daemons+=($!)

while [ "$SECONDS" -lt "$patience" ]; do
  [ -z "$(squeue --noheader)" ] && break
  sleep 0.1
done
[ -z "$(squeue --noheader)" ] || { squeue; fail "the queue did not get empty"; }
took=$((SECONDS - begun))
"$vigia" campaign status "$big"
status=0
"$vigia" campaign merge "$big" >"$folder/merge.txt" || status=$?
[ "$status" -le 1 ] || fail "the shards cannot be merged"
"$vigia" evaluate "$campaign" --quiet -j 2 --out "$folder/one" >/dev/null || [ $? = 1 ] || fail "evaluate failed"
for name in results.csv summary.json table.md; do
  cmp "$big/$name" "$folder/one/$name" || fail "$name differs from one process's"
done
[ "$(find "$big/logs" -name '[0-9]*.log' | wc -l)" = "$shards" ] || fail "not a log for each shard"
[ "$(grep -c '^shard [0-9]* on' "$big"/logs/[0-9]*.log | grep -c ':2$')" -ge 1 ] ||
  fail "no shard was driven again"
echo "by Slurm in $took s; results.csv $(sha256sum <"$big/results.csv" | cut -c1-16)"
