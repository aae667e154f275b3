"""Runs the viewer for the tests, in a window nobody sees."""
import os
import pathlib
import shutil
import struct
import subprocess
import unittest
import zlib

from program import TYNDALL, ProgramTest

VIEWER = pathlib.Path(TYNDALL).parent / "tyndall-view"
XVFB = shutil.which("xvfb-run")


def read_png(path):
    """Width, height and rows of an 8-bit RGB picture."""
    data, at, packed = path.read_bytes(), 8, b""
    width, height = struct.unpack(">II", data[16:24])
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, rows, stride = zlib.decompress(packed), [], 3 * width
    before = bytearray(stride)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left, up = line[i - 3] if i >= 3 else 0, before[i]
            corner = before[i - 3] if i >= 3 else 0
            guess = left + up - corner
            nearest = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]
            line[i] = (line[i] + (0, left, up, (left + up) // 2, nearest)[kind]) & 255
        rows.append(bytes(line))
        before = line
    return width, height, rows


@unittest.skipUnless(VIEWER.exists(), "tyndall-view was not built")
class ViewerTest(ProgramTest):
    def command(self, *arguments):
        # The exit code goes into a file: xvfb-run has one of its own when it fails to tidy up.
        return ["xvfb-run", "-a", "-s", "-screen 0 1280x800x24", "sh", "-c", '"$@"; echo $? > "$0"',
                self.path("exit_code"), VIEWER, *map(str, arguments)]

    def exit_code(self):
        return int(self.path("exit_code").read_text())

    def environment(self):
        return {**os.environ, "ASAN_OPTIONS": "detect_leaks=0"}  # of the graphics driver

    def view(self, film, lines, *more, code=0, timeout=240):
        """Opens a scene, does what the lines say and quits; what it printed."""
        script = self.write("script.txt", "\n".join([*lines, "quit"]))
        result = subprocess.run(self.command(film, "--script", script, "--stats", *more), text=True, timeout=timeout,
                                capture_output=True, env=self.environment())
        self.assertEqual(self.exit_code(), code, result.stderr)
        return result.stdout if code == 0 else result.stderr

    def attributes(self, name):
        return self.succeed("info", "--json", self.path(name)).stdout
