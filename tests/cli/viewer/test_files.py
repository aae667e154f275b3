"""Files in the viewer: jobs that write sequences, and recipes and volumes that change under it."""
import unittest

from cli.exr import without_name
from cli.program import SANITIZED, recipe, scene
from cli.viewer.viewer import ViewerTest


class Jobs(ViewerTest):
    def setUp(self):
        super().setUp()
        self.write_triangle()
        self.write("dust.json", recipe())
        self.film = self.write("scene.json", scene(gltf="triangle.gltf", frames="1-3", media=[
            {"name": "dust", "type": "noise", "recipe": "dust.json"}]))

    def same(self, one, other):
        """Whether files are the same but for their own names, which headers of images have."""
        contents = [self.path(name).read_bytes() for name in (one, other)]
        if one.endswith(".exr"):
            contents = list(map(without_name, contents))
        return contents[0] == contents[1]

    def test_sequences_are_those_of_render_and_bake(self):
        self.view(self.film, ["wait samples 1", "set pixel.samples 2", "size 48 27",
                              f"render {self.path('a.####.exr')} 2-3 png", f"bake dust {self.path('a.####.vdb')} 1-2",
                              "wait job", f"screenshot {self.path('window.png')}"])
        self.succeed("render", self.film, "-o", self.path("b.####.exr"), "--frames", "2-3", "--res", "48x27",
                     "--samples", 2, "--png", "-q")
        self.succeed("bake", self.path("dust.json"), "-o", self.path("b.####.vdb"), "--frames", "1-2", "-q")
        for name in ("0002.exr", "0003.exr", "0002.png", "0003.png", "0001.vdb", "0002.vdb"):
            self.assertTrue(self.same(f"a.{name}", f"b.{name}"), name)
        self.assertFalse(self.path("a.0001.exr").exists())

    def test_a_job_stops_and_its_mistakes_end_scripts(self):
        told = self.view(self.film, ["wait samples 1", "set pixel.samples 256", "mode path",
                                     f"render {self.path('a.####.exr')} 1-900", "wait 0.3", "stop-job", "wait job",
                                     "mode march", "reset all", f"render {self.path('b.####.exr')} 1", "wait job"])
        self.assertNotIn("error", told)
        self.assertTrue(self.path("b.0001.exr").exists())
        self.assertFalse(self.path("a.0900.exr").exists())
        for line, code in (("render out.exr", 2), ("render out.####.exr 3-", 2), ("bake fog out.####.vdb", 2),
                           (f"render {self.film}/a.####.exr", 5)):
            told = self.view(self.film, ["wait samples 1", line, "wait job"], code=code)
            self.assertIn("script.txt:2", told, line)

    def test_the_window_stays_for_a_job_until_told_otherwise(self):
        self.view(self.film, ["wait samples 1", "set pixel.samples 256", "mode path",
                              f"render {self.path('a.####.exr')} 1-900", "close", "wait 0.3",
                              f"screenshot {self.path('asked.png')}", "answer discard", "wait 999"])
        self.assertTrue(self.path("asked.png").exists())
        self.assertFalse(list(self.path(".").glob("*.tmp*")))


class Reloading(ViewerTest):
    def changed(self, film, change):
        """Pictures before and after the change of a file, each as render has it."""
        self.succeed("render", film, "-o", self.path("before.exr"), "-q", "--frames", 1)
        self.view(film, ["wait samples 1", f"snapshot {self.path('a.exr')}", f"wait {12 if SANITIZED else 4}",
                         f"snapshot {self.path('b.exr')}"], "--samples", 2, once=(self.path("a.exr"), change))
        self.succeed("render", film, "-o", self.path("after.exr"), "-q", "--frames", 1)
        pictures = [without_name(self.path(name).read_bytes()) for name in ("before.exr", "a.exr", "after.exr", "b.exr")]
        self.assertTrue(pictures[0] == pictures[1])
        self.assertTrue(pictures[2] == pictures[3])
        self.assertTrue(pictures[0] != pictures[2])

    def test_a_recipe_that_changes_is_grown_anew(self):
        self.write("dust.json", recipe())
        film = self.write("scene.json", scene(media=[{"name": "dust", "type": "noise", "recipe": "dust.json"}]))
        self.changed(film, lambda: self.write("dust.json", recipe(density={"threshold": 0.2, "gain": 5})))

    def test_a_volume_that_changes_is_read_again(self):
        self.write("one.json", recipe())
        self.write("other.json", recipe(density={"threshold": 0.2, "gain": 5}))
        for name, baked in (("one.json", "fog.vdb"), ("other.json", "next.vdb")):
            self.succeed("bake", self.path(name), "-o", self.path(baked), "-q")
        film = self.write("scene.json", scene(media=[{"name": "fog", "type": "vdb", "file": "fog.vdb"}]))
        self.changed(film, lambda: self.path("next.vdb").replace(self.path("fog.vdb")))


if __name__ == "__main__":
    unittest.main()
