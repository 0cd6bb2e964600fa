#!/usr/bin/env bash
# A dataset by a real Slurm: one node on this machine's loopback, from Debian's packages, in a folder of its own and gone
# afterwards; no systemd, no cgroups, no accounting. An array of 8 shards, of which one is killed and the controller is
# killed once, submitted again until all is done: the bytes of an unbroken run. Needs root; exit code 77 (skipped) if it
# can't be.
#   slurm_test.sh RETROLUX_BINARY
set -u
for program in slurmctld slurmd munged sbatch; do
  command -v $program >/dev/null || { echo "skip: no $program (Debian: slurm-wlm, munge)"; exit 77; }
done
[ "$(id -u)" -eq 0 ] || { echo "skip: the daemons need root"; exit 77; }
. "$(dirname "$(realpath "$0")")/cli_checks.sh"

node=$(hostname -s)
base=$((20000 + $$ % 20000))
state=$work/slurm
mkdir -p "$state"/{ctld,d}
export SLURM_CONF=$state/slurm.conf
cat >"$SLURM_CONF" <<END
ClusterName=retrolux
SlurmctldHost=$node(127.0.0.1)
SlurmUser=root
SlurmctldPort=$base
SlurmdPort=$((base + 1))
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$state/munge.socket
StateSaveLocation=$state/ctld
SlurmdSpoolDir=$state/d
SlurmctldPidFile=$state/slurmctld.pid
SlurmdPidFile=$state/slurmd.pid
SlurmctldLogFile=$state/slurmctld.log
SlurmdLogFile=$state/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
MpiDefault=none
SchedulerParameters=sched_min_interval=100000
NodeName=$node NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=night Nodes=$node Default=YES MaxTime=INFINITE State=UP
END
dd if=/dev/urandom of="$state/munge.key" bs=1024 count=1 2>/dev/null
chmod 400 "$state/munge.key"

stop() { for name in slurmd slurmctld munged; do [ -s "$state/$name.pid" ] && kill -KILL "$(cat "$state/$name.pid")" 2>/dev/null; done; }
trap 'stop; rm -rf "$work"' EXIT
logs() { tail -n 5 "$state"/*.log; }
# until SECONDS COMMAND...: waits for the command to succeed.
until_true() {
  local i limit=$1
  shift
  for ((i = 0; i < limit * 5; ++i)); do "$@" >/dev/null 2>&1 && return 0; sleep 0.2; done
  return 1
}
start_controller() { slurmctld -f "$SLURM_CONF" && until_true 20 scontrol ping; }

munged --force --key-file="$state/munge.key" --socket="$state/munge.socket" --pid-file="$state/munged.pid" \
  --log-file="$state/munged.log" --seed-file="$state/munge.seed" 2>"$state/munged.err" || { cat "$state/munged.err"; exit 1; }
start_controller && slurmd -f "$SLURM_CONF" && until_true 30 sh -c "sinfo -h -o %t | grep -q idle" || { logs; bad "Slurm starts" "no idle node"; finish; exit 1; }
good "Slurm of one node on the loopback: $(sinfo --version)"

cat >batch.json <<'END'
{"schema": "retrolux/dataset-1", "name": "cluster", "licence": "CC0-1.0", "scenes": 32, "spp": 16,
 "splits": {"train": 0.5, "test": 0.5}, "masks": [{"mesh": "oval"}],
 "views": [{"kind": "free", "cameras": 3, "distance_mm": [1200, 1600], "incidence_deg": [0, 50]}],
 "markers": {"identifiable": 4, "standard": 2},
 "recording": {"size_px": [320, 240], "sensor": "default"}}
END
succeed "plan, unbroken" dataset plan batch.json --out whole
succeed "unbroken run" dataset run whole
# Three scenes are rendered to be timed; after that the number of shards is taken as it is.
run dataset plan batch.json --out set --emit slurm
succeed "plan --emit slurm --shards 8" dataset plan batch.json --out set --emit slurm --shards 8

export RETROLUX=$retrolux
empty_queue() { [ -z "$(squeue -h)" ]; }
submit() { set/jobs/slurm/submit.sh >submit.txt 2>&1 || bad "submit" "$(cat submit.txt)"; }
missing() { "$retrolux" --json dataset status set | node -e 'console.log(JSON.parse(fs.readFileSync(0)).missing)'; }

submit
# One shard is killed as soon as it is at work.
kill_shard() { pkill -KILL -f -- '^[^ ]*retrolux dataset run [.] --shard 3/8'; }
until_true 60 kill_shard && good "shard 3 of 8 was killed" || bad "shard 3 of 8 was killed" "it never ran: $(squeue)"
until_true 120 empty_queue || bad "the array ends" "$(squeue)"
[ "$(missing)" -gt 0 ] && good "$(missing) scenes are missing" || bad "scenes are missing" "none"
grep -q 'not done: scene-' set/jobs/slurm/merge.log && good "the merge says which" || bad "the merge says which" "$(tail -3 set/jobs/slurm/merge.log)"
[ ! -e set/dataset.json ] && good "no index of what is not whole" || bad "no index of what is not whole" "dataset.json"

# Again; the controller is killed at once, which may lose the array, or leave jobs in the queue whose processes are
# gone. What is done counts, not what Slurm says.
submit
kill -KILL "$(cat "$state/slurmctld.pid")"
sleep 0.5
start_controller || bad "the controller starts again" "$(logs)"
for _ in 1 2 3; do
  until_true 25 empty_queue || { echo "      cancelled: $(squeue -h -o '%i %t %r' | tr '\n' ',')"; scancel -u root; until_true 60 empty_queue; }
  [ -e set/dataset.json ] && break
  submit
done
diff <(cd whole && find . -type f ! -name run.json ! -name .lock | sort | xargs md5sum) \
  <(cd set && find . -type f ! -name run.json ! -name .lock ! -path './jobs/*' | sort | xargs md5sum) >diff.txt &&
  good "merged: the bytes of an unbroken run" || bad "merged: the bytes of an unbroken run" "$(head -4 diff.txt | tr '\n' '|') $(tail -2 set/jobs/slurm/merge.log)"
grep -q '"threads":1,"threads_from":"\(SLURM_CPUS_PER_TASK\|CPU affinity\)"' set/jobs/slurm/shard-1.log &&
  good "a shard works on the CPUs that it was given" || bad "a shard works on the CPUs that it was given" "$(head -1 set/jobs/slurm/shard-1.log)"
finish
