"""Prints the table of docs/techniques.md: every mode's time, error and FLIP.

    python3 docs/make_modes.py build/release/tyndall OUT [SCENE...] [--res WxH]

Run it on a machine that does nothing else: times are wall clock, those of the fog alone. Fog is timed and measured at one
ray per pixel's center, at preview.
"""
import argparse
import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[1]
SCENES = ["window", "spotlight", "pillars", "lantern"]
CENTERS = ["--set", "pixel.filter=center", "--set", "pixel.lamp_samples=1"]
REFERENCE = 8  # samples of the reference, whose noise counts as error


def run(*command):
    return subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout


def measured(tyndall, scene, mode, out, options):
    """Seconds of the fog, its error and the FLIP of the whole, at pixel centers."""
    image, stats = out / f"{mode}.exr", out / f"{mode}.json"
    run(tyndall, "render", scene, "-o", image, "--mode", mode, "--stats-json", stats, "--samples", 1, *CENTERS, *options)
    report = json.loads(run(tyndall, "--json", "compare", image, out / "reference.exr"))
    error = report["layers"]["inscatter"]["rmse_rel"]
    return json.loads(stats.read_text())["totals"]["fog_seconds"], error, report["metrics"]["flip"]


def seconds_text(seconds):
    return f"{1000 * seconds:.2g} ms" if seconds < 0.01 else f"{1000 * seconds:.0f} ms" if seconds < 1 else f"{seconds:.0f} s"


def percent(share):
    return f"{100 * share:.2g} %" if share < 0.1 else f"{100 * share:.0f} %"


def column(tyndall, name, out, resolution, modes):
    """The cells of one scene by mode."""
    out.mkdir(parents=True, exist_ok=True)
    scene, options = ROOT / f"scenes/{name}.json", ["--frames", "1", "--res", resolution, "--quiet"]
    run(tyndall, "render", scene, "-o", out / "reference.exr", "--quality", "reference", "--samples", REFERENCE, *CENTERS, *options)
    cells = {}
    for mode in modes:
        seconds, error, flip = measured(tyndall, scene, mode, out, options)
        cells[mode] = f"{seconds_text(seconds)}, {percent(error)}, {flip:.3f}"
    return cells


def main():
    reader = argparse.ArgumentParser(usage=__doc__)
    reader.add_argument("tyndall")
    reader.add_argument("out", type=pathlib.Path)
    reader.add_argument("scenes", nargs="*", default=SCENES)
    reader.add_argument("--res", default="640x360")
    asked = reader.parse_args()
    modes = [mode["name"] for mode in json.loads(run(asked.tyndall, "modes", "--json"))["modes"]]
    modes.remove("path")  # its error is noise
    columns = {name: column(asked.tyndall, name, asked.out / name, asked.res, modes) for name in asked.scenes}
    print("| mode |", " | ".join(columns), "|")
    print("|---|" + "---|" * len(columns))
    for mode in modes:
        print(f"| `{mode}` |", " | ".join(cells[mode] for cells in columns.values()), "|")


if __name__ == "__main__":
    main()
