"""Motion blur at the default number of time samples against 512 of them, on scenes drawn by chance and on shipped ones.

    shutter.py --seeds 1-20 [--scenes concert,lantern] [--program build/release/tyndall] [-o DIR] [--jobs 1]

Scenes are about what moves: lamps near bars, cages around swinging lamps, spots that sweep or turn a gobo, volumes that spin,
cameras, height fog. Prints E, the number of time samples and the processor time a scene, and ends with 1 where E is above 5 % in
more than one scene of twenty, beyond the noise of the measurement."""
import argparse
import concurrent.futures
import json
import math
import pathlib
import sys
import tempfile

import numpy as np

from families import Chance, Drawn, hall
from geometry import Deformation, Material, Mesh, box
from pictures import LAYERS, render
from run import numbers
from scene_files import write_scene

SOURCE = pathlib.Path(__file__).parents[2]
SCENES = SOURCE / "scenes"
MAX_ERROR = 0.05
BRIGHTEST = 10  # of what counts, by the mean: noise of the few pixels around a lamp would hide all else
SIZE = (160, 90)
IMAGES, SAMPLES = 4, 16  # of each kind, and per pixel
SHIPPED = {"concert": ["--frames", "30"], "lantern": ["--frames", "12", "--shutter=0,1"]}
FRAMES = 1 / 24  # seconds


def keys(first, last):
    """Even change while the shutter is open, from frame 1 on."""
    return {"keys": [[FRAMES, first], [2 * FRAMES, last]]}


def blurred(c, drawn):
    drawn.camera["shutter"] = {"open": 0, "close": 1, "curve": c.choice(["box", "triangle"])}
    return drawn


def haze(c, size, depth=(0.2, 1.5)):
    """Even fog in a box of `size` meters to each side."""
    return {"type": "homogeneous", **c.optics(c.log(*depth) / (2 * size)),
            "bounds": {"low": [-size, 0, -size], "high": [size, 1.2 * size, size]}}


def eye(c, size):
    around = c.uniform(0, 2 * math.pi)
    away = size * c.uniform(1.2, 2.2)
    return c.camera([away * math.sin(around), size * c.uniform(0.3, 1.5), away * math.cos(around)], [0, 0.5 * size, 0])


def way(c, length):
    """A step of so many meters in any direction."""
    step = np.array([c.gauss(0, 1) for _ in range(3)])
    return length * step / np.linalg.norm(step)


def lever(c):
    """A lamp that moves a little, close to bars."""
    size = c.uniform(1, 6)
    lamp = np.array([c.uniform(-0.3, 0.3) * size, c.uniform(0.3, 0.8) * size, c.uniform(-0.3, 0.3) * size])
    bars = []
    for _ in range(c.randint(1, 4)):
        middle, thick = lamp + way(c, size * c.log(0.04, 0.15)), size * c.log(0.004, 0.02)
        half = np.full(3, thick)
        half[c.randrange(3)] = size * c.uniform(0.1, 0.3)
        bars.append(box(middle - half, middle + half))
    step = way(c, size * c.log(0.01, 0.1))
    light = c.point_light([0, 0, 0], size) | {"position": keys(list(lamp - step / 2), list(lamp + step / 2))}
    return Drawn(eye(c, size), [light], [haze(c, size)], [Mesh(Material(c.color()), np.concatenate(bars))])


def lantern(c):
    """A lamp that swings in its cage."""
    size = c.uniform(1, 4)
    middle, half = np.array([0, c.uniform(0.4, 0.7) * size, 0]), size * c.log(0.05, 0.15)
    bars, thick = [], half * c.log(0.03, 0.15)
    for i in range(count := c.randint(5, 12)):
        at = middle + half * np.array([math.cos(2 * math.pi * i / count), 0, math.sin(2 * math.pi * i / count)])
        bars.append(box(at - (thick, half, thick), at + (thick, half, thick)))
    cage = np.concatenate(bars)
    step, lag = way(c, half * c.log(0.1, 1)), c.choice([1, 0.7, 0.5])
    deformation = Deformation(2 * FRAMES, target=cage + 2 * lag * step)  # half of it while the shutter is open
    light = c.point_light([0, 0, 0], size, c.choice([0, 0, 0.05 * half])) | {
        "position": keys(list(middle + lag * step), list(middle + (1 + lag) * step))}
    return Drawn(eye(c, size), [light], [haze(c, size)],
                 [Mesh(Material(c.color()), cage, deformation),
                  Mesh(Material(c.color()), box((-size, -0.1, -size), (size, 0, size)))])


def sweep(c):
    """Spots that sweep over a room."""
    size = c.uniform(3, 12)
    lights = []
    for _ in range(c.randint(1, 5)):
        target, step = np.array(c.point((-size, 0, -size), (size, 0, size))), way(c, size * c.log(0.1, 1))
        place = c.point((-0.7 * size, 0.9 * size, -0.7 * size), (0.7 * size, 1.1 * size, 0.7 * size))
        lights.append(c.spot(place, (0, 0, 0), size) | {"outer_cone": (outer := c.log(1, 30)), "inner_cone": 0.9 * outer,
                                                        "target": keys(list(target), list(target + step * (1, 0, 1)))})
    return Drawn(eye(c, size), lights, [haze(c, size)], [hall(4 * size, 3 * size, 4 * size, c.color())])


def gobo(c):
    """An image or a profile that turns in the beam."""
    size = c.uniform(2, 8)
    turn = c.uniform(0, 360)
    light = c.spot([c.uniform(-0.3, 0.3) * size, 1.1 * size, 0], [0, 0, 0], size)
    light |= {"outer_cone": (outer := c.uniform(10, 40)), "inner_cone": 0.95 * outer}
    light["gobo"] = {"image": str(SCENES / c.choice(["gobo_spokes.png", "gobo_breakup.png"])),
                     "rotate": keys(turn, turn + c.log(10, 120)), "scale": keys(1, c.choice([1, 1, 0.7]))}
    return Drawn(eye(c, size), [light], [haze(c, size)])


def spin(c):
    """Clouds that turn or grow."""
    size = c.uniform(1, 5)
    low, high = [-0.5 * size] * 3, [0.5 * size] * 3
    cloud = {"type": c.choice(["noise", "vdb"]), **c.optics(c.log(5, 30) / size), "recipe": c.recipe(low, high),
             "translate": [0, 0.5 * size, 0], "rotate": keys([0, 0, 0], list(way(c, c.log(10, 120))))}
    if c.happens(0.3):
        cloud["scale"] = keys([1, 1, 1], [c.uniform(0.7, 1.4)] * 3)
    light = c.sun() if c.happens(0.6) else c.point_light([size, 1.5 * size, 0.3 * size], size)
    return Drawn(eye(c, size), [light], [cloud])


def camera(c):
    """A view that moves or turns."""
    size = c.uniform(2, 8)
    posts = [box(at, np.array(at) + (0.03 * size, size, 0.03 * size))
             for at in (c.point((-size, 0, -size), (size, 0, size)) for _ in range(c.randint(3, 12)))]
    drawn = Drawn(eye(c, size), [c.sun()], [haze(c, size)], [Mesh(Material(c.color()), np.concatenate(posts))])
    for end in ("position", "target") if c.happens(0.5) else ("target",):
        at = np.array(drawn.camera[end])
        drawn.camera[end] = keys(list(at), list(at + way(c, size * c.log(0.03, 0.4))))
    return drawn


def rising(c):
    """Fog that rises or thins."""
    size = c.uniform(2, 8)
    falloff, base = size * c.log(0.003, 0.1), size * c.uniform(0, 0.2)
    fog = haze(c, size, (1, 6)) | {"type": "height", "base": keys(base, base + size * c.log(0.05, 0.5)),
                                   "falloff": keys(falloff, falloff * c.choice([1, 1, 0.5, 2]))}
    return Drawn(eye(c, size), [c.sun()], [fog])


FAMILIES = [lever, lantern, sweep, gobo, spin, camera, rising]


def squared_error(differences):
    """The mean square of what images are off by, without their noise, and its standard error: products of independent
    differences hold no noise."""
    n, total, squares = len(differences), np.sum(differences, 0), np.sum(np.square(differences), 0)

    def of(total, squares, n):
        return float(np.mean(total ** 2 - squares)) / (n * (n - 1))

    left_out = [of(total - one, squares - one ** 2, n - 1) for one in differences]
    return of(total, squares, n), np.sqrt((n - 1) * np.var(left_out))


def measured(row, scene, folder, options, more=()):
    """The row with what images of the scene are off by and took. `low` is what E surely exceeds."""
    def pictures(name, first_seed, *asked):
        seeds = range(first_seed, first_seed + IMAGES)
        return [render(options.program, scene, folder / f"{name}.exr", ["--mode", "march", "--seed", seed, *asked, *more])
                for seed in seeds]

    own = pictures("own", 0, "--samples", SAMPLES)
    truths = pictures("truth", IMAGES, "--samples", options.truth_samples, "--time-samples", options.moments)
    for run in own + truths:
        if run.layers is None:
            return row | {"refused": run.said[:200]}
    worst = {"E": 0, "low": 0}
    for layer in LAYERS:
        mean = np.mean([run.layers[layer].mean() for run in truths])
        if mean > 0:
            shown = [[np.minimum(run.layers[layer] / mean, BRIGHTEST) for run in runs] for runs in (own, truths)]
            square, error = squared_error([a - b for a, b in zip(*shown)])
            found = {"E": math.sqrt(max(square, 0)), "low": math.sqrt(max(square - 2 * error, 0))}
            worst = max(worst, found, key=lambda one: one["low"] or one["E"] / 1e9)
    frame = own[0].stats["frames"][0]
    return row | worst | {"time_samples": frame.get("time_samples", 1), "load_seconds": frame["load_seconds"],
                          "seconds": own[0].processor}


def prove(case, options):
    with tempfile.TemporaryDirectory(prefix=f"proving_shutter_{case}_") as folder:
        folder = pathlib.Path(folder)
        if case in SHIPPED:
            size = ["--res", "{}x{}".format(*SIZE)]
            return measured({"scene": case}, SCENES / f"{case}.json", folder, options, [*size, *SHIPPED[case]])
        family, c = FAMILIES[case % len(FAMILIES)], Chance(case)
        scene = write_scene(blurred(c, family(c)), SIZE, folder / "scene", options.program)
        return measured({"scene": f"{case} {family.__name__}"}, scene, folder, options, ["--frames", "1"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=lambda text: [n for part in text.split(",") for n in numbers(part)], default=[])
    parser.add_argument("--scenes", type=lambda text: text.split(","), default=list(SHIPPED), help="shipped (usually both)")
    parser.add_argument("--program", type=pathlib.Path, default=SOURCE / "build/release/tyndall")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("proving"))
    parser.add_argument("--moments", type=int, default=512, help="of the truth")
    parser.add_argument("--truth-samples", type=int, default=128, help="per pixel")
    parser.add_argument("--jobs", type=int, default=1, help="scenes at once")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    cases, rows = [name for name in options.scenes if name] + options.seeds, []
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        for row in pool.map(prove, cases, [options] * len(cases)):
            rows.append(row)
            print(f"{row['scene']:12s} " + (row["refused"] if "refused" in row else
                  f"E {row['E']:.4f}, surely {row['low']:.4f}; {row['time_samples']:3d} time samples, {row['seconds']:.1f} s"),
                  flush=True)
            (options.output / "shutter.json").write_text(json.dumps(rows, indent=1))
    told = [row for row in rows if "E" in row]
    result = {"scenes": len(told), "E": round(float(np.mean([row["low"] <= MAX_ERROR for row in told])), 3),
              "median_time_samples": float(np.median([row["time_samples"] for row in told])), "refused": len(rows) - len(told)}
    print(json.dumps(result, indent=1))
    sys.exit(0 if result["E"] >= 0.95 else 1)


if __name__ == "__main__":
    main()
