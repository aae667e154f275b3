"""What `tyndall info` says about files whose content is known."""
import json
import math
import unittest

from cli.exr import read_channels
from cli.program import SOURCE, TRIANGLE, ProgramTest, corpus, glb, gltf, recipe, scene


def lamp(kind, intensity):
    light = {"type": kind, "intensity": intensity, "name": f"{kind} {intensity}"}
    return {**light, "spot": {"outerConeAngle": 0.5}} if kind == "spot" else light


class Info(ProgramTest):
    def report(self, path):
        """The report as JSON; the one for people has to come as well."""
        text = self.succeed("info", path).stdout
        self.assertIn(str(path), text)
        self.assertNotIn("\x1b", text)
        return self.info(path)

    def test_volumes(self):
        fog = recipe(density={"threshold": 0, "gain": 1000}, wind=[0, 0, 0], optics={"extinction": 0.25})
        self.succeed("bake", self.write("recipe.json", fog), "-o", self.path("fog.0007.vdb"), "--frames", "7")
        report = self.report(self.path("fog.0007.vdb"))
        self.assertEqual((report["kind"], report["file_version"]), ("vdb", 224))
        self.assertEqual(report["metadata"]["tyndall_frame"], "7")
        self.assertEqual(report["metadata"]["tyndall_extinction_per_m"], "0.25")
        self.assertNotIn("extinction", json.loads(report["scene_medium"]), "a scene takes the file's")
        [grid] = report["grids"]
        self.assertEqual((grid["name"], grid["type"], grid["class"]), ("density", "float", "fog volume"))
        self.assertTrue(grid["usable"])
        # Saturated fog fills the box: every number follows from the recipe.
        self.assertEqual(grid["voxels"], [32, 16, 32])
        self.assertEqual(grid["active_voxels"], 32 * 16 * 32)
        self.assertEqual((grid["minimum"], grid["maximum"], grid["mean"], grid["background"]), (1, 1, 1, 0))
        for name, corner in fog["bounds"].items():
            for found, expected in zip(grid["bounds"][name], corner):
                self.assertAlmostEqual(found, expected, places=5)

    def test_grids_of_one_name_are_told_apart_by_what_a_scene_types(self):
        [path] = corpus("vdb/arnold/grids.vdb")
        text = self.succeed("info", path).stdout
        keys = [grid["grid"] for grid in self.info(path)["grids"]]
        self.assertEqual(keys, ["density[0]", "density[1]", "density[2]"])
        pictures = set()
        for i, key in enumerate(keys):
            self.assertIn(f"\n  {key}: ", text)
            media = [{"type": "vdb", "file": str(path), "grid": key, "extinction": 1}]
            self.succeed("render", self.write("scene.json", scene(frames="1", media=media)), "-o", self.path(f"{i}.exr"),
                         "--samples", "1", "--png")
            pictures.add(self.path(f"{i}.png").read_bytes())
        self.assertEqual(len(pictures), 3, "each name is another grid")

    def test_a_volume_by_itself_is_a_scene_to_every_command(self):
        self.succeed("bake", self.write("recipe.json", recipe()), "-o", self.path("smoke.vdb"))
        smoke = self.path("smoke.vdb")
        result = self.succeed("render", smoke, "-o", self.path("a.exr"), "--res", "48x27", "--samples", "1")
        self.assertIn("a volume by itself", result.stderr)
        self.assertGreater(max(read_channels(self.path("a.exr"))["inscatter.R"]), 0.01, "there is light in the fog")
        self.assertIn("smoke.vdb", self.attributes("a.exr")["tyndall:command"])
        self.assertIn("density", self.succeed("info", smoke).stdout)
        self.succeed("check", smoke)
        for command in (("explain", smoke, "--pixel", "24,13", "--res", "48x27", "--modes", "none"),
                        ("plan", smoke, "--res", "48x27", "--target-error", "0.5"),
                        ("chart", smoke, "-o", self.path("chart"), "--quick", "--modes", "cone", "--res", "48x27")):
            self.succeed("--json", *command, timeout=200)
        again = self.succeed("render", smoke, "-o", self.path("a.exr"), "--res", "48x27", "--samples", "1", "--resume")
        self.assertIn("kept", again.stderr)

    def test_pictures(self):
        box = {"type": "homogeneous", "extinction": 0.1, "bounds": {"low": [-2, -2, -2], "high": [2, 2, 2]}}
        path = self.write("scene.json", scene(frames="5", media=[box]))
        self.succeed("render", path, "-o", self.path("out.exr"), "--crop", "8,4,40,20", "--seed", "3", "--aov", "Z")
        report = self.report(self.path("out.exr"))
        self.assertEqual((report["display"], report["low"], report["size"]), ([64, 36], [8, 4], [32, 16]))
        channels = {channel["name"]: channel for channel in report["channels"]}
        self.assertEqual(sorted(channels), ["A", "B", "G", "R", "Z"])
        self.assertEqual(report["attributes"]["tyndall:seed"], "3")
        self.assertEqual(report["attributes"]["tyndall:mode"], "march")
        self.assertGreater(channels["R"]["minimum"], 0)

    def test_scenes_and_recipes(self):
        report = self.report(self.write("scene.json", scene()))
        self.assertEqual((report["kind"], report["first_frame"], report["last_frame"]), ("scene", 1, 3))
        self.assertEqual([light["kind"] for light in report["lights"]], ["sun"])
        self.assertEqual([medium["kind"] for medium in report["media"]], ["homogeneous"])
        report = self.report(self.write("recipe.json", recipe()))
        self.assertEqual((report["kind"], report["voxels"]), ("recipe", [32, 16, 32]))
        for path in sorted([*(SOURCE / "scenes").glob("*.gltf"), *(SOURCE / "scenes").glob("*.glb")]):
            self.assertGreater(self.report(path)["triangles"], 0)

    def test_kinds_are_told_by_content_where_names_do_not_say(self):
        self.succeed("bake", self.write("recipe.json", recipe()), "-o", self.path("fog.vdb"))
        self.path("fog.vdb").rename(self.path("fog.cache"))
        self.assertEqual(self.report(self.path("fog.cache"))["kind"], "vdb")
        self.refuse(3, ["notes.txt"], "info", self.write("notes.txt", "some notes"))
        self.refuse(3, ["neither"], "info", self.write("other.json", {"name": "something else"}))

    def test_gltf(self):
        report = self.report(self.write("model.glb", glb(gltf(buffers=[{"byteLength": len(TRIANGLE)}]))))
        self.assertEqual((report["kind"], report["triangles"], report["lights"]), ("gltf", 1, []))
        self.assertEqual(report["bounds"], {"low": [0, 0, 0], "high": [1, 1, 0]})

    def units(self, *lights):
        names = [{"extensions": {"KHR_lights_punctual": {"light": i}}} for i in range(len(lights))]
        content = gltf(nodes=names, scenes=[{"nodes": list(range(len(lights)))}], meshes=[{"primitives": [
            {"attributes": {"POSITION": 0}}]}], buffers=[{"byteLength": len(TRIANGLE)}],
            extensionsUsed=["KHR_lights_punctual"], extensions={"KHR_lights_punctual": {"lights": list(lights)}})
        return self.report(self.write("lights.glb", glb(content)))["light_units"]

    def test_light_units_are_recognized_but_not_acted_on(self):
        watt = 1 / (4 * math.pi)
        self.assertIn("standard", self.units(lamp("point", 683 * 1000 * watt), lamp("directional", 683 * 3)))
        self.assertIn("unitless", self.units(lamp("point", 1000 * watt), lamp("directional", 3)))
        self.assertIn("raw", self.units(lamp("point", 1000), lamp("spot", 250)))
        self.assertEqual(self.units(lamp("point", 123.4567), lamp("point", 77.7777)), "")
        self.assertEqual(self.units(lamp("directional", 3.14159)), "")


if __name__ == "__main__":
    unittest.main()
