"""Volumes of others as media of several grids: what `tyndall info` prints is what a scene file takes."""
import json
import unittest

from cli.exr import read_channels
from cli.program import ProgramTest, corpus, run, scene


class Grids(ProgramTest):
    def medium(self, path):
        return json.loads(self.info(path)["scene_medium"])

    def test_printed_lines_render(self):
        count = 0
        for path in corpus("vdb/**/*.vdb"):
            told = run("info", "--json", path)
            text = json.loads(told.stdout)["scene_medium"] if told.returncode == 0 else ""
            if not text or path.stat().st_size > 3e6:
                continue
            medium = json.loads(text)
            self.assertIn(json.dumps(medium["file"]), self.succeed("info", path).stdout)
            medium["file"] = str(path)
            look = self.write("scene.json", scene(frames="1", media=[medium]))
            self.succeed("render", look, "-o", self.path("a.exr"), "--res", "32x18", "--samples", "1")
            self.assertIn(run("check", look).returncode, (0, 1), "it tells of voxels that are mended")
            count += 1
        self.assertGreaterEqual(count, 6)

    def test_roles_and_ranges(self):
        [nebula] = corpus("vdb/volumarcher/nebula.vdb")
        grids = {grid["name"]: grid for grid in self.info(nebula)["grids"]}
        self.assertEqual(grids["density"]["looks_like"], "density")
        self.assertEqual(grids["distance"]["looks_like"], "level set")
        self.assertEqual(grids["color.x"]["looks_like"], "color")
        self.assertEqual(self.medium(nebula)["grids"]["albedo"], "color")
        [sphere] = corpus("vdb/oiio/sphereCd.vdb")
        [color] = [grid for grid in self.info(sphere)["grids"] if grid["name"] == "Cd"]
        self.assertEqual(len(color["ranges"]), 3)
        self.assertLess(min(low for low, high in color["ranges"]), 0)
        self.assertIn("looks like a color", self.succeed("info", sphere).stdout)

    def test_colors_color_the_light(self):
        [nebula] = corpus("vdb/volumarcher/nebula.vdb")
        medium = self.medium(nebula)
        medium["file"] = str(nebula)
        gray = {**medium, "grids": {"density": "density"}, "albedo": 1}
        for name, one in ("color", {**medium, "albedo": 1}), ("gray", gray):
            look = self.write("scene.json", scene(frames="1", media=[one]))
            for mode in "march", "path", "froxel":
                self.succeed("render", look, "-o", self.path(f"{name}_{mode}.exr"), "--res", "24x13", "--samples", "4",
                             "--mode", mode, "--orders", "1")
        def ratio(name, mode):
            channels = read_channels(self.path(f"{name}_{mode}.exr"))
            red, blue = sum(channels["inscatter.R"]), sum(channels["inscatter.B"])
            return red / blue if blue else 1
        for mode in "march", "path", "froxel":
            self.assertAlmostEqual(ratio("gray", mode), 1, delta=0.05)
            self.assertNotAlmostEqual(ratio("color", mode), ratio("gray", mode), delta=0.02)
            self.assertAlmostEqual(ratio("color", mode), ratio("color", "march"), delta=0.1 * ratio("color", "march"))

    def test_mistakes_are_one_line(self):
        [nebula] = corpus("vdb/volumarcher/nebula.vdb")
        def look(**members):
            return self.write("scene.json", scene(frames="1", media=[{"type": "vdb", "file": str(nebula), "extinction": 1, **members}]))
        for words, members in [
                (["nebula.vdb", "has no grid", "heat"],
                 {"grids": {"temperature": "heat"}, "blackbody": {"convention": "kelvin"}}),
                (["nebula.vdb", "distance", "narrow band"], {"grids": {"density": {"grid": "distance", "width": 1e6}}}),
                (["nebula.vdb", "density", "width"], {"grids": {"density": {"grid": "density", "width": 0.1}}})]:
            path = look(**members)
            self.refuse(3, words, "render", path, "-o", self.path("a.exr"), "--res", "16x9", "--samples", "1")

    def test_modes_say_what_becomes_of_light_and_color(self):
        [nebula] = corpus("vdb/volumarcher/nebula.vdb")
        medium = {"type": "vdb", "file": str(nebula), "extinction": 1, "grids": {"albedo": "color", "temperature": {"grid": "density", "scale": 1500}},
                  "blackbody": {"convention": "kelvin"}}
        look = self.write("scene.json", scene(frames="1", media=[medium]))
        for mode, ids in {"march": {"out_of_gamut"}, "path": {"out_of_gamut"}, "cone": {"mean_emission_color", "mean_albedo", "lamps_for_fire"},
                          "shadow-map": {"mean_albedo", "lamps_for_fire"}, "radial-blur": {"fire_left_out"}}.items():
            self.succeed("render", look, "-o", self.path("a.exr"), "--res", "16x9", "--samples", "1", "--mode", mode, "--stats-json",
                         self.path("stats.json"))
            found = {one["id"] for one in json.loads(self.path("stats.json").read_text())["limitations"]}
            self.assertLessEqual(ids, found, mode)


if __name__ == "__main__":
    unittest.main()
