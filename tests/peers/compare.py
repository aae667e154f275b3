"""Renders the scenes of scenes.py with tyndall, Mitsuba 3, Blender's Cycles and a plain quadrature, and compares mean
radiances: python tests/peers/compare.py --tyndall build/release/tyndall. Exit 1 when a mean differs (README.md). Run it
with the Python that has bpy and mitsuba."""
import argparse
import dataclasses
import importlib.util
import json
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
# Noise that counts for nothing, in standard errors: of a picture, and of one of 48 regions and channels. With errors known
# from 8 runs only, Student's t with 7 degrees of freedom passes 4.5 once in 360 times; with 16 runs, 3 in 1 % of cases.
ERRORS, REGION_ERRORS, SCORE = 2, 4.5, 3


def run_blender(job, folder, script="cycles_peer.py"):
    path = folder / "job.json"
    path.write_text(json.dumps(job))
    done = subprocess.run([sys.executable, str(HERE / script), str(path)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True)
    if done.returncode:
        sys.exit("compare.py: blender failed:\n" + "\n".join(done.stdout.splitlines()[-15:]))


def march_pictures(scene, orders, folder, args, voxels):
    return tyndall_pictures(scene, args.march_options, folder, args)


def path_pictures(scene, orders, folder, args, voxels):
    return tyndall_pictures(scene, f"--mode path --orders {orders or 'all'} {args.path_options}", folder, args)


def tyndall_pictures(scene, options, folder, args):
    import tyndall_peer
    scene_file, options = folder / f"{scene.name}.json", shlex.split(f"{options} --threads {args.threads}")
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
    return mitsuba_peer.render(scene, orders, voxels, args.mitsuba_samples, range(args.runs))


def cycles_pictures(scene, orders, folder, args, voxels):
    output = folder / f"{scene.name}_cycles_"
    job = {"scene": dataclasses.asdict(scene), "orders": orders, "samples": args.samples, "output": str(output),
           "seeds": list(range(args.runs)), "threads": args.threads,
           "vdb": str(folder / f"{scene.name}.vdb") if voxels else None}
    run_blender(job, folder)
    return [np.load(f"{output}{seed}.npy") for seed in range(args.runs)]


def quadrature_pictures(scene, orders, folder, args, voxels):
    import quadrature
    return [quadrature.render(scene, voxels, seed) for seed in range(args.runs)]


def voxelwise_pictures(scene, orders, folder, args, voxels):
    import fire
    return quadrature_pictures(scene, orders, folder, args, fire.emission_of_voxels(voxels))


RENDERERS = {"march": march_pictures, "path": path_pictures, "quadrature": quadrature_pictures,
             "voxelwise": voxelwise_pictures, "mitsuba": mitsuba_pictures, "cycles": cycles_pictures}


def cannot(name, scene, orders):
    """Why a renderer has no picture of this, or None."""
    if name == "mitsuba":
        import mitsuba_peer
        return mitsuba_peer.lacks(scene)
    if name == "voxelwise" and "fire" not in (scene.fog.recipe or {}):
        return "as quadrature"
    return "one order only" if name in ("march", "quadrature", "voxelwise") and orders != 1 else None


def read_voxels(scene, folder):
    """Its grids by name, `first` (center of the first voxel) and `size` of the baked fog, or None when it is even."""
    if not scene.fog.recipe:
        return None
    arrays = folder / f"{scene.name}.npz"
    command = [sys.executable, str(HERE / "voxels.py"), str(folder / f"{scene.name}.vdb"), str(arrays)]
    if subprocess.run(command, stdout=subprocess.DEVNULL).returncode:
        sys.exit("compare.py: the voxels could not be read")
    with np.load(arrays) as file:
        return {name: file[name] if file[name].ndim else float(file[name]) for name in file.files}


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


def scores(peer, own):
    """Of regions and channels: differences over their standard errors."""
    return (peer["regions"] - own["regions"]) / np.hypot(peer["region_errors"], own["region_errors"])


def compare(scene, orders, folder, args, renderers):
    """Prints a row per renderer; returns whether any differs from the first that can render it."""
    voxels = read_voxels(scene, folder)
    failed, own = False, None
    for name in renderers:
        reason = cannot(name, scene, orders)
        if reason:
            print(f"| {scene.name} | {orders or 'all'} | {name} | {reason} | | | | | |", flush=True)
            continue
        start = time.time()
        pictures = RENDERERS[name](scene, orders, folder, args, voxels)
        seconds = time.time() - start
        if args.keep:
            np.save(args.keep / f"{scene.name}_{orders or 'all'}_{name}.npy", np.mean(pictures, 0).astype(np.float32))
        result = statistics(pictures)
        row = f"| {scene.name} | {orders or 'all'} | {name} | {result['mean']:.6f} | {result['error'] / result['mean']:.2%} |"
        if own is None:
            own = result
            print(f"{row} | | | {seconds:.0f} s |", flush=True)
            continue
        picture, regions = differs(result, own)
        verdict = "agrees" if not picture and not regions else "DIFFERS" if picture else f"{regions} regions"
        failed |= verdict != "agrees"
        beyond = (abs(scores(result, own)) > SCORE).mean()
        print(f"{row} {result['mean'] / own['mean']:.4f} | {worst_region(result, own):+.2%} | {1 - beyond:.0%} | {seconds:.0f} s, "
              f"{verdict} |", flush=True)
    return failed


def parse():
    names = [scene.name for scene in SCENES]
    parser = argparse.ArgumentParser(description="mean radiances of tyndall and of independent renderers")
    parser.add_argument("--tyndall", default="build/release/tyndall", help="the program")
    parser.add_argument("--march-options", default="--mode march --quality final", help="of tyndall, for single scattering")
    parser.add_argument("--path-options", default="--samples 64", help="of tyndall's path tracing")
    parser.add_argument("--scenes", default=",".join(names), help="of " + ",".join(names))
    parser.add_argument("--renderers", default=",".join(RENDERERS), help="the first is what the others must agree with")
    parser.add_argument("--orders", choices=["1", "all", "both"], default="1", help="of scattering (default: 1)")
    parser.add_argument("--runs", type=int, default=8, help="pictures per scene and renderer, each with its seed")
    parser.add_argument("--samples", type=int, default=64, help="of Cycles per pixel and run")
    parser.add_argument("--mitsuba-samples", type=int, default=256, help="of Mitsuba per pixel and run")
    parser.add_argument("--threads", type=int, default=2, help="of tyndall and Cycles")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the mean pictures, as .npy")
    return parser.parse_args()


def renderers_there(wanted):
    """Those of the wanted that are installed; says which are not."""
    missing = {"mitsuba": importlib.util.find_spec("mitsuba") is None, "cycles": importlib.util.find_spec("bpy") is None}
    hints = {"mitsuba": "pip install mitsuba", "cycles": "pip install bpy==5.0.1"}
    for name in wanted:
        if name not in RENDERERS:
            sys.exit(f"compare.py: no renderer {name}; there are {', '.join(RENDERERS)}")
    absent = [f"{name} ({hints[name]})" for name in wanted if missing.get(name)]
    there = [name for name in wanted if not missing.get(name)]
    if all(missing.values()) or len(there) < 2:  # the quadrature alone is no independent renderer
        what = ", ".join(absent) or "a renderer beside tyndall, mitsuba or bpy"
        sys.exit(f"compare.py: nothing to compare: missing {what}")
    if absent:
        print(f"compare.py: left out, as they are missing: {', '.join(absent)}", file=sys.stderr)
    return there


def main():
    args = parse()
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
    print("| scene | orders | renderer | mean | standard error | ratio | worst | within 3 errors | |\n" + "|---" * 9 + "|")
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
