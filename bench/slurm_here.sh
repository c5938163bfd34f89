#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A Slurm of one node on this machine, for trying `roomgraph batch --engine slurm` and for its tests: controller, node daemon and
# munge of its own, on free ports of the loopback, without systemd, control groups or accounting. Packages: slurm-wlm munge.
#
#     bench/slurm_here.sh start DIR [KEY=VALUE...]    # of slurm.conf, e.g. MaxJobCount=5; CPUS=4 and MEMORY=4000 (MB) of the node
#     export SLURM_CONF=DIR/slurm.conf                # from here on sbatch, squeue... speak to it
#     bench/slurm_here.sh kill-node DIR               # SIGKILL to the node daemon; what it runs goes on
#     bench/slurm_here.sh crash-node DIR              # SIGKILL to it and to all that it runs: the machine has died, and the
#                                                     # controller has noticed
#     bench/slurm_here.sh start-node DIR
#     bench/slurm_here.sh stop DIR
#
# DIR has to be readable by the user munge when this is done as root.
set -euo pipefail

die() { echo "slurm_here: $*" >&2; exit 1; }
usage() { sed -n '3,14s/^# \{0,1\}//p' "$0"; exit 2; }

free_ports() {
  python3 - <<'PYTHON'
import socket
sockets = [socket.socket() for _ in range(2)]
for each in sockets:
    each.bind(("127.0.0.1", 0))
print(*(each.getsockname()[1] for each in sockets))
PYTHON
}

wait_for() {  # SECONDS COMMAND...
  local until=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    ((SECONDS < until)) || return 1
    sleep 0.1
  done
}

write_conf() {
  local controller_port=$1 node_port=$2 host cpus memory setting
  host=$(hostname -s) cpus=$(nproc) memory=$(awk '/MemTotal/ {print int($2 / 1024 * 0.9)}' /proc/meminfo)
  shift 2
  local more=()
  for setting in "$@"; do
    case $setting in
      CPUS=*) cpus=${setting#*=} ;;
      MEMORY=*) memory=${setting#*=} ;;
      *=*) more+=("$setting") ;;
      *) die "$setting is no KEY=VALUE" ;;
    esac
  done
  {
    cat <<CONF
ClusterName=here
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$controller_port
SlurmdPort=$node_port
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
MpiDefault=none
ReturnToService=2
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=2,batch_sched_delay=0,sched_min_interval=100000
CompleteWait=0
DefMemPerCPU=100
NodeName=node0 NodeHostname=$host NodeAddr=127.0.0.1 CPUs=$cpus RealMemory=$memory State=UNKNOWN
PartitionName=here Nodes=node0 Default=YES MaxTime=INFINITE State=UP
CONF
    for setting in ${more[@]+"${more[@]}"}; do echo "$setting"; done
  } >"$folder/slurm.conf"
}

start_munge() {
  local as=()
  mkdir -p "$folder/munge"
  head -c 128 /dev/urandom >"$folder/munge/key"
  chmod 400 "$folder/munge/key"
  if [ "$(id -u)" = 0 ]; then
    chown -R munge "$folder/munge"
    as=(setpriv --reuid munge --regid munge --clear-groups)
  fi
  chmod 755 "$folder/munge"
  ${as[@]+"${as[@]}"} munged --force --key-file="$folder/munge/key" --socket="$folder/munge/socket" --pid-file="$folder/munge/pid" \
    --log-file="$folder/munge/log" --seed-file="$folder/munge/seed" --num-threads=2 2>>"$folder/munge.err" ||
    die "munged: $(tail -n 1 "$folder/munge.err")"
}

start_node() {
  slurmd -N node0 -f "$folder/slurm.conf" || die "slurmd: $(tail -n 1 "$folder/slurmd.log")"
  scontrol update NodeName=node0 State=RESUME 2>/dev/null || true  # it is down after a crash only
}

start() {
  for program in munged slurmctld slurmd sbatch; do
    command -v "$program" >/dev/null || die "no $program: install slurm-wlm and munge"
  done
  [ ! -e "$folder/slurm.conf" ] || die "$folder: has been started already"
  mkdir -p "$folder/state" "$folder/spool"
  chmod 755 "$folder"
  read -r controller_port node_port < <(free_ports)
  write_conf "$controller_port" "$node_port" "$@"
  start_munge
  slurmctld -f "$folder/slurm.conf" || die "slurmctld: $(tail -n 1 "$folder/slurmctld.log")"
  start_node
  wait_for 30 idle || { stop; die "the node did not come up: see $folder/slurmctld.log"; }
  echo "export SLURM_CONF=$folder/slurm.conf"
}

idle() { [ "$(sinfo -h -o %T)" = idle ]; }

pid_in() { cat "$folder/$1" 2>/dev/null || true; }

# The processes of a daemon's jobs are known by the spool folder in their environment or by their parent.
steps() { pgrep -f "slurmstepd: \[" | while read -r pid; do
  tr '\0' '\n' <"/proc/$pid/environ" 2>/dev/null | grep -qx "SLURM_CONF=$folder/slurm.conf" && echo "$pid"
  done || true; }

descendants() {
  local child
  for child in $(pgrep -P "$1"); do
    descendants "$child"
    echo "$child"
  done
}

kill_node() {
  local pid
  pid=$(pid_in slurmd.pid)
  [ -z "$pid" ] || kill -9 "$pid" 2>/dev/null || true
  rm -f "$folder/slurmd.pid"
}

kill_node_and_jobs() {
  local step
  kill_node
  for step in $(steps); do kill -9 $(descendants "$step") "$step" 2>/dev/null || true; done
}

crash_node() {
  kill_node_and_jobs
  scontrol update NodeName=node0 State=DOWN Reason=crashed
}

gone() { ! kill -0 "$1" 2>/dev/null; }

stop() {
  local name pid
  scancel --user="$(id -un)" 2>/dev/null || true
  kill_node_and_jobs
  for name in slurmctld.pid munge/pid; do
    pid=$(pid_in "$name")
    [ -n "$pid" ] || continue
    kill "$pid" 2>/dev/null || true
    wait_for 10 gone "$pid" || kill -9 "$pid" 2>/dev/null || true
  done
  rm -f "$folder/slurm.conf"
}

(($# >= 2)) || usage
action=$1
mkdir -p "$2"
folder=$(cd "$2" && pwd)
shift 2
export SLURM_CONF=$folder/slurm.conf
case $action in
  start) start "$@" ;;
  stop) stop ;;
  kill-node) kill_node ;;
  crash-node) crash_node ;;
  start-node) start_node ;;
  *) usage ;;
esac
