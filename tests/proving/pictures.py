"""Renders with tyndall, reads what came out, and says how far pictures are from each other."""
import dataclasses
import json
import math
import resource
import struct
import subprocess
import time
import zlib

import numpy as np

LAYERS = ("beauty", "inscatter")


@dataclasses.dataclass
class Run:
    """A picture and what the run said and took. `layers` are arrays of height x width x 3; None where there is none."""
    layers: dict
    exit_code: int
    said: str
    stats: dict
    wall: float  # seconds of the whole process
    processor: float  # seconds


def read_channels(path):
    """The channels of a scan-line OpenEXR file of one part, stored as floats in ZIP blocks of 16 lines; `tyndall render
    --float` writes such."""
    data, at, header = path.read_bytes(), 8, {}
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)
        at += len(name) + len(kind) + 6
        size = struct.unpack_from("<I", data, at - 4)[0]
        header[name], at = data[at:at + size], at + size
    low_x, low_y, high_x, high_y = struct.unpack("<4i", header[b"dataWindow"])
    assert header[b"compression"] == b"\3", "ZIP"
    names, place = [], 0
    while header[b"channels"][place]:
        end = header[b"channels"].index(b"\0", place)
        names.append(header[b"channels"][place:end].decode())
        place = end + 17  # the type and three more numbers
    width, height = high_x - low_x + 1, high_y - low_y + 1
    pixels = np.empty((height, len(names), width), np.float32)
    for offset in struct.unpack_from(f"<{-(-height // 16)}Q", data, at + 1):
        line, size = struct.unpack_from("<iI", data, offset)
        lines = pixels[line - low_y:line - low_y + 16]
        block = np.frombuffer(data, np.uint8, size, offset + 8)
        if size < lines.nbytes:  # halves of bytes apart, differences of neighbours
            block = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
            block[1:] -= 128
            block = np.cumsum(block).astype(np.uint8)
            half = (len(block) + 1) // 2
            mixed = np.empty_like(block)
            mixed[0::2], mixed[1::2] = block[:half], block[half:]
            block = mixed
        lines[:] = np.frombuffer(block.tobytes(), "<f4").reshape(lines.shape)
    return {name: pixels[:, i] for i, name in enumerate(names)}


def read_layers(path):
    channels = read_channels(path)
    return {layer: np.stack([channels[prefix + c] for c in "RGB"], -1).astype(np.float64)
            for layer, prefix in zip(LAYERS, ("", "inscatter."))}


def render(program, scene, output, options, threads=2, timeout=600, processor=None):
    """Ends without a picture after `timeout` seconds, or after so many of processor time."""
    output.unlink(missing_ok=True)
    stats = output.with_suffix(".stats.json")
    stats.unlink(missing_ok=True)
    command = [program, "render", scene, "-o", output, "--float", "-q", "--threads", threads, "--stats-json", stats, *options]
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    try:
        limit = processor and (lambda: resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(processor),) * 2))
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=timeout, preexec_fn=limit)
        code, said = done.returncode, done.stderr.strip()
    except subprocess.TimeoutExpired:
        code, said = -1, f"took more than {timeout} s"
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return Run(read_layers(output) if output.exists() and code >= 0 else None, code, said,
               json.loads(stats.read_text()) if stats.exists() else {}, time.monotonic() - start,
               after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


@dataclasses.dataclass
class Truth:
    """Means of independent pictures, and the variance of those means."""
    layers: dict
    variance: dict  # of a layer's mean, averaged over pixels and channels
    seconds: float = 0  # of processors

    def error(self):
        """Of the truth itself, as of pictures."""
        return max(np.sqrt(self.variance[layer]) / max(self.layers[layer].mean(), 1e-30) for layer in LAYERS)


def save_truth(truth, attempt, path):
    np.savez(path, attempt=attempt, seconds=truth.seconds, **{layer: truth.layers[layer] for layer in LAYERS},
             **{f"{layer}_variance": truth.variance[layer] for layer in LAYERS})


def load_truth(path):
    """The truth and the attempt it belongs to."""
    with np.load(path) as kept:
        return Truth({layer: kept[layer] for layer in LAYERS},
                     {layer: float(kept[f"{layer}_variance"]) for layer in LAYERS}, float(kept["seconds"])), int(kept["attempt"])


def mean_of(pictures):
    layers = {layer: np.mean([picture[layer] for picture in pictures], 0) for layer in LAYERS}
    count = len(pictures)
    variance = {layer: float(np.mean(np.var([picture[layer] for picture in pictures], 0, ddof=1)) / count)
                for layer in LAYERS}
    return Truth(layers, variance)


def error_against(truth, layers):
    """`rmse_rel`: the worse of beauty and fog light; what the truth is off by itself is taken out."""
    def of(layer):
        squared = np.mean((layers[layer] - truth.layers[layer]) ** 2) - truth.variance[layer]
        return float(np.sqrt(max(squared, 0)) / max(truth.layers[layer].mean(), 1e-30))
    return max(of(layer) for layer in LAYERS)


RUNS = 4  # independent pictures of a truth
EXACT = ["--mode", "march", "--quality", "reference"]
QUICK = EXACT + [word for row in (
    "march.visibility=intervals", "march.step_depth=0.25", "march.step_voxels=8", "march.step_share=0.036",
    "march.near_light=0.5", "march.min_transmittance=0.001", "march.nodes=4", "terms.light=grid",
    "terms.light_resolution=65") for word in ("--set", row)]  # departing from the quality in all that --target-error would set
SAME_RAYS = ["--set", "pixel.edge_samples=1", "--set", "pixel.lamp_samples=1"]
THREADS, FEWEST_SAMPLES = 2, 8


class TooLong(Exception):
    pass


class Truths:
    """Renders what a truth is made of, within so much processor time."""

    def __init__(self, program, scene, frame, folder, seconds):
        self.program, self.scene, self.frame, self.folder = program, scene, frame, folder
        self.left, self.seed = seconds, 7000

    def picture(self, options, seed):
        run = render(self.program, self.scene, self.folder / "truth.exr", [*options, "--frames", self.frame, "--seed", seed],
                     THREADS, max(10 * self.left, 60), max(self.left, 1))
        self.left -= run.processor
        if self.left < 0 or run.layers is None:
            raise TooLong(run.said)
        return run

    def several(self, make, expected):
        """RUNS of them, each with a seed of its own; their mean and the processor time of one."""
        before, made = self.left, []
        while len(made) < RUNS:
            if (RUNS - len(made)) * expected > self.left:
                raise TooLong("many samples")
            self.seed += 1
            made.append(make(self.seed))
            expected = (before - self.left) / len(made)
        return mean_of(made), (before - self.left) / RUNS

    def quick(self, error, expected=0):
        """Samples go where noise is, as many as bring it about to an error."""
        def picture(seed):
            run = self.picture([*QUICK, "--target-error", error], seed)
            if run.stats["frames"][0]["samples"] >= FEWEST_SAMPLES:
                return run.layers
            return self.picture([*QUICK, "--samples", FEWEST_SAMPLES], seed).layers  # more than centres of pixels
        return self.several(picture, expected)

    def correction(self, samples, expected=0):
        """Exact less quick pictures, through the same rays."""
        def difference(seed):
            exact, quick = (self.picture([*options, *SAME_RAYS, "--samples", samples], seed).layers
                            for options in (EXACT, QUICK))
            return {layer: exact[layer] - quick[layer] for layer in LAYERS}
        return self.several(difference, expected)


def find_truth(program, scene, frame, folder, wanted, seconds):
    """The mean of endless exact samples with an error of at most `wanted`, or None where that takes more processor time:
    quick pictures, corrected by how far they are from exact ones through the same few rays (Giles 2008, two levels). The
    level that is less well known is made anew, with more samples. What is known of the error comes from differences
    between independent pictures alone."""
    made = Truths(program, scene, frame, folder, seconds)
    try:
        error, samples = 2 * wanted, 2
        (quick, quick_time), (correction, correction_time) = made.quick(error), made.correction(samples)
        while True:
            truth = Truth({layer: quick.layers[layer] + correction.layers[layer] for layer in LAYERS},
                          {layer: quick.variance[layer] + correction.variance[layer] for layer in LAYERS},
                          seconds - made.left)
            if min(truth.layers[layer].mean() for layer in LAYERS) <= 0:
                return None
            if truth.error() <= wanted:
                return truth
            worst = max(LAYERS, key=lambda layer: truth.variance[layer] / truth.layers[layer].mean() ** 2)
            if quick.variance[worst] > correction.variance[worst]:
                step = min(0.6, 0.8 * wanted / truth.error())
                error *= step
                quick, quick_time = made.quick(error, quick_time / step)
            else:
                step = 2 if truth.error() < 2.5 * wanted else 4
                samples *= step
                correction, correction_time = made.correction(samples, step * correction_time)
    except TooLong:
        return None
