"""Several modes in one run, styles, and the history."""
import json
import pathlib
import unittest

from cli.program import ProgramTest, lit_scene, png_size, run


class Modes(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("scene.json", lit_scene())

    def modes(self):
        return [mode["name"] for mode in json.loads(self.succeed("modes", "--json").stdout)["modes"]]

    def test_all_modes_write_files_of_their_own_and_a_sheet(self):
        names = self.modes()
        self.assertGreaterEqual(len(names), 3)
        result = self.succeed("render", self.scene, "-o", self.path("out.####.exr"), "--mode", "all", "--frames", "1-2",
                              "--samples", "1", "--stats-json", self.path("stats.json"))
        for name in names:
            self.assertEqual(self.attributes(self.path(f"out.{name}.0002.exr"))["tyndall:mode"], name)
            self.assertEqual(json.loads(pathlib.Path(self.path(f"stats.{name}.json")).read_text())["mode"], name)
        self.assertIn("out.modes.0001.png", result.stderr)
        width, height = png_size(self.path("out.modes.0002.png"))
        self.assertGreater(width, 2 * 32)
        self.assertGreater(height, 18)

    def test_a_sheet_with_a_reference(self):
        modes = ["--mode", "march,radial-blur", "--samples", "1"]
        self.succeed("render", self.scene, "-o", self.path("truth.exr"), "--quality", "reference")
        self.succeed("render", self.scene, "-o", self.path("plain.exr"), *modes)
        self.succeed("render", self.scene, "-o", self.path("out.exr"), *modes, "--reference", self.path("truth.exr"))
        plain, sheet = png_size(self.path("plain.modes.png")), png_size(self.path("out.modes.png"))
        self.assertEqual(sheet[0], plain[0])
        self.assertGreater(sheet[1], 2 * plain[1])  # the reference begins a second row, and a line more is under each
        self.refuse(2, ["--reference", "several modes"], "render", self.scene, "-o", self.path("one.exr"),
                    "--reference", self.path("truth.exr"))
        self.refuse(4, ["gone.exr"], "render", self.scene, "-o", self.path("b.exr"), *modes, "--reference", self.path("gone.exr"))
        self.refuse(3, ["truth.exr", "pixels"], "render", self.scene, "-o", self.path("b.exr"), *modes, "--res", "16x9",
                    "--reference", self.path("truth.exr"))
        self.assertFalse(self.path("b.march.exr").exists(), "it is found out before the work")

    def test_two_modes_report_as_a_list(self):
        result = self.succeed("--json", "render", self.scene, "-o", self.path("out.exr"), "--mode", "march,radial-blur",
                              "--samples", "1")
        self.assertEqual([report["mode"] for report in json.loads(result.stdout)], ["march", "radial-blur"])
        for report in json.loads(result.stdout):
            self.assertGreaterEqual(report["totals"]["fog_seconds"], 0)
            self.assertLessEqual(report["totals"]["fog_seconds"],
                                 report["totals"]["prepare_seconds"] + report["totals"]["render_seconds"] + 0.1)

    def test_the_list_of_modes_is_a_line_each_and_one_mode_comes_with_its_settings(self):
        short = self.succeed("modes").stdout
        for name in self.modes():
            self.assertEqual(len([line for line in short.splitlines() if line.startswith(f"  {name} ")]), 1, short)
        self.assertLess(len(short.splitlines()), len(self.modes()) + 6)
        self.assertNotIn("pixel.samples", short)
        self.assertIn("froxel.tile", self.succeed("modes", "froxel").stdout)
        self.assertNotIn("froxel.tile", self.succeed("modes", "march").stdout)
        every = self.succeed("modes", "--settings").stdout
        self.assertTrue(every.startswith(short))
        for row in json.loads(self.succeed("modes", "--json").stdout)["settings"]:
            self.assertIn(f"\n  {row['name']} ", every)

    def test_lights_with_the_same_limitation_are_one_line_of_the_report(self):
        spots = [{"name": f"spot {i}", "type": "point", "position": [i, 2, 0], "radius": 0.3, "intensity": 5}
                 for i in range(12)]
        scene = self.write("spots.json", lit_scene(lights=spots))
        result = self.succeed("--json", "render", scene, "-o", self.path("out.exr"), "--mode", "cone", "--samples", "1")
        found = [one for one in json.loads(result.stdout)["limitations"] if one["id"] == "point_light_only"]
        self.assertEqual([one["where"] for one in found], ["12 lights (spot 0, spot 1, spot 2, ...)"])
        self.assertEqual(found[0]["names"], [spot["name"] for spot in spots])
        said = self.succeed("render", scene, "-o", self.path("out.exr"), "--mode", "cone", "--samples", "1", "-v").stderr
        self.assertEqual(said.count("12 lights (spot 0, spot 1, spot 2, ...): "), 1)
        self.assertNotIn("light spot", said)

    def test_bad_lists_are_refused(self):
        for names, why in (("march,march", "named twice"), ("march,rays", "no mode 'rays'"), ("", "empty")):
            result = run("render", self.scene, "-o", self.path("out.exr"), "--mode", names)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(why, result.stderr)

    def test_a_style_is_written_into_the_header(self):
        self.succeed("render", self.scene, "-o", self.path("plain.exr"), "--samples", "1")
        self.succeed("render", self.scene, "-o", self.path("styled.exr"), "--samples", "1", "--set", "style.light_depth=0.5")
        self.assertNotIn("stylized", self.attributes(self.path("plain.exr")))
        self.assertEqual(self.attributes(self.path("styled.exr"))["stylized"], "1")
        result = self.succeed("compare", self.path("styled.exr"), self.path("plain.exr"))
        self.assertIn("stylized", result.stdout + result.stderr)
        report = json.loads(self.succeed("--json", "compare", self.path("styled.exr"), self.path("plain.exr")).stdout)
        self.assertTrue(report["stylized"])

    def test_the_truth_has_no_style(self):
        result = self.succeed("render", self.scene, "-o", self.path("out.exr"), "--mode", "path", "--samples", "1",
                              "--set", "style.density=2")
        self.assertIn("style.density=2 has no effect", result.stderr)
        self.assertNotIn("stylized", self.attributes(self.path("out.exr")))

    def test_history_is_noted_where_it_changes_nothing(self):
        result = self.succeed("render", self.scene, "-o", self.path("out.exr"), "--samples", "1", "--history", "3")
        self.assertIn("march does not use earlier frames", result.stderr)
        result = run("render", self.scene, "-o", self.path("out.exr"), "--history", "-1")
        self.assertEqual(result.returncode, 2, result.stderr)

    def test_radial_blur_of_a_crop_is_part_of_the_whole(self):
        common = ["render", self.scene, "--mode", "radial-blur", "--samples", "1", "--aov", "Z,inscatter,validity,lights"]
        self.succeed(*common, "-o", self.path("whole.exr"))
        self.succeed(*common, "-o", self.path("crop.exr"), "--crop", "8,4,20,12")
        info = self.info("crop.exr")
        names = [channel["name"] for channel in info["channels"]]
        self.assertIn("validity.T", names)
        self.assertIn("light_sun.R", names)

    def test_noise_of_a_finished_picture_is_not_measured(self):
        result = run("render", self.scene, "-o", self.path("out.exr"), "--mode", "radial-blur", "--aov", "variance")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("radial-blur", result.stderr)


if __name__ == "__main__":
    unittest.main()
