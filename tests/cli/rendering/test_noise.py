"""Noise: variances, halves, full floats, and pictures rendered to an error that was asked for."""
import json
import unittest

from cli.program import ProgramTest, lit_scene, recipe, run, scene


class Layers(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("scene.json", lit_scene(resolution=[16, 9]))
        self.output = self.path("out.exr")

    def render(self, *more, **options):
        return self.succeed("render", self.scene, "-o", self.output, *more, **options)

    def report(self):
        """Channels by name, and attributes, of the picture."""
        report = self.info(self.output)
        return {channel["name"]: channel for channel in report["channels"]}, report["attributes"]

    def test_variance_and_halves_are_layers(self):
        stats = self.path("stats.json")
        result = self.render("--aov", "variance,halves", "--samples", "70", "--stats-json", stats)
        notes = [line for line in result.stderr.splitlines() if "note:" in line]
        self.assertEqual(len(notes), 1, result.stderr)
        self.assertIn("128 camera rays per pixel instead of 70", notes[0])
        channels, attributes = self.report()
        for layer in ("Variance", "half_a", "half_b"):
            for component in "RGB":
                self.assertIn(f"{layer}.{component}", channels)
        for c in "RGB":
            self.assertGreater(channels[f"Variance.{c}"]["maximum"], 0)
            halves = (channels[f"half_a.{c}"]["mean"] + channels[f"half_b.{c}"]["mean"]) / 2
            self.assertAlmostEqual(halves, channels[c]["mean"], delta=2**-11 * halves)  # colors are halves
        self.assertEqual(attributes["tyndall:samples"], "128")
        frame = json.loads(stats.read_text())["frames"][0]
        self.assertEqual(frame["samples"], 128)
        self.assertAlmostEqual(frame["achieved_error"], float(attributes["tyndall:achievedError"]), delta=1e-8)
        self.assertGreater(frame["error_bound"], frame["achieved_error"])
        self.assertIn("Variance.R", self.succeed("info", self.output).stdout)

    def test_nothing_is_said_where_nothing_changed(self):
        self.assertNotIn("note:", self.render("--aov", "variance", "--samples", "128").stderr)
        self.assertNotIn("note:", self.render("--samples", "3").stderr)
        self.assertNotIn("tyndall:samples", self.report()[1])
        self.assertEqual(self.render("--aov", "variance", "-q").stderr, "")

    def test_path_takes_more_samples_by_itself(self):
        self.render("--mode", "path", "--quality", "draft", "--aov", "none")
        self.assertIn("pixel.samples=16", self.report()[1]["tyndall:settings"])
        self.render("--mode", "path", "--quality", "draft", "--aov", "none", "--samples", "2")
        self.assertIn("pixel.samples=2", self.report()[1]["tyndall:settings"])

    def test_settings_of_another_mode_are_said_to_be_idle(self):
        self.assertIn("path.orders=3 has no effect", self.render("--set", "path.orders=3", "--samples", "1").stderr)
        self.assertIn("terms.light=off has no effect",
                      self.render("--mode", "path", "--samples", "1", "--set", "terms.light=off").stderr)
        self.assertNotIn("has no effect", self.render("--set", "terms.light=off", "--samples", "1").stderr)

    def test_full_floats(self):
        self.render("--aov", "none", "--samples", "1")
        half = self.report()[0]["R"]["maximum"]
        self.render("--aov", "none", "--samples", "1", "--float")
        full = self.report()[0]["R"]["maximum"]
        self.assertNotEqual(full, half)
        self.assertAlmostEqual(full, half, delta=2**-11 * full)
        again = self.render("--aov", "none", "--samples", "1", "--resume", "--json")
        self.assertFalse(json.loads(again.stdout)["frames"][0]["kept"], "halves are no full floats")
        again = self.render("--aov", "none", "--samples", "1", "--float", "--resume", "--json")
        self.assertFalse(json.loads(again.stdout)["frames"][0]["kept"])
        again = self.render("--aov", "none", "--samples", "1", "--float", "--resume", "--json")
        self.assertTrue(json.loads(again.stdout)["frames"][0]["kept"])

    def test_march_scatters_light_once_when_asked_or_not(self):
        self.render()
        before = self.output.read_bytes()
        self.render("--orders", "1")
        self.assertEqual(self.output.read_bytes(), before)


class Target(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("scene.json", lit_scene(resolution=[16, 9]))
        self.output = self.path("out.exr")

    def render(self, *more):
        return run("render", self.scene, "-o", self.output, "--mode", "path", "--json", *more)

    def test_it_is_reached(self):
        result = self.render("--target-error", "0.05", "--orders", "2")
        self.assertEqual(result.returncode, 0, result.stderr)
        report, attributes = json.loads(result.stdout), self.attributes(self.output)
        self.assertEqual(attributes["tyndall:targetError"], "0.05")
        self.assertLessEqual(float(attributes["tyndall:errorBound"]), 0.05)
        self.assertEqual(int(attributes["tyndall:samples"]), report["frames"][0]["samples"])
        self.assertEqual(report["missed"], 0)
        self.assertIn("target 0.05", result.stderr)
        self.assertIn("path.orders=2", attributes["tyndall:settings"])

    def test_a_miss_writes_the_picture_and_exits_with_1(self):
        result = self.render("--target-error", "1e-5", "--res", "2x1", "--orders", "1")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("larger than 1e-05", result.stderr)
        self.assertEqual(self.attributes(self.output)["tyndall:samples"], "65536")
        self.assertEqual(json.loads(result.stdout)["missed"], 1)


class Orders(ProgramTest):
    """Multiple scattering from a grid says how far off path tracing it is, and that counts in an error asked for."""
    def setUp(self):
        super().setUp()
        thick = {"type": "homogeneous", "extinction": 3, "bounds": {"low": [-1, 0, -1], "high": [1, 1, 1]}}
        # Ambient light is not shadowed by the fog: too much of it in its middle.
        self.scene = self.write("scene.json", lit_scene(resolution=[32, 18], media=[thick], ambient=[1, 1, 1]))
        self.output = self.path("out.exr")

    def render(self, *more):
        return run("render", self.scene, "-o", self.output, "--orders", "all", "--json", *more)

    def test_a_limitation_has_the_amount(self):
        for mode in ["march", "froxel"]:
            result = self.render("--mode", mode, "--quality", "draft")
            self.assertEqual(result.returncode, 0, result.stderr)
            found = [one for one in json.loads(result.stdout)["limitations"] if one["id"] == "approximate_orders"]
            self.assertEqual(len(found), 1)
            amount, mean = found[0]["amounts"]
            self.assertGreater(amount, 0)
            self.assertGreaterEqual(amount, abs(mean) - 0.5)
            self.assertEqual(found[0]["severity"] != "info", "against path tracing" in result.stderr)
        result = self.render("--mode", "path", "--samples", "1")
        self.assertNotIn("approximate_orders", result.stdout)

    def test_it_counts_in_the_error(self):
        result = self.render("--mode", "march", "--target-error", "2")
        self.assertEqual(result.returncode, 0, result.stderr)
        frame, attributes = json.loads(result.stdout)["frames"][0], self.attributes(self.output)
        parts = [frame[name] for name in ("noise_bound", "integrator_bound", "orders_bound")]
        self.assertGreater(parts[2], 0)
        self.assertAlmostEqual(frame["error_bound"], sum(part**2 for part in parts) ** 0.5, places=6)
        self.assertAlmostEqual(float(attributes["tyndall:ordersBound"]), parts[2], places=6)
        kept = json.loads(self.render("--mode", "march", "--target-error", "2", "--resume").stdout)["frames"][0]
        self.assertTrue(kept["kept"])
        self.assertAlmostEqual(kept["error_bound"], frame["error_bound"], places=6)

    def test_a_grid_that_is_too_far_off_misses_and_auto_takes_path(self):
        error = json.loads(self.render("--mode", "march", "--target-error", "0.3").stdout)["frames"][0]["orders_error"]
        out_of_reach = f"{0.5 * error:.6f}"
        result = self.render("--mode", "march", "--target-error", out_of_reach)
        self.assertEqual(result.returncode, 1, result.stderr)
        result = self.render("--mode", "auto", "--target-error", out_of_reach)
        self.assertEqual(json.loads(result.stdout)["mode"], "path", result.stderr)
        self.assertEqual(result.returncode, 0, result.stderr)


class MarchTarget(ProgramTest):
    """Goals of march: an error measured against exact single scattering, a time, or both."""
    def setUp(self):
        super().setUp()
        fog = {"type": "noise", "recipe": self.write("fog.json", recipe()).name, "extinction": 2}
        self.scene = self.write("scene.json", scene(frames="1-2", resolution=[48, 27], media=[fog]))
        self.output = self.path("out.####.exr")

    def render(self, *more, code=0):
        result = run("render", self.scene, "-o", self.output, "--frames", "1", "--json", *more)
        self.assertEqual(result.returncode, code, result.stderr)
        attributes = self.attributes("out.0001.exr")
        return json.loads(result.stdout), attributes, result.stderr

    def test_the_error_is_measured_reached_and_reported(self):
        report, attributes, said = self.render("--target-error", "0.05")
        frame = report["frames"][0]
        self.assertEqual(report["missed"], 0)
        self.assertLessEqual(frame["error_bound"], 0.05)
        self.assertAlmostEqual(frame["error_bound"] ** 2, frame["noise_bound"] ** 2 + frame["integrator_bound"] ** 2,
                               delta=1e-8)
        self.assertLessEqual(frame["integrator_bound"], 0.035)
        for key, name in [("error_bound", "errorBound"), ("achieved_error", "achievedError"),
                          ("integrator_error", "integratorError"), ("noise_error", "noiseError")]:
            self.assertAlmostEqual(float(attributes["tyndall:" + name]), frame[key], delta=1e-8)
        self.assertEqual(attributes["tyndall:candidate"], frame["candidate"])
        self.assertEqual(attributes["tyndall:targetError"], "0.05")
        self.assertIn("target 0.05", said)
        self.assertIn(f"({frame['candidate']})", said)

        truth = self.path("truth.exr")
        self.succeed("render", self.scene, "-o", truth, "--frames", "1", "--quality", "reference")
        compared = json.loads(self.succeed("compare", "--json", self.path("out.0001.exr"), truth).stdout)
        self.assertLessEqual(compared["metrics"]["rmse_rel"], 0.05)

    def test_the_picture_can_be_made_again_from_its_settings(self):
        _, attributes, _ = self.render("--target-error", "0.1")
        words = [("--set", row) for row in attributes["tyndall:settings"].split() if row.startswith("march.")]
        again, _, _ = self.render("--target-error", "0.1", *[word for pair in words for word in pair])
        self.assertLessEqual(again["frames"][0]["error_bound"], 0.1)

    def test_resume_keeps_what_is_reached_or_was_given_its_time(self):
        for goal in [("--target-error", "0.1"), ("--time-budget", "2")]:
            first = self.render(*goal, "--resume")[0]["frames"][0]
            second = self.render(*goal, "--resume")[0]["frames"][0]
            self.assertFalse(first["kept"], goal)
            self.assertTrue(second["kept"], goal)
            for key in ["samples", "candidate"]:
                self.assertEqual(second[key], first[key])
            for key in ["error_bound", "integrator_bound", "noise_error"]:
                self.assertAlmostEqual(second[key], first[key], delta=1e-8 + 1e-6 * first[key])
        self.assertAlmostEqual(second["goal_seconds"], first["goal_seconds"], delta=1e-6)
        self.assertFalse(self.render("--time-budget", "2.5", "--resume")[0]["frames"][0]["kept"])

    def test_a_time_is_reported_beside_what_it_was_worth(self):
        report, attributes, said = self.render("--time-budget", "2")
        frame = report["frames"][0]
        self.assertEqual(report["time_budget"], 2)
        self.assertGreaterEqual(frame["samples"], 1)
        self.assertGreater(frame["goal_seconds"], 0)
        self.assertGreater(frame["error_bound"], 0)
        self.assertEqual(attributes["tyndall:timeBudget"], "2")
        self.assertAlmostEqual(float(attributes["tyndall:timeUsed"]), frame["goal_seconds"], delta=1e-6)
        self.assertIn("of 2 s", said)

    def test_a_row_that_is_set_too_coarse_is_a_miss(self):
        report, attributes, said = self.render("--target-error", "0.02", "--set", "terms.light=off", code=1)
        self.assertEqual(report["missed"], 1)
        self.assertGreater(report["frames"][0]["integrator_error"], 0.02)
        self.assertIn("may be larger than 0.02", said)
        self.assertIn("terms.light=off", attributes["tyndall:settings"])


if __name__ == "__main__":
    unittest.main()
