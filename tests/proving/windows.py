"""Which parts of a picture take how many samples: windows, told from how much pixels spread."""
import numpy as np

TILE = 4  # pixels: those of a packet
BESIDE, WHOLE = 1 / 16, 1 / 256  # a tile spreads at least as this share of the variance beside it, and of the mean
POWER = 1.5  # of the samples by which variance falls, about: they are stratified


def tile_sums(pixels):
    """Sums over tiles, those at the edges too."""
    starts = [np.arange(0, n, TILE) for n in pixels.shape]
    return np.add.reduceat(np.add.reduceat(pixels, starts[0], 0), starts[1], 1)


def cautious(variance):
    """Of a pixel of each tile, raised to what lies around allows: chance may have hidden it."""
    areas = tile_sums(np.ones(variance.shape))
    means = tile_sums(variance) / areas
    padded = np.pad(means, 1, mode="edge")
    height, width = means.shape
    beside = np.max([padded[y:y + height, x:x + width] for y in range(3) for x in range(3)], 0)
    return np.maximum.reduce([means, BESIDE * beside, np.full(means.shape, WHOLE * variance.mean())]), areas


def best_cut(spread, areas):
    """Of a block of tiles: what samples cost in it as a whole, in the cheapest two parts, and the axis and place of that cut.
    Costs are Neyman's: the area times the root of the mean variance."""
    whole, best = np.sqrt(spread.sum() * areas.sum()), (np.inf, 0, 0)
    for axis in (0, 1):
        first_spread, first_area = np.cumsum(spread.sum(1 - axis))[:-1], np.cumsum(areas.sum(1 - axis))[:-1]
        if len(first_area) == 0:
            continue
        costs = np.sqrt(first_spread * first_area) + np.sqrt((spread.sum() - first_spread) * (areas.sum() - first_area))
        place = int(np.argmin(costs))
        best = min(best, (float(costs[place]), axis, place + 1))
    return float(whole), best


def divide(spread, worth):
    """Windows (x0, y0, x1, y1) that cover the picture. `spread` is what a sample of a pixel varies by times what it costs;
    `worth` what one more window costs, as a share of what samples cost undivided."""
    means, areas = cautious(spread)
    sums = means * areas
    least = worth * np.sqrt(sums.sum() * areas.sum())
    found, blocks = [], [(0, 0, means.shape[1], means.shape[0])]
    while blocks:
        x0, y0, x1, y1 = blocks.pop()
        whole, (cost, axis, place) = best_cut(sums[y0:y1, x0:x1], areas[y0:y1, x0:x1])
        if whole - cost > least:
            blocks += [(x0, y0, x1, y0 + place), (x0, y0 + place, x1, y1)] if axis == 0 else [
                (x0, y0, x0 + place, y1), (x0 + place, y0, x1, y1)]
            continue
        height, width = spread.shape
        found.append((TILE * x0, TILE * y0, min(TILE * x1, width), min(TILE * y1, height)))
    return sorted(found)


def allot(areas, single, price, taken, wanted, least):
    """Whole samples for each window that bring the mean variance of pixels about to `wanted`, as the roots of what a sample
    varies by over what it costs (Neyman 1934); `taken` is how many samples that was told from."""
    def counts(scale):
        return np.maximum(np.ceil(scale * np.sqrt(single / price)), least)

    def reached(scale):
        return (areas * single / taken * (taken / counts(scale)) ** POWER).sum() / areas.sum()

    low, high = -60.0, 60.0  # of the scale's logarithm
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if reached(np.exp(middle)) <= wanted else (middle, high)
    return counts(np.exp(high)).astype(int)


def area_of(window):
    x0, y0, x1, y1 = window
    return (x1 - x0) * (y1 - y0)


def inside(window):
    x0, y0, x1, y1 = window
    return slice(y0, y1), slice(x0, x1)
