"""Truths of a scene that is known: whether their errors are what they say, and windows what they have to be."""
import unittest
from unittest import mock

import numpy as np

import truths
from pictures import LAYERS
from windows import divide, inside

SIZE = (48, 32)
WANTED = 0.004
PRICES = {"beams": 0.5, "bare": 1, "coarse": 2, "fine": 4, "grid": 20, "exact": 50}


class Known:
    """In place of the program: pixels of known means, of which a few spread a hundred times as much as the others. Recipes
    are off by something, and by more noise, that the same seed makes the same."""

    def __init__(self, seed):
        self.seed = seed
        y, x = np.mgrid[:SIZE[1], :SIZE[0]]
        self.surface = 1 + 0.5 * np.sin(x / 5)[..., None] * np.ones(3)
        self.fog = 0.3 + 0.1 * np.cos(y / 7)[..., None] * np.ones(3)
        self.noise = np.where((abs(x - 11) < 3) & (abs(y - 20) < 2), 20, 0.2)[..., None]

    def picture(self, renderer, recipe, samples, seed, more):
        width, height = SIZE
        if "--res" in more:
            width, height = map(int, more[more.index("--res") + 1].split("x"))
        x0, y0, x1, y1 = map(int, more[more.index("--crop") + 1].split(",")) if "--crop" in more else (0, 0, width, height)
        place = np.s_[y0:y1, x0:x1]
        random = np.random.default_rng([self.seed, seed])
        noise = random.standard_normal((2, y1 - y0, x1 - x0, 3)) / np.sqrt(samples)
        off = {"beams": 0.3, "bare": 0.3, "coarse": 0.05, "fine": 0.01, "grid": 1e-4, "exact": 0}[recipe]
        took = 1e-3 + 1e-7 * samples * (x1 - x0) * (y1 - y0) * PRICES[recipe]
        renderer.left -= took
        if renderer.left < 0:
            raise truths.TooLong()
        return {"surface": self.surface[place] + self.noise[place] * noise[0] + (0.01 if recipe in truths.FOR_SURFACES else off),
                "fog": self.fog[place] + off + (0.1 + off) * noise[1]}, took

    def find(self, seconds=1e3):
        with mock.patch.object(truths.Renderer, "picture", lambda *given: self.picture(*given)):
            return truths.find_truth("", "", SIZE, 1, None, [WANTED, 4 * WANTED], seconds)

    def layers(self):
        return dict(zip(LAYERS, (self.surface + self.fog, self.fog)))


class Truths(unittest.TestCase):
    def test_errors_are_what_they_say(self):
        said, is_so, bias = {layer: [] for layer in LAYERS}, {layer: [] for layer in LAYERS}, []
        for seed in range(10):
            known = Known(seed)
            truth = known.find()
            self.assertLessEqual(truth.error(), truth.bound)
            self.assertLessEqual(truth.bound, WANTED)
            for layer in LAYERS:
                off = truth.layers[layer] - known.layers()[layer]
                said[layer].append(truth.variance[layer])
                is_so[layer].append(np.mean(off ** 2))
            bias.append(off.mean() / np.sqrt(truth.variance[layer] / off.size))
        for layer in LAYERS:
            self.assertAlmostEqual(np.mean(is_so[layer]) / np.mean(said[layer]), 1, delta=0.25, msg=layer)
        self.assertLess(abs(np.mean(bias)), 4 * np.std(bias) / np.sqrt(len(bias)))

    def test_few_pixels_leave_more_doubt(self):
        random = np.random.default_rng(1)
        for pixels in (1, 4, 100):
            pictures = random.standard_normal((truths.RUNS, 4000, pixels))
            seen = np.var(pictures, 0, ddof=1)
            exceeded = np.mean([row.sum() * truths.doubt(row) < pixels for row in seen])
            self.assertLess(exceeded, 0.07, pixels)
            self.assertGreater(exceeded, 0.01, pixels)

    def test_takes_no_more_time_than_there_is(self):
        whole = Known(1).find().seconds
        self.assertGreater(Known(1).find(0.5 * whole).bound, WANTED)
        self.assertLessEqual(Known(1).find(0.5 * whole).seconds, 0.5 * whole)
        self.assertIsNone(Known(1).find(0.01 * whole))

    def test_windows(self):
        known = Known(0)
        spread = known.noise[..., 0] ** 2
        windows = divide(spread, 1e-3)
        covered = np.zeros(spread.shape, int)
        for window in windows:
            covered[inside(window)] += 1
        self.assertTrue((covered == 1).all())
        hot = [window for window in windows if spread[inside(window)].max() > 1]
        self.assertLess(sum(spread[inside(window)].size for window in hot), 0.1 * spread.size)
        self.assertEqual(divide(spread, 1), [(0, 0, *SIZE)])  # where a window costs as much as all samples


if __name__ == "__main__":
    unittest.main()
