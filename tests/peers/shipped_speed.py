"""Time to an error of scenes that ship, beside Cycles: python shipped_speed.py --tyndall build/release/tyndall (README.md)
Fog of recipes is baked, and both load the same .vdb. Samples are doubled, the two take turns, until each is within `--error`, by
`tyndall compare`. Times are processor seconds: of tyndall's whole process, of Cycles' render
call alone."""
import argparse
import json
import pathlib
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile

from compare import run_blender
from tyndall_peer import run

HERE = pathlib.Path(__file__).resolve().parent
SCENES = HERE.parent.parent / "scenes"
FRAME = {"campfire": 12, "forest_morning": 1, "concert": 12, "cumulus_sky": 1}


def prepare(name, folder, program, frame):
    """NAME.json with its recipes baked, all paths absolute; the medium's own numbers beside the file."""
    document = json.loads((SCENES / f"{name}.json").read_text())
    for medium in document["media"]:
        if medium["type"] != "noise":
            continue
        recipe = (SCENES / medium.pop("recipe")).resolve()
        pattern = folder / f"{name}_{medium['name']}.####.vdb"
        run([program, "bake", str(recipe), "-o", str(pattern), "--frames", str(frame), "-q"])
        medium |= {"type": "vdb", "file": pattern.name.replace("####", f"{frame:04}"), **json.loads(recipe.read_text())["optics"]}
        if "blackbody" in medium:
            medium["grids"] = {"temperature": "temperature"}
    lamps = [(light[part], field) for light in document.get("lights", ()) for part, field in (("ies", "file"), ("gobo", "image"))
             if part in light]
    for owner, key in [(document, "gltf"), *lamps]:
        if key in owner:
            shutil.copy(SCENES / owner[key], folder / owner[key])
    document.pop("$schema")
    path = folder / f"{name}.json"
    path.write_text(json.dumps(document, indent=1))
    return path


def compared(program, a, b):
    done = subprocess.run([program, "compare", str(a), str(b), "--json"], stdout=subprocess.PIPE)
    return json.loads(done.stdout)["metrics"]["rmse_rel"]


class Tyndall:
    """March pictures of ever more samples. What they are compared with has final quality and four times the samples, and its noise
    counts as error."""

    def __init__(self, quality, scene, frame, args, folder):
        self.quality, self.scene, self.frame, self.args, self.folder = quality, scene, frame, args, folder

    def render(self, samples, seed, better=False):
        picture = self.folder / f"{self.scene.stem}_{self.quality}_{samples}_{seed}.exr"
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        run([self.args.tyndall, "render", str(self.scene), "-o", str(picture), "--frames", str(self.frame), "--aov", "none", "-q",
             "--res", self.args.res, "--samples", str(samples), "--seed", str(seed), "--threads", str(self.args.threads),
             "--quality", "final" if better else self.quality, "--set", "pixel.filter=box", "--set", "pixel.filter_radius=0.5",
             *shlex.split(self.args.options)])
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return picture, after.ru_utime + after.ru_stime - used.ru_utime - used.ru_stime

    def rung(self, samples):
        """Samples, processor seconds and error of a picture."""
        picture, seconds = self.render(samples, 1)
        better, _ = self.render(4 * samples, 1000, better=True)
        return samples, seconds, compared(self.args.tyndall, picture, better)


class Cycles:
    """The same scene; light scattered once, without bias."""

    def __init__(self, scene, frame, args, folder):
        self.scene, self.frame, self.args, self.folder = scene, frame, args, folder

    def render(self, samples, seed):
        output = str(self.folder / f"cycles_{self.scene.stem}_{samples}_")
        run_blender({"scene": str(self.scene), "frame": self.frame, "size": list(map(int, self.args.res.split("x"))),
                     "samples": samples, "threads": self.args.threads, "seeds": [seed], "sampling": self.args.sampling,
                     "output": output}, self.folder, "shipped_cycles.py")
        return pathlib.Path(f"{output}{seed}.exr"), float(pathlib.Path(f"{output}{seed}.seconds").read_text().split()[1])

    def rung(self, samples):
        """Of the mean of two pictures with other random numbers: its error is half of their difference."""
        (one, first), (other, second) = [self.render(samples, seed) for seed in (1, 1000)]
        return 2 * samples, first + second, compared(self.args.tyndall, one, other) / 2


def ladder(renderer, samples):
    while True:
        yield renderer.rung(samples)
        samples *= 2


def climb(renderers, args):
    """Doubles samples of each in turn until all are within the error or have had their time; prints a row for each rung."""
    rungs = {name: ladder(renderer, args.first) for name, renderer in renderers.items()}
    reached = {}
    while rungs:
        for name in list(rungs):
            reached[name] = samples, seconds, left = next(rungs[name])
            print(f"| {name} | {samples} | {seconds:.2f} | {left:.2%} |", flush=True)
            if left <= args.error or seconds > args.limit:
                del rungs[name]
    return reached


def main():
    parser = argparse.ArgumentParser(description="processor time of tyndall and Cycles to an error, on scenes that ship")
    parser.add_argument("--tyndall", default="build/release/tyndall", help="the program")
    parser.add_argument("--scenes", default=",".join(FRAME), help="of " + ",".join(FRAME))
    parser.add_argument("--renderers", default="preview,final,cycles", help="tyndall's qualities, and cycles")
    parser.add_argument("--res", default="640x360", help="of the picture, pixels")
    parser.add_argument("--error", type=float, default=0.05, help="the error to reach: RMSE over the mean")
    parser.add_argument("--first", type=int, default=1, help="samples of a picture to begin with")
    parser.add_argument("--limit", type=float, default=1200, help="processor seconds after which a renderer stops")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--options", default="--mode march --orders 1", help="of tyndall")
    parser.add_argument("--sampling", default="MULTIPLE_IMPORTANCE", choices=["DISTANCE", "EQUIANGULAR", "MULTIPLE_IMPORTANCE"],
                        help="of Cycles' volumes")
    parser.add_argument("--keep", type=pathlib.Path, help="folder that keeps scenes and pictures")
    args = parser.parse_args()
    if not shutil.which(args.tyndall):
        sys.exit(f"shipped_speed.py: {args.tyndall} is not there: build it, or name it with --tyndall")
    with tempfile.TemporaryDirectory(prefix="tyndall_speed_") as name:
        folder = args.keep or pathlib.Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        for scene in args.scenes.split(","):
            path = prepare(scene, folder, args.tyndall, FRAME[scene])
            print(f"\n{scene}\n| renderer | samples | seconds | error |\n|---|---|---|---|")
            names = args.renderers.split(",")
            climb({name: Cycles(path, FRAME[scene], args, folder) if name == "cycles" else
                   Tyndall(name, path, FRAME[scene], args, folder) for name in names}, args)


if __name__ == "__main__":
    main()
