"""How far froxels' fog light is off at pixel centers, on scenes drawn by chance that have point or spot lights.

    froxels.py [--seeds 5001-5080] [--count 50] [--scenes spotlight,window] [--beside PROGRAM] [--program build/release/tyndall]
               [-o DIR] [--jobs 1]

The layer `inscatter` of `--mode froxel --quality preview`, one sample at each pixel's center, against the mean of several such of
`march --quality reference`: E, and FLIP of the layer seen as an image (needs oiiotool). Prints a row a scene and what they add up
to, writes DIR/froxels.json, and ends with 1 where E is above 10 % or FLIP above .04 in more than one scene of twenty. --scenes
adds shipped scenes at their first frame; --beside also times another program, in turn, and prints the ratio of medians."""
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
TIMES = 7  # of each program, whose medians count
MOST_SECONDS = 120  # of processor time for the exact image; scenes that take longer are left out and counted
EXACT = (16, 4)  # samples, each with other random numbers along its ray; the fewer where more would take too long
DRAWN = ("--set", "march.light_marches=64")  # of the nodes of a ray: unbiased, and much faster where there are many


def has_lamp(scene):
    return any(light["type"] in ("point", "spot") for light in json.loads(scene.read_text()).get("lights", []))


def only_fog(file):
    """The image with its fog light for colors, in a file beside it."""
    fog = file.with_suffix(".fog.exr")
    subprocess.run(["oiiotool", file, "--ch", "R=inscatter.R,G=inscatter.G,B=inscatter.B", "-d", "float", "-o", fog], check=True)
    return fog


def time_ratio(scene, folder, common, options):
    """Median wall seconds over those of the other program; None where that refuses the scene."""
    seconds = {program: [] for program in (options.program, options.beside)}
    for _ in range(TIMES):
        for program, took in seconds.items():
            run = render(program, scene, folder / "timed.exr", ["--mode", "froxel", "--samples", 1, *common])
            if run.layers is None:
                return None
            took.append(run.wall)
    return float(np.median(seconds[options.program]) / np.median(seconds[options.beside]))


def prove(what, options):
    """A row of a seed or of a shipped scene; None where the seed's scene has no lamp."""
    with tempfile.TemporaryDirectory(prefix=f"proving_froxels_{what}_") as folder:
        folder = pathlib.Path(folder)
        if isinstance(what, str):
            scene, frame, family = SOURCE / f"scenes/{what}.json", 1, "shipped"
        else:
            drawn, size = draw(what)
            scene = write_scene(drawn, size, folder / "scene", options.program)
            frame, family = drawn.frame, family_of(what).__name__
            if not has_lamp(scene):
                return None
        row, common = {"seed": what, "family": family}, ["--frames", frame, *CENTERS]
        own = render(options.program, scene, folder / "own.exr", ["--mode", "froxel", "--samples", 1, *common])
        for samples in EXACT:
            exact = render(options.program, scene, folder / "exact.exr",
                           ["--mode", "march", "--quality", "reference", "--samples", samples, *DRAWN, *common],
                           processor=MOST_SECONDS)
            if exact.layers is not None:
                break
        if own.layers is None or exact.layers is None:
            return row | {"refused": (own.said or exact.said)[:200]}
        if not exact.layers["inscatter"].any():
            return row | {"refused": "no light in the fog"}
        done = subprocess.run([options.program, "compare", only_fog(folder / "own.exr"), only_fog(folder / "exact.exr"), "--json"],
                              capture_output=True, text=True, check=True)
        metrics = json.loads(done.stdout)["metrics"]
        if options.beside:
            row["by_other"] = time_ratio(scene, folder, common, options)
        return row | {"E": metrics["rmse_rel"], "flip": metrics["flip"], "seconds": own.processor}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=lambda text: [n for part in text.split(",") for n in numbers(part)],
                        default=[])
    parser.add_argument("--count", type=int, default=50, help="of drawn scenes, at most")
    parser.add_argument("--scenes", type=lambda text: text.split(","), default=[], help="names in scenes/")
    parser.add_argument("--beside", type=pathlib.Path, help="another program, to time as well")
    parser.add_argument("--program", type=pathlib.Path, default=SOURCE / "build/release/tyndall")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("proving"))
    parser.add_argument("--jobs", type=int, default=1, help="scenes at once")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    rows = []
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        scenes = options.scenes + options.seeds
        for row in pool.map(prove, scenes, [options] * len(scenes)):
            if row is None or len(rows) == options.count + len(options.scenes):
                continue
            rows.append(row)
            print(f"{row['seed']!s:>9} {row['family']:12s} " + (row["refused"] if "refused" in row else
                  f"E {row['E']:.4f} FLIP {row['flip']:.4f} {row['seconds']:.2f} s" +
                  (f" {row['by_other']:.2f} times the other's" if row.get("by_other") else "")), flush=True)
            (options.output / "froxels.json").write_text(json.dumps(rows, indent=1))
    told = [row for row in rows if "E" in row]
    result = {"scenes": len(told), "E": float(np.mean([row["E"] <= MOST_ERROR for row in told])),
              "flip": float(np.mean([row["flip"] <= MOST_FLIP for row in told])),
              "median_E": float(np.median([row["E"] for row in told])), "refused": len(rows) - len(told)}
    print(json.dumps(result, indent=1))
    sys.exit(0 if min(result["E"], result["flip"]) >= 0.95 else 1)


if __name__ == "__main__":
    main()
