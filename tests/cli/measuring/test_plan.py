"""Plans, and frames rendered as planned."""
import json
import unittest

from cli.program import ProgramTest, scene


def hazy(**changes):
    """A spot above the picture in a box of homogeneous fog: nothing casts shadows."""
    box = {"low": [-2, -1, -2], "high": [2, 2, 2]}
    spot = {"name": "spot", "type": "spot", "position": [-1, 4, 0], "target": [0.5, 0, 0], "intensity": 100,
            "inner_cone": 8, "outer_cone": 15}
    return scene(lights=[spot], media=[{"name": "haze", "type": "homogeneous", "extinction": 0.2, "bounds": box}], **changes)


class Plan(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("scene.json", hazy())
        self.output = self.path("out.####.exr")

    def test_says_what_is_needed_and_who_wins(self):
        text = self.succeed("plan", self.scene, "--progress", "none").stdout
        self.assertIn("error at most 0.05 of the mean", text)
        self.assertIn("shadows of spot", text)
        self.assertIn("nothing in the scene could cast them", text)
        self.assertIn("artistic: no error bound", text)
        self.assertIn("tyndall render", text.splitlines()[-1])

    def test_an_environment_is_ambient_light(self):
        def ambient(lights):
            path = self.write("sky.json", {**hazy(), "lights": hazy()["lights"] + lights})
            terms = json.loads(self.succeed("plan", path, "--json").stdout)["terms"]
            return next(term for term in terms if term["name"] == "ambient light in fog")
        self.assertEqual(ambient([])["bound"], 0)
        self.assertTrue(ambient([{"type": "environment", "color": 5}])["needed"])

    def test_json_holds_terms_and_modes(self):
        plan = json.loads(self.succeed("plan", self.scene, "--target-error", "0.02", "--json").stdout)
        self.assertEqual(plan["target_error"], 0.02)
        terms = {term["name"]: term for term in plan["terms"]}
        self.assertTrue(terms["shadows"]["rigorous"])
        self.assertFalse(terms["shadows"]["needed"])
        self.assertEqual(terms["emission"]["bound"], 0)
        modes = {mode["mode"]: mode for mode in plan["modes"]}
        winner = modes[plan["mode"]]
        self.assertEqual(plan["modes"][0], winner)
        self.assertTrue(winner["gets_there"])
        self.assertLessEqual(winner["error"], 0.02)
        for name, mode in modes.items():
            if name != plan["mode"]:
                self.assertTrue(mode["why"], name)
            if name != plan["mode"] and mode.get("gets_there"):
                self.assertGreaterEqual(mode["seconds"], winner["seconds"], name)

    def test_the_last_line_of_a_plan_renders(self):
        line = self.succeed("plan", self.scene, "--progress", "none").stdout.splitlines()[-1]
        words = line.split()[1:]
        words[words.index("out.####.exr")] = str(self.output)
        self.succeed(*words, "--frames", "1")
        self.assertLessEqual(float(self.attributes("out.0001.exr")["tyndall:achievedError"]), 0.05)

    def test_the_frame_that_was_planned_is_the_one_to_render(self):
        line = self.succeed("plan", self.scene, "--frame", "3", "--progress", "none").stdout.splitlines()[-1]
        self.assertIn(" --frames 3", line)

    def test_a_scene_without_fog_needs_no_plan(self):
        self.refuse(3, ["empty.json", "has no fog to plan for"], "plan", self.write("empty.json", scene(media=[])))

    def test_a_budget_instead_of_an_error(self):
        plan = json.loads(self.succeed("plan", self.scene, "--time-budget", "0.5", "--json").stdout)
        self.assertEqual(plan["time_budget"], 0.5)
        self.assertLessEqual(plan["modes"][0]["seconds"], 0.5)

    def test_exit_code_one_when_no_mode_gets_there(self):
        self.refuse(1, ["no mode reaches the goal"], "plan", self.scene, "--target-error", "0.00001",
                    "--time-budget", "0.01", "-q")

    def test_auto_renders_as_planned_and_says_so_in_the_header(self):
        result = self.succeed("render", self.scene, "-o", self.output, "--mode", "auto", "--target-error", "0.03")
        self.assertIn("plan: ", result.stderr)
        for frame in (1, 2, 3):
            attributes = self.attributes(f"out.{frame:04d}.exr")
            self.assertLessEqual(float(attributes["tyndall:errorBound"]), 0.03)
            self.assertTrue(attributes["tyndall:plan"].startswith(attributes["tyndall:mode"]))
        self.assertEqual(len({self.attributes(f"out.{frame:04d}.exr")["tyndall:mode"] for frame in (1, 2, 3)}), 1)

    def test_resume_keeps_to_the_mode_of_the_frames_that_are_there(self):
        self.succeed("render", self.scene, "-o", self.output, "--mode", "auto", "--frames", "1")
        mode = self.attributes("out.0001.exr")["tyndall:mode"]
        result = self.succeed("render", self.scene, "-o", self.output, "--mode", "auto", "--resume")
        self.assertIn("1 kept", result.stderr)
        self.assertEqual(self.attributes("out.0003.exr")["tyndall:mode"], mode)

    def test_without_a_goal_quality_says_how_right(self):
        self.succeed("render", self.scene, "-o", self.output, "--mode", "auto", "--frames", "1", "--quality", "draft")
        self.assertEqual(float(self.attributes("out.0001.exr")["tyndall:targetError"]), 0.1)


if __name__ == "__main__":
    unittest.main()
