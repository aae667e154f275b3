"""Sequences of modes that remember: the same bits however a farm renders them, less noise, and nothing left behind."""
import json
import unittest

from cli.program import ProgramTest, recipe, scene

REMEMBERING = ("froxel", "shadow-map", "cone")
HISTORY = 3
FOG = {"low": [-1.5, 0, -1.5], "high": [1.5, 1.5, 1.5]}


def keys(*pairs, interpolation="step"):
    return {"keys": [list(pair) for pair in pairs], "interpolation": interpolation}


class History(ProgramTest):
    """Drifting fog, a lamp over a triangle, one frame per second; no other light."""

    def setUp(self):
        super().setUp()
        self.write_triangle()

    def film(self, wind=0.05, intensity=60, sun=0, position=(0, 0.9, 3), target=(0, 0.5, 0), **changes):
        lamp = {"name": "lamp", "type": "spot", "position": [0.3, 4, 0.3], "direction": [0, -1, 0],
                "inner_cone": 8, "outer_cone": 15, "intensity": intensity}
        self.write("recipe.json", recipe(bounds=FOG, wind=[wind, 0, 0]))
        return self.write("scene.json", scene(
            frames="1-8", frame_rate=1, resolution=[48, 32], gltf="triangle.gltf",
            lights=[lamp, {"name": "sun", "type": "sun", "direction": [-0.5, -0.7, -0.4], "intensity": sun}],
            camera={"position": position, "target": target},
            media=[{"type": "noise", "recipe": "recipe.json", "extinction": 0.5}],
            background={"color": [0, 0, 0]}, **changes))

    def render(self, film, mode, place, *more, history=HISTORY, samples=1):
        """Renders with all samples in the middle of their pixel."""
        self.succeed("render", film, "-o", self.path(f"{place}/out.####.exr"), "--mode", mode, "--samples", samples,
                     "--set", "pixel.filter=center", "--history", history, "-q", *more)

    def against(self, test, reference):
        """What compare says of the fog's light."""
        report = self.succeed("compare", "--json", "-q", self.path(test), self.path(reference)).stdout
        return json.loads(report)["layers"]["inscatter"]


class Farm(History):
    """A camera that moves, a lamp that flickers, a cut to another side at frame 5."""

    def setUp(self):
        super().setUp()
        self.moving = self.film(intensity=keys((0, 3), (1, 2), (2, 4), (3, 1), (5, 3), interpolation="linear"),
                                position=keys((0, [0, 0.9, 3]), (3, [0.3, 0.9, 3]), (3.99, [0.4, 0.9, 3]),
                                              (4, [3, 0.9, 0]), (6, [3, 0.9, 0.2]), interpolation="linear"))

    def test_frames_are_the_same_alone_in_parts_resumed_and_on_any_threads(self):
        for mode in REMEMBERING:
            self.render(self.moving, mode, mode, "--frames", "1-6")
            whole = self.content(mode)
            self.assertEqual(len(set(whole.values())), 6, "frames differ")

            for frame in range(1, 7):
                self.render(self.moving, mode, f"{mode}_alone", "--frames", frame)
            self.assertEqual(self.content(f"{mode}_alone"), whole, mode)
            self.render(self.moving, mode, f"{mode}_parts", "--frames", "6,2,4", "--threads", 1)
            self.render(self.moving, mode, f"{mode}_parts", "--frames", "1-5x2", "--threads", 3)
            self.assertEqual(self.content(f"{mode}_parts"), whole, mode)

            for name in ("out.0002.exr", "out.0005.exr"):
                self.path(f"{mode}/{name}").unlink()
            third = self.path(f"{mode}/out.0003.exr")
            third.write_bytes(third.read_bytes()[:-100])
            self.render(self.moving, mode, mode, "--frames", "1-6", "--resume")
            self.assertEqual(self.content(mode), whole, mode)

    def test_frames_of_another_history_are_rendered_again(self):
        for mode in REMEMBERING:
            self.render(self.moving, mode, mode, "--frames", "4")
            before = self.content(mode)
            for history in (0, 1):
                self.render(self.moving, mode, mode, "--frames", "4", "--resume", history=history)
                self.assertNotEqual(self.content(mode), before, (mode, history))


class Noise(History):
    def test_history_is_closer_to_the_truth(self):
        # Froxels are jittered once there is history, by a pattern of five frames, and have no samples of their own: one
        # frame of history against sixteen, which end on the same of the five, both against a march. In images this
        # small, a tile of 64 is 2 pixels wide.
        still = self.film(wind=0)
        cases = [("froxel", "march", "froxel.tile=64", 1, 16), ("shadow-map", "shadow-map", "shadow_map.steps=6", 0, 16)]
        for mode, truth, row, short, long in cases:
            options = ["--frames", "5", "--res", "96x64", "--set", row]
            self.render(still, truth, f"{mode}_truth", *options, history=0, samples=256)
            error = {}
            for history in (short, long):
                self.render(still, mode, mode, *options, history=history)
                error[history] = self.against(f"{mode}/out.0005.exr", f"{mode}_truth/out.0005.exr")["rmse_rel"]
            self.assertLess(error[long], error[short], mode)


class Left(History):
    def test_four_frames_after_a_lamp_goes_out_two_percent_of_it_are_left_at_most(self):
        # The sun goes on shining, so that clamping to what neighbors show does not hide all by itself. Compared with a
        # lamp that never shone, whose history is as old as that since the switch.
        for mode in REMEMBERING:
            self.render(self.film(intensity=keys((0, 60), (5, 0)), sun=2), mode, "out", "--frames", "4,8", history=8)
            never = self.film(intensity=0, sun=2)
            self.render(never, mode, "never", "--frames", "4", history=8)
            self.render(never, mode, "never", "--frames", "8", history=3)
            before = self.against("out/out.0004.exr", "never/out.0004.exr")
            after = self.against("out/out.0008.exr", "never/out.0008.exr")
            self.assertGreater(before["bias"], 0.2 * before["mean_reference"], "a lamp that shows")
            self.assertLess(after["rmse"], 0.02 * before["bias"], mode)

    def test_nothing_is_left_of_what_a_camera_saw_before_a_cut(self):
        # History that reaches back over the cut changes no bit; without the cut it changes many.
        for mode in REMEMBERING:
            difference = {}
            for cut in (True, False):
                film = self.film(sun=2, position=keys((0, [0, 0.9, 3]), (5, [3, 0.9, 0] if cut else [0, 0.9, 3])))
                for history in (3, 8):
                    self.render(film, mode, f"{mode}{history}", "--frames", "8", history=history)
                difference[cut] = self.against(f"{mode}3/out.0008.exr", f"{mode}8/out.0008.exr")["max"]
            self.assertEqual(difference[True], 0, mode)
            self.assertGreater(difference[False], 0, mode)

    def test_fog_that_drifts_is_said_to_trail_behind(self):
        for mode in REMEMBERING:
            for wind, history, trails in ((0.05, 3, True), (0, 3, False), (0.05, 0, False)):
                done = self.succeed("render", self.film(wind=wind), "-o", self.path("out.exr"), "--mode", mode,
                                    "--samples", 1, "--frames", 2, "--history", history)
                self.assertEqual("trails behind" in done.stderr + done.stdout, trails, (mode, wind, history))


if __name__ == "__main__":
    unittest.main()
