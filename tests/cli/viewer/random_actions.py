"""Actions by chance for the viewer: every verb of scripts, keys, drags over panels and picture, on copies of scenes.

    cd tests && python3 -m cli.viewer.random_actions ../build/asan/tyndall --minutes 30 --seed 1

Wants Xvfb. Says how the viewer ended and how its memory grew; exit code 1 when it failed or went on growing.
"""
import argparse
import json
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

from cli.viewer.viewer import display

SOURCE = pathlib.Path(__file__).resolve().parents[3]
SCENES = ("window", "spotlight", "pillars", "lantern", "cloud", "forest_morning", "concert", "cumulus_sky")
WINDOW = (1280, 800)
KEYS = ["space", "left", "right", "home", "tab", "f1", "f5", "[", "]", "ctrl+z", "ctrl+y", "ctrl+s", *"12345678lvpwsadqegt"]
LARGEST = {"pixel.samples": 16}  # what else would only take long
GROWTH = 1.15  # of the most memory, from the second third of the time to the last


def copies_of_scenes(directory):
    """Scenes that may be written to."""
    for name in ("scenes", "volumes"):
        shutil.copytree(SOURCE / name, directory / name)
    return [directory / "scenes" / f"{name}.json" for name in SCENES]


def media_of(scene, kind=None):
    media = json.loads(scene.read_text())["media"]
    return [medium["name"] for medium in media if kind in (None, medium["type"])]


class Actions:
    """Lines of a script; each asks nothing that the viewer would refuse."""

    def __init__(self, seed, scenes, program):
        self.random, self.scenes, self.frames = random.Random(seed), scenes, 0
        self.last_pixel = 20  # across and down, that every picture of this size has
        self.media, self.grown = media_of(scenes[0]), media_of(scenes[0], "noise")
        table = json.loads(subprocess.run([program, "modes", "--json"], capture_output=True, check=True).stdout)
        self.modes = [mode["name"] for mode in table["modes"]]
        self.rows = table["settings"]
        text = subprocess.run([program, "view", "--help"], capture_output=True, text=True, check=True).stdout
        self.verbs = re.findall(r"^  ([a-z-]+)", text.split("Actions of a script:")[1].split("Exit codes")[0], re.M)
        unknown = [verb for verb in self.verbs if verb != "quit" and not hasattr(self, verb.replace("-", "_"))]
        if unknown:
            raise SystemExit(f"random_actions.py: knows nothing of {unknown}")

    def line(self):
        verb = self.random.choices(self.verbs, [self.weight(verb) for verb in self.verbs])[0]
        words = getattr(self, verb.replace("-", "_"))()
        if verb == "orders":
            return f"mode march\norders {words[0]}"  # few modes follow light on
        after = "\nstop\nwait samples 1" if verb == "open" else ""  # what follows means the new one
        before = "stop-job\n" if verb in ("render", "bake") else ""  # that a click may have started
        return before + " ".join([verb, *(f'"{word}"' if " " in str(word) else str(word) for word in words)]) + after

    def weight(self, verb):
        return {"quit": 0, "open": 0.3, "snapshot": 0.1, "screenshot": 0.2, "size": 0.3, "set": 4, "drag": 6, "key": 4,
                "play": 0.5, "save": 0.3, "save-as": 0.2, "edit": 4, "undo": 2, "render": 0.1, "bake": 0.1 if self.grown else 0,
                "stop-job": 0.3, "copy-command": 0, "close": 0, "answer": 0}.get(verb, 1)

    def number(self, low, high):
        return round(self.random.uniform(low, high), 3)

    def pair(self, low, high):
        return [self.number(low, high), self.number(low, high)]

    def switch(self):
        return [self.random.choice(["on", "off"])]

    def row(self):
        return self.random.choice(self.rows)

    def open(self):
        scene = self.random.choice(self.scenes)
        self.media, self.grown = media_of(scene), media_of(scene, "noise")
        return [scene]

    def set(self):
        row = self.row()
        if "choices" in row:
            return [row["name"], self.random.choice(row["choices"])]
        high = LARGEST.get(row["name"], row["high"])
        low, high = max(row["low"], -100), min(high, 100)
        if "," in row["values"]["preview"]:
            return [row["name"], ",".join(str(self.number(max(low, 0), min(high, 2))) for _ in range(3))]
        value = low + (high - low) * self.random.random() ** 3
        return [row["name"], round(value) if row["integer"] else f"{max(value, low):.4g}"]

    def reset(self):
        return [self.random.choice(["all", self.row()["name"]])]

    def mode(self):
        return [self.random.choice(self.modes)]

    def beside(self):
        return self.random.choice([[], ["reference"], [self.random.choice(self.modes)]])

    def arrange(self):
        return [self.random.choice(["wipe", "side"])]

    def explain(self):
        pixel = [self.random.randint(0, self.last_pixel), self.random.randint(0, self.last_pixel)]
        return self.random.choice([[], pixel])

    def medium(self):
        return [self.random.choice(self.media)]

    def slice(self):
        return [self.random.choice("xyz"), self.number(0, 1)]

    def project(self):
        return [self.random.choice("xyz"), self.random.choice(["maximum", "mean"])]

    def edit(self):
        path, value = self.random.choice([
            ("exposure", self.number(-2, 2)), ("ambient", f"{self.number(0, 0.1)} 0.02 0.03"),
            ("lights/0/intensity", self.number(0.1, 500)), ("lights/0/color", f"1 {self.number(0, 1)} 0.5"),
            ("media/0/extinction", self.number(0.01, 3)), ("media/0/g", self.number(-0.8, 0.8))])
        return [path, value, *self.random.choice([[], [self.random.randint(1, 9)]])]

    def cancel(self):
        return [self.random.randint(1, 9)]

    def save_as(self):
        self.frames += 1
        return [self.scenes[0].parent / f"other_{self.frames}.json"]

    def select(self):
        return [self.random.choice(["lights/0", "media/0", "scene"])]

    def tab(self):
        return [self.random.choice(["render", "lights"])]

    def missing(self):
        return [self.random.choice(["error", "hold", "skip"])]

    def wipe(self):
        return [self.number(0, 1)]

    def quality(self):
        return [self.random.choice(["draft", "preview", "final"])]

    def orders(self):
        return [self.random.choice([1, 1, 2, 3])]

    def show(self):
        return [self.random.choice(["picture", "fog", "transmittance", "depth", "validity", "stops", "error"])]

    def exposure(self):
        return [self.random.choice(["auto", "scene", self.number(-4, 4), self.number(-4, 4)])]

    def brighten(self):
        return [self.number(-4, 4)]

    def view_transform(self):
        return [self.random.choice(["filmic", "srgb"])]

    def zoom(self):
        return [self.random.choice(["fit", 0.5, 1, 3])]

    def orbit(self):
        return self.pair(-40, 40)

    turn = orbit

    def pan(self):
        return self.pair(-0.3, 0.3)

    def dolly(self):
        return [self.number(0.7, 1.4)]

    def fly(self):
        return [self.number(-0.3, 0.3) for _ in range(3)]

    def size(self):
        size = self.random.choice([[0, 0], [320, 180], [97, 61], [1, 1], [640, 360]])
        self.last_pixel = 0 if size == [1, 1] else 20
        return size

    def frame(self):
        return [self.random.randint(1, 24)]

    def step(self):
        return [self.random.randint(-3, 3)]

    def play(self):
        return [self.random.randint(1, 8)]

    def nothing(self):
        return []

    reload = stop = undo = redo = save = camera = close = answer = stop_job = copy_command = nothing
    loop = panels = help = handles = volume = switch

    def key(self):
        return [self.random.choice(KEYS)]

    def drag(self):
        point = lambda: f"{self.random.randrange(WINDOW[0])},{self.random.randrange(WINDOW[1])}"
        return [point(), point()]

    def wait(self):
        return [self.number(0, 0.5)]

    def snapshot(self):
        self.frames += 1
        return [f"picture.{self.frames % 3}.{self.random.choice(['exr', 'png'])}"]

    def screenshot(self):
        return ["window.png"]

    def frames_of_job(self):
        first = self.random.randint(1, 20)
        return f"{first}-{first + self.random.randint(0, 3)}"

    def render(self):
        return ["frames.####.exr", self.frames_of_job(), self.random.choice(["exr", "png"])]

    def bake(self):
        return [self.random.choice(self.grown), "fog.####.vdb", self.frames_of_job()]


def script(actions, seconds):
    """Lines that take about so long, going by their pauses."""
    lines, left = [], seconds
    while left > 0:
        pause = round(actions.random.random() ** 3, 2)
        lines += [actions.line(), f"wait {pause}"]
        left -= pause
    return "\n".join([*lines, "stop-job", "quit"]) + "\n"


def memory_of(process):
    """Bytes that a process holds; 0 when it has ended."""
    try:
        return 1024 * int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{process.pid}/status").read_text()).group(1))
    except (OSError, AttributeError):
        return 0


def run(program, seconds, seed, directory):
    """Exit code, what was said, and (seconds, bytes) every second."""
    actions = Actions(seed, copies_of_scenes(directory), program)
    (directory / "actions.txt").write_text(script(actions, seconds))
    command = [pathlib.Path(program).resolve().parent / "tyndall-view", actions.scenes[0], "--script", "actions.txt",
               "--stats"]
    start, memory = time.monotonic(), []
    with open(directory / "said.txt", "w") as said:
        process = subprocess.Popen(command, cwd=directory, stdout=said, stderr=said, env=display())
        while process.poll() is None:
            memory.append((time.monotonic() - start, memory_of(process)))
            time.sleep(1)
    return process.returncode, (directory / "said.txt").read_text(), memory


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="tyndall, beside which tyndall-view lies")
    parser.add_argument("--minutes", type=float, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", metavar="DIR", help="where the script and what was said stay")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        directory = pathlib.Path(args.keep or temporary).resolve()
        directory.mkdir(parents=True, exist_ok=True)
        code, said, memory = run(args.program, 60 * args.minutes, args.seed, directory)
    print(said.strip()[-4000:])
    thirds = [max((bytes for _, bytes in memory[i * len(memory) // 3:(i + 1) * len(memory) // 3]), default=0)
              for i in range(3)]
    print(f"exit code {code} after {memory[-1][0]:.0f} s; most memory in each third: "
          + ", ".join(f"{part / 1e6:.0f} MB" for part in thirds))
    return 1 if code != 0 or thirds[2] > GROWTH * thirds[1] else 0


if __name__ == "__main__":
    sys.exit(main())
