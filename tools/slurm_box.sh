#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A Slurm cluster in a folder: a controller and two nodes of one core on this machine, for tests and to play with.
#   slurm_box.sh start FOLDER         then: export SLURM_CONF=FOLDER/slurm.conf
#   slurm_box.sh node FOLDER n1|n2    starts a node again
#   slurm_box.sh controller FOLDER    starts the controller again
#   slurm_box.sh stop FOLDER
# As root, because nodes start jobs as their users. Touches no Slurm that this machine has besides.
set -euo pipefail

die() { printf 'slurm_box: %s\n' "$*" >&2; exit 1; }

# cred_expire: a job that is requeued waits until the credential of its last start has expired; two minutes by default.
write_conf() {
  cat >"$box/slurm.conf" <<TEXT
ClusterName=box
SlurmctldHost=$(hostname)(127.0.0.1)
SlurmctldPort=16817
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$box/munge.socket,cred_expire=10
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
ReturnToService=2
SlurmdTimeout=10
SlurmctldTimeout=10
MessageTimeout=5
KillWait=20
MinJobAge=300
JobRequeue=1
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=2,sched_min_interval=0,defer_batch,batch_sched_delay=1
JobCompType=jobcomp/filetxt
JobCompLoc=$box/jobs.txt
AccountingStorageType=accounting_storage/none
SwitchType=switch/none
MpiDefault=none
StateSaveLocation=$box/state
SlurmdSpoolDir=$box/spool-%n
SlurmctldPidFile=$box/slurmctld.pid
SlurmdPidFile=$box/%n.pid
SlurmctldLogFile=$box/slurmctld.log
SlurmdLogFile=$box/%n.log
NodeName=n1 NodeHostname=n1 NodeAddr=127.0.0.1 Port=17001 CPUs=1 RealMemory=4000
NodeName=n2 NodeHostname=n2 NodeAddr=127.0.0.1 Port=17002 CPUs=1 RealMemory=4000
PartitionName=box Nodes=ALL Default=YES MaxTime=INFINITE State=UP
TEXT
}

start_munge() {
  [[ -s $box/munge.key ]] || head -c 1024 /dev/urandom >"$box/munge.key"
  chmod 600 "$box/munge.key"
  munged --force --key-file="$box/munge.key" --socket="$box/munge.socket" --pid-file="$box/munge.pid" \
    --log-file="$box/munge.log" --seed-file="$box/munge.seed"
}

start_controller() { slurmctld -f "$box/slurm.conf"; }

# slurmd asks for the name of its machine: each has a name space of its own.
start_node() {
  mkdir -p "$box/spool-$1"
  unshare --uts sh -c 'hostname "$1"; exec slurmd -N "$1" -f "$2"' sh "$1" "$box/slurm.conf"
}

wait_for_nodes() {
  export SLURM_CONF=$box/slurm.conf
  for ((i = 0; i < 60; ++i)); do
    [[ $(sinfo -h -t idle -o %D 2>/dev/null) == 2 ]] && return
    sleep 0.5
  done
  sinfo -N >&2 || true
  tail -5 "$box"/*.log >&2
  die "the nodes do not answer"
}

stop_all() {
  local file pid
  for file in "$box"/slurmctld.pid "$box"/n?.pid "$box"/munge.pid; do
    [[ -s $file ]] || continue
    pid=$(<"$file")
    # A file may outlive its process: only what still has this folder in its command line, or is our munged.
    tr '\0' ' ' <"/proc/$pid/cmdline" 2>/dev/null | grep -F "$box" >/dev/null || continue
    kill "$pid" || true
  done
}

[[ $# -ge 2 ]] || die "usage: slurm_box.sh start|node|controller|stop FOLDER [NODE]"
mkdir -p "$2"
box=$(realpath "$2")
command -v slurmctld >/dev/null && command -v slurmd >/dev/null && command -v munged >/dev/null ||
  die "Slurm is not installed: ./run cluster installs it"
[[ $(id -u) == 0 ]] || die "needs root"
case $1 in
  start)
    mkdir -p "$box/state"
    chmod 755 "$box"
    write_conf
    start_munge
    start_controller
    start_node n1
    start_node n2
    wait_for_nodes
    ;;
  node) start_node "$3" ;;
  controller) start_controller ;;
  stop) stop_all ;;
  *) die "unknown: $1" ;;
esac
