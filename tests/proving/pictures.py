"""Renders with tyndall, reads what came out, and says how far pictures are from each other."""
import dataclasses
import json
import resource
import subprocess
import time

import numpy as np
import OpenImageIO

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


def read_layers(path):
    file = OpenImageIO.ImageInput.open(str(path))  # an ImageBuf would remember an older file of that name
    names = list(file.spec().channelnames)
    pixels = np.asarray(file.read_image(OpenImageIO.FLOAT), np.float64)
    file.close()
    return {layer: pixels[..., [names.index(prefix + c) for c in "RGB"]]
            for layer, prefix in zip(LAYERS, ("", "inscatter."))}


def render(program, scene, output, options, threads=2, timeout=600):
    output.unlink(missing_ok=True)
    stats = output.with_suffix(".stats.json")
    stats.unlink(missing_ok=True)
    command = [program, "render", scene, "-o", output, "--float", "-q", "--threads", threads, "--stats-json", stats, *options]
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    try:
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=timeout)
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
                     THREADS, max(self.left, 1))
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
