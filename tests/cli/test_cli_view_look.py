"""Looking into pictures in the viewer's window: errors, rays, volumes, gaps of sequences."""
import shutil
import unittest

from program import recipe, scene
from viewer import ViewerTest, read_png


def area(rows):
    """What of a window is picture, without what stands on it."""
    return [row[:3 * 900] for row in rows[100:550]]


class Looking(ViewerTest):
    def setUp(self):
        super().setUp()
        self.write_triangle()
        self.film = self.write("scene.json", scene(gltf="triangle.gltf", frames="1-8", lights=[
            {"name": "lamp", "type": "point", "position": [0.5, 1.2, 0.5], "intensity": 20}]))

    def shots(self, lines, *options):
        """Rows of the window after each of the lists of lines."""
        script, names = [], []
        for i, group in enumerate(lines):
            names.append(self.path(f"{i}.png"))
            script += [*group, "wait idle", f"screenshot {names[-1]}"]
        self.view(self.film, script, "--samples", "4", *options)
        return [read_png(name)[2] for name in names]

    def test_errors_rays_and_volumes_are_shown_and_put_away(self):
        plain, error, side, ray, volume, again = self.shots(
            [["mode cone"], ["show error"], ["show picture", "beside reference", "arrange side"],
             ["beside", "explain 10 10"], ["explain", "slice y 0.5"], ["volume off"]], "--res", "64x40")
        for name, other in {"error": error, "side": side, "ray": ray, "volume": volume}.items():
            self.assertTrue(area(plain) != area(other), name)
        # The strip below the picture: curves and figures, or a slice, where the picture ended before.
        for strip in (ray, volume):
            self.assertGreater(len({row[3 * x:3 * x + 3] for row in strip[460:720] for x in range(20, 900, 3)}), 20)
        self.assertTrue(area(plain) == area(again))

    def test_mistakes_of_scripts_name_their_line(self):
        for line in ("explain 9999 0", "medium smoke", "slice w 0.5", "beside refrence"):
            said = self.view(self.film, ["wait samples 1", line], code=3 if "slice" in line else 2)
            self.assertIn("script.txt:2", said)

    def test_gaps_of_a_sequence_are_marked(self):
        self.succeed("bake", self.write("recipe.json", recipe()), "-o", self.path("fog.0001.vdb"))
        shutil.copy(self.path("fog.0001.vdb"), self.path("fog.0003.vdb"))
        self.film = self.write("gap.json", scene(gltf="triangle.gltf", frames="1-3", media=[
            {"name": "fog", "type": "vdb", "file": "fog.####.vdb"}]))
        held, = self.shots([["frame 2"]], "--missing", "hold")
        marked = [row[3 * x:3 * x + 3] for row in held[760:790] for x in range(240, 850)]
        self.assertTrue(any(r > 200 and g < 140 and b < 130 for r, g, b in marked))


if __name__ == "__main__":
    unittest.main()
