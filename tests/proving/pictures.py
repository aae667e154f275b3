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
        if size < lines.nbytes:  # halves of bytes apart, differences of neighbors
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
    bound: float  # that its own error is surely below
    seconds: float = 0  # of processors
    dark: int = 0  # drawings of the seed before this one that nothing lit

    def size(self):
        height, width, _ = self.layers["beauty"].shape
        return width, height

    def error(self):
        """Of the truth itself, as of pictures."""
        return error_of(self.layers, self.variance)


def error_of(layers, variance):
    return max(np.sqrt(variance[layer]) / max(layers[layer].mean(), 1e-30) for layer in LAYERS)


def save_truth(truth, attempt, path):
    np.savez(path, attempt=attempt, bound=truth.bound, seconds=truth.seconds, dark=truth.dark,
             **{layer: truth.layers[layer] for layer in LAYERS},
             **{f"{layer}_variance": truth.variance[layer] for layer in LAYERS})


def load_truth(path):
    """The truth and the attempt it belongs to."""
    with np.load(path) as kept:
        layers, variance = [{layer: kept[layer + end] for layer in LAYERS} for end in ("", "_variance")]
        return Truth(layers, variance, float(kept["bound"]), float(kept["seconds"]), int(kept["dark"])), int(kept["attempt"])


def error_against(truth, layers):
    """`rmse_rel`: the worse of beauty and fog light; what the truth is off by itself is taken out."""
    def of(layer):
        squared = np.mean((layers[layer] - truth.layers[layer]) ** 2) - truth.variance[layer]
        return float(np.sqrt(max(squared, 0)) / max(truth.layers[layer].mean(), 1e-30))
    return max(of(layer) for layer in LAYERS)
