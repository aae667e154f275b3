"""The model of campfire.json: burning logs in a ring of stones, trunks around, sparks. make_geometry.py writes it."""
import math
import random

from make_geometry import between, cross, lathe, Model, moved, quad, rough, smooth, sphere


def forest_floor():
    """Rings that grow outwards, a shallow pit in the middle; and the height at a place, that of the nearest corner."""
    rings = [0.06 * 1.155 ** i for i in range(38)]
    floor = lathe([(0.001, -0.03)] + [(r, -0.03 if r < 0.4 else 0.012 * min(r - 0.4, 1.5)) for r in rings], 60)
    floor = [t[::-1] if cross([q - p for p, q in zip(t[0][0], t[1][0])], [q - p for p, q in zip(t[0][0], t[2][0])])[1] < 0 else t
             for t in floor]
    floor = rough(rough(floor, 0.35, 0.022, 1, (0.2, 1, 0.2)), 2.5, 0.07, 2, (0, 1, 0))
    grid = {}
    for p in {v[0] for tri in floor for v in tri}:
        grid.setdefault((round(2 * p[0]), round(2 * p[2])), []).append(p)

    def ground(x, z):
        near = [p for i in (-1, 0, 1) for k in (-1, 0, 1) for p in grid.get((round(2 * x) + i, round(2 * z) + k), [])]
        return min(near, key=lambda p: (p[0] - x) ** 2 + (p[2] - z) ** 2)[1]

    return floor, ground


def log(radius, seed, rows=9, sides=14):
    """Side and ends of a log of unit height."""
    side = lathe([(radius * (1 - 0.12 * i / rows), i / rows) for i in range(rows + 1)], sides)
    ends = lathe([(0.0008, 0), (radius, 0)], sides, inward=True) + lathe([(0.88 * radius, 1), (0.0008, 1)], sides)
    return rough(side, 0.09, 0.011, seed, (1, 0, 1)), ends


def trunk(r, seed, chance):
    """A trunk with furrows along it that wander a little."""
    profile = [(r * (1 + 0.9 * math.exp(-8 * h)) * (1 - 0.07 * h), h) for h in (-0.1, 0.06, 0.2, 0.45, 0.8, 1.3, 2, 3.2, 8)]
    ridges = [chance.uniform(-0.09, 0.09) for _ in range(20)]

    def ridged(p):
        side = (math.atan2(p[2], p[0]) / (2 * math.pi) * 20 + 0.25 * math.sin(5 * p[1] + seed)) % 20
        k, f = int(side) % 20, side % 1
        out = 1 + (1 - f) * ridges[k] + f * ridges[(k + 1) % 20]
        return (p[0] * out, p[1], p[2] * out)

    one = smooth([[ridged(v) for v, _ in tri] for tri in lathe(profile, 20)])
    return rough(one, 0.3, 0.03, 600 + seed, (1, 0.3, 1))


def litter(ground, chance):
    """Leaves and twigs on the floor, fewer far away."""
    leaves, twigs = [], []
    for i in range(520):
        angle, r = chance.uniform(0, 6.283), 0.75 + 4.2 * chance.uniform(0, 1) ** 1.6
        x, z = r * math.cos(angle), r * math.sin(angle)
        place = (x, ground(x, z) + 0.012, z)
        if i % 6 == 0:
            length, way = chance.uniform(0.08, 0.3), chance.uniform(0, 6.283)
            end = (place[0] + length * math.cos(way), place[1] + chance.uniform(-0.01, 0.03), place[2] + length * math.sin(way))
            twigs += between(lathe([(0.006, 0), (0.003, 1)], 5), place, end)
            continue
        a, b = chance.uniform(0.018, 0.034), chance.uniform(0.012, 0.02)
        leaf = quad((-a, 0, 0), (0, 0.3 * b, b), (a, 0, 0), (0, 0.4 * b, -b))
        leaf = moved(leaf, (0, 0, 0), (1, 0, 0), chance.uniform(-35, 35))
        leaves += moved(leaf, place, (0, 1, 0), chance.uniform(0, 360))
    return leaves, twigs


def add_sparks(m, spark, chance):
    """Upright slivers, as long as they fly in a fiftieth of a second, that rise from the fire and start anew."""
    def sliver(a, b):
        return quad((-a, 0, 0), (0, -b, 0), (a, 0, 0), (0, b, 0)) + quad((0, 0, -a), (0, -b, 0), (0, 0, a), (0, b, 0))

    shape, period = [(spark, sliver(0.0022, 0.011))], 2.0
    for i in range(56):
        angle, r, speed = chance.uniform(0, 6.283), chance.uniform(0.02, 0.2), chance.uniform(0.7, 1.5)
        born, turn, reach = chance.uniform(0.01, period - 0.01), chance.uniform(-3, 3), chance.uniform(0.05, 0.5)

        def at(age):
            y = 0.25 + speed * age * (1 + 0.15 * age)
            out = r + reach * (age / period) ** 1.5
            wobble = 0.05 * math.sin(5 * age + 200 * r)
            return (out * math.cos(angle + turn * age) + wobble + 0.1 * age, y, out * math.sin(angle + turn * age) + 0.7 * wobble)

        # A spark starts anew between two of its keys, where it has shrunk to nothing.
        times, size = sorted([0.2 * k for k in range(11)] + [born - 1e-4, born]), chance.uniform(0.6, 1)
        path = []
        for time in times:
            age = (time - born + 1e-9) % period
            path.append((time, at(age), size * max(0.02, (1 - age / period) ** 0.7)))
        m.node(f"spark {i + 1}", shape, (0, 0, 0), path=path)


def campfire():
    """Burning logs in a ring of stones on a forest floor, trunks around; sparks that rise and repeat after two seconds."""
    m, chance = Model(), random.Random(4)
    soil = m.material("soil", (0.24, 0.20, 0.16))
    stone = m.material("stone", (0.33, 0.31, 0.29))
    bark = m.material("bark", (0.16, 0.11, 0.075))
    char = m.material("charred wood", (0.07, 0.05, 0.04))
    wood = m.material("cut wood", (0.34, 0.24, 0.15))
    leaves = m.material("dry leaves", (0.34, 0.20, 0.10))
    ember = m.material("embers", (0.05, 0.03, 0.02), (1500, 330, 28))
    spark = m.material("sparks", (0.1, 0.05, 0.02), (16000, 4600, 420))

    floor, ground = forest_floor()
    m.node("floor", [(soil, floor)])
    stones = []
    for i in range(13):
        angle, size = 2 * math.pi * (i + chance.uniform(-0.15, 0.15)) / 13, chance.uniform(0.085, 0.125)
        one = [tuple(((p[0] * 1.15, p[1] * 0.8, p[2]), n) for p, n in t) for t in sphere(size, (0, 0, 0), 16, 10)]
        one = rough(one, 0.16, 0.03, 100 + i)
        stones += moved(one, (0.58 * math.cos(angle), 0.03, -0.58 * math.sin(angle)), (0, 1, 0), math.degrees(angle) + 90 + chance.uniform(-25, 25))
    m.node("stones", [(stone, stones)])

    teepee, cuts = [], []
    for i in range(7):
        angle = 2 * math.pi * (i + chance.uniform(-0.2, 0.2)) / 7 + 0.35
        foot, top = chance.uniform(0.33, 0.42), chance.uniform(0.03, 0.07)
        side, ends = log(chance.uniform(0.035, 0.055), 200 + i)
        low = (foot * math.cos(angle), -0.02, foot * math.sin(angle))
        high = (-top * math.cos(angle + 0.5), chance.uniform(0.42, 0.56), -top * math.sin(angle + 0.5))
        teepee += between(side, low, high)
        cuts += between(ends, low, high)
    m.node("logs", [(char, teepee), (char, cuts)])

    bed = []
    for i in range(40):
        angle, r = chance.uniform(0, 6.283), 0.33 * math.sqrt(chance.uniform(0, 1))
        lump = rough(sphere(chance.uniform(0.014, 0.032), (0, 0, 0), 7, 5), 0.05, 0.008, 300 + i)
        bed.append(moved(lump, (r * math.cos(angle), -0.012 + 0.05 * (1 - r / 0.33), r * math.sin(angle))))
    m.node("embers", [(ember, sum(bed[::2], [])), (char, sum(bed[1::2], []))])

    # Something to sit on, and firewood beside it.
    side, ends = log(0.17, 400, 16, 20)
    low, high = (-1.12, 0.15, -0.3), (-2.6, 0.16, -0.72)
    m.node("seat", [(bark, between(side, low, high)), (wood, between(ends, low, high))])
    pile, cut = [], []
    for i, (x, y) in enumerate(((0, 0.05), (0.12, 0.05), (0.24, 0.05), (0.06, 0.15), (0.18, 0.15), (0.12, 0.25))):
        side, ends = log(0.052, 500 + i)
        low = (0.95 + x, y, -0.62 - 0.25 * x + chance.uniform(-0.03, 0.03))
        high = (1.14 + x, y, -1.06 - 0.25 * x)
        pile += between(side, low, high)
        cut += between(ends, low, high)
    m.node("firewood", [(bark, pile), (wood, cut)])

    trunks = []
    for i, (x, z, r) in enumerate(((-2.3, -2.2, 0.17), (-0.9, -3.4, 0.22), (0.75, -2.6, 0.14), (2.1, -3.1, 0.24), (3.3, -1.6, 0.16),
                                   (-3.6, -0.9, 0.2), (-4.2, -4.6, 0.25), (0.1, -5.6, 0.21), (4.6, -5.2, 0.26), (1.4, -7.2, 0.2),
                                   (-2.3, -7.6, 0.22), (-6.3, -3.1, 0.24), (6.4, -3.4, 0.22))):
        trunks += moved(trunk(r, i, chance), (x, 0, z), (0, 0, 1), chance.uniform(-3, 3))
    m.node("trunks", [(bark, trunks)])

    fallen, twigs = litter(ground, chance)
    m.node("leaves", [(leaves, fallen)])
    m.node("twigs", [(bark, twigs)])
    add_sparks(m, spark, chance)
    return m
