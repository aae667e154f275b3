"""verify: a scene's invariances as a table and as JSON, and what it refuses."""
import json
import unittest

from cli.program import ProgramTest, SOURCE, scene


class Verify(ProgramTest):
    def setUp(self):
        super().setUp()
        fog = {"type": "homogeneous", "extinction": 0.3, "bounds": {"low": [-2, -1, -2], "high": [2, 2, 2]}}
        self.scene = self.write("scene.json", scene(frames="3-4", media=[fog]))
        self.small = ["--res", "48x32", "--samples", "64"]

    def test_a_scene_holds(self):
        result = self.succeed("verify", self.scene, *self.small)
        for topic in ("same bits", "units of length", "lights add up", "white furnace", "two methods"):
            self.assertIn(topic, result.stdout)
        self.assertIn("all hold", result.stderr)
        self.assertNotIn("FAIL", result.stdout)

    def test_a_scene_with_area_lights_holds(self):
        content = json.loads(self.scene.read_text())
        content["lights"] = [{"name": "panel", "type": "rectangle", "position": [0, 1.5, 0], "target": [0, 0, 0], "width": 0.6,
                              "height": 0.4, "intensity": 50}]
        result = self.succeed("verify", self.write("panel.json", content), *self.small)
        self.assertIn("units of length", result.stdout)

    def test_json_holds_every_figure(self):
        report = json.loads(self.succeed("verify", self.scene, *self.small, "--json", "-q").stdout)
        self.assertEqual(report["off"], 0)
        self.assertGreaterEqual(len(report["checks"]), 5)
        for check in report["checks"]:
            self.assertTrue(check["holds"], check)
            self.assertLessEqual(abs(check["measured"] - check["expected"]), check["tolerance"])

    def test_fog_without_bounds_has_no_furnace(self):
        result = self.succeed("verify", self.write("endless.json", scene(media=[{"type": "homogeneous", "extinction": 0.1}])),
                              *self.small)
        self.assertNotIn("white furnace", result.stdout)
        self.assertIn("two methods", result.stdout)

    def test_an_environment_is_a_light_and_leaves_the_furnace(self):
        sky = {"type": "environment", "sky": {"zenith": [1, 2, 5], "horizon": [4, 3, 2]}, "visible": False}
        content = json.loads(self.scene.read_text())
        content["lights"].append(sky)
        result = self.succeed("verify", self.write("sky.json", content), *self.small)
        self.assertNotIn("FAIL", result.stdout)

    def test_example_scene_with_surfaces(self):
        self.succeed("verify", SOURCE / "scenes/window.json", "--res", "32x18", "--samples", "64", "--frame", "5")

    def test_refusals(self):
        self.refuse(2, ["--res"], "verify", "--res", "10x10")
        self.refuse(2, ["--samples"], "verify", self.scene, "--samples", "0")
        self.refuse(2, ["--frame"], "verify", self.scene, "--frame", "x")
        self.refuse(4, ["missing.json"], "verify", "missing.json")
        self.refuse(3, ["empty.json", "no fog"], "verify", self.write("empty.json", scene(media=[])))


if __name__ == "__main__":
    unittest.main()
