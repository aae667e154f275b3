"""Makes the pictures of README.md and docs anew, each with the command that stands beside it: a line that ends in
"docs/images/NAME".

    python3 docs/make_pictures.py build/release/tyndall [NAME...]      # window.png, or all of them

Wants python3-pil; pictures of the viewer want xvfb-run. Charts have a script of their own: make_charts.py.
"""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parents[1]
WIDEST = 800  # pixels of a picture on a page; windows are left as they are
SMALL = 400  # pixels of those that may have all their colors
PICTURE = re.compile(r"    (tyndall .*?)\s+#(?: .*)? docs/images/(\S+)$")


def commands():
    """Picture and command of every such line, with the commands before it in the same block: it may need their files."""
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]:
        before = []
        for line in page.read_text().splitlines():
            found = PICTURE.match(line)
            if found:
                yield found[2], shlex.split(found[1]), before
            elif line.startswith("    tyndall "):
                before.append(shlex.split(line.split(" # ")[0]))
            if not line.startswith("    "):
                before = []


def make(tyndall, picture, words, before, directory):
    """Runs a command in a directory that looks like the repository, and takes what it wrote to out/ under its name."""
    shown = words[1] == "view"
    while before:
        subprocess.run([tyndall, *before.pop(0)[1:]], cwd=directory, check=True, stdout=subprocess.DEVNULL)
    subprocess.run([*(["xvfb-run", "-a", "-s", "-screen 0 1280x800x24"] if shown else []), tyndall, *words[1:]],
                   cwd=directory, check=True, stdout=subprocess.DEVNULL)
    stem, extension = picture.rsplit(".", 1)
    made = [directory / f"out/{stem}.{extension}", directory / f"out/{stem}.modes.{extension}"]
    written, kept = next(path for path in made if path.exists()), ROOT / "docs/images" / picture
    if extension == "png":
        image = Image.open(written).convert("RGB")
        if not shown and image.width > WIDEST:
            image = image.resize((WIDEST, image.height * WIDEST // image.width), Image.LANCZOS)
        if image.width > SMALL:  # in 256 colors, dithered so that beams show no bands
            image = image.quantize(palette=image.quantize(256), dither=Image.FLOYDSTEINBERG)
        image.save(kept, optimize=True)
    else:
        shutil.copyfile(written, kept)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    tyndall, wanted = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
    with tempfile.TemporaryDirectory() as name:
        directory = pathlib.Path(name)
        (directory / "out").mkdir()
        for folder in ("scenes", "volumes", "docs"):
            os.symlink(ROOT / folder, directory / folder)
        for picture, words, before in commands():
            if not wanted or picture in wanted:
                print(picture, flush=True)
                make(tyndall, picture, words, before, directory)


if __name__ == "__main__":
    main()
