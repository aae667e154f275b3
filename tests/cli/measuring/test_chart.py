"""chart: numbers that agree, nothing measured twice, and a page that works in a browser without a network."""
import csv
import html.parser
import json
import math
import re
import shutil
import subprocess
import unittest
import xml.dom.minidom

from cli.program import ProgramTest, scene

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FOG = {"type": "homogeneous", "extinction": 0.3, "bounds": {"low": [-2, -1, -2], "high": [2, 2, 2]}}


class Chart(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("scene.json", scene(media=[FOG], ambient=[0.1, 0.1, 0.1]))
        self.small = ["--res", "48x32", "--samples", "4", "--quick"]

    def chart(self, *arguments):
        return self.succeed("chart", self.scene, "-o", self.path("chart"), *self.small, *arguments, timeout=300)

    def points(self):
        return json.loads(self.path("chart/chart.json").read_text())["points"]

    def test_all_modes_csv_and_json_agree(self):
        self.chart()
        points = self.points()
        modes = {point["mode"] for point in points}
        self.assertEqual(modes, {"march", "froxel", "shadow-map", "shadow-volume", "cone", "billboard",
                                 "radial-blur", "path"})
        with open(self.path("chart/chart.csv"), newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(points))
        for row, point in zip(rows, points):
            for name, value in point.items():
                if value is None:
                    self.assertEqual(row[name], "", name)
                elif isinstance(value, str):
                    self.assertEqual(row[name], value)
                else:
                    self.assertTrue(math.isclose(float(row[name]), value, rel_tol=1e-12), name)
        for point in points:
            self.assertGreater(point["frame_seconds"], 0)
            self.assertGreaterEqual(point["runs"], 2)
            self.assertLessEqual(point["frame_fastest"], point["frame_seconds"])
            self.assertLessEqual(point["frame_seconds"], point["frame_slowest"])
            self.assertGreaterEqual(point["seconds_1"], point["seconds_100"])
            look = point["mode"] in ("billboard", "radial-blur")
            self.assertEqual(point["gain"] is not None, look, point["mode"])
            if look:
                self.assertLessEqual(point["fitted_fog_error"], point["fog_error"] * 1.0001)
            for kind in ("png", "error.png"):
                self.assertTrue(self.path(f"chart/pictures/{point['mode']}.{point['rung']}.{kind}").exists())

    def test_even_open_fog_is_right_in_every_mode_that_says_so(self):
        # One sun, nothing in its way, fog without grain: all but path are exact at pixel centers.
        self.chart("--modes", "march,shadow-volume,cone,path")
        best = {}
        for point in self.points():
            best[point["mode"]] = min(point["fog_error"], best.get(point["mode"], 9))
        for mode in ("march", "shadow-volume", "cone"):
            self.assertLess(best[mode], 1e-3, mode)
        self.assertLess(best["path"], 0.5)

    def test_nothing_is_measured_twice(self):
        arguments = ["--modes", "march,cone"]
        self.chart(*arguments)
        files = sorted(self.path("chart/points").glob("*.json")) + sorted(self.path("chart/reference").glob("*"))
        before = {file: (file.stat().st_mtime_ns, file.read_bytes()) for file in files}
        first = self.points()
        result = self.chart(*arguments)
        self.assertIn(f"{len(first)} kept", result.stderr)
        self.assertEqual({file: (file.stat().st_mtime_ns, file.read_bytes()) for file in files}, before)
        self.assertEqual(self.points(), first)

        # A point that is gone or damaged is measured again, and no other.
        gone, damaged = files[0], files[1]
        gone.unlink()
        damaged.write_text(damaged.read_text()[:40])
        self.chart(*arguments)
        for file in files:
            same = (file.stat().st_mtime_ns, file.read_bytes()) == before[file]
            self.assertEqual(same, file not in (gone, damaged), file.name)

        # Another scene under the same name: nothing may be kept.
        self.write("scene.json", scene(media=[dict(FOG, extinction=0.5)]))
        self.assertNotIn("kept", self.chart(*arguments).stderr)

    def test_json_report_is_the_file(self):
        result = self.chart("--modes", "cone", "--json")
        self.assertEqual(result.stdout, self.path("chart/chart.json").read_text())
        self.assertIn("error of at most", self.chart("--modes", "cone", "-q").stdout)

    def test_says_what_was_left_out_and_why(self):
        result = self.chart("--modes", "cone,path", "--longest", "0.01", "-q")
        left_out = json.loads(self.path("chart/chart.json").read_text())["left_out"]
        self.assertGreater(len(left_out), 0)  # 1024 paths a pixel take more than 10 ms
        listed = [line for line in result.stdout.splitlines() if line.startswith("  ")]
        self.assertEqual(len(listed), len(left_out))
        for rung, line in zip(left_out, listed):
            self.assertTrue(line.startswith(f"  {rung['mode']} {rung['rung']}, "), line)
            self.assertIn(rung["settings"], line)
        self.assertIn("more than 10 ms (--longest)", result.stdout)

    def test_drawings_are_files_of_their_own(self):
        self.chart("--modes", "cone")
        for name in ("chart", "chart_fog", "chart_sequence"):
            drawing = xml.dom.minidom.parse(str(self.path(f"chart/{name}.svg"))).documentElement
            marks = [group for group in drawing.getElementsByTagName("g") if group.getAttribute("class") == "mark"]
            self.assertEqual(len(marks), len(self.points()))

    def test_refusals(self):
        out = ["-o", self.path("out")]
        self.refuse(2, ["--modes", "fog"], "chart", self.scene, *out, "--modes", "fog")
        self.refuse(2, ["--modes", "twice"], "chart", self.scene, *out, "--modes", "cone,cone")
        self.refuse(2, ["--samples"], "chart", self.scene, *out, "--samples", "1")
        self.refuse(2, ["--output"], "chart", self.scene)
        self.refuse(2, ["left"], "chart", self.scene, *out, "--camera", "left")
        self.refuse(4, ["missing.json"], "chart", "missing.json", *out)
        self.refuse(3, ["empty.json", "no fog"], "chart", self.write("empty.json", scene(media=[])), *out)
        self.refuse(5, ["scene.json"], "chart", self.scene, "-o", self.scene)


class Links(html.parser.HTMLParser):
    """Every address a page mentions."""

    def __init__(self):
        super().__init__()
        self.found = []

    def handle_starttag(self, tag, attributes):
        self.found += [value for name, value in attributes if name in ("src", "href", "xlink:href")]


class Page(ProgramTest):
    def setUp(self):
        super().setUp()
        file = self.write("scene.json", scene(media=[FOG]))
        self.succeed("chart", file, "-o", self.path("chart"), "--res", "48x32", "--samples", "4", "--quick",
                     "--modes", "march,billboard", timeout=300)
        self.page = self.path("chart/chart.html")
        self.points = json.loads(self.path("chart/chart.json").read_text())["points"]

    def test_holds_all_it_shows(self):
        text = self.page.read_text()
        links = Links()
        links.feed(text)
        self.assertEqual([link for link in links.found if not link.startswith("data:")], [])
        self.assertNotIn("@import", text)
        for point in self.points:
            name = f"{point['mode']}.{point['rung']}"
            self.assertEqual(text.count(f"data-id='{name}'"), 3, name)  # in every chart
            self.assertIn(f'id="row-{name}"', text)

    def opened(self, text, fragment=""):
        """The document after its scripts have run, and what the browser logged."""
        file = self.write("opened.html", text)
        result = subprocess.run(
            [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={self.path('profile')}",
             "--enable-logging=stderr", "--v=0", "--virtual-time-budget=3000", "--dump-dom", file.as_uri() + fragment],
            capture_output=True, text=True, timeout=120, check=True)
        self.assertEqual([line for line in result.stderr.splitlines() if "CONSOLE" in line], [])
        return result.stdout

    @unittest.skipUnless(BROWSER, "needs chromium")
    def test_shows_values_under_the_pointer(self):
        text = self.page.read_text()
        self.assertRegex(self.opened(text), r'<div id="tip"[^>]*hidden')
        event = """<script>document.querySelector('.mark[data-id="march.3"]').dispatchEvent(
            new PointerEvent("pointerenter", {clientX: 300, clientY: 200}));</script></body>"""
        for document in (self.opened(text.replace("</body>", event)), self.opened(text, "#hover=march.3")):
            tip = re.search(r'<div id="tip".*?</div>', document, re.S).group(0)
            self.assertNotIn("hidden", tip.split(">")[0])
            self.assertIn("march 3", tip)
            self.assertIn("error E", tip)
            self.assertEqual(tip.count("<img"), 2)
            self.assertIn("pixel.samples=4", tip)


if __name__ == "__main__":
    unittest.main()
