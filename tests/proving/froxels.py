"""How far froxels' fog light is off at pixel centers, on scenes drawn by chance that have point or spot lights.

    froxels.py --seeds 5001-5080 [--count 50] [--program build/release/tyndall] [-o DIR] [--jobs 1]

The layer `inscatter` of `--mode froxel --quality preview`, one sample at each pixel's center, against the mean of several such of
`march --quality reference`: E, and FLIP of the layer seen as an image (needs oiiotool). Prints a row a scene and what they add up
to, writes DIR/froxels.json, and ends with 1 where E is above 10 % or FLIP above .04 in more than one scene of twenty."""
import argparse
import concurrent.futures
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from families import draw, family_of
from pictures import render
from run import numbers
from scene_files import write_scene

SOURCE = pathlib.Path(__file__).parents[2]
MOST_ERROR, MOST_FLIP = 0.10, 0.04
CENTERS = ("--set", "pixel.filter=center", "--set", "pixel.edge_samples=1", "--set", "pixel.lamp_samples=1")
MOST_SECONDS = 60  # for the exact image; scenes that take longer are left out and counted
EXACT = (16, 4)  # samples, each with other random numbers along its ray; the fewer where more would take too long


def has_lamp(scene):
    return any(light["type"] in ("point", "spot") for light in json.loads(scene.read_text()).get("lights", []))


def only_fog(file):
    """The image with its fog light for colors, in a file beside it."""
    fog = file.with_suffix(".fog.exr")
    subprocess.run(["oiiotool", file, "--ch", "R=inscatter.R,G=inscatter.G,B=inscatter.B", "-d", "float", "-o", fog], check=True)
    return fog


def prove(seed, options):
    """A row; None where the seed's scene has no lamp."""
    with tempfile.TemporaryDirectory(prefix=f"proving_froxels_{seed}_") as folder:
        folder = pathlib.Path(folder)
        drawn, size = draw(seed)
        scene = write_scene(drawn, size, folder / "scene", options.program)
        if not has_lamp(scene):
            return None
        row, common = {"seed": seed, "family": family_of(seed).__name__}, ["--frames", drawn.frame, *CENTERS]
        own = render(options.program, scene, folder / "own.exr", ["--mode", "froxel", "--samples", 1, *common])
        for samples in EXACT:
            exact = render(options.program, scene, folder / "exact.exr",
                           ["--mode", "march", "--quality", "reference", "--samples", samples, *common], timeout=MOST_SECONDS)
            if exact.layers is not None:
                break
        if own.layers is None or exact.layers is None:
            return row | {"refused": (own.said or exact.said)[:200]}
        if not exact.layers["inscatter"].any():
            return row | {"refused": "no light in the fog"}
        done = subprocess.run([options.program, "compare", only_fog(folder / "own.exr"), only_fog(folder / "exact.exr"), "--json"],
                              capture_output=True, text=True, check=True)
        metrics = json.loads(done.stdout)["metrics"]
        return row | {"E": metrics["rmse_rel"], "flip": metrics["flip"], "seconds": own.processor}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=lambda text: [n for part in text.split(",") for n in numbers(part)], required=True)
    parser.add_argument("--count", type=int, default=50, help="of scenes, at most")
    parser.add_argument("--program", type=pathlib.Path, default=SOURCE / "build/release/tyndall")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("proving"))
    parser.add_argument("--jobs", type=int, default=1, help="scenes at once")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    rows = []
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        for row in pool.map(prove, options.seeds, [options] * len(options.seeds)):
            if row is None or len(rows) == options.count:
                continue
            rows.append(row)
            print(f"{row['seed']:6d} {row['family']:12s} " + (row["refused"] if "refused" in row else
                  f"E {row['E']:.4f} FLIP {row['flip']:.4f} {row['seconds']:.2f} s"), flush=True)
            (options.output / "froxels.json").write_text(json.dumps(rows, indent=1))
    told = [row for row in rows if "E" in row]
    result = {"scenes": len(told), "E": float(np.mean([row["E"] <= MOST_ERROR for row in told])),
              "flip": float(np.mean([row["flip"] <= MOST_FLIP for row in told])),
              "median_E": float(np.median([row["E"] for row in told])), "refused": len(rows) - len(told)}
    print(json.dumps(result, indent=1))
    sys.exit(0 if min(result["E"], result["flip"]) >= 0.95 else 1)


if __name__ == "__main__":
    main()
