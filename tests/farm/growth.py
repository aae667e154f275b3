"""How a frame and a sequence grow with the number of machines: simulated from what parts and merging cost here.

    growth.py [--program build/release/tyndall] [--size 320x180] [-o FILE.md]

Measures start-up, preparation, bytes and merging of parts of two scenes that ship, in processor seconds, so that a busy
machine counts less; fits what merging costs by part and pixel, and prints what one frame takes on 1 to 10,000 machines and
a thousand frames on 1 to 1,000. -o writes the tables too."""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile

import numpy as np

SOURCE = pathlib.Path(__file__).parents[2]
SCENES = {"window": ("--mode", "march", "--samples", "64"),
          "cloud": ("--mode", "march", "--samples", "64", "--quality", "draft")}
COUNTS = (2, 8, 64, 128)  # parts that are merged to see what each costs
# What is assumed.
PIXELS = 1920 * 1080
STORAGE = 1e9                # bytes a second of the storage that all share
LINK = 1.25e8                # and of a machine's own link to it
INPUT = 1e9                  # bytes of a frame's volume and scene
HERO, FRAME, FRAMES = 24 * 3600.0, 3600.0, 1000  # seconds that a frame's samples take on one machine; frames of a shot


def run(program, *words):
    """Processor seconds of a run."""
    child = subprocess.Popen([str(word) for word in (program, *words, "-q")], stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode not in (0, 1):
        raise SystemExit(f"{words[0]} ended with {child.returncode}")
    return used.ru_utime + used.ru_stime


def measured(program, name, size, folder):
    """Of a scene: seconds that each part spends apart from its samples, bytes of parts, seconds of merging."""
    plan, stats = folder / f"{name}.json", folder / f"{name}.stats.json"
    run(program, "plan", SOURCE / f"scenes/{name}.json", *SCENES[name], "--res", size, "--frames", 1, "--save", plan)
    one = run(program, "render", "--plan", plan, "-o", folder / "one.exr", "--stats-json", stats)
    pixels, rows, start = int(np.prod([int(n) for n in size.split("x")])), [], []
    for count in COUNTS:
        parts = [run(program, "render", "--plan", plan, "-o", folder / f"{name}.exr", "--part", f"{part}/{count}")
                 for part in range(1, count + 1)]
        files = sorted(folder.glob(f"{name}.part-*-of-{count}.exr"))
        seconds = run(program, "merge", *files, "-o", folder / "merged.exr")
        rows.append((count, sum(file.stat().st_size for file in files) / count / pixels, seconds))
        start.append((sum(parts) - one) / (count - 1))
        for file in files:
            file.unlink()
    counts, sizes, seconds = np.array(rows).T
    start_of_merge = smallest_merge(program, name, folder)
    slope, rest = np.polyfit(counts, seconds, 1)
    return {"start": start[1], "start_by_count": dict(zip(COUNTS, start)), "one": one, "bytes": dict(zip(COUNTS, sizes)),
            "merge_second": max(slope, 0) / pixels, "merge_start": start_of_merge, "merge_rest": max(rest - start_of_merge, 0) / pixels,
            "merge_seconds": dict(zip(COUNTS, seconds))}


def smallest_merge(program, name, folder):
    """Seconds of merging a part of a few pixels: start-up."""
    plan, part = folder / "small.json", folder / "small.part-1-of-1.exr"
    run(program, "plan", SOURCE / f"scenes/{name}.json", *SCENES[name], "--res", "8x8", "--frames", 1, "--save", plan)
    run(program, "render", "--plan", plan, "-o", folder / "small.exr", "--part", "1/1")
    return min(run(program, "merge", part, "-o", folder / "merged.exr") for _ in range(3))


def merging(cost, parts):
    return cost["merge_start"] + PIXELS * (cost["merge_rest"] + parts * cost["merge_second"])


def one_frame(cost, machines, parts=None):
    """Seconds of each step of a hero frame in as many parts as machines, or fewer."""
    parts = min(parts or machines, machines)
    size = PIXELS * cost["bytes"][min((count for count in COUNTS if count >= parts), default=COUNTS[-1])]
    load = max(INPUT / LINK, parts * INPUT / STORAGE)
    write = max(size / LINK, parts * size / STORAGE)
    merge = merging(cost, parts) + parts * size / STORAGE if parts > 1 else 0
    return {"start": cost["start"], "load": load, "render": HERO / parts, "write": write, "merge": merge}


def total(steps):
    return sum(steps.values())


def best_parts(cost, machines):
    """How many parts take least time."""
    return int(min(np.unique(np.geomspace(1, machines, 400).astype(int)), key=lambda n: total(one_frame(cost, n))))


def sequence(cost, machines):
    """Hours of a thousand frames, whole frames on machines, and in three parts each."""
    hours = []
    for parts in (1, 3):
        jobs = FRAMES * parts
        merge = merging(cost, parts) if parts > 1 else 0
        load = max(INPUT / LINK, min(jobs, machines) * INPUT / STORAGE)
        rounds = -(-jobs // machines)
        merges = -(-FRAMES // machines)
        hours.append((rounds * (cost["start"] + load + FRAME / parts) + merges * merge) / 3600)
    return hours


def tables(costs):
    lines = []
    for name, cost in costs.items():
        lines += [f"**{name}**: a part costs {cost['start']:.2f} processor seconds beside its samples; its file takes "
                  + ", ".join(f"{size:.1f} ({count})" for count, size in cost["bytes"].items())
                  + f" bytes per pixel (number of parts); merging takes {1e9 * cost['merge_second']:.0f} ns per part and pixel "
                  f"beside {1e9 * cost['merge_rest']:.0f} ns per pixel.",
                  "", "| machines | loading | rendering | writing | merging | all | times as fast |", "|---|---|---|---|---|---|---|"]
        alone = total(one_frame(cost, 1))
        for machines in (1, 3, 10, 30, 100, 300, 1000, 3000, 10000):
            steps = one_frame(cost, machines)
            lines.append(f"| {machines:,} | {steps['start'] + steps['load']:.0f} s | {steps['render']:.0f} s | {steps['write']:.0f} s | "
                         f"{steps['merge']:.0f} s | {total(steps):.0f} s | {alone / total(steps):.1f} |")
        best = best_parts(cost, 10000)
        longer = next(n for n in range(2, 10001) if one_frame(cost, n)["merge"] > one_frame(cost, n)["render"])
        lines += ["", f"From {longer} parts on, merging takes longer than rendering. {best} parts are quickest: {total(one_frame(cost, best)):.0f} s, "
                  f"{alone / total(one_frame(cost, best)):.0f} times as fast as one machine.", "",
                  "| machines, 1,000 frames | whole frames | three parts each |", "|---|---|---|"]
        for machines in (1, 10, 100, 300, 1000):
            whole, split = sequence(cost, machines)
            lines.append(f"| {machines:,} | {whole:.1f} h | {split:.1f} h |")
        lines.append("")
    return "\n".join([
        f"Assumed: {PIXELS / 1e6:.1f} million pixels; a frame whose samples take one machine {HERO / 3600:.0f} hours, and "
        f"{FRAMES:,} of {FRAME / 3600:.0f} hour; {INPUT / 1e9:.0f} GB of input that each part reads; storage of {STORAGE / 1e9:.0f} "
        f"GB/s for all and {LINK / 1e6:.0f} MB/s for each machine; all samples of a frame take equally long; nothing dies.", "",
        *lines])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=SOURCE / "build/release/tyndall")
    parser.add_argument("--size", default="320x180", help="of the pictures that are measured")
    parser.add_argument("--scenes", type=lambda text: text.split(","), default=list(SCENES))
    parser.add_argument("-o", "--output", type=pathlib.Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="growth_") as folder:
        costs = {name: measured(options.program, name, options.size, pathlib.Path(folder)) for name in options.scenes}
    print(json.dumps(costs, indent=1))
    print(text := tables(costs))
    if options.output:
        options.output.write_text(text)


if __name__ == "__main__":
    main()
