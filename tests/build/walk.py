"""Walks the calls from a request for frames to their EXRs, and from settings to the light of march, as a reader does.

    walk.py [ROOT [ROOT ...]]

Prints, per tree and walk, the files entered in order and how often the next one lies in a higher layer than the last.
Functions are found in the sources by the format that clang-format gives them. Functions of the layers that own a walk are
read to their end, each once; those they call below are entered and not read. src/base is vocabulary and does not count."""
import functools
import pathlib
import re
import sys

LAYERS = ["base", "volume", "scene", "trace", "integrate", "modes", "render", "measure", "viewer", "preview", "apps"]
# name -> first functions (the first that a tree has), folders read to the end, functions that end it
WALKS = {
    "request to EXR": (["render_sequence"], ["src/render"], ["write_exr"]),
    "settings to light": (["prepare_march"], ["src/modes"], []),
}
NOT_CALLS = {"if", "for", "while", "switch", "return", "sizeof", "catch", "defined"}


def layer_of(path):
    return LAYERS.index("apps" if path.startswith("apps/") else path.split("/")[1])


class Tree:
    """The functions of a tree, the files that define each and the headers each file includes, itself or by others."""

    def __init__(self, root):
        self.text, self.bodies, self.names = {}, {}, {}
        for path in sorted([*root.glob("src/**/*.h"), *root.glob("src/**/*.cpp"), *root.glob("apps/tyndall/**/*.*")]):
            file = path.relative_to(root).as_posix()
            self.text[file] = re.sub(r"//[^\n]*", "", path.read_text())
            for name, body in functions(self.text[file]):
                self.bodies.setdefault((file, name), []).append(body)
                self.names.setdefault(name, []).append(file)

    @functools.cache
    def included(self, file):
        folder = file.rsplit("/", 1)[0]
        named = re.findall(r'#include "([^"]+)"', self.text[file])
        direct = {place for name in named for place in (f"src/{name}", f"{folder}/{name}") if place in self.text}
        return direct.union(*map(self.included, direct))

    def definition(self, caller, name):
        """The file that defines what `caller` calls by this name."""
        files = self.names.get(name, [])
        if caller in files:
            return caller
        declared = {h for h in self.included(caller) if re.search(rf"\b{name}\(", self.text[h])}
        found = [f for f in files if f in declared or self.included(f) & declared]
        own = [f for f in found if f.rsplit(".", 1)[0] in {h.rsplit(".", 1)[0] for h in declared}]
        return (own or found or [None])[0]


def functions(text):
    """Name and body of each function whose head begins in the first column."""
    lines = text.splitlines()
    for number, line in enumerate(lines):
        if not re.match(r"[A-Za-z]", line) or re.match(r"(namespace|struct|class|enum|using|constexpr|const \w+ \w+ ?[={])", line):
            continue
        end = number
        while end < len(lines) - 1 and not re.search(r"[;}]$", lines[end]) or (
                lines[end].endswith("{") or end > number and lines[end].startswith(" ")):
            end += 1
            if re.match(r"\}", lines[end]):
                break
        chunk = "\n".join(lines[number:end + 1])
        match = re.match(r"(?:template<[^>]*>\s)?[^(){};=]*?\b(?:\w+::)*(\w+)\(", chunk)
        if match and "{" in chunk and chunk.endswith("}"):
            yield match[1], chunk[chunk.index("{"):]


def walk(tree, first, owned, last):
    """The functions entered, in order, as (file, name)."""
    entered, order = set(), []

    def enter(file, name):
        if (file, name) in entered:
            return
        entered.add((file, name)), order.append((file, name))
        if name in last or not any(file.startswith(place) for place in owned):
            return
        for body in tree.bodies[file, name]:
            for called in re.findall(r"(?<![.>\w])(\w+)\(", body):
                place = None if called in NOT_CALLS else tree.definition(file, called)
                if place and 0 < layer_of(place) <= layer_of(file):
                    enter(place, called)

    start = next(name for name in first if name in tree.names)
    enter(next(f for f in tree.names[start] if f.startswith(tuple(owned))), start)
    return order


def main():
    for root in map(pathlib.Path, sys.argv[1:] or ["."]):
        tree = Tree(root)
        for title, (first, owned, last) in WALKS.items():
            files = [file for file, _ in walk(tree, first, owned, last)]
            steps = [file for i, file in enumerate(files) if i == 0 or files[i - 1] != file]
            climbs = sum(layer_of(b) > layer_of(a) for a, b in zip(steps, steps[1:]))
            print(f"{root}, {title}: {len(set(files))} files, {len(steps)} steps, {climbs} to a higher layer")
            print("  " + "\n  ".join(steps))


main()
