"""Fails when an identifier of tests/words.txt is in code or docs again, or when two limitations have one id."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
words = {}
for line in (root / "tests/words.txt").read_text().splitlines():
    if line and not line.startswith("#"):
        word, better = line.split(maxsplit=1)
        words[word] = better
pattern = re.compile(r"\b(" + "|".join(word.replace("*", r"\w*") for word in words) + r")\b")


def better_than(found):
    return next(words[word] for word in words if re.fullmatch(word.replace("*", r"\w*"), found))


problems, ids = [], {}
files = [path for folder in ("src", "apps", "tests", "docs") for path in (root / folder).rglob("*")
         if path.suffix in (".h", ".cpp", ".py", ".md")]
for path in sorted([*files, root / "README.md"]):
    relative, text = path.relative_to(root).as_posix(), path.read_text()
    for number, line in enumerate(text.splitlines(), 1):
        for found in pattern.findall(line):
            if path.suffix == ".md" and found.islower() and "_" not in found:
                continue  # an ordinary word in a sentence
            problems.append(f"{relative}:{number}: {found}; the field says {better_than(found)}")
    for kind in re.findall(r'LimitationKind \w+\{\s*"(\w+)"', text):
        if kind in ids:
            problems.append(f"{relative}: limitation {kind} is in {ids[kind]} already")
        ids[kind] = relative
if not ids:
    problems.append("no limitation was found: has LimitationKind another form now?")
if problems:
    sys.exit("\n".join(problems))
print(f"words: ok; {len(ids)} limitations, each with an id of its own")
