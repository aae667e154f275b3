"""What goes wrong with parts on their way to merge: every fault has to be refused, and to harm nothing.

    faults.py [--seed 1] [--count 200] [--program build/release/tyndall] [--only WORD]

Parts that are cut, flipped, missing, doubled, of something else, or crafted by hand, and disks that are full. A fault is
refused as it should when merge ends with the right exit code and one line that names the file, within 20 seconds and 2 GB,
and leaves parts and an older frame as they were, and nothing else. Prints those that are not, and ends with 1."""
import argparse
import dataclasses
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

from crafted import channel_names, header_of, with_header, with_samples

SOURCE = pathlib.Path(__file__).parents[2]
SECONDS, BYTES = 20, 2 << 30
REFUSED, MISSING, NO_SPACE = 3, 4, 5
PARTS = 3
FULL = 20000  # bytes that a full disk still takes; a frame is larger


@dataclasses.dataclass
class Fault:
    """What is merged: contents of files by name where they differ from the parts, names, options, and what is to happen."""
    name: str
    files: dict = dataclasses.field(default_factory=dict)
    parts: list = None
    options: tuple = ()
    codes: tuple = (REFUSED, MISSING)
    words: tuple = ()
    disk: int = None  # bytes that a file may have


def scene_of(**changes):
    box = {"low": [-1, 0, -1], "high": [1, 1, 1]}
    return {"tyndall": 1, "frames": "1-2", "resolution": [64, 36], "camera": {"position": [0, 0.6, 3], "target": [0, 0.4, 0]},
            "lights": [{"name": "sun", "type": "sun", "direction": [-0.6, -0.7, -0.3], "intensity": 10}],
            "media": [{"type": "homogeneous", "extinction": 0.5, "bounds": box}],
            "background": {"color": [0.1, 0.2, 0.3]}} | changes


class Workshop:
    """A folder with a plan and its parts, to make faults of."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.scene("scene.json")
        self.names = self.parts("frame", "scene.json", 1)
        self.good = {name: (folder / name).read_bytes() for name in self.names}
        self.one = self.names[1]  # the one that is damaged

    def run(self, *words):
        subprocess.run([str(word) for word in (self.program, *words, "-q")], check=True, capture_output=True, timeout=60,
                       cwd=self.folder)

    def scene(self, name, **changes):
        (self.folder / name).write_text(json.dumps(scene_of(**changes)))

    def parts(self, name, scene, frame, *options):
        self.run("plan", scene, "--mode", "march", "--samples", 8, "--groups", 4, "--float", "--frames", "1-2", "--save",
                 f"{name}.json", *options)
        for part in range(1, PARTS + 1):
            self.run("render", "--plan", f"{name}.json", "--frames", frame, "-o", f"{name}.exr", "--part", f"{part}/{PARTS}")
        return [f"{name}.part-{part}-of-{PARTS}.exr" for part in range(1, PARTS + 1)]

    def changed(self, **changes):
        """A plan with members changed."""
        plan = json.loads((self.folder / "frame.json").read_text()) | changes
        return json.dumps(plan).encode()


def cuts(shop):
    data = shop.good[shop.one]
    return [Fault(f"cut at {size}", {shop.one: data[:size]}, words=(shop.one,)) for size in range(0, len(data), 4096)]


def flips(shop, chance, count):
    data, result = shop.good[shop.one], []
    end = header_of(data)[1]
    for i in range(count):
        at, bit = chance.randrange(end if i % 2 else len(data)), chance.randrange(8)
        flipped = data[:at] + bytes([data[at] ^ 1 << bit]) + data[at + 1:]
        result.append(Fault(f"bit {bit} of byte {at} flipped", {shop.one: flipped}, words=(shop.one,)))
    return result


def strangers(shop):
    """Parts and plans of something else."""
    shop.scene("other.json", ambient=[1, 1, 1])
    names, one = shop.names, shop.one
    mixed = lambda files: [names[0], files[1], names[2]]
    other = shop.parts("others", "other.json", 1)
    second = shop.parts("second", "scene.json", 2)
    seeded = shop.parts("seeded", "scene.json", 1, "--seed", 5)
    draft = shop.parts("draft", "scene.json", 1, "--quality", "draft")
    files = {name: shop.good[name] for name in names}
    merge_with = lambda name, what, **plan: Fault(name, {"changed.json": shop.changed(**plan)},
                                                  options=("--plan", "changed.json"), words=what)
    shuffled = with_header(shop.good[one], {"tyndall:planHash": "0" * 32})
    return [
        Fault("part of another scene", parts=mixed(other), words=("others",)),
        Fault("part of another frame", parts=mixed(second), codes=(2, REFUSED), words=("second",)),
        Fault("part of another seed", parts=mixed(seeded), words=("seeded",)),
        Fault("part of another quality", parts=mixed(draft), words=("draft",)),
        Fault("part of another plan by its hash", {one: shuffled}, words=(one,)),
        Fault("part of another instruction set", {one: with_header(shop.good[one], {"tyndall:hash": "1" * 32})}, words=(one,)),
        merge_with("plan of another build", ("changed.json",), build="0" * 32),
        merge_with("plan of another version", ("changed.json",), version="9.9.9"),
        merge_with("plan of another instruction set", (), isa="avx512"),
        merge_with("plan of another scene", (), inputs=["0" * 32]),
        merge_with("plan of no groups", ("changed.json",), groups=0),
        merge_with("plan of many groups", ("changed.json",), groups=10 ** 9),
        merge_with("plan of many leaves", ("changed.json",), leaves=10 ** 9),
        Fault("scene changed since", {"scene.json": json.dumps(scene_of(ambient=[1, 1, 1])).encode()}, words=("scene.json",)),
        Fault("scene gone", {"scene.json": None}, codes=(MISSING,), words=("scene.json",)),
        Fault("plan gone", {"frame.json": None}, codes=(MISSING,), words=("frame.json",)),
        Fault("plan cut", {"frame.json": (shop.folder / "frame.json").read_bytes()[:500]}, words=("frame.json",)),
        *(Fault(f"gap: {name}", parts=[n for n in names if n != name], words=("a part is missing",)) for name in names),
        *(Fault(f"doubled: {name}", parts=[*names, name], words=(name,)) for name in names),
        *(Fault(f"copied: {name}", {"copy.exr": files[name]}, parts=[*names, "copy.exr"], words=("has samples that are also in",))
          for name in names),
        Fault("part gone", {one: None}, codes=(MISSING,), words=(one,)),
        Fault("a frame for a part", {one: shop.whole}, words=(one,)),
        Fault("text for a part", {one: b"hello\n" * 1000}, words=(one,)),
        Fault("zeros for a part", {one: bytes(len(files[one]))}, words=(one,)),
        Fault("a tail of rubbish", {one: files[one] + b"x" * 1000}, words=(one,)),
        Fault("a folder for a part", parts=[names[0], ".", names[2]])]


HEADERS = {  # what is written for an attribute
    "tyndall:partRange": ["", "a b c", "0", "-1 4 1", "4 0 1", "0 0 1", "0 4 0", "0 4 -1", "0 1073741824 1", "0 9999999999999 1",
                          "0 99999999999999999999 1", "1073741823 1073741824 1", "0 4 2147483647", "0 1073741824 2147483647",
                          "0 8 99999999999", "2 6 3", "0 3 1"],
    "tyndall:partLeaves": ["", "0", "-2", "3", "64", "128", "1073741824", "1e3", "99999999999999"],
    "tyndall:partLights": ["", "{", "[]", "null", '{"names":[]}', '{"names":1,"of_light":2}', '{"names":["a"],"of_light":[-1]}',
                           '{"names":["a"],"of_light":[1e300]}', '{"names":["a"],"of_light":["x"]}',
                           '{"names":[],"of_light":[0]}', "[" * 5000, '{"names":["a"],"of_light":[0]}'],
    "tyndall:planHash": ["", "x" * 3000],
    "tyndall:hash": ["", "x" * 3000],
    "imageCounter": [struct.pack("<i", 2), struct.pack("<i", -2 ** 31), struct.pack("<i", 2 ** 31 - 1)],
    "dataWindow": [struct.pack("<4i", *numbers) for numbers in (
        (0, 0, 63, 34), (0, 0, 16383, 16383), (0, 0, 2 ** 31 - 1, 2 ** 31 - 1), (-2 ** 31, 0, 63, 35), (5, 5, 4, 4), (0, 0, 62, 35))],
    "displayWindow": [struct.pack("<4i", *numbers) for numbers in ((0, 0, 31, 35), (0, 0, 2 ** 24, 2 ** 24), (9, 9, 0, 0))],
    "compression": [b"\0", b"\2", b"\x07", b"\xff"]}


def channels_of(names):
    return b"".join(name + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in names) + b"\0"


def crafted(shop):
    """Headers and samples that are impossible, in files whose check is right."""
    data, one = shop.good[shop.one], shop.one
    result = [Fault(f"{name} = {value[:40]!r}", {one: with_header(data, {name: value})}) for name, values in HEADERS.items()
              for value in values]
    result += [Fault(f"without {name}", {one: with_header(data, {name: None})})
               for name in HEADERS if name.startswith("tyndall") or name == "imageCounter"]
    names = channel_names(header_of(data)[0]["channels"][1])
    many = [b"s%d_0_0.alpha" % i for i in range(5000)]
    for what, some in (("renamed", [names[0] + b"x", *names[1:]]), ("of another group", [n.replace(b"s1", b"s9") for n in names]),
                       ("twice", [names[0], names[0], *names[2:]]), ("5000 channels", many), ("no channels", []),
                       ("a long name", [b"x" * 300, *names[1:]]), ("an empty name", [b"", *names[1:]])):
        result.append(Fault(f"channels: {what}", {one: with_header(data, {"channels": channels_of(some)})}))
    weights = {n.decode(): 1.0 for n in names}
    taken = next(n.decode() for n in names if n.endswith(b"taken"))
    for value in (-1.0, 0.5, 1e30, float("inf"), float("nan"), 3e7):
        result.append(Fault(f"{taken} = {value}", {one: with_samples(data, weights | {taken: value})}))
    every = lambda end, value: {n.decode(): value for n in names if n.endswith(end)}
    result += [
        Fault("millions of samples dropped", {one: with_samples(data, weights | every(b"taken", 2.0 ** 24) | every(b"kept", 0.0))}),
        Fault("no samples", {one: with_samples(data, weights | every(b"taken", 0.0) | every(b"kept", 0.0))}),
        Fault("more samples than planned", {one: with_samples(data, weights | every(b"taken", 4096.0) | every(b"kept", 4096.0))}),
        Fault("no numbers", {one: with_samples(data, weights | every(b"inscatter.R", float("nan")))})]
    far = "1073741823 1073741824"  # samples that some --more might have: what is missing is what lies before them
    result = [dataclasses.replace(fault, words=("a part is missing",) if far in fault.name else (one,), codes=(2, REFUSED) if "imageCounter" in fault.name else (REFUSED,))
              for fault in result]
    first = shop.names[0]  # whose plan is read
    return result + [Fault(f"tyndall:planFile = {value[:40]!r}", {first: with_header(shop.good[first], {"tyndall:planFile": value})})
                     for value in ("", "nowhere.json", "/", "/dev/null", "/dev/zero", "x" * 5000, "a\0b.json", "scene.json", first)]


def disks(shop):
    """A limit to the size of files stands for a disk that is full."""
    sizes = (0, 1, 100, 1000, 4096, 8192, FULL // 2, FULL)
    return [Fault(f"disk full after {size} bytes", disk=size, codes=(NO_SPACE,), words=("older.exr",)) for size in sizes] + [
        Fault("no folder to write to", options=("-o", "/proc/nowhere/older.exr"), codes=(NO_SPACE,), words=("nowhere",)),
        Fault("a folder where the frame goes", options=("-o", "folder.exr"), codes=(2, NO_SPACE), words=("folder.exr",))]


def contents(folder):
    return {path.name: path.read_bytes() if path.is_file() else None for path in folder.iterdir()}


def merge(shop, fault, folder):
    """Exit code, stderr, seconds and peak bytes."""
    def limits():
        if fault.disk is not None:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (fault.disk,) * 2)
    output = [] if "-o" in fault.options else ["-o", "older.exr"]
    command = [str(shop.program), "merge", *(fault.parts or shop.names), *output, *fault.options, "-q", "--progress", "none"]
    start = time.monotonic()
    done = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, preexec_fn=limits)
    signal.signal(signal.SIGALRM, lambda *_: done.kill())
    signal.alarm(SECONDS)
    said = done.stderr.read().decode(errors="replace")
    _, status, used = os.wait4(done.pid, 0)
    signal.alarm(0)
    done.returncode = os.waitstatus_to_exitcode(status)
    return done.returncode, said, time.monotonic() - start, used.ru_maxrss * 1024


def complaints(shop, fault, folder):
    """What is wrong with how a fault was met: nothing, where it was refused as it should."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(shop.folder, folder)
    for name, data in fault.files.items():
        (folder / name).unlink(missing_ok=True) if data is None else (folder / name).write_bytes(data)
    before = contents(folder)
    code, said, seconds, peak = merge(shop, fault, folder)
    lines, wrong = said.splitlines(), []
    if code not in fault.codes:
        wrong.append(f"exit {code}")
    if len(lines) != 1 or not said.startswith("tyndall: error: ") or len(said.encode()) > 501:
        wrong.append(f"{len(lines)} lines")
    if any(word not in said for word in fault.words):
        wrong.append(f"does not name {fault.words}")
    if seconds >= SECONDS or peak > BYTES:
        wrong.append(f"{seconds:.0f} s, {peak >> 20} MB")
    if contents(folder) != before:
        wrong.append("files changed")
    return wrong + [said.strip()[:200]] if wrong else [], seconds, peak


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200, help="at least: bits are flipped until there are so many")
    parser.add_argument("--program", type=lambda text: pathlib.Path(text).absolute(), default=SOURCE / "build/release/tyndall")
    parser.add_argument("--only", default="", help="faults with this word")
    options = parser.parse_args()
    start, place = time.monotonic(), pathlib.Path(tempfile.mkdtemp(prefix="proving_faults_"))
    try:
        (place / "good").mkdir()
        shop = Workshop(options.program, place / "good")
        shop.run("render", "--plan", "frame.json", "--frames", 1, "-o", "older.exr")
        (place / "good/folder.exr").mkdir()
        shop.whole = (place / "good/older.exr").read_bytes()
        faults = cuts(shop) + strangers(shop) + crafted(shop) + disks(shop)
        faults += flips(shop, random.Random(options.seed), max(options.count - len(faults), 40))
        faults = [fault for fault in faults if options.only in fault.name]
        bad, slowest, largest = [], 0, 0
        for fault in faults:
            wrong, seconds, peak = complaints(shop, fault, place / "tried")
            slowest, largest = max(slowest, seconds), max(largest, peak)
            if wrong:
                bad.append(fault)
                print(f"NOT AS IT SHOULD: {fault.name}: " + "; ".join(wrong), flush=True)
    finally:
        shutil.rmtree(place, ignore_errors=True)
    print(f"{len(faults) - len(bad)} of {len(faults)} faults are refused as they should; slowest {slowest:.1f} s, at most "
          f"{largest >> 20} MB; took {time.monotonic() - start:.0f} s")
    sys.exit(1 if bad or not faults else 0)


if __name__ == "__main__":
    main()
