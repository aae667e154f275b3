"""Draws what runs of the proving ground found: the target error against the error achieved, one dot per target. Writes
the figures beside the drawing, as CSV.

    tests/proving/run.py --seeds 5001-5200 -o out/proving
    docs/make_accuracy.py docs/images/accuracy.svg out/proving/proving.json [MORE.json ...]
"""
import csv
import json
import math
import pathlib
import random
import sys

WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 720, 420, 64, 28, 48
COLORS = {"march": "#0072B2", "auto": "#D55E00"}
LOW, HIGH = 0.001, 0.2  # errors on the vertical axis


def place_y(error):
    share = math.log(min(max(error, LOW), HIGH) / LOW) / math.log(HIGH / LOW)
    return HEIGHT - BOTTOM - share * (HEIGHT - TOP - BOTTOM)


def text(x, y, words, anchor="middle", more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {more}>{words}</text>'


def drawing(rows):
    targets = sorted({row["asked"] for row in rows})
    step = (WIDTH - LEFT - 20) / len(targets)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="13">',
             f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    for error in (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2):
        y = place_y(error)
        parts += [f'<line x1="{LEFT}" x2="{WIDTH - 20}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>',
                  text(LEFT - 8, y + 4, f"{100 * error:g} %", "end")]
    chance = random.Random(1)  # spreads dots sideways
    for column, target in enumerate(targets):
        left = LEFT + column * step
        y = place_y(target)
        parts += [f'<line x1="{left + 10:.1f}" x2="{left + step - 10:.1f}" y1="{y:.1f}" y2="{y:.1f}" stroke="#222" stroke-width="2"/>',
                  text(left + step / 2, HEIGHT - BOTTOM + 20, f"target {100 * target:g} %")]
        for row in (row for row in rows if row["asked"] == target):
            side = 0.3 if row["mode"] == "march" else 0.7
            x = left + step * (side + chance.uniform(-0.15, 0.15))
            filled = COLORS[row["mode"]] if row["exit"] == 0 else "white"
            parts.append(f'<circle cx="{x:.1f}" cy="{place_y(row["achieved"]):.1f}" r="3.5" fill="{filled}" fill-opacity="0.6" '
                         f'stroke="{COLORS[row["mode"]]}"><title>seed {row["seed"]}, {row["family"]}: {row["achieved"]:.4f}, '
                         f'at most {row["bound"] or 0:.4f}</title></circle>')
    for i, (mode, color) in enumerate(COLORS.items()):
        x = LEFT + 14 + 90 * i
        parts += [f'<circle cx="{x}" cy="{TOP - 12}" r="4" fill="{color}"/>', text(x + 8, TOP - 8, mode, "start")]
    parts.append(text(WIDTH - 20, TOP - 8, "error achieved; line: target; hollow: exit code 1", "end"))
    return "\n".join([*parts, "</svg>", ""])


COLUMNS = {"seed": "", "family": "", "redrawn": "", "asked": "g", "mode": "", "chosen": "", "exit": "", "stated": ".4f", "bound": ".4f",
           "achieved": ".4f", "samples": "", "seconds": ".2f", "processor": ".2f", "forecast": ".2f", "took": ".2f"}


def table(rows):
    """One row per target: the target, the error stated and achieved, and the time it took."""
    for row in sorted(rows, key=lambda row: (row["seed"], -row["asked"], row["mode"] != "march")):
        yield ["" if row.get(name) is None else format(row[name], form) for name, form in COLUMNS.items()]


def main():
    drawing_file = pathlib.Path(sys.argv[1])
    rows = [row for file in sys.argv[2:] for row in json.loads(pathlib.Path(file).read_text())
            if row.get("achieved") is not None]
    drawing_file.write_text(drawing(rows))
    with open(drawing_file.with_suffix(".csv"), "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS, *table(rows)])


if __name__ == "__main__":
    main()
