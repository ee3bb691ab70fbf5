"""A Slurm of two nodes on this machine, for one test: munged, slurmctld and two slurmd on 127.0.0.1, all in a folder of its own."""

import contextlib
import os
import pathlib
import shutil
import socket
import subprocess
import tempfile
import time

CONF = """
ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CryptoType=crypto/munge
SlurmctldPort={ports[0]}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmdSpoolDir={folder}/spool.%n
StateSaveLocation={folder}/state
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.%n.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
SchedulerParameters=sched_interval=1,bf_interval=1
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
KillWait=3
NodeName=n[1-2] NodeHostname=localhost NodeAddr=127.0.0.1 Port={ports[1]},{ports[2]} CPUs=1 RealMemory=1000
PartitionName=all Nodes=n[1-2] Default=YES MaxTime=INFINITE State=UP
"""


class DoesNotStart(AssertionError):
    """Slurm is installed, and its daemons do not come up on this machine."""


def installed():
    """Whether this machine can run it: the programs, and root."""
    return os.geteuid() == 0 and all(shutil.which(name) for name in ("slurmctld", "slurmd", "munged", "sbatch"))


def ports(count):
    held = [socket.socket() for _ in range(count)]
    for one in held:
        one.bind(("127.0.0.1", 0))
    found = [one.getsockname()[1] for one in held]
    for one in held:
        one.close()
    return found


@contextlib.contextmanager
def running():
    """The environment in which sbatch, squeue and scancel find it. Everything that it started ends with it."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="sensitol-slurm-"))
    folder.chmod(0o755)
    processes = []
    environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}
    try:
        (folder / "state").mkdir()
        (folder / "slurm.conf").write_text(CONF.format(folder=folder, ports=ports(3)))
        key = folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)

        def start(*command):
            processes.append(subprocess.Popen(
                [str(part) for part in command], env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL, start_new_session=True,
            ))  # fmt: skip

        start(
            "munged", "--foreground", "--force", f"--key-file={key}", f"--socket={folder}/munge.socket",
            f"--pid-file={folder}/munged.pid", f"--seed-file={folder}/munge.seed", f"--log-file={folder}/munged.log",
        )  # fmt: skip
        wait(lambda: (folder / "munge.socket").exists(), "munged")
        start("slurmctld", "-D", "-c", "-f", folder / "slurm.conf")
        for node in ("n1", "n2"):
            start("slurmd", "-D", "-N", node, "-f", folder / "slurm.conf")

        def idle():
            done = subprocess.run(["sinfo", "-h", "-o", "%t %D"], env=environment, capture_output=True, text=True, timeout=20, check=False)
            return "idle 2" in done.stdout

        wait(idle, "two idle nodes", folder)
        yield environment
    finally:
        subprocess.run(["scancel", "--user=root"], env=environment, capture_output=True, timeout=20, check=False)
        for process in reversed(processes):
            process.terminate()
        for process in processes:
            try:
                process.wait(timeout=10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        shutil.rmtree(folder, ignore_errors=True)


def wait(ready, what, folder=None, seconds=60):
    for _ in range(seconds * 10):
        if ready():
            return
        time.sleep(0.1)
    logs = "\n".join(path.read_text()[-800:] for path in folder.glob("*.log")) if folder else ""
    raise DoesNotStart(f"{what} did not come in {seconds} s\n{logs}")


def jobs(environment):
    """The jobs in the queue: name, state and node."""
    done = subprocess.run(["squeue", "-h", "-o", "%i %j %t %N"], env=environment, capture_output=True, text=True, timeout=30, check=True)
    return [line.split() for line in done.stdout.splitlines()]
