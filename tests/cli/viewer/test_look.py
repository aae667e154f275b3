"""Looking into pictures in the viewer's window: errors, rays, volumes, gaps of sequences."""
import shutil
import unittest

from cli.program import recipe, scene
from cli.viewer.viewer import ViewerTest, read_png


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

    def test_zoomed_pixels_are_squares_and_fit_again(self):
        plain, zoomed, again = self.shots([["panels off"], ["zoom 8"], ["zoom fit"]], "--res", "64x36")
        self.assertTrue(plain == again)
        left, top = (1280 - 8 * 64) // 2, (800 - 8 * 36) // 2
        colors = set()
        for y in range(top, top + 8 * 26, 8):  # the lines of status stand on the last rows
            for x in range(left, left + 8 * 64, 8):
                block = {zoomed[y + j][3 * (x + i):3 * (x + i) + 3] for i in range(8) for j in range(8)}
                self.assertEqual(len(block), 1, (x, y))
                colors |= block
        self.assertGreater(len(colors), 50)

    def test_exposure_is_measured_kept_and_set_by_hand(self):
        bright = [{"name": "lamp", "type": "point", "position": [0.5, 1.2, 0.5], "intensity": 2e6}]
        other = self.write("bright.json", scene(gltf="triangle.gltf", frames="1-8", lights=bright,
                                                background={"color": [1e4, 2e4, 3e4]}))
        plain, edited, measured, by_hand, darker, other_film = self.shots(
            [["panels off"], ["edit lights/lamp/intensity 200"], ["exposure auto"], ["exposure 0"], ["brighten -2"],
             ["undo", f"open {other}", "exposure scene"]], "--res", "64x36")

        def mean(rows):
            codes = b"".join(row[:3 * 1000] for row in rows[150:600])
            return sum(codes) / len(codes)
        self.assertGreater(mean(edited), mean(plain) + 5, "a light that gets brighter is seen to")
        self.assertLess(mean(measured), mean(edited) - 5)
        self.assertLess(mean(darker), mean(by_hand) - 5)
        for rows in (plain, measured, other_film):
            self.assertTrue(20 < mean(rows) < 200, mean(rows))

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
