"""Frames rendered in parts from a saved plan: the bits of one run, and no other parts among them."""
import json
import math
import random
import re
import shutil
import signal
import subprocess
import time
import unittest

from cli.exr import read_channels
from cli.layered import LAMPS, PARTS, fog, panes
from cli.program import TRIANGLE, TYNDALL, ProgramTest, lit_scene, run

ALL_LAYERS = f"Z,transmittance,validity,variance,halves,{PARTS}"


def part_of(checkpoint):
    """How much of a part is there."""
    finished = read_channels(checkpoint)["finished"]
    return sum(finished) / len(finished)


class PartsTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("triangle.bin", TRIANGLE)
        self.write("panes.gltf", panes())
        self.scene = self.write("scene.json", lit_scene(
            gltf="panes.gltf", lights=LAMPS, ambient=[0.1, 0.2, 0.3], media=[fog(), fog(extinction=0.3)],
            resolution=[70, 37]))

    def plan(self, *options, name="plan.json", mode="march"):
        self.succeed("plan", self.scene, "--mode", mode, "--save", self.path(name), "-q", *options)
        return self.path(name)

    def render_part(self, plan, part, parts, *options, name="frame.exr"):
        self.succeed("render", "--plan", plan, "-o", self.path(name), "--part", f"{part}/{parts}", "-q", *options)

    def parts(self, plan, count, *options, name="frame.exr"):
        """Renders all parts; returns their files in the order of the parts."""
        for part in range(1, count + 1):
            self.render_part(plan, part, count, *options, name=name)
        return sorted(self.directory.glob(f"{name[:-4]}.part-*-of-{count}.exr"))

    def merge(self, files, name="merged.exr", *options):
        return self.succeed("merge", *files, "-o", self.path(name), "-q", *options)

    def one_run(self, plan, *options):
        self.succeed("render", "--plan", plan, "-o", self.path("one.exr"), "-q", *options)
        return read_channels(self.path("one.exr"))

    def test_parts_make_the_bits_of_one_run_in_every_mode(self):
        """At any number of threads, in any order, all layers."""
        chance = random.Random(3)
        for mode in json.loads(self.succeed("modes", "--json").stdout)["modes"]:
            layers = PARTS if mode["name"] == "radial-blur" else ALL_LAYERS
            plan = self.plan("--samples", 16, "--groups", 4, "--aov", layers, "--float", "--crop", "5,3,66,35", mode=mode["name"])
            one = self.one_run(plan, "--threads", 1)
            for count in (1, 3, 8):
                files = self.parts(plan, count, "--threads", 2)
                chance.shuffle(files)
                self.merge(files)
                with self.subTest(mode=mode["name"], parts=count):
                    self.assertEqual(read_channels(self.path("merged.exr")), one)

    def test_depths_are_those_of_plain_render_with_a_lens(self):
        camera = {"position": [0, 0.3, 3], "target": [0, 0.2, 0], "aperture_radius": 0.3, "focus_distance": 1}
        self.scene = self.write("lens.json", lit_scene(gltf="panes.gltf", camera=camera, media=[fog()], resolution=[70, 37]))
        plan = self.plan("--samples", 4, "--groups", 2, "--aov", "Z", "--float")
        one = self.one_run(plan)["Z"]
        self.merge(self.parts(plan, 2))
        self.succeed("render", self.scene, "-o", self.path("plain.exr"), "--float", "--samples", 4, "--aov", "Z", "-q")
        for other in ("merged.exr", "plain.exr"):
            self.assertEqual(read_channels(self.path(other))["Z"], one, other)

    def test_more_parts_than_leaves_share_them_block_by_block(self):
        plan = self.plan("--samples", 2, "--orders", "all", "--aov", ALL_LAYERS, "--float")
        one = self.one_run(plan)
        for count in (2, 7, 12):  # two groups of one leaf, six blocks
            self.merge(self.parts(plan, count))
            self.assertEqual(read_channels(self.path("merged.exr")), one, count)
        self.refuse(2, ["--part", "at most 12 parts"], "render", "--plan", plan, "-o", self.path("frame.exr"), "--part", "1/13")

    def test_a_single_group_is_the_sequence_of_plain_render(self):
        """With its noise, and sections of the sequence that tell no less than that."""
        plan = self.plan("--samples", 32, "--float")
        self.one_run(plan)
        self.succeed("render", self.scene, "-o", self.path("plain.exr"), "--float", "--samples", 32, "-q")
        same = json.loads(run("compare", self.path("one.exr"), self.path("plain.exr"), "--json").stdout)
        self.assertLess(same["metrics"]["E"], 1e-5)
        self.merge(self.parts(plan, 3))
        self.assertTrue(read_channels(self.path("merged.exr")) == read_channels(self.path("one.exr")))
        self.succeed("render", self.scene, "-o", self.path("truth.exr"), "--float", "--samples", 256, "--seed", 5, "-q")
        error = json.loads(run("compare", self.path("merged.exr"), self.path("truth.exr"), "--json").stdout)["metrics"]["E"]
        said = self.attributes("merged.exr")
        self.assertLess(error, float(said["tyndall:errorBound"]))
        self.assertLess(float(said["tyndall:achievedError"]), 4 * error)
        for option in (("--target-error", 0.1), ("--aov", "halves")):
            self.refuse(2, ["--groups", "two independent groups"], "plan", self.scene, "--mode", "march", "--groups", 1, *option,
                        "--save", self.path("x.json"))
        self.refuse(2, ["--aov", "two samples"], "plan", self.scene, "--mode", "march", "--samples", 1, "--aov", "variance",
                    "--save", self.path("x.json"))

    def test_what_all_samples_share_is_part_of_the_error(self):
        """Steps and the grid of multiple scattering are measured when the frame is planned."""
        plan = self.plan("--samples", 16, "--groups", 2, "--orders", "all", "--quality", "draft", "--float")
        shared = [json.loads(plan.read_text())[name] for name in ("integrator", "orders")]
        for error, bound in shared:
            self.assertGreater(bound, error)
        self.merge(self.parts(plan, 2))
        said = self.attributes("merged.exr")
        self.assertGreater(float(said["tyndall:noiseBound"]), 0)
        for i, (name, noise) in enumerate((("achievedError", "noiseError"), ("errorBound", "noiseBound"))):
            self.assertAlmostEqual(float(said["tyndall:" + name]),
                                   math.hypot(float(said["tyndall:" + noise]), *(error[i] for error in shared)), 5)

    def test_groups_can_be_added(self):
        few = self.plan("--samples", 8, "--groups", 8)
        files = self.parts(few, 2)
        self.merge(files)
        before = self.attributes("merged.exr")
        for part in (1, 2):
            self.render_part(few, part, 2, "--more", 8)
        self.render_part(few, 1, 1, "--more", "16@16")
        files += sorted(self.directory.glob("frame.groups-*-to-*.part-*.exr"))
        self.assertEqual(len(files), 5)
        twice = self.path("frame.groups-17-to-32.part-1-of-1.exr")
        self.refuse(3, [twice, "has samples that are also in"], "merge", *files, twice, "-o", self.path("twice.exr"))
        self.merge(files)
        after = self.attributes("merged.exr")
        self.assertGreater(float(after["tyndall:samples"]), 3.9 * (float(before["tyndall:samples"]) - 0.5))  # rounded
        share = float(after["tyndall:achievedError"]) / float(before["tyndall:achievedError"])
        self.assertAlmostEqual(share, 0.5, delta=0.1)

    def test_a_target_is_planned_for_and_checked_when_merged(self):
        for mode, target in (("march", 0.04), ("froxel", 0.2), ("path", 0.1)):
            plan = self.plan("--target-error", target, "--float", mode=mode)
            one = self.one_run(plan)
            files = self.parts(plan, 3)
            self.merge(files)
            self.assertEqual(read_channels(self.path("merged.exr")), one, mode)
            said = self.attributes("merged.exr")
            self.assertEqual(said["tyndall:errorBound"], self.attributes("one.exr")["tyndall:errorBound"])
            self.assertLessEqual(float(said["tyndall:errorBound"]), target, mode)
            self.succeed("render", self.scene, "-o", self.path("truth.exr"), "--float", "--quality", "final", "-q",
                         *(("--mode", "path", "--samples", 512) if mode == "path" else ("--samples", 64)))
            far = json.loads(run("compare", self.path("merged.exr"), self.path("truth.exr"), "--json").stdout)
            self.assertLessEqual(far["metrics"]["E"], 1.05 * float(said["tyndall:errorBound"]), mode)
        counts = self.path("plan.counts")
        counts.write_bytes(counts.read_bytes()[:-1] + b"\1")
        self.refuse(3, ["plan.counts", "damaged"], "render", "--plan", self.path("plan.json"), "-o", self.path("x.exr"))

    def test_a_missed_target_names_the_groups_that_are_lacking(self):
        plan = self.plan("--target-error", 0.05, "--groups", 4)
        planned = json.loads(plan.read_text())
        planned["target"]["error"] = 0.02  # further than it was planned for
        plan.write_text(json.dumps(planned))
        files = self.parts(plan, 2)
        missed = run("merge", *files, "-o", self.path("merged.exr"))
        self.assertEqual(missed.returncode, 1, missed.stderr)
        self.assertTrue(self.path("merged.exr").exists())
        more = re.search(r"lacks \d+ groups: tyndall render --plan \S+ -o \S+ --frames 1 --more (\d+)", missed.stderr)
        self.assertTrue(more, missed.stderr)
        self.succeed("render", "--plan", plan, "-o", self.path("frame.exr"), "--more", more[1], "-q")
        self.merge(files + list(self.directory.glob("frame.groups-*")))
        self.assertLessEqual(float(self.attributes("merged.exr")["tyndall:errorBound"]), 0.02)

    def test_what_does_not_belong_together_is_refused_by_name(self):
        plan = self.plan("--samples", 8)
        a, b, c = self.parts(plan, 3)
        out = self.path("merged.exr")
        self.refuse(3, [b, "has samples that are also in"], "merge", a, b, b, c, "-o", out)
        self.refuse(3, [a, "a part is missing next to 1/3", "leaf"], "merge", a, c, "-o", out)
        self.refuse(3, [b, "a part is missing"], "merge", c, b, "-o", out)
        self.refuse(3, [b, "a part is missing"], "merge", a, b, "-o", out)

        other = self.plan("--samples", 8, "--seed", 1, name="other.json")
        d = self.parts(other, 3, name="other.exr")[1]
        self.refuse(3, [d, "a different plan"], "merge", a, d, c, "-o", out)
        self.refuse(3, ["frame.part-1-of-3.exr", "does not belong to"], "merge", a, b, c, "-o", out, "--plan", other)
        whole = self.path("whole.exr")
        self.succeed("render", "--plan", plan, "-o", whole, "-q")
        self.refuse(3, [whole, "is not a part"], "merge", a, whole, c, "-o", out)

    def test_inputs_are_never_written_over(self):
        self.succeed("render", self.scene, "-o", self.path("sky.exr"), "--res", "8x4", "--samples", 1)
        self.scene = self.write("scene.json", {**json.loads(self.scene.read_text()), "background": {"image": "sky.exr"}})
        files = self.parts(self.plan("--samples", 2), 2)
        for taken in [self.path("sky.exr"), files[1]]:
            before = taken.read_bytes()
            self.refuse(2, [taken.name, "overwritten"], "merge", *files, "-o", taken)
            self.assertEqual(taken.read_bytes(), before)

    def test_every_damage_is_seen(self):
        plan = self.plan("--samples", 8)
        a, b = self.parts(plan, 2)
        data, chance = b.read_bytes(), random.Random(1)
        for size in range(0, len(data), 4096):
            b.write_bytes(data[:size])
            self.assertIn(run("merge", a, b, "-o", self.path("merged.exr")).returncode, (3, 4), size)
        for _ in range(40):
            at, bit = chance.randrange(len(data)), chance.randrange(8)
            b.write_bytes(data[:at] + bytes([data[at] ^ 1 << bit]) + data[at + 1:])
            self.refuse(3, [b], "merge", a, b, "-o", self.path("merged.exr"))
        b.write_bytes(data)
        self.merge([a, b])

    def test_a_plan_is_only_for_what_it_was_made_of(self):
        plan = self.plan("--samples", 8)
        files = self.parts(plan, 2)
        text = plan.read_text()
        for key, value in (("build", "0"), ("version", "0.0.0")):
            self.write("changed.json", json.dumps(json.loads(text) | {key: value}))
            self.refuse(3, ["changed.json", f"/{key}", "made by"], "render", "--plan", self.path("changed.json"), "-o",
                        self.path("x.exr"))
        self.write("changed.json", json.dumps(json.loads(text) | {"groups": "8"}))
        self.refuse(3, ["changed.json", "/groups"], "render", "--plan", self.path("changed.json"), "-o", self.path("x.exr"))
        self.write("panes.gltf", self.path("panes.gltf").read_text() + " ")
        self.refuse(3, ["panes.gltf", "has changed since"], "render", "--plan", plan, "-o", self.path("x.exr"), "--part", "1/2")
        self.refuse(3, ["panes.gltf", "has changed since"], "merge", *files, "-o", self.path("x.exr"))

    def test_options_that_a_plan_decides_are_refused_beside_it(self):
        plan = self.plan("--samples", 8)
        for option in (("--samples", 4), ("--mode", "path"), ("--seed", 1), ("--res", "8x8"), ("--float",), (self.scene,)):
            self.refuse(2, ["is fixed by the plan"], "render", "--plan", plan, "-o", self.path("x.exr"), *option)
        self.refuse(2, ["--part", "needs --plan"], "render", self.scene, "-o", self.path("x.exr"), "--part", "1/2")
        for part in ("0/2", "3/2", "1", "a/b", "1/0"):
            self.refuse(2, ["--part"], "render", "--plan", plan, "-o", self.path("x.exr"), "--part", part)
        self.refuse(2, ["--png"], "render", "--plan", plan, "-o", self.path("x.exr"), "--part", "1/2", "--png")
        self.refuse(2, ["--frames", "frame 9 is not in the plan"], "render", "--plan", plan, "-o", self.path("x.exr"),
                    "--frames", 9)

    def test_parts_that_are_there_are_kept(self):
        plan = self.plan("--samples", 8)
        self.render_part(plan, 1, 2)
        again = self.succeed("render", "--plan", plan, "-o", self.path("frame.exr"), "--part", "1/2", "--resume").stderr
        self.assertIn("kept", again)
        part = self.path("frame.part-1-of-2.exr")
        part.write_bytes(part.read_bytes()[:-100])
        again = self.succeed("render", "--plan", plan, "-o", self.path("frame.exr"), "--part", "1/2", "--resume").stderr
        self.assertIn("rendering again", again)

    def test_a_part_that_was_killed_goes_on_from_its_checkpoint(self):
        """By SIGTERM within ten seconds; by SIGKILL from the last checkpoint; the bits are those of a part in one go."""
        plan = self.plan("--samples", 512, "--aov", ALL_LAYERS, "--float")
        self.render_part(plan, 1, 1, name="whole.exr")
        whole = read_channels(self.path("whole.part-1-of-1.exr"))
        part, checkpoint = self.path("frame.part-1-of-1.exr"), self.path("frame.part-1-of-1.checkpoint")
        command = [TYNDALL, "render", "--plan", plan, "-o", self.path("frame.exr"), "--part", "1/1", "--threads", "1",
                   "--checkpoint", "0.01", "--resume"]
        continued = 0
        for stop in (signal.SIGTERM, signal.SIGKILL) * 2:
            with subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as run:
                while run.poll() is None and not (checkpoint.exists() and part_of(checkpoint) > continued):
                    time.sleep(0.05)
                run.send_signal(stop)
                at = time.monotonic()
                said = run.communicate(timeout=30)[1]
            self.assertEqual(run.returncode, 143 if stop == signal.SIGTERM else -9, said)
            self.assertLess(time.monotonic() - at, 10)
            self.assertEqual("resumes from" in said, continued > 0, said)
            self.assertGreater(part_of(checkpoint), continued)
            continued = part_of(checkpoint)
        self.refuse(3, [checkpoint, "of an unfinished part"], "merge", checkpoint, "-o", self.path("merged.exr"))
        self.assertFalse(part.exists())
        self.assertIn("resumes from", self.succeed(*command[1:]).stderr)
        self.assertFalse(checkpoint.exists())
        self.assertEqual(read_channels(part), whole)

    def test_a_checkpoint_of_something_else_is_not_taken(self):
        plan = self.plan("--samples", 8)
        files = self.parts(plan, 2)
        checkpoint = self.path("frame.part-1-of-2.checkpoint")
        shutil.copy(files[1], checkpoint)
        files[0].unlink()
        said = self.succeed("render", "--plan", plan, "-o", self.path("frame.exr"), "--part", "1/2", "--resume").stderr
        self.assertIn("starts over", said)
        self.assertFalse(checkpoint.exists())
        self.refuse(2, ["--checkpoint", "needs --part or --more"], "render", "--plan", plan, "-o", self.path("x.exr"), "--checkpoint", 1)

    def test_pngs_are_those_of_one_run(self):
        for name, exposure in (("measured", {}), ("stated", {"exposure": 2})):
            with self.subTest(exposure=name):
                self.scene = self.write("scene.json", {**json.loads(self.scene.read_text()), **exposure})
                plan = self.plan("--samples", 2, name=f"{name}.json")
                self.one_run(plan, "--png")
                self.merge(self.parts(plan, 2, name=f"{name}.exr"), "merged.exr", "--png")
                self.assertEqual(self.path("merged.png").read_bytes(), self.path("one.png").read_bytes())

    def test_what_is_there_can_be_merged(self):
        """With more noise, which is told where it can be; the frame is never taken for a finished one."""
        plan = self.plan("--samples", 64, "--groups", 4, "--float")
        one = self.one_run(plan)
        files = self.parts(plan, 8)
        self.merge(files, "all.exr", "--partial")
        self.assertEqual(read_channels(self.path("all.exr")), one)
        self.succeed("check", self.path("all.exr"), files[0])
        out = self.path("some.exr")
        before = self.attributes("all.exr")
        for there, known in (([0, 1, 2, 4, 5, 6, 7], True), ([0, 5], True), ([2], False)):
            some = run("merge", *(files[i] for i in there), self.path("frame.part-9-of-8.exr"), "-o", out, "--partial",
                       "--json")
            self.assertEqual(some.returncode, 1, some.stderr)
            self.assertIn("parts are missing", some.stderr)
            frame = json.loads(some.stdout)["frames"][0]
            self.assertAlmostEqual(frame["share"], len(there) / 8)
            self.assertEqual("error" in frame, known)
            if known:
                self.assertGreater(frame["error"], 0.9 * float(before["tyndall:achievedError"]))
            self.assertNotEqual(self.attributes("some.exr")["tyndall:hash"], before["tyndall:hash"])
            metrics = json.loads(run("compare", out, self.path("all.exr"), "--json").stdout)["metrics"]
            self.assertLess(metrics["E"], 0.3)
            problem = run("check", out)
            self.assertEqual(problem.returncode, 1)
            self.assertIn(f"from {len(there) / 8:g} of the samples", problem.stdout)
        blocks = self.parts(self.plan("--samples", 2, "--float", name="few.json"), 12, name="few.exr")
        some = run("merge", *blocks[1:], "-o", out, "--partial")
        self.assertEqual(some.returncode, 1, some.stderr)
        self.assertIn("noise unknown", some.stderr)
        none = run("merge", blocks[0], "-o", out, "--partial")
        self.assertIn("none for", none.stderr)
        for values in read_channels(out).values():
            self.assertNotIn(b"\x00\x00\xc0\x7f", values)

    def test_parts_that_come_late_are_waited_for(self):
        files = self.parts(self.plan("--samples", 8), 2)
        late = files[1].rename(self.path("late"))
        self.refuse(4, [files[1], "no such file"], "merge", *files, "-o", self.path("merged.exr"), "--wait", 0.5)
        waiting = subprocess.Popen([TYNDALL, "merge", *map(str, files), "-o", str(self.path("merged.exr")), "--wait", "30"],
                                   stderr=subprocess.PIPE)
        time.sleep(0.5)
        late.rename(files[1])
        self.assertEqual(waiting.wait(20), 0, waiting.communicate()[1])

    def test_parts_are_removed_only_when_asked_to(self):
        plan = self.plan("--samples", 8)
        files = self.parts(plan, 2)
        self.merge(files)
        self.assertTrue(all(file.exists() for file in files))
        self.merge(files, "merged.exr", "--remove-parts")
        self.assertFalse(any(file.exists() for file in files))


if __name__ == "__main__":
    unittest.main()
