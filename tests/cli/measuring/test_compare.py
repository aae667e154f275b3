"""`tyndall compare`: what it measures, what it refuses, and its exit codes."""
import json
import math
import struct
import unittest

from cli.program import ProgramTest, png_size, run, scene

NAN, INF = math.nan, math.inf
METRICS = ["E", "rmse_rel", "bias_rel", "mae_rel", "p95_rel", "p99_9_rel", "max_rel", "rmse", "bias", "mae", "p95",
           "p99_9", "max", "rel_mse", "rel_mse_trimmed", "ssim_loss", "flip", "flip_ldr", "ssim"]


def exr(width, height, channels, display=None, low=(0, 0)):
    """An uncompressed OpenEXR file; each channel is a number, or a function of x and y."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    names = sorted(channels)
    window = struct.pack("<4i", *low, low[0] + width - 1, low[1] + height - 1)
    view = struct.pack("<4i", 0, 0, *(side - 1 for side in display)) if display else window
    table = b"".join(name.encode() + b"\0" + struct.pack("<i4B2i", 2, 0, 0, 0, 0, 1, 1) for name in names) + b"\0"
    header = struct.pack("<2i", 20000630, 2) + b"".join([
        attribute("channels", "chlist", table), attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", window), attribute("displayWindow", "box2i", view),
        attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1))]) + b"\0"
    line = 4 * width * len(names)
    first = len(header) + 8 * height
    offsets = struct.pack(f"<{height}Q", *(first + y * (line + 8) for y in range(height)))
    rows = []
    for y in range(height):
        values = [v(x, y) if callable(v) else v for v in map(channels.get, names) for x in range(width)]
        rows.append(struct.pack("<2i", low[1] + y, line) + struct.pack(f"<{len(values)}f", *values))
    return header + offsets + b"".join(rows)


def gray(value, **layers):
    return {"R": value, "G": value, "B": value, **layers}


def color_layer(name, value):
    return {f"{name}.{c}": value for c in "RGB"}


class Compare(ProgramTest):
    def picture(self, name, channels, width=16, height=8, **windows):
        return self.write(name, exr(width, height, channels, **windows))

    def report(self, *arguments, code=0):
        result = run("compare", *arguments, "--json", "-q")
        self.assertEqual(result.returncode, code, result.stderr)
        return json.loads(result.stdout)


class Values(Compare):
    def test_known_pictures(self):
        reference = self.picture("b.exr", gray(2, Z=1e10, **{"transmittance.T": 0.5}, **color_layer("inscatter", 1)))
        test = self.picture("a.exr", gray(lambda x, y: 3 if x < 8 else 1, Z=3,
                                          **{"transmittance.T": 0.25}, **color_layer("inscatter", 1.75)))
        report = self.report(test, reference)
        self.assertEqual((report["size"], report["pixels"]), ([16, 8], 128))
        self.assertEqual((report["mean"], report["mean_reference"]), (2, 2))
        metrics = report["metrics"]
        self.assertEqual(list(metrics), METRICS)
        self.assertEqual((metrics["bias"], metrics["rmse"], metrics["rmse_rel"], metrics["max"]), (0, 1, 0.5, 1))
        self.assertEqual(metrics["E"], 0.75)
        self.assertEqual(sorted(report["layers"]), ["inscatter", "transmittance"])
        self.assertEqual(report["layers"]["inscatter"]["bias_rel"], 0.75)
        self.assertEqual(report["layers"]["transmittance"]["bias_rel"], -0.5)
        text = self.succeed("compare", test, reference).stdout
        for word in ["16 x 8 pixels", "rmse", "50 %", "SSIM", "FLIP", "relMSE", "inscatter", "75 %", "transmittance"]:
            self.assertIn(word, text)

    def test_equal_pictures(self):
        path = self.picture("a.exr", gray(lambda x, y: x * y))
        metrics = self.report(path, path)["metrics"]
        for name in METRICS:
            self.assertEqual(metrics[name], 1 if name == "ssim" else 0, name)

    def test_black_pictures(self):
        black, light = self.picture("b.exr", gray(0)), self.picture("a.exr", gray(1))
        self.assertEqual(self.report(black, black)["metrics"]["rmse_rel"], 0)
        metrics = self.report(light, black)["metrics"]
        self.assertEqual((metrics["rmse"], metrics["rmse_rel"], metrics["ssim"]), (1, None, 0))
        self.assertIn("inf", self.succeed("compare", light, black).stdout)
        self.assertEqual(run("compare", light, black, "--fail-above", "rmse_rel=1e30").returncode, 1)

    def test_luminance_pictures_and_pixels_per_degree(self):
        reference = self.picture("b.exr", {"Y": lambda x, y: 1 + (x + y) % 2})
        test = self.picture("a.exr", {"Y": lambda x, y: 1.5})
        report = self.report(test, reference)
        self.assertAlmostEqual(report["metrics"]["rmse"], 0.5)
        self.assertEqual(report["viewing"]["pixels_per_degree"], 67)
        near = self.report(test, reference, "--ppd", "20")
        self.assertEqual(near["viewing"]["pixels_per_degree"], 20)
        self.assertGreater(near["metrics"]["flip"], report["metrics"]["flip"])  # a checkerboard blurs with distance

    def test_halves(self):
        reference = self.picture("b.exr", gray(2, **color_layer("half_a", 1), **color_layer("half_b", 3)))
        metrics = self.report(self.picture("a.exr", gray(5)), reference)["metrics"]
        self.assertEqual((metrics["mse_unbiased"], metrics["mse_unbiased_error"]), (8, 0))
        self.assertNotIn("bias_squared", metrics)
        both = self.picture("c.exr", gray(5, **color_layer("half_a", 6), **color_layer("half_b", 4)))
        self.assertEqual(self.report(both, reference)["metrics"]["bias_squared"], 5)

    def test_rendered_pictures(self):
        path = self.write("scene.json", scene(frames="1"))
        for name, samples in [("a.exr", 1), ("b.exr", 4)]:
            self.succeed("render", path, "-o", self.path(name), "--samples", samples, "--aov", "inscatter,lights,Z")
        report = self.report(self.path("a.exr"), self.path("b.exr"))
        self.assertEqual(sorted(report["layers"]), ["inscatter", "light_sun"])
        self.assertLess(abs(report["metrics"]["bias_rel"]), 0.1)

    def test_threads_do_not_matter(self):
        a = self.picture("a.exr", gray(lambda x, y: math.sin(x * y) + 1), 61, 47)
        b = self.picture("b.exr", gray(lambda x, y: math.sin(x * y + 0.1) + 1), 61, 47)
        reports = {run("compare", a, b, "--json", "--threads", n).stdout for n in (1, 2, 5)}
        self.assertEqual(len(reports), 1)


class Sequences(Compare):
    def setUp(self):
        super().setUp()
        for frame in (1, 2, 3):
            self.picture(f"b.{frame:04}.exr", gray(2))
            self.picture(f"a.{frame:04}.exr", gray(2 + frame % 2))

    def test_sequence_against_sequence_and_against_one_picture(self):
        for reference in ("b.####.exr", "b.0001.exr"):
            report = self.report(self.path("a.####.exr"), self.path(reference), "--frames", "1-3")
            self.assertEqual([frame["frame"] for frame in report["frames"]], [1, 2, 3])
            self.assertEqual([frame["rmse_rel"] for frame in report["frames"]], [0.5, 0, 0.5])
            self.assertEqual([frame["ssim"] == 1 for frame in report["frames"]], [False, True, False])
            self.assertAlmostEqual(report["metrics"]["rmse_rel"], math.sqrt(2 / 3) / 2)
            self.assertAlmostEqual(report["metrics"]["flicker"], 0.5)
        text = self.succeed("compare", self.path("a.####.exr"), self.path("b.####.exr"), "--frames", "1-3").stdout
        self.assertIn("flicker", text)
        self.assertIn("3 frames", text)

    def test_heat_map_of_each_frame(self):
        self.report(self.path("a.####.exr"), self.path("b.####.exr"), "--frames", "1-2",
                    "--heatmap", self.path("maps/heat.####.png"))
        self.assertEqual(sorted(path.name for path in self.path("maps").iterdir()), ["heat.0001.png", "heat.0002.png"])

    def test_what_does_not_fit_together(self):
        a, b, one = self.path("a.####.exr"), self.path("b.####.exr"), self.path("b.0001.exr")
        self.refuse(2, ["--frames"], "compare", a, b)
        self.refuse(2, ["sequence"], "compare", one, b, "--frames", "1-3")
        self.refuse(2, ["--frames"], "compare", one, one, "--frames", "1")
        self.refuse(2, ["--heatmap"], "compare", a, b, "--frames", "1-3", "--heatmap", self.path("heat.png"))
        self.refuse(4, ["b.0009.exr"], "compare", one, self.path("b.0009.exr"))
        self.assertEqual(run("compare", a, b, "--frames", "1-4", "-q").returncode, 4)


class Limits(Compare):
    def setUp(self):
        super().setUp()
        self.pair = self.picture("a.exr", gray(1.5)), self.picture("b.exr", gray(2))

    def test_exit_codes(self):
        self.assertEqual(run("compare", *self.pair).returncode, 0)
        for bounds, code in [(["rmse_rel=0.25"], 0), (["rmse_rel=0.24"], 1), (["bias=0.4"], 1), (["bias=0.5"], 0),
                             (["rmse_rel=0.3", "max=0.1", "flip=0"], 1), (["rmse_rel=0.3", "max=1"], 0)]:
            arguments = [word for bound in bounds for word in ("--fail-above", bound)]
            self.assertEqual(run("compare", *self.pair, *arguments).returncode, code, bounds)

    def test_what_was_exceeded_is_said(self):
        report = self.report(*self.pair, "--fail-above", "rmse_rel=0.1", "--fail-above", "bias=9", code=1)
        self.assertEqual(report["exceeded"], [{"metric": "rmse_rel", "value": 0.25, "limit": 0.1}])
        self.assertIn("rmse_rel is 0.25; the limit is 0.1", run("compare", *self.pair, "--fail-above", "rmse_rel=0.1").stderr)

    def test_unknown_metrics_and_values(self):
        self.refuse(2, ["did you mean rmse?"], "compare", *self.pair, "--fail-above", "rmsd=1")
        self.refuse(2, ["rmse_rel", "flip", "flicker"], "compare", *self.pair, "--fail-above", "loudness=1")
        for bound in ["rmse_rel", "rmse_rel=", "rmse_rel=x", "rmse_rel=-1", "rmse_rel=nan", "=1", "ssim=0.9"]:
            self.refuse(2, ["--fail-above"], "compare", *self.pair, "--fail-above", bound)
        for metric in ["flicker", "mse_unbiased", "bias_squared"]:
            self.refuse(2, [metric], "compare", *self.pair, "--fail-above", f"{metric}=1")

    def test_pixels_that_are_not_finite(self):
        test = self.picture("nan.exr", gray(lambda x, y: NAN if x == y == 3 else 2))
        reference = self.picture("inf.exr", gray(lambda x, y: INF if x == 5 else 2))
        result = run("compare", test, reference, "--json")
        self.assertEqual(result.returncode, 6)
        self.assertIn("9 pixels", result.stderr)
        report = json.loads(result.stdout)
        self.assertEqual(report["non_finite"], {"test": 1, "reference": 8})
        self.assertEqual((report["pixels"], report["metrics"]["rmse"]), (128 - 9, 0))
        self.assertEqual(run("compare", test, self.pair[0], "--fail-above", "rmse=0").returncode, 1)
        fog = color_layer("inscatter", lambda x, y: NAN if y == 0 else 1)
        layer = self.picture("layer.exr", gray(2, **fog))
        report = self.report(layer, layer, code=6)
        self.assertEqual(report["layers"]["inscatter"]["non_finite"], {"test": 16, "reference": 16})
        self.assertIn("ignored", run("compare", layer, layer).stdout)
        nothing = self.picture("nothing.exr", gray(NAN))
        self.assertIsNone(self.report(nothing, self.pair[1], code=6)["metrics"]["rmse"])
        self.assertEqual(run("compare", nothing, self.pair[1], "--fail-above", "rmse=1e9").returncode, 1)


class HeatMaps(Compare):
    def test_png_of_the_picture_and_its_scale(self):
        a, b = self.picture("a.exr", gray(1), 80, 50), self.picture("b.exr", gray(lambda x, y: 1 + x / 80), 80, 50)
        for kind in ("error", "flip"):
            path = self.path(f"{kind}.png")
            result = self.succeed("compare", a, b, "--heatmap", path, "--map", kind)
            self.assertIn("white", result.stderr)
            width, height = png_size(path)
            self.assertEqual(width, 80)
            self.assertGreater(height, 50)
            self.assertLess(height, 70)
        self.assertNotEqual(self.path("error.png").read_bytes(), self.path("flip.png").read_bytes())

    def test_where_it_cannot_be_written(self):
        pair = self.picture("a.exr", gray(1)), self.picture("b.exr", gray(1))
        self.refuse(2, ["--heatmap"], "compare", *pair, "--heatmap", self.path("heat.jpg"))
        self.refuse(2, ["--map"], "compare", *pair, "--heatmap", self.path("heat.png"), "--map", "depth")
        self.refuse(2, ["--map", "--heatmap"], "compare", *pair, "--map", "flip")
        self.refuse(5, [], "compare", *pair, "--heatmap", self.path("a.exr/heat.png"))


class Refusals(Compare):
    def test_pictures_that_do_not_match(self):
        reference = self.picture("b.exr", gray(1))
        wide = self.picture("a.exr", gray(1), 17, 8)
        self.refuse(3, ["a.exr", "17 x 8", "b.exr", "16 x 8"], "compare", wide, reference)
        crop = self.picture("crop.exr", gray(1), 8, 4, display=(16, 8), low=(2, 1))
        self.refuse(3, ["8 x 4 at 2,1", "--crop"], "compare", crop, reference)
        self.assertEqual(self.report(crop, crop)["pixels"], 32)
        self.refuse(3, ["luminance"], "compare", self.picture("y.exr", {"Y": 1}), reference)

    def test_files_without_color(self):
        reference = self.picture("b.exr", gray(1))
        depth = self.picture("depth.exr", {"Z": 1, "A": 1, "view.combined.R": 1})
        self.refuse(3, ["depth.exr", "no color", "Z", "view.combined.R"], "compare", depth, reference)
        self.refuse(3, ["depth.exr"], "compare", reference, depth)

    def test_files_that_are_missing_or_something_else(self):
        reference = self.picture("b.exr", gray(1))
        self.refuse(4, ["nobody.exr"], "compare", self.path("nobody.exr"), reference)
        self.refuse(4, ["nobody.exr"], "compare", reference, self.path("nobody.exr"))
        notes = self.write("notes.exr", "some notes, long enough to be read")
        self.refuse(3, ["notes.exr"], "compare", notes, reference)
        self.refuse(2, ["B.exr"], "compare", reference)
        self.refuse(2, ["--ppd"], "compare", reference, reference, "--ppd", "0")


if __name__ == "__main__":
    unittest.main()
