"""IES profiles, gobos and units of lights through the program: real files, projected pictures, glTF, refusals."""
import base64
import math
import resource
import struct
import unittest
import zlib

from cli.exr import read_channels
from cli.program import ProgramTest, corpus, glb, run, scene

# Zonal sums, or what the laboratory says, of the files that are there.
LUMENS = {"6.ies": 3062, "12.IES": 33.1, "light.ies": 232, "profile.ies": 4777, "02a7.ies": 9600, "00c6.ies": 2044,
          "1aec.ies": 2342, "108b.ies": 40.0, "1a93.ies": 2438, "1.IES": 9217.18, "2.IES": 5834.2, "6.IES": 9230.16,
          "7.IES": 531.98, "examp1.ies": 5297}
HALF_SPHERE = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n50 50\n"


def png(size, pixel):
    """A gray PNG; pixel(x, y) of 0..255."""
    def part(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    rows = b"".join(b"\0" + bytes(pixel(x, y) for x in range(size[0])) for y in range(size[1]))
    return (b"\x89PNG\r\n\x1a\n" + part(b"IHDR", struct.pack(">IIBBBBB", *size, 8, 0, 0, 0, 0)) +
            part(b"IDAT", zlib.compress(rows)) + part(b"IEND", b""))


def letter_f(x, y):
    """An F on 8 x 8: upright at the left, arms at the top and in the middle."""
    return 255 if x in (1, 2) or y in (0, 1) and x >= 1 or y in (3, 4) and 1 <= x <= 5 else 0


def wall(half=2):
    """A white wall across -Z at z = -4, facing +Z."""
    corners = [(-half, -half, -4), (half, -half, -4), (half, half, -4), (-half, half, -4)]
    binary = b"".join(struct.pack("<3f", *corner) for corner in corners) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    return {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                       "min": [-half, -half, -4], "max": [half, half, -4]},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64," + base64.b64encode(binary).decode()}],
    }


class Lamps(ProgramTest):
    def projected(self, light, size=(32, 32), **changes):
        """The wall as a camera beside the light at the origin sees it: R of its surface, as rows."""
        self.write("wall.gltf", wall())
        spot = {"name": "spot", "type": "spot", "position": [0, 0, 0], "direction": [0, 0, -1], "inner_cone": 40, "outer_cone": 40,
                "intensity": 100, **light}
        camera = {"position": [0, 0, 0], "target": [0, 0, -1], "vertical_fov": 53.13010235415598}  # the wall, edge to edge
        content = scene(frames="1", resolution=list(size), camera=camera, gltf="wall.gltf", gltf_lights=False, lights=[spot],
                        media=[], background={"color": 0}, **changes)
        self.succeed("render", self.write("scene.json", content), "-o", self.path("out.exr"), "--samples", "16", "--float")
        values = read_channels(self.path("out.exr"))["R"]
        return [list(values[row * size[0]:(row + 1) * size[0]]) for row in range(size[1])]

    def test_lumens_of_real_files(self):
        checked = 0
        for path in corpus("ies/*/*.ies", "ies/*/*.IES"):
            report = self.info(path)
            self.assertEqual(report["kind"], "ies")
            self.assertIn("candela", self.succeed("info", path).stdout)
            if path.name in LUMENS:
                self.assertAlmostEqual(report["lumens"] / LUMENS[path.name], 1, delta=0.01, msg=path)
                checked += 1
        self.assertGreaterEqual(checked, 4)

    def test_the_line_for_a_scene_is_one(self):
        path = self.write("lamp.ies", HALF_SPHERE)
        light = self.info(path)["scene"]
        self.write("scene.json", "{\"tyndall\": 1, \"lights\": [" + light + "]}")
        [found] = self.info("scene.json")["lights"]
        self.assertEqual((found["intensity"], found["unit"], found["profile"]), (50, "candela", True))

    def test_damaged_files_are_refused_in_one_line(self):
        def little_memory():
            resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
        for words, text in [("TILT=", "nonsense\n"), ("ends before", HALF_SPHERE[:-4]), ("room for", HALF_SPHERE.replace(" 2 1 1 2", " 1000000000 1 1 2")),
                            ("room for", HALF_SPHERE.replace(" 2 1 1 2", " 2 1000000000 1 2")), ("expected a candela value", HALF_SPHERE.replace("50 50", "nan 50")),
                            ("photometric type", HALF_SPHERE.replace(" 2 1 1 2", " 2 1 9 2")), ("no light", HALF_SPHERE.replace("50 50", "0 0"))]:
            path = self.write("bad.ies", text)
            self.refuse(3, ["bad.ies", words], "info", path, preexec_fn=little_memory)
            lights = [{"type": "point", "position": [0, 1, 0], "ies": {"file": "bad.ies"}}]
            self.refuse(3, ["bad.ies", words], "info", self.write("scene.json", scene(lights=lights)), preexec_fn=little_memory)

    def test_a_gobo_stands_on_the_wall_as_it_is_drawn(self):
        # Both camera and light look along -Z with +Y up: the wall shows the picture, 8 x 8 blocks of 4 x 4 pixels.
        self.write("f.png", png((64, 64), lambda x, y: letter_f(x // 8, y // 8)))
        half = math.degrees(math.atan(0.5))  # the picture is as wide as the wall
        cone = {"inner_cone": half, "outer_cone": half, "gobo": {"image": "f.png", "color_space": "linear"}}
        rows = self.projected(cone)
        for y in range(8):
            for x in range(8):
                lit = (sum(rows[4 * y + j][4 * x + i] for j in (1, 2) for i in (1, 2)) / 4)
                ray = ((x - 3.5) / 8, (3.5 - y) / 8)  # x and y over -z, to the middle of the block
                within = math.hypot(*ray) < 0.5 - 0.06
                square = ray[0] ** 2 + ray[1] ** 2 + 1
                expected = 100 / 16 / square ** 1.5 / math.pi if letter_f(x, y) and within else 0
                if within or math.hypot(*ray) > 0.56:
                    self.assertAlmostEqual(lit, expected, delta=0.03 * (100 / 16 / math.pi), msg=(x, y))
        # Turned by 180 degrees the foot of the F points up and its arms to the left.
        turned = self.projected({**cone, "gobo": {**cone["gobo"], "rotate": 180}})
        for y in range(8, 24):
            for x in range(8, 24):
                if letter_f((31 - x) // 4, (31 - y) // 4) == letter_f((31 - x - 1) // 4, (31 - y - 1) // 4):
                    self.assertAlmostEqual(turned[y][x], rows[31 - y][31 - x], delta=0.02 * 2)

    def test_numbered_gobos_follow_the_frames(self):
        for frame, value in ((1, 255), (2, 51)):
            self.write(f"g.{frame:04}.png", png((4, 4), lambda x, y: value))
        gobo = {"image": "g.####.png", "color_space": "linear", "sequence": {"mode": "loop"}}
        means = {}
        for frame in (1, 2, 3):
            rows = self.projected({"gobo": gobo})
            content = self.path("scene.json").read_text().replace('"frames": "1"', f'"frames": "{frame}"')
            self.succeed("render", self.write("scene.json", content), "-o", self.path("f.exr"), "--samples", "1")
            means[frame] = sum(read_channels(self.path("f.exr"))["R"])
            self.assertEqual(len(rows), 32)
        self.assertAlmostEqual(means[2] / means[1], 0.2, delta=0.01)
        self.assertAlmostEqual(means[3], means[1], delta=0.01 * means[1])
        # Damaged ones are found by check, and named.
        text = self.path("scene.json").read_text().replace('"frames": "3"', '"frames": "1-2"')
        self.path("g.0002.png").write_bytes(b"no picture")
        result = run("check", self.write("scene.json", text))
        self.assertIn("g.0002.png", result.stdout + result.stderr)
        self.assertNotEqual(result.returncode, 0)

    def test_gltf_lights_of_photometric_files(self):
        self.write("half.ies", HALF_SPHERE)
        lamp = {"name": "lamp", "extensions": {"EXT_lights_ies": {"light": 0, "multiplier": 2, "color": [1, 0.5, 0.25]}}}
        content = {**wall(), "nodes": [{"mesh": 0}, lamp], "scenes": [{"nodes": [0, 1]}], "extensionsUsed": ["EXT_lights_ies"],
                   "extensionsRequired": ["EXT_lights_ies"], "extensions": {"EXT_lights_ies": {"lights": [{"uri": "half.ies"}]}}}
        path = self.write("lamp.gltf", content)
        [light] = self.info(path)["lights"]
        self.assertEqual((light["name"], light["intensity"], light["color"]), ("lamp", 100, [1, 0.5, 0.25]))
        self.write("scene.json", scene(frames="1", resolution=[8, 8], gltf="lamp.gltf", lights=[], media=[], background={"color": 0},
                                       camera={"position": [0, 0, 0], "target": [0, 0, -1], "vertical_fov": 20}))
        self.succeed("render", self.path("scene.json"), "-o", self.path("a.exr"), "--samples", "4", "--float")
        self.assertAlmostEqual(read_channels(self.path("a.exr"))["R"][27], 100 / 16 / math.pi, delta=0.05)
        # The same in the buffer; broken ones name their place.
        view = {"buffer": 0, "byteLength": len(HALF_SPHERE)}
        inside = {**content, "bufferViews": [view], "buffers": [{"byteLength": len(HALF_SPHERE)}], "meshes": [], "accessors": [],
                  "nodes": [lamp], "scenes": [{"nodes": [0]}]}
        for key in ("meshes", "accessors"):
            del inside[key]
        inside["extensions"] = {"EXT_lights_ies": {"lights": [{"bufferView": 0, "mimeType": "application/x-ies-lm-63"}]}}
        self.write("lamp.glb", glb(inside, HALF_SPHERE.encode()))
        self.assertEqual(self.info("lamp.glb")["lights"][0]["intensity"], 100)
        content["extensions"]["EXT_lights_ies"]["lights"] = [{}]
        self.refuse(3, ["EXT_lights_ies/lights/0", "uri"], "info", self.write("lamp.gltf", content))
        content["nodes"][1] = {"extensions": {"EXT_lights_ies": {"light": 4}}}
        self.refuse(3, ['index into "lights" of EXT_lights_ies'], "info", self.write("lamp.gltf", content))

    def test_march_agrees_with_paths(self):
        self.write("board.png", png((32, 32), lambda x, y: 255 if (x // 4 + y // 4) % 2 else 10))
        lights = [{"name": "spot", "type": "spot", "position": [-1, 2, 0], "target": [0.2, 0, 0], "inner_cone": 20, "outer_cone": 25,
                   "intensity": 2000, "unit": "lumen", "temperature": 3200, "gobo": {"image": "board.png"}}]
        media = [{"type": "homogeneous", "extinction": 0.3, "g": 0.3, "bounds": {"low": [-2, -2, -2], "high": [2, 2, 2]}}]
        path = self.write("scene.json", scene(frames="1", resolution=[24, 16], lights=lights, media=media, background={"color": 0}))
        mean = {}
        for mode, samples in (("march", 16), ("path", 256)):
            self.succeed("render", path, "-o", self.path(f"{mode}.exr"), "--mode", mode, "--orders", "1", "--samples", samples, "--float")
            mean[mode] = [sum(read_channels(self.path(f"{mode}.exr"))[c]) for c in "RGB"]
        for march, traced in zip(mean["march"], mean["path"]):
            self.assertAlmostEqual(march / traced, 1, delta=0.01)

    def test_a_rectangle_shows_its_picture_to_who_looks_at_it(self):
        self.write("f.png", png((64, 64), lambda x, y: letter_f(x // 8, y // 8)))
        screen = {"name": "screen", "type": "rectangle", "position": [0, 0, -4], "direction": [0, 0, 1], "width": 2, "height": 2,
                  "intensity": 50, "gobo": {"image": "f.png", "color_space": "linear"}}
        for mode in ("march", "path", "froxel"):
            content = scene(frames="1", resolution=[32, 32], lights=[screen], media=[], background={"color": 0},
                            camera={"position": [0, 0, 0], "target": [0, 0, -1], "vertical_fov": 28.072486935852957})
            self.succeed("render", self.write("scene.json", content), "-o", self.path("a.exr"), "--mode", mode, "--samples", "4", "--float")
            values = read_channels(self.path("a.exr"))["R"]
            for y in range(8):
                for x in range(8):
                    for pixel in ((4 * y + 1) * 32 + 4 * x + 1, (4 * y + 2) * 32 + 4 * x + 2):
                        self.assertAlmostEqual(values[pixel], 50 if letter_f(x, y) else 0, delta=0.1, msg=(mode, x, y))
        for name in ("rotate", "scale"):
            bad = {**screen, "gobo": {**screen["gobo"], name: 2}}
            self.refuse(3, [f"/lights/0/gobo/{name}", "spot"], "info", self.write("bad.json", scene(lights=[bad])))
        disc = {key: value for key, value in screen.items() if key not in ("width", "height")}
        self.refuse(3, ["/lights/0/gobo", "rectangles"], "info",
                    self.write("bad.json", scene(lights=[{**disc, "type": "disc", "radius": 1}])))

    def test_pictures_of_rectangles_follow_the_frames(self):
        for frame, value in ((1, 255), (2, 51)):
            self.write(f"g.{frame:04}.png", png((4, 4), lambda x, y: value))
        gobo = {"image": "g.####.png", "color_space": "linear", "sequence": {"mode": "loop"}}
        screen = {"type": "rectangle", "position": [0, 0, -4], "direction": [0, 0, 1], "width": 9, "height": 9, "intensity": 10}
        path = self.write("scene.json", scene(frames="1-3", resolution=[8, 8], lights=[{**screen, "gobo": gobo}], media=[],
                                              background={"color": 0},
                                              camera={"position": [0, 0, 0], "target": [0, 0, -1], "vertical_fov": 20}))
        self.succeed("render", path, "-o", self.path("f.####.exr"), "--samples", "1", "--float")
        for frame, expected in ((1, 10), (2, 2), (3, 10)):
            self.assertAlmostEqual(read_channels(self.path(f"f.{frame:04}.exr"))["R"][27], expected, delta=0.01)

    def test_march_agrees_with_paths_at_a_screen(self):
        self.write("board.png", png((32, 32), lambda x, y: 255 if (x // 8 + y // 8) % 2 else 10))
        lights = [{"name": "screen", "type": "rectangle", "position": [-0.5, 0.5, -1], "direction": [0.3, -0.2, 1], "width": 1.6,
                   "height": 0.9, "intensity": 20, "color": [1, 0.6, 0.3], "gobo": {"image": "board.png"}}]
        media = [{"type": "homogeneous", "extinction": 0.3, "g": 0.3, "bounds": {"low": [-2, -2, -2], "high": [2, 2, 2]}}]
        path = self.write("scene.json", scene(frames="1", resolution=[24, 16], lights=lights, media=media, background={"color": 0}))
        mean = {}
        for mode, samples in (("march", 16), ("path", 256)):
            self.succeed("render", path, "-o", self.path(f"{mode}.exr"), "--mode", mode, "--orders", "1", "--samples", samples,
                         "--float", "--aov", "inscatter")
            mean[mode] = [sum(read_channels(self.path(f"{mode}.exr"))[f"inscatter.{c}"]) for c in "RGB"]
        for march, traced in zip(mean["march"], mean["path"]):
            self.assertAlmostEqual(march / traced, 1, delta=0.01)

    def test_a_huge_gobo_is_refused(self):
        data = bytearray(png((1, 1), lambda x, y: 255))
        data[16:24] = struct.pack(">II", 16384, 16384)
        self.write("huge.png", bytes(data))
        lights = [{"type": "spot", "position": [0, 1, 0], "direction": [0, -1, 0], "intensity": 1, "gobo": {"image": "huge.png"}}]
        self.refuse(3, ["/lights/0/gobo/image", "8192"], "info", self.write("scene.json", scene(lights=lights)))


if __name__ == "__main__":
    unittest.main()
