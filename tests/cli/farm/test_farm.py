"""Jobs for farms without a farm: what submit writes, and what status tells of it."""
import json
import os
import shlex
import shutil
import subprocess
import time
import unittest

from cli.exr import read_channels
from cli.program import SANITIZED, TRIANGLE, TYNDALL, ProgramTest, gltf, lit_scene, recipe, run


class FarmTest(ProgramTest):
    FOLDER = "it's \"a\" job $HOME"

    def setUp(self):
        super().setUp()
        self.scene = self.write("my scene's.json", lit_scene(frames="1-3"))
        self.folder = self.path(self.FOLDER)

    def submit(self, engine="slurm", *options, scene=None):
        return self.succeed("submit", engine, scene or self.scene, "--samples", 16, "-o", self.folder, *options)

    def status(self, *options):
        result = run("status", self.folder, "--json", *options)
        self.assertIn(result.returncode, (0, 1), result.stderr)
        told = json.loads(result.stdout)
        self.assertEqual(result.returncode, 0 if told["finished"] == told["frames"] else 1)
        return told

    def run_commands(self, told):
        for command in told["commands"]:
            result = subprocess.run(["bash", "-c", command], capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, command + "\n" + result.stderr)

    def part(self, frame, part, parts=2):
        return self.folder / f"parts/my_scene_s.{frame:04}.part-{part}-of-{parts}.exr"


class Submit(FarmTest):
    def test_a_dry_run_prints_all_and_writes_nothing(self):
        for engine, words in (("slurm", ["task.sh", "submit.sh", "0 0-999\n1000 0-999\n2000 0-999"]),
                              ("openjd", ["template.json", "asset_references.yaml", "openjd run"])):
            before = self.files()
            said = self.submit(engine, "--frames", "1-1500", "--parts", 2, "--dry-run").stdout
            for word in ["job.json", *words]:
                self.assertIn(word, said)
            self.assertEqual(self.files(), before)

    def test_no_array_ends_above_1000_and_tasks_cover_all_once(self):
        """Frames begin at 1001, two by two, in three parts; task.sh is asked what each of its tasks would run."""
        self.submit("slurm", "--frames", "1001-2001", "--parts", 3, "--chunk", 2)
        seen = []
        echo = self.write("bin/tyndall", '#!/bin/bash\necho "${@@Q}"\n')
        echo.chmod(0o755)
        arrays = [line.split() for line in self.succeed("status", self.folder, "--tasks", "parts").stdout.splitlines()]
        self.assertEqual(arrays, [["0", "0-999"], ["1000", "0-502"]])
        for first, numbers in arrays:
            low, high = map(int, numbers.split("-"))
            self.assertLessEqual(high, 1000)
            for number in {low, low + 1, 2, high // 2, high}:
                said = subprocess.run(["bash", self.folder / "task.sh", "parts", first], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                                      env={**os.environ, "TYNDALL": str(echo), "SLURM_ARRAY_TASK_ID": str(number)}, check=True).stdout
                words = shlex.split(said)
                seen.append((int(first) + number, words[words.index("--frames") + 1], words[words.index("--part") + 1]))
                self.assertIn("--resume", words)
        for task, frames, part in seen:
            start = 1001 + 2 * (task // 3)
            self.assertEqual((frames, part), (f"{start}-{start + 1}" if start < 2001 else "2001", f"{task % 3 + 1}/3"))

    def test_scripts_are_valid_shell(self):
        for options in (["--samples", 2], ["--target-error", 0.1, "--set", "march.step_depth=0.2"]):
            shutil.rmtree(self.folder, ignore_errors=True)
            self.succeed("submit", "slurm", self.scene, "-o", self.folder, *options)
            for script in ("task.sh", "submit.sh"):
                subprocess.run(["bash", "-n", self.folder / script], check=True)

    def test_sbatch_gets_dependent_arrays(self):
        """A stand-in for sbatch writes down what it was given."""
        sbatch = self.write("bin/sbatch", '#!/bin/bash\necho "${@@Q}" >>"$LOG"\nwc -l <"$LOG"\n')
        sbatch.chmod(0o755)
        log = self.path("log")
        env = {**os.environ, "PATH": f"{sbatch.parent}:{os.environ['PATH']}", "LOG": str(log), "TYNDALL": TYNDALL}
        self.succeed("submit", "slurm", self.scene, "--samples", 2, "--frames", "1-600", "--parts", 2, "--cpus", 4, "--memory", 900,
                     "-o", self.folder, "--run", env=env)
        jobs = [shlex.split(line) for line in log.read_text().splitlines()]
        self.assertEqual([job[-3:] for job in jobs], [["task.sh", *words] for words in (
            ("prepare", "0"), ("parts", "0"), ("parts", "1000"), ("merge", "0"), ("finish", "1"))])
        for job in jobs:
            self.assertIn(f"--chdir={self.folder}", job)
            self.assertIn("--open-mode=append", job)
            self.assertIn("--cpus-per-task=4", job)
            self.assertIn("--mem=900", job)
            self.assertNotIn("--time", " ".join(job))  # SBATCH_TIMELIMIT of the forecast, or of whoever submits
        self.assertIn("--array=0-599", jobs[0])
        self.assertIn("--array=0-999", jobs[1])
        self.assertIn("--array=0-199", jobs[2])
        self.assertIn("--dependency=afterany:1", jobs[1])
        self.assertIn("--dependency=afterany:2:3", jobs[3])
        self.assertIn("--dependency=afterany:4", jobs[4])

    def limits(self, *options, **environment):
        """What sbatch gets by options and by environment, minutes and MiB."""
        shutil.rmtree(self.folder, ignore_errors=True)
        sbatch = self.write("bin/sbatch", '#!/bin/bash\necho "$SBATCH_TIMELIMIT $SBATCH_MEM_PER_NODE $*" >>"$LOG"\necho 1\n')
        sbatch.chmod(0o755)
        self.path("log").unlink(missing_ok=True)
        env = {**os.environ, "PATH": f"{sbatch.parent}:{os.environ['PATH']}", "LOG": str(self.path("log")), "TYNDALL": TYNDALL, **environment}
        self.succeed("submit", "slurm", self.scene, "-o", self.folder, "--run", *options, env=env)
        minutes, memory, options = self.path("log").read_text().splitlines()[0].split(" ", 2)
        return minutes, memory, options

    def test_limits_come_from_a_forecast(self):
        minutes, memory, _ = self.limits("--samples", 2)
        self.assertEqual(minutes, "10")
        self.assertTrue(1024 <= int(memory) < 4096, memory)
        long, large, _ = self.limits("--samples", 4096, "--res", "8192x8192", "--cpus", 1)
        self.assertGreater(int(long), 600)
        self.assertGreater(int(large), int(memory))
        parts, _, _ = self.limits("--samples", 4096, "--res", "8192x8192", "--cpus", 1, "--parts", 10)
        self.assertLess(int(parts), int(long) / 2)  # a tenth, by times that other work on the machine may stretch
        self.assertEqual(self.limits("--samples", 2, SBATCH_TIMELIMIT="7", SBATCH_MEM_PER_NODE="0")[:2], ("7", "0"))
        self.assertEqual(self.limits("--target-error", 0.2)[0], "")
        self.assertIn("--time=33", self.limits("--samples", 2, "--minutes", 33)[2])

    def test_assets_are_all_files_that_are_read(self):
        self.write("triangle.bin", TRIANGLE)
        self.write("triangle.gltf", gltf())
        self.write("fog recipe.json", recipe())
        self.succeed("bake", self.path("fog recipe.json"), "-o", self.path("fog.####.vdb"), "--frames", "1-3", "-q")
        scene = self.write("all.json", lit_scene(gltf="triangle.gltf", media=[
            {"type": "vdb", "file": "fog.####.vdb"}, {"type": "noise", "recipe": "fog recipe.json"}]))
        self.submit("openjd", "--frames", "1,3", scene=scene)
        files = json.loads((self.folder / "asset_references.yaml").read_text())["assetReferences"]["inputs"]["filenames"]
        self.assertEqual(files, sorted(str(self.path(name)) for name in (
            "all.json", "fog recipe.json", "fog.0001.vdb", "fog.0003.vdb", "triangle.bin", "triangle.gltf")))

    def test_the_template_says_what_openjd_wants(self):
        self.submit("openjd", "--parts", 4, "--chunk", 2, "--cpus", 3)
        template = json.loads((self.folder / "template.json").read_text())
        self.assertEqual(template["specificationVersion"], "jobtemplate-2023-09")
        self.assertEqual(template["extensions"], ["TASK_CHUNKING"])
        paths = [row for row in template["parameterDefinitions"] if row["type"] == "PATH"]
        self.assertEqual([(row["objectType"], row["dataFlow"]) for row in paths], [("DIRECTORY", "INOUT")])
        prepare, parts, merge = template["steps"]
        self.assertEqual(parts["dependencies"], [{"dependsOn": "Prepare"}])
        self.assertEqual(merge["dependencies"], [{"dependsOn": "Parts"}])
        for step in (prepare, parts, merge):
            action = step["script"]["actions"]["onRun"]
            self.assertEqual(action["cancelation"], {"mode": "NOTIFY_THEN_TERMINATE", "notifyPeriodInSeconds": 30})
            self.assertEqual(action["args"][-4:], ["--progress", "openjd", "--threads", "3"])

    def test_refusals(self):
        out = self.path("out")
        submit = ["submit", "slurm", self.scene, "-o", out]
        for code, words, arguments in (
                (2, ["ENGINE", "slurm"], ["submit", "slrm", self.scene, "-o", out]),
                (2, ["--parts", "at most 2 parts"], [*submit, "--samples", 2, "--parts", 3]),
                (2, ["--parts"], [*submit, "--parts", 0]), (2, ["--chunk"], [*submit, "--target-error", 0.1, "--chunk", 2]),
                (2, ["--time-budget"], [*submit, "--time-budget", 2]), (2, ["frames 1-", "column 3"], [*submit, "--frames", "1-"]),
                (2, ["--mode"], [*submit, "--mode", "marhc"]), (2, ["--run"], [*submit, "--run", "--dry-run"]),
                (2, ["--samples"], [*submit, "--samples", 5, "--target-error", 0.1]),
                (4, ["nothing.json"], ["submit", "slurm", self.path("nothing.json"), "-o", out])):
            self.refuse(code, words, *arguments)
        merge = ["merge", self.path("a.####.exr"), "-o", self.path("b.####.exr")]
        self.refuse(2, ["--frames", "needs --parts"], *merge, "--frames", 1)
        self.refuse(2, ["--frames", "####"], *merge, "--parts", 2)
        self.refuse(2, ["--parts"], *merge, "--parts", 0, "--frames", 1)
        self.submit()
        self.refuse(2, ["--output", "another job"], "submit", "slurm", self.scene, "--samples", 4, "-o", self.folder)
        self.submit()  # the same again
        self.check_refusal(run("submit", "openjd", self.scene, "-o", out, "--camera", "{{x}}"), 2, "camera")


class Status(FarmTest):
    def test_commands_finish_what_is_missing(self):
        self.submit("slurm", "--parts", 2)
        told = self.status()
        self.assertEqual((told["frames"], told["finished"], told["missing_parts"]), (3, 0, 6))
        self.assertEqual(len(told["commands"]), 3)
        self.run_commands(told)
        self.assertEqual(self.status("--verify")["commands"], [])
        self.succeed("render", "--plan", self.folder / "plan.json", "-o", self.path("one.####.exr"), "-q")
        for frame in (1, 2, 3):
            self.assertEqual(read_channels(self.folder / f"frames/my_scene_s.{frame:04}.exr"), read_channels(self.path(f"one.{frame:04}.exr")))
        shutil.rmtree(self.folder / "parts")  # merged frames need them no more
        self.assertEqual(self.status()["finished"], 3)
        self.assertEqual(self.succeed("status", self.folder, "--tasks", "merge").stdout, "")

    def test_each_frame_with_its_own_plan(self):
        self.succeed("submit", "openjd", self.scene, "--target-error", 0.2, "--frames", "1,3", "--parts", 2, "-o", self.folder)
        told = self.status()
        self.assertEqual([row["planned"] for row in told["unfinished"]], [False, False])
        self.assertEqual(len(told["commands"]), 2 + 4 + 2)
        self.run_commands(told)
        self.assertEqual(self.status()["finished"], 2)

    def test_what_is_suspicious_is_told_and_made_again(self):
        self.submit("slurm", "--parts", 2)
        self.run_commands(self.status())
        shutil.rmtree(self.folder / "frames")
        good = {part: part.read_bytes() for part in (self.folder / "parts").glob("*.exr")}
        whole = self.part(1, 1).read_bytes()
        damaged = bytearray(whole)
        damaged[-20] ^= 1
        for name, content, why in (
                (self.part(1, 1), whole[:-1], "truncated"), (self.part(1, 2), whole[:100], "truncated"), (self.part(2, 1), b"", "truncated"),
                (self.part(2, 2), good[self.part(1, 2)], "another frame"), (self.part(3, 1), good[self.part(3, 2)], "not the expected part"),
                (self.part(3, 2), b"x" * 5000, "not a scanline OpenEXR image")):
            name.write_bytes(content)
            told = self.status()
            self.assertEqual([row["file"] for row in told["suspicious"]], [str(name.relative_to(self.folder))])
            self.assertIn(why, told["suspicious"][0]["why"])
            self.assertEqual(told["missing_parts"], 1)
            name.write_bytes(good[name])
        self.part(1, 1).write_bytes(damaged)
        self.assertEqual(self.status()["suspicious"], [])  # headers tell nothing of it
        self.assertEqual(len(self.status("--verify")["suspicious"]), 1)
        self.run_commands(self.status("--verify"))
        self.assertEqual(self.part(1, 1).read_bytes(), whole)
        self.assertEqual(self.status("--verify")["finished"], 3)

    def test_a_part_of_another_plan(self):
        self.submit("slurm", "--parts", 2, "--seed", 5)
        self.run_commands(self.status())
        foreign = self.part(2, 2).read_bytes()
        shutil.rmtree(self.folder)
        self.submit("slurm", "--parts", 2)
        self.part(2, 2).write_bytes(foreign)
        self.assertEqual(self.status()["suspicious"][0]["why"], "was made from another plan")

    def test_a_frame_of_another_plan(self):
        self.submit("slurm", "--seed", 5)
        self.run_commands(self.status())
        frame = self.folder / "frames/my_scene_s.0002.exr"
        foreign = frame.read_bytes()
        shutil.rmtree(self.folder)
        self.submit("slurm")
        self.run_commands(self.status())
        frame.write_bytes(foreign)
        told = self.status()
        self.assertEqual((told["finished"], [row["why"] for row in told["suspicious"]]), (2, ["was made from another plan"]))

    def test_temporaries_and_cut_frames(self):
        self.submit("slurm")
        self.run_commands(self.status())
        frame = self.folder / "frames/my_scene_s.0002.exr"
        frame.write_bytes(frame.read_bytes()[:-8])
        self.write(f"{self.FOLDER}/parts/.my_scene_s.0002.part-1-of-1.exr.host.1-2.x.tmp", b"")
        told = self.status()
        self.assertEqual((told["finished"], told["temporaries"], told["missing_parts"]), (2, 1, 0))
        said = run("status", self.folder).stdout
        for words in ("finished: 2 of 3 frames", "temporary: 1 file,", "0002.exr: truncated", "submit.sh", "tyndall merge"):
            self.assertIn(words, said)
        self.run_commands(told)
        self.assertEqual(self.status()["finished"], 3)

    def test_a_frame_of_some_of_its_parts_is_not_finished(self):
        self.submit("slurm", "--parts", 2, "--frames", 1)
        told = self.status()
        subprocess.run(["bash", "-c", told["commands"][0]], check=True, capture_output=True)
        merged = run("merge", self.part(1, 1), "--partial", "-o", self.folder / "frames/my_scene_s.0001.exr")
        self.assertEqual(merged.returncode, 1, merged.stderr)
        told = self.status()
        self.assertEqual((told["finished"], told["missing_parts"]), (0, 1))
        self.assertEqual(told["suspicious"][0]["why"], "was merged while parts were missing")
        self.run_commands(told)
        self.assertEqual(self.status()["finished"], 1)

    def test_bad_jobs(self):
        self.refuse(4, ["job.json"], "status", self.path("nothing"))
        self.submit()
        job = self.folder / "job.json"
        text = job.read_text()
        for change, words in ((text[:-20], ["job.json"]), (text.replace('"parts":1', '"parts":0'), ["/parts"]),
                              (text.replace('"1-3"', '"1-"'), ["/frames"]), (text.replace("my_scene_s", "../x"), ["/name"])):
            job.write_text(change)
            self.refuse(3, words, "status", self.folder)
        job.write_text(text)
        (self.folder / "plan.json").unlink()
        self.refuse(4, ["plan.json"], "status", self.folder)

    def test_80000_parts_answer_in_time(self):
        """As many files as 10,000 frames of 8 parts have; a tenth under sanitizers."""
        count = 1000 if SANITIZED else 10000
        self.succeed("submit", "openjd", self.write("tiny.json", lit_scene(frames="1", resolution=[4, 4])), "--samples", 8, "--parts", 8,
                     "-o", self.folder)
        told = self.status()
        for command in told["commands"][:8]:
            subprocess.run(["bash", "-c", command], check=True, capture_output=True)
        job = self.folder / "job.json"
        job.write_text(job.read_text().replace('"frames":"1"', f'"frames":"1-{count}"'))
        mark = b"imageCounter\0int\0\4\0\0\0"
        for part in range(1, 9):
            content = (self.folder / f"parts/tiny.0001.part-{part}-of-8.exr").read_bytes()
            place = content.index(mark) + len(mark)
            for frame in range(2, count + 1):
                with open(self.folder / f"parts/tiny.{frame:04}.part-{part}-of-8.exr", "wb") as file:
                    file.write(content[:place] + frame.to_bytes(4, "little") + content[place + 4:])
        before, start = os.times(), time.monotonic()
        told = self.status()
        seconds, after = time.monotonic() - start, os.times()
        used = after.children_user + after.children_system - before.children_user - before.children_system
        self.assertEqual((told["missing_parts"], told["suspicious"], len(told["unfinished"])), (0, [], count))
        self.assertLess(min(seconds, used), 2, (seconds, used))  # of its own, whatever else the machine does


if __name__ == "__main__":
    unittest.main()
