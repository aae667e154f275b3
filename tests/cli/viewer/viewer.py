"""Runs the viewer for the tests, on a display that nobody sees."""
import atexit
import functools
import os
import pathlib
import shutil
import subprocess
import time
import unittest

from PIL import Image

from cli.program import TYNDALL, ProgramTest

VIEWER = pathlib.Path(TYNDALL).parent / "tyndall-view"
XVFB = shutil.which("Xvfb")


@functools.cache
def display():
    """The environment of programs that draw on a display of this process; it lasts as long as the process."""
    reading, writing = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
                              pass_fds=[writing], stderr=subprocess.DEVNULL)
    atexit.register(server.terminate)
    os.close(writing)
    with os.fdopen(reading) as told:
        number = told.readline().strip()  # once it can be reached
    return {**os.environ, "DISPLAY": ":" + number, "ASAN_OPTIONS": "detect_leaks=0"}  # of the graphics driver


def read_png(path):
    """Width, height and rows of an 8-bit RGB picture."""
    picture = Image.open(path).convert("RGB")
    data, stride = picture.tobytes(), 3 * picture.width
    return picture.width, picture.height, [data[at:at + stride] for at in range(0, len(data), stride)]


@unittest.skipUnless(VIEWER.exists(), "tyndall-view was not built")
@unittest.skipUnless(XVFB, "Xvfb is not installed")
class ViewerTest(ProgramTest):
    def view(self, film, lines, *more, code=0, once=None, timeout=240):
        """Opens a scene, does what the lines say and quits; what it printed. `once`: a file, and what is done as soon as
        it is there."""
        script = self.write("script.txt", "\n".join([*lines, "quit"]))
        process = subprocess.Popen([VIEWER, film, "--script", script, "--stats", *map(str, more)], text=True,
                                   env=display(), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            if once:
                path, action = once
                while not path.exists() and process.poll() is None:
                    time.sleep(0.05)
                action()
            output, errors = process.communicate(timeout=timeout)
        finally:
            process.kill()
        self.assertEqual(process.returncode, code, errors)
        return output if code == 0 else errors
