"""Files that a light or a medium names, damaged or absurd, and numbers beyond all sense: one line, or a stated repair."""
import json
import math
import random
import unittest

from cli.exr import read_channels
from cli.program import ProgramTest, corpus, lit_scene, recipe, run

SMALL = ("--res", "16x9", "--samples", 4)


def radiance_file(texels, header="", size=(8, 4)):
    """A Radiance file without runs, of mantissas and exponents."""
    head = f"#?RADIANCE\n{header}FORMAT=32-bit_rle_rgbe\n\n-Y {size[1]} +X {size[0]}\n"
    return head.encode() + b"".join(map(bytes, texels))


class BadData(ProgramTest):
    def refuse_scene(self, words, content, code=3):
        path = self.write("scene.json", content)
        self.refuse(code, words, "render", path, "-o", self.path("out.exr"), *SMALL)

    def render(self, content, *options):
        """What is said, and the picture, which is finite."""
        told = self.succeed("render", self.write("scene.json", content), "-o", self.path("out.exr"), "--float", *SMALL, *options).stderr
        picture = read_channels(self.path("out.exr"))
        self.assertTrue(all(math.isfinite(value) for name in "RGBA" for value in picture[name]), told)
        return told, picture

    def test_photometry_cut_anywhere(self):
        chance = random.Random(3)
        for path in corpus("ies/*/*.ies", "ies/*/*.IES"):
            whole = path.read_bytes()
            last = len(whole.rstrip().rsplit(None, 1)[0])  # where the last number begins
            for length in (0, chance.randrange(last), chance.randrange(last), last):
                with self.subTest(path=path.name, length=length):
                    self.refuse(3, ["cut.ies"], "info", self.write("cut.ies", whole[:length]))

    def test_photometry_with_bytes_of_chance(self):
        chance, refused = random.Random(5), 0
        for path in corpus("ies/*/*.ies", "ies/*/*.IES"):
            for _ in range(3):
                data = bytearray(path.read_bytes())
                for _ in range(5):
                    data[chance.randrange(len(data))] = chance.randrange(256)
                result = run("info", self.write("noise.ies", bytes(data)))
                if result.returncode:
                    self.check_refusal(result, 3, "noise.ies")
                    refused += 1
        self.assertGreater(refused, 0)

    def sky(self, texels, header="", size=(8, 4)):
        self.write("sky.hdr", radiance_file(texels, header, size))
        return lit_scene(lights=[{"name": "sky", "type": "environment", "image": "sky.hdr"}])

    def test_environment_maps_at_the_end_of_floats(self):
        gray, brightest = (128, 128, 128, 128), (255, 255, 255, 255)  # 0.5 and 1.7e38
        for mode in ("march", "path", "froxel"):
            self.render(self.sky([gray] * 31 + [brightest]), "--mode", mode, "--orders", 1)
        self.refuse_scene(["scene.json", "light sky", "overflows"], self.sky([brightest] * 32))
        for header in ("EXPOSURE=nan\n", "EXPOSURE=-1\n", "EXPOSURE=0\n", "COLORCORR=1 1\n"):
            self.refuse_scene(["/lights/0/image", "sky.hdr", header.strip()], self.sky([gray] * 32, header))
        self.refuse_scene(["/lights/0/image", "40000x20000"], self.sky([], size=(40000, 20000)))
        self.refuse_scene(["/lights/0/image", "truncated"], self.sky([gray] * 31))
        self.assertIn("sky.hdr: the image is black", self.render(self.sky([(0, 0, 0, 0)] * 32))[0])

    def test_gobos_that_are_too_large(self):
        self.write("gobo.hdr", radiance_file([], size=(16384, 16384)))
        spot = {"type": "spot", "position": [0, 3, 0], "direction": [0, -1, 0], "intensity": 5, "gobo": {"image": "gobo.hdr"}}
        self.refuse_scene(["/lights/0/gobo/image", "16384x16384", "4096"], lit_scene(lights=[spot]))

    def test_temperatures_of_lights(self):
        lamp = {"type": "point", "position": [0, 2, 0], "intensity": 5}
        for value in (1e9, -5, 0, "hot", None):
            self.refuse_scene(["/lights/0/temperature"], lit_scene(lights=[{**lamp, "temperature": value}]))
        self.refuse_scene(["/lights/0/temperature/keys/1/1"], lit_scene(lights=[{**lamp, "temperature": {"keys": [[0, 1000], [1, 1e9]]}}]))
        self.refuse_scene(["scene.json", "line 1"], json.dumps(lit_scene(lights=[{**lamp, "temperature": math.nan}])))

    def test_temperatures_of_fire(self):
        fire = {"base": [0, 0, 0], "height": 0.8, "radius": 0.3, "noise": {"octaves": 2, "scale": 0.2}}
        self.succeed("bake", self.write("fire.json", recipe(fire=fire)), "-o", self.path("fire.vdb"), "-q")

        def burning(blackbody=None, **grid):
            grids = {"temperature": {"grid": "temperature", **grid}}
            return lit_scene(media=[{"type": "vdb", "file": "fire.vdb", "extinction": 2, "grids": grids,
                                     "blackbody": {"convention": "kelvin", **(blackbody or {})}}])
        self.assertGreater(max(self.render(burning())[1]["R"]), 100)
        for change in ({"scale": 1e9}, {"offset": 1e9}, {"remap": [[0, 0], [1, 1e9]]}):
            self.assertIn("above 65504 clamped to it", self.render(burning(**change))[0])
        self.assertIn("negative voxels set to 0", self.render(burning(scale=-1))[0])
        for words, change in ((["scale"], {"scale": 1e30}), (["clamp/1"], {"clamp": [5000, 0]}), (["remap/1/0"], {"remap": [[1, 2], [0, 3]]})):
            self.refuse_scene([f"/media/0/grids/temperature/{words[0]}"], burning(**change))
        self.refuse_scene(["/media/0/blackbody/emission_scale"], burning({"emission_scale": 1e30}))
        self.refuse_scene(["fire.vdb", "has no grid \"heat\"", "temperature"], burning(grid="heat"))
        self.refuse_scene(["/media/0/grids/temperature/file", "gone.vdb"], burning(file="gone.vdb"), 4)

    def test_shutters(self):
        for words, shutter in ((["", "closes before it opens"], {"open": 0.5, "close": -0.5}), (["/close", "100"], {"close": 1e9}),
                               (["/open", "-100"], {"open": -1e9}), (["/curve"], {"close": 1, "curve": [0, 0]}),
                               (["/curve/0"], {"close": 1, "curve": [-1, 1]}), (["/curve"], {"close": 1, "curve": [1] * 100000})):
            camera = {"position": [0, 0.6, 3], "target": [0, 0.4, 0], "shutter": shutter}
            self.refuse_scene(["/camera/shutter" + words[0], *words[1:]], lit_scene(camera=camera))
        scene = self.write("scene.json", lit_scene())
        for value in ("0.5,-0.5", "nan,1", "0", "1,2,3", "-inf,inf"):
            self.refuse(2, ["--shutter"], "render", scene, "-o", self.path("out.exr"), f"--shutter={value}")


if __name__ == "__main__":
    unittest.main()
