"""PNGs: neither white nor black without a word said about exposure, alike in all parts of a sequence, and honest about
how they were made."""
import json
import unittest

from PIL import Image

from cli.exr import read_channels
from cli.program import ProgramTest, gltf, scene


def pixels(path):
    return list(Image.open(path).convert("RGB").getdata())


def mean(path):
    """Of what is not black."""
    codes = [sum(pixel) / 3 for pixel in pixels(path) if sum(pixel) > 15]
    return sum(codes) / len(codes)


def srgb(x):
    x = min(max(x, 0), 1)
    return 255 * (12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055)


class Pngs(ProgramTest):
    def setUp(self):
        super().setUp()
        self.film = self.write("scene.json", scene())

    def render(self, name, *options, film=None):
        self.succeed("render", film or self.film, "-o", self.path(name), "--frames", "1", "--quality", "draft", "-q",
                     "--png", *options)
        return self.path(name).with_suffix(".png")

    def test_the_sun_in_lux_is_as_bright_through_a_scene_file_as_alone(self):
        self.write_triangle()
        sun = {"extensionsUsed": ["KHR_lights_punctual"],
               "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 70000}]}},
               "nodes": [{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
               "scenes": [{"nodes": [0, 1]}]}
        model = self.write("room.gltf", gltf(**sun))
        fog = [{"type": "homogeneous", "extinction": 0.3, "bounds": {"low": [-1, -1, -1], "high": [2, 2, 1]}}]
        film = self.write("room.json", scene(gltf="room.gltf", lights=[], media=fog, background={"color": 900}))
        for name, one in (("model.exr", model), ("film.exr", film)):
            png = self.render(name, film=one)
            self.assertGreater(mean(png), 40, name)
            self.assertLess(mean(png), 200, name)
            self.assertLess(float(Image.open(png).text["tyndall:exposure"]), -8)

    def test_brightness_does_not_depend_on_the_unit_of_light(self):
        codes = []
        for factor in (1e-3, 1, 1e4):
            bright = scene()
            bright["lights"][0]["intensity"] *= factor
            bright["background"] = {"color": [factor * value for value in (0.1, 0.2, 0.3)]}
            codes.append(mean(self.render(f"{factor}.exr", film=self.write(f"{factor}.json", bright))))
        self.assertLess(max(codes) - min(codes), 2.5)  # exposures are in tenths of stops

    def test_parts_of_a_sequence_match(self):
        keys = {"keys": [[0, 0], [0.04, 1], [0.125, 40]]}
        fading = scene()
        fading["lights"][0]["intensity"] = keys
        film = self.write("fading.json", fading)
        self.succeed("render", film, "-o", self.path("all.####.exr"), "-q", "--png", "--stats-json", self.path("s.json"))
        for frame in (1, 2, 3):
            self.succeed("render", film, "-o", self.path("one.####.exr"), "-q", "--png", "--frames", frame, "--quality",
                         "preview")
            name = f"{frame:04}.png"
            self.assertEqual(self.path("one." + name).read_bytes(), self.path("all." + name).read_bytes())
        stats = json.loads(self.path("s.json").read_text())
        self.assertTrue(stats["automatic_exposure"])
        self.assertEqual(stats["view_transform"], "filmic")
        used = {frame["exposure"] for frame in stats["frames"]}
        self.assertEqual(used, {float(Image.open(self.path("all.0001.png")).text["tyndall:exposure"])})

    def test_srgb_shows_values_as_they_are(self):
        png = self.render("a.exr", "--view-transform", "srgb", "--exposure", "1", "--float")
        channels = read_channels(self.path("a.exr"))
        for codes, values in zip(pixels(png), zip(*(channels[name] for name in "RGB"))):
            for code, value in zip(codes, values):
                self.assertAlmostEqual(code, srgb(2 * value), delta=1)
        self.assertEqual(Image.open(png).text, {"tyndall:exposure": "1", "tyndall:viewTransform": "srgb"})

    def test_what_sets_the_exposure(self):
        stated = self.write("stated.json", scene(exposure=-1.5))
        used = lambda *options, **more: Image.open(self.render("b.exr", *options, **more)).text["tyndall:exposure"]
        self.assertEqual(used(film=stated), "-1.5")
        self.assertEqual(used("--exposure", "2", film=stated), "2")
        self.assertEqual(used("--exposure", "auto", film=stated), used())

    def test_light_in_the_exr_does_not_change(self):
        files = []
        for options in ((), ("--exposure", "3"), ("--view-transform", "srgb")):
            self.render("c.exr", *options)
            files.append(self.path("c.exr").read_bytes())
        self.succeed("render", self.film, "-o", self.path("c.exr"), "--frames", "1", "--quality", "draft", "-q")
        files.append(self.path("c.exr").read_bytes())
        self.assertEqual(len(set(files)), 1)

    def test_modes_side_by_side_have_one_exposure(self):
        self.succeed("render", self.film, "-o", self.path("d.exr"), "--frames", "1", "-q", "--png", "--mode",
                     "march,path", "--samples", "4")
        names = ("d.march.png", "d.path.png", "d.modes.png")
        self.assertEqual(len({Image.open(self.path(name)).text["tyndall:exposure"] for name in names}), 1)

    def test_fog_that_is_missing_is_still_said(self):
        film = self.write("gone.json", scene(media=[{"type": "vdb", "file": "fog.####.vdb"}]))
        self.refuse(4, ["fog"], "render", film, "-o", self.path("e.exr"), "--frames", "1", "--png", "-q")


if __name__ == "__main__":
    unittest.main()
