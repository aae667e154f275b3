"""Environment maps from the file to the shafts in fog: the penumbra of an edge is that of the map's texels."""
import math
import struct
import unittest

from cli.exr import read_channels
from cli.program import CORPORA, ProgramTest, gltf, scene

ROOF, REACH = 100, 2000  # height of a roof over x < 0, and how far it goes
LENGTH, EXTINCTION = 100, 0.003  # of a sheet of fog along the view
WIDTH = 32  # of the image, one pixel high


def radiance_file(width, height, texel):
    """A Radiance file without runs; texel(x, y) is three mantissas and their exponent."""
    head = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    return head.encode() + bytes(value for y in range(height) for x in range(width) for value in texel(x, y))


def read_radiance(path):
    """The rows of a Radiance file, each a list of colors, for files without runs or with those of 1991."""
    data = path.read_bytes()
    at = data.index(b"\n\n") + 2
    end = data.index(b"\n", at)
    words, at = data[at:end].split(), end + 1
    height, width = int(words[1]), int(words[3])
    rows = []
    for _ in range(height):
        if data[at:at + 2] == b"\2\2":
            at, line = at + 4, bytearray()
            while len(line) < 4 * width:
                count = data[at]
                line += data[at + 1:at + 2] * (count - 128) if count > 128 else data[at + 1:at + 1 + count]
                at += 2 if count > 128 else 1 + count
            texels = zip(*(line[channel * width:(channel + 1) * width] for channel in range(4)))
        else:
            texels = struct.iter_unpack("4B", data[at:at + 4 * width])
            at += 4 * width
        rows.append([tuple(math.ldexp(value, exponent - 136) if exponent else 0 for value in color)
                     for *color, exponent in texels])
    return rows


def parts_of(rows):
    """Parts of texels as latitude, longitude, solid angle and color, bilinear between the texels' centers; 24 x 24 where a
    texel or one beside it is bright, one elsewhere."""
    height, width = len(rows), len(rows[0])
    limit = 0.02 * max(max(color) for row in rows for color in row)
    bright = {(x + i, y + j) for y, row in enumerate(rows) for x, color in enumerate(row) if max(color) > limit
              for i in (-1, 0, 1) for j in (-1, 0, 1)}
    for y, row in enumerate(rows):
        for x, color in enumerate(row):
            count = 24 if (x, y) in bright else 1
            for j in range(count):
                top, bottom = (math.pi * (y + edge / count) / height for edge in (j, j + 1))
                solid_angle = 2 * math.pi / width / count * (math.cos(top) - math.cos(bottom))
                v = y + (j + 0.5) / count - 0.5
                for i in range(count):
                    u = x + (i + 0.5) / count - 0.5
                    if count > 1:
                        color = bilinear(rows, u, v)
                    yield (top + bottom) / 2, 2 * math.pi * ((u + 0.5) / width - 0.5), solid_angle, color


def bilinear(rows, u, v):
    x, y, s, t = math.floor(u), math.floor(v), u % 1, v % 1

    def texel(x, y):
        return rows[min(max(y, 0), len(rows) - 1)][x % len(rows[0])]

    corners = ((1 - s) * (1 - t), texel(x, y)), (s * (1 - t), texel(x + 1, y)), ((1 - s) * t, texel(x, y + 1)), (s * t, texel(x + 1, y + 1))
    return [sum(weight * color[c] for weight, color in corners) for c in range(3)]


class Environment(ProgramTest):
    def expected(self, rows, rotation, low, pixel):
        """Light scattered once by the sheet, isotropically, in each pixel: integrated over the directions that the roof
        does not block, each dimmed on its way into the sheet."""
        left, edges = [0.0] * 3, [[0.0] * 3 for _ in range(8 * WIDTH + 1)]
        for polar, turn, solid_angle, color in parts_of(rows):
            up, across = math.cos(polar), math.sin(polar)
            x, z = across * math.sin(turn - rotation), -across * math.cos(turn - rotation)
            way = min(0.5 * pixel / max(abs(up), 1e-9), LENGTH / 2)
            light = solid_angle * math.exp(-EXTINCTION * way)
            at_roof = (x * ROOF / up, z * ROOF / up) if up > 0 else (math.inf, math.inf)
            free = 8 * (-at_roof[0] - low) / pixel - 0.5  # the first middle of an eighth of a pixel that sees past the roof
            if abs(at_roof[1]) > REACH or low + WIDTH * pixel + at_roof[0] < -REACH:
                free = 0
            place = left if free <= 0 else edges[min(math.ceil(free), 8 * WIDTH)]
            for c in range(3):
                place[c] += light * color[c]
        pixels, sum_ = [], list(left)
        scattered = (1 - math.exp(-EXTINCTION * LENGTH)) / (4 * math.pi)
        for column in range(WIDTH):
            mean = [0.0] * 3
            for eighth in range(8):
                for c in range(3):
                    sum_[c] += edges[8 * column + eighth][c]
                    mean[c] += sum_[c] * scattered / 8
            pixels.append(mean)
        return pixels

    def check(self, file, rotation, sun, pixel):
        """March and paths against that sum, around the penumbra of the texel `sun`."""
        rows = read_radiance(file)
        polar = math.pi * (sun[1] + 0.5) / len(rows)
        turn = 2 * math.pi * ((sun[0] + 0.5) / len(rows[0]) - 0.5) - math.radians(rotation)
        middle = -ROOF * math.tan(polar) * math.sin(turn)
        low = middle - 0.5 * WIDTH * pixel
        expected = self.expected(rows, math.radians(rotation), low, pixel)

        corners = (-REACH, ROOF, -REACH), (0, ROOF, -REACH), (0, ROOF, REACH), (-REACH, ROOF, REACH)
        corners = [corners[i] for i in (0, 1, 2, 0, 2, 3)]
        self.write("triangle.bin", b"".join(struct.pack("<3f", *corner) for corner in corners))
        self.write("roof.gltf", gltf(
            accessors=[{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3", "min": list(corners[0]), "max": list(corners[2])}],
            bufferViews=[{"buffer": 0, "byteLength": 72}], buffers=[{"uri": "triangle.bin", "byteLength": 72}]))
        reach = WIDTH * pixel
        content = scene(frames="1", resolution=[WIDTH, 1], gltf="roof.gltf", background={"color": 0},
                        camera={"position": [middle, 0, LENGTH], "target": [middle, 0, 0], "ortho_height": pixel},
                        lights=[{"type": "environment", "image": str(file), "rotation": rotation}],
                        media=[{"type": "homogeneous", "extinction": EXTINCTION, "albedo": 1, "phase": "isotropic",
                                "bounds": {"low": [middle - reach, -pixel / 2, -LENGTH / 2], "high": [middle + reach, pixel / 2, LENGTH / 2]}}])
        self.write("scene.json", content)
        for mode in ("march", "path"):
            self.succeed("render", self.path("scene.json"), "-o", self.path("a.exr"), "--mode", mode, "--orders", 1, "--samples", 4096,
                         "--set", "pixel.filter=box", "--set", "pixel.filter_radius=0.5", "--aov", "inscatter,variance", "--float", "-q")
            found = read_channels(self.path("a.exr"))
            for c, name in enumerate("RGB"):
                values = [color[c] for color in expected]
                step = max(values) - min(values)
                variances = found["Variance." + name]
                self.assertLess(math.sqrt(sum(variances) / WIDTH), 0.03 * step, "noise that would hide an edge in another place")
                # Beside the noise, three thousandths for a sky that is even over each texel, and for the ends of the sheet.
                for column, (seen, variance) in enumerate(zip(found["inscatter." + name], variances)):
                    self.assertAlmostEqual(seen, values[column], delta=4.5 * math.sqrt(variance) + 0.003 * step,
                                           msg=(file.name, mode, name, column))
        return expected

    def test_a_sun_of_three_colors(self):
        """Its red, green and blue texels lie side by side, then one above the other."""
        colors = [(255, 8, 8, 137), (8, 255, 8, 136), (8, 8, 255, 139)]  # of similar luminance, so that each is sampled
        for name, texels in (("row", [(40, 7), (41, 7), (42, 7)]), ("column", [(20, 6), (20, 7), (20, 8)])):
            suns = dict(zip(texels, colors))
            file = self.write(f"{name}.hdr", radiance_file(64, 32, lambda x, y: suns.get((x, y), (128, 140 + x, 200 - 2 * y, 124))))
            expected = self.check(file, 23, texels[1], 3)
            red, green, blue = ([color[c] for color in expected] for c in range(3))
            halves = [next(i for i, value in enumerate(one) if value > (one[0] + one[-1]) / 2) for one in (red, green, blue)]
            self.assertEqual(len(set(halves)), 3, "the colors have edges of their own")

    def test_the_sun_of_a_photographed_sky(self):
        file = next((path / "hdr/kloppenheim_05_1k.hdr" for path in CORPORA if (path / "hdr/kloppenheim_05_1k.hdr").exists()), None)
        if not file:
            self.skipTest("this file does not travel with the program")
        self.check(file, 37, (614, 43), 0.1)


if __name__ == "__main__":
    unittest.main()
