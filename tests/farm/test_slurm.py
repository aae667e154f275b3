"""A job on a real Slurm, a controller and three nodes on this machine, while daemons and tasks are killed at random: it
completes by itself, with the bits of one run. With TYNDALL_NIGHTLY=1 24 frames of 3 parts and at least 20 kills."""
import os
import pathlib
import random
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from cli.exr import read_channels
from cli.program import SOURCE, TYNDALL, ProgramTest, run
from slurm_cluster import Cluster, missing_programs

NIGHTLY = bool(os.environ.get("TYNDALL_NIGHTLY"))
MISSING = missing_programs()
# Slurm itself takes three minutes to give up a step or a node and start its job again: for the long test only.
KINDS = ("task", "step", "node", "slurmd") if NIGHTLY else ("task", "slurmd")


class Killer:
    """Kills something of a running job now and then, and starts daemons again a few seconds later, as an init does."""

    def __init__(self, cluster, seed, seconds):
        self.cluster, self.chance, self.seconds = cluster, random.Random(seed), seconds
        self.kills, self.next, self.down = {kind: 0 for kind in KINDS}, time.monotonic() + 1, {}

    def count(self):
        return sum(self.kills.values())

    def step(self, most):
        now = time.monotonic()
        for name in [name for name, when in self.down.items() if when < now]:
            self.cluster.start_node(name)
            del self.down[name]
        if now < self.next or self.count() >= most:
            return
        steps, tasks = self.cluster.processes()
        busy = [name for name in self.cluster.names if tasks[name] and steps[name] and name not in self.down]
        if not busy:
            return
        kind, name = self.chance.choice(KINDS), self.chance.choice(busy)
        victims = {"task": [self.chance.choice(tasks[name])], "step": steps[name], "node": steps[name] + tasks[name],
                   "slurmd": []}[kind]
        if kind in ("node", "slurmd"):
            self.cluster.kill_node(name)
            self.down[name] = now + self.chance.uniform(1, 4)
        if self.cluster.kill(victims) or not victims:
            self.kills[kind] += 1
            self.next = now + self.chance.uniform(*self.seconds)

    def finish(self):
        for name in self.down:
            self.cluster.start_node(name)


@unittest.skipIf(MISSING, "Slurm is not installed: " + ", ".join(MISSING) + " (apt-get install slurmctld slurmd slurm-client)")
class Slurm(ProgramTest):
    def setUp(self):
        super().setUp()
        self.cluster = Cluster(self.path("slurm"))
        self.addCleanup(self.cluster.stop)
        self.cluster.start()

    def submit(self, *options):
        """A job in a folder whose name needs quotes, handed over; its folder."""
        folder = self.path("it's \"a\" job $HOME")
        self.succeed("submit", "slurm", SOURCE / "scenes/window.json", "--res", "64x36", "-o", folder, "--run", *options,
                     env=self.cluster.environment)
        return folder

    def wait_for(self, seconds, step=lambda: None):
        end = time.monotonic() + seconds
        while queue := self.cluster.queue():
            self.assertLess(time.monotonic(), end, "\n".join(queue))
            step()
            time.sleep(0.2)

    def check_bits(self, folder, frames):
        """Each frame has the bits of one run of the plan."""
        self.succeed("render", "--plan", folder / "plan.json", "-o", self.path("one.####.exr"), "-q", timeout=3600)
        for frame in frames:
            merged = read_channels(folder / f"frames/window.{frame:04}.exr")
            self.assertEqual(merged, read_channels(self.path(f"one.{frame:04}.exr")), frame)

    def kill_during_job(self, frames, samples, kills, seconds, limit):
        folder = self.submit("--frames", f"1001-{1000 + frames}", "--parts", 3, "--samples", samples)
        killer, start = Killer(self.cluster, 24, seconds), time.monotonic()
        self.wait_for(limit, lambda: killer.step(kills))
        killer.finish()
        print(f"{frames} frames x 3 parts: {killer.count()} kills {killer.kills} in {time.monotonic() - start:.0f} s", file=sys.stderr)
        self.assertEqual(run("status", folder, "--verify").returncode, 0, run("status", folder).stdout)
        self.assertGreaterEqual(killer.count(), kills)
        self.check_bits(folder, range(1001, 1001 + frames))

    @unittest.skipIf(NIGHTLY, "the long one runs instead")
    def test_a_job_survives_kills(self):
        self.kill_during_job(4, 512, 3, (1, 2), 300)

    @unittest.skipUnless(NIGHTLY, "long: set TYNDALL_NIGHTLY=1")
    def test_a_job_survives_many_kills(self):
        self.kill_during_job(24, 512, 24, (2, 6), 3600)

    def test_each_frame_gets_a_plan_for_an_error(self):
        folder = self.submit("--frames", "1,9", "--parts", 2, "--target-error", 0.2, "--remove-parts")
        self.wait_for(120)
        self.succeed("status", folder)
        self.assertEqual(sorted(file.name for file in (folder / "frames").iterdir()), ["window.0001.exr", "window.0009.exr"])
        self.assertEqual(list((folder / "parts").glob("*.exr")), [])
        self.assertEqual(len(list((folder / "plans").glob("plan.*.json"))), 2)
        again = subprocess.run(["bash", folder / "submit.sh"], env=self.cluster.environment, capture_output=True, text=True)
        self.assertEqual(again.stdout, "nothing is missing\n", again.stderr)

    def wait_until(self, word, seconds=60):
        """Until the first part is in that state."""
        end = time.monotonic() + seconds
        while not any(line.startswith("1_0 " + word) for line in self.cluster.queue()):
            self.assertLess(time.monotonic(), end, self.cluster.queue())
            time.sleep(0.2)

    def test_a_task_that_is_told_to_stop_leaves_a_checkpoint_and_is_queued_again(self):
        folder = self.submit("--frames", "1-1", "--samples", 4096)
        self.wait_until("RUNNING")
        time.sleep(3)
        self.cluster.ask("scancel", "--batch", "--signal=TERM", "1_0")  # as a time limit does
        self.wait_until("PENDING")
        self.assertEqual([file.name for file in (folder / "parts").iterdir()], ["window.0001.part-1-of-1.checkpoint"])
        self.assertIn("started: 1 part,", run("status", folder).stdout)
        if NIGHTLY:  # Slurm waits for two minutes before it starts it again
            self.wait_for(900)
            self.succeed("status", folder, "--verify")
            self.check_bits(folder, [1])

    def test_what_is_cancelled_stays_cancelled(self):
        folder = self.submit("--frames", "1-3", "--samples", 4096)
        self.wait_until("RUNNING")
        self.cluster.ask("scancel", *{line.split("_")[0].split(" ")[0] for line in self.cluster.queue()})
        self.wait_for(60)
        self.assertEqual(run("status", folder).returncode, 1)


if __name__ == "__main__":
    unittest.main()
