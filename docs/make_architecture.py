"""Writes docs/images/architecture.svg from the includes: layers, their folders, and which folder includes which.

    python3 docs/make_architecture.py             # write it
    python3 docs/make_architecture.py --check     # only tell whether it is stale; exit code 1 when it is
"""
import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
PICTURE = ROOT / "docs/images/architecture.svg"
COMMAND = "python3 docs/make_architecture.py"
LAYERS = {"base": "#64748b", "volume": "#0e7490", "scene": "#15803d", "trace": "#4d7c0f", "integrate": "#a16207",
          "modes": "#c2410c", "render": "#be123c", "measure": "#86198f", "viewer": "#5b21b6", "apps": "#1e3a8a"}
LIBRARIES = {"tbb/": "TBB", "nlohmann/": "nlohmann-json", "hwy/": "Highway", "openvdb/": "OpenVDB", "nanovdb/": "NanoVDB",
             "tiny_gltf": "tinygltf", "stb_image": "stb", "embree": "Embree", "OpenEXR/": "OpenEXR", "Imf": "OpenEXR",
             "CLI/": "CLI11", "GLFW/": "GLFW", "imgui": "Dear ImGui"}
CELL, GAP = 15, 6          # pixels: a folder's row and column; between layers
LEFT, TOP = 250, 100       # of the matrix
FAINT, TEXT = "#f1f5f9", "#334155"


def folder_of(path):
    """trace/shadows of trace/shadows/maps/a.h; a layer's own files are a folder of its name."""
    parts = path.split("/")
    return "/".join(parts[:2]) if len(parts) > 2 else parts[0]


def read_includes():
    """The pairs of folders of which one includes the other, and the libraries of each folder."""
    edges, libraries = set(), collections.defaultdict(set)
    for base in ("src", "apps"):
        for path in sorted((ROOT / base).rglob("*")):
            if path.suffix not in (".h", ".cpp") or path.parent == ROOT / "apps":
                continue
            own = folder_of(path.relative_to(ROOT / base if base == "src" else ROOT).as_posix())
            libraries[own] |= set()
            for name in re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', path.read_text(), re.M):
                libraries[own] |= {library for prefix, library in LIBRARIES.items() if name.startswith(prefix)}
                if name.split("/")[0] in LAYERS and "/" in name and folder_of(name) != own:
                    edges.add((own, folder_of(name)))
    return edges, libraries


def in_order(layer, folders, edges):
    """A layer's folders, each as far as possible below those it includes."""
    left, ordered = sorted(folder for folder in folders if folder.split("/")[0] == layer), []
    while left:
        next_one = min(left, key=lambda folder: (sum((folder, other) in edges for other in left), folder))
        left.remove(next_one)
        ordered.append(next_one)
    return ordered


def text(x, y, words, size=11, color=TEXT, anchor="start", more=""):
    return f'<text x="{x}" y="{y}" font-size="{size}" fill="{color}" text-anchor="{anchor}" {more}>{words}</text>'


def box(x, y, width, height, color, radius=3, more=""):
    return f'<rect x="{x}" y="{y}" width="{width}" height="{height}" rx="{radius}" fill="{color}" {more}/>'


def drawing():
    edges, libraries = read_includes()
    places, bands, offset = {}, {}, 0  # of folders and layers, in pixels from the matrix's corner
    for layer in LAYERS:
        folders = in_order(layer, libraries, edges)
        bands[layer] = (offset, CELL * len(folders))
        for folder in folders:
            places[folder] = offset
            offset += CELL
        offset += GAP
    size = offset - GAP
    parts = [text(24, 34, "Layers, folders and what they include", 18, "#0f172a", more='font-weight="600"'),
             text(24, 54, "Rows and columns are the same folders; a square says that the row includes the column."),
             text(24, 70, "A layer includes itself and the layers above it, so that nothing lies right of the colored blocks. "
                          "A technique includes no other technique.")]
    for layer, (start, length) in bands.items():
        color = LAYERS[layer]
        parts += [box(24, TOP + start, 74, length, color),
                  text(61, TOP + start + length / 2 + 4, layer, 12 if len(layer) < 9 else 11, "#ffffff", "middle", 'font-weight="600"'),
                  box(LEFT, TOP + start, start + length, length, FAINT, 0),
                  box(LEFT + start, TOP + start, length, length, color, 2, 'fill-opacity="0.16"')]
    for folder, start in places.items():
        layer = folder.split("/")[0]
        name = folder.split("/")[1] + "/" if "/" in folder else "its own files"
        parts += [box(104, TOP + start + 0.5, LEFT - 112, CELL - 1, LAYERS[layer], 3, 'fill-opacity="0.12"'),
                  text(112, TOP + start + CELL - 4, name, 11),
                  box(LEFT + start + 4, TOP + start + 4, CELL - 8, CELL - 8, LAYERS[layer], 4)]
        if libraries[folder]:
            parts.append(text(LEFT + size + 12, TOP + start + CELL - 4, ", ".join(sorted(libraries[folder])), 10, "#64748b"))
    for own, other in sorted(edges):
        same = own.split("/")[0] == other.split("/")[0]
        parts.append(box(LEFT + places[other] + 2, TOP + places[own] + 2, CELL - 4, CELL - 4,
                         LAYERS[own.split("/")[0]] if same else TEXT, 2, 'fill-opacity="0.7"'))
    for layer, (start, length) in bands.items():  # a column's name stands over its block, where nothing else is
        parts.append(text(LEFT + start + 1, TOP + start - 4, layer, 11, LAYERS[layer], more='font-weight="600"'))
    parts.append(text(LEFT + size + 12, TOP - 4, "libraries", 10, "#64748b", more='font-style="italic"'))
    width, height = LEFT + size + 130, TOP + size + 20
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
            f'font-family="Helvetica, Arial, sans-serif">\n<!-- written by {COMMAND} -->\n'
            + box(0, 0, width, height, "#ffffff", 0) + "\n" + "\n".join(parts) + "\n</svg>\n")


def main():
    new = drawing()
    if "--check" not in sys.argv:
        PICTURE.write_text(new)
    elif not PICTURE.exists() or PICTURE.read_text() != new:
        sys.exit(f"stale: {PICTURE.relative_to(ROOT)}. Regenerate with: {COMMAND}")


if __name__ == "__main__":
    main()
