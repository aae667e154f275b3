"""Says which share of a build's compile time a touched header costs, from the times and dependencies that Ninja keeps.

    rebuild_cost.py BUILD [HEADER ...]

Without headers: every header of src, dearest first. The times are those of the last time each file was compiled, so
compile everything on a quiet machine before."""
import collections
import pathlib
import subprocess
import sys


def compile_seconds(build):
    """Seconds each object (or precompiled header) took to compile, the last time it was."""
    seconds = {}
    for line in (build / ".ninja_log").read_text().splitlines()[1:]:
        start, end, _, output, _ = line.split("\t")
        if output.endswith((".o", ".gch")):
            seconds[output] = (int(end) - int(start)) / 1000
    return seconds


def headers_of_objects(build):
    """The project's own headers that each object includes."""
    listed = subprocess.run(["ninja", "-C", build, "-t", "deps"], capture_output=True, text=True, check=True).stdout
    cache = (build / "CMakeCache.txt").read_text()
    root = next(line.split("=", 1)[1] for line in cache.splitlines() if line.startswith("CMAKE_HOME_DIRECTORY:")) + "/"
    headers, used = [], {}
    for line in listed.splitlines():
        if line.startswith(" "):
            headers.append(line.strip().removeprefix(root))
        elif ": #deps" in line:
            headers = used.setdefault(line.split(": #deps")[0], [])
    return used


def main():
    build, asked = pathlib.Path(sys.argv[1]), sys.argv[2:]
    seconds, used = compile_seconds(build), headers_of_objects(build)
    live = {name: time for name, time in seconds.items() if name in used}
    total, cost = sum(live.values()), collections.Counter()
    for name, time in live.items():
        cost.update({header: time for header in set(used[name])})
    shown = asked or [name for name, _ in cost.max_common() if name.startswith("src/") and name.endswith(".h")]
    print(f"{len(live)} objects, {total:.0f} s of compiling")
    for header in shown:
        print(f"{100 * cost[header] / total:5.1f} %  {cost[header]:6.0f} s  {header}")


main()
