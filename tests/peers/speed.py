"""Times whole pictures beside Cycles and vdb_render at equal error: python tests/peers/speed.py (README.md).
Every renderer's error is taken against its own converged picture; times are medians of runs that take turns."""
import argparse
import dataclasses
import importlib.util
import json
import math
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import tyndall_peer
from compare import run_blender
from scenes import SHAFTS

# Ever finer: what the picture costs, what error is left.
FEW_STEPS = "--set march.step_share=0.0625 --set march.step_voxels=16"
LADDER = ["--samples 1 " + FEW_STEPS, "--samples 1", "--samples 4 " + FEW_STEPS, "--samples 4",
          "--quality final --samples 4", "--quality final --samples 16"]
CONVERGED_OPTIONS = "--quality final --samples 128 --set terms.light_resolution=256"
# The same fog and a sun, as vdb_render has them: isotropic, white, the eye 12 m away.
VDB_RENDER = ["-res", "640x360", "-translate", "0,2,12", "-lookat", "0,2,0", "-light", "0.3,0.8,0.2,1,1,1",
              "-absorb", "0.05,0.05,0.05", "-scatter", "0.3,0.3,0.3", "-gain", "0"]
VDB_CONVERGED = ["-step", "0.2", "-shadowstep", "0.2", "-cutoff", "1e-5"]


def seconds_of(command):
    start = time.time()
    tyndall_peer.run([str(part) for part in command])
    return time.time() - start


def error(program, picture, reference):
    """Root mean square difference over the mean."""
    done = subprocess.run([program, "compare", str(picture), str(reference), "--json"], stdout=subprocess.PIPE)
    return json.loads(done.stdout)["metrics"]["rmse_rel"]


class Tyndall:
    """Pictures of one scene file, each remembered with its options."""

    def __init__(self, program, scene_file, folder):
        self.program, self.scene_file, self.folder = program, scene_file, folder

    def render(self, options, name):
        picture = self.folder / f"{name}.exr"
        spent = seconds_of([self.program, "render", self.scene_file, "-o", picture, "--frames", "1", "--aov", "none", "-q",
                            "--set", "pixel.filter=box", "--set", "pixel.filter_radius=0.5", *options.split()])
        return picture, spent

    def ladder(self, runs):
        """(options, median seconds of the whole process, error), against the converged picture."""
        converged, _ = self.render(CONVERGED_OPTIONS, "converged")
        times = {options: [] for options in LADDER}
        errors = {}
        for _ in range(runs):
            for options in LADDER:
                picture, spent = self.render(options, "picture")
                times[options].append(spent)
                errors.setdefault(options, error(self.program, picture, converged))
        return [(options, statistics.median(times[options]), errors[options]) for options in LADDER]


def cycles(folder, vdb, args):
    """Median seconds and error. The converged picture's own noise is taken out of it."""
    def job(samples, seeds, name):
        run_blender({"scene": dataclasses.asdict(SHAFTS), "orders": 1, "samples": samples, "threads": 2,
                     "vdb": str(vdb), "seeds": seeds, "output": str(folder / name)}, folder)
        return [folder / f"{name}{seed}.exr" for seed in seeds], \
            [float((folder / f"{name}{seed}.seconds").read_text().split()[0]) for seed in seeds]

    (converged,), _ = job(args.converged, [1000], "converged_")
    pictures, seconds = job(args.samples, list(range(args.runs)), "cycles_")
    seen = statistics.median(error(args.tyndall, picture, converged) for picture in pictures)
    return statistics.median(seconds), seen / math.sqrt(1 + args.samples / args.converged)


def vdb_render(folder, vdb, program, runs):
    """Median seconds of the whole process and error, as it comes."""
    def one(name, options):
        return seconds_of(["vdb_render", vdb, folder / name, *VDB_RENDER, *options])

    one("vdb_converged.exr", VDB_CONVERGED)
    seconds = [one("vdb.exr", []) for _ in range(runs)]
    return statistics.median(seconds), error(program, folder / "vdb.exr", folder / "vdb_converged.exr")


def sun_scene(folder, vdb):
    """vdb_render's picture as a scene: its camera of 50 mm and an aperture of 41.2136 mm sees 44.8 degrees across."""
    across = math.radians(44.8)
    fov = math.degrees(2 * math.atan(math.tan(across / 2) * 360 / 640))
    path = folder / "sun.json"
    path.write_text(json.dumps({
        "tyndall": 1, "resolution": [640, 360],
        "camera": {"position": [0, 2, 12], "target": [0, 2, 0], "vertical_fov": fov},
        "lights": [{"name": "sun", "type": "sun", "direction": [-0.3, -0.8, -0.2], "intensity": 4 * math.pi}],
        "media": [{"name": "fog", "type": "vdb", "file": str(vdb), "extinction": 0.35, "albedo": [6 / 7] * 3, "g": 0}]}))
    return path


def quickest(ladder, wanted):
    """The fastest rung within an error."""
    return min((rung for rung in ladder if rung[2] <= wanted), key=lambda rung: rung[1], default=None)


def print_ladder(title, ladder):
    print(f"\n{title}\n| options | seconds | error |\n|---|---|---|")
    for options, seconds, left in ladder:
        print(f"| `{options}` | {seconds:.3f} | {100 * left:.2f} % |")


def print_ratio(what, seconds, rung):
    if rung is None:
        print(f"{what}: no rung of the ladder is as good")
    else:
        print(f"{what}: {seconds:.1f} s / {rung[1]:.3f} s = {seconds / rung[1]:.0f} (`{rung[0]}`, {100 * rung[2]:.2f} %)")


def main():
    parser = argparse.ArgumentParser(description="times of tyndall, Cycles and vdb_render at equal error")
    parser.add_argument("--tyndall", default="build/release/tyndall", help="the program")
    parser.add_argument("--runs", type=int, default=5, help="of everything that is timed; medians count")
    parser.add_argument("--samples", type=int, default=64, help="of Cycles")
    parser.add_argument("--converged", type=int, default=512, help="samples of Cycles' converged picture")
    parser.add_argument("--peers", default="cycles,vdb_render", help="who is timed beside tyndall")
    args = parser.parse_args()
    if not shutil.which(args.tyndall):
        sys.exit(f"speed.py: {args.tyndall} is not there: build it, or name it with --tyndall")
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        room = tyndall_peer.write_scene(SHAFTS, folder, args.tyndall)
        vdb = folder / "shafts.vdb"
        ladder = Tyndall(args.tyndall, room, folder).ladder(args.runs)
        print_ladder("slats room, tyndall", ladder)
        if "cycles" in args.peers and importlib.util.find_spec("bpy"):
            seconds, left = cycles(folder, vdb, args)
            print(f"\nCycles, {args.samples} samples: {seconds:.1f} s, {100 * left:.2f} %")
            print_ratio("at that error", seconds, quickest(ladder, left))
            print_ratio("at 1 %", seconds * (left / 0.01) ** 2, quickest(ladder, 0.01))
        if "vdb_render" in args.peers and shutil.which("vdb_render"):
            ladder = Tyndall(args.tyndall, sun_scene(folder, vdb), folder).ladder(args.runs)
            print_ladder("fog and sun, tyndall", ladder)
            seconds, left = vdb_render(folder, vdb, args.tyndall, args.runs)
            print(f"\nvdb_render: {seconds:.1f} s, {100 * left:.1f} %")
            print_ratio("at 2 %", seconds, quickest(ladder, 0.02))


if __name__ == "__main__":
    main()
