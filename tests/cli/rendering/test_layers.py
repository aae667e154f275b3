"""Layers that add up to the picture in every mode, and what alpha covers."""
import json
import math
import struct
import unittest
import zlib

from cli.exr import added, read_channels
from cli.layered import LAMPS, PARTS, fog, panes
from cli.program import SOURCE, TRIANGLE, ProgramTest, lit_scene

OTHER = ("ambient", "emission", "multiple")


def png(width, height, pixel):
    """An 8-bit RGB picture; pixel(x, y) gives its bytes."""
    lines = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(width)) for y in range(height))

    def block(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    return (b"\x89PNG\r\n\x1a\n" + block(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)) +
            block(b"IDAT", zlib.compress(lines)) + block(b"IEND", b""))


class LayersTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("triangle.bin", TRIANGLE)
        self.write("panes.gltf", panes())
        self.write("sky.png", png(8, 4, lambda x, y: (30 * x, 60 * y, 90)))
        self.rich = self.write("rich.json", lit_scene(
            gltf="panes.gltf", lights=LAMPS, ambient=[0.1, 0.2, 0.3], background={"image": "sky.png", "intensity": 0.5},
            media=[fog(), fog(extinction=0.3, emission=[0, 0, 0], albedo=[0.9, 0.5, 0.3])]))

    def render(self, scene, name, *options, aov=PARTS, samples=2):
        options += ("--samples", samples) if samples else ()
        self.succeed("render", scene, "-o", self.path(name), "--frames", "1", "--aov", aov, "-q", *options)
        return self.read(name)

    def read(self, name):
        """The channels, and the layers that make up inscatter in their order."""
        channels = read_channels(self.path(name))
        lights = self.attributes(name)["tyndall:lights"].split() if any("light_" in c for c in channels) else []
        return channels, lights + [part for part in OTHER if f"{part}.R" in channels]


class Layers(LayersTest):
    def sums(self, channels, parts):
        for c in "RGB":
            behind = [channels[f"{part}.{c}"] for part in ("surface", "background") if f"{part}.{c}" in channels]
            yield added(*(channels[f"{part}.{c}"] for part in parts)), channels[f"inscatter.{c}"]
            yield added(*behind, channels[f"inscatter.{c}"]), channels[c]

    def check_exact(self, name):
        channels, parts = self.read(name)
        for sum, whole in self.sums(channels, parts):
            self.assertEqual(sum, whole, name)
        return channels, parts

    def check_all_modes(self, scene, *options, modes="all"):
        """Renders float layers in all modes, and the pictures alone, which have to be the same up to rounding."""
        for aov, name in ((PARTS, "layers.exr"), ("none", "alone.exr")):
            self.succeed("render", scene, "-o", self.path(name), "--frames", "1", "--samples", "2", "--mode", modes,
                         "--float", "--aov", aov, "-q", *options)
        found = sorted(self.directory.glob("layers.*.exr"))
        self.assertGreater(len(found), 1)
        for path in found:
            channels, _ = self.check_exact(path.name)
            alone = read_channels(self.path(path.name.replace("layers", "alone")))
            squares = sum((x - y) ** 2 for c in "RGB" for x, y in zip(channels[c], alone[c]))
            mean = sum(sum(alone[c]) for c in "RGB") / (3 * len(alone["R"]))
            self.assertLessEqual((squares / (3 * len(alone["R"]))) ** 0.5, 1e-6 * mean, path.name)

    def test_they_add_up_bit_for_bit_in_all_modes(self):
        self.check_all_modes(self.rich)
        _, parts = self.read("layers.march.exr")
        self.assertEqual(parts, ["light_sun", "light_a_lamp", "ambient", "emission"])
        channels, _ = self.read("layers.march.exr")
        for layer in [*parts, "surface", "background", "inscatter"]:
            self.assertGreater(max(channels[f"{layer}.G"]), 0, layer)

    def test_light_of_meshes_has_a_layer_where_nothing_else_glows(self):
        scene = self.write("glow.json", lit_scene(gltf="panes.gltf", media=[fog(emission=[0, 0, 0])]))
        for mode in ("march", "froxel", "shadow-map", "shadow-volume", "cone", "path"):
            self.render(scene, "glow.exr", "--float", "--mode", mode)
            with self.subTest(mode=mode):
                channels, parts = self.check_exact("glow.exr")
                self.assertIn("emission", parts)
                self.assertGreater(max(channels["emission.G"]), 0)

    def test_they_add_up_in_scenes_that_ship(self):
        for scene in ("spotlight", "pillars"):
            self.check_all_modes(SOURCE / f"scenes/{scene}.json", "--res", "48x27", "--quality", "draft")

    def test_they_add_up_with_multiple_scattering_and_history(self):
        self.check_all_modes(self.rich, "--orders", "3", "--quality", "draft", modes="march,froxel,path")
        _, parts = self.read("layers.froxel.exr")
        self.assertEqual(parts[-1], "multiple")
        _, parts = self.read("layers.path.exr")
        self.assertNotIn("multiple", parts, "path knows whose light it is")
        self.check_all_modes(self.rich, "--history", "3", modes="froxel,cone,shadow-map")
        self.check_all_modes(self.rich, "--set", "cone.resolution=half", "--set", "shadow_map.fog_resolution=half",
                             modes="cone,shadow-map")

    def test_halves_add_up_within_their_rounding(self):
        channels, parts = self.render(self.rich, "half.exr")
        exact, _ = self.render(self.rich, "float.exr", "--float")
        for sum, whole in self.sums(channels, parts):
            for x, y in zip(sum, whole):
                self.assertLessEqual(abs(x - y), 2 ** -10 * abs(y) + 1e-6)
        self.assertNotEqual(channels["inscatter.R"], exact["inscatter.R"])

    def test_settings_decide_what_is_measured_and_still_add_up(self):
        self.render(self.rich, "noise.exr", "--float", aov=PARTS + ",variance,halves", samples=32)
        self.check_exact("noise.exr")
        self.render(self.rich, "goal.exr", "--float", "--target-error", "0.3", samples=None)
        self.check_exact("goal.exr")

    def test_a_crop_is_part_of_the_whole(self):
        for mode in ("march", "path", "radial-blur"):
            for options in ([], ["--background", "off"]):
                aov = PARTS if not options else PARTS.replace("background,", "")
                whole, _ = self.render(self.rich, "whole.exr", "--mode", mode, *options, aov=aov)
                crop, _ = self.render(self.rich, "crop.exr", "--mode", mode, "--crop", "8,4,20,13", *options, aov=aov)
                for name, values in crop.items():
                    part = [whole[name][32 * y + x] for y in range(4, 13) for x in range(8, 20)]
                    self.assertEqual(values.tolist(), part, f"{mode} {name}")

    def test_only_layers_that_the_scene_has_are_written(self):
        scene = self.write("plain.json", lit_scene())
        options = ("--samples", "1", "--aov", "inscatter,lights,ambient,emission,multiple")
        result = self.succeed("render", scene, "-o", self.path("plain.exr"), *options)
        self.assertIn("note: no layer ambient, emission, multiple", result.stderr)
        names = {channel["name"].split(".")[0] for channel in self.info("plain.exr")["channels"]}
        self.assertEqual(names, {"R", "G", "B", "A", "inscatter", "light_sun"})
        again = self.succeed("render", scene, "-o", self.path("plain.exr"), *options, "--resume", "--json")
        self.assertTrue(json.loads(again.stdout)["frames"][0]["kept"])


class Background(LayersTest):
    def test_alpha_is_one_where_the_background_is_in_the_picture(self):
        for mode in ("march", "path", "radial-blur", "froxel"):
            with_it, _ = self.render(self.rich, "on.exr", "--float", "--mode", mode)
            without, _ = self.render(self.rich, "off.exr", "--float", "--mode", mode, "--background", "off",
                                     aov=PARTS.replace("background,", ""))
            self.assertEqual(set(with_it["A"]), {1.0}, mode)
            self.assertLess(min(without["A"]), 0.05, mode)
            self.assertEqual(max(without["A"]), 1, mode)
            self.assertTrue(0.1 < without["A"][32 * 9 + 20] < 1, f"{mode}: fog")
            for c in "RGB":
                self.assertEqual(without[f"surface.{c}"], with_it[f"surface.{c}"], mode)
                self.assertEqual(without[f"inscatter.{c}"], with_it[f"inscatter.{c}"], mode)
                self.assertEqual(without[c], added(without[f"surface.{c}"], without[f"inscatter.{c}"]), mode)

    def test_over_the_background_is_the_picture_with_it(self):
        scene = self.write("even.json", lit_scene(background={"color": [0.3, 0.5, 0.2]}, ambient=[0.1, 0.1, 0.1]))
        whole, _ = self.render(scene, "whole.exr", "--float", aov="none")
        front, _ = self.render(scene, "front.exr", "--float", "--background", "off", aov="none")
        for c, plate in zip("RGB", (0.3, 0.5, 0.2)):
            for value, own, alpha in zip(whole[c], front[c], front["A"]):
                self.assertAlmostEqual(value, own + (1 - alpha) * plate, delta=1e-6)

    def test_none_covers_nothing_and_a_black_one_all(self):
        none = self.write("none.json", {k: v for k, v in lit_scene().items() if k != "background"})
        self.assertLess(min(self.render(none, "none.exr", aov="none")[0]["A"]), 0.05)
        black = self.write("black.json", lit_scene(background={"color": [0, 0, 0]}))
        self.assertEqual(set(self.render(black, "black.exr", aov="none")[0]["A"]), {1.0})

    def test_the_header_and_resume_know_the_option(self):
        options = ("--samples", "1", "--resume", "--json")

        def kept(*more):
            result = self.succeed("render", self.rich, "-o", self.path("out.exr"), *options, *more)
            return json.loads(result.stdout)["frames"][0]["kept"]

        self.assertFalse(kept("--background", "off"))
        self.assertIn(" --background off", self.attributes("out.exr")["tyndall:command"])
        self.assertTrue(kept("--background", "off"))
        self.assertFalse(kept())
        self.assertNotIn("--background", self.attributes("out.exr")["tyndall:command"])
        self.assertTrue(kept("--background", "on"))

    def test_it_has_no_layer_when_it_is_left_out(self):
        refused = ["render", self.rich, "-o", self.path("out.exr"), "--background", "off", "--aov", "background"]
        self.refuse(2, ["--aov", "--background off"], *refused)
        self.refuse(2, ["--background", "of"], "render", self.rich, "-o", self.path("out.exr"), "--background", "of")


class ColoredFog(LayersTest):
    """The transmittance of each channel, where fog dims them differently."""
    EXTINCTION = (0.2, 0.6, 1.2)

    def colored(self, **changes):
        return self.write("colored.json", lit_scene(
            lights=LAMPS, media=[fog(extinction=list(self.EXTINCTION), emission=[0, 0, 0])], **changes))

    def test_each_channel_is_dimmed_by_its_extinction(self):
        for mode in ("march", "froxel"):
            channels, _ = self.render(self.colored(), "a.exr", "--mode", mode, "--float", "--background", "off",
                                      aov="transmittance", samples=1)
            foggy = 0
            for i, mean in enumerate(channels["transmittance.T"]):
                own = [channels[f"transmittance.{c}"][i] for c in "RGB"]
                self.assertAlmostEqual(sum(own) / 3, mean, delta=2e-6, msg=mode)
                self.assertAlmostEqual(channels["A"][i], 1 - mean, delta=2e-6, msg=mode)
                if mode != "march":  # froxels mix transmittances, not depths
                    continue
                meters = [-math.log(value) / extinction for value, extinction in zip(own, self.EXTINCTION)]
                # One length for all channels; at the edges, where a pixel has several rays, means of exp(-length) are
                # those of a shorter one the more the fog dims.
                self.assertGreater(meters[0] - meters[1], -1e-4)
                self.assertGreater(meters[1] - meters[2], -1e-4)
                foggy += meters[2] > 1 and meters[0] - meters[2] < 1e-3
            if mode == "march":
                self.assertGreater(foggy, 20)

    def test_every_frame_has_the_layer_and_gray_scenes_have_none(self):
        white = {"keys": [[0, list(self.EXTINCTION)], [1, [0.5, 0.5, 0.5]]]}
        path = self.write("keyed.json", lit_scene(lights=LAMPS, media=[fog(extinction=white)], frame_rate=1, frames="0-1"))
        self.succeed("render", path, "-o", self.path("k.####.exr"), "--samples", "2", "--float", "-q")
        for frame in (0, 1):
            channels = read_channels(self.path(f"k.{frame:04}.exr"))
            self.assertEqual(channels["transmittance.R"] == channels["transmittance.B"], frame == 1)
        self.assertIn("transmittance.T", self.render(self.rich, "gray.exr", aov="transmittance")[0])
        self.assertNotIn("transmittance.R", self.render(self.rich, "gray.exr", aov="transmittance")[0])
        # What is there is used again.
        made = self.path("k.0000.exr").stat().st_mtime_ns
        self.succeed("render", path, "-o", self.path("k.####.exr"), "--samples", "2", "--float", "-q", "--resume")
        self.assertEqual(self.path("k.0000.exr").stat().st_mtime_ns, made)

    def test_compare_and_crop_know_it(self):
        scene = self.colored(gltf="panes.gltf")
        whole, _ = self.render(scene, "whole.exr", "--float", aov="transmittance," + PARTS)
        crop, _ = self.render(scene, "crop.exr", "--float", "--crop", "8,4,20,13", aov="transmittance," + PARTS)
        for name, values in crop.items():
            self.assertEqual(values.tolist(), [whole[name][32 * y + x] for y in range(4, 13) for x in range(8, 20)], name)
        self.succeed("compare", self.path("whole.exr"), self.path("whole.exr"))

    def test_parts_make_the_bits_of_one_run(self):
        scene = self.colored(gltf="panes.gltf")
        for layers in ("transmittance", "transmittance," + PARTS):
            self.succeed("plan", scene, "--save", self.path("plan.json"), "-q", "--samples", "4", "--groups", "2", "--float",
                         "--aov", layers, "--mode", "march")
            self.succeed("render", "--plan", self.path("plan.json"), "-o", self.path("one.exr"), "-q")
            for part in (1, 2, 3):
                self.succeed("render", "--plan", self.path("plan.json"), "-o", self.path("f.exr"), "--part", f"{part}/3", "-q")
            self.succeed("merge", *sorted(self.directory.glob("f.part-*-of-3.exr")), "-o", self.path("merged.exr"), "-q")
            one = read_channels(self.path("one.exr"))
            self.assertEqual(read_channels(self.path("merged.exr")), one)
            self.assertNotEqual(one["transmittance.R"], one["transmittance.B"])
            for path in self.directory.glob("f.part-*"):
                path.unlink()


if __name__ == "__main__":
    unittest.main()
