"""Multiple scattering on the proving ground: what `--orders all` says of its error, beside how far path tracing is.

    orders.py --seeds 1-60 [--program build/release/tyndall] [-o DIR] [--mode march] [--path-seconds 20]

Prints a row a scene and what they add up to. A scene counts where path tracing's own error allows it. Ends with 1 when the
stated amount is too small in more than one of twenty scenes, or four times too large in the median."""
import argparse
import json
import pathlib
import sys
import tempfile

import numpy as np

from families import draw, family_of
from pictures import LAYERS, render
from run import numbers
from scene_files import write_scene

SOURCE = pathlib.Path(__file__).parents[2]
LEAST = 0.01  # differences below this count as this
PICTURES = 6  # of path tracing, at least


def differences(own, truths, layer):
    """Of two images of a mode and many of path tracing: mean and rms over pixels, each with its standard error, as shares of
    path tracing's mean. Products of independent differences hold no noise."""
    mean = np.mean([truth[layer].mean() for truth in truths])
    a, b = (picture[layer].astype(float) for picture in own)
    own_noise = np.mean((a - b) ** 2) / 4  # is in all differences: taken out by the mode's two images
    some = [0.5 * (a + b) - truth[layer] for truth in truths]
    total, squares = np.sum(some, 0), np.sum(np.square(some), 0)

    def squared(total, squares, n):
        return np.mean(total ** 2 - squares) / (n * (n - 1)) - own_noise

    n = len(some)
    value = squared(total, squares, n)
    left_out = [squared(total - one, squares - one ** 2, n - 1) for one in some]
    error = np.sqrt((n - 1) * np.var(left_out))
    offsets = [one.mean() for one in some]
    return {"mean": np.mean(offsets) / mean, "mean_error": np.std(offsets, ddof=1) / np.sqrt(n) / mean,
            "pixels": np.sqrt(max(value, 0)) / mean,
            "pixels_high": np.sqrt(max(value + 2 * error, 0)) / mean,
            "pixels_low": np.sqrt(max(value - 2 * error, 0)) / mean}


def stated(run):
    """The share that the limitation names, None where there is none."""
    for limitation in run.stats.get("limitations", []):
        if limitation["id"] == "approximate_orders":
            return limitation["amounts"][0] / 100
    return None


def prove(seed, options):
    with tempfile.TemporaryDirectory(prefix="proving_orders_") as folder:
        folder = pathlib.Path(folder)
        drawn, size = draw(seed, 0)
        scene = write_scene(drawn, options.size or size, folder / "scene", options.program)
        common = ["--frames", drawn.frame, "--orders", "all"]
        own = [render(options.program, scene, folder / "own.exr", [*common, "--mode", options.mode, "--seed", seed])
               for seed in (0, 1)]
        row = {"seed": seed, "family": family_of(seed).__name__, "stated": stated(own[0]), "seconds": own[0].wall,
               "without": own[0].stats.get("totals", {}).get("seconds")}
        truths, used, samples = [], 0, 4
        while used < options.path_seconds or len(truths) < PICTURES:
            run = render(options.program, scene, folder / "path.exr",
                         [*common, "--mode", "path", "--samples", samples, "--seed", 100 + len(truths)])
            if run.layers is None:
                return row | {"refused": run.said}
            if not truths and run.processor < options.path_seconds / 40:
                used, samples = used + run.processor, samples * 4  # fewer, better ones
                if samples <= 4096:
                    continue
            truths.append(run.layers)
            used += run.processor
        if row["stated"] is None:
            return row | {"refused": own[0].said}
        row["layers"] = {layer: differences([run.layers for run in own], truths, layer) for layer in LAYERS
                         if any(truth[layer].any() for truth in truths)}
        if not row["layers"]:
            return row | {"refused": "no light"}
        worst = max(row["layers"].values(), key=lambda layer: layer["pixels"])
        low = max(max(layer["pixels_low"], abs(layer["mean"]) - 2 * layer["mean_error"]) for layer in row["layers"].values())
        # a stated amount is too small where the measurement says so beyond its own error
        return row | {"measured": worst["pixels"], "low": low, "high": worst["pixels_high"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=lambda text: [n for part in text.split(",") for n in numbers(part)], required=True)
    parser.add_argument("--program", default=SOURCE / "build/release/tyndall")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("proving"))
    parser.add_argument("--mode", default="march")
    parser.add_argument("--size", type=lambda text: tuple(map(int, text.split("x"))), help="of all pictures")
    parser.add_argument("--path-seconds", type=float, default=20, help="of processor time for path tracing, a scene")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    rows = []
    for seed in options.seeds:
        rows.append(row := prove(seed, options))
        (options.output / "orders.json").write_text(json.dumps(rows, indent=1))
        if "refused" in row:
            print(f"{seed:6d} {row['family']:12s} {row['refused'][:90]}", flush=True)
            continue
        layers = " ".join(f"{layer} {100 * d['mean']:+.1f}±{100 * d['mean_error']:.1f} % pixels {100 * d['pixels']:.1f} %"
                          for layer, d in row["layers"].items())
        mark = "" if row["stated"] >= row["low"] else "  TOO SMALL"
        print(f"{seed:6d} {row['family']:12s} stated {100 * row['stated']:6.1f} % measured {100 * row['measured']:6.1f} % "
              f"({100 * row['low']:.1f} to {100 * row['high']:.1f})  {layers}  {row['seconds']:.1f} s, {row['without']:.1f} s "
              f"without{mark}", flush=True)
    told = [row for row in rows if "measured" in row]
    ratios = [row["stated"] / max(row["measured"], LEAST) for row in told]
    result = {"scenes": len(told), "large_enough": round(float(np.mean([r["stated"] >= r["measured"] for r in told])), 3),
              "not_too_small": round(float(np.mean([row["stated"] >= row["low"] for row in told])), 3),
              "stated_by_measured": round(float(np.median(ratios)), 2)}
    print(json.dumps(result, indent=1))
    sys.exit(0 if result["not_too_small"] >= 0.95 and result["stated_by_measured"] <= 4 else 1)


if __name__ == "__main__":
    main()
