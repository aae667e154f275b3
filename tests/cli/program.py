"""Runs the built program for the tests: fresh directories, small inputs, and what a refusal has to look like."""
import json
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile
import unittest
import zlib

from cli.exr import without_name

TYNDALL = os.environ.get("TYNDALL", "tyndall")
SOURCE = pathlib.Path(os.environ.get("TYNDALL_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
CORPORA = [SOURCE / "tests/data", pathlib.Path(os.environ.get("TYNDALL_SHARED_DATA", SOURCE / "../shared/data"))]

SANITIZED = "asan" in TYNDALL  # sanitizers make everything several times slower


def run(*arguments, timeout=60, **options):
    """Runs tyndall with the arguments; stdout and stderr as text."""
    options.setdefault("stdout", subprocess.PIPE)
    options.setdefault("stderr", subprocess.PIPE)
    return subprocess.run([TYNDALL, *map(str, arguments)], text=True, errors="replace", timeout=timeout, **options)


def corpus(*patterns):
    """Files by others below tests/data, and below the larger collection where there is one: each name once."""
    found = {path.relative_to(folder): path for folder in reversed(CORPORA) for pattern in patterns
             for path in folder.glob(pattern) if path.is_file()}
    assert found, f"no files {patterns}"
    return [found[name] for name in sorted(found)]


def recipe(**changes):
    """A small fog recipe: 32 x 16 x 32 voxels that change from frame to frame."""
    fog = {
        "bounds": {"low": [-1, 0, -1], "high": [1, 1, 1]},
        "voxel_size": 0.0625,
        "noise": {"octaves": 3, "scale": 0.7, "seed": 5},
        "density": {"threshold": 0.4, "gain": 3},
        "wind": [0.5, 0, 0],
    }
    fog.update(changes)
    return fog


def scene(**changes):
    """A camera, a sun and homogeneous fog: renders in a moment."""
    content = {
        "tyndall": 1,
        "frames": "1-3",
        "resolution": [64, 36],
        "camera": {"position": [0, 0.6, 3], "target": [0, 0.4, 0]},
        "lights": [{"name": "sun", "type": "sun", "direction": [-0.6, -0.7, -0.3], "intensity": 10}],
        "media": [{"type": "homogeneous", "extinction": 0.1, "bounds": {"low": [-50, -50, -50], "high": [50, 50, 50]}}],
        "background": {"color": [0.1, 0.2, 0.3]},
    }
    content.update(changes)
    return content


def lit_scene(**changes):
    """A box of fog in the sun: light that varies, with an edge in some pixels."""
    box = {"low": [-1, 0, -1], "high": [1, 1, 1]}
    return scene(**{"frames": "1", "resolution": [32, 18],
                    "media": [{"type": "homogeneous", "extinction": 0.5, "bounds": box}], **changes})


def gltf(**changes):
    """One triangle, its data in triangle.bin."""
    content = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"uri": "triangle.bin", "byteLength": 36}],
    }
    content.update(changes)
    return content


TRIANGLE = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)


def glb(content, binary=TRIANGLE):
    """The bytes of a binary glTF file."""
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body


def png_size(path):
    """Width and height of a PNG whose blocks are whole."""
    data = pathlib.Path(path).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, size, pixels = 8, None, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0]
        if kind == b"IHDR":
            size = struct.unpack(">II", body[:8])
        pixels += body if kind == b"IDAT" else b""
        at += 12 + length
    assert len(zlib.decompress(pixels)) == size[1] * (1 + 3 * size[0])
    return size


class ProgramTest(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.directory = pathlib.Path(tempfile.mkdtemp(prefix="tyndall_test_"))
        self.addCleanup(shutil.rmtree, self.directory, ignore_errors=True)

    def path(self, name):
        return self.directory / name

    def write(self, name, content):
        """Writes bytes, text, or anything else as JSON; returns the path."""
        path = self.path(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    def files(self):
        """Every file and directory below the test's directory, hidden ones too."""
        return sorted(str(path.relative_to(self.directory)) for path in self.directory.rglob("*"))

    def content(self, place):
        """Every file in a directory by name, temporaries too; images without the name of their folder."""
        path = self.path(place)
        files = {file.name: file.read_bytes() for file in path.iterdir()} if path.is_dir() else {}
        return {name: without_name(data) if name.endswith(".exr") else data for name, data in files.items()}

    def write_triangle(self):
        self.write("triangle.bin", TRIANGLE)
        return self.write("triangle.gltf", gltf())

    def info(self, name):
        return json.loads(self.succeed("info", "--json", self.path(name)).stdout)

    def attributes(self, name):
        return self.info(name)["attributes"]

    def succeed(self, *arguments, **options):
        result = run(*arguments, **options)
        self.assertEqual(result.returncode, 0, f"{arguments}: {result.stderr}")
        return result

    def check_refusal(self, result, code, *words):
        """One line of error with these words, the exit code, and nothing a terminal would obey."""
        context = f"exit {result.returncode}, stderr: {result.stderr!r}"
        self.assertEqual(result.returncode, code, context)
        lines = result.stderr.splitlines()
        self.assertEqual(len(lines), 1, context)
        self.assertTrue(lines[0].startswith("tyndall: error: "), context)
        self.assertLessEqual(len(lines[0].encode()), 500, context)
        self.assertFalse([c for c in lines[0] if ord(c) < 32 or ord(c) == 127], context)
        for word in words:
            self.assertIn(str(word), lines[0], context)

    def refuse(self, code, words, *arguments, **options):
        """Runs, expects the refusal and no change to the test's directory."""
        before = self.files()
        self.check_refusal(run(*arguments, **options), code, *words)
        self.assertEqual(self.files(), before, arguments)
