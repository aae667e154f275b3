"""What `--mode auto` saves in a sequence of 24 frames: the time of march over its own, at an error that both reach.

    sequences.py [--scenes window,pillars] [--targets .05,.02] [--program build/release/tyndall] [-o DIR] [--truths DIR]

Errors are those of four of the frames, together, against truths of theirs. march is asked for ever smaller errors, until it is
no less exact than auto was. Whole processes are timed. Prints a row a scene and target, writes DIR/sequences.json, and ends with
1 where no target of a scene gives a ratio of 1.3."""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

from pictures import error_against, read_layers
from run import SOURCE, TRUTH_SHARE, named_scene_with_truth

FRAMES, LOOKED_AT = 24, (1, 8, 16, 24)
FINER = 0.85  # of the target before, for march
ENOUGH = 1.3
RUNS = 3  # whose median counts


def sequence(scene, folder, truths, mode, target, options):
    """Wall seconds of the whole process, the error, and the technique of the first frame."""
    command = list(map(str, [
        options.program, "render", scene, "-o", folder / "frame.####.exr", "--float", "-q", "--threads", 2, "--mode", mode,
        "--target-error", target, "--frames", f"1-{FRAMES}", "--stats-json", folder / "stats.json"]))
    seconds = []
    for _ in range(RUNS):
        start = time.monotonic()
        subprocess.run(command, check=True)
        seconds.append(time.monotonic() - start)
    errors = [error_against(truth, read_layers(folder / f"frame.{frame:04d}.exr")) for frame, truth in truths.items()]
    return {"seconds": float(np.median(seconds)), "error": float(np.sqrt(np.mean(np.square(errors)))),
            "mode": json.loads((folder / "stats.json").read_text())["mode"]}


def compare(name, target, folder, options):
    """A row; one without times where a truth cannot be had."""
    row, truths = {"scene": name, "asked": target}, {}
    wanted = [TRUTH_SHARE * target for target in options.targets]
    for frame in LOOKED_AT:
        scene, _, truths[frame], _ = named_scene_with_truth(name, folder, wanted, options, frame)
    if None in truths.values():
        return row
    auto = sequence(scene, folder, truths, "auto", target, options)
    march, asked = [], target
    while not march or march[-1]["error"] > auto["error"]:
        march.append(sequence(scene, folder, truths, "march", asked, options))
        asked = round(FINER * asked, 6)
    best = march[-1]  # the first that is no less exact
    return row | {"auto": auto, "march": best, "ratio": best["seconds"] / auto["seconds"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=lambda text: text.split(","), default=["window", "pillars"], help="names in scenes/")
    parser.add_argument("--targets", type=lambda text: [float(t) for t in text.split(",")], default=[0.05, 0.02])
    parser.add_argument("--program", default=SOURCE / "build/release/tyndall")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("proving"))
    parser.add_argument("--truths", type=pathlib.Path, help="a folder that keeps truths from run to run")
    parser.add_argument("--truth-seconds", type=float, default=600, help="of processor time that a truth may take")
    options = parser.parse_args()
    for folder in filter(None, (options.output, options.truths)):
        folder.mkdir(parents=True, exist_ok=True)
    rows = []
    with tempfile.TemporaryDirectory(prefix="proving_sequences_") as folder:
        for name in options.scenes:
            for target in options.targets:
                rows.append(row := compare(name, target, pathlib.Path(folder), options))
                if "ratio" in row:
                    auto, march = row["auto"], row["march"]
                    print(f"{name:10s} target {target:.3f} auto ({auto['mode']}) {auto['seconds']:.2f} s, error {auto['error']:.4f};"
                          f" march {march['seconds']:.2f} s, error {march['error']:.4f}: {row['ratio']:.3f} times", flush=True)
                else:
                    print(f"{name:10s} target {target:.3f}: no truth", flush=True)
                (options.output / "sequences.json").write_text(json.dumps(rows, indent=1))
    best = {name: max((row.get("ratio", 0) for row in rows if row["scene"] == name), default=0) for name in options.scenes}
    print(json.dumps(best, indent=1))
    sys.exit(0 if min(best.values()) >= ENOUGH else 1)


if __name__ == "__main__":
    main()
