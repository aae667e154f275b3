"""Motion blur from a scene file to the picture, its parts, and what is refused."""
import json
import math
import struct
import unittest

from cli.exr import read_channels
from cli.program import TRIANGLE, ProgramTest, gltf, lit_scene, run

CAMERA = {"position": [0, 0.6, 3], "target": [0, 0.4, 0]}
HALF_FRAME = {"open": -0.25, "close": 0.25}
LAYERS = "Z,inscatter,transmittance,lights,ambient,variance"
LAMPS = [{"name": "swinging", "type": "spot", "position": [0, 1.5, 0], "outer_cone": 20, "intensity": 20,
          "target": {"keys": [[0, [-1, -0.5, 0]], [0.2, [1, -0.5, 0]]]}},
         {"name": "flash", "type": "point", "position": [0.4, 0.3, 0.3], "intensity": {"keys": [[0.12, 0], [0.2, 8]]}}]


class ShutterTest(ProgramTest):
    def scene(self, name="scene.json", shutter=None, **fields):
        camera = {**CAMERA, **({"shutter": shutter} if shutter else {})}
        return self.write(name, lit_scene(**{**dict(
            camera=camera, lights=LAMPS, ambient=[0.1, 0.1, 0.1], frames="3", frame_rate=24, resolution=[48, 27]), **fields}))

    def render(self, scene, name, *options):
        self.succeed("render", scene, "-o", self.path(name), "--frames", "3", "--float", "-q", *options)
        return read_channels(self.path(name))

    def test_closed_it_is_a_still(self):
        still = self.render(self.scene(), "still.exr")
        blurred = self.scene("blurred.json", HALF_FRAME)
        self.assertEqual(still, self.render(self.scene("closed.json", {"close": 0}), "closed.exr"))
        self.assertEqual(still, self.render(blurred, "off.exr", "--shutter", "0,0"))
        self.assertNotEqual(still, self.render(blurred, "blurred.exr"))
        self.assertEqual(self.render(blurred, "blurred.exr"), self.render(self.scene(), "asked.exr", "--shutter", "-0.25,0.25"))

    def test_moments_are_counted_and_said(self):
        scene = self.scene(shutter=HALF_FRAME)
        self.succeed("render", scene, "-o", self.path("a.exr"), "--stats-json", self.path("stats.json"), "-q")
        usual = json.loads(self.path("stats.json").read_text())["frames"][0]["time_samples"]
        self.assertGreaterEqual(usual, 4)
        self.assertEqual(self.render(scene, "a.exr"), self.render(scene, "b.exr", "--time-samples", usual))
        self.assertNotEqual(self.render(scene, "a.exr"), self.render(scene, "c.exr", "--time-samples", 3))
        said = self.succeed("render", scene, "-o", self.path("a.exr"), "-v")
        self.assertIn(f"motion blur of {usual} moments", said.stdout + said.stderr)

    def test_moments_of_a_still_are_said_to_change_nothing(self):
        said = self.succeed("render", self.scene(), "-o", self.path("a.exr"), "--frames", "3", "--time-samples", 8)
        self.assertIn("--time-samples has no effect", said.stderr)
        blurred = self.succeed("render", self.scene(shutter=HALF_FRAME), "-o", self.path("a.exr"), "--frames", "3", "--time-samples", 8)
        self.assertNotIn("has no effect", blurred.stderr)

    def test_targets_and_joints_blur_as_nodes_do(self):
        """A triangle in a beam that goes the same way by its node, by a morph target and by a joint of its skin."""
        way, times = [0.5, 0, 0], struct.pack("<2f", 0, 0.25)
        ends = struct.pack("<6f", 0, 0, 0, *way)
        data = (TRIANGLE + struct.pack("<9f", *3 * way) + times + ends + struct.pack("<2f", 0, 1) + bytes(12) +
                struct.pack("<12f", *3 * [1, 0, 0, 0]))
        views = [(0, 36, 3, "VEC3"), (36, 36, 3, "VEC3"), (72, 8, 2, "SCALAR"), (80, 24, 2, "VEC3"), (104, 8, 2, "SCALAR"),
                 (112, 12, 3, "VEC4"), (124, 48, 3, "VEC4")]
        whole = {"bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": size} for at, size, _, _ in views],
                 "accessors": [{"bufferView": i, "componentType": 5121 if size == 12 else 5126, "count": count, "type": kind}
                               for i, (_, size, count, kind) in enumerate(views)],
                 "buffers": [{"uri": "moving.bin", "byteLength": len(data)}]}
        self.path("moving.bin").write_bytes(data)

        def animation(node, path, output):
            return [{"channels": [{"sampler": 0, "target": {"node": node, "path": path}}], "samplers": [{"input": 2, "output": output}]}]

        def mesh(attributes=None, **more):
            return [{"primitives": [{"attributes": {"POSITION": 0, **(attributes or {})}, **more}]}]

        ways = {"node": dict(animations=animation(0, "translation", 3)),
                "target": dict(meshes=mesh(targets=[{"POSITION": 1}]), animations=animation(0, "weights", 4)),
                "joint": dict(meshes=mesh({"JOINTS_0": 5, "WEIGHTS_0": 6}), nodes=[{"mesh": 0, "skin": 0}, {}],
                              scenes=[{"nodes": [0, 1]}], skins=[{"joints": [1]}], animations=animation(1, "translation", 3))}
        scenes = {}
        for name, changes in ways.items():
            self.write(f"{name}.gltf", gltf(**whole, **changes))
            scenes[name] = self.scene(f"{name}.json", HALF_FRAME, gltf=f"{name}.gltf")
        for mode in ("march", "froxel", "shadow-map", "shadow-volume", "path"):
            pictures = {name: self.render(scene, f"{name}.exr", "--mode", mode, "--time-samples", 8, "--aov", "Z,inscatter")
                        for name, scene in scenes.items()}
            still = self.render(scenes["node"], "still.exr", "--mode", mode, "--shutter", "0,0")
            self.assertNotEqual(still["R"], pictures["node"]["R"], "it moves")
            for name, picture in pictures.items():
                for channel, values in pictures["node"].items():
                    for is_so, wanted in zip(picture[channel], values):
                        if math.isfinite(wanted):
                            self.assertAlmostEqual(is_so, wanted, delta=1e-4 * max(abs(wanted), 1e-2), msg=(mode, name, channel))

    def test_a_curve_weighs_the_moments(self):
        """Light that comes in late shows more of the flash, which grows."""
        early, even, late = (sum(self.render(self.scene(f"{i}.json", {**HALF_FRAME, "curve": curve}), f"{i}.exr",
                                             "--aov", "lights")["light_flash.R"])
                             for i, curve in enumerate(([1, 0], "box", [0, 1])))
        self.assertLess(early, even)
        self.assertLess(even, late)

    def test_bits_do_not_depend_on_threads(self):
        scene = self.scene(shutter=HALF_FRAME)
        for mode in ("march", "path", "froxel", "cone"):
            one = self.render(scene, "one.exr", "--mode", mode, "--threads", 1)
            self.assertEqual(one, self.render(scene, "two.exr", "--mode", mode, "--threads", 2), mode)

    def test_parts_make_the_bits_of_one_run_in_every_mode(self):
        scene = self.scene(shutter={**HALF_FRAME, "curve": "triangle"})
        for mode in json.loads(self.succeed("modes", "--json").stdout)["modes"]:
            plan, name = self.path("plan.json"), mode["name"]
            layers = LAYERS.replace(",variance", "") if name == "radial-blur" else LAYERS
            self.succeed("plan", scene, "--mode", name, "--save", plan, "-q", "--samples", 8, "--groups", 2,
                         "--aov", layers, "--float", "--frames", "3", "--shutter", "-0.5,0.5", "--time-samples", 6)
            self.succeed("render", "--plan", plan, "-o", self.path("one.exr"), "-q", "--threads", 1)
            if name in ("march", "froxel"):
                self.succeed("prepare", "--plan", plan, "-q")
            for part in (3, 1, 2):
                self.succeed("render", "--plan", plan, "-o", self.path("frame.exr"), "--part", f"{part}/3", "-q", "--threads", 2)
            self.succeed("merge", *sorted(self.directory.glob("frame.part-*")), "-o", self.path("merged.exr"), "-q")
            self.assertEqual(read_channels(self.path("one.exr")), read_channels(self.path("merged.exr")), name)
            self.succeed("prepare", "--plan", plan, "--clean-all", "-q")
            for file in (plan, *self.directory.glob("*.exr")):
                file.unlink()

    def test_an_error_is_reached_with_moments(self):
        scene = self.scene(shutter=HALF_FRAME)
        self.succeed("render", scene, "-o", self.path("a.exr"), "--frames", "3", "--target-error", 0.1, "--seed", 1,
                     "--stats-json", self.path("stats.json"), "-q")
        frame = json.loads(self.path("stats.json").read_text())["frames"][0]
        self.assertLessEqual(frame["error_bound"], 0.1)
        self.assertGreaterEqual(frame["time_samples"], 4)
        self.succeed("render", scene, "-o", self.path("truth.exr"), "--frames", "3", "--samples", 64, "--seed", 2, "-q")
        self.succeed("compare", self.path("a.exr"), self.path("truth.exr"), "--fail-above", "rmse_rel=0.1")

    def test_moments_are_added_for_an_error(self):
        """Fog that changes many times without going anywhere: how much that matters is not known beforehand."""
        self.write("boiling.json", {"bounds": {"low": [-1, 0, -1], "high": [1, 1, 1]}, "voxel_size": 0.1,
                                    "noise": {"octaves": 1, "scale": 0.4, "evolve": 100}, "density": {"threshold": 0.5, "gain": 8}})
        scene = self.scene(shutter=HALF_FRAME, lights=LAMPS[1:], resolution=[32, 18],
                           media=[{"type": "noise", "recipe": "boiling.json", "extinction": 8}])
        asked = ["render", scene, "-o", self.path("a.exr"), "--frames", "3", "--target-error", 0.1, "--stats-json",
                 self.path("stats.json")]

        def frame():
            return json.loads(self.path("stats.json").read_text())["frames"][0]

        self.assertEqual(run(*asked, "--time-samples", 8).returncode, 1, "as many as asked for")
        self.assertGreater(frame()["moments_error"], 0.1)
        self.assertEqual(frame()["time_samples"], 8)
        said = self.succeed(*asked, "-v")
        used = frame()["time_samples"]
        self.assertGreater(used, 8)
        self.assertLessEqual(frame()["error_bound"], 0.1)
        self.assertEqual(self.attributes("a.exr")["tyndall:timeSamples"], str(used))
        self.assertIn(f"needs {used} time samples", said.stdout + said.stderr)
        self.succeed("render", scene, "-o", self.path("truth.exr"), "--frames", "3", "--samples", 256, "--time-samples", 512,
                     "--seed", 2, "-q")
        self.succeed("compare", self.path("a.exr"), self.path("truth.exr"), "--fail-above", "rmse_rel=0.11")

        plan = self.path("plan.json")
        said = self.succeed("plan", scene, "--mode", "march", "--frames", "3", "--target-error", 0.1, "--save", plan)
        self.assertIn(f"needs {json.loads(plan.read_text())['time_samples']} time samples", said.stderr)
        run("render", "--plan", plan, "-o", self.path("planned.exr"), "--stats-json", self.path("stats.json"), "-q")
        self.assertLess(frame()["moments_error"], 0.07)
        self.succeed("compare", self.path("planned.exr"), self.path("truth.exr"), "--fail-above", "rmse_rel=0.11")

    def test_bad_shutters_are_refused_in_one_line(self):
        scene = self.scene()
        for text, why in (("0.5,0.25", "runs backwards"), ("nan,1", "--shutter"), ("0", "OPEN,CLOSE"), ("0,1000", "--shutter"),
                          ("a,b", "--shutter")):
            self.refuse(2, ["--shutter", why], "render", scene, "-o", self.path("a.exr"), "--shutter", text)
        self.refuse(2, ["--time-samples"], "render", scene, "-o", self.path("a.exr"), "--time-samples", "0")
        self.refuse(2, ["--history", "shutter"], "render", self.scene(shutter=HALF_FRAME), "-o", self.path("a.exr"),
                    "--mode", "froxel", "--history", 4, "-q")
        for shutter, why in (({"open": 1, "close": 0}, "closes before it opens"), ({"open": 0}, "close"),
                             ({"close": 1e9}, "100"), ({"close": 1, "curve": [0, 0]}, "no light"),
                             ({"close": 1, "curve": "gauss"}, "curve")):
            self.refuse(3, ["/camera/shutter", why], "render", self.scene("bad.json", shutter), "-o", self.path("a.exr"))


if __name__ == "__main__":
    unittest.main()
