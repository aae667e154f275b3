"""Frames in parts: whether merged parts are, bit for bit, what one run of their plan renders.

    parts.py [--seeds 6001-6050] [--scenes window,cloud,lantern] [--counts 1,2,3,5,8,64] [--program build/release/tyndall]
             [-o DIR] [--jobs 2]

Of every seed, mode, size, samples or target, orders, layers and groups are drawn by chance. Parts arrive in a shuffled
order, each rendered by one thread or by two. Prints a row a frame and writes DIR/parts.json; ends with 1 at any difference."""
import argparse
import concurrent.futures
import json
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

from families import draw, family_of
from pictures import read_channels
from run import numbers
from scene_files import write_scene

SOURCE = pathlib.Path(__file__).parents[2]
LAYERS = "Z,inscatter,transmittance,surface,background,lights,ambient,emission,multiple,validity"
SPREAD = ",variance,halves"
MOST = (160, 90)  # pixels
SIZE = ("--res", f"{MOST[0]}x{MOST[1]}")
SHIPPED = {  # scenes of the repository and what is asked of them
    "window": ("--mode", "march", "--samples", 16, *SIZE, "--aov", LAYERS + SPREAD),
    "cloud": ("--mode", "path", "--orders", "all", "--samples", 4, *SIZE, "--aov", LAYERS + SPREAD),
    "lantern": ("--mode", "march", "--target-error", 0.03, *SIZE, "--aov", LAYERS + SPREAD)}
LIMIT = re.compile(r"this frame can have at most (\d+) parts")


def options_of(chance, size):
    """What is asked of a drawn scene, and the layers that it allows for."""
    mode, has_target = chance.choice(["march", "froxel", "path"]), chance.random() < 0.4
    share = min(1, MOST[0] / size[0]) * chance.choice([0.25, 0.5] if mode == "path" or has_target else [0.25, 0.5, 1])
    options = ["--mode", mode, "--res", f"{round(share * size[0])}x{round(share * size[1])}"]
    samples, groups = chance.choice([1, 2, 4, 8, 12]), chance.choice([None, 1, 2, 3, 4, 8])
    options += ["--target-error", chance.choice([1.0, 0.5] if mode == "path" else [0.3, 0.15])] if has_target else ["--samples", samples]
    if mode != "path" and chance.random() < 0.25:
        options += ["--orders", "all", "--set", "fluence.paths=5000", "--set", "fluence.resolution=16"]  # in each part
    if groups and not (groups == 1 and has_target):
        options += ["--groups", groups]
    if mode != "path":
        options += ["--quality", chance.choice(["draft", "preview"])]
    has_spread = has_target or min(samples, groups or 2) > 1  # of groups
    return options + ["--aov", LAYERS + (SPREAD if has_spread else "")]


class Frame:
    """A planned frame in a folder, rendered in one go and in parts."""

    def __init__(self, program, folder):
        self.program, self.folder, self.plan = program, folder, folder / "frame.plan.json"

    def run(self, *arguments):
        return subprocess.run([str(word) for word in (self.program, *arguments, "-q")], capture_output=True, text=True,
                              timeout=600)

    def whole(self, name, threads):
        done = self.run("render", "--plan", self.plan, "-o", self.folder / name, "--threads", threads)
        return done, self.image(name)

    def image(self, name):
        """Channels, and the error that the header states."""
        path = self.folder / name
        if not path.exists():
            return None
        said = json.loads(self.run("info", "--json", path).stdout)["attributes"]
        return read_channels(path), {key: said.get(f"tyndall:{key}") for key in ("achievedError", "errorBound", "samples")}

    def merged(self, count, shift, chance):
        """What merge ends with and the image, or the refusal of so many parts. Odd and even parts differ in threads."""
        for part in chance.sample(range(1, count + 1), count):
            done = self.run("render", "--plan", self.plan, "-o", self.folder / "frame.exr", "--part", f"{part}/{count}",
                            "--threads", 1 + (part + shift) % 2)
            if done.returncode != 0:
                return done, None
        parts = list(self.folder.glob(f"frame.part-*-of-{count}.exr"))
        chance.shuffle(parts)
        done = self.run("merge", *parts, "-o", self.folder / "merged.exr", "--threads", 1 + shift)
        image = self.image("merged.exr")
        for file in parts + [self.folder / "merged.exr"]:
            file.unlink(missing_ok=True)
        return done, image


def differences(a, b):
    """Names of channels whose bits differ, and of statements that do."""
    if a is None or b is None:
        return ["no image"]
    channels = sorted(a[0].keys() ^ b[0].keys()) + [name for name in a[0].keys() & b[0].keys()
                                                   if a[0][name].tobytes() != b[0][name].tobytes()]
    return channels + [key for key in a[1] if a[1][key] != b[1][key]]


def compare(frame, counts, chance):
    """What one run of the plan and its parts have in common: a row."""
    alone, one = frame.whole("one.exr", 1)
    row = {"exit": alone.returncode, "equal": [], "limit": None, "different": {}}
    if one is None:
        return row | {"refused": alone.stderr.strip()[:200]}
    row["channels"] = len(one[0])
    if found := differences(one, frame.whole("two.exr", 2)[1]):
        row["different"]["one run, two threads"] = found
    wanted = [(count, shift) for count in counts for shift in ((0, 1) if count <= 3 else (0,))]
    while wanted:
        count, shift = wanted.pop(0)
        done, image = frame.merged(count, shift, chance)
        limit = LIMIT.search(done.stderr)
        if done.returncode == 2 and limit and int(limit[1]) < count:
            if row["limit"] is None:
                row["limit"] = int(limit[1])
                wanted.insert(0, (row["limit"], shift))  # as many parts as there may be
            continue
        found = differences(one, image) + ([] if done.returncode == alone.returncode else
                                           [f"exit {done.returncode}: {done.stderr.strip()[:200]}"])
        if found:
            row["different"][str(count)] = found
        elif count not in row["equal"]:
            row["equal"].append(count)
    return row


def prove(what, options):
    """A row of a seed or of a shipped scene."""
    folder, start = pathlib.Path(tempfile.mkdtemp(prefix="proving_parts_")), time.monotonic()
    try:
        chance = random.Random(f"parts {what}")
        if what in SHIPPED:
            scene, asked, number, family = SOURCE / f"scenes/{what}.json", SHIPPED[what], 1, what
        else:
            drawn, size = draw(what)
            scene = write_scene(drawn, size, folder / "scene", options.program)
            asked, number, family = options_of(chance, size), drawn.frame, family_of(what).__name__
        frame, row = Frame(options.program, folder), {"scene": what, "family": family, "asked": " ".join(map(str, asked[:-2]))}
        planned = frame.run("plan", scene, *asked, "--frames", number, "--float", "--save", frame.plan)
        if not frame.plan.exists():
            return row | {"refused": planned.stderr.strip()[:200], "seconds": time.monotonic() - start}
        plan = json.loads(frame.plan.read_text())
        row |= {"groups": plan["groups"], "leaves": plan["leaves"]}
        return row | compare(frame, options.counts, chance) | {"seconds": time.monotonic() - start}
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def line(row):
    start = f"{row['scene']!s:>8} {row['family']:12s} {row['asked']:70s}"
    if "refused" in row:
        return f"{start} REFUSED {row['refused']}"
    return (f"{start} {row['groups']}x{row['leaves']} leaves, {row['channels']} channels, equal in {row['equal']} parts"
            + (f", {row['limit']} at most" if row["limit"] else "") + f", exit {row['exit']}, {row['seconds']:.0f} s"
            + (f"  DIFFERENT {row['different']}" if row["different"] else ""))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=lambda text: [n for part in text.split(",") for n in numbers(part)], default=[])
    parser.add_argument("--scenes", type=lambda text: text.split(","), default=[], help="of window, cloud and lantern")
    parser.add_argument("--counts", type=lambda text: [int(n) for n in text.split(",")], default=[1, 2, 3, 5, 8, 64])
    parser.add_argument("--program", default=SOURCE / "build/release/tyndall")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("proving"))
    parser.add_argument("--jobs", type=int, default=1, help="frames at once")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    start, rows = time.monotonic(), []
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        for done in concurrent.futures.as_completed([pool.submit(prove, what, options)
                                                     for what in options.seeds + options.scenes]):
            rows.append(done.result())
            print(line(rows[-1]), flush=True)
            (options.output / "parts.json").write_text(json.dumps(rows, indent=1))
    equal = [row for row in rows if "refused" not in row and not row["different"]]
    print(f"{len(equal)} of {len(rows)} frames are the bits of one run, {sum(len(row['equal']) for row in equal)} numbers of "
          f"parts; took {time.monotonic() - start:.0f} s")
    sys.exit(0 if rows and len(equal) == len(rows) else 1)


if __name__ == "__main__":
    main()
