"""explain: a ray as text, JSON, drawing and table, and what it refuses."""
import csv
import json
import unittest
import xml.etree.ElementTree

from cli.program import ProgramTest, SOURCE, scene

WINDOW = SOURCE / "scenes/window.json"


class Explain(ProgramTest):
    def setUp(self):
        super().setUp()
        fog = {"name": "haze", "type": "homogeneous", "extinction": 0.3,
               "bounds": {"low": [-2, -1, -2], "high": [2, 2, 2]}}
        self.scene = self.write("scene.json", scene(media=[fog]))

    def test_text_says_what_happens(self):
        result = self.succeed("explain", self.scene, "--pixel", "32,18", "-q")
        for word in ("pixel 32,18 of 64x36", "optical depth", "haze", "sun", "lit", "reference", "froxel", "radial-blur"):
            self.assertIn(word, result.stdout)
        self.assertLessEqual(max(map(len, result.stdout.splitlines())), 100)

    def test_json_holds_all_data(self):
        report = json.loads(self.succeed("explain", self.scene, "--pixel", "32,18", "--json", "-q").stdout)
        self.assertEqual(report["pixel"], [32, 18])
        self.assertEqual([mode["mode"] for mode in report["modes"]][:2], ["march", "froxel"])
        self.assertAlmostEqual(report["media"][0]["depth"], report["depth"])
        (light,) = report["lights"]
        self.assertEqual(len(light["steps"]), len(report["steps"]))
        total = sum(step["reach"] * at["scattered"][0] for step, at in zip(report["steps"], light["steps"]))
        self.assertAlmostEqual(total / light["fog"][0], 1, delta=1e-3)
        march = report["modes"][0]
        self.assertLess(abs(march["difference"]), 0.05)
        self.assertIn("standard_error", next(mode for mode in report["modes"] if mode["mode"] == "path"))

    def test_every_kind_of_light_has_its_name(self):
        face = {"position": [0, 1.5, 0], "target": [0, 0, 0], "intensity": 50, "radius": 0.3}
        lights = [{"name": kind, "type": kind, **face} for kind in ("disc", "sphere", "rectangle")]
        lights[1].pop("target"), lights[2].pop("radius")
        lights[2] |= {"width": 0.6, "height": 0.4}
        path = self.write("faces.json", scene(lights=lights))
        asked = ("explain", path, "--pixel", "32,18", "--modes", "none", "-q")
        told = json.loads(self.succeed(*asked, "--json").stdout)["lights"]
        self.assertEqual([light["type"] for light in told], ["disc", "sphere", "rectangle"])
        self.assertLessEqual(max(map(len, self.succeed(*asked).stdout.splitlines())), 100)

    def test_drawing_and_table(self):
        svg, table = self.path("new/ray.svg"), self.path("ray.csv")
        self.succeed("explain", WINDOW, "--pixel", "80,45", "--res", "160x90", "--modes", "march,cone", "-q",
                     "--svg", svg, "--csv", table)
        root = xml.etree.ElementTree.parse(svg).getroot()
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        words = "".join(root.itertext())
        for word in ("window.json", "sun", "march", "cone", "distance"):
            self.assertIn(word, words)
        with open(table, newline="") as file:
            rows = list(csv.reader(file))
        self.assertGreater(len(rows), 100)
        self.assertEqual({len(row) for row in rows}, {len(rows[0])})
        self.assertIn("sun lit", rows[0])
        steps = [list(map(float, row)) for row in rows[1:]]
        for before, after in zip(steps, steps[1:]):
            self.assertLessEqual(before[1], after[0] + 1e-6)

    def test_names_do_not_break_the_drawing(self):
        light = {"name": "a <b> & \"c\", 'd'", "type": "sun", "direction": [0, -1, 0], "intensity": 10}
        path = self.write("odd.json", scene(lights=[light]))
        svg, table = self.path("odd.svg"), self.path("odd.csv")
        self.succeed("explain", path, "--pixel", "3,3", "--modes", "none", "--svg", svg, "--csv", table, "-q")
        self.assertIn(light["name"][:9], "".join(xml.etree.ElementTree.parse(svg).getroot().itertext()))
        with open(table, newline="") as file:
            self.assertIn(light["name"] + " lit", next(csv.reader(file)))

    def test_modes_settings_and_frames_are_heard(self):
        def report(*more):
            return json.loads(self.succeed("explain", self.scene, "--pixel", "32,18", "--json", "-q", *more).stdout)
        one = report("--modes", "march", "--frame", "2", "--quality", "final")
        self.assertEqual((len(one["modes"]), one["frame"], one["quality"]), (1, 2, "final"))
        dark = report("--modes", "march", "--set", "style.density=0.5")
        self.assertAlmostEqual(dark["depth"], one["depth"] / 2, places=5)
        self.assertEqual(report("--modes", "none")["modes"], [])

    def test_the_same_with_any_number_of_threads(self):
        texts = {self.succeed("explain", self.scene, "--pixel", "20,20", "--json", "-q", "--threads", n).stdout
                 for n in (1, 2, 3)}
        self.assertEqual(len(texts), 1)

    def test_refusals(self):
        self.refuse(2, ["--pixel"], "explain", self.scene)
        for pixel in ("3", "1,2,3", "a,b", "1.5,2"):
            self.refuse(2, ["--pixel"], "explain", self.scene, "--pixel", pixel)
        self.refuse(2, ["--pixel", "64,0", "64x36"], "explain", self.scene, "--pixel", "64,0")
        self.refuse(2, ["--pixel", "64x36"], "explain", self.scene, "--pixel=0,-1")
        self.refuse(2, ["--pixel", "20x10"], "explain", self.scene, "--pixel", "20,0", "--res", "20x10")
        self.refuse(2, ["--svg", ".svg"], "explain", self.scene, "--pixel", "1,1", "--svg", self.path("ray.png"))
        self.refuse(2, ["nothing"], "explain", self.scene, "--pixel", "1,1", "--modes", "nothing")
        self.refuse(2, ["auto"], "explain", self.scene, "--pixel", "1,1", "--modes", "auto")
        self.refuse(2, ["nobody"], "explain", self.scene, "--pixel", "1,1", "--camera", "nobody")
        self.refuse(2, ["march.step"], "explain", self.scene, "--pixel", "1,1", "--set", "march.step=1")
        self.refuse(4, ["missing.json"], "explain", "missing.json", "--pixel", "1,1")


if __name__ == "__main__":
    unittest.main()
