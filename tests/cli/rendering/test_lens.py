"""Depth of field from a scene file to the picture, and parts of one."""
import json
import unittest

from cli.exr import read_channels
from cli.program import ProgramTest, lit_scene

CAMERA = {"position": [0, 0.6, 3], "target": [0, 0.4, 0]}
LAMPS = [{"name": name, "type": "point", "position": place, "intensity": 2}
         for name, place in (("near", [-0.5, 0.5, 0.9]), ("far", [0.5, 0.5, -0.9]))]


class LensTest(ProgramTest):
    def scene(self, name="scene.json", **lens):
        return self.write(name, lit_scene(camera={**CAMERA, **lens}, lights=LAMPS, resolution=[48, 27]))

    def render(self, scene, name, *options):
        self.succeed("render", scene, "-o", self.path(name), "--frames", "1", "--float", "-q", *options)
        return read_channels(self.path(name))

    def test_no_lens_is_a_pinhole(self):
        plain = self.render(self.scene(), "plain.exr", "--samples", 4)
        closed = self.render(self.scene("closed.json", aperture_radius=0, focus_distance=2), "closed.exr", "--samples", 4)
        self.assertEqual(plain, closed)
        self.assertNotEqual(plain, self.render(self.scene("open.json", aperture_radius=0.1), "open.exr", "--samples", 4))

    def test_parts_make_the_bits_of_one_run(self):
        scene = self.scene(aperture_radius=0.1, aperture_blades=5)
        for mode in ("march", "path", "froxel", "cone"):
            plan = self.path("plan.json")
            self.succeed("plan", scene, "--mode", mode, "--save", plan, "-q", "--samples", 16, "--groups", 4,
                         "--aov", "Z,inscatter,variance", "--float")
            self.succeed("render", "--plan", plan, "-o", self.path("one.exr"), "-q", "--threads", 1)
            for part in (3, 1, 2):
                self.succeed("render", "--plan", plan, "-o", self.path("frame.exr"), "--part", f"{part}/3", "-q", "--threads", 2)
            self.succeed("merge", *sorted(self.directory.glob("frame.part-*")), "-o", self.path("merged.exr"), "-q")
            self.assertEqual(read_channels(self.path("one.exr")), read_channels(self.path("merged.exr")), mode)
            for file in (plan, *self.directory.glob("*.exr")):
                file.unlink()

    def test_the_header_says_what_is_in_focus(self):
        self.render(self.scene(aperture_radius=0.1, focus_distance=2.5), "lens.exr", "--samples", 1)
        self.assertIn(b"focus\0float\0", self.path("lens.exr").read_bytes())

    def test_explain_goes_through_the_middle(self):
        scene = self.scene(aperture_radius=0.3)
        told = [json.loads(self.succeed("explain", file, "--pixel", "20,10", "--json").stdout)
                for file in (scene, self.scene("plain.json"))]
        self.assertEqual(told[0]["origin"], told[1]["origin"])
        self.assertEqual(told[0]["direction"], told[1]["direction"])


if __name__ == "__main__":
    unittest.main()
