"""Makes docs/images/modes_*.png, every mode on a scene, and prints the table of docs/techniques.md: time, error, FLIP.

    python3 docs/make_modes.py build/release/tyndall OUT [SCENE...] [--res WxH]

Wants python3-pil and fonts-dejavu-core. Run it on a machine that does nothing else: times are wall clock. Fog is timed and
measured at one ray per pixel's centre, at preview; pictures are taken at four.
"""
import argparse
import json
import pathlib
import subprocess

from PIL import Image, ImageDraw, ImageFont

ROOT = pathlib.Path(__file__).resolve().parents[1]
SCENES = ["window", "spotlight", "pillars", "lantern"]
CENTRES = ["--samples", "1", "--set", "pixel.filter=center", "--set", "pixel.lamp_samples=1"]
CELL, LINE, BORDER = (320, 180), 21, 3
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"


def run(*command):
    return subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout


def measured(tyndall, scene, mode, out, options):
    """Seconds of the fog, its error and the FLIP of the whole, at pixel centres."""
    image, stats = out / f"{mode}.exr", out / f"{mode}.json"
    run(tyndall, "render", scene, "-o", image, "--mode", mode, "--stats-json", stats, *CENTRES, *options)
    report = json.loads(run(tyndall, "--json", "compare", image, out / "reference.exr"))
    error = report["layers"]["inscatter"]["rmse_rel"]
    return json.loads(stats.read_text())["totals"]["fog_seconds"], error, report["metrics"]["flip"]


def seconds_text(seconds):
    return f"{1000 * seconds:.2g} ms" if seconds < 0.01 else f"{1000 * seconds:.0f} ms" if seconds < 1 else f"{seconds:.0f} s"


def percent(share):
    return f"{100 * share:.2g} %" if share < 0.1 else f"{100 * share:.0f} %"


def sheet(pictures, file):
    """Pictures with a line under each, three in a row."""
    font = ImageFont.truetype(FONT, 12)
    width, height = CELL[0] + 2 * BORDER, CELL[1] + BORDER + LINE + BORDER
    page = Image.new("RGB", (3 * width, -(-len(pictures) // 3) * height), (24, 24, 24))
    draw = ImageDraw.Draw(page)
    for place, (path, words) in enumerate(pictures):
        x, y = place % 3 * width, place // 3 * height
        page.paste(Image.open(path).convert("RGB").resize(CELL, Image.LANCZOS), (x + BORDER, y + BORDER))
        draw.text((x + width // 2, y + BORDER + CELL[1] + 4), words, (230, 230, 230), font, "ma")
    page.save(file)


def make(tyndall, name, out, resolution, modes):
    """The sheet of one scene; returns the cells of its column by mode."""
    out.mkdir(parents=True, exist_ok=True)
    scene, options = ROOT / f"scenes/{name}.json", ["--frames", "1", "--res", resolution, "--quiet"]
    run(tyndall, "render", scene, "-o", out / "reference.exr", "--quality", "reference", *CENTRES, *options, "--png")
    exposure = Image.open(out / "reference.png").text["tyndall:exposure"]  # of all
    pictures, cells = [], {}
    for mode in modes:
        run(tyndall, "render", scene, "-o", out / f"look.{mode}.exr", "--mode", mode, *options, "--png", "--exposure",
            exposure)
        words = f"{mode}   all orders"
        if mode != "path":
            seconds, error, flip = measured(tyndall, scene, mode, out, options)
            cells[mode] = f"{seconds_text(seconds)}, {percent(error)}, {flip:.3f}"
            words = f"{mode}   {seconds_text(seconds)}   error {percent(error)}   FLIP {flip:.3f}"
        pictures.append((out / f"look.{mode}.png", words))
    sheet([*pictures, (out / "reference.png", "reference")], ROOT / f"docs/images/modes_{name}.png")
    return cells


def main():
    reader = argparse.ArgumentParser(usage=__doc__)
    reader.add_argument("tyndall")
    reader.add_argument("out", type=pathlib.Path)
    reader.add_argument("scenes", nargs="*", default=SCENES)
    reader.add_argument("--res", default="640x360")
    asked = reader.parse_args()
    modes = [mode["name"] for mode in json.loads(run(asked.tyndall, "modes", "--json"))["modes"]]
    columns = {name: make(asked.tyndall, name, asked.out / name, asked.res, modes) for name in asked.scenes}
    print("| mode |", " | ".join(columns), "|")
    print("|---|" + "---|" * len(columns))
    for mode in modes[:-1]:
        print(f"| `{mode}` |", " | ".join(cells[mode] for cells in columns.values()), "|")


if __name__ == "__main__":
    main()
