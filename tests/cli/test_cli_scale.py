"""The same scene in other units of length gives the same picture: nothing but what the scene says is measured in metres."""
import json
import unittest

from moved_scenes import write_moved
from program import SOURCE, ProgramTest, run

MODES = "march froxel shadow-map shadow-volume cone billboard radial-blur path".split()
IN_METRES = {"radial_blur.lamp_size": 0.3, "billboard.near_fade": 0.6, "billboard.soft_depth": 0.4,
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
        settings = [text for name, value in IN_METRES.items() for text in ("--set", f"{name}={value * factor:.9g}")]
        result = run("render", scene, "-o", scene.with_suffix(".exr"), "--mode", ",".join(MODES), "--res", "64x36",
                     "--frames", "1", "--quality", "draft", "--seed", "1", "-q", *settings)
        self.assertEqual(result.returncode, 0, result.stderr)

    def check(self, source, factors):
        plain = self.path("plain.json")
        write_moved(source, plain)
        self.render(plain, 1)
        for number, (factor, largest) in enumerate(factors.items()):
            scaled = self.path(f"scaled{number}.json")
            write_moved(source, scaled, factor)
            self.render(scaled, factor)
            for mode in MODES:
                result = run("compare", "--json", scaled.with_suffix(f".{mode}.exr"), plain.with_suffix(f".{mode}.exr"))
                error = json.loads(result.stdout)["metrics"]["E"]
                self.assertLessEqual(error, largest, f"{source} times {factor}, {mode}")

    # Powers of two round nothing, so pictures are the same. Others move edges by a rounding.
    def test_lamps(self):
        source = self.path("lamps.json")
        source.write_text(json.dumps(LAMPS))
        self.check(source, {2.0**-10: 1e-6, 1e-3: 1e-3, 1e5: 1e-3, 2.0**16: 1e-6})

    def test_spots_over_figures(self):
        self.check(SOURCE / "scenes/spotlight.json", {2.0**-10: 1e-4, 1e-3: 3e-3, 1e5: 3e-3, 2.0**16: 1e-4})


if __name__ == "__main__":
    unittest.main()
