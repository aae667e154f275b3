"""The model of forest_morning.json: a clearing with a path, trees around it, their crowns and the ferns below as alpha-cut
twigs. make_geometry.py writes it."""
import math
import random

from drawing import twig
from make_geometry import Model, add, cross, limb, unit

TO_SUN = unit((-0.27, 0.33, -0.90))  # against the sun's `direction` in forest_morning.json
EYE = (0.5, 1.55, 11.5)


def path_center(z):
    return 0.9 * math.sin(0.13 * z + 0.6) - 0.3


def ground_height(x, z):
    """Rolls, rises to both sides of the path, and sinks along it."""
    aside = abs(x - path_center(z))
    bank = 0.75 * (1 - math.exp(-((aside / 4.5) ** 2)))
    return 0.16 * math.sin(0.55 * x + 0.3 * z) * math.sin(0.4 * z - 0.2 * x) + bank + 0.012 * max(0, -z - 12) * min(aside, 12)


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def ground():
    step, width, near, far = 2, 36, 14, -62
    nx, nz = int(2 * width / step), int((near - far) / step)

    def vertex(i, j):
        x, z = -width + i * step, near - j * step
        slope = [(ground_height(x + dx, z + dz) - ground_height(x - dx, z - dz)) / 0.2 for dx, dz in ((0.1, 0), (0, 0.1))]
        return (x, ground_height(x, z), z), unit((-slope[0], 1, -slope[1]))

    triangles = []
    for j in range(nz):
        for i in range(nx):
            a, b, c, d = vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)
            triangles += [(a, b, c), (a, c, d)]
    return triangles


def leaf_normal(face, chance):
    """Light comes through leaves: on the side that the eye sees, the normal leans towards the sun as far as that side has it."""
    through = dot(face, TO_SUN)
    lean = add(TO_SUN, face, 0.06 - min(through, 0))
    return unit(add(unit(lean), add(face, (chance.uniform(-1, 1), chance.uniform(-1, 1), chance.uniform(-1, 1)), 0.5), 0.45))


def card(foot, along, size, chance):
    """A square with a twig that grows from its foot along a direction, turned at random about it."""
    along = unit(along)
    side = unit(cross(along, unit([chance.gauss(0, 1) for _ in range(3)])))
    face = cross(side, along)
    center = add(foot, along, size / 2)
    if dot(face, add(EYE, center, -1)) < 0:
        side, face = tuple(-c for c in side), tuple(-c for c in face)
    normal = leaf_normal(face, chance)
    low, high = add(foot, side, -size / 2), add(foot, side, size / 2)
    corners = [(low, (0, 1)), (high, (1, 1)), (add(high, along, size), (1, 0)), (add(low, along, size), (0, 0))]
    a, b, c, d = [(place, normal, uv) for place, uv in corners]
    return [(a, b, c), (a, c, d)]


def tuft(center, radius, count, size, chance):
    """Twigs around a center, pointing outwards and drooping a little; flat, as layers of beech are."""
    cards = []
    for _ in range(count):
        out = unit((chance.gauss(0, 1), chance.gauss(0.05, 0.45), chance.gauss(0, 1)))
        foot = add(center, (out[0] * radius[0], out[1] * radius[1], out[2] * radius[0]), chance.uniform(0.1, 0.75))
        cards += card(foot, add(out, (0, -0.25, 0)), size * chance.uniform(0.7, 1.25), chance)
    return cards


def fern(x, z, size, chance):
    cards, turn = [], chance.uniform(0, 6.28)
    for k in range(5):
        a = turn + 2 * math.pi * k / 5 + chance.uniform(-0.3, 0.3)
        cards += card((x, ground_height(x, z) - 0.05, z), (math.cos(a), chance.uniform(0.5, 1.1), math.sin(a)), size * chance.uniform(0.8, 1.2), chance)
    return cards


# Trees that make the picture: x, z, radius at breast height, height of the first tufts, tufts (0: the crown is out of sight).
TREES = [(-3.1, 7.0, 0.36, 4.6, 4), (4.3, 5.2, 0.30, 4.3, 5), (-5.6, 1.5, 0.27, 4.2, 6), (2.9, -2.5, 0.24, 4.4, 6),
         (-2.6, -6.5, 0.26, 4.8, 7), (6.6, -5.0, 0.30, 4.5, 6), (-8.2, -7.5, 0.28, 4.4, 6), (4.6, -12.5, 0.25, 5.0, 6),
         (-5.2, -14.5, 0.28, 5.2, 7), (1.9, -20.0, 0.27, 5.6, 6), (-10.5, -18.0, 0.3, 5.0, 5), (9.8, -16.0, 0.3, 5.0, 5)]


def all_trees(chance):
    trees = list(TREES)
    while len(trees) < 46:  # those behind, apart from each other and from the path
        x, z = chance.uniform(-26, 26), chance.uniform(-50, -8)
        if abs(x - path_center(z)) > 2.4 and all(math.hypot(x - t[0], z - t[1]) > 2.6 for t in trees):
            trees.append((x, z, chance.uniform(0.18, 0.3), chance.uniform(5, 7.5), 2))
    return trees


def forest_morning():
    """46 trees of a beech wood 60 m deep, ferns along the path; the crowns leave gaps for the sun."""
    m, chance, image = Model(), random.Random(7), twig()
    soil = m.material("forest floor", (0.095, 0.105, 0.04))
    bark = m.material("bark", (0.12, 0.095, 0.07))
    greens = [m.material("leaves", (0.38, 0.48, 0.07), leaf=image), m.material("golden leaves", (0.60, 0.46, 0.05), leaf=image),
              m.material("ferns", (0.26, 0.40, 0.06), leaf=image)]
    m.node("ground", [(soil, ground())])

    wood, crowns, golden = [], [], []
    for index, (x, z, radius, crown, tufts) in enumerate(all_trees(chance)):
        foot, lean = ground_height(x, z) - 0.2, (chance.uniform(-0.5, 0.5), chance.uniform(-0.3, 0.3))
        at = lambda y: (x + lean[0] * (y / 12) ** 1.6, foot + y, z + lean[1] * (y / 12) ** 1.6)
        heights = [0, 0.35, 1.0, 3.5, 7.5, 13]
        wood += limb([at(y) for y in heights], [radius * k for k in (2.1, 1.35, 1.05, 0.92, 0.75, 0.42)], 12 if index < 8 else 6)
        for k in range(tufts):
            a, y = chance.uniform(0, 6.28), crown + chance.uniform(0, 3.6)
            reach = chance.uniform(1.2, 2.6)
            end = add(at(y), (reach * math.cos(a), 0.45 * reach, reach * math.sin(a)))
            wood += limb([at(y - 0.3), add(at(y + 0.1), add(end, at(y), -1), 0.55), end], [0.28 * radius, 0.17 * radius, 0.02], 5)
            (golden if chance.random() < 0.3 else crowns).extend(tuft(end, (1.5, 0.7), 24 if index < 12 else 9, 1.0, chance))
    m.node("trunks", [(bark, wood)])
    m.node("crowns", [(greens[0], crowns), (greens[1], golden)])

    ferns = []
    while len(ferns) < 1400:
        z = chance.uniform(-26, 8.5)
        x = path_center(z) + chance.choice((-1, 1)) * (0.9 + abs(chance.gauss(0, 2.6)))
        if abs(x) < 14:
            ferns += fern(x, z, chance.uniform(0.35, 0.75), chance)
    m.node("ferns", [(greens[2], ferns)])
    print(f"{(len(crowns) + len(golden) + len(ferns))} leaf triangles")
    return m
