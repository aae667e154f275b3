"""Bad input and bad output places: one line naming file and field, the right exit code, nothing left behind."""
import json
import os
import resource
import struct
import unittest

from cli import exr
from cli.program import SANITIZED, TRIANGLE, ProgramTest, corpus, glb, gltf, lit_scene, recipe, run, scene


class Render(ProgramTest):
    """Renders of scenes that must be refused."""

    def refuse_scene(self, code, words, content, *more):
        path = self.write("scene.json", content)
        self.refuse(code, ["scene.json", *words], "render", path, "-o", self.path("out.####.exr"), *more)

    def test_missing_and_unreadable_files(self):
        for name in ["nothing.json", "nothing.gltf", "nothing.glb"]:
            self.refuse(4, [name], "render", self.path(name), "-o", self.path("out.####.exr"))
        self.path("folder.json").mkdir()
        os.mkfifo(self.path("pipe.json"))
        for name in ["folder.json", "pipe.json"]:
            self.refuse(4, [name], "render", self.path(name), "-o", self.path("out.####.exr"), timeout=10)
        self.refuse(4, ["/dev/zero"], "info", "/dev/zero", timeout=10)

    def test_text_that_is_not_json(self):
        for text in ["", "{", "[1, 2", '{"tyndall": 1,}', '{"tyndall": 1} x', "\0\0\0\0", "\xff\xfe{}",
                     '{"tyndall": 1, "tyndall": 1}', '{"tyndall": 1e999}', "[" * 100000]:
            with self.subTest(text=text[:20]):
                self.refuse_scene(3, [], text)

    def test_files_of_another_kind_are_told_what_they_are_for(self):
        fog, room = self.write("fog.json", recipe()), self.write("room.json", scene())
        self.refuse(3, [fog, "is a fog recipe, not a scene"], "render", fog, "-o", self.path("a.exr"))
        self.refuse(3, [room, "is a scene, not a fog recipe"], "bake", room, "-o", self.path("a.vdb"))
        blend = self.write("room.blend", "BLENDER")
        self.refuse(3, [blend, "export the scene as glTF"], "render", blend, "-o", self.path("a.exr"))

    def test_a_sun_outside_endless_fog_is_told(self):
        dark = self.write("dark.json", scene(media=[{"name": "haze", "type": "homogeneous", "extinction": 0.1}]))
        result = run("check", dark)
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("medium haze fills all space, so no light from sun gets through", result.stdout)
        self.assertEqual(run("check", self.write("lit.json", scene())).returncode, 0)

    def test_a_lamp_enclosed_by_its_bulb_is_told_and_mended(self):
        corners = [(x, y, z) for x in (-0.02, 0.02) for y in (-0.02, 0.02) for z in (-0.02, 0.02)]
        faces = [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3]
        binary = b"".join(struct.pack("<3f", *corner) for corner in corners) + struct.pack("<36H", *faces)
        self.write("bulb.glb", glb(gltf(
            nodes=[{"name": "Bulb", "mesh": 0, "translation": [0, 1, 0]}],
            meshes=[{"name": "Globe", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            accessors=[{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3",
                        "min": [-0.02] * 3, "max": [0.02] * 3},
                       {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}],
            bufferViews=[{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
            buffers=[{"byteLength": 168}]), binary))
        lamp = {"name": "lamp", "type": "point", "position": [0, 1, 0], "intensity": 5}
        box = {"low": [-1, 0, -1], "high": [1, 2, 1]}
        content = lit_scene(gltf="bulb.glb", lights=[lamp], resolution=[32, 18],
                            media=[{"type": "homogeneous", "extinction": 0.2, "bounds": box}])
        dark = self.write("dark.json", content)
        words = 'light lamp is enclosed by the object "Bulb": 100 % of its light is blocked within 0.03'
        result = run("check", dark)
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn(words, result.stdout)
        for mode in ["march", "path"]:
            told = self.succeed("render", dark, "-o", self.path("dark.exr"), "--mode", mode).stderr
            self.assertIn("warning: " + words, told)

        # Either way of mending it gives the same picture, with light in it.
        self.write("free.json", {**content, "objects": [{"name": "Bulb", "casts_shadows": False}]})
        self.write("linked.json", {**content, "lights": [{**lamp, "shadow_link": {"exclude": ["Globe"]}}]})
        pictures = []
        for name in ["free", "linked"]:
            self.succeed("check", self.path(name + ".json"))
            self.succeed("render", self.path(name + ".json"), "-o", self.path(name + ".exr"), "--float")
            pictures.append(exr.read_channels(self.path(name + ".exr"))["R"])
        self.assertEqual(pictures[0], pictures[1])
        self.assertGreater(max(pictures[0]), 0)

        wrong = {**content, "objects": [{"name": "Blub", "casts_shadows": False}]}
        self.refuse_scene(3, ["/objects/0/name", "Blub", "did you mean Bulb"], wrong)

    def test_unknown_keys_get_a_hint(self):
        self.refuse_scene(3, ["lihgts", "lights"], scene(lihgts=[]))
        self.refuse_scene(3, ["/media/0", "extintion", "extinction"],
                          scene(media=[{"type": "homogeneous", "extintion": 1}]))

    def test_wrong_types(self):
        self.refuse_scene(3, ["/frame_rate", "number"], scene(frame_rate="fast"))
        self.refuse_scene(3, ["/lights", "array"], scene(lights={}))
        self.refuse_scene(3, ["/camera/position"], scene(camera={"position": [0, 0], "target": [0, 0, 0]}))
        self.refuse_scene(3, ["/resolution"], scene(resolution=[64, 36.5]))
        self.refuse_scene(3, [], [])

    def test_numbers_out_of_range(self):
        self.refuse_scene(3, ["/frame_rate"], scene(frame_rate=0))
        self.refuse_scene(3, ["/resolution"], scene(resolution=[0, 36]))
        self.refuse_scene(3, ["/media/0"], scene(media=[{"type": "homogeneous", "extinction": -1}]))
        self.refuse_scene(3, ["/media/0"], scene(media=[{"type": "homogeneous", "albedo": 1.5}]))
        self.refuse_scene(3, ["/media/0"], scene(media=[{"type": "homogeneous", "g": 2}]))
        self.refuse_scene(3, [], '{"tyndall": 1, "frame_rate": 1e39}')

    def test_frames(self):
        self.refuse_scene(3, ["/frames"], scene(frames="1-5:2"))
        self.refuse_scene(3, ["/frames"], scene(frames="9-1"))

    def test_files_a_scene_names(self):
        self.refuse_scene(4, ["nothing.glb"], scene(gltf="nothing.glb"))
        self.refuse_scene(4, ["nothing.json"], scene(media=[{"type": "noise", "recipe": "nothing.json"}]))
        self.refuse_scene(4, ["nothing.vdb"], scene(media=[{"type": "vdb", "file": "nothing.vdb"}]))
        self.refuse_scene(4, ["nothing.####.vdb"], scene(media=[{"type": "vdb", "file": "nothing.####.vdb"}]))
        self.refuse_scene(4, ["nothing.png"], scene(background={"image": "nothing.png"}))

    def test_names_are_made_printable(self):
        self.refuse_scene(3, ["\\x1b"], scene(**{"\x1b[31m\n": 1}))
        self.refuse_scene(3, [], scene(**{"x" * 100000: 1}))


class Recipe(ProgramTest):
    def refuse_recipe(self, code, words, content):
        path = self.write("recipe.json", content)
        self.refuse(code, ["recipe.json", *words], "bake", path, "-o", self.path("fog.####.vdb"))

    def test_recipes(self):
        self.refuse(4, ["nothing.json"], "bake", self.path("nothing.json"), "-o", self.path("fog.vdb"))
        self.refuse_recipe(3, ["voxel_sise", "voxel_size"], recipe(voxel_sise=1))
        self.refuse_recipe(3, ["/voxel_size"], recipe(voxel_size="small"))
        self.refuse_recipe(3, ["/voxel_size"], recipe(voxel_size=0))
        self.refuse_recipe(3, ["/noise/octaves"], recipe(noise={"octaves": 1000}))
        self.refuse_recipe(3, ["/fire", "height"], recipe(fire={"radius": 1}))
        self.refuse_recipe(3, ["/fire/core"], recipe(fire={"height": 1, "core": -1900}))
        self.refuse_recipe(3, ["/fire/core"], recipe(fire={"height": 1, "core": 1e9}))
        self.refuse_recipe(3, [], "not json")
        self.refuse_recipe(3, [], scene())

    def test_a_recipe_that_cannot_fit_in_memory(self):
        path = self.write("recipe.json", recipe(voxel_size=1e-5))
        result = run("bake", path, "-o", self.path("fog.vdb"), timeout=30)
        self.assertIn(result.returncode, (3, 33), result.stderr)
        self.check_refusal(result, result.returncode)
        self.assertEqual(self.files(), ["recipe.json"])


class Volume(ProgramTest):
    """Volumes that are cut, foreign or not volumes."""

    def setUp(self):
        super().setUp()
        self.recipe = self.write("recipe.json", recipe())

    def fog_scene(self, **medium):
        return self.write("scene.json", scene(frames="1", resolution=[8, 8],
                                              media=[{"type": "vdb", "file": "fog.vdb", **medium}]))

    def test_volumes_cut_anywhere(self):
        for options, places in [((), 40), (("--compression", "zip"), 12), (("--float",), 12)]:
            self.succeed("bake", self.recipe, "-o", self.path("whole.vdb"), *options)
            whole = self.path("whole.vdb").read_bytes()
            path = self.fog_scene()
            for place in range(places):
                # From the first bytes to the last one missing, denser in the header.
                share = (place / (places - 1)) ** 2
                length = min(int(share * len(whole)), len(whole) - 1)
                self.write("fog.vdb", whole[:length])
                with self.subTest(options=options, length=length):
                    self.refuse(3, ["fog.vdb"], "render", path, "-o", self.path("out.exr"), "--quality", "draft")
            self.write("fog.vdb", whole)
            self.succeed("render", path, "-o", self.path("out.exr"), "--quality", "draft")
            self.path("out.exr").unlink()

    def test_a_missing_grid_lists_what_is_there(self):
        self.succeed("bake", self.recipe, "-o", self.path("fog.vdb"))
        path = self.fog_scene(grid="smoke")
        self.refuse(3, ["fog.vdb", "smoke", "density"], "render", path, "-o", self.path("out.exr"))

    def test_a_missing_frame_of_a_sequence(self):
        self.succeed("bake", self.recipe, "-o", self.path("fog.####.vdb"), "--frames", "1,2,4")
        path = self.write("scene.json", scene(frames="1-4", resolution=[8, 8],
                                              media=[{"type": "vdb", "file": "fog.####.vdb"}]))
        before = self.files()
        result = run("render", path, "-o", self.path("out.####.exr"))
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertIn("fog.0003.vdb", result.stderr.splitlines()[-1])
        self.assertEqual(sorted(set(self.files()) - set(before)), ["out.0001.exr", "out.0002.exr"])
        for choice in ["hold", "skip"]:
            self.succeed("render", path, "-o", self.path(f"{choice}.####.exr"), "--missing", choice)
            self.assertTrue(self.path(f"{choice}.0003.exr").exists())

    def test_things_that_are_not_volumes(self):
        pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:" + "0" * 64 + "\nsize 1000000\n"
        path = self.fog_scene()
        output = ("-o", self.path("out.exr"))
        self.write("fog.vdb", pointer)
        self.refuse(3, ["fog.vdb", "Git LFS"], "render", path, *output)
        self.refuse(3, ["fog.vdb", "Git LFS"], "info", self.path("fog.vdb"))
        for content in [b"", b" BDV", b"\0" * 4096, b"NanoVDB0" + b"\0" * 100, b"\x89PNG\r\n\x1a\n" + b"\0" * 100]:
            self.write("fog.vdb", content)
            self.refuse(3, ["fog.vdb"], "render", path, *output)
            self.refuse(3, ["fog.vdb"], "info", self.path("fog.vdb"))


class Gltf(ProgramTest):
    def refuse_gltf(self, code, words, content, name="model.gltf"):
        path = self.write(name, content)
        self.write("triangle.bin", TRIANGLE)
        self.refuse(code, [name, *words], "render", path, "-o", self.path("out.exr"), "--res", "8x8")

    def test_the_plain_file_renders(self):
        self.write("triangle.bin", TRIANGLE)
        self.succeed("render", self.write("a.gltf", gltf()), "-o", self.path("out.exr"), "--res", "8x8")
        embedded = gltf(buffers=[{"byteLength": 36}])
        self.succeed("render", self.write("a.glb", glb(embedded)), "-o", self.path("out.exr"), "--res", "8x8")

    def test_binary_files_cut_anywhere(self):
        whole = glb(gltf(buffers=[{"byteLength": 36}]))
        for length in [0, 3, 4, 11, 12, 19, 20, 21, 200, len(whole) - 45, len(whole) - 36, len(whole) - 1]:
            with self.subTest(length=length):
                self.refuse_gltf(3, [], whole[:length], "cut.glb")

    def test_paths_out_of_the_directory(self):
        secret = self.write("secret.bin", TRIANGLE)
        for uri in ["../secret.bin", "%2e%2e/secret.bin", "..%2fsecret.bin", "a/../../secret.bin", "..\\secret.bin",
                    str(secret), f"file://{secret}"]:
            with self.subTest(uri=uri):
                self.refuse_gltf(3, ["/buffers/0"], gltf(buffers=[{"uri": uri, "byteLength": 36}]), "inner/model.gltf")

    def test_node_cycles(self):
        self.refuse_gltf(3, ["/nodes/"], gltf(nodes=[{"mesh": 0, "children": [0]}]))
        self.refuse_gltf(3, ["/nodes/"], gltf(nodes=[{"mesh": 0, "children": [1]}, {"children": [0]}]))
        ring = [{"children": [(i + 1) % 1000]} for i in range(1000)]
        self.refuse_gltf(3, ["/nodes/"], gltf(nodes=ring))

    def test_numbers_that_point_nowhere(self):
        self.refuse_gltf(3, ["/nodes/0"], gltf(nodes=[{"mesh": 7}]))
        self.refuse_gltf(3, ["/accessors/0"], gltf(accessors=[{"bufferView": 9, "componentType": 5126, "count": 3,
                                                               "type": "VEC3"}]))
        self.refuse_gltf(3, ["/accessors/0"], gltf(accessors=[{"bufferView": 0, "componentType": 5126,
                                                               "count": 1000000000, "type": "VEC3"}]))
        self.refuse_gltf(3, ["/bufferViews/0"], gltf(bufferViews=[{"buffer": 0, "byteLength": 36,
                                                                   "byteOffset": 2**40}]))
        self.refuse_gltf(3, ["/buffers/0"], gltf(buffers=[{"uri": "triangle.bin", "byteLength": 3600}]))
        self.refuse_gltf(4, ["/buffers/0"], gltf(buffers=[{"uri": "nothing.bin", "byteLength": 36}]))


class Output(ProgramTest):
    """Output that cannot be written is found before the scene is loaded."""

    def setUp(self):
        super().setUp()
        self.scene = self.write("scene.json", scene())
        self.file = self.write("file", "somebody's work")

    def test_places_that_cannot_be_written(self):
        self.path("taken.0002.exr").mkdir()
        places = [self.path("file/out.####.exr"), "/proc/tyndall/out.####.exr", self.path("taken.####.exr"),
                  self.path("x" * 300 + ".####.exr")]
        if os.geteuid() != 0:
            self.path("locked").mkdir(mode=0o555)
            places.append(self.path("locked/out.####.exr"))
        for place in places:
            with self.subTest(place=place):
                self.refuse(5, [], "render", self.scene, "-o", place)
                # Before the scene is read: a scene that is not there makes no difference.
                self.refuse(5, [], "render", self.path("nothing.json"), "-o", place, "--frames", "1-3")
        fog = self.write("recipe.json", recipe())
        self.refuse(5, ["file"], "bake", fog, "-o", self.path("file/fog.vdb"))
        self.refuse(5, ["file"], "render", self.scene, "-o", self.path("out.####.exr"), "--stats-json",
                    self.path("file/stats.json"))
        for goal in [("--target-error", 0.1), ("--mode", "march", "--samples", 2)]:
            self.refuse(5, ["file"], "plan", self.path("nothing.json"), *goal, "--save", self.path("file/plan.json"))

    def test_directories_are_made_and_removed_again(self):
        self.succeed("render", self.scene, "-o", self.path("a/b/out.####.exr"), "--frames", "1")
        self.assertTrue(self.path("a/b/out.0001.exr").exists())
        self.refuse(4, [], "render", self.path("nothing.json"), "-o", self.path("c/d/out.####.exr"))

    def test_a_full_disk(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))

        fog = self.write("recipe.json", recipe())
        before = self.files()
        for command in [("render", self.scene, "-o", self.path("out.####.exr"), "--frames", "1"),
                        ("bake", fog, "-o", self.path("fog.vdb"))]:
            result = run(*command, preexec_fn=limit)
            self.assertEqual(result.returncode, 5, result.stderr)
            self.assertTrue(result.stderr.splitlines()[-1].startswith("tyndall: error: "), result.stderr)
            self.assertEqual(self.files(), before)

    def test_an_old_frame_survives_a_failed_new_one(self):
        self.succeed("render", self.scene, "-o", self.path("out.exr"), "--frames", "1")
        old = self.path("out.exr").read_bytes()

        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))

        result = run("render", self.scene, "-o", self.path("out.exr"), "--frames", "1", "--seed", "9", preexec_fn=limit)
        self.assertEqual(result.returncode, 5)
        self.assertEqual(self.path("out.exr").read_bytes(), old)

    def test_input_is_never_written_over(self):
        self.succeed("render", self.scene, "-o", self.path("plate.exr"), "--frames", "1")
        self.succeed("bake", self.write("recipe.json", recipe()), "-o", self.path("fog.vdb"))
        fog = self.path("fog.vdb").read_bytes()
        self.refuse(2, [], "render", self.scene, "-o", self.path("fog.vdb"), "--frames", "1")
        self.assertEqual(self.path("fog.vdb").read_bytes(), fog)

    def test_files_of_the_scene_are_never_written_over(self):
        self.path("link").symlink_to(self.directory)
        own = self.write("chart.json", scene())
        before = own.read_bytes()
        for command in [("plan", "--target-error", 0.1, "--save", own),
                        ("plan", "--mode", "march", "--samples", 2, "--save", own),
                        ("render", "-o", self.path("out.exr"), "--frames", 1, "--stats-json", self.path("link/chart.json")),
                        ("chart", "-o", self.directory)]:
            with self.subTest(command=command):
                self.refuse(2, [own.name, "overwritten"], command[0], own, *command[1:])
                self.assertEqual(own.read_bytes(), before)
        plan = self.path("plan.json")
        self.succeed("plan", self.scene, "--mode", "march", "--samples", 2, "--save", plan)
        self.refuse(2, ["plan.json"], "render", "--plan", plan, "-o", self.path("out.####.exr"), "--stats-json", plan)


@unittest.skipIf(SANITIZED, "sanitizers need the address space themselves")
class Memory(ProgramTest):
    def test_too_little_memory(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))

        path = self.write("scene.json", scene(frames="1", resolution=[16384, 16384]))
        result = run("render", path, "-o", self.path("out.exr"), "--quality", "draft", "--threads", "1", "-q",
                     preexec_fn=limit)
        self.check_refusal(result, 33)
        self.assertEqual(self.files(), ["scene.json"])


class Pictures(ProgramTest):
    def test_info_of_broken_pictures(self):
        self.succeed("render", self.write("scene.json", scene(frames="1")), "-o", self.path("out.exr"))
        whole = self.path("out.exr").read_bytes()
        for place in range(20):
            self.write("cut.exr", whole[:int(len(whole) * place / 20)])
            self.refuse(3, ["cut.exr"], "info", self.path("cut.exr"))
        self.write("cut.exr", whole[:-1])
        self.refuse(3, ["cut.exr"], "info", self.path("cut.exr"))


class Check(ProgramTest):
    def check(self, code, *files):
        result = run("check", *files)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result.stdout.splitlines()

    def test_good_files_have_nothing_to_say(self):
        fog = self.write("recipe.json", recipe())
        self.succeed("bake", fog, "-o", self.path("fog.####.vdb"), "--frames", "1-3")
        path = self.write("scene.json", scene(media=[{"type": "vdb", "file": "fog.####.vdb"}]))
        self.succeed("render", path, "-o", self.path("out.exr"), "--frames", "1")
        model = self.write("model.glb", glb(gltf(buffers=[{"byteLength": 36}])))
        files = [path, fog, model, self.path("fog.0001.vdb"), self.path("fog.####.vdb"), self.path("out.exr")]
        self.assertEqual(self.check(0, *files), [])

    def test_every_problem_is_a_line(self):
        fog = self.write("recipe.json", recipe())
        self.succeed("bake", fog, "-o", self.path("fog.####.vdb"), "--frames", "1-4")
        whole = self.path("fog.0002.vdb").read_bytes()
        self.write("fog.0002.vdb", whole[:len(whole) // 2])
        self.path("fog.0003.vdb").unlink()
        media = [{"type": "vdb", "file": "fog.####.vdb"}]
        path = self.write("scene.json", scene(frames="1-4", media=media))
        bad = self.write("bad.json", scene(frame_rate=0))
        lines = self.check(1, path, bad, fog)
        self.assertEqual(len(lines), 3, lines)
        for line, words in zip(lines, [["fog.0002.vdb"], ["fog.0003.vdb"], ["bad.json", "/frame_rate"]]):
            self.assertTrue(line.startswith(str(self.directory)), line)
            for word in words:
                self.assertIn(word, line)
        self.assertEqual(len(self.check(1, self.path("fog.####.vdb"))), 2)
        self.assertEqual(len(self.check(4, self.path("fog.####.vdb"), "--frames", "1,4-6")), 2)  # 5 and 6
        self.check(2, bad, "--frames", "1-4")
        report = json.loads(run("check", "--json", path, bad).stdout)
        self.assertEqual(len(report["problems"]), 3)

    def test_a_changed_image_is_told_by_its_checksum(self):
        self.succeed("render", self.write("scene.json", scene()), "-o", self.path("out.exr"), "--frames", "1", "-q")
        changed = self.path("out.exr").read_bytes().replace(b"march", b"marsh", 1)
        lines = self.check(1, self.write("out.exr", changed))
        self.assertEqual(len(lines), 1, lines)
        self.assertIn("checksum", lines[0])
        self.assertEqual(self.check(0, self.write("foreign.exr", changed.replace(b"tyndall:check", b"another:check"))), [])

    def test_missing_files_alone_are_exit_code_4(self):
        self.check(4, self.path("nothing.vdb"))
        self.check(1, self.path("nothing.vdb"), self.write("bad.json", scene(frame_rate=0)))


class Foreign(ProgramTest):
    def test_hostile_files_by_others(self):
        refused = 0
        for path in corpus("vdb/malformed/**/*.vdb"):
            with self.subTest(path=path.name):
                result = run("info", path, timeout=20)
                self.assertIn(result.returncode, (0, 3, 33), result.stderr)
                if result.returncode:
                    self.check_refusal(result, result.returncode, path.name)
                    refused += 1
        self.assertGreaterEqual(refused, 2)


if __name__ == "__main__":
    unittest.main()
