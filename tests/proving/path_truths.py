"""Whether ground truths, all by marching, are also what path tracing converges to: `path --orders 1`, scene by scene.

    path_truths.py --seeds 5001-5020 [--seconds 60] [--program build/release/tyndall] [-o DIR]

Scenes are drawn as for run.py, without `ambient`, which only path tracing shadows. Prints, for beauty and fog, the difference of
the means with its standard error and the RMS difference of tiles of 8 x 8 pixels with the noise of both taken out. Writes
DIR/path_truths.json and ends with 1 where more than one scene of twenty is off by more than its truth may be and three
standard errors."""
import argparse
import json
import pathlib
import sys
import tempfile

import numpy as np

from families import draw, family_of
from pictures import LAYERS, render
from run import SMALLEST, SOURCE, numbers
from scene_files import write_scene
from truths import Dark, find_truth

TILE = 8  # pixels
IMAGES = 8  # by path tracing
WANTED = [0.004, 0.01]  # errors of the truths


def tiles(image):
    height, width = (size // TILE * TILE for size in image.shape[:2])
    return image[:height, :width].reshape(height // TILE, TILE, width // TILE, TILE, 3).mean((1, 3))


def differences(images, truth, layer):
    """Of the means, and squared of tiles, as shares of the truth's mean; each with its standard error. Products of independent
    differences hold no noise of path tracing; the truth's own is subtracted."""
    scale = truth.layers[layer].mean()
    some = np.array([tiles(image[layer]) - tiles(truth.layers[layer]) for image in images]) / scale
    noise = truth.variance[layer] / TILE ** 2 / scale ** 2

    def squared(part):
        n = len(part)
        return np.mean(part.sum(0) ** 2 - (part ** 2).sum(0)) / (n * (n - 1)) - noise

    n, means = len(some), some.mean((1, 2, 3))
    left_out = [squared(np.delete(some, i, 0)) for i in range(n)]
    own = np.sqrt(truth.variance[layer] / truth.layers[layer][..., 0].size) / scale
    return {"mean": means.mean(), "mean_error": float(np.hypot(np.std(means, ddof=1) / np.sqrt(n), own)),
            "squared": squared(some), "squared_error": np.sqrt((n - 1) * np.var(left_out))}


def off(row):
    """By more than three standard errors and what a tile of the truth may be off by."""
    return any(abs(d["mean"]) > 3 * d["mean_error"] + row["truth_bound"] / TILE or
               d["squared"] > 3 * d["squared_error"] + row["truth_bound"] ** 2 for d in row["layers"].values())


def compare(seed, options):
    """A row; None where nothing but ambient light is seen, or no truth is found."""
    with tempfile.TemporaryDirectory(prefix=f"proving_path_{seed}_") as folder:
        folder = pathlib.Path(folder)
        drawn = draw(seed)[0]
        drawn = drawn.plain or drawn
        drawn.ambient = 0
        scene = write_scene(drawn, SMALLEST, folder / "scene", options.program)
        try:
            truth = find_truth(options.program, scene, SMALLEST, drawn.frame, folder, WANTED, options.seconds)
        except Dark:
            return None
        if truth is None:
            return None
        path = lambda samples, seed: render(options.program, scene, folder / "path.exr", [
            "--mode", "path", "--orders", 1, "--samples", samples, "--seed", seed, "--frames", drawn.frame, "--set",
            "pixel.edge_samples=1", "--set", "pixel.lamp_samples=1"])
        quick = [path(samples, 1).processor for samples in (4, 36)]
        samples = int(np.clip(32 * options.seconds / IMAGES / max(quick[1] - quick[0], 1e-3), 4, 4096))
        images = [path(samples, seed).layers for seed in range(2, 2 + IMAGES)]
        return {"seed": seed, "family": family_of(seed).__name__, "samples": samples, "truth_bound": truth.bound,
                "layers": {layer: differences(images, truth, layer) for layer in LAYERS}}


def line(row):
    root = lambda value: 100 * np.sign(value) * np.sqrt(abs(value))
    layers = "  ".join(f"{layer} {100 * d['mean']:+.2f} ± {100 * d['mean_error']:.2f} %, tiles {root(d['squared']):.2f} ± "
                       f"{root(d['squared_error']):.2f} %" for layer, d in row["layers"].items())
    return f"{row['seed']:6d} {row['family']:12s} {row['samples']:6d} samples  {layers}{'  OFF' if off(row) else ''}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=lambda text: [n for part in text.split(",") for n in numbers(part)], required=True)
    parser.add_argument("--seconds", type=float, default=60, help="of processor time for each of the two, a scene")
    parser.add_argument("--program", default=SOURCE / "build/release/tyndall")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("proving"))
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    rows = []
    for seed in options.seeds:
        row = compare(seed, options)
        if row is None:
            print(f"{seed:6d} {family_of(seed).__name__:12s} no truth", flush=True)
            continue
        rows.append(row)
        print(line(row), flush=True)
        (options.output / "path_truths.json").write_text(json.dumps(rows, indent=1))
    wrong = [row["seed"] for row in rows if off(row)]
    print(f"{len(wrong)} of {len(rows)} scenes are off: {wrong}")
    sys.exit(0 if rows and len(wrong) <= max(1, len(rows) / 20) else 1)


if __name__ == "__main__":
    main()
