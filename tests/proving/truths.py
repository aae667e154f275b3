"""Finds truths: means of endless exact samples, each with an error of its own that is told from independent pictures.

Light of surfaces and light in fog are found apart: the first needs many samples through no more fog than dims it, the
second few good ones."""
import itertools

import numpy as np

from pictures import LAYERS, Truth, error_of, render
from windows import allot, area_of, cautious, divide, inside

RUNS = 4  # independent pictures of a truth
THREADS, MOST_SAMPLES = 2, 4096
FEWEST_SAMPLES, FEWEST_DIFFERENCES = 4, 2  # a single one would be the centers of pixels
COARSER = 3  # than the picture, each way: those that recipes are chosen by
STEP = 16   # variances fall by this factor at most at once: far from what is wanted, little is known
HOPE = 4    # forecasts may be as many times too long, where there is nothing else to try
FINER = 8   # times as many moments of motion blur as usual, at most
MOST_MOMENTS = 64
AIM = 0.85  # of the variance wanted
SURE = 1.645  # deviations: variances are below what is counted on in 95 %
PARTS = ("surface", "fog")
SAME_RAYS = ("--set", "pixel.edge_samples=1", "--set", "pixel.lamp_samples=1")
BEAMS, BARE, EXACT = "beams", "bare", "exact"
COARSE = ("march.step_depth=0.25", "march.step_voxels=8", "march.step_share=0.036", "march.min_transmittance=0.001",
          "terms.light=grid", "terms.light_resolution=65")
RECIPES = {  # from quick to exact; what each departs from the reference in
    BEAMS: ("terms.light=grid", "terms.light_resolution=65"),
    BARE: (*COARSE, "march.visibility=intervals", "march.near_light=10", "march.nodes=1"),
    "coarse": (*COARSE, "march.visibility=intervals", "march.near_light=0.5", "march.nodes=4"),
    "fine": ("march.visibility=intervals", "march.step_depth=0.1", "march.step_voxels=2", "march.step_share=0.0104",
             "march.near_light=0.25", "march.min_transmittance=0.0001", "march.nodes=6", "terms.light=grid",
             "terms.light_resolution=129"),
    "grid": ("terms.light=grid",),
    EXACT: ("march.light_marches=32",)}  # unbiased, as at all nodes, in a fraction of the time where there are many
MODES = {BEAMS: "billboard"}  # others march
FOR_SURFACES = (BEAMS, BARE)  # whose light in fog is of no use


class TooLong(Exception):
    pass


class Dark(Exception):
    """No light in the fog, or none at all: nothing that an error could be relative to."""


def doubt(variances):
    """How many times the sum of variances of pixels, each from RUNS pictures, may exceed what it seems: much where one pixel
    holds all of it. Chi-squared with as many degrees of freedom as Satterthwaite 1946 says, after Wilson and Hilferty 1931."""
    freedom = (RUNS - 1) * variances.sum() ** 2 / max((variances ** 2).sum(), 1e-300)
    share = 2 / (9 * freedom)
    return 1 / (1 - share - SURE * np.sqrt(share)) ** 3


def parts_of(layers):
    return {"surface": layers["beauty"] - layers["inscatter"], "fog": layers["inscatter"]}


class Renderer:
    """Pictures of a scene by recipe, within so much processor time."""

    def __init__(self, program, scene, frame, folder, seconds):
        self.program, self.scene, self.frame, self.folder = program, scene, frame, folder
        self.left, self.seed = seconds, 7000
        self.moments = None  # options: as many as motion blur is to be made of

    def finer_moments(self):
        usual = self.made(EXACT, ["--samples", 1, "--crop", "0,0,4,4"]).stats["frames"][0].get("time_samples", 1)
        return ["--time-samples", max(min(FINER * usual, MOST_MOMENTS), 2 * usual)] if usual > 1 else []

    def made(self, recipe, options):
        run = render(self.program, self.scene, self.folder / "truth.exr",
                     ["--mode", MODES.get(recipe, "march"), "--frames", self.frame, *options],
                     THREADS, max(10 * self.left, 60), max(self.left, 1))
        self.left -= run.processor
        if self.left < 0 or run.layers is None:
            raise TooLong(run.said)
        return run

    def picture(self, recipe, samples, seed, more):
        """Its parts, and the processor time it took."""
        if self.moments is None:
            self.moments = self.finer_moments()
        options = ["--quality", "reference", "--samples", samples, "--seed", seed, *self.moments]
        run = self.made(recipe, [*options, *(word for row in RECIPES[recipe] for word in ("--set", row)), *more])
        return parts_of(run.layers), run.processor


class Level:
    """What parts are by some recipes less what they are by others, through the same rays: RUNS pictures of it that know
    nothing of each other. `plus` and `minus` name a part's recipe."""

    def __init__(self, renderer, size, plus, minus, start_seconds):
        self.renderer, self.plus, self.minus = renderer, plus, minus
        self.recipes = sorted({*plus.values(), *minus.values()})
        self.least = FEWEST_DIFFERENCES if minus else FEWEST_SAMPLES
        self.start_seconds = sum(start_seconds[recipe] for recipe in self.recipes)  # for a window of no samples
        self.price = np.ones(size[::-1])  # seconds of a sample of each pixel
        self.take([((0, 0, *size), self.least)])

    def window(self, samples, window):
        self.renderer.seed += 1
        more = ["--crop", ",".join(map(str, window)), *(SAME_RAYS if self.minus else [])]
        made = {recipe: self.renderer.picture(recipe, samples, self.renderer.seed, more)[0] for recipe in self.recipes}
        return {part: made[recipe][part] - (made[self.minus[part]][part] if part in self.minus else 0)
                for part, recipe in self.plus.items()}

    def take(self, plan):
        """From nothing: what told a plan must not bias what counts."""
        self.runs = [{part: np.zeros((*self.price.shape, 3)) for part in PARTS} for _ in range(RUNS)]
        self.samples, self.plan = np.zeros(self.price.shape), plan
        self.add(plan)

    def add(self, plan):
        """More samples, in windows that were told beforehand."""
        for window, samples in plan:
            place, before = inside(window), self.renderer.left
            counts = [max(min(MOST_SAMPLES, samples - done), 2) for done in range(0, samples, MOST_SAMPLES)]
            for count in counts:
                self.samples[place] += count
                share = count / self.samples[place][..., None]
                for run in self.runs:
                    for part, made in self.window(count, window).items():
                        run[part][place] += share * (made - run[part][place])
            seconds = (before - self.renderer.left) / RUNS
            self.price[place] = max(seconds - len(counts) * self.start_seconds, 0.1 * seconds) / (
                area_of(window) * sum(counts))

    def cost(self, plan):
        return RUNS * sum(self.price[inside(window)].sum() * samples + self.start_seconds for window, samples in plan)

    def mean(self, part):
        return np.mean([run[part] for run in self.runs], 0)

    def variance(self, *parts):
        """Of pixels of a run, averaged over channels; of several parts, of their sum."""
        return np.var([sum(run[part] for part in parts) for run in self.runs], 0, ddof=1).mean(-1)

    def spread(self, scales):
        """Of pixels of a run, as shares of squared means."""
        return sum(self.variance(part) / scales[part] ** 2 for part in PARTS)

    def more(self, spread, wanted):
        """What brings the mean spread down: more of the plan or, where that takes less, another from nothing. Seconds, how
        to take it, and the plan."""
        added = [(window, int(np.ceil(samples * (spread.mean() / wanted - 1)))) for window, samples in self.plan]
        single = spread * self.samples
        worth = self.start_seconds * wanted / spread.mean() / (self.samples * self.price).sum()
        windows = divide(single * self.price, worth)
        of = lambda pixels: np.array([pixels[inside(window)].mean() for window in windows])
        counts = allot(np.array([area_of(window) for window in windows]), of(single), of(self.price), of(self.samples),
                       wanted, self.least)
        anew = list(zip(windows, map(int, counts)))
        return min([(self.cost(added), self.add, added), (self.cost(anew), self.take, anew)], key=lambda choice: choice[0])


def chains_of(renderer, size, wanted):
    """For each part, recipes from quick to exact whose differences take least time together (Giles 2008, several levels),
    told from two small pictures by each; and what each recipe takes for a picture of no samples."""
    small = ["--res", f"{size[0] // COARSER}x{size[1] // COARSER}", *SAME_RAYS]
    samples, made, seconds, start = 2, {}, {}, {}
    for recipe in RECIPES:
        start[recipe] = renderer.picture(recipe, samples, 1, [*small, "--crop", "0,0,4,4"])[1]
        runs = [renderer.picture(recipe, samples, seed, small) for seed in (1, 2)]
        made[recipe] = {part: np.array([parts[part] for parts, _ in runs]) for part in PARTS}
        seconds[recipe] = COARSER ** 2 / samples * max(np.mean([took for _, took in runs]) - start[recipe], 1e-3)
    fog = np.mean(made[EXACT]["fog"])
    means = {"surface": max(np.mean(made[EXACT]["surface"]) + fog, 1e-30), "fog": max(fog, 1e-30)}

    def root_of_variance(part, quick, better):
        """Of a sample, as far as windows let it count."""
        differences = made[better][part] - (made[quick][part] if quick else 0)
        tiles, areas = cautious(np.var(differences, 0, ddof=1).mean(-1))
        return np.sqrt(samples) / means[part] * (np.sqrt(tiles) * areas).sum() / areas.sum()

    def cost(part, chain):
        levels = list(zip((None, *chain), chain))
        roots = np.array([root_of_variance(part, *level) for level in levels])
        times = np.array([seconds[b] + (seconds[a] if a else 0) for a, b in levels])
        counts = (roots * np.sqrt(times)).sum() * roots / np.sqrt(times) / (RUNS * wanted ** 2)
        return RUNS * (np.maximum(counts, FEWEST_DIFFERENCES) * times).sum()

    quicker = [recipe for recipe in made if recipe not in (*FOR_SURFACES, EXACT)]
    chains = {"surface": [(recipe, EXACT) for recipe in FOR_SURFACES],
              "fog": [(*some, EXACT) for count in range(len(quicker) + 1) for some in itertools.combinations(quicker, count)]}
    return {part: min(of_part, key=lambda chain: cost(part, chain)) for part, of_part in chains.items()}, start


def levels_of(renderer, size, wanted):
    chains, start = chains_of(renderer, size, wanted)
    surface, fog = chains["surface"][0], chains["fog"]
    last = {"surface": surface} | ({"fog": fog[-2]} if len(fog) > 1 else {})
    rows = [({"surface": surface}, {}), *(({"fog": recipe}, {}) for recipe in fog[:-1][:1]),
            *(({"fog": better}, {"fog": quick}) for quick, better in zip(fog[:-1], fog[1:-1])),
            ({"surface": EXACT, "fog": EXACT}, last)]
    return [Level(renderer, size, plus, minus, start) for plus, minus in rows]


def steps(levels, scales, wanted):
    """What to take so that the levels' spreads add up to what is wanted: a level that is good enough leaves the rest of its
    share to the others."""
    spreads = [level.spread(scales) for level in levels]
    weights = [np.sqrt(spread.mean() * (level.samples * level.price).sum()) for spread, level in zip(spreads, levels)]
    poor = set(range(len(levels)))
    while True:
        rest = wanted - sum(spreads[i].mean() for i in range(len(levels)) if i not in poor)
        shares = {i: rest * weights[i] / sum(weights[j] for j in poor) for i in poor}
        good = {i for i in poor if spreads[i].mean() <= shares[i]}
        if not good or good == poor:
            return [levels[i].more(spreads[i], shares[i]) for i in poor]
        poor -= good


def aim_of(costs, left, hope):
    """Which error to go for, of those wanted and what each costs: the smallest that time is left for, or else one that may
    cost less than it seems."""
    for most in (left, hope * left):
        within = [error for error, cost in sorted(costs.items()) if cost <= most]
        if within:
            return within[0] if most == left else within[-1]
    return None


def find_truth(program, scene, size, frame, folder, wanted, seconds, hope=HOPE):
    """The truth with an error that is surely at most one of those wanted, the smallest there is processor time for; None
    where that is none. Raises Dark. Quick pictures, corrected by how far they are from better ones through the same few
    rays, and so on to exact ones. What is noisiest, a level or a window of one, takes most samples. What is known of the
    error comes from differences between independent pictures alone, and from how many of them."""
    renderer, best = Renderer(program, scene, frame, folder, seconds), None
    try:
        levels = levels_of(renderer, size, min(wanted))
        while True:
            mean = {part: sum(level.mean(part) for level in levels) for part in PARTS}
            layers = dict(zip(LAYERS, (mean["surface"] + mean["fog"], mean["fog"])))
            if min(layer.mean() for layer in layers.values()) <= 0:
                raise Dark()
            pixels = {layer: np.array([level.variance(*parts) for level in levels]) / RUNS
                      for layer, parts in zip(LAYERS, (PARTS, ("fog",)))}
            variance = {layer: float(values.sum(0).mean()) for layer, values in pixels.items()}
            doubts = {layer: doubt(values) for layer, values in pixels.items()}
            bound = error_of(layers, {layer: doubts[layer] * variance[layer] for layer in LAYERS})
            if bound <= max(wanted):
                best = Truth(layers, variance, bound, seconds - renderer.left)
            scales = {part: layers[layer].mean() for part, layer in zip(PARTS, LAYERS)}
            goals = {error: RUNS * AIM * error ** 2 / max(doubts.values()) for error in wanted if error < bound}
            aim = aim_of({error: sum(step[0] for step in steps(levels, scales, goal)) for error, goal in goals.items()},
                         renderer.left, hope)
            if aim is None:
                return best
            now = sum(level.spread(scales).mean() for level in levels)
            for _, take, plan in steps(levels, scales, max(goals[aim], now / STEP)):
                take(plan)
    except TooLong:
        return best
