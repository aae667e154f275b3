"""The viewer: techniques, time, mouse and keys, and files equal to those of render."""
import os
import pathlib
import subprocess
import time
import unittest

from cli.exr import read_channels
from cli.program import SANITIZED, TYNDALL, run, scene
from cli.viewer import random_actions
from cli.viewer.viewer import VIEWER, ViewerTest

MODES = ("march", "froxel", "shadow-map", "shadow-volume", "cone", "billboard", "radial-blur", "path")


class Pictures(ViewerTest):
    """A scene that renders in a moment."""

    def setUp(self):
        super().setUp()
        self.write_triangle()
        self.film = self.write("scene.json", scene(gltf="triangle.gltf", frames="1-8"))

    def same(self, name, *options):
        """Whether the file is the one that render writes under this name, which its header has."""
        files = [self.path(name).with_suffix(suffix) for suffix in (".exr", ".png")]
        before = {file: file.read_bytes() for file in files if file.exists()}
        self.succeed("render", self.film, "-o", files[0], "-q", "--png", *options)
        rendered = self.path(name).read_bytes()
        for file in files:
            file.unlink()
        for file, content in before.items():
            file.write_bytes(content)
        return rendered == before[self.path(name)]

    def test_written_pictures_are_those_of_render(self):
        self.view(self.film, ["wait samples 2", f"snapshot {self.path('a.exr')}", f"snapshot {self.path('a.png')}",
                              "frame 3", "set march.nodes 7", "exposure 1", f"snapshot {self.path('b.exr')}",
                              f"snapshot {self.path('b.png')}", "quality draft", "size 80 50",
                              f"snapshot {self.path('c.exr')}"], "--seed", "5")
        self.assertTrue(self.same("a.exr", "--frames", 1, "--seed", 5))
        self.assertTrue(self.same("a.png", "--frames", 1, "--seed", 5))
        changed = ("--frames", 3, "--seed", 5, "--set", "march.nodes=7", "--exposure", 1)
        self.assertTrue(self.same("b.exr", *changed))
        self.assertTrue(self.same("b.png", *changed))
        self.assertTrue(self.same("c.exr", "--frames", 3, "--seed", 5, "--quality", "draft", "--res", "80x50"))

    def test_every_mode_has_a_key_and_its_pictures_are_those_of_render(self):
        lines = ["set pixel.samples 4"]
        for number, mode in enumerate(MODES, 1):
            lines += [f"key {number}", "wait idle", f"snapshot {self.path(mode + '.exr')}"]
        self.view(self.film, lines, "--samples", 2)
        for mode in MODES:
            self.assertTrue(self.same(f"{mode}.exr", "--frames", 1, "--mode", mode, "--samples", 4), mode)

    def test_the_mouse_turns_the_camera_and_drags_time(self):
        self.view(self.film, ["wait idle", "drag 450,400 600,420", "wait idle", f"snapshot {self.path('a.exr')}",
                              "camera", f"snapshot {self.path('b.exr')}", "drag 260,776 700,776",
                              f"snapshot {self.path('c.exr')}"], "--samples", 2)
        self.assertIn('--camera view', str(self.attributes("a.exr")))
        self.assertFalse(self.same("a.exr", "--frames", 1))
        self.assertTrue(self.same("b.exr", "--frames", 1))
        self.assertTrue(any(self.same("c.exr", "--frames", frame) for frame in range(2, 9)))

    def test_sliders_change_settings(self):
        drags = [f"drag 1173,{y} 1215,{y}" for y in range(560, 780, 30)]
        self.view(self.film, ["wait idle", *drags, f"snapshot {self.path('a.exr')}", "reset all",
                              f"snapshot {self.path('b.exr')}"], "--samples", 1)
        self.assertIn(" --set ", str(self.attributes("a.exr")))
        self.assertTrue(self.same("b.exr", "--frames", 1))

    def test_time_goes_on_by_keys_and_by_playing(self):
        self.view(self.film, ["key right", "key right", f"snapshot {self.path('a.exr')}", "key left", "play 3",
                              f"snapshot {self.path('b.exr')}"], "--samples", 2)
        self.assertTrue(self.same("a.exr", "--frames", 3))
        self.assertTrue(self.same("b.exr", "--frames", 4))

    def test_another_scene_is_opened(self):
        other = self.write("other.json", scene(background={"color": [0.5, 0, 0]}))
        self.view(self.film, ["wait samples 1", f"open {other}", f"snapshot {self.path('a.exr')}"], "--samples", 2)
        self.film = other
        self.assertTrue(self.same("a.exr", "--frames", 1))

    def test_a_file_that_changes_is_read_again_and_a_broken_one_is_not_the_end(self):
        def change():
            self.write("scene.json", "{ broken")
            time.sleep(1)
            self.write("scene.json", scene(gltf="triangle.gltf", background={"color": [0, 0.5, 0]}))
        self.view(self.film, [f"snapshot {self.path('a.exr')}", "wait 4", f"snapshot {self.path('b.exr')}"],
                  "--samples", 2, once=(self.path("a.exr"), change))
        self.assertTrue(self.same("b.exr", "--frames", 1))
        self.assertNotEqual(*(read_channels(self.path(name))["R"] for name in ("a.exr", "b.exr")))


class Mistakes(ViewerTest):
    def setUp(self):
        super().setUp()
        self.film = self.write("scene.json", scene())

    def check(self, lines, code, *words):
        told = self.view(self.film, lines, code=code)
        errors = [line for line in told.splitlines() if line.startswith("tyndall: error: ")]
        self.assertEqual(len(errors), 1, told)
        for word in words:
            self.assertIn(word, errors[0])

    def test_scripts_end_where_they_are_wrong(self):
        self.check(["wait idle", "spin 3"], 3, "script.txt:2", "spin")
        self.check(["", "mode marsh"], 2, "script.txt:2", "marsh")
        self.check(["set march.nods 4"], 2, "script.txt:1", "march.nodes")
        self.check(["key nothing"], 2, "script.txt:1")
        self.check(["open missing.json"], 4, "script.txt:1", "missing.json")
        self.check([f"open {self.write('bad.json', '{')}"], 3, "script.txt:1", "bad.json")
        self.check([f"snapshot {self.path('a.jpg')}"], 2, "script.txt:1", "a.jpg")
        self.check([f"snapshot {self.film}/a.exr"], 5, "script.txt:1")

    def test_a_first_scene_that_cannot_be_read_is_said_at_once(self):
        self.film = self.write("bad.json", "{}")
        self.check(["wait idle"], 3, "bad.json")


class CommandLine(ViewerTest):
    def plain(self, *arguments):
        """Without any display."""
        environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        return subprocess.run([VIEWER, *map(str, arguments)], text=True, capture_output=True, timeout=60,
                              env=environment)

    def test_without_a_display_it_says_so(self):
        self.check_refusal(self.plain(self.write("a.json", scene())), 69, "display", "xvfb-run")

    def test_mistakes_come_before_the_window(self):
        film = self.write("a.json", scene())
        self.check_refusal(self.plain("missing.json"), 4, "missing.json")
        self.check_refusal(self.plain(film, "--mode", "marsh"), 2, "marsh")
        self.check_refusal(self.plain(film, "--set", "march.nodes=x"), 2, "march.nodes")
        self.check_refusal(self.plain(film, "--fps", "0"), 2, "--fps")
        self.check_refusal(self.plain(film, "--color"), 2, "--color")
        self.check_refusal(self.plain(), 2, "SCENE")
        self.check_refusal(self.plain(film, "--script", "missing.txt"), 4, "missing.txt")
        self.check_refusal(self.plain(film, "--script", self.write("s.txt", "jump")), 3, "s.txt:1", "jump")

    def test_tyndall_view_starts_it(self):
        self.assertIn("screenshot FILE", run("view", "--help").stdout)
        self.check_refusal(run("view", "missing.json", "--res", "64x36"), 4, "missing.json")
        self.check_refusal(run("view", "missing.json", "--res", "64"), 2, "--res")
        self.assertIn("view", run("--help").stdout)


class Chance(ViewerTest):
    def test_actions_by_chance_end_well(self):
        code, said, _ = random_actions.run(TYNDALL, 20 if SANITIZED else 8, 1, self.directory)
        self.assertEqual(code, 0, said)
        self.assertIn("pictures: first after", said)


if __name__ == "__main__":
    unittest.main()
