"""The command line itself: help, names, hints, exit code 2, and output that cannot be written."""
import json
import subprocess
import unittest

from cli.program import TYNDALL, ProgramTest, recipe, run, scene

COMMANDS = ["bake", "render", "info", "check", "modes", "compare", "verify", "explain", "merge", "submit", "status"]
OPTIONS = {
    "bake": ["--output", "--frames", "--voxel-size", "--float", "--resume", "--compression"],
    "render": ["--output", "--frames", "--mode", "--quality", "--camera", "--res", "--crop", "--samples", "--set",
               "--exposure", "--view-transform", "--light-units", "--missing", "--aov", "--background", "--png", "--resume", "--seed", "--isa",
               "--stats-json", "--orders", "--target-error", "--time-budget", "--float"],
    "compare": ["--frames", "--fail-above", "--heatmap", "--map", "--ppd"],
    "merge": ["--parts", "--frames", "--wait", "--png", "--partial", "--remove-parts"],
    "submit": ["--frames", "--parts", "--chunk", "--cpus", "--memory", "--dry-run", "--run", "--target-error", "--aov"],
    "status": ["--verify", "--tasks"],
    "verify": ["--frame", "--camera", "--res", "--samples", "--seed"],
    "explain": ["--pixel", "--frame", "--camera", "--res", "--quality", "--set", "--modes", "--svg", "--csv"],
}


class Help(ProgramTest):
    def test_without_a_command_it_says_what_to_do_first(self):
        result = self.succeed()
        for word in ["tyndall bake", "tyndall render", "--help"]:
            self.assertIn(word, result.stdout)
        self.assertEqual(result.stderr, "")

    def test_general_help_lists_commands_and_exit_codes(self):
        result = self.succeed("--help")
        for word in COMMANDS + ["--threads", "--progress", "--json", "--quiet", "--verbose", "--version", "Exit codes"]:
            self.assertIn(word, result.stdout)

    def test_every_command_explains_itself_with_an_example(self):
        for command in COMMANDS:
            for arguments in [(command, "--help"), (command, "-h")]:
                result = self.succeed(*arguments)
                self.assertIn("Example", result.stdout)
                self.assertEqual(result.stderr, "")
                for option in OPTIONS.get(command, []):
                    self.assertIn(option, result.stdout)
                self.assertLessEqual(max(map(len, result.stdout.splitlines())), 120, command)

    def test_help_is_a_command_too(self):
        self.assertEqual(self.succeed("help").stdout, self.succeed("--help").stdout)
        for command in COMMANDS:
            self.assertEqual(self.succeed("help", command).stdout, self.succeed(command, "--help").stdout)

    def test_help_says_what_the_program_does(self):
        self.assertRegex(self.succeed("--help").stdout, r"--quiet .*no progress unless\n +--progress is given")
        self.assertIn(".ies", self.succeed("check", "--help").stdout)

    def test_help_names_nothing_of_the_code(self):
        for command in [*COMMANDS, "plan", "stress", "chart", "view"]:
            self.assertNotRegex(self.succeed(command, "--help").stdout, r"\b[A-Z][a-z]+[A-Z][a-z]", command)

    def test_version(self):
        self.assertRegex(self.succeed("--version").stdout, r"^tyndall \d+\.\d+\.\d+\n$")


class CommandLine(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("scene.json", scene())
        self.output = self.path("out.####.exr")

    def render(self, *more):
        return ("render", self.scene, "-o", self.output, *more)

    def test_mistyped_names_get_a_hint(self):
        self.refuse(2, ["rneder", "did you mean render"], "rneder", self.scene)
        self.refuse(2, ["--framse", "did you mean --frames"], *self.render("--framse", "1-3"))
        self.refuse(2, ["--thraeds", "did you mean --threads"], "modes", "--thraeds", "2")

    def test_unknown_names_get_those_like_them(self):
        for option, value, meant in [
                ("--mode", "marhc", "march"), ("--set", "march.step_dpeth=1", "march.step_depth"),
                ("--set", "light_pionts=8", "terms.light_points"), ("--set", "pixel.jitter=bleu", "blue"),
                ("--set", "terms.light=gird", "grid"), ("--quality", "fianl", "final"), ("--camera", "camrea", "camera"),
                ("--aov", "transmitance", "transmittance"), ("--aov", "Z,validty", "validity"),
                ("--light-units", "untiless", "unitless"), ("--missing", "hodl", "hold"), ("--isa", "avx52", "avx2 or avx512"),
                ("--progress", "jsn", "json")]:
            with self.subTest(option=option, value=value):
                self.refuse(2, [value.split("=")[0].split(",")[-1], f"did you mean {meant}?"], *self.render(option, value))
        self.refuse(2, ["did you mean froxel?"], "modes", "forxel")
        self.refuse(2, ["did you mean cone?"], "chart", self.scene, "-o", self.path("out"), "--modes", "march,coen")
        self.refuse(2, ["did you mean cone?"], "stress", "-o", self.path("out"), "--modes", "march,coen")
        self.refuse(2, ["did you mean cone?"], "explain", self.scene, "--pixel", "3,3", "--modes", "coen")
        self.refuse(2, ["did you mean zip?"], "bake", self.write("r.json", recipe()), "-o", self.path("fog.####.vdb"),
                    "--compression", "zpi")
        self.succeed(*self.render("--quality", "draft"))
        picture = self.path("out.0001.exr")
        self.refuse(2, ["did you mean flip?"], "compare", picture, picture, "--fail-above", "flop=1")
        self.refuse(2, ["did you mean error?"], "compare", picture, picture, "--heatmap", self.path("h.png"), "--map", "eror")

    def test_unknown_names_without_one_like_them_get_the_list(self):
        self.refuse(2, ["available: march, froxel"], *self.render("--mode", "rasterize"))
        self.refuse(2, ["available: camera"], *self.render("--camera", "nobody"))
        self.refuse(2, ["available: box, tent"], *self.render("--set", "pixel.filter=sharp"))
        self.refuse(2, ["tyndall modes --settings"], *self.render("--set", "zzzzzz=1"))

    def test_unknown_names_in_scenes_get_those_like_them(self):
        card = {"light": "snu", "from": [0, 0, 0], "to": [0, 1, 0]}
        self.refuse(3, ["/billboards/0/light", "did you mean sun?"], "render",
                    self.write("card.json", scene(billboards=[card])), "-o", self.output)
        self.refuse(3, ["/camera", "did you mean main?"], "render",
                    self.write("camera.json", scene(camera="mian", cameras=[dict(scene()["camera"], name="main")])),
                    "-o", self.output)

    def test_what_is_missing_is_named(self):
        self.refuse(2, ["SCENE"], "render")
        self.refuse(2, ["--output"], "render", self.scene)
        self.refuse(2, ["--frames"], *self.render("--frames"))
        self.refuse(2, ["FILE"], "info")
        self.refuse(2, ["FILES"], "check")
        self.refuse(2, ["unexpected"], *self.render("another.json"))
        for option in ["--shutter=", "--mode=", "--png="]:
            self.refuse(2, [option[:-1], "empty"], *self.render(option, "--orders", "1"))

    def test_wrong_values_of_render_options(self):
        cases = {
            "--frames": ["", "x", "1-", "1-10:", "5-1", "1-10x0", "1,,2", "1-99999999999"],
            "--res": ["", "64", "64x", "0x36", "64x36x2", "-64x36", "99999x10", "64.5x36"],
            "--crop": ["", "1,2,3", "5,5,5,9", "9,0,5,5", "0,0,9,x", "-1,0,5,5"],
            "--samples": ["0", "-1", "nan", "1.5", "5000", "many"],
            "--quality": ["good", "FINAL"],
            "--mode": ["rasterize", ""],
            "--set": ["march.step_depth", "march.step_depth=", "march.step_depth=nan", "march.step_depth=1e30",
                      "pixel.samples=1.5", "pixel.jitter=red", "=1"],
            "--exposure": ["bright", "nan", "1000", "automatic"],
            "--view-transform": ["", "agx", "FILMIC"],
            "--light-units": ["watts"],
            "--missing": ["ignore"],
            "--aov": ["depth", "Z,,inscatter", "Variance", "half_a"],
            "--orders": ["", "0", "-1", "1.5", "65537", "many"],
            "--target-error": ["", "0", "-0.1", "nan", "1e-6", "11", "low"],
            "--time-budget": ["", "0", "-1", "nan", "inf", "2e6", "soon"],
            "--seed": ["-1", "4294967296", "1.5"],
            "--isa": ["sse2", "neon"],
        }
        for option, values in cases.items():
            for value in values:
                with self.subTest(option=option, value=value):
                    self.refuse(2, [], *self.render("--png", option, value))

    def test_wrong_values_of_global_options(self):
        for option, value in [("--threads", "0"), ("--threads", "-1"), ("--threads", "1025"), ("--threads", "two"),
                              ("--progress", "loud")]:
            self.refuse(2, [option], "modes", option, value)

    def test_wrong_values_of_bake_options(self):
        bake = ("bake", "recipe.json", "-o", self.path("fog.####.vdb"))
        for option, value in [("--voxel-size", "0"), ("--voxel-size", "-1"), ("--voxel-size", "nan"),
                              ("--compression", "lzma"), ("--frames", "1-5:0")]:
            self.refuse(2, [], *bake, option, value)

    def test_options_without_effect_are_refused(self):
        self.refuse(2, ["--exposure", "--png"], *self.render("--exposure", "1"))
        self.refuse(2, ["--view-transform", "--png"], *self.render("--view-transform", "srgb"))

    def test_options_that_do_not_exist_are_not_swallowed(self):
        self.refuse(2, ["--motion-samples"], *self.render("--motion-samples", "1"))
        for mode, why in [("march,march", "march is named twice"), ("march,auto", "do not combine it")]:
            self.refuse(2, [why], *self.render("--mode", mode))

    def test_what_a_mode_cannot_do_is_refused(self):
        self.refuse(2, ["--orders", "cone scatters light once", "march, froxel and path"],
                    *self.render("--orders", "2", "--mode", "cone"))
        for option in ["--target-error", "--time-budget"]:
            for mode in ["billboard", "radial-blur", "march,billboard"]:
                self.refuse(2, [option, mode.split(",")[-1], "is artistic"],
                            *self.render(option, "0.1", "--mode", mode))
            for more in [("--samples", "8"), ("--set", "pixel.samples=8")]:
                self.refuse(2, ["--samples", option], *self.render(option, "0.1", *more))
        self.refuse(2, ["--samples", "--time-budget"],
                    *self.render("--time-budget", "0.1", "--mode", "path", "--samples", "8"))

    def test_output_names(self):
        several = ("--frames", "1-2")
        for name in ["out.exr", "out.####.png", "out", "####", ".exr", "out.%s.exr", "out.##.##.exr"]:
            with self.subTest(name=name):
                self.refuse(2, [], "render", self.scene, "-o", self.path(name), *several)
        self.refuse(2, ["several frames"], "render", self.scene, "-o", self.path("out.exr"))
        self.refuse(2, [".vdb"], "bake", "recipe.json", "-o", self.path("out.####.exr"))

    def test_a_step_may_follow_a_colon_or_an_x(self):
        for mark in ":x":
            self.refuse(2, ["column"], *self.render("--frames", f"1-10{mark}"))
            self.succeed(*self.render("--frames", f"1-3{mark}2", "--quality", "draft"))
            self.assertFalse(self.path("out.0002.exr").exists())
            self.path("out.0003.exr").unlink()

    def test_camera_and_crop_are_checked_against_the_scene(self):
        self.refuse(2, ["nobody"], *self.render("--camera", "nobody"))
        self.refuse(2, ["--crop"], *self.render("--crop", "0,0,65,36"))
        self.refuse(2, ["--crop"], *self.render("--res", "32x18", "--crop", "0,0,33,18"))

    def test_negative_frames_are_values_not_options(self):
        self.succeed(*self.render("--frames", "-2--1", "--quality", "draft"))
        self.assertTrue(self.path("out.-0002.exr").exists())
        self.assertTrue(self.path("out.-0001.exr").exists())

    def test_option_values_may_be_any_bytes(self):
        for value in ["\n\x1b[31m", "%s%n%s", "é" * 400, "x" * 5000, "--", "🌫"]:
            self.refuse(2, [], *self.render("--quality", value))
            self.refuse(2, [], "modes", f"--{value[:3000]}")


class Modes(ProgramTest):
    def test_table_for_people_and_scripts(self):
        text = self.succeed("modes", "--settings").stdout
        report = json.loads(self.succeed("modes", "--json").stdout)
        self.assertIn("march", [mode["name"] for mode in report["modes"]])
        for mode in report["modes"]:
            self.assertTrue(mode["promise"] and mode["summary"])
            self.assertIn(mode["summary"], text)
        self.assertGreater(len(report["settings"]), 30)
        for row in report["settings"]:
            self.assertIn(row["name"], text)
            self.assertEqual(list(row["values"]), ["draft", "preview", "final", "reference"])

    def test_one_mode_with_what_it_reads(self):
        every = json.loads(self.succeed("modes", "--json").stdout)
        for mode in every["modes"]:
            text = self.succeed("modes", mode["name"]).stdout
            one = json.loads(self.succeed("--json", "modes", mode["name"]).stdout)
            self.assertEqual(one["modes"], [mode])
            self.assertEqual(one["settings"], [row for row in every["settings"] if mode["name"] in row["modes"]])
            for row in every["settings"]:
                self.assertEqual(f"\n  {row['name']} " in text, mode["name"] in row["modes"], row["name"])

    def test_settings_that_most_leave_alone_are_marked_advanced(self):
        rows = json.loads(self.succeed("modes", "--json").stdout)["settings"]
        marked = sum(row["advanced"] for row in rows)
        self.assertTrue(5 < marked < len(rows) / 2, marked)
        self.assertEqual(self.succeed("modes", "--settings").stdout.count("advanced)"), marked)

    def test_every_setting_takes_its_own_values(self):
        path = self.write("scene.json", scene(frames="1", resolution=[2, 2]))
        assignments = []
        for row in json.loads(self.succeed("modes", "--json").stdout)["settings"]:
            assignments += ["--set", f"{row['name']}={row['values']['draft']}"]
        self.succeed("render", path, "-o", self.path("out.exr"), *assignments)


class Streams(ProgramTest):
    def test_a_full_device_is_an_error_and_a_closed_pipe_is_not(self):
        with open("/dev/full", "w") as full:
            self.check_refusal(run("modes", stdout=full), 5, "standard output")
        shell = subprocess.run(["bash", "-c", '"$0" modes | true; exit "${PIPESTATUS[0]}"', TYNDALL],
                               stderr=subprocess.PIPE, text=True)
        self.assertEqual((shell.returncode, shell.stderr), (0, ""))

    def test_rendering_does_not_need_its_streams(self):
        path = self.write("scene.json", scene(frames="1"))
        reference = self.path("reference.exr")
        self.succeed("render", path, "-o", reference)
        whole = reference.read_bytes()
        for name, redirection in [("closed", ">&- 2>&- <&-"), ("full", ">/dev/full 2>/dev/full"), ("pipe", "| true")]:
            command = f'"$0" render "$1" -o "$2" {redirection}; exit "${{PIPESTATUS[0]}}"'
            output = self.path("reference.exr")  # its header has the name
            result = subprocess.run(["bash", "-c", command, TYNDALL, path, output], stderr=subprocess.DEVNULL)
            self.assertEqual(result.returncode, 0, name)
            self.assertEqual(output.read_bytes(), whole, name)
            output.unlink()

    def test_reports_leave_stdout_alone(self):
        path = self.write("scene.json", scene(frames="1-2"))
        result = self.succeed("render", path, "-o", self.path("out.####.exr"), "--json", "--progress", "alf")
        json.loads(result.stdout)
        self.assertIn("ALF_PROGRESS", result.stderr)

    def test_quiet_says_nothing_but_errors(self):
        path = self.write("scene.json", scene(frames="1-2", ambient=1))
        result = self.succeed("render", path, "-o", self.path("out.####.exr"), "-q", "-v")
        self.assertEqual(result.stdout, "")
        self.assertEqual(result.stderr, "")
        self.assertEqual(self.succeed("check", path, "-q").stderr, "")


if __name__ == "__main__":
    unittest.main()
