"""What parts share, prepared once: the same bits with and without it, and no file that is gone, cut or damaged in use."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import time
import unittest

from cli.exr import read_channels
from cli.layered import LAMPS, panes
from cli.program import SANITIZED, TRIANGLE, TYNDALL, ProgramTest, lit_scene, recipe, run


class PrepareTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("triangle.bin", TRIANGLE)
        self.write("panes.gltf", panes())
        self.succeed("bake", self.write("recipe.json", recipe()), "-o", self.path("fog.vdb"), "-q")
        self.write("still.json", recipe(wind=[0, 0, 0]))
        self.scene = self.write("scene.json", lit_scene(
            frames="1-2", gltf="panes.gltf", lights=LAMPS, ambient=[0.1, 0.2, 0.3], resolution=[70, 37], media=[
                {"type": "vdb", "file": "fog.vdb", "extinction": 2, "translate": [0.2, 0, 0]},
                {"type": "noise", "recipe": "still.json", "extinction": 1}]))
        self.cache = self.path("plan.cache")

    def plan(self, *options, mode="march", samples=8):
        orders = ("--orders", "all", "--set", "fluence.paths=20000") if mode in ("march", "froxel", "path") else ()
        self.succeed("plan", self.scene, "--mode", mode, "--save", self.path("plan.json"), "--samples", samples, "--float",
                     "-q", *orders, *options)
        return self.path("plan.json")

    def prepare(self, plan, *options):
        return json.loads(self.succeed("prepare", "--plan", plan, "--json", "--progress", "none", *options).stdout)

    def image(self, plan, *options):
        """Frame 1 by one run of the plan."""
        self.succeed("render", "--plan", plan, "-o", self.path("one.exr"), "--frames", 1, "-q", *options)
        return read_channels(self.path("one.exr"))

    def cached(self, kind="bricks"):
        return sorted(self.cache.glob(f"{kind}-*.cache"))

    def test_the_bits_are_the_same_in_every_mode(self):
        for mode in [mode["name"] for mode in json.loads(self.succeed("modes", "--json").stdout)["modes"]]:
            plan = self.plan("--frames", 1, mode=mode)
            shutil.rmtree(self.cache, ignore_errors=True)
            plain = self.image(plan)
            made = {thing["what"] for thing in self.prepare(plan)["frames"][0]["things"] if thing["file"]}
            self.assertIn("bricks", made, mode)
            found = self.succeed("render", "--plan", plan, "-o", self.path("one.exr"), "-v").stderr
            for what in made:
                self.assertIn("found " + what.replace(" ", "-"), found, mode)
            self.assertEqual(read_channels(self.path("one.exr")), plain, mode)
            for part in (1, 2, 3):
                self.succeed("render", "--plan", plan, "-o", self.path("part.exr"), "--part", f"{part}/3", "-q")
            self.succeed("merge", *self.directory.glob("part.part-*-of-3.exr"), "-o", self.path("merged.exr"), "-q")
            self.assertEqual(read_channels(self.path("merged.exr")), plain, mode)

    def test_the_bits_are_the_same_with_every_way_to_dim_light(self):
        for light in ("grid", "froxel", "average", "marched"):
            plan = self.plan("--frames", 1, "--set", f"terms.light={light}", mode="froxel")
            shutil.rmtree(self.cache, ignore_errors=True)
            plain = self.image(plan)
            self.prepare(plan)
            self.assertEqual(self.image(plan), plain, light)

    def test_targets_are_met_with_the_same_bits(self):
        self.succeed("plan", self.scene, "--mode", "march", "--target-error", 0.1, "--frames", 1, "--save",
                     self.path("plan.json"), "-q")
        plain = self.image(self.path("plan.json"))
        self.prepare(self.path("plan.json"))
        self.assertEqual(self.image(self.path("plan.json")), plain)

    def test_frames_share_what_stands_still(self):
        report = self.prepare(self.plan())
        kinds = [{thing["what"]: thing["kind"] for thing in frame["things"]} for frame in report["frames"]]
        self.assertEqual([kinds[0][what] for what in ("bricks", "fluence", "edges", "surfaces")],
                         ["cached", "cached", "cached", "rebuilt"])
        self.assertEqual([kinds[1][what] for what in ("bricks", "fluence", "edges")], ["found", "found", "cached"])
        self.assertEqual(len(self.cached()), 2)
        again = self.prepare(self.path("plan.json"))
        self.assertNotIn("cached", [t["kind"] for f in again["frames"] for t in f["things"] if t["file"]])
        self.assertEqual(again["bytes"], report["bytes"])

    def test_a_vanished_or_cut_file_is_unreadable(self):
        plan = self.plan("--frames", 1)
        self.prepare(plan)
        render = ("render", "--plan", plan, "-o", self.path("x.exr"), "--part", "1/2", "-q")
        for file in sorted(self.cache.glob("*.cache")):
            data = file.read_bytes()
            for size in (0, 100, len(data) // 2, len(data) - 1):
                file.write_bytes(data[:size])
                self.refuse(4, [file.name, "is truncated", f"{size} of {len(data)} bytes"], *render)
            file.unlink()
            self.refuse(4, [file.name, "no such file"], *render)
            file.write_bytes(data)
        self.succeed(*render)

    def test_damage_is_refused(self):
        plan = self.plan("--frames", 1)
        plain = self.image(plan)
        self.prepare(plan)
        self.succeed("render", "--plan", plan, "-o", self.path("x.exr"), "--part", "1/1", "-q")
        file = self.cached()[0]
        data = file.read_bytes()
        stamp = os.stat(file)
        for at in (0, 20, 40, 100, 128, len(data) // 2, len(data) - 1):
            file.write_bytes(data[:at] + bytes([data[at] ^ 4]) + data[at + 1:])
            self.refuse(3, [file.name, "damaged"], "render", "--plan", plan, "-o", self.path("y.exr"), "-q")
            self.refuse(3, [file.name, "damaged"], "prepare", "--plan", plan)
            os.utime(file, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))  # parts trust the time stamp, merge does not
            self.refuse(3, [file.name, "damaged"], "merge", self.path("x.part-1-of-1.exr"), "-o", self.path("y.exr"))
            if at < 128:
                self.refuse(3, [file.name, "damaged"], "render", "--plan", plan, "-o", self.path("y.exr"), "-q")
        file.write_bytes(data)  # another time stamp, the same bytes
        self.assertEqual(self.image(plan), plain)
        manifest = self.path("plan.cache/frame.0001.json")
        text = manifest.read_text()
        manifest.write_text(text[:-20])
        self.refuse(3, ["frame.0001.json"], "render", "--plan", plan, "-o", self.path("y.exr"), "-q")
        manifest.write_text(text.replace("bricks-", "../bricks-"))
        self.refuse(3, ["frame.0001.json", "names of files in its folder"], "render", "--plan", plan, "-o",
                    self.path("y.exr"), "-q")

    def start_long(self, plan):
        """A run of the plan, as soon as it has mapped both files of bricks."""
        process = subprocess.Popen([TYNDALL, "render", "--plan", plan, "-o", self.path("long.exr"), "--threads", "1", "-q"],
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        maps, end = pathlib.Path(f"/proc/{process.pid}/maps"), time.monotonic() + 60
        while len(set(re.findall("bricks-[0-9a-f]+", maps.read_text()))) < 2:
            self.assertIsNone(process.poll(), "ended too early")
            self.assertLess(time.monotonic(), end)
        return process

    def test_files_deleted_while_mapped_do_no_harm(self):
        plan = self.plan("--frames", 1, samples=64)
        plain = self.image(plan)
        self.prepare(plan)
        process = self.start_long(plan)
        for file in self.cached():
            file.unlink()
        self.assertEqual((process.wait(), process.stderr.read()), (0, ""))
        process.stderr.close()
        self.assertEqual(read_channels(self.path("long.exr")), plain)

    @unittest.skipIf(SANITIZED, "the sanitizer takes the signal")
    def test_files_cut_while_mapped_end_the_run(self):
        plan = self.plan("--frames", 1, samples=256)
        self.prepare(plan)
        for size in (0, 5000):  # nothing is left, or the header and a little more
            process = self.start_long(plan)
            for file in self.cached():
                os.truncate(file, size)
            self.assertEqual(process.wait(), 4)
            said = process.stderr.read()
            process.stderr.close()
            self.assertRegex(said, r"^tyndall: error: .*bricks-[0-9a-f]{32}\.cache: was (truncated|changed).*\n$")
            self.assertFalse(self.path("long.exr").exists())
            shutil.rmtree(self.cache)
            self.prepare(plan)

    def test_runs_at_once_and_killed_runs_do_no_harm(self):
        plan = self.plan()
        plain = self.image(plan)
        command = [TYNDALL, "prepare", "--plan", plan, "-q"]
        killed = subprocess.Popen(command)
        time.sleep(0.05)
        killed.kill()
        killed.wait()
        self.cache.mkdir(exist_ok=True)
        (self.cache / f".bricks-0.cache.{os.uname().nodename}.{os.stat('/proc/self/ns/pid').st_ino}-{killed.pid}.{'0' * 16}.tmp").write_text("left")
        both = [subprocess.Popen(command) for _ in range(2)]
        self.assertEqual([process.wait() for process in both], [0, 0])
        self.assertEqual([file for file in self.files() if file.endswith(".tmp")], [])
        self.assertEqual(len(self.cached()), 2)
        self.assertEqual(self.image(plan), plain)

    def test_local_copies(self):
        plan = self.plan("--frames", 1)
        plain = self.image(plan)
        self.prepare(plan)
        self.assertEqual(self.image(plan, "--cache-local", self.path("local")), plain)
        copies = sorted(self.path("local").iterdir())
        self.assertEqual([copy.name for copy in copies], [file.name for file in sorted(self.cache.glob("*.cache"))])
        stamps = [copy.stat().st_mtime_ns for copy in copies]
        copies[0].write_bytes(copies[0].read_bytes()[:-1])  # copied again
        for file in self.cache.glob("*.cache"):
            if file.name != copies[0].name:
                file.unlink()  # not needed any more
        self.assertEqual(self.image(plan, "--cache-local", self.path("local")), plain)
        self.assertEqual([copy.stat().st_mtime_ns for copy in copies[1:]], stamps[1:])
        self.write("occupied", "a file")
        shutil.rmtree(self.cache)
        self.prepare(plan)
        self.refuse(5, ["occupied"], "render", "--plan", plan, "-o", self.path("x.exr"), "--cache-local", self.path("occupied"),
                    "-q")
        self.refuse(2, ["--cache-local", "needs --plan"], "render", self.scene, "-o", self.path("x.exr"), "--cache-local", "a")

    def test_what_does_not_fit_is_said_and_made_anew(self):
        plan = self.plan("--frames", 1)
        plain = self.image(plan)
        said = self.succeed("prepare", "--plan", plan, "--cache-size", 0).stderr
        self.assertIn("no room bricks", said)
        self.assertIn("--cache-size leaves no room", said)
        self.assertEqual(list(self.cache.glob("*.cache")), [])
        self.assertEqual(self.image(plan), plain)
        self.prepare(plan, "--cache-size", 1e-4)
        self.assertLessEqual(sum(file.stat().st_size for file in self.cache.glob("*.cache")), 1e5)
        self.assertGreater(len(list(self.cache.glob("*.cache"))), 0)
        self.assertEqual(self.image(plan), plain)

    def test_cleaning(self):
        plan = self.plan()
        self.prepare(plan)
        before = self.files()
        self.succeed("prepare", "--plan", plan, "--clean", "-q")
        self.assertEqual(self.files(), before)
        self.plan("--seed", 3)  # another plan of this name
        said = self.succeed("render", "--plan", plan, "-o", self.path("x.exr"), "--frames", 1).stderr
        self.assertIn("was prepared for another plan", said)
        self.prepare(plan, "--frames", 2)
        self.succeed("prepare", "--plan", plan, "--clean", "-q")
        self.assertFalse((self.cache / "frame.0001.json").exists())
        self.assertEqual((len(self.cached()), len(self.cached("fluence")), len(self.cached("edges"))), (2, 1, 1))
        self.write("plan.cache/mine.txt", "not of the program")
        self.succeed("prepare", "--plan", plan, "--clean-all", "-q")
        self.assertEqual([file.name for file in self.cache.iterdir()], ["mine.txt"])
        self.path("plan.cache/mine.txt").unlink()
        self.prepare(plan)
        self.succeed("prepare", "--plan", plan, "--clean-all", "-q")
        self.assertFalse(self.cache.exists())

    def test_volumes_that_changed_are_refused(self):
        plan = self.plan("--frames", 1)
        plain = self.image(plan)
        self.prepare(plan)
        fog = self.path("fog.vdb")
        data = fog.read_bytes()
        fog.write_bytes(data)  # another time stamp, the same bytes
        self.assertEqual(self.image(plan), plain)
        self.succeed("bake", self.write("other.json", recipe(noise={"octaves": 2, "scale": 0.5, "seed": 1})), "-o", fog, "-q")
        self.refuse(3, ["fog.vdb", "has changed since", "frame.0001.json"], "render", "--plan", plan, "-o", self.path("x.exr"), "-q")
        self.prepare(plan)
        self.assertNotEqual(self.image(plan), plain)

    def test_the_command_line(self):
        plan = self.plan("--frames", 1)
        self.refuse(2, ["--frames", "frame 9 is not in the plan"], "prepare", "--plan", plan, "--frames", 9)
        for size in ("-1", "much"):
            self.refuse(2, ["--cache-size"], "prepare", "--plan", plan, "--cache-size", size)
        self.refuse(4, ["none.json"], "prepare", "--plan", self.path("none.json"))
        self.write("plan.cache", "a file")
        self.refuse(5, ["plan.cache"], "prepare", "--plan", plan)


if __name__ == "__main__":
    unittest.main()
