"""What groups of samples cost: the error of one run of a plan beside plain render at equal samples, on the scenes that ship.

    groups.py [--scenes window,spotlight,pillars,lantern,cloud] [--groups 1,2,8] [--samples 64] [--program build/release/tyndall]
              [-o DIR]

The ratio of variances, and that of work: how many times as many samples the plan needs for the same error, told from how its
variance falls when samples double. Ends with 1 where two groups need more than 1.3 times the work."""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from pictures import LAYERS, Truth, error_against, read_layers, render

SOURCE = pathlib.Path(__file__).parents[2]
SIZE = ("--res", "96x54", "--frames", "1", "--mode", "march")
BAR = 1.3
SAME = 2  # groups that a plan of samples has


def truth_of(program, scene, folder, samples, pictures=4):
    """Independent pictures with many more samples each."""
    layers = [render(program, scene, folder / "truth.exr", [*SIZE, "--samples", samples, "--seed", 900 + i]).layers
              for i in range(pictures)]
    return Truth({layer: np.mean([some[layer] for some in layers], 0) for layer in LAYERS},
                 {layer: np.mean(np.var([some[layer] for some in layers], 0, ddof=1)) / pictures for layer in LAYERS}, 0)


def planned(program, scene, folder, samples, groups, seed):
    run = lambda *words: subprocess.run([str(word) for word in (program, *words, "-q")], check=True, capture_output=True)
    plan, output = folder / "plan.json", folder / "one.exr"
    run("plan", scene, *SIZE, "--samples", samples, "--groups", groups, "--seed", seed, "--float", "--save", plan)
    run("render", "--plan", plan, "-o", output)
    return read_layers(output)


def mean_square(truth, pictures):
    return float(np.mean([error_against(truth, layers) ** 2 for layers in pictures]))


def costs(name, options, folder):
    scene, samples, seeds = SOURCE / f"scenes/{name}.json", options.samples, range(options.seeds)
    truth = truth_of(options.program, scene, folder, 16 * samples)
    plain = mean_square(truth, [render(options.program, scene, folder / "plain.exr",
                                       [*SIZE, "--samples", samples, "--seed", seed]).layers for seed in seeds])
    row = {"scene": name, "samples": samples, "plain": plain ** 0.5, "truth": truth.error(), "groups": {}}
    for groups in options.groups:
        own, doubled = [mean_square(truth, [planned(options.program, scene, folder, n, groups, seed) for seed in seeds])
                        for n in (samples, 2 * samples)]
        falls = np.log2(own / max(doubled, 1e-30))  # variance as samples to the power of -falls
        row["groups"][groups] = {"variance": own / plain, "falls": falls, "work": (own / plain) ** (1 / max(falls, 1))}
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=lambda text: text.split(","), default="window,spotlight,pillars,lantern,cloud".split(","))
    parser.add_argument("--groups", type=lambda text: [int(n) for n in text.split(",")], default=[1, SAME, 8])
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=3, help="pictures of each")
    parser.add_argument("--program", default=SOURCE / "build/release/tyndall")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("proving"))
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    rows = []
    for name in options.scenes:
        with tempfile.TemporaryDirectory(prefix="proving_groups_") as folder:
            rows.append(row := costs(name, options, pathlib.Path(folder)))
        print(f"{name:10s} plain {row['plain']:.5f} (truth {row['truth']:.5f})" + "".join(
            f" | {groups}: variance x{of['variance']:.2f}, falls as n^-{of['falls']:.2f}, work x{of['work']:.2f}"
            for groups, of in row["groups"].items()), flush=True)
        (options.output / "groups.json").write_text(json.dumps(rows, indent=1))
    sys.exit(1 if any(row["groups"].get(SAME, {"work": 0})["work"] > BAR for row in rows) else 0)


if __name__ == "__main__":
    main()
