#!/bin/bash
# Drives a campaign by GNU parallel, once here and once over ssh to an sshd of the test's own on
# loopback; the merged bytes are those of one process.
# campaign_by_parallel.sh VIGIA CAMPAIGN FOLDER; 77 (skipped) where there is no parallel or sshd.
set -euo pipefail
vigia=$1
campaign=$2
folder=$3

skip() { echo "campaign_by_parallel: $*"; exit 77; }
fail() { echo "campaign_by_parallel: $*" >&2; exit 1; }

export PATH=$PATH:/usr/sbin:/sbin
for tool in parallel sshd ssh ssh-keygen; do
  command -v "$tool" >/dev/null || skip "no $tool here: apt-get install parallel openssh-server"
done

rm -rf "$folder"
mkdir -p "$folder"
"$vigia" evaluate "$campaign" --quiet -j 2 --out "$folder/one" >/dev/null || [ $? = 1 ] || fail "evaluate failed"

# run_all NAME OPTION…: plans with the options, drives what parallel.sh says, merges, compares.
run_all() {
  local big="$folder/$1's shards" status=0
  shift
  "$vigia" campaign plan "$campaign" --shards 4 --out "$big" "$@" >/dev/null
  local begun=$SECONDS
  bash "$big/parallel.sh" || fail "parallel says that a shard failed"
  "$vigia" campaign merge "$big" >/dev/null || status=$?
  [ "$status" -le 1 ] || fail "the shards cannot be merged"
  for name in results.csv summary.json table.md; do
    cmp "$big/$name" "$folder/one/$name" || fail "$name differs from one process's"
  done
  [ "$(find "$big/logs" -name '[0-9]*.log' | wc -l)" = 4 ] || fail "not a log for each shard"
  echo "in $((SECONDS - begun)) s; results.csv $(sha256sum <"$big/results.csv" | cut -c1-16)"
}

echo "by parallel, here"
run_all here --parallel

run=$(mktemp -d /tmp/vigia-ssh-XXXXXX)
sshd=
finish() {
  [ -z "$sshd" ] || kill "$sshd" 2>/dev/null || true
  rm -rf "$run"
}
trap finish EXIT
ssh-keygen -q -t ed25519 -N '' -f "$run/host"
ssh-keygen -q -t ed25519 -N '' -f "$run/user"
cp "$run/user.pub" "$run/authorized"
while :; do
  port=$((20000 + RANDOM % 20000))
  (: <"/dev/tcp/127.0.0.1/$port") 2>/dev/null || break
done
mkdir -p /run/sshd 2>/dev/null || true
cat >"$run/sshd_config" <<CONF
ListenAddress 127.0.0.1
Port $port
HostKey $run/host
AuthorizedKeysFile $run/authorized
PidFile $run/sshd.pid
StrictModes no
UsePAM no
PermitRootLogin prohibit-password
PasswordAuthentication no
MaxStartups 50
CONF
cat >"$run/ssh_config" <<CONF
Host node1 node2
  HostName 127.0.0.1
  Port $port
  User $(id -un)
  IdentityFile $run/user
  IdentitiesOnly yes
  UserKnownHostsFile $run/known
  StrictHostKeyChecking accept-new
CONF
"$(command -v sshd)" -D -e -f "$run/sshd_config" 2>"$folder/sshd.log" &
sshd=$!
for ((i = 0; i < 50; ++i)); do
  ssh -F "$run/ssh_config" node1 true 2>"$folder/ssh.log" && break
  sleep 0.1
done
ssh -F "$run/ssh_config" node1 true 2>"$folder/ssh.log" ||
  skip "no login over ssh on loopback: $(tail -n 1 "$folder/ssh.log")"
echo "by parallel, over ssh to two nodes"
run_all ssh --ssh "1/ssh -F $run/ssh_config node1" --ssh "1/ssh -F $run/ssh_config node2"
