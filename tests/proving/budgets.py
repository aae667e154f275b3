"""Time budgets on the proving ground: whether the whole process keeps to them, and whether the bound it states is valid.

    budgets.py --seeds 1-50 [--budgets 2,6,20] [--modes march,auto] [--program build/release/tyndall] [-o DIR] [--truths DIR]

Budgets are multiples of what `--quality draft` takes, loading and writing included. A process is late by more than a tenth of
its budget or .2 s, whichever is more. Bounds below what the truth itself may be off by are not judged. Prints a row a run
and what they add up to; ends with 1 where more than 3 % of the runs are late or of the bounds are invalid."""
import argparse
import json
import pathlib
import sys
import tempfile

import numpy as np

from families import family_of
from pictures import error_against, render
from run import SLACK, SOURCE, bound_valid, numbers, scene_with_truth


def late(row):
    return row["seconds"] > row["budget"] + max(0.1 * row["budget"], 0.2)


def can_be_judged(row):
    return row["bound"] is None or row["bound"] >= row["truth_bound"]


def prove(seed, options):
    """Rows of one seed; none where its truth cannot be had."""
    rows = []
    with tempfile.TemporaryDirectory(prefix="proving_budgets_") as folder:
        folder = pathlib.Path(folder)
        scene, frame, truth, _ = scene_with_truth(seed, folder, [0.004, 0.01], options)
        if truth is None:
            return rows
        draft = render(options.program, scene, folder / "draft.exr", ["--quality", "draft", "--frames", frame]).wall
        for multiple in options.budgets:
            for mode in options.modes:
                budget = round(multiple * draft, 3)
                run = render(options.program, scene, folder / "timed.exr",
                             ["--mode", mode, "--time-budget", budget, "--frames", frame])
                told = run.stats.get("frames", [{}])[0] if run.stats else {}
                rows.append({"seed": seed, "family": family_of(seed).__name__, "mode": mode, "budget": budget,
                             "seconds": run.wall, "exit": run.exit_code, "chosen": run.stats.get("mode"),
                             "stated": told.get("achieved_error"), "bound": told.get("error_bound"),
                             "truth_bound": truth.bound, "achieved": error_against(truth, run.layers) if run.layers else None})
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=lambda text: [n for part in text.split(",") for n in numbers(part)], required=True)
    parser.add_argument("--budgets", type=lambda text: [float(t) for t in text.split(",")], default=[2, 6, 20])
    parser.add_argument("--modes", type=lambda text: text.split(","), default=["march", "auto"])
    parser.add_argument("--program", default=SOURCE / "build/release/tyndall")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("proving"))
    parser.add_argument("--size", type=lambda text: tuple(map(int, text.split("x"))), help="of all pictures")
    parser.add_argument("--truth-seconds", type=float, default=120, help="of processor time that a truth may take")
    parser.add_argument("--truths", type=pathlib.Path, help="a folder that keeps truths from run to run")
    options = parser.parse_args()
    for folder in filter(None, (options.output, options.truths)):
        folder.mkdir(parents=True, exist_ok=True)
    rows = []
    for seed in options.seeds:
        for row in prove(seed, options):
            rows.append(row)
            mark = ("  LATE" if late(row) else "") + ("" if bound_valid(row) or not can_be_judged(row) else "  BOUND INVALID")
            number = lambda value: "-" if value is None else f"{value:.4f}"
            print(f"{seed:6d} {row['family']:12s} {row['mode']:6s} {row['seconds']:7.2f} s of {row['budget']:7.2f} s, {row['chosen']}:"
                  f" stated {number(row['stated'])} at most {number(row['bound'])} is {number(row['achieved'])}"
                  f" exit {row['exit']}{mark}", flush=True)
        (options.output / "budgets.json").write_text(json.dumps(rows, indent=1))
    judged = [row for row in rows if can_be_judged(row)]
    share = lambda of, some: round(float(np.mean([of(row) for row in some])), 4)
    result = {"runs": len(rows), "late": share(late, rows),
              "late_and_unsaid": share(lambda row: late(row) and row["exit"] == 0, rows),
              "bounds_judged": len(judged), "bound_valid": share(bound_valid, judged),
              "bound_by_achieved": round(float(np.median(
                  [row["bound"] / row["achieved"] for row in judged if row["bound"] and row["achieved"]])), 3)}
    print(json.dumps(result, indent=1))
    sys.exit(0 if result["late"] <= 0.03 and result["bound_valid"] >= 0.97 else 1)


if __name__ == "__main__":
    main()
