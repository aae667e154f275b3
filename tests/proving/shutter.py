"""Motion blur at the default number of time samples against many more, on scenes drawn by chance and on shipped ones.

    shutter.py --seeds 1-20 [--scenes concert:30,lantern:12] [--mode march] [--program build/release/tyndall] [-o DIR] [--jobs 1]

Scenes are about what moves: lamps in perforated shades, spots that sweep, open or turn a gobo, clouds that spin or drift,
cameras that pass, turn and zoom, height fog. Both images of a pair trace each pixel at the same times, rounded to their own
time samples, with the same random numbers: they differ by the error of the time samples, and what is left of noise cancels in
products of independent pairs. Prints E, the number of time samples and the processor time of an image. Ends with 1 where E
is surely above 5 % in more than one scene of twenty, or where four time samples would do in more than two thirds of them."""
import argparse
import concurrent.futures
import itertools
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
FEW = 4  # time samples, which must not do
FINER, FEWEST, MOST = 8, 64, 1024  # time samples of the truth: times as many as usual, but within these
PAIRS, SAMPLES = 4, 64  # of images, and per pixel of each
ALIKE = ["--set", "pixel.edge_samples=1", "--set", "pixel.lamp_samples=1"]  # as many samples a pixel in all images
SHIPPED = {"concert": ["--crop", "130,90,194,126"], "lantern": ["--crop", "250,20,314,56", "--shutter=0,1"]}
FRAMES = 1 / 24  # seconds
BLACK = Material((0, 0, 0))  # so that the inside of a shade does not outshine all else


def keys(first, last):
    """Even change while the shutter is open, from frame 1 on."""
    return {"keys": [[FRAMES, first], [2 * FRAMES, last]]}


def haze(c, size, depth=(0.2, 1.5)):
    """Even fog in a box of `size` meters to each side, below the lamps: a glow around them would be noise that hides all else."""
    return {"type": "homogeneous", **c.optics(c.log(*depth) / (2 * size)),
            "bounds": {"low": [-size, 0, -size], "high": [size, 0.8 * size, size]}}


def eye(c, size):
    around = c.uniform(0, 2 * math.pi)
    away = size * c.uniform(1.2, 2.2)
    return c.camera([away * math.sin(around), size * c.uniform(0.3, 1.5), away * math.cos(around)], [0, 0.5 * size, 0])


def way(c, length):
    """A step of so many meters in any direction."""
    step = np.array([c.gauss(0, 1) for _ in range(3)])
    return length * step / np.linalg.norm(step)


def shade(c, middle, half):
    """A box around a lamp that lets light out through holes in its sides."""
    count, share, thin = c.randint(4, 12), c.uniform(0.1, 0.4), 0.01 * half
    wide, bars = (1 - share) * half / count, []
    for axis, side, other, across in itertools.product(range(3), (-half, half), (1, 2), np.linspace(-half, half, count + 1)):
        low, high, face = np.full(3, -half), np.full(3, half), (axis + other) % 3
        low[axis], high[axis], low[face], high[face] = across - wide, across + wide, side - thin, side + thin
        bars.append(box(low, high))
    return np.concatenate(bars) + np.array(middle)


def lever(c):
    """A lamp that moves a little in its shade."""
    size = c.uniform(1, 6)
    lamp, half = size * np.array(c.point((-0.3, 0.95, -0.3), (0.3, 1.1, 0.3))), size * c.log(0.03, 0.1)
    step = way(c, half * c.log(0.5, 1.8)) * (1, 0.5, 1)
    light = c.point_light([0, 0, 0], size) | {"position": keys(list(lamp - step / 2), list(lamp + step / 2))}
    return Drawn(eye(c, size), [light], [haze(c, size)], [Mesh(BLACK, shade(c, lamp, half))])


def lantern(c):
    """A lamp that swings with its shade, or lags."""
    size = c.uniform(1, 4)
    middle, half = np.array([0, c.uniform(1, 1.2) * size, 0]), size * c.log(0.03, 0.1)
    cage = shade(c, middle, half)
    step = way(c, half * c.log(2, 10)) * (1, 0, 1)
    own = step + way(c, half * c.choice([0, 0.2, 0.6]))
    swinging = Mesh(BLACK, cage, Deformation(2 * FRAMES, target=cage + 2 * step))  # half of it while the shutter is open
    light = c.point_light([0, 0, 0], size, c.choice([0, 0, 0.05 * half]))
    light["position"] = keys(list(middle + step), list(middle + step + own))
    floor = Mesh(Material(c.color()), box((-size, -0.1, -size), (size, 0, size)))
    return Drawn(eye(c, size), [light], [haze(c, size)], [swinging, floor])


def narrow_spot(c, size):
    """A spot from above, without its target."""
    place = size * np.array(c.point((-0.7, 1.2, -0.7), (0.7, 1.5, 0.7)))
    return c.spot(place, (0, 0, 0), size) | {"outer_cone": (outer := c.log(2, 15)), "inner_cone": 0.9 * outer}


def sweep(c):
    """Spots that sweep over a room."""
    size = c.uniform(3, 12)
    lights = []
    for _ in range(c.randint(2, 6)):
        target, step = np.array(c.point((-size, 0, -size), (size, 0, size))), way(c, size * c.log(0.5, 2))
        lights.append(narrow_spot(c, size) | {"target": keys(list(target), list(target + step * (1, 0, 1)))})
    return Drawn(eye(c, size), lights, [haze(c, size)], [hall(4 * size, 3 * size, 4 * size, c.color())])


def opening(c):
    """Spots that open or close, some of which fade or flash as they do."""
    size = c.uniform(3, 12)
    lights = []
    for _ in range(c.randint(1, 4)):
        light = narrow_spot(c, size) | {"target": c.point((-size, 0, -size), (size, 0, size))}
        cones = [light["outer_cone"], min(light["outer_cone"] * c.log(2, 6), 60)][::c.choice([1, -1])]
        light |= {"outer_cone": keys(*cones), "inner_cone": keys(*(0.9 * cone for cone in cones))}
        if c.happens(0.5):
            peak, times = light["intensity"], [FRAMES, FRAMES * c.uniform(1.1, 1.5), FRAMES * c.uniform(1.6, 1.9), 2 * FRAMES]
            light["intensity"] = {"keys": [[time, share * peak] for time, share in zip(times, (0.1, 1, 0.2, 0))]}
        lights.append(light)
    return Drawn(eye(c, size), lights, [haze(c, size)], [hall(4 * size, 3 * size, 4 * size, c.color())])


def gobo(c):
    """An image or a profile that turns in the beam."""
    size = c.uniform(2, 8)
    light = c.spot([c.uniform(-0.3, 0.3) * size, c.uniform(1.2, 1.6) * size, 0], [0, 0, 0], size)
    light |= {"outer_cone": (outer := c.uniform(10, 40)), "inner_cone": 0.95 * outer}
    light["gobo"] = {"image": str(SCENES / c.choice(["gobo_spokes.png", "gobo_breakup.png"])),
                     "rotate": keys((turn := c.uniform(0, 360)), turn + c.log(60, 240)), "scale": keys(1, c.choice([1, 1, 0.7]))}
    return Drawn(eye(c, size), [light], [haze(c, size)])


def cloud(c, size):
    """A box of hard-edged noise, and what lights it."""
    recipe = c.recipe([-0.5 * size] * 3, [0.5 * size] * 3, c.uniform(24, 48))
    recipe["density"] |= {"threshold": c.uniform(0.4, 0.55), "gain": c.log(4, 16), "soft_edge": 0}
    medium = {"type": c.choice(["noise", "vdb"]), **c.optics(c.log(5, 30) / size), "recipe": recipe,
              "translate": [0, 0.5 * size, 0]}
    return medium, c.sun() if c.happens(0.6) else c.point_light([size, 1.5 * size, 0.3 * size], size)


def spin(c):
    """Clouds that turn or grow."""
    size = c.uniform(1, 5)
    medium, light = cloud(c, size)
    medium |= {"rotate": keys([0, 0, 0], list(way(c, c.log(40, 240)))), "scale": keys([1] * 3, [c.choice([1, 1, 0.7, 1.4])] * 3)}
    return Drawn(eye(c, size), [light], [medium])


def drift(c):
    """Clouds in wind, from their recipe, by their velocities or blended from file to file."""
    size = c.uniform(1, 5)
    medium, light = cloud(c, size)
    medium["recipe"]["wind"] = list(way(c, size * c.log(0.1, 1) / FRAMES))
    if medium["type"] == "vdb":
        medium |= c.choice([{"grids": {"velocity": "vel"}}, {"sequence": {"blend": True}}])
    return Drawn(eye(c, size), [light], [medium])


def lattice(c, size):
    """Sunlit fog among thin posts and beams, sometimes seen through a lens."""
    bars = []
    for _ in range(c.randint(20, 60)):
        half = np.full(3, size * c.log(0.004, 0.03))
        half[c.randrange(3)] = size * c.uniform(0.2, 1)
        middle = np.array(c.point((-size, 0, -size), (size, size, size)))
        bars.append(box(middle - half, middle + half))
    drawn = Drawn(eye(c, size), [c.sun()], [haze(c, size, (0.2, 2))], [Mesh(Material(c.color(0.02, 0.1)), np.concatenate(bars))])
    if c.happens(0.3):
        drawn.camera |= {"aperture_radius": size * c.log(0.003, 0.03), "focus_distance": size * c.uniform(0.5, 2)}
    return drawn


def camera(c):
    """A view from outside that moves or turns."""
    size = c.uniform(2, 8)
    drawn = lattice(c, size)
    for end in c.choice([["position"], ["target"], ["position", "target"]]):
        at = np.array(drawn.camera[end])
        drawn.camera[end] = keys(list(at), list(at + way(c, size * c.log(0.3, 1))))
    return drawn


def passing(c):
    """A view from among posts and beams that passes them or zooms."""
    size = c.uniform(2, 8)
    drawn = lattice(c, size)
    at = size * np.array(c.point((-0.3, 0.3, -0.3), (0.3, 0.7, 0.3)))
    ahead, step = way(c, size), way(c, size * c.log(0.1, 0.5)) * c.choice([0, 1])
    drawn.camera |= {"position": keys(list(at), list(at + step)), "target": keys(list(at + ahead), list(at + ahead + step))}
    if not step.any() or c.happens(0.3):
        drawn.camera["vertical_fov"] = keys((fov := c.uniform(30, 60)), fov * c.choice([c.uniform(0.4, 0.8), c.uniform(1.25, 2)]))
    return drawn


def rising(c):
    """Fog that rises or thins."""
    size = c.uniform(2, 8)
    falloff, base = size * c.log(0.002, 0.05), size * c.uniform(0, 0.2)
    fog = haze(c, size, (1, 6)) | {"type": "height", "base": keys(base, base + size * c.log(0.2, 0.7)),
                                   "falloff": keys(falloff, falloff * c.choice([1, 1, 0.5, 2]))}
    return Drawn(eye(c, size), [c.sun()], [fog])


FAMILIES = [lever, lantern, sweep, opening, gobo, spin, drift, camera, passing, rising]


def squared_error(differences):
    """The mean square of what images are off by, without their noise, and its standard error: products of independent
    differences hold no noise."""
    n, total, squares = len(differences), np.sum(differences, 0), np.sum(np.square(differences), 0)

    def of(total, squares, n):
        return float(np.mean(total ** 2 - squares)) / (n * (n - 1))

    left_out = [of(total - one, squares - one ** 2, n - 1) for one in differences]
    return of(total, squares, n), np.sqrt((n - 1) * np.var(left_out))


def error_of(pictures, truths):
    """E of the worse layer, and what it surely is above and below."""
    found = [(0, 0, 0)]
    for layer in LAYERS:
        if (mean := np.mean([truth[layer].mean() for truth in truths])) > 0:
            square, error = squared_error([(own[layer] - truth[layer]) / mean for own, truth in zip(pictures, truths)])
            found.append([math.sqrt(max(square + far * error, 0)) for far in (0, -2, 2)])
    return np.max(found, 0).tolist()


def measured(row, scene, folder, options, more=()):
    """The row with the errors of the default number of time samples and of few, and what an image took."""
    def pictures(*asked):
        asked = ["--mode", options.mode, "--samples", SAMPLES, *ALIKE, *asked, *more]
        runs = [render(options.program, scene, folder / "image.exr", ["--seed", seed, *asked]) for seed in range(PAIRS)]
        return [run.layers for run in runs], runs[0]

    own, first = pictures(*(["--time-samples", options.time_samples] if options.time_samples else []))
    if first.layers is None:
        return row | {"refused": first.said[:200]}
    count = first.stats["frames"][0].get("time_samples", 1)
    truths, few = (pictures("--time-samples", number)[0] for number in (min(max(FINER * count, FEWEST), MOST), FEW))
    return row | dict(zip(("E", "low", "high"), error_of(own, truths))) | {
        "few": error_of(few, truths)[1], "time_samples": count, "seconds": first.processor}


def prove(case, options):
    with tempfile.TemporaryDirectory(prefix="proving_shutter_") as folder:
        folder = pathlib.Path(folder)
        if isinstance(case, str):
            name, frame = case.split(":")
            return measured({"scene": case}, SCENES / f"{name}.json", folder, options, ["--frames", frame, *SHIPPED[name]])
        family, c = FAMILIES[case % len(FAMILIES)], Chance(case)
        drawn = family(c)
        drawn.camera["shutter"] = {"open": 0, "close": 1, "curve": c.choice(["box", "triangle"])}
        scene = write_scene(drawn, options.size, folder / "scene", options.program)
        return measured({"scene": f"{case} {family.__name__}"}, scene, folder, options, ["--frames", "1"])


def told(row):
    return row["scene"].ljust(12) + (row.get("refused") or (
        f" E {row['E']:.4f}, surely {row['low']:.4f} to {row['high']:.4f}; {row['time_samples']:4d} time samples, "
        f"{row['seconds']:.1f} s; with {FEW} above {row['few']:.3f}"))


def summary(rows):
    share = lambda fits: round(float(np.mean([fits(row) for row in rows])), 3)
    return {"scenes": len(rows), "above": share(lambda row: row["low"] > MAX_ERROR),
            "below": share(lambda row: row["high"] <= MAX_ERROR), "few_above": share(lambda row: row["few"] > MAX_ERROR),
            "median_time_samples": float(np.median([row["time_samples"] for row in rows]))}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=lambda text: [n for part in text.split(",") for n in numbers(part)], default=[])
    parser.add_argument("--scenes", type=lambda text: text.split(","), default=[], help=", ".join(SHIPPED) + ": with a frame, at full size")
    parser.add_argument("--program", type=pathlib.Path, default=SOURCE / "build/release/tyndall")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("proving"))
    parser.add_argument("--mode", default="march")
    parser.add_argument("--size", type=lambda text: tuple(map(int, text.split("x"))), default=(128, 72))
    parser.add_argument("--time-samples", type=int, help="instead of the default number: to try whether too few are noticed")
    parser.add_argument("--jobs", type=int, default=1, help="scenes at once")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    cases, rows = options.scenes + options.seeds, []
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        for row in pool.map(prove, cases, [options] * len(cases)):
            rows.append(row)
            print(told(row), flush=True)
            (options.output / "shutter.json").write_text(json.dumps(rows, indent=1))
    result = summary([row for row in rows if "E" in row]) | {"refused": sum("refused" in row for row in rows)}
    print(json.dumps(result, indent=1))
    sys.exit(0 if result["above"] <= 0.05 and result["few_above"] >= 1 / 3 and not result["refused"] else 1)


if __name__ == "__main__":
    main()
