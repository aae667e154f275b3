"""Makes docs/images/chart_*.png and prints the table of docs/techniques.md: which technique for which error or time.

    python3 docs/make_charts.py build/release/tyndall OUT [SCENE...] [-- OPTIONS of tyndall chart]

Wants chromium for the pictures. Run it on a machine that does nothing else: times are wall clock. What OUT holds
already is not measured again.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
SCENES = ["window", "spotlight", "pillars", "lantern", "cloud"]
BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
CHOICES = [("error", 0.2), ("error", 0.1), ("error", 0.05), ("error", 0.02), ("error", 0.01),
           ("seconds", 1 / 30), ("seconds", 0.1), ("seconds", 1)]


def picture(chart, png):
    """The two drawings of a single frame side by side: the whole picture, and its fog light."""
    drawings = [(chart / name).resolve().as_uri() for name in ("chart.svg", "chart_fog.svg")]
    body = "".join(f'<img src="{drawing}" style="width:760px;vertical-align:top">' for drawing in drawings)
    with tempfile.TemporaryDirectory() as directory:
        file = pathlib.Path(directory) / "charts.html"
        file.write_text(f'<meta charset="utf-8"><body style="margin:0;font-size:0">{body}</body>')
        subprocess.run([BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                        f"--user-data-dir={directory}/profile", "--window-size=1520,720",
                        f"--screenshot={png}", file.as_uri()], check=True, capture_output=True)


def seconds_words(seconds):
    return f"{1000 * seconds:.0f} ms" if seconds < 1 else f"{seconds:.1f} s"


def percent(share):
    return f"{100 * share:.2g} %"


def fog_error(point):
    """Of the fog light, but no less than what the noise of the reference leaves uncertain."""
    return max(point["fog_error"], point["fog_uncertainty"])


def cell(chart, kind, limit):
    """The quickest point with so little error in the fog light, or the best in so much time."""
    points = [p for p in chart["points"] if p["fog_error"] is not None]
    if kind == "error":
        best = min((p for p in points if fog_error(p) <= limit), key=lambda p: p["seconds_1"], default=None)
    else:
        best = min((p for p in points if p["seconds_1"] <= limit), key=fog_error, default=None)
    if best is None:
        return "-"
    most = "below " if best["fog_error"] < best["fog_uncertainty"] else ""
    return f"`{best['mode']}` {seconds_words(best['seconds_1'])}, {most}{percent(fog_error(best))}"


def main():
    arguments, options = sys.argv[1:], []
    if "--" in arguments:
        split = arguments.index("--")
        arguments, options = arguments[:split], arguments[split + 1:]
    if len(arguments) < 2:
        sys.exit(__doc__)
    tyndall, out, scenes = arguments[0], pathlib.Path(arguments[1]), arguments[2:] or SCENES
    charts = {}
    for scene in scenes:
        subprocess.run([tyndall, "chart", ROOT / f"scenes/{scene}.json", "-o", out / scene, *options],
                       check=True, stdout=subprocess.DEVNULL)
        charts[scene] = json.loads((out / scene / "chart.json").read_text())
        if BROWSER:
            picture(out / scene, ROOT / f"docs/images/chart_{scene}.png")
    print("| wanted of the fog light |", " | ".join(scenes), "|")
    print("|---|" + "---|" * len(scenes))
    for kind, limit in CHOICES:
        need = f"error below {percent(limit)}" if kind == "error" else f"best in {seconds_words(limit)}"
        print(f"| {need} |", " | ".join(cell(charts[scene], kind, limit) for scene in scenes), "|")


if __name__ == "__main__":
    main()
