#!/usr/bin/env python3
"""Runs a catalogue on a Slurm of two nodes on the loopback, of which one is lost on the way.

    own-network slurm_test.py FOLDER_OF_THE_FLEET

The rows must be those of the same catalogue without Slurm. Skipped without the packages of [slurm] and [fleet].
"""
import contextlib
import getpass
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from pathlib import Path

FLEET = Path(sys.argv[1]).resolve()
HERE = Path(__file__).resolve().parent
NEEDED = ("snakemake", "slurmctld", "slurmd", "sbatch", "munged")
CONFIGURATION = """
ClusterName=small
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort=26817
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={d}/munge/munge.socket
StateSaveLocation={d}/state
SlurmdSpoolDir={d}/spool/%n
SlurmctldPidFile={d}/slurmctld.pid
SlurmdPidFile={d}/slurmd-%n.pid
SlurmctldLogFile={d}/slurmctld.log
SlurmdLogFile={d}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,sched_interval=5
ReturnToService=2
SlurmdTimeout=10
SlurmctldTimeout=10
KillWait=3
MinJobAge=300
EnforcePartLimits=ALL
MailProg=/bin/true
NodeName=node1 NodeHostname=localhost NodeAddr=127.0.0.1 Port=26821 CPUs=2 RealMemory=4000 State=UNKNOWN
NodeName=node2 NodeHostname=localhost NodeAddr=127.0.0.1 Port=26822 CPUs=2 RealMemory=4000 State=UNKNOWN
PartitionName=main Nodes=node1,node2 Default=YES MaxTime=INFINITE State=UP
"""
TEXT = """
[[recording]]
name = "a"
path = "a.csv"
seconds = 1

[[experiment]]
name = "seeds"
recordings = ["a"]
seeds = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]
metrics = ["position_rms"]
"""


def wait_until(condition, what, seconds=90.0):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.2)
    raise RuntimeError(f"{what}: not within {seconds:.0f} s")


class Cluster:
    """Daemons in the foreground, each in a session of its own, so that it can be ended with its children."""

    def __init__(self, folder):
        self.folder, self.daemons = folder, {}
        for part in ("munge", "state", "spool/node1", "spool/node2"):
            folder.joinpath(part).mkdir(parents=True)
        folder.joinpath("munge").chmod(0o755)
        host = os.uname().nodename.split(".")[0]
        (folder / "slurm.conf").write_text(CONFIGURATION.format(d=folder, user=getpass.getuser(), host=host))
        key = folder / "munge/munge.key"
        key.touch(0o600)
        key.write_bytes(os.urandom(128))
        os.environ["SLURM_CONF"] = str(folder / "slurm.conf")

    def start(self):
        m = self.folder / "munge"
        self.daemon("munged", "munged", "-F", "--force", f"--key-file={m}/munge.key", f"--socket={m}/munge.socket",
                    f"--pid-file={m}/munged.pid", f"--log-file={m}/munged.log", f"--seed-file={m}/munged.seed")
        wait_until(m.joinpath("munge.socket").exists, "munge")
        self.daemon("slurmctld", "slurmctld", "-D")
        for node in ("node1", "node2"):
            self.daemon(node, "slurmd", "-D", "-N", node)
        wait_until(lambda: self.ask("sinfo", "-h", "-o", "%T %D") == "idle 2", "two idle nodes")

    def daemon(self, name, *command):
        with open(self.folder / f"{name}.out", "w", encoding="utf-8") as out:
            self.daemons[name] = subprocess.Popen(command, stdout=out, stderr=subprocess.STDOUT, start_new_session=True)

    @staticmethod
    def ask(*command):
        return subprocess.run(command, capture_output=True, text=True).stdout.strip()

    def jobs(self):
        """Job and node of what is running."""
        return [line.split() for line in self.ask("squeue", "-h", "-t", "R", "-o", "%i %N").splitlines()]

    def lose(self, node):
        """Kills a node's daemon and the steps that it started, which have left its session."""
        steps = [line.split(" ", 1) for line in self.ask("pgrep", "-af", "slurmstepd").splitlines()]
        daemon = self.daemons.pop(node)
        mine = {job for job, where in self.jobs() if where == node}
        for step, words in steps:
            if any(f"[{job}." in words for job in mine):
                for process in (*self.ask("pgrep", "-P", step).split(), step):
                    with contextlib.suppress(ProcessLookupError):  # it has ended meanwhile
                        os.kill(int(process), signal.SIGKILL)
        os.killpg(daemon.pid, signal.SIGKILL)
        daemon.wait()

    def stop(self):
        self.ask("scancel", "-u", getpass.getuser())
        for name in ("slurmctld", "node1", "node2", "munged"):
            daemon = self.daemons.pop(name, None)
            if daemon is None:
                continue
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                os.killpg(daemon.pid, signal.SIGKILL)


def fleet(folder, out, *more, **environment):
    return subprocess.Popen([FLEET / "run", folder / "c.toml", "--out", folder / out, "--code", "x", "--binary",
                             HERE / "made_up_maploop.py", *more],
                            env={**os.environ, "MADE_UP_FOLDER": str(folder), **environment})


def rows(folder, out):
    db = sqlite3.connect(folder / out / "x/c/runs.sqlite")
    return db.execute("SELECT key, status, hash, position_rms FROM runs ORDER BY key").fetchall()


def main():
    missing = [each for each in NEEDED if shutil.which(each) is None]
    if missing:
        print(f"SKIPPED, NOT TESTED: there is no {missing[0]}; tools/install-packages fleet slurm")
        return 77
    subprocess.run(["ip", "addr", "add", "127.0.0.2/8", "dev", "lo"], check=True)  # Slurm looks for a second address
    folder = Path(tempfile.mkdtemp(prefix="fleet-slurm-"))
    folder.chmod(0o755)
    (folder / "a.csv").write_text("1\n")
    (folder / "c.toml").write_text(TEXT)
    cluster = Cluster(folder)
    try:
        assert fleet(folder, "here", "--cores", "2").wait(120) == 0, "without Slurm"
        cluster.start()
        workflow = fleet(folder, "there", "--profile", "slurm", MADE_UP_SECONDS="4")
        wait_until(lambda: {node for _, node in cluster.jobs()} == {"node1", "node2"}, "jobs on both nodes")
        cancelled = next(job for job, node in cluster.jobs() if node == "node1")
        cluster.ask("scancel", cancelled)
        cluster.lose("node2")
        print(f"job {cancelled} was cancelled, and node2 is lost", flush=True)
        began = time.monotonic()
        assert workflow.wait(240) == 0, "on Slurm"
        print(f"it ended {time.monotonic() - began:.0f} s later")
        assert rows(folder, "there") == rows(folder, "here"), "other rows"
        assert len(rows(folder, "there")) == 12
        calls = (folder / "calls").read_text().splitlines()
        assert len(calls) > 24, "nothing was run again"
    finally:
        cluster.stop()
        shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
