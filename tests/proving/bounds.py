"""What merge says of the error of its frames: whether it is so, on scenes drawn by chance.

    bounds.py --seeds 5101-5150 [--kinds samples,target] [--program build/release/tyndall] [-o DIR] [--truths DIR] [--jobs 2]

Every seed has one mode, with single scattering or with all orders, and is planned, rendered in two parts and merged four
times: by three numbers of samples, and by a target. What merge says is held against exact single scattering, or against path
tracing where there are all orders or `path` renders (it alone shadows ambient light).
Prints a row a frame and what they add up to, by mode and number of groups; writes DIR/bounds.json. Ends with 1 when more
than one bound in twenty is invalid, or the median bound is more than twice the error."""
import argparse
import concurrent.futures
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import numpy as np

from families import draw, family_of
from pictures import LAYERS, Truth, error_against, read_layers, render
from run import SLACK, numbers, scene_with_truth
from scene_files import write_scene

SOURCE = pathlib.Path(__file__).parents[2]
KINDS = [("march", "1"), ("froxel", "1"), ("path", "all"), ("march", "all"), ("froxel", "all"), ("path", "1")]
SAMPLES = [("--samples", 8, "--groups", 2), ("--samples", 8, "--groups", 8), ("--samples", 16, "--groups", 2)]
TARGET = 0.1
PICTURES = 6   # independent ones of a truth
MANY = 128     # samples of each
ROUNDING = 1e-6  # of 32 bit floats
KNOWN = 0.35   # of the bound, at most, is what a truth may be off by
FEW_PATHS = ("--set", "fluence.paths=10000", "--set", "fluence.resolution=24")  # every part and picture prepares them


def mean_of_pictures(pictures):
    """Independent pictures as a truth."""
    layers = {layer: np.mean([picture[layer] for picture in pictures], 0) for layer in LAYERS}
    variance = {layer: np.mean(np.var([picture[layer] for picture in pictures], 0, ddof=1)) / len(pictures)
                for layer in LAYERS}
    return Truth(layers, variance, 0)


def path_traced(program, scene, folder, options):
    """By many samples; None where they cannot be rendered."""
    runs = [render(program, scene, folder / "truth.exr",
                   ["--mode", "path", "--samples", MANY, *options, "--seed", 1000 + i])
            for i in range(PICTURES)]
    return None if any(run.layers is None for run in runs) else mean_of_pictures([run.layers for run in runs])


def merged(program, scene, folder, options):
    """Plans, renders two parts and merges: layers, what merge says of the frame, and the plan. None where it is refused."""
    def run(*words):
        return subprocess.run([str(word) for word in (program, *words, "-q")], capture_output=True, text=True, timeout=600)
    for file in folder.glob("frame*"):
        file.unlink()
    plan, output = folder / "frame.plan.json", folder / "frame.exr"
    said = run("plan", scene, *options, "--float", "--save", plan).stderr
    if not plan.exists():
        return None, {"refused": said.strip()[:200]}, {}
    for part in (1, 2):
        said += run("render", "--plan", plan, "-o", output, "--part", f"{part}/2", "--threads", 2).stderr
    done = run("merge", *folder.glob("frame.part-*"), "-o", output, "--json")
    if not output.exists():
        return None, {"refused": (said + done.stderr).strip()[:200]}, {}
    return read_layers(output), json.loads(done.stdout)["frames"][0], json.loads(plan.read_text())


def row_of(common, program, scene, folder, asked, truth):
    layers, said, plan = merged(program, scene, folder, asked)
    if layers is None or "bound" not in said:
        return common | {"refused": said.get("refused", "says nothing of its error")}
    achieved = error_against(truth, layers)
    if truth.error() > KNOWN * said["bound"] and achieved - 2 * truth.error() <= SLACK * said["bound"]:
        return common | {"refused": f"no truth: off by {truth.error():.4f} where at most {said['bound']:.4f} is said"}
    return common | {"groups": said["groups"], "samples": said["samples"], "said": said["error"], "bound": said["bound"],
                     "achieved": achieved, "truth_error": truth.error(),
                     "integrator": plan.get("integrator"),
                     "orders_error": plan.get("orders")}


def scene_and_truth(seed, mode, orders, folder, options):
    """The scene, the options that make its frame and the truth of it: None where there is none."""
    if orders == "1" and mode != "path":
        wanted = argparse.Namespace(program=options.program, truths=options.truths, size=None, truth_seconds=60)
        scene, frame, truth, _ = scene_with_truth(seed, folder, [0.2 * TARGET], wanted)
        return scene, ["--frames", frame], truth
    drawn, size = draw(seed)
    scene = write_scene(drawn, size, folder / "scene", options.program)
    frame = ["--frames", drawn.frame, "--res", "{}x{}".format(*options.size)]
    return scene, frame, path_traced(options.program, scene, folder, ["--orders", orders, *frame])


def prove(seed, options):
    folder = pathlib.Path(tempfile.mkdtemp(prefix=f"proving_bounds_{seed}_"))
    mode, orders = KINDS[seed % len(KINDS)]
    common = {"seed": seed, "family": family_of(seed).__name__, "mode": mode, "orders": orders}
    rows, start, what = [], time.monotonic(), "truth"
    try:
        scene, frame, truth = scene_and_truth(seed, mode, orders, folder, options)
        if truth is None:
            return [common | {"what": what, "refused": "no truth", "seconds": time.monotonic() - start}]
        plain = ["--mode", mode, "--orders", orders, *frame, *(FEW_PATHS if orders == "all" and mode != "path" else ())]
        draft = () if mode == "path" else ("--quality", "draft")
        asked = [("samples", [*draft, *some]) for some in SAMPLES] + [("target", ["--target-error", TARGET])]
        for what, more in asked:
            if what in options.kinds:
                rows.append(row_of(common | {"what": what}, options.program, scene, folder, [*plain, *more], truth))
    except subprocess.TimeoutExpired as late:
        rows.append(common | {"what": what, "refused": f"took more than {late.timeout} s"})
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return [row | {"seconds": time.monotonic() - start} for row in rows]


def is_valid(row):
    return row["achieved"] <= SLACK * row["bound"] + ROUNDING


def line(row):
    start = f"{row['seed']:6d} {row['family']:12s} {row['mode']:6s} {row['orders']:3s} {row['what']:7s}"
    if "refused" in row:
        return f"{start} {row['refused']}"
    return (f"{start} {row['groups']} groups {row['samples']:4d} samples said {row['said']:.4f} at most {row['bound']:.4f} is "
            f"{row['achieved']:.4f}" + ("" if is_valid(row) else "  BOUND INVALID"))


def share(rows):
    """Number, number of valid bounds, and median bound by error."""
    return {"frames": len(rows), "valid": sum(map(is_valid, rows)),
            "bound_by_error": round(float(np.median([row["bound"] / max(row["achieved"], 1e-9) for row in rows])), 3)}


def summary(rows):
    told = [row for row in rows if "refused" not in row]
    result = {"all": share(told)} if told else {}
    for name, key in (("by_kind", lambda r: f"{r['mode']} {r['orders']} {r['what']}"),
                      ("by_groups", lambda r: f"{r['groups']} {r['what']}")):
        result[name] = {of: share([row for row in told if key(row) == of]) for of in sorted(set(map(key, told)))}
    return result | {"refused": len(rows) - len(told)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=lambda text: [n for part in text.split(",") for n in numbers(part)], required=True)
    parser.add_argument("--kinds", type=lambda text: text.split(","), default=["samples", "target"])
    parser.add_argument("--program", default=SOURCE / "build/release/tyndall")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("proving"))
    parser.add_argument("--size", type=lambda text: tuple(map(int, text.split("x"))), default=(48, 27),
                        help="of pictures that are held against path tracing")
    parser.add_argument("--truths", type=pathlib.Path, help="a folder that keeps truths from run to run")
    parser.add_argument("--jobs", type=int, default=1, help="scenes at once")
    options = parser.parse_args()
    for folder in filter(None, (options.output, options.truths)):
        folder.mkdir(parents=True, exist_ok=True)
    rows = []
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        for done in concurrent.futures.as_completed([pool.submit(prove, seed, options) for seed in options.seeds]):
            rows += (some := done.result())
            print("\n".join(map(line, some)), flush=True)
            (options.output / "bounds.json").write_text(json.dumps(rows, indent=1))
    result = summary(rows)
    print(json.dumps(result, indent=1))
    told = result.get("all", {"frames": 0, "valid": 0, "bound_by_error": 0})
    sys.exit(0 if told["frames"] and told["valid"] >= 0.95 * told["frames"] and told["bound_by_error"] <= 2 else 1)


if __name__ == "__main__":
    main()
