"""Sequences: killed and resumed, stopped, on any number of threads, by several processes: always the same bits."""
import contextlib
import json
import os
import pty
import random
import re
import signal
import subprocess
import threading
import time
import unittest

from cli.program import TYNDALL, ProgramTest, recipe, run, scene

FRAMES = "1-3"


class Sequence(ProgramTest):
    def setUp(self):
        super().setUp()
        self.recipe = self.write("recipe.json", recipe())
        self.scene = self.write("scene.json", scene(media=[{"type": "vdb", "file": "fog/fog.####.vdb"}]))

    def bake(self, place="fog/fog.####.vdb", *more):
        return ("bake", self.recipe, "-o", self.path(place), "--frames", FRAMES, *more)

    def render(self, place, *more):
        return ("render", self.scene, "-o", self.path(f"{place}/out.####.exr"), "--frames", FRAMES, *more)

    def finished(self, place):
        return {name: data for name, data in self.content(place).items() if not name.endswith(".tmp")}

    def start(self, *arguments):
        return subprocess.Popen([TYNDALL, *map(str, arguments)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def reference(self):
        """Fog and frames of an undisturbed run, and how long the render took."""
        self.succeed(*self.bake())
        start = time.monotonic()
        self.succeed(*self.render("reference"))
        seconds = time.monotonic() - start
        frames = self.content("reference")
        self.assertEqual(sorted(frames), ["out.0001.exr", "out.0002.exr", "out.0003.exr"])
        self.assertEqual(len(set(frames.values())), 3, "the fog moves, so frames differ")
        return frames, seconds


class Kill(Sequence):
    def kill_rounds(self, command, place, reference, seconds, rounds):
        """Kills the command at random moments, then lets --resume finish it."""
        moments = random.Random(1)
        for _ in range(rounds):
            process = self.start(*command)
            try:
                process.wait(timeout=moments.uniform(0, 1.1 * seconds))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
            for name, data in self.finished(place).items():
                self.assertEqual(data, reference[name], f"{name} is not complete after a kill")
            # Every other time the frames stay, so that --resume below finds some.
            if moments.random() < 0.5:
                for name in self.finished(place):
                    self.path(f"{place}/{name}").unlink()
        self.succeed(*command, "--resume")
        self.assertEqual(self.content(place), reference, "resumed and undisturbed runs have to agree, nothing beside")

    def test_killed_renders_leave_complete_frames_only(self):
        reference, seconds = self.reference()
        self.kill_rounds(self.render("killed"), "killed", reference, seconds, 12)

    def test_killed_bakes_leave_complete_volumes_only(self):
        start = time.monotonic()
        self.succeed(*self.bake("whole/fog.####.vdb"))
        seconds = time.monotonic() - start
        self.kill_rounds(self.bake("killed/fog.####.vdb"), "killed", self.content("whole"), seconds, 12)


class Resume(Sequence):
    def test_it_keeps_what_is_right_and_replaces_what_is_not(self):
        reference, _ = self.reference()
        command = self.render("out", "--resume", "--json")
        kept = lambda result: [frame["kept"] for frame in json.loads(result.stdout)["frames"]]
        self.assertEqual(kept(self.succeed(*command)), [False, False, False])
        self.assertEqual(kept(self.succeed(*command)), [True, True, True])

        second = self.path("out/out.0002.exr")
        data = second.read_bytes()
        damages = [data[:len(data) // 5], data[:-1], b"", data[:-200] + bytes(200), b"x" * len(data)]
        for damage in damages:
            second.write_bytes(damage)
            self.assertEqual(kept(self.succeed(*command)), [True, False, True])
            self.assertEqual(self.content("out"), reference)

    def test_it_renders_again_what_was_made_differently(self):
        self.reference()
        self.succeed(*self.render("out"))
        first = self.path("out/out.0001.exr")
        before = first.read_bytes()
        for change in [("--seed", "1"), ("--samples", "2"), ("--set", "terms.light=off"), ("--res", "32x18")]:
            self.succeed(*self.render("out", "--resume", *change))
            self.assertNotEqual(first.read_bytes(), before, change)
            before = first.read_bytes()

        # Fog of the same name with other content.
        self.succeed(*self.render("out"))
        before = first.read_bytes()
        self.write("recipe.json", recipe(density={"threshold": 0.3, "gain": 2}))
        self.succeed(*self.bake())
        self.succeed(*self.render("out", "--resume"))
        self.assertNotEqual(first.read_bytes(), before)

    def test_what_remembers_fog_is_rendered_again_with_it(self):
        self.succeed(*self.bake())
        command = self.render("out", "--resume", "--json", "--mode", "froxel", "--history", "1")
        kept = lambda: [frame["kept"] for frame in json.loads(self.succeed(*command).stdout)["frames"]]
        kept()
        self.assertEqual(kept(), [True, True, True])
        self.write("recipe.json", recipe(density={"threshold": 0.3, "gain": 2}))
        self.succeed("bake", self.recipe, "-o", self.path("fog/fog.####.vdb"), "--frames", "1")
        self.assertEqual(kept(), [False, False, True])

    def test_bakes_are_resumed_by_content(self):
        self.succeed(*self.bake())
        before = self.content("fog")
        counts = lambda result: [json.loads(result.stdout)[key] for key in ("written", "kept")]
        self.assertEqual(counts(self.succeed(*self.bake(), "--resume", "--json")), [0, 3])
        self.path("fog/fog.0003.vdb").write_bytes(before["fog.0003.vdb"][:-100])
        self.assertEqual(counts(self.succeed(*self.bake(), "--resume", "--json")), [1, 2])
        self.assertEqual(self.content("fog"), before)
        self.assertEqual(counts(self.succeed(*self.bake(), "--resume", "--json", "--voxel-size", "0.05")), [3, 0])

    def test_kept_files_say_nothing_of_the_time_left(self):
        for command in (self.bake(), self.render("out")):
            self.succeed(*command)
            result = self.succeed(*command, "--resume", "--progress", "json")
            lines = [json.loads(line) for line in result.stdout.splitlines()]
            self.assertEqual([(round(line["progress"], 2), line["left"]) for line in lines],
                             [(0, None), (0.33, None), (0.67, None), (1, 0)])


class Bits(Sequence):
    def test_threads_and_ranges_do_not_matter(self):
        reference, _ = self.reference()
        for threads in (1, 2):
            self.succeed(*self.render(f"threads{threads}", "--threads", threads))
            self.assertEqual(self.content(f"threads{threads}"), reference)
            self.succeed(*self.bake(f"fog{threads}/fog.####.vdb", "--threads", threads))
            self.assertEqual(self.content(f"fog{threads}"), self.content("fog"))
        for frames in ("3", "2,1"):
            self.succeed("render", self.scene, "-o", self.path("parts/out.####.exr"), "--frames", frames)
        self.assertEqual(self.content("parts"), reference)

    def test_a_crop_holds_the_same_pixels(self):
        self.succeed(*self.bake())
        whole, part = self.path("whole.exr"), self.path("part.exr")
        command = ("render", self.scene, "--frames", "1", "--aov", "none")
        self.succeed(*command, "-o", whole)
        self.succeed(*command, "-o", part, "--crop", "16,8,48,30")
        report = self.info(part)
        self.assertEqual((report["display"], report["low"], report["size"]), ([64, 36], [16, 8], [32, 22]))

    def test_two_processes_may_work_on_the_same_frames(self):
        reference, _ = self.reference()
        for _ in range(3):
            processes = [self.start(*self.render("shared")) for _ in range(2)]
            self.assertEqual([process.wait(timeout=60) for process in processes], [0, 0])
            self.assertEqual(self.content("shared"), reference)
            for name in reference:
                self.path(f"shared/{name}").unlink()


class Signals(Sequence):
    def stop(self, process, *signals):
        """Sends signals; the exit code and the seconds until the process was gone."""
        start = time.monotonic()
        for number in signals:
            process.send_signal(number)
        process.wait(timeout=10)
        return process.returncode, time.monotonic() - start

    def long_render(self, place):
        """A render that would take minutes, once its first frame has begun."""
        process = subprocess.Popen([TYNDALL, *map(str, self.render(place, "--samples", "4096", "--res", "640x360"))],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertIn("ALF_PROGRESS", process.stdout.readline())
        time.sleep(0.5)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        return process

    def test_asked_to_stop(self):
        self.succeed(*self.bake())
        for number, code in [(signal.SIGTERM, 143), (signal.SIGINT, 130)]:
            process = self.long_render("stopped")
            stopped, seconds = self.stop(process, number)
            self.assertEqual(stopped, code)
            self.assertLess(seconds, 2)
            self.assertIn("stopped", process.stderr.read())
            self.assertEqual(self.content("stopped"), {}, "the unfinished frame is dropped, nothing is left")

    def test_asked_twice(self):
        self.succeed(*self.bake())
        process = self.long_render("stopped")
        os.kill(process.pid, signal.SIGSTOP)  # so that both signals wait when it goes on
        threading.Timer(0.1, lambda: os.kill(process.pid, signal.SIGCONT)).start()
        code, seconds = self.stop(process, signal.SIGTERM, signal.SIGINT)
        self.assertIn(code, (130, 143))
        self.assertLess(seconds, 1)
        self.assertEqual(self.finished("stopped"), {})

    def test_a_bake_stops_as_well(self):
        fine = self.write("fine.json", recipe(voxel_size=0.01))
        process = self.start("bake", fine, "-o", self.path("fine/fog.####.vdb"), "--frames", "1-500")
        time.sleep(0.7)
        self.assertIsNone(process.poll())
        code, seconds = self.stop(process, signal.SIGTERM)
        self.assertEqual(code, 143)
        self.assertLess(seconds, 2)
        for name in self.finished("fine"):
            self.succeed("check", self.path(f"fine/{name}"))


class Check(Sequence):
    def test_a_numbered_name_stands_for_all_pictures_and_the_gaps_between(self):
        self.reference()
        pattern = self.path("reference/out.####.exr")
        self.succeed("check", pattern)
        self.path("reference/out.0002.exr").write_bytes(b"no picture")
        self.assertIn("out.0002.exr", run("check", pattern).stdout)
        self.path("reference/out.0002.exr").unlink()
        self.assertNotEqual(run("check", pattern).returncode, 0)


class Progress(Sequence):
    def test_farms_read_progress_on_stdout(self):
        self.succeed(*self.bake())
        for command in (self.bake("again/fog.####.vdb"), self.render("out")):
            result = self.succeed(*command)
            lines = result.stdout.splitlines()
            percents = [int(re.fullmatch(r"ALF_PROGRESS (\d+)%", line).group(1)) for line in lines]
            self.assertEqual(percents, sorted(percents))
            self.assertEqual((percents[0], percents[-1]), (0, 100))
            self.assertNotIn("\r", result.stdout + result.stderr)

    def test_reports_come_after_progress_on_the_same_stream(self):
        """Of every command whose report has stdout; with --json it has it alone."""
        still = self.write("still.json", scene(frames="1"))
        for command in (("explain", still, "--pixel", "3,3", "--modes", "none"), ("plan", still, "--target-error", "0.5"),
                        ("stress", "--cases", "albedo", "--modes", "cone"),
                        ("chart", still, "-o", self.path("chart"), "--modes", "cone", "--quick")):
            result = self.succeed(*command, timeout=200)
            lines = result.stdout.splitlines()
            percents = [int(line[13:-1]) for line in lines if line.startswith("ALF_PROGRESS ")]
            self.assertEqual((percents[0], percents[-1]), (0, 100), command)
            self.assertTrue(all(line.startswith("ALF_PROGRESS ") for line in lines[:len(percents)]), command)
            self.assertGreater(len(lines), len(percents), command)
            self.assertNotIn("ALF_PROGRESS", result.stderr)
            result = self.succeed("--json", *command, timeout=200)
            json.loads(result.stdout)
            self.assertIn("ALF_PROGRESS 100%", result.stderr)

    def test_the_bar_is_where_the_terminal_is(self):
        """Also when only stderr is one, and the report goes into a file."""
        for terminal, other in (("stdout", "stderr"), ("stderr", "stdout")):
            reader, writer = pty.openpty()
            process = subprocess.run([TYNDALL, "stress", "--cases", "albedo", "--modes", "cone"], text=True, timeout=60,
                                     **{terminal: writer, other: subprocess.PIPE})
            os.close(writer)
            shown = b""
            with contextlib.suppress(OSError):  # the end of a terminal
                while piece := os.read(reader, 65536):
                    shown += piece
            os.close(reader)
            self.assertIn(b"100%", shown)
            self.assertNotIn("100%", getattr(process, other))

    def test_styles(self):
        self.succeed(*self.bake())
        result = self.succeed(*self.render("out", "--progress", "json"))
        steps = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual(steps[-1]["progress"], 1)
        self.assertEqual(self.succeed(*self.render("out", "--progress", "none")).stdout, "")
        self.assertIn("100%", self.succeed(*self.render("out", "--progress", "bar")).stdout)

    def test_statistics(self):
        self.succeed(*self.bake())
        stats = self.path("stats.json")
        self.succeed(*self.render("out", "--stats-json", stats, "--png"))
        report = json.loads(stats.read_text())
        self.assertEqual([frame["frame"] for frame in report["frames"]], [1, 2, 3])
        self.assertEqual(report["totals"]["non_finite"], 0)
        self.assertGreater(report["totals"]["camera_rays"], 3 * 64 * 36)
        self.assertTrue(self.path("out/out.0001.png").read_bytes().startswith(b"\x89PNG"))
        self.assertEqual(len(self.content("out")), 6)


if __name__ == "__main__":
    unittest.main()
