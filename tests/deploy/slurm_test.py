"""Runs a sweep as an array on a Slurm cluster of three nodes, kills one of them, and compares the merged file with one run.

usage: slurm_test.py SOURCE_DIRECTORY RICOCHET WORK_DIRECTORY [POINTS]

The cluster is real: munged, slurmctld and three slurmd, all on this machine and by root. Then Open MPI starts the shards
of a second sweep.
"""
import filecmp
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import time

SOURCE, RICOCHET, WORK = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
NODES = 3
SHARDS = 6
# An impact that takes time costs a millisecond, so that a task lasts for seconds and can be killed in the middle.
POINTS = int(sys.argv[4]) if len(sys.argv) > 4 else 30_000
SCENE = SOURCE / "tests/data/scenes/dropped_rod.textproto"
SWEEP = ["--scene", str(SCENE), "--axis", f"friction.kinetic_coefficient=lin:0.01:1.5:{POINTS}", "--column",
         "coefficients.newton,contact_velocity_after.normal_m_s", "--regime"]
WAIT_S = 300


def free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def wait_for(what, ask, seconds=WAIT_S):
    """Returns the first true answer of `ask`."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        answer = ask()
        if answer:
            return answer
        time.sleep(0.2)
    raise SystemExit(f"no {what} within {seconds} s")


def say(text):
    print(f"{time.monotonic() - START:6.1f} s  {text}", flush=True)


class Cluster:
    """Ends all its daemons and their tasks."""

    def __init__(self, directory):
        self.directory = directory
        self.daemons = {}
        directory.mkdir(parents=True)
        self.env = {**os.environ, "SLURM_CONF": str(directory / "slurm.conf"), "RICOCHET": str(RICOCHET)}
        self.write_configuration()

    def write_configuration(self):
        controller, *nodes = free_ports(NODES + 1)
        key = self.directory / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        lines = f"""
            ClusterName=ricochet
            SlurmctldHost={socket.gethostname()}(127.0.0.1)
            SlurmctldPort={controller}
            SlurmUser=root
            SlurmdUser=root
            AuthType=auth/munge
            AuthInfo=socket={self.directory}/munge.socket,cred_expire=30
            CredType=cred/munge
            StateSaveLocation={self.directory}/state
            SlurmdSpoolDir={self.directory}/spool.%n
            SlurmctldPidFile={self.directory}/slurmctld.pid
            SlurmdPidFile={self.directory}/slurmd.%n.pid
            SlurmctldLogFile={self.directory}/slurmctld.log
            SlurmdLogFile={self.directory}/slurmd.%n.log
            ProctrackType=proctrack/linuxproc
            TaskPlugin=task/none
            MpiDefault=none
            JobAcctGatherType=jobacct_gather/none
            AccountingStorageType=accounting_storage/none
            SelectType=select/cons_tres
            SelectTypeParameters=CR_CPU
            SlurmdParameters=config_overrides
            ReturnToService=2
            SlurmdTimeout=10
            KillWait=5
            MinJobAge=300""".split("\n")
        for number, port in enumerate(nodes, 1):
            lines.append(f"NodeName=n{number} NodeHostname={socket.gethostname()} NodeAddr=127.0.0.1 Port={port} CPUs=1 "
                         "RealMemory=1000")
        lines.append(f"PartitionName=all Nodes=n[1-{NODES}] Default=YES MaxTime=INFINITE State=UP")
        (self.directory / "slurm.conf").write_text("\n".join(line.strip() for line in lines) + "\n")
        (self.directory / "state").mkdir()

    def start(self, name, *command):
        log = open(self.directory / f"{name}.out", "wb")
        self.daemons[name] = subprocess.Popen(command, env=self.env, stdout=log, stderr=log, start_new_session=True)

    def __enter__(self):
        directory = self.directory
        self.start("munged", "munged", "--foreground", "--force", f"--socket={directory}/munge.socket",
                   f"--key-file={directory}/munge.key", f"--pid-file={directory}/munged.pid",
                   f"--log-file={directory}/munged.log", f"--seed-file={directory}/munge.seed")
        wait_for("socket of munged", (directory / "munge.socket").exists, 30)
        self.start("slurmctld", "slurmctld", "-D", "-f", self.env["SLURM_CONF"])
        for number in range(1, NODES + 1):
            self.start(f"n{number}", "slurmd", "-D", "-N", f"n{number}", "-f", self.env["SLURM_CONF"])
        wait_for("idle nodes", lambda: self.run("sinfo", "-h", "-o", "%T %D").split() == ["idle", str(NODES)], 60)
        return self

    def __exit__(self, *exception):
        subprocess.run(["scancel", "--state=RUNNING", "--state=PENDING", "--user=root"], env=self.env, check=False,
                       timeout=30)
        for name in reversed(list(self.daemons)):
            daemon = self.daemons[name]
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    def run(self, *command):
        done = subprocess.run(command, env=self.env, cwd=WORK, text=True, stdout=subprocess.PIPE, timeout=60, check=False)
        return done.stdout

    def tasks_of(self, node):
        """The processes of a node's jobs by their ids, and those that watch them."""
        found = {}
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                environment = (process / "environ").read_bytes().split(b"\0")
                parent = int(re.search(r"^PPid:\s*(\d+)", (process / "status").read_text(), re.MULTILINE).group(1))
            except (OSError, AttributeError):
                continue
            if {f"SLURMD_NODENAME={node}".encode(), f"SLURM_CONF={self.env['SLURM_CONF']}".encode()} <= set(environment):
                found[int(process.name)] = parent
        return found

    def kill(self, node):
        """Ends a node as a power cut does: its slurmd first, then whatever watches its tasks, then these."""
        tasks = self.tasks_of(node)
        self.daemons[node].kill()
        self.daemons[node].wait()
        for process in [*(set(tasks.values()) - set(tasks) - {1}), *tasks]:
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                pass
        return len(tasks)


def check(condition, message):
    if not condition:
        raise SystemExit(message)


def same(name, whole):
    check(filecmp.cmp(WORK / name, WORK / whole, shallow=False), f"{name} differs from {whole}, the file of one run")
    say(f"{name} has the {(WORK / name).stat().st_size} bytes of one run")


def ricochet(*arguments):
    subprocess.run([RICOCHET, *arguments], check=True, cwd=WORK, timeout=WAIT_S)


def begun(node, cluster):
    """True if a task of the node has written points that it has not ended with."""
    if not cluster.tasks_of(node):
        return False
    running = cluster.run("squeue", "-h", "-r", "-w", node, "-o", "%K").split()
    manifests = [WORK / f"sweep.csv.shard-{task}-of-{SHARDS}.part.json" for task in running]
    return any(path.exists() and '"engine"' in path.read_text() for path in manifests)


def try_slurm():
    with Cluster(WORK / "cluster") as cluster:
        say(f"{NODES} nodes are idle")
        submitted = cluster.run(SOURCE / "deploy/slurm/submit.sh", WORK / "sweep.csv", str(SHARDS), *SWEEP)
        array, merge = re.fullmatch(r"array (\d+), then merge (\d+)\n", submitted).groups()
        wait_for("task that n2 has begun", lambda: begun("n2", cluster))
        say(f"killed n2 with {cluster.kill('n2')} processes of a task that had begun")
        wait_for("state down of n2", lambda: "down" in cluster.run("sinfo", "-h", "-n", "n2", "-o", "%T"))
        say("Slurm knows that n2 is down")
        wait_for("end of all jobs", lambda: not cluster.run("squeue", "-h"))
        job = cluster.run("scontrol", "show", "job", merge)
        check("JobState=COMPLETED" in job, f"the merge did not succeed: {job}")
        jobs = cluster.run("scontrol", "show", "job", array)
        check(re.search(r"Restarts=[1-9]", jobs), f"no task was started again: {jobs}")
        say("every task and the merge have ended with 0, one task in its second try")
    same("sweep.csv", "whole.csv")


def try_open_mpi():
    subprocess.run(
        ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", "3", RICOCHET, "sweep", *SWEEP, "--shard", "--threads", "1",
         "-o", "mpi.csv"], check=True, cwd=WORK, timeout=WAIT_S)
    ricochet("merge", "--verify", "mpi.csv", "--format", "csv", "-o", "mpi.csv")
    same("mpi.csv", "whole.csv")


START = time.monotonic()
shutil.rmtree(WORK, ignore_errors=True)
WORK.mkdir(parents=True)
ricochet("sweep", *SWEEP, "--format", "csv", "-o", "whole.csv")
say(f"one run of {POINTS} points")
try_slurm()
try_open_mpi()
