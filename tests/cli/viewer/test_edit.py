"""Editing a scene in the viewer: by scripts, keys and mouse; what is saved is what was seen."""
import math
import re
import time
import unittest

from cli.exr import without_name
from cli.program import SOURCE, gltf
from cli.viewer.viewer import ViewerTest

FILM = """{
  // lit by hand
  "tyndall": 1, "gltf": "triangle.gltf", "frames": "1-8", "resolution": [64, 36], "exposure": 0,
  "camera": { "position": [0, 0.6, 3], "target": [0, 0.4, 0] },
  "lights": [
    { "name": "sun", "type": "sun", "direction": [-0.6, -0.7, -0.3], "intensity": 10.50 }, /* low */
    { "name": "lamp", "type": "point", "position": [0, 0.5, 1.0], "intensity": 2 }
  ],
  "media": [ { "name": "fog", "type": "homogeneous", "extinction": 0.1,
               "bounds": { "low": [-2, -1, -2], "high": [2, 2, 2] } } ],
  "background": { "color": [0.10, 0.20, 0.30] }
}
"""
SLIDERS, VALUES = range(312, 642, 15), (1120, 1230)  # pixels of the window
# The picture is as wide as the space left of the panel; the lamp stands a little above its middle.
LAMP = (467, 366)


class Editing(ViewerTest):
    def setUp(self):
        super().setUp()
        self.write_triangle()
        self.film = self.write("film.json", FILM)

    def text(self):
        return self.film.read_text()

    def pictures(self, *names):
        return [self.path(name).read_bytes() for name in names]

    def rendered(self, film=None):
        """The PNG that render makes of a scene."""
        self.succeed("render", film or self.film, "-o", self.path("r.exr"), "-q", "--png", "--frames", 1)
        return self.path("r.png").read_bytes()

    def test_what_is_saved_is_what_was_seen_and_nothing_else_changes(self):
        before = self.rendered()
        self.view(self.film, ["edit lights/sun/intensity 33.25", "edit media/fog/albedo 0.5,0.6,0.7", "undo", "wait idle",
                              f"snapshot {self.path('a.png')}", f"snapshot {self.path('a.exr')}", "save",
                              f"snapshot {self.path('b.exr')}", f"open {self.film}", "wait idle",
                              f"snapshot {self.path('c.png')}", f"snapshot {self.path('c.exr')}"], "--samples", 2)
        self.assertEqual(self.text(), FILM.replace("10.50", "33.25"))
        seen, again = self.pictures("a.png", "c.png")
        self.assertTrue(seen == again)
        self.assertTrue(seen == self.rendered())
        self.assertTrue(seen != before)
        self.assertTrue(without_name(self.path("b.exr").read_bytes()) == without_name(self.path("c.exr").read_bytes()))
        self.assertIn("lights/sun/intensity = 33.25", str(self.attributes("a.exr")))  # no file had it then
        self.assertNotIn("unsavedEdits", str(self.attributes("b.exr")))

    def test_another_file_is_written_and_gone_on_with(self):
        other = self.path("deep/other.json")
        other.parent.mkdir()
        self.view(self.film, ["edit exposure 1", f"save-as {other}", "edit lights/1/position \"0.5 0.5 1\"", "save",
                              f"snapshot {self.path('a.png')}"], "--samples", 2)
        self.assertEqual(self.text(), FILM)
        self.assertTrue(self.path("a.png").read_bytes() == self.rendered(other))

    def test_keys_undo_redo_and_save(self):
        self.view(self.film, ["wait idle", "edit ambient 0.25", "edit ambient 0.5", "key ctrl+z", "key ctrl+z",
                              "key ctrl+y", "key ctrl+s", "key ctrl+shift+z"], "--samples", 1)
        self.assertIn('"ambient": 0.25', self.text())

    def test_sliders_and_colors_of_the_page_change_the_scene(self):
        drags = [f"drag {VALUES[0]},{y} {VALUES[1]},{y}" for y in SLIDERS]
        self.view(self.film, ["wait idle", "tab lights", "select lights/lamp", *drags, "save"], "--samples", 1)
        lamp = self.text().split("\n")[6]
        self.assertNotEqual(lamp, FILM.split("\n")[6])
        self.assertIn('"volume_scale"', lamp)
        self.assertEqual(self.text().replace(lamp, ""), FILM.replace(FILM.split("\n")[6], ""))

    def test_lights_are_moved_in_the_picture_and_a_drag_is_one_step(self):
        drag = "drag {0},{1} {2},{3}".format(*LAMP, LAMP[0] + 133, LAMP[1] - 60)
        begin = ["wait idle", "tab lights", "wait 0.1", drag]
        self.view(self.film, [*begin, f"snapshot {self.path('a.png')}", "save"], "--samples", 1)
        x, y, z = map(float, re.search(r'"lamp".*"position": \[([^]]*)\]', self.text()).group(1).split(","))
        self.assertEqual(self.text(), FILM.replace("[0, 0.5, 1.0]", f"[{x}, {y}, {z}]"), "the camera stood still")
        scale = 2 * math.hypot(2, 0.1) * math.tan(math.radians(22.5)) / 526  # meters a pixel, about
        self.assertAlmostEqual(x, 133 * scale, delta=0.03)
        self.assertAlmostEqual(y, 0.5 + 60 * scale, delta=0.03)
        self.assertTrue(self.path("a.png").read_bytes() == self.rendered())
        self.write("film.json", FILM)
        self.view(self.film, [*begin, "undo", "edit exposure 0.5", "save"], "--samples", 1)
        self.assertIn("[0, 0.5, 1.0]", self.text())

    def test_with_the_lights_hidden_the_mouse_turns_the_camera(self):
        self.view(self.film, ["wait idle", "tab lights", "select lights/lamp", "key g",
                              "drag {0},{1} {2},{3}".format(*LAMP, LAMP[0] + 133, LAMP[1] - 60), "edit exposure 1",
                              "save"], "--samples", 1)
        self.assertIn("[0, 0.5, 1.0]", self.text())

    def test_the_window_asks_before_edits_are_lost(self):
        self.view(self.film, ["wait idle", "edit ambient 0.25", "close", "wait 0.2", "drag 640,427 640,427", "wait 9",
                              "select lights/moon"], "--samples", 1)
        self.assertEqual(self.text(), FILM, "discarded")
        self.view(self.film, ["edit ambient 0.25", "close", "answer cancel", "edit ambient 0.5", "close", "wait 0.2",
                              "drag 535,427 535,427", "wait 9", "select lights/moon"], "--samples", 1)
        self.assertIn('"ambient": 0.5', self.text())

    def test_edits_stay_when_the_file_is_changed_by_others(self):
        theirs = FILM.replace("0.10, 0.20", "0.5, 0.20").replace('"name": "fog"', '"name": "mist"')

        def change():
            self.write("film.json", "{ broken")
            time.sleep(1)
            self.write("film.json", theirs)
        self.view(self.film, ["edit lights/sun/intensity 33.25", "edit media/fog/extinction 0.3",
                              f"snapshot {self.path('a.png')}", "wait 4", f"snapshot {self.path('b.png')}",
                              f"screenshot {self.path('s.png')}", "save"], "--samples", 2,
                  once=(self.path("a.png"), change))
        self.assertEqual(self.text(), theirs.replace("10.50", "33.25"))  # the fog is not there any more
        self.assertTrue(self.path("b.png").read_bytes() == self.rendered())

    def test_mistakes_end_scripts(self):
        for line, code, word in (("edit lights/moon/intensity 3", 2, "available: sun, lamp"),
                                 ("edit lights/sun/intensity -3", 3, "lights/sun/intensity"),
                                 ("edit lights/sun/color \"1 2\"", 2, "three numbers"),
                                 ("select fog", 2, "media/NAME"), ("tab fog", 2, "lights"),
                                 ("answer save", 2, "there is no open question"), ("key ctrl+", 2, "no key"),
                                 (f"save-as {self.film}/a.json", 5, "a.json")):
            told = self.view(self.film, ["wait idle", line], "--samples", 1, code=code)
            self.assertIn("script.txt:2", told)
            self.assertIn(word, told)

    def test_a_bare_model_gets_a_scene_file(self):
        self.film = self.write("model.gltf", gltf())
        made = self.path("model.json")
        self.view(self.film, ["edit exposure 0.5", f"save-as {made}", f"snapshot {self.path('a.png')}"], "--samples", 1)
        self.assertTrue(self.path("a.png").read_bytes() == self.rendered(made))


class Times(ViewerTest):
    def test_dragging_a_light_keeps_the_interface_awake(self):
        lines = ["wait samples 1"]
        for i in range(40):
            lines += [f'edit lights/sun/direction "0.78 -0.42 {0.15 + 0.01 * i:.2f}" 3', "wait 0.02"]
        told = self.view(SOURCE / "scenes/window.json", lines, "--res", "320x180")
        self.assertRegex(told, r"\d+ while things moved")


if __name__ == "__main__":
    unittest.main()
