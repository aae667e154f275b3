"""A technique that the tests add to the table (tests/added) is found wherever the others are."""
import json
import os
import pathlib
import sys
import unittest

from cli import program
from cli.program import SOURCE, ProgramTest, scene
from cli.viewer import viewer
from cli.viewer.viewer import ViewerTest, read_png

sys.path.append(str(SOURCE / "docs"))
import make_reference

WITH_MIST = os.environ.get("TYNDALL_WITH_MIST", str(pathlib.Path(program.TYNDALL).parent / "tests/tyndall_with_mist"))


class Added(ProgramTest):
    def setUp(self):
        super().setUp()
        fog = {"type": "homogeneous", "extinction": 0.1, "bounds": {"low": [-2, -1, -2], "high": [2, 2, 2]}}
        self.scene = self.write("scene.json", scene(media=[fog]))
        usual, program.TYNDALL = program.TYNDALL, WITH_MIST
        self.addCleanup(setattr, program, "TYNDALL", usual)

    def test_the_table_and_its_settings_are_listed(self):
        told = self.succeed("modes").stdout
        self.assertRegex(told, r"mist +homogeneous fog +fog of one brightness")
        rows = {row["name"]: row for row in json.loads(self.succeed("modes", "--json").stdout)["settings"]}
        self.assertEqual(rows["mist.brightness"]["values"]["draft"], "0.5")
        self.refuse(2, ["mist"], "render", self.scene, "-o", self.path("a.exr"), "--mode", "fogg")

    def test_it_renders_with_its_settings_and_beside_all_others(self):
        said = self.succeed("render", self.scene, "-o", self.path("a.exr"), "--mode", "mist", "--frames", 1,
                            "--set", "mist.brightness=3").stderr
        self.assertIn("no light is looked at", said)
        self.assertIn("mist.brightness=3", self.attributes("a.exr")["tyndall:settings"])
        self.succeed("render", self.scene, "-o", self.path("b.exr"), "--mode", "all", "--frames", 1, "--quality", "draft")
        self.assertTrue(self.path("b.mist.exr").exists())

    def test_charts_plans_and_explanations_know_it(self):
        self.succeed("chart", self.scene, "-o", self.path("chart"), "--modes", "march,mist", "--quick", "--res", "32x18",
                     timeout=120)
        chart = json.loads(self.path("chart/chart.json").read_text())
        self.assertEqual([mode["name"] for mode in chart["modes"]], ["march", "mist"])
        self.assertTrue("#888888" in self.path("chart/chart.html").read_text())
        self.assertIn("mist", self.succeed("plan", self.scene, "--target-error", "0.05").stdout)
        self.assertIn("mist", self.succeed("explain", self.scene, "--pixel", "10,10").stdout)

    def test_the_stability_suite_holds_it_to_what_its_row_claims(self):
        told = self.succeed("stress", "--modes", "mist", "--list").stdout
        self.assertIn("thin-fog", told)
        self.assertNotIn("lamp-in-froxel", told)

    def test_references_list_it(self):
        pages = {path.name: text for path, text in make_reference.pages(WITH_MIST).items()}
        self.assertIn("mist", pages["modes.md"])
        self.assertIn("mist.brightness", pages["settings.md"])
        self.assertIn("| `mist` | fog of one brightness |", pages["README.md"])


class Viewed(ViewerTest):
    def test_the_viewer_draws_it_with_its_settings(self):
        usual, viewer.VIEWER = viewer.VIEWER, pathlib.Path(WITH_MIST).parent / "tyndall-view_with_mist"
        self.addCleanup(setattr, viewer, "VIEWER", usual)
        fog = {"type": "homogeneous", "extinction": 0.5, "bounds": {"low": [-2, -1, -2], "high": [2, 2, 2]}}
        film, shots = self.write("scene.json", scene(media=[fog])), []
        for brightness in (0.1, 3):
            shots.append(self.path(f"{brightness}.png"))
            self.view(film, ["mode mist", f"set mist.brightness {brightness}", "wait idle", f"screenshot {shots[-1]}"],
                      "--samples", "1", "--res", "64x40")
        dim, bright = (sum(map(sum, read_png(shot)[2])) for shot in shots)
        self.assertGreater(bright, dim)


if __name__ == "__main__":
    unittest.main()
