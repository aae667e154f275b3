"""A Slurm of one controller and several nodes on this machine, in a folder of its own. The machine's own configuration
stays as it is.

    python3 tests/farm/slurm_cluster.py FOLDER    # runs until it is interrupted; says what SLURM_CONF to set
"""
import os
import pathlib
import pwd
import shutil
import signal
import socket
import subprocess
import sys
import time

PROGRAMS = ("slurmctld", "slurmd", "slurmstepd", "sbatch", "scontrol", "squeue")
SBIN = f"{os.environ['PATH']}:/usr/sbin:/sbin"

# A node counts as dead 10 s after it was last heard of, its jobs go back to the queue, and it comes back by itself.
CONFIGURATION = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
AuthType=auth/none
CredType=cred/none
SlurmUser={user}
SlurmdUser={user}
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SlurmdParameters=config_overrides
SlurmdTimeout=10
ReturnToService=2
JobRequeue=1
KillWait=5
MessageTimeout=5
SchedulerParameters=bf_interval=2
StateSaveLocation={folder}/state
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdSpoolDir={folder}/spool.%n
SlurmdPidFile={folder}/slurmd.%n.pid
NodeName=n[1-{nodes}] NodeHostname={host} NodeAddr=127.0.0.1 Port=[{first}-{last}] CPUs=1 RealMemory=4096 State=UNKNOWN
PartitionName=test Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def find(program):
    return shutil.which(program, path=SBIN)


def missing_programs():
    return [program for program in PROGRAMS if not find(program)]


def free_ports(count):
    """The first of so many ports in a row that nobody listens on; another process begins to look elsewhere."""
    start = os.getpid() * count % 15000
    for first in [16820 + (start + i * count) % 15000 for i in range(1000)]:
        try:
            for port in range(first, first + count):
                with socket.socket() as probe:
                    probe.bind(("127.0.0.1", port))
            return first
        except OSError:
            continue
    raise OSError("no free ports")


class Process:
    """A process by its number, as /proc shows it."""

    def __init__(self, number):
        self.number = number
        folder = pathlib.Path("/proc", str(number))
        self.environment = dict(entry.split("=", 1) for entry in (folder / "environ").read_text(errors="replace").split("\0") if "=" in entry)
        self.words = (folder / "cmdline").read_text(errors="replace").split("\0")
        self.parent = int((folder / "stat").read_text().rsplit(")", 1)[1].split()[1])


class Cluster:
    def __init__(self, folder, nodes=3):
        self.folder = pathlib.Path(folder).resolve()
        self.names = [f"n{i + 1}" for i in range(nodes)]
        self.configuration = self.folder / "slurm.conf"
        self.environment = {**os.environ, "PATH": SBIN, "SLURM_CONF": str(self.configuration)}
        self.controller, self.nodes = None, {}

    def start(self):
        self.folder.mkdir(parents=True, exist_ok=True)
        (self.folder / "state").mkdir(exist_ok=True)
        port = free_ports(1 + len(self.names))
        self.configuration.write_text(CONFIGURATION.format(
            folder=self.folder, host=socket.gethostname(), user=pwd.getpwuid(os.getuid()).pw_name, nodes=len(self.names),
            port=port, first=port + 1, last=port + len(self.names)))
        self.controller = self._daemon("slurmctld", "-D", "-c", "-f", self.configuration)
        for name in self.names:
            self.start_node(name)
        for _ in range(600):
            answer = self.ask("sinfo", "-h", "-o", "%T %D")
            if answer.split() == ["idle", str(len(self.names))]:
                return self
            time.sleep(0.1)
        raise TimeoutError("the nodes did not come up: " + answer)

    def start_node(self, name):
        self.nodes[name] = self._daemon("slurmd", "-D", "-f", self.configuration, "-N", name, "-d", find("slurmstepd"), log=name)

    def _daemon(self, program, *words, log=None):
        with open(self.folder / f"{log or program}.log", "ab") as output:
            return subprocess.Popen([find(program), *map(str, words)], env=self.environment, stdin=subprocess.DEVNULL,
                                    stdout=output, stderr=output, start_new_session=True)

    def ask(self, *words):
        return subprocess.run(words, env=self.environment, capture_output=True, text=True, timeout=60).stdout

    def queue(self):
        """Lines of job, state and reason."""
        return self.ask("squeue", "-h", "-r", "-o", "%i %T %r").splitlines()

    def processes(self):
        """By node: the step daemons that run there, and all that they started."""
        steps, tasks = {name: [] for name in self.names}, {name: [] for name in self.names}
        found = {}
        for entry in os.listdir("/proc"):
            try:
                if entry.isdigit():
                    found[int(entry)] = Process(int(entry))
            except OSError:  # it has ended, or is another user's
                continue
        for number, process in found.items():
            if process.environment.get("SLURM_CONF") != str(self.configuration):
                continue
            name = process.environment.get("SLURMD_NODENAME")
            if name in tasks and "SLURM_JOB_ID" in process.environment:
                tasks[name].append(number)
                parent = found.get(process.parent)
                if parent and parent.words[0].startswith("slurmstepd") and process.parent not in steps[name]:
                    steps[name].append(process.parent)
        return steps, tasks

    def kill(self, numbers):
        """SIGKILL to those that are still there; how many."""
        killed = 0
        for number in numbers:
            try:
                os.kill(number, signal.SIGKILL)
                killed += 1
            except ProcessLookupError:
                pass
        return killed

    def kill_node(self, name):
        self.nodes[name].kill()
        self.nodes[name].wait()

    def stop(self):
        for process in [*self.nodes.values(), self.controller]:
            if process:
                process.kill()
                process.wait()
        for _ in range(50):  # a step that begins right now appears in a moment
            numbers = [number for group in self.processes() for of_node in group.values() for number in of_node]
            if not self.kill(numbers):
                return
            time.sleep(0.1)


if __name__ == "__main__":
    if missing_programs() or len(sys.argv) != 2:
        sys.exit(f"missing: {' '.join(missing_programs())}" if missing_programs() else __doc__)
    cluster = Cluster(sys.argv[1])
    try:
        cluster.start()
        print(f"export SLURM_CONF={cluster.configuration}", flush=True)
        signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
        signal.pause()
    except KeyboardInterrupt:
        pass
    finally:
        cluster.stop()
