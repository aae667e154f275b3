"""Says whether two builds of tyndall make the same pictures, bit for bit: the example scenes in every mode, at every
quality, for every instruction set that this processor has.

    same_pictures.py OLD NEW [--size 160x90] [--modes M,M] [--qualities Q,Q] [--isas I,I] [--scenes FILE,FILE] [--stress]

Pixels are compared as they are stored: headers tell version and time. `path` takes 4 samples. With --stress the cases of
`tyndall stress` are compared too, at the middle of their sweeps, by the error that each build measures there. Ends with 1
when some picture differs, each on a line."""
import argparse
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).parents[2]
SCENES = ["window", "spotlight", "pillars", "lantern", "cloud", "forest_morning", "concert", "cumulus_sky"]
MODES = ["march", "froxel", "path", "billboard", "radial-blur", "cone", "shadow-volume", "shadow-map"]
PATH_SAMPLES = 4
SHOWN_ERROR = 300  # characters of an error message


def instruction_sets():
    return ["avx2", "avx512"] if "avx512f" in pathlib.Path("/proc/cpuinfo").read_text() else ["avx2"]


def stored_pixels(path):
    """The bytes of an OpenEXR file behind its header and its table of offsets (scan lines, one part)."""
    data, at = path.read_bytes(), 8
    while data[at]:
        at = data.index(0, data.index(0, at) + 1) + 1  # name, type
        at += 4 + struct.unpack_from("<I", data, at)[0]
    return data[struct.unpack_from("<Q", data, at + 1)[0]:]


def render(program, scene, mode, quality, isa, size, output):
    """What went wrong, or nothing."""
    command = [program, "render", scene, "-o", output, "--frames", "1", "--mode", mode, "--quality", quality, "--isa", isa,
               "--res", size, "--float", "--quiet"]
    command += ["--samples", str(PATH_SAMPLES)] if mode == "path" else []
    result = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    return f"exit {result.returncode}: {result.stderr.strip()[:SHOWN_ERROR]}" if result.returncode else ""


def difference(old, new, scene, mode, quality, isa, size, directory):
    """How the two pictures differ, or nothing; builds that refuse a scene alike agree."""
    pictures = [directory / "old.exr", directory / "new.exr"]
    said = [render(program, scene, mode, quality, isa, size, picture) for program, picture in zip([old, new], pictures)]
    if any(said):
        return "" if said[0] == said[1] else f"old: {said[0] or 'a picture'}, new: {said[1] or 'a picture'}"
    if stored_pixels(pictures[0]) == stored_pixels(pictures[1]):
        return ""
    told = subprocess.run([str(new), "compare", "--json", *map(str, pictures)], capture_output=True, text=True).stdout
    return f"other pixels, E = {json.loads(told)['metrics']['E']:.3g}"


def middle_errors(program, directory):
    """The error of each case and mode at the middle of its sweep."""
    subprocess.run([program, "stress", "-o", directory, "--quiet"], capture_output=True)  # ends with 1 where a mode fails
    cases = json.loads((directory / "stress.json").read_text())["cases"]
    return {(case["case"], result["mode"]): result["points"][len(result["points"]) // 2]["error"]
            for case in cases for result in case["results"] if result["points"]}


def same_stress(old, new, directory):
    """Counts of the cases that both builds have: with the same error, with another."""
    errors = [middle_errors(program, directory / name) for program, name in [(old, "old"), (new, "new")]]
    both = sorted(errors[0].keys() & errors[1].keys())
    other = [key for key in both if errors[0][key] != errors[1][key]]
    for case, mode in other:
        print(f"stress {case} {mode}: error {errors[0][case, mode]} became {errors[1][case, mode]}", flush=True)
    for key in sorted(errors[0].keys() ^ errors[1].keys()):
        print(f"stress {' '.join(key)}: in one build alone", flush=True)
    return len(both) - len(other), len(other)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("old", type=pathlib.Path)
    parser.add_argument("new", type=pathlib.Path)
    parser.add_argument("--size", default="160x90")
    parser.add_argument("--modes", default=",".join(MODES))
    parser.add_argument("--qualities", default="draft,preview,final")
    parser.add_argument("--isas", default=",".join(instruction_sets()))
    parser.add_argument("--scenes", default=",".join(str(SOURCE / f"scenes/{name}.json") for name in SCENES))
    parser.add_argument("--stress", action="store_true")
    given = parser.parse_args()
    same = other = 0
    with tempfile.TemporaryDirectory() as directory:
        for scene in map(pathlib.Path, given.scenes.split(",")):
            for isa in given.isas.split(","):
                for mode in given.modes.split(","):
                    for quality in given.qualities.split(","):
                        told = difference(given.old, given.new, scene, mode, quality, isa, given.size, pathlib.Path(directory))
                        same, other = same + (not told), other + bool(told)
                        if told:
                            print(f"{scene.stem} {mode} {quality} {isa}: {told}", flush=True)
        if given.stress:
            alike, changed = same_stress(given.old, given.new, pathlib.Path(directory))
            same, other = same + alike, other + changed
    print(f"{same} of {same + other} pictures are the same")
    sys.exit(1 if other else 0)


main()
