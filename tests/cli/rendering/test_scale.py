"""The same scene in other units of length, or far from the world's origin, gives the same picture."""
import json
import unittest

from cli.rendering.moved_scenes import write_moved
from cli.program import SOURCE, ProgramTest, run

MODES = "march froxel shadow-map shadow-volume cone billboard radial-blur path".split()
IN_METERS = {"radial_blur.lamp_size": 0.3, "billboard.near_fade": 0.6, "billboard.soft_depth": 0.4,
             "billboard.scroll": 0.05, "cone.noise_size": 0.6, "cone.noise_speed": 0.2}
LAMPS = {
    "tyndall": 1,
    "camera": {"position": [0.5, 0.4, 6], "target": [0, 0, 0], "far": 50},
    "lights": [
        {"type": "point", "position": [0.3, 0.2, 0.1], "intensity": 5},
        {"type": "spot", "position": [-1, 2, 0], "direction": [0, -1, 0], "intensity": 30, "outer_cone": 20},
    ],
    "media": [{"type": "homogeneous", "extinction": 0.1, "emission": 0.02},
              {"type": "height", "extinction": 0.3, "base": -1, "falloff": 0.5}],
}


class Scale(ProgramTest):
    def render(self, scene, factor):
        settings = [text for name, value in IN_METERS.items() for text in ("--set", f"{name}={value * factor:.9g}")]
        result = run("render", scene, "-o", scene.with_suffix(".exr"), "--mode", ",".join(MODES), "--res", "64x36",
                     "--frames", "1", "--quality", "draft", "--seed", "1", "-q", *settings)
        self.assertEqual(result.returncode, 0, result.stderr)

    def check(self, source, factors, offsets={}):
        plain = self.path("plain.json")
        write_moved(source, plain)
        self.render(plain, 1)
        cases = [(factor, (0, 0, 0), most) for factor, most in factors.items()]
        cases += [(1, offset, most) for offset, most in offsets.items()]
        for number, (factor, offset, largest) in enumerate(cases):
            moved = self.path(f"moved{number}.json")
            write_moved(source, moved, factor, offset)
            self.render(moved, factor)
            for mode in MODES:
                result = run("compare", "--json", moved.with_suffix(f".{mode}.exr"), plain.with_suffix(f".{mode}.exr"))
                error = json.loads(result.stdout)["metrics"]["E"]
                self.assertLessEqual(error, largest, f"{source} times {factor} at {offset}, {mode}")
        return moved

    # Powers of two round nothing, so pictures are the same. Others move edges by a rounding.
    def test_lamps(self):
        source = self.path("lamps.json")
        source.write_text(json.dumps(LAMPS))
        self.check(source, {2.0**-10: 1e-6, 1e-3: 1e-3, 1e5: 1e-3, 2.0**16: 1e-6},
                   {(1e5, 2e4, -5e4): 1e-4, (1000000.3, -12345.6, 777777.7): 3e-3})

    def test_spots_over_figures(self):
        self.check(SOURCE / "scenes/spotlight.json", {2.0**-10: 1e-4, 1e-3: 3e-3, 1e5: 3e-3, 2.0**16: 1e-4})

    def test_columns_far_from_the_origin(self):
        moved = self.check(SOURCE / "scenes/pillars.json", {}, {(1e7, 0, -1e7): 1e-3, (1e6, 2e5, -3e6): 1e-3})
        # Places are told in the world, to the millimeter.
        report = json.loads(run("explain", moved, "--pixel", "32,18", "--res", "64x36", "--frame", "1", "--json",
                               "-q").stdout)
        for value, expected in zip(report["origin"], (1e6 - 1.6, 2e5 + 2.0, -3e6 + 9.5)):
            self.assertAlmostEqual(value, expected, delta=0.1)
        bounds = json.loads(run("info", moved, "--json").stdout)["bounds"]
        self.assertAlmostEqual(bounds["low"][1], 2e5, delta=10)
        self.assertNotEqual(bounds["low"][0], bounds["high"][0])


if __name__ == "__main__":
    unittest.main()
