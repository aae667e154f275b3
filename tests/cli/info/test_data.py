"""Volumes and scenes written by other programs: each renders, or is refused with one clear line."""
import concurrent.futures
import json
import pathlib
import time
import unittest

from cli.program import SANITIZED, ProgramTest, corpus, run

LONGEST = 240 if SANITIZED else 60  # seconds one file may take

# Files the validator warns about only, and which are refused here: types that are not in the standard, a field of view
# beyond a half turn, data over the network, and a matrix whose padding lies outside its buffer.
STRICTER = {"unknown_type.gltf", "perspective_yfov.gltf", "non_relative_uri.gltf", "get_elements_matrix.gltf"}


def framing(low, high):
    """A camera that sees a box, and a sun over its shoulder."""
    center = [(a + b) / 2 for a, b in zip(low, high)]
    size = max(max(b - a for a, b in zip(low, high)), 1e-3)
    position = [center[0] + 0.9 * size, center[1] + 0.5 * size, center[2] + 1.5 * size]
    return {
        "camera": {"position": position, "target": center, "vertical_fov": 45},
        "lights": [{"type": "sun", "direction": [-0.4, -0.8, -0.3], "intensity": 5}],
    }, size


class Data(ProgramTest):
    def for_each(self, paths, check):
        """Checks every path, a few at a time; every failure is reported."""
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            outcomes = [(path, pool.submit(check, number, path)) for number, path in enumerate(paths)]
        for path, outcome in outcomes:
            with self.subTest(path=str(path)):
                outcome.result()

    def render(self, number, path):
        """Renders a small frame. True when it came out, false when it was refused as it should be."""
        output = self.path(f"{number}.exr")
        start = time.monotonic()
        result = run("render", path, "-o", output, "--frames", "1", "--res", "32x18", "--quality", "draft", "--threads",
                     "1", "-q", timeout=LONGEST)
        self.assertLess(time.monotonic() - start, LONGEST)
        if result.returncode == 0:
            self.assertEqual(result.stderr, "")
            self.assertTrue(output.exists())
            return True
        self.assertIn(result.returncode, (3, 4), result.stderr)
        self.check_refusal(result, result.returncode)
        self.assertFalse(output.exists())
        return False

    def volume(self, number, path):
        result = run("info", "--json", path, timeout=LONGEST)
        self.assertIn(result.returncode, (0, 3, 4), result.stderr)
        if result.returncode:
            self.check_refusal(result, result.returncode, path.name)
        grids = json.loads(result.stdout)["grids"] if result.returncode == 0 else []
        boxes = [grid["bounds"] for grid in grids if grid["is_fog"] and grid["bounds"]]
        view, size = framing(**boxes[0]) if boxes else framing([-1, -1, -1], [1, 1, 1])
        media = [{"type": "vdb", "file": str(path), "extinction": 5 / size}]
        content = self.write(f"{number}.json", {"tyndall": 1, "media": media, **view})
        rendered = self.render(number, content)
        self.assertEqual(rendered, any(grid["is_fog"] for grid in grids),
                         "what info calls fog renders, and nothing else")
        return rendered

    def test_volumes(self):
        rendered = []
        paths = corpus("vdb/**/*.vdb", "vdb/**/*.nvdb")
        self.for_each(paths, lambda number, path: rendered.append(path.name) if self.volume(number, path) else None)
        for name in ["sphere.vdb", "box.vdb", "dragon_with_xform.vdb", "grids.vdb", "nebula_cut.vdb"]:
            self.assertIn(name, rendered)
        for name in ["wdas_cloud_sixteenth.vdb", "smoke.vdb", "singlecloud.vdb", "smoke_000002.vdb"]:
            if any(path.name == name for path in paths):
                self.assertIn(name, rendered)

    def test_scenes(self):
        self.for_each(corpus("gltf/**/*.gltf", "gltf/**/*.glb"), self.gltf)

    def gltf(self, number, path):
        rendered = self.render(number, path)
        report = pathlib.Path(f"{path}.report.json")
        if not report.exists() and "malformed" not in path.parts:
            self.assertTrue(rendered or "Draco" in str(path), "a sound file has to render")
        elif path.name not in STRICTER and report.exists() and json.loads(report.read_text())["issues"]["numErrors"] == 0:
            self.assertTrue(rendered, "the validator finds no error in it")

    def test_pictures(self):
        readable = []

        def check(_, path):
            result = run("info", path, timeout=LONGEST)
            self.assertIn(result.returncode, (0, 3), result.stderr)
            if result.returncode:
                self.check_refusal(result, 3, path.name)
            else:
                readable.append(path.name)

        damaged = [path for path in corpus("exr/openexr-damaged/*") if path.suffix not in (".rst", ".txt")]
        self.for_each(corpus("exr/**/*.exr") + damaged, check)
        self.assertLessEqual({"BrightRings.exr", "BrightRingsNanInf.exr", "WideColorGamut.exr"}, set(readable))


if __name__ == "__main__":
    unittest.main()
