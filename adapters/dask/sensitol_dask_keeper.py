"""Holds a cluster for one engine: `python3 sensitol_dask_keeper.py FOLDER`, with what to do in FOLDER/asked.json.

The engine ends a model's process group at once when it must, and starts the model anew for replays. A cluster that lived in that
process would leave jobs in the queue, and wait in the queue for every replay. So it lives here, in a session of its own, and is closed
when the engine is gone or nobody has used it for a while.
"""

import json
import os
import pathlib
import shutil
import signal
import stat
import subprocess
import sys
import time

# How often it looks for the engine and for clients.
TICK_S = 0.2
# A worker that finds no scheduler ends after this time.
DEATH_S = 15


def alive(pid, begun):
    """Whether this very process still runs. A zombie does not."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass
    now = birth(pid)
    return now is None or begun is None or now == begun


def birth(pid):
    """When a process began, so that another one with its number is not taken for it; 0 for a zombie, None where nobody can say."""
    try:
        text = pathlib.Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return None
    fields = text.rpartition(")")[2].split()
    return 0 if fields[0] == "Z" else int(fields[19])


def opened(asked, folder):
    """The cluster that was asked for."""
    import dask

    dask.config.set({
        "distributed.scheduler.allowed-failures": 3,
        # A thread that ends a point finds the next one at its own worker.
        "distributed.scheduler.worker-saturation": 2.0,
        "distributed.worker.profile.enabled": False,
        "distributed.scheduler.dashboard.status.task-stream-length": 0,
        "temporary-directory": str(folder),
    })  # fmt: skip
    if asked["kind"] == "local":
        from distributed import LocalCluster

        return LocalCluster(
            n_workers=asked["workers"], threads_per_worker=asked["threads"], processes=True, dashboard_address=None,
            memory_limit=None, host="127.0.0.1",
        )  # fmt: skip
    from dask_jobqueue import SLURMCluster

    options = dict(asked["options"])
    jobs, adapt = options.pop("jobs", None), options.pop("adapt", None)
    options.setdefault("cores", 1)
    options.setdefault("processes", 1)
    options.setdefault("memory", "1GB")
    prologue = [f"export PYTHONPATH={here()}${{PYTHONPATH:+:$PYTHONPATH}}", *options.pop("job_script_prologue", [])]
    scheduler = {"dashboard_address": None, **options.pop("scheduler_options", {})}
    security = options.pop("security", None)
    if isinstance(security, dict):
        from distributed.security import Security

        # dask-jobqueue makes its own for `true`, and lays them where the jobs read them.
        security = Security(**security, require_encryption=True)
    if security is not None:
        options["security"] = security
        options.setdefault("shared_temp_directory", str(keys_of(folder)))
    cluster = SLURMCluster(
        job_name=asked["token"], job_script_prologue=prologue, death_timeout=DEATH_S, scheduler_options=scheduler,
        local_directory=options.pop("local_directory", None), log_directory=options.pop("log_directory", str(folder)), **options,
    )  # fmt: skip
    if adapt:
        # The adapter keeps no more than two tasks a thread at the scheduler, whose own idea of enough work is 5 s a thread.
        cluster.adapt(minimum_jobs=adapt.get("minimum", 0), maximum_jobs=adapt.get("maximum", 1), target_duration="100ms")
    else:
        cluster.scale(jobs=jobs or 1)
    return cluster


def keys_of(folder):
    """A folder for the keys of workers, which all nodes see and only this user reads. It is removed with the cluster."""
    private = pathlib.Path.home() / ".sensitol-dask"
    private.mkdir(mode=0o700, exist_ok=True)
    found = os.lstat(private)
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid() or found.st_mode & 0o077:
        raise OSError(f"{private} is open to other users: remove it, or set `shared_temp_directory`")
    (private / folder.name).mkdir(mode=0o700, exist_ok=True)
    return private / folder.name


def of_client(cluster):
    """Certificate and key of a client, of a cluster that speaks TLS. They stand in the private folder until the cluster ends."""
    security = getattr(cluster, "security", None)
    keys = ("tls_ca_file", "tls_client_cert", "tls_client_key")
    found = {key: getattr(security, key, None) for key in keys}
    return {"security": found} if all(found.values()) else {}


def here():
    return str(pathlib.Path(__file__).resolve().parent)


def cancel(token):
    """Takes every job of this name out of Slurm's queue, those of a keeper that was killed too."""
    subprocess.run(["scancel", f"--name={token}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=30, check=False)


def keep(folder):
    asked = json.loads((folder / "asked.json").read_text())
    stopped = []
    for one in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        signal.signal(one, lambda *_: stopped.append(True))
    cluster = None
    try:
        if asked["kind"] == "slurm":
            cancel(asked["token"])
        cluster = opened(asked, folder)
        said = {"scheduler": cluster.scheduler_address, "pid": os.getpid(), "birth": birth(os.getpid()), **of_client(cluster)}
        (folder / "said.tmp").write_text(json.dumps(said))
        os.replace(folder / "said.tmp", folder / "said.json")
        used = time.monotonic()
        while not stopped and alive(asked["engine"], asked["engine_birth"]):
            time.sleep(TICK_S)
            if any(name != "fire-and-forget" for name in list(cluster.scheduler.clients)):
                used = time.monotonic()
            elif time.monotonic() - used > asked["linger"]:
                break
    except BaseException as error:
        # The front end reads it: there is no other way to tell.
        text = " ".join(f"{type(error).__name__}: {error}".split())
        (folder / "said.tmp").write_text(json.dumps({"error": text[:600]}))
        os.replace(folder / "said.tmp", folder / "said.json")
        time.sleep(1.0)
    finally:
        if asked["kind"] == "slurm":
            cancel(asked["token"])
        if cluster is not None:
            try:
                cluster.close(timeout=5)
            except Exception:
                # The jobs are gone already; what is left ends with this process.
                pass
        shutil.rmtree(folder, ignore_errors=True)
        shutil.rmtree(pathlib.Path.home() / ".sensitol-dask" / folder.name, ignore_errors=True)
        os._exit(0)


if __name__ == "__main__":
    keep(pathlib.Path(sys.argv[1]))
