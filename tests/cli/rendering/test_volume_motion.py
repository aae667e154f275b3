"""Volumes that move while the shutter is open, from files to the picture and its parts, and what is refused."""
import json
import math
import unittest

from cli.exr import read_channels
from cli.program import CORPORA, ProgramTest, lit_scene, recipe

SHUTTER = {"open": -3, "close": 3}  # of frames of 1/24 s, in a wind of half a meter per second: four voxels of 1/16 m
VELOCITY = {"grids": {"velocity": "vel"}}


def rms(a, b):
    return (sum((x - y) ** 2 for x, y in zip(a, b)) / len(a)) ** 0.5


class VolumeMotion(ProgramTest):
    def setUp(self):
        super().setUp()
        self.recipe = self.write("dust.json", recipe())
        self.succeed("bake", self.recipe, "-o", self.path("dust.####.vdb"), "--frames", "1-3", "--velocity", "-q")

    def scene(self, name, medium, shutter=SHUTTER, **fields):
        camera = {"position": [0, 0.5, 3], "target": [0, 0.5, 0], **({"shutter": shutter} if shutter else {})}
        medium = {"type": "vdb", "file": "dust.0002.vdb", "extinction": 2, **medium}
        return self.write(name, lit_scene(**{**dict(camera=camera, media=[medium], frames="2", frame_rate=24, resolution=[48, 27]),
                                             **fields}))

    def render(self, scene, name, *options):
        self.succeed("render", scene, "-o", self.path(name), "--frames", "2", "--float", "--background", "off", "-q", *options)
        return read_channels(self.path(name))

    def test_velocity_moves_a_file_as_its_recipe_moves(self):
        """In the middle of the picture, where nothing comes in from beyond the recipe's bounds."""
        shutter = {"open": 0, "close": 12}  # four voxels
        grown = self.scene("grown.json", {"type": "noise", "recipe": "dust.json"}, shutter)
        text = json.loads(grown.read_text())
        del text["media"][0]["file"]
        grown.write_text(json.dumps(text))

        def middle(scene, *options):
            alpha = self.render(scene, "a.exr", *options)["A"]
            return [alpha[y * 48 + x] for y in range(9, 18) for x in range(18, 30)]
        for mode in ("march", "froxel", "path"):
            options = ("--mode", mode, "--samples", 64 if mode != "path" else 256, "--orders", 1)
            truth = middle(grown, *options)
            moved = middle(self.scene("moved.json", VELOCITY, shutter), *options)
            still = middle(self.scene("still.json", {}, shutter), *options)
            self.assertLess(rms(moved, truth), 0.4 * rms(still, truth), mode)

    def test_unit_and_scale(self):
        second = self.render(self.scene("second.json", VELOCITY), "second.exr")
        frame = self.render(self.scene("frame.json", {**VELOCITY, "velocity_unit": "frame", "velocity_scale": 1 / 24}), "frame.exr")
        none = self.render(self.scene("none.json", {**VELOCITY, "velocity_scale": 0}), "none.exr")
        self.assertLess(rms(second["A"], frame["A"]), 1e-3)
        self.assertEqual(none, self.render(self.scene("still.json", {}, shutter=None), "still.exr"))

    def test_closed_it_is_a_still(self):
        still = self.render(self.scene("still.json", {}, shutter=None), "still.exr")
        self.assertEqual(still, self.render(self.scene("closed.json", VELOCITY, shutter=None), "closed.exr"))
        blend = {"file": "dust.####.vdb", "sequence": {"blend": True}}
        self.assertEqual(still, self.render(self.scene("blend.json", blend, shutter=None), "blend.exr"))

    def test_a_blend_lies_between_its_files(self):
        blend = self.scene("blend.json", {"file": "dust.####.vdb", "extinction": 0.01, "sequence": {"blend": True}}, {"close": 1})
        mixed = self.render(blend, "mixed.exr")["A"]
        ends = [self.render(self.scene("end.json", {"file": f"dust.000{frame}.vdb", "extinction": 0.01}, shutter=None), "end.exr")["A"]
                for frame in (2, 3)]
        self.assertLess(rms(mixed, [(a + b) / 2 for a, b in zip(*ends)]), 0.05 * rms(*ends))

    def test_limitations(self):
        def said(medium):
            lamp = {"name": "lamp", "type": "point", "position": {"keys": [[0, [0, 2, 0]], [1, [1, 2, 0]]]}, "intensity": 9}
            scene = self.scene("said.json", {"file": "dust.####.vdb", **medium}, lights=[lamp])
            return self.succeed("render", scene, "-o", self.path("a.exr"), "-v").stderr
        self.assertIn("it does not move during the", said({}))
        self.assertIn("moved along straight lines by its velocities", said(VELOCITY))
        self.assertIn("two of its files are blended", said({"sequence": {"blend": True}}))

    def test_bits_do_not_depend_on_threads_and_parts(self):
        for medium in (VELOCITY, {"file": "dust.####.vdb", "sequence": {"blend": True}}):
            scene, plan = self.scene("scene.json", medium), self.path("plan.json")
            for mode in ("march", "froxel"):
                one = self.render(scene, "one.exr", "--mode", mode, "--threads", 1)
                self.assertEqual(one, self.render(scene, "two.exr", "--mode", mode, "--threads", 2), mode)
                self.succeed("plan", scene, "--mode", mode, "--save", plan, "-q", "--samples", 8, "--groups", 2, "--float", "--frames", "2")
                self.succeed("render", "--plan", plan, "-o", self.path("one.exr"), "-q")
                self.succeed("prepare", "--plan", plan, "-q")
                for part in (2, 1):
                    self.succeed("render", "--plan", plan, "-o", self.path("frame.exr"), "--part", f"{part}/2", "-q")
                self.succeed("merge", *sorted(self.directory.glob("frame.part-*")), "-o", self.path("merged.exr"), "-q")
                self.assertEqual(read_channels(self.path("one.exr")), read_channels(self.path("merged.exr")), mode)
                self.succeed("prepare", "--plan", plan, "--clean-all", "-q")
                for file in (plan, *self.directory.glob("*.exr")):
                    file.unlink()

    def test_what_makes_no_sense_is_refused_in_one_line(self):
        sequence = {"file": "dust.####.vdb"}
        for medium, words in (
                ({"velocity_unit": "frame"}, ["velocity_unit", "has no effect without"]),
                ({"velocity_scale": 2}, ["velocity_scale", "has no effect without"]),
                ({**VELOCITY, "velocity_unit": "hour"}, ["velocity_unit"]),
                ({"sequence": {"blend": True}}, ["/media/0/sequence/blend", "numbered sequence"]),
                ({**sequence, **VELOCITY, "sequence": {"blend": True}}, ["/media/0/grids/velocity", "use one"]),
                ({**sequence, **VELOCITY, "sequence": {"mode": "ping_pong"}}, ["/media/0/grids/velocity", "ping_pong"]),
                ({"grids": {"velocity": "wind"}}, ["has no grid \"wind\"", "vel"]),
                ({"grids": {"velocity": "density"}}, ["density", "one number per voxel"]),
                ({**VELOCITY, "velocity_scale": 1e6}, ["its velocity moves it by up to", "velocity_unit"])):
            self.refuse(3, words, "render", self.scene("bad.json", medium), "-o", self.path("a.exr"), "-q")
        self.path("dust.0003.vdb").unlink()
        self.succeed("bake", self.recipe, "-o", self.path("dust.####.vdb"), "--frames", "4", "-q")
        gap = self.scene("gap.json", {**sequence, "sequence": {"blend": True}}, {"close": 0.5})
        self.refuse(4, ["dust.0003.vdb", "missing"], "render", gap, "-o", self.path("a.exr"), "-q")
        self.render(gap, "a.exr", "--missing", "hold")

    def test_blended_fire_has_the_light_of_both_files(self):
        """Halfway, where the mean of a flame's temperature and that of the air beside it would hardly glow."""
        fire = {"base": [0, 0, 0], "height": 0.8, "radius": 0.3, "rise": 6, "flicker": 1, "soot": 0.2,
                "noise": {"octaves": 2, "scale": 0.2}}
        self.succeed("bake", self.write("fire.json", recipe(fire=fire)), "-o", self.path("fire.####.vdb"), "--frames", "2-3", "-q")

        def emission(blackbody, sequence, **shutter):
            fields = {"file": "fire.####.vdb", "extinction": 1e-3, "grids": {"temperature": "temperature"}, "blackbody": blackbody,
                      "translate": [0.1, 0, 0], "sequence": sequence}
            return self.render(self.scene("fire_scene.json", fields, shutter), "fire.exr", "--aov", "emission")["emission.R"]

        for blackbody in ({"convention": "kelvin"}, {"convention": "kelvin", "kirchhoff": True}, {"convention": "cycles"}):
            ends = [emission(blackbody, {"offset": offset}) for offset in (0, 1)]
            mixed = emission(blackbody, {"blend": True}, open=0.49, close=0.51)
            mean = [(a + b) / 2 for a, b in zip(*ends)]
            self.assertGreater(rms(*ends), 0.2 * rms(mean, [0] * len(mean)), "the flames differ")
            self.assertLess(rms(mixed, mean), 0.02 * rms(*ends), blackbody)

    def foreign(self, name):
        """A folder of volumes by others, of those that do not travel with the program."""
        folder = next((path / "vdb" / name for path in CORPORA if (path / "vdb" / name).is_dir()), None)
        if not folder:
            self.skipTest("these files do not travel with the program")
        return folder

    def test_a_velocity_that_is_the_same_everywhere_shifts(self):
        """Fifteen meters per second downwards: 10 voxels of 1/16 m in a frame of 1/24 s."""
        wind = {"grids": {"velocity": {"file": str(self.foreign("zeno") / "vel_VDB_bound_v02.vdb"), "grid": "vel"}}}
        camera = {"position": [0, 0, 5], "target": [0, 0, 0], "ortho_height": 4}  # rows of 1/8 m

        def picture(medium, shutter, *options):
            look = {**camera, "shutter": shutter} if shutter else camera
            return self.render(self.scene("shift.json", medium, camera=look, resolution=[32, 32]), "shift.exr", *options)

        # At one moment, the file in another place.
        for mode in ("march", "froxel"):
            for frames in (1, -1):
                shutter = {"open": frames - 0.01, "close": frames + 0.01}
                moved = picture(wind, shutter, "--mode", mode, "--time-samples", 1, "--samples", 1)
                placed = picture({"translate": [0, -0.625 * frames, 0]}, None, "--mode", mode, "--samples", 1)
                self.assertEqual(moved["A"], placed["A"], (mode, frames))
                self.assertGreater(rms(placed["A"], picture({}, None, "--mode", mode, "--samples", 1)["A"]), 0.1, "it is elsewhere")

        # Over the whole shutter, the optical depth keeps its sum and its center moves by half the way.
        def center(medium, shutter=None):
            alpha = picture({**medium, "extinction": 0.01}, shutter, "--samples", 64)["A"]
            depths = [-math.log1p(-value) for value in alpha]
            height = sum(depth * (2 - (i // 32 + 0.5) / 8) for i, depth in enumerate(depths))
            return height / sum(depths), sum(depths)

        at, amount = center({})
        for shutter in ({"open": 0, "close": 1}, {"open": -1, "close": 0}, {"open": 0.5, "close": 1.5}):
            moved, same = center(wind, shutter)
            way = -0.625 * (shutter["open"] + shutter["close"]) / 2
            # Moved every half voxel, each of the 4 time samples or more is a quarter of a voxel off at most.
            self.assertAlmostEqual(moved - at, way, delta=0.0625 / 4 / 4, msg=shutter)
            self.assertAlmostEqual(same / amount, 1, delta=0.01, msg=shutter)

    def test_fire_whose_voxels_change_their_size(self):
        """Each frame of it where its voxels are, nearly empty ones too, and halfway between two frames their mean."""
        folder = self.foreign("pesichra")
        camera = {"position": [0.55, 0.3, 5], "target": [0.55, 0.3, 0], "ortho_height": 1.28}  # pixels of 0.02 m
        look = {"camera": camera, "resolution": [64, 64], "lights": [], "background": {"color": 0}}

        def render(medium, frame, **changes):
            self.write("fire.json", lit_scene(**{**look, "frames": str(frame), "media": [medium], **changes}))
            self.succeed("render", self.path("fire.json"), "-o", self.path("fire.exr"), "--background", "off", "--aov", "emission",
                         "--samples", 16, "--set", "pixel.filter=box", "--float", "-q", timeout=120)
            return read_channels(self.path("fire.exr"))

        for frame in range(45, 51):
            report = self.info(folder / f"fluid_data_{frame:04}.vdb")
            medium = json.loads(report["scene_medium"])
            self.assertEqual(medium["grids"].pop("velocity"), "velocity")
            self.assertLessEqual({"density", "temperature", "flame"}, set(medium["grids"]))
            picture = render({**medium, "file": str(folder / medium["file"]), "up_axis": "Z"}, frame)
            self.assertGreater(max(picture["emission.R"]), 1, "a flame has nits by the thousand")
            self.assertTrue(all(math.isfinite(value) for values in picture.values() for value in values))
            [grid] = [grid for grid in report["grids"] if grid["name"] == "density"]
            seen = [i for i, alpha in enumerate(picture["A"]) if alpha > 0]
            columns, rows = [i % 64 for i in seen], [i // 64 for i in seen]
            low, high, side = grid["bounds"]["low"], grid["bounds"]["high"], grid["voxel_size"][0]
            for edge, wanted in ((-0.09 + 0.02 * min(columns), low[0]), (-0.09 + 0.02 * (max(columns) + 1), high[0]),
                                 (0.94 - 0.02 * (max(rows) + 1), low[2]), (0.94 - 0.02 * min(rows), high[2])):
                self.assertAlmostEqual(edge, wanted, delta=side + 0.02 + 0.02, msg=frame)  # half a voxel, and the filter's pixel

        burning = {"grids": {"temperature": {"grid": "temperature", "scale": 1000}, "flame": "flame"},
                   "blackbody": {"convention": "kelvin"}}
        thin = {"type": "vdb", "file": str(folder / "fluid_data_####.vdb"), "up_axis": "Z", "extinction": 1, **burning}
        half = {"camera": {**camera, "shutter": {"open": 0.49, "close": 0.51}}}
        for frame in (45, 47):
            ends = [render(thin, number) for number in (frame, frame + 1)]
            mixed = render({**thin, "sequence": {"blend": True}}, frame, **half)
            for layer in ("A", "emission.R"):
                a, b = (end[layer] for end in ends)
                self.assertLess(rms(mixed[layer], [(x + y) / 2 for x, y in zip(a, b)]), 0.05 * rms(a, b), (frame, layer))

    def test_smoke_without_flames_does_not_glow(self):
        file = self.foreign("wavelet") / "fluid_data_0151.vdb"
        medium = json.loads(self.info(file)["scene_medium"])
        self.assertNotIn("blackbody", medium)
        self.assertEqual(medium["grids"], {"density": "density", "velocity": "velocity"})
        burning = {"temperature": {"grid": "temperature", "scale": 2000}, "flame": "flame"}
        for grids in (medium["grids"], {**medium["grids"], **burning}):
            medium.update({"file": str(file), "up_axis": "Z", "grids": grids, **({"blackbody": {"convention": "kelvin"}} if "flame" in grids else {})})
            picture = self.render(self.scene("smoke.json", medium, camera={"position": [6, 6, 20], "target": [6, 6, -6]}), "smoke.exr",
                                  "--aov", "emission")
            self.assertGreater(sum(picture["A"]), 10)
            self.assertEqual(max(picture.get("emission.R", [0])), 0)

    def test_files_of_others(self):
        """Mantaflow's staggered velocities, fire among them, and voxels whose size changes from file to file."""
        for name, pattern, frame in (("wavelet", "fluid_data_####.vdb", 151), ("pesichra", "fluid_data_####.vdb", 48)):
            folder = self.foreign(name)
            for medium in ({"grids": {"velocity": "velocity"}, "velocity_scale": 0.05}, {"sequence": {"blend": True}}):
                scene = self.write("others.json", lit_scene(
                    camera={"position": [0, 1, 4], "target": [0, 0.5, 0], "shutter": {"open": -0.25, "close": 0.25}},
                    media=[{"type": "vdb", "file": str(folder / pattern), "up_axis": "Z", "scale": 0.2, "extinction": 30, **medium}]))
                self.succeed("render", scene, "-o", self.path("a.####.exr"), "--frames", frame, "--float", "-q")
                self.assertGreater(sum(read_channels(self.path(f"a.{frame:04}.exr"))["A"]), 0, name)


if __name__ == "__main__":
    unittest.main()
