"""Models of scenes/pbrt: flames in light bulbs after the scene "matchbulb", and the ground of its explosions."""
import math

from make_geometry import Model, lathe, moved, quad, sphere

# Where the bulbs lie: the matrices of pbrt's ConcatTransform, column after column as in glTF.
BULBS = [
    [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
    [0.76604444, 0, -0.64278764, 0, -0.6232521, 0.24466307, -0.7427629, 0, 0.1572664, 0.9696082, 0.18742278, 0, -0.5, 0.2452139, -3.943021, 1],
    [-0.5, 0, 0.8660254, 0, 0.8397053, 0.24466307, 0.4848041, 0, -0.21188444, 0.9696082, -0.12233154, 0, 0.50736, 0.2452139, -3.636737, 1],
    [-0.7858569, 0, 0.6184084, 0, 0.59961385, 0.24466307, 0.76197326, 0, -0.1513017, 0.9696082, -0.19227016, 0, -2.59264, 0.2452139, -1.83674, 1],
    [0.49044752, 0, 0.87147075, 0, 0.8449851, 0.24466307, -0.47554192, 0, -0.2132167, 0.9696082, 0.119994394, 0, 1.09596, 0.2452139, 1.87731, 1],
    [0.98768836, 0, -0.15643446, 0, -0.15168013, 0.24466307, -0.9576707, 0, 0.038273737, 0.9696082, 0.24165086, 0, -6.69, 0.2452139, -11.44302, 1],
]


def cap():
    """A screw thread of rings, narrower towards the contact."""
    profile = [(0.187, 0.108), (0.20, 0.14), (0.26, 0.19)]
    for i in range(49):
        y = 0.19 + 0.45 * i / 48
        profile.append((0.285 + 0.018 * math.cos(2 * math.pi * 5 * i / 48), y))
    return lathe(profile + [(0.29, 0.655), (0.31, 0.67), (0.28, 0.68)], 40)


def matchbulb():
    """Six bulbs on a floor, a burning match in each. Their glass does not refract: it is a faint white film."""
    m = Model()
    floor = m.material("floor", (0.17, 0.14, 0.115))
    metal = m.material("aluminium", (0.34, 0.33, 0.32))
    ceramic = m.material("ceramic", (0.08, 0.08, 0.08))
    glass = m.material("glass", (0.8, 0.8, 0.8), alpha=0.05)
    wood = m.material("match", (0.42, 0.30, 0.18))
    m.node("floor", [(floor, quad((-40, 0, 12), (40, 0, 12), (40, 0, -60), (-40, 0, -60)))])
    bulb = [(0.28, 0.66), (0.295, 0.74), (0.325, 0.9), (0.39, 1.1), (0.485, 1.33), (0.565, 1.53), (0.605, 1.68), (0.61, 1.78),
            (0.585, 1.93), (0.525, 2.06), (0.435, 2.17), (0.31, 2.25), (0.16, 2.295), (0.001, 2.305)]
    parts = [(metal, cap() + lathe([(0.001, 0), (0.05, 0), (0.057, 0.0147), (0.001, 0.0147)], 24)),
             (ceramic, lathe([(0.057, 0.0147), (0.187, 0.108)], 32)),
             (wood, lathe([(0.026, 0.375), (0.026, 1.42), (0.001, 1.42)], 8) + moved(sphere(0.036, (0, 0, 0), 16, 10), (0, 1.45, 0))),
             (glass, lathe(bulb, 48))]
    for number, matrix in enumerate(BULBS):
        m.node(f"bulb {number + 1}", parts, matrix=matrix)
    return m


def explosion_ground():
    """The disc of a kilometer's radius below both explosions: pbrt's default material is Lambert's with an albedo of 0.5."""
    m = Model()
    sand = m.material("ground", (0.5, 0.5, 0.5))
    m.node("ground", [(sand, lathe([(1000, -0.05), (0.001, -0.05)], 96))])
    return m
