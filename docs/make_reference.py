"""Writes docs/reference/: settings, modes, scene and recipe keys, exit codes, limitations, from the tables the program has
them from.

    python3 docs/make_reference.py build/release/tyndall            # write the pages, and the table of modes in README.md
    python3 docs/make_reference.py build/release/tyndall --check    # only tell which are stale; exit code 1 when one is
"""
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
COMMAND = "python3 docs/make_reference.py build/release/tyndall"
GROUPS = {  # of settings that several modes share
    "pixel": "How pixels are sampled", "terms": "Terms of the light", "style": "Artistic control",
    "fluence": "Multiple scattering in `march` and `froxel`",
}


def told(tyndall, *arguments):
    return subprocess.run([tyndall, *arguments], check=True, capture_output=True, text=True).stdout


def cell(text):
    return str(text).replace("|", "\\|").replace("\n", " ")


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(map(cell, line)) + " |\n" for line in lines)


def number(value):
    return f"{value:g}"


# --- modes and settings ------------------------------------------------------------------------------------------------

def readers_text(row, modes):
    readers = row["modes"]
    if len(readers) == len(modes):
        return "all modes"
    if len(readers) > len(modes) / 2:
        return "all but " + ", ".join(f"`{mode}`" for mode in modes if mode not in readers)
    return ", ".join(f"`{mode}`" for mode in readers)


def range_text(row):
    if "choices" in row:
        return ", ".join(f"`{choice}`" for choice in row["choices"])
    whole = "whole, " if row["integer"] else ""
    return f"{whole}{number(row['low'])} to {number(row['high'])}" + (f" {row['unit']}" if row["unit"] else "")


def shortened(value, whole):
    """A number to four digits, or whole; anything else as it is."""
    try:
        return f"{float(value):.0f}" if whole else f"{float(value):.4g}"
    except ValueError:
        return value


def values_text(row):
    """The default, and what other qualities change."""
    values = {quality: shortened(value, row.get("integer")) for quality, value in row["values"].items()}
    others = [f"{quality} {value}" for quality, value in values.items() if value != values["preview"]]
    return f"`{values['preview']}`" + (f" ({', '.join(others)})" if others else "")


def settings_page(listed):
    modes = [mode["name"] for mode in listed["modes"]]
    page = ("# Settings\n\n`--set NAME=VALUE` changes one; `tyndall modes MODE` lists those a mode reads. The default is that of "
            "`--quality preview`;\nvalues at other qualities are in parentheses. Most users leave those marked *advanced* alone.\n")
    groups = {}
    for row in listed["settings"]:
        groups.setdefault(row["name"].split(".")[0], []).append(row)
    for prefix, rows in groups.items():
        page += f"\n## {GROUPS.get(prefix) or '`' + prefix.replace('_', '-') + '`'}\n\n"
        texts = [readers_text(row, modes) for row in rows]
        alike = len(set(texts)) == 1
        if alike:
            page += f"Read by {texts[0]}.\n\n"
        head = ["setting", "default", "range", "what it does"] + ([] if alike else ["read by"])
        page += table(head, [[f"`{row['name']}`" + (" *advanced*" if row["advanced"] else ""), values_text(row), range_text(row),
                              row["doc"]] + ([] if alike else [text]) for row, text in zip(rows, texts)])
    return page


def modes_page(listed):
    page = ("# Modes\n\nThe table of techniques, as `tyndall modes` prints it; `tyndall modes NAME` shows one with the settings "
            "it reads.\n[Techniques](../techniques.md) compares them.\n\n")
    return page + table(["`--mode`", "how it works", "promises", "use it for"],
                        [[f"`{mode['name']}`", mode["summary"], mode["promise"], mode["use"]] for mode in listed["modes"]])


def readme_table(listed):
    return table(["`--mode`", "how it works", "promises"],
                 [[f"`{mode['name']}`", mode["summary"], mode["promise"]] for mode in listed["modes"]])


# --- exit codes --------------------------------------------------------------------------------------------------------

def exit_codes_page(help_text):
    lines = help_text[help_text.index("Exit codes:"):].splitlines()[1:]
    rows = []
    for line in lines:
        row = re.match(r"  (\d+(?:\+n)?) +(\S.*)", line)
        if row:
            rows.append([row[1], row[2]])
        elif line.strip() and rows:
            rows[-1][1] += " " + line.strip()
    page = ("# Exit codes\n\nErrors are one line on stderr that names the file and the field. `tyndall --help` prints the same table.\n\n")
    return page + table(["code", "meaning"], rows)


# --- JSON files --------------------------------------------------------------------------------------------------------

def resolved(schema, root):
    """The schema with what it refers to merged in; its own members win."""
    if "$ref" not in schema:
        return schema
    target = root
    for step in schema["$ref"].lstrip("#/").split("/"):
        target = target[step]
    return {**resolved(target, root), **{key: value for key, value in schema.items() if key != "$ref"}}


def bounds_text(schema):
    low = schema.get("minimum", schema.get("exclusiveMinimum"))
    high = schema.get("maximum")
    above = "above " if "exclusiveMinimum" in schema else ""
    if low is None and high is None:
        return ""
    if high is None or high >= 1e5:  # larger ones only keep numbers finite
        return f", {above}{number(low)}" + ("" if above else " or more") if low is not None and low > -1e5 else ""
    return f", {above}{number(low)}{',' if above else ''} to {number(high)}"


def type_text(schema, root):
    """What a value may be, in a few words."""
    schema = resolved(schema, root)
    if "const" in schema:
        return f"`{json.dumps(schema['const'])}`"
    if "enum" in schema:
        return ", ".join(f"`{json.dumps(value)}`" for value in schema["enum"])
    for union in ("oneOf", "anyOf"):
        if union in schema:
            texts = []
            for branch in schema[union]:
                branch = resolved(branch, root)
                keyed = "keys" in branch.get("properties", {})
                text = "keys" if keyed else type_text(branch, root)
                if text not in texts:
                    texts.append(text)
            return " or ".join(texts)
    kind = schema.get("type", "any")
    if kind == "array":
        if isinstance(schema["items"], list):
            return "[" + ", ".join(type_text(item, root) for item in schema["items"]) + "]"
        items = type_text(schema["items"], root)
        count = schema.get("minItems")
        return f"[{count} × {items}]" if count and count == schema.get("maxItems") else f"list of {items}"
    if kind in ("number", "integer"):
        return ("whole number" if kind == "integer" else "number") + bounds_text(schema)
    return {"boolean": "`true`, `false`", "string": "text"}.get(kind, kind)


def keys_of(schema, root, prefix=""):
    """Rows of an object's keys; plain objects inside it are listed with a path, shared ones have a table of their own."""
    required = schema.get("required", [])
    for key, member in schema.get("properties", {}).items():
        if key == "$schema":
            continue
        shape = resolved(member, root)
        inner = shape.get("properties")
        section = section_of(member)
        kind = f"[{section}](#{section})" if section else "object" if inner else type_text(member, root)
        description = shape.get("description", "") + (" (required)" if key in required else "")
        yield [f"`{prefix}{key}`", kind, description]
        if inner and not section:
            yield from keys_of(shape, root, f"{prefix}{key}.")


def section_of(member):
    """The name of the table that a member's own objects have, also through a list or a union."""
    places = [member, member.get("items", {}), *member.get("oneOf", [])]
    names = [place["$ref"].split("/")[-1] for place in places if "$ref" in place]
    return next((name for name in names if name in SECTIONS), None)


SECTIONS = {"camera": "Camera", "object": "Object", "light": "Light", "medium": "Medium", "phase": "Phase", "background": "Background", "billboard": "Billboard",
            "property": "Property", "density": "Density"}


def animation_text(root):
    keyed = [branch for branch in root["definitions"]["number"]["oneOf"] if "properties" in branch][0]
    return table(["key", "value", "meaning"], list(keys_of(keyed, root)))


def scene_page(root):
    page = f"# Scene keys\n\n{root['description']}\n[Scenes](../scenes.md) explains them with an example.\n\n"
    page += table(["key", "value", "meaning"], list(keys_of(root, root)))
    for name, title in SECTIONS.items():
        schema = root["definitions"][name]
        page += f"\n## {title}\n\n{schema.get('description', '')}\n".replace("\n\n\n", "\n")
        branches = [resolved(branch, root) for branch in schema.get("oneOf", [])]
        if not branches or "properties" in schema:
            page += "\n" + table(["key", "value", "meaning"], list(keys_of(schema, root)))
            continue
        kinds = [branch["properties"]["type"]["const"] for branch in branches]
        rows = {}  # a key with the same meaning in several kinds is listed once
        for kind, branch in zip(kinds, branches):
            for row in keys_of(branch, root):
                if row[0] != "`type`":
                    rows.setdefault(tuple(row), []).append(kind)
        page += "\n" + table(["`type`", "meaning"], [[f"`{json.dumps(kind)}`", branch.get("description", "")]
                                                   for kind, branch in zip(kinds, branches)])
        page += "\n" + table(["key", "value", "meaning", "of type"],
                            [[*row, "all" if len(of) == len(kinds) else ", ".join(of)] for row, of in sorted(
                                rows.items(), key=lambda item: -len(item[1]))])
    page += ("\n## Names in other programs\n\nUnknown keys and types are answered with the nearest one here; these names in other "
             "programs are known:\n\n" + table(["other programs", "here"], sorted(
                 [", ".join(f"`{word}`" for word in words), f"`{key}`"] for key, words in root["synonyms"].items())))
    page += "\n## Keys over time\n\nA value that takes keys may be an object instead of a number or a vector:\n\n" + animation_text(root)
    return page


def recipe_page(root):
    page = f"# Recipe keys\n\n{root['description']}\n[Baking fog](../baking.md) explains them with an example.\n\n"
    return page + table(["key", "value", "meaning"], list(keys_of(root, root)))


# --- limitations -------------------------------------------------------------------------------------------------------

LIMITATION = re.compile(r'^inline constexpr LimitationKind \w+\{\s*"(\w+)",((?:\s*"(?:[^"\\]|\\.)*")+)\s*\};', re.M)


def sentence_text(literals):
    """The sentence of adjacent string literals, with letters for its numbers: n is a whole one."""
    text = "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', literals)).replace('\\"', '"')
    letters = iter("xy")
    return re.sub(r"\{n?\}", lambda found: "*n*" if found[0] == "{n}" else f"*{next(letters)}*", text)


def limitations_page():
    rows = []
    for path in sorted((ROOT / "src").rglob("*.h")):
        folder = path.parent.relative_to(ROOT / "src").as_posix()
        mode = re.fullmatch(r"modes/(\w+)", folder)
        for name, literals in LIMITATION.findall(path.read_text()):
            rows.append([f"`{name}`", sentence_text(literals), f"`{mode[1].replace('_', '-')}`" if mode else "several"])
    page = ("# Limitations\n\nWhat a mode may report before it renders, by the id in parentheses at the end of its line and in "
            "`--stats-json`; letters\nstand for numbers. [Techniques](../techniques.md) explains the severities.\n\n")
    return page + table(["id", "what it says", "mode"], sorted(rows, key=lambda row: row[0].strip("`")))


# --- files -------------------------------------------------------------------------------------------------------------

def pages(tyndall):
    listed = json.loads(told(tyndall, "modes", "--json"))
    schema = lambda path: json.loads((ROOT / path).read_text())
    folder = ROOT / "docs/reference"
    readme = ROOT / "README.md"
    parts = re.split(r"(<!-- modes -->\n|<!-- end of modes -->)", readme.read_text())
    parts[2] = readme_table(listed)
    return {folder / "modes.md": modes_page(listed), folder / "settings.md": settings_page(listed),
            folder / "scene.md": scene_page(schema("scenes/scene.schema.json")),
            folder / "recipe.md": recipe_page(schema("volumes/recipe.schema.json")),
            folder / "exit-codes.md": exit_codes_page(told(tyndall, "--help")), folder / "limitations.md": limitations_page(),
            readme: "".join(parts)}


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    stale = []
    for path, text in pages(sys.argv[1]).items():
        if path != ROOT / "README.md":
            text = re.sub(r"\n", f"\n\n<!-- written by {COMMAND} -->\n", text, count=1)
        if path.exists() and path.read_text() == text:
            continue
        stale.append(str(path.relative_to(ROOT)))
        if "--check" not in sys.argv:
            path.parent.mkdir(exist_ok=True)
            path.write_text(text)
    if "--check" in sys.argv and stale:
        sys.exit(f"stale: {', '.join(stale)}. Regenerate with: {COMMAND}")
    print("\n".join(stale) or "nothing changed")


if __name__ == "__main__":
    main()
