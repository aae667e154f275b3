"""A job that openjd-cli runs: each step with the one it depends on, to the bits of one run."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from cli.exr import read_channels
from cli.program import SOURCE, ProgramTest, run

OPENJD = shutil.which("openjd", path=f"{SOURCE / 'build/openjd/bin'}:{os.environ['PATH']}")


@unittest.skipUnless(OPENJD, "openjd-cli is not installed: tests/farm/install.sh")
class OpenJd(ProgramTest):
    def openjd(self, *words):
        result = subprocess.run([OPENJD, *map(str, words)], capture_output=True, text=True, timeout=600)
        self.assertEqual(result.returncode, 0, result.stdout[-3000:] + result.stderr)
        return result.stdout

    def submit(self, *options):
        folder = self.path("a job")
        self.succeed("submit", "openjd", SOURCE / "scenes/window.json", "--res", "64x36", "-o", folder, *options)
        return folder

    def test_the_merge_step_runs_what_it_depends_on(self):
        """Frames come in chunks that are ranges with a step, and each has the bits of one run."""
        folder = self.submit("--frames", "1-9:2,12", "--chunk", 4, "--parts", 3, "--samples", 16)
        said = self.openjd("run", folder / "template.json", "--step", "Merge", "--run-dependencies")
        self.assertIn("Frames(CHUNK[INT]) = 1-5:2", said)
        self.assertIn("openjd_progress: 100", said)
        self.assertIn("Chunks run: 10", said)  # six frames in two chunks: prepared, six parts and two merges
        self.succeed("status", folder, "--verify")
        self.succeed("render", "--plan", folder / "plan.json", "-o", self.path("one.####.exr"), "-q")
        for frame in (1, 3, 5, 7, 9, 12):
            self.assertEqual(read_channels(folder / f"frames/window.{frame:04}.exr"),
                             read_channels(self.path(f"one.{frame:04}.exr")), frame)

    def test_each_frame_gets_a_plan_for_an_error(self):
        folder = self.submit("--frames", "1,9", "--parts", 2, "--target-error", 0.2, "--cpus", 1, "--memory", 500)
        self.openjd("run", folder / "template.json", "--step", "Merge", "--run-dependencies")
        self.succeed("status", folder)
        self.assertEqual(len(list((folder / "plans").glob("plan.*.json"))), 2)

    def test_one_task_can_run_again(self):
        folder = self.submit("--frames", "1-2", "--parts", 2, "--samples", 2)
        self.openjd("run", folder / "template.json", "--step", "Parts", "--tasks", json.dumps([{"Frames": "2", "Part": 1}]))
        self.assertEqual([file.name for file in (folder / "parts").iterdir()], ["window.0002.part-1-of-2.exr"])

    def test_a_failure_is_told_to_the_session(self):
        folder = self.submit("--frames", "1", "--samples", 2)
        (folder / "plan.json").write_text("{}")
        result = subprocess.run([OPENJD, "run", folder / "template.json", "--step", "Parts"], capture_output=True, text=True)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("openjd_fail: ", result.stdout)
        self.assertIn("plan.json", result.stdout)

    def test_templates_are_valid(self):
        for options in (["--frames", "-3--1"], ["--target-error", 0.1, "--frames", "7"], ["--parts", 9, "--chunk", 1000]):
            shutil.rmtree(self.path("a job"), ignore_errors=True)
            self.assertIn("passes validation", self.openjd("check", self.submit("--samples" if "--target-error" not in options else "--seed", 9, *options) / "template.json"))


if __name__ == "__main__":
    unittest.main()
