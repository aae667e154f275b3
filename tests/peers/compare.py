"""Renders the scenes of scenes.py with tyndall, Mitsuba 3, Blender's Cycles and a plain quadrature, and compares mean
radiances: python tests/peers/compare.py --tyndall build/release/tyndall. Exit 1 when a mean differs (README.md)."""
import argparse
import dataclasses
import importlib.util
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

try:
    import numpy as np
except ImportError:
    sys.exit("compare.py: numpy is missing (Debian: apt-get install python3-numpy, or pip install mitsuba)")

from scenes import ALL_ORDERS, SCENES

HERE = pathlib.Path(__file__).resolve().parent
REGIONS = 4  # rows and columns the picture is cut into
TOLERANCE = 0.01
MITSUBA_SAMPLES = 8  # for one of Cycles: they cost less and are noisier
# Noise that counts for nothing, in standard errors: of a picture, and of one of 16 regions (with the errors known from
# 8 runs only, Student's t with 7 degrees of freedom passes 4.5 once in 360 times: in one of 16 regions, once in 22).
ERRORS, REGION_ERRORS = 2, 4.5


def run_blender(job, folder):
    path = folder / "job.json"
    path.write_text(json.dumps(job))
    command = ["blender", "-b", "--factory-startup", "--python-exit-code", "3", "-P", str(HERE / "cycles_peer.py"),
               "--", str(path)]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        sys.exit("compare.py: blender failed:\n" + "\n".join(done.stdout.splitlines()[-15:]))


def tyndall_pictures(scene, orders, folder, args, voxels):
    import tyndall_peer
    scene_file = folder / f"{scene.name}.json"
    options = shlex.split(args.tyndall_options if orders != ALL_ORDERS else args.tyndall_all_orders)
    paths = [folder / f"{scene.name}_{seed}.exr" for seed in range(args.runs)]
    for seed, path in enumerate(paths):
        tyndall_peer.render(scene_file, options, seed, path, args.tyndall)
    if importlib.util.find_spec("mitsuba"):
        import mitsuba_peer
        return [mitsuba_peer.read_exr(path) for path in paths]
    run_blender({"exr": [str(path) for path in paths]}, folder)
    return [np.load(path.with_suffix(".npy")) for path in paths]


def mitsuba_pictures(scene, orders, folder, args, voxels):
    import mitsuba_peer
    return mitsuba_peer.render(scene, orders, voxels, MITSUBA_SAMPLES * args.samples, range(args.runs))


def cycles_pictures(scene, orders, folder, args, voxels):
    output = folder / f"{scene.name}_cycles_"
    job = {"scene": dataclasses.asdict(scene), "orders": orders, "samples": args.samples, "output": str(output),
           "seeds": list(range(args.runs)), "step_rate": args.cycles_step_rate,
           "vdb": str(folder / f"{scene.name}.vdb") if voxels else None, "voxel_size": voxels[1] if voxels else None}
    run_blender(job, folder)
    return [np.load(f"{output}{seed}.npy") for seed in range(args.runs)]


def quadrature_pictures(scene, orders, folder, args, voxels):
    import quadrature
    return [quadrature.render(scene, voxels, seed) for seed in range(args.runs)]


RENDERERS = {"tyndall": tyndall_pictures, "quadrature": quadrature_pictures, "mitsuba": mitsuba_pictures,
             "cycles": cycles_pictures}


def read_voxels(scene, folder):
    """(centre of the first voxel, voxel size, density) of the baked fog, or None when it is even."""
    if not scene.fog.recipe:
        return None
    arrays = folder / f"{scene.name}.npz"
    # Debian's pyopenvdb belongs to Debian's python and numpy, not to those of a virtual environment.
    command = ["/usr/bin/python3", str(HERE / "voxels.py"), str(folder / f"{scene.name}.vdb"), str(arrays)]
    if subprocess.run(command).returncode:
        sys.exit("compare.py: the voxels could not be read")
    with np.load(arrays) as file:
        return file["first"], float(file["size"]), file["density"]


def standard_error(runs):
    return runs.std(0, ddof=1) / np.sqrt(len(runs))


def statistics(pictures):
    """Means and standard errors, from the spread between runs: of the picture over all channels, and of each channel of
    each region."""
    stack = np.stack(pictures)
    runs, height, width, channels = stack.shape
    cut = stack.reshape(runs, REGIONS, height // REGIONS, REGIONS, width // REGIONS, channels)
    regions, whole = cut.mean((2, 4)).reshape(runs, -1), stack.mean((1, 2, 3))
    return {"mean": whole.mean(), "error": standard_error(whole), "regions": regions.mean(0),
            "region_errors": standard_error(regions)}


def region_scale(own):
    """What a region's difference is a share of: its mean, but at least a tenth of the picture's, as what is nearly
    black decides nothing."""
    return np.maximum(own["regions"], 0.1 * own["mean"])


def differs(peer, own):
    """(picture, number of regions and channels) beyond the tolerance and the noise of both."""
    gap = abs(peer["mean"] - own["mean"])
    picture = gap > TOLERANCE * own["mean"] + ERRORS * np.hypot(peer["error"], own["error"])
    gaps = abs(peer["regions"] - own["regions"])
    noise = np.hypot(peer["region_errors"], own["region_errors"])
    return picture, int((gaps > TOLERANCE * region_scale(own) + REGION_ERRORS * noise).sum())


def worst_region(peer, own):
    return max((peer["regions"] - own["regions"]) / region_scale(own), key=abs)


def compare(scene, orders, folder, args, renderers):
    """Prints a row per renderer; returns whether any differs from the first."""
    voxels = read_voxels(scene, folder)
    failed, own = False, None
    for name in renderers:
        if name == "quadrature" and orders != 1:
            continue
        start = time.time()
        pictures = RENDERERS[name](scene, orders, folder, args, voxels)
        seconds = time.time() - start
        if args.keep:
            np.save(args.keep / f"{scene.name}_{orders or 'all'}_{name}.npy", np.mean(pictures, 0).astype(np.float32))
        result = statistics(pictures)
        row = f"{scene.name:8} {orders or 'all':>6} {name:10} {result['mean']:11.6f} {result['error']:10.1e}"
        if own is None:
            own = result
            print(f"{row} {'':>8} {'':>8} {'':12} {seconds:6.1f} s", flush=True)
            continue
        picture, regions = differs(result, own)
        verdict = "agrees" if not picture and not regions else "DIFFERS" if picture else f"{regions} regions"
        failed |= verdict != "agrees"
        print(f"{row} {result['mean'] / own['mean']:8.4f} {100 * worst_region(result, own):+7.2f}% {verdict:12}"
              f" {seconds:6.1f} s", flush=True)
    return failed


def parse():
    names = [scene.name for scene in SCENES]
    parser = argparse.ArgumentParser(description="mean radiances of tyndall and of independent renderers")
    parser.add_argument("--tyndall", default="build/release/tyndall", help="the program")
    parser.add_argument("--tyndall-options", default="--mode march --quality final", help="for single scattering")
    parser.add_argument("--tyndall-all-orders", default="--mode path", help="for all orders of scattering")
    parser.add_argument("--scenes", default=",".join(names), help="of " + ",".join(names))
    parser.add_argument("--renderers", default=",".join(RENDERERS), help="the first is what the others must agree with")
    parser.add_argument("--orders", choices=["1", "all", "both"], default="1", help="of scattering (default: 1)")
    parser.add_argument("--runs", type=int, default=8, help="pictures per scene and renderer, each with its seed")
    parser.add_argument("--samples", type=int, default=32,
                        help=f"of Cycles per pixel and run; Mitsuba takes {MITSUBA_SAMPLES} times as many")
    parser.add_argument("--cycles-step-rate", type=float, default=0.5, help="voxels per step of Cycles in grids")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the mean pictures, as .npy")
    return parser.parse_args()


def renderers_there(wanted):
    """Those of the wanted that are installed; says which are not."""
    missing = {"mitsuba": importlib.util.find_spec("mitsuba") is None, "cycles": shutil.which("blender") is None}
    hints = {"mitsuba": "pip install mitsuba", "cycles": "apt-get install blender"}
    for name in wanted:
        if name not in RENDERERS:
            sys.exit(f"compare.py: no renderer {name}; there are {', '.join(RENDERERS)}")
    absent = [f"{name} ({hints[name]})" for name in wanted if missing.get(name)]
    there = [name for name in wanted if not missing.get(name)]
    if all(missing.values()) or len(there) < 2:  # the quadrature alone is no independent renderer
        what = ", ".join(absent) or "a renderer beside tyndall, mitsuba or blender"
        sys.exit(f"compare.py: nothing to compare: missing {what}")
    if absent:
        print(f"compare.py: left out, as they are missing: {', '.join(absent)}", file=sys.stderr)
    return there


def main():
    args = parse()
    os.nice(5)
    if args.runs < 8:
        sys.exit("compare.py: --runs: at least 8, their spread is the error")
    if not shutil.which(args.tyndall):
        sys.exit(f"compare.py: {args.tyndall} is not there: build it, or name it with --tyndall")
    wanted = args.scenes.split(",")
    unknown = set(wanted) - {scene.name for scene in SCENES}
    if unknown:
        sys.exit(f"compare.py: no scene {', '.join(sorted(unknown))}")
    renderers = renderers_there(args.renderers.split(","))
    if args.keep:
        args.keep.mkdir(parents=True, exist_ok=True)
    orders = {"1": [1], "all": [ALL_ORDERS], "both": [1, ALL_ORDERS]}[args.orders]
    print(f"{'scene':8} {'orders':>6} {'renderer':10} {'mean':>11} {'std.error':>10} {'ratio':>8} {'worst':>8}")
    failed = False
    with tempfile.TemporaryDirectory(prefix="tyndall_peers_") as name:
        folder = pathlib.Path(name)
        import tyndall_peer
        for scene in (scene for scene in SCENES if scene.name in wanted):
            tyndall_peer.write_scene(scene, folder, args.tyndall)
            for number in orders:
                failed |= compare(scene, number, folder, args, renderers)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
