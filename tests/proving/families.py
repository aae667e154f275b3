"""Kinds of scenes, drawn by chance from a seed within wide ranges: what nobody had before their eyes when the tool was
tuned. A family is a function of a Chance that returns a Drawn scene. Meters, seconds, candela, lux and nits."""
import copy
import dataclasses
import math
import random

import numpy as np

from geometry import (Material, Mesh, box, cylinder, inward_box, quads, scattered_quads, sphere, wall_with_holes)

SIZES = [(96, 54), (128, 72), (160, 90), (192, 108), (256, 144), (320, 180)]  # of pictures


@dataclasses.dataclass
class Drawn:
    """`media` hold recipes as objects; those of type vdb are baked from theirs. `frame` is the one to render. `gltf` names
    a file below tests/data that is there instead of `meshes`."""
    camera: dict
    lights: list
    media: list
    meshes: list = dataclasses.field(default_factory=list)
    ambient: float = 0
    background: dict = None
    frame: int = 1
    gltf: str = None
    offset: list = None  # of the meshes' node
    objects: list = dataclasses.field(default_factory=list)  # settings of meshes by name
    files: dict = dataclasses.field(default_factory=dict)  # contents of files beside the scene's, by name
    plain: "Drawn" = None  # the same picture at the usual scale and place: what the truth is made from


class Chance(random.Random):
    def log(self, low, high):
        """Evenly in the logarithm."""
        return math.exp(self.uniform(math.log(low), math.log(high)))

    def happens(self, probability):
        return self.random() < probability

    def point(self, low, high):
        return [self.uniform(a, b) for a, b in zip(low, high)]

    def color(self, low=0.05, high=0.9):
        gray = self.uniform(low, high)
        return [gray] * 3 if self.happens(0.4) else [min(0.95, gray * self.uniform(0.5, 1.5)) for _ in range(3)]

    def optics(self, extinction):
        albedo = self.uniform(0.5, 0.99)
        return {"extinction": extinction, "g": self.uniform(-0.4, 0.85),
                "albedo": albedo if self.happens(0.6) else [min(1, albedo * self.uniform(0.7, 1)) for _ in range(3)]}

    def recipe(self, low, high, cells=None):
        """Noise that fills a box with 40 to 120 voxels along its longest side."""
        longest = max(b - a for a, b in zip(low, high))
        size = longest / (cells or self.uniform(40, 120))
        return {"bounds": {"low": list(low), "high": list(high)}, "voxel_size": size,
                "noise": {"octaves": self.randint(1, 5), "scale": longest * self.log(0.08, 0.6),
                          "gain": self.uniform(0.4, 0.65), "seed": self.randrange(1000), "billow": self.happens(0.3)},
                "density": {"threshold": self.uniform(0.25, 0.55), "gain": self.log(1, 8),
                            "soft_edge": self.choice([0, 0.1, 0.3]), "border": self.choice([0, 0.1 * longest])}}

    def fog(self, low, high, depth):
        """One medium of about so much optical depth across a box: homogeneous, noise or VDB."""
        extinction = depth / max(b - a for a, b in zip(low, high))
        kind = self.choice(["homogeneous", "homogeneous", "noise", "noise", "vdb"])
        if kind == "homogeneous":
            return {"type": kind, **self.optics(extinction), "bounds": {"low": list(low), "high": list(high)}}
        return {"type": kind, **self.optics(2 * extinction), "recipe": self.recipe(low, high)}

    def point_light(self, position, size, radius=0):
        """Bright enough for `size` meters around."""
        return {"type": "point", "position": list(position), "intensity": 10 * size * size * self.log(0.3, 3),
                "color": self.color(0.6, 0.95), "radius": radius}

    def spot(self, position, target, size, radius=0):
        outer = self.uniform(6, 45)
        return {**self.point_light(position, size, radius), "type": "spot", "target": list(target), "outer_cone": outer,
                "inner_cone": outer * self.uniform(0, 0.98)}

    def sun(self, elevation=(8, 75), soft=0.3):
        up, around = math.radians(self.uniform(*elevation)), self.uniform(0, 2 * math.pi)
        way = [math.cos(up) * math.cos(around), -math.sin(up), math.cos(up) * math.sin(around)]
        return {"type": "sun", "direction": way, "intensity": 10 * self.log(0.5, 5), "color": self.color(0.6, 0.95),
                "angle": self.log(0.1, 3) if self.happens(soft) else 0}

    def camera(self, position, target):
        return {"position": list(position), "target": list(target), "vertical_fov": self.uniform(20, 75)}


def hall(width, height, depth, color):
    """The inside of a room: x and z around 0, y from 0."""
    return Mesh(Material(color), inward_box((-width / 2, 0, -depth / 2), (width / 2, height, depth / 2)))


def slats(c):
    """A room behind slats or a grille, with a lamp or the sun outside."""
    width, height, depth = c.uniform(3, 10), c.uniform(2.4, 5), c.uniform(3, 10)
    count, share = c.randint(3, 24), c.uniform(0.3, 0.85)
    pitch, thick = width / count, c.log(0.005, 0.1)
    at = c.uniform(0.6, 0.9) * height if c.happens(0.5) else None  # a ceiling of slats, else a wall
    bars = []
    for i in range(count):
        x = -width / 2 + i * pitch
        if at:
            bars.append(box((x, at - thick, -depth / 2), (x + pitch * share, at, depth / 2)))
        else:
            bars.append(box((x, 0, -depth / 2), (x + pitch * share, height, -depth / 2 + thick)))
    if c.happens(0.4):  # a grille
        across = c.randint(2, 16)
        for i in range(across):
            v = i / across
            if at:
                z = -depth / 2 + v * depth
                bars.append(box((-width / 2, at - thick, z), (width / 2, at, z + depth / across * share * 0.5)))
            else:
                y = v * height
                bars.append(box((-width / 2, y, -depth / 2), (width / 2, y + height / across * 0.3, -depth / 2 + thick)))
    walls = [box((-width, -0.1, -depth), (width, 0, depth)), box((-width, 0, -depth - 0.1), (width, height * 2, -depth))]
    outside = [c.uniform(-0.3, 0.3) * width, height * c.uniform(1.1, 1.6) if at else height * c.uniform(0.4, 1.2),
               c.uniform(-0.2, 0.2) * depth if at else -depth * c.uniform(0.6, 0.9)]
    light = (c.point_light(outside, 2 * height, c.choice([0, 0, 0.02, 0.1])) if c.happens(0.7)
             else c.spot(outside, (0, 0, 0), 2 * height))
    return Drawn(c.camera((c.uniform(-0.3, 0.3) * width, c.uniform(0.2, 0.7) * height, depth * c.uniform(0.6, 1.3)),
                          (0, height * c.uniform(0.3, 0.6), 0)),
                 [light], [c.fog((-width / 2, 0, -depth / 2), (width / 2, height, depth / 2), c.log(0.2, 5))],
                 [Mesh(Material(c.color(0, 0.5)), np.concatenate(bars)), Mesh(Material(c.color(0, 0.5)), np.concatenate(walls))])


def foliage(c):
    """The sun or a street lamp through leaves and thin trunks."""
    size, count = c.uniform(4, 30), int(c.log(200, 8000))
    trunks = [cylinder((x := c.uniform(-size, size), 0, z := c.uniform(-size, 0.3 * size)),
                       (x + c.uniform(-0.5, 0.5), size, z + c.uniform(-0.5, 0.5)), size * c.log(0.004, 0.04))
              for _ in range(c.randint(4, 60))]
    leaf = c.happens(0.4)
    crown = scattered_quads(c, count, (-size, 0.45 * size, -size), (size, size, 0.5 * size), size * c.log(0.01, 0.08))
    light = (c.sun((15, 70)) if c.happens(0.7)
             else c.point_light((c.uniform(-0.3, 0.3) * size, 1.2 * size, c.uniform(-0.5, 0) * size), size))
    return Drawn(c.camera((c.uniform(-0.4, 0.4) * size, 0.15 * size, size * c.uniform(0.6, 1.4)),
                          (0, c.uniform(0.2, 0.6) * size, 0)),
                 [light], [c.fog((-1.2 * size, 0, -1.2 * size), (1.2 * size, 1.1 * size, 1.2 * size), c.log(0.1, 3))],
                 [Mesh(Material((0.6, 0.8, 0.4) if leaf else c.color(0.1, 0.5), leaf=leaf), crown),
                  Mesh(Material(c.color(0.05, 0.4)), np.concatenate(trunks)),
                  Mesh(Material(c.color()), box((-3 * size, -1, -3 * size), (3 * size, 0, 3 * size)))],
                 ambient=c.choice([0, 0.02]), background={"color": c.color(0, 0.5)} if c.happens(0.5) else None)


def headlights(c):
    """Spots that shine about towards the camera: a car in fog, or a stage."""
    stage = c.happens(0.5)
    size = c.uniform(4, 12) if stage else c.uniform(10, 60)
    lights, count = [], c.randint(3, 14) if stage else c.randint(1, 3) * 2
    for i in range(count):
        x = (i / max(count - 1, 1) - 0.5) * size * 1.4
        if stage:
            place = (x, size * c.uniform(0.5, 0.9), -0.5 * size)
            lights.append(c.spot(place, c.point((-size, 0, -0.5 * size), (size, 0.5 * size, 0.8 * size)), size))
        else:
            place = (x + c.uniform(-1, 1), 0.7, -size * c.uniform(0.2, 1))
            lights.append(c.spot(place, (x * 0.6, c.uniform(0, 1), size), size, c.choice([0, 0.05, 0.1])))
    ground = box((-5 * size, -1, -5 * size), (5 * size, 0, 5 * size))
    boxes = [box((x := c.uniform(-size, size), 0, z := c.uniform(-size, 0.3 * size)),
                 (x + c.uniform(0.1, 0.1 * size), c.uniform(0.3, 2.5), z + 0.1 * size)) for _ in range(c.randint(0, 8))]
    media = [{"type": "height", **c.optics(c.log(0.3, 2) / size), "base": 0, "falloff": c.uniform(1, 0.5 * size)}
             if c.happens(0.5) else c.fog((-2 * size, 0, -1.5 * size), (2 * size, size, 1.2 * size), c.log(0.3, 3))]
    return Drawn(c.camera((c.uniform(-0.3, 0.3) * size, c.uniform(0.8, 2), size * c.uniform(0.7, 1.1)),
                          (0, c.uniform(0.5, 0.3 * size), -0.3 * size)),
                 lights, media, [Mesh(Material(c.color()), np.concatenate([ground, *boxes]))], ambient=c.choice([0, 0.005]))


def soft_lamps(c):
    """Glowing balls in view in a room of boxes."""
    size = c.uniform(3, 9)
    radius = c.log(0.002, 0.25)
    lights = [c.point_light(c.point((-0.35 * size, 0.3 * size, -0.35 * size), (0.35 * size, 0.8 * size, 0.3 * size)), size,
                            radius) for _ in range(c.randint(1, 4))]
    boxes = []
    while len(boxes) < 5:
        low = c.point((-0.45 * size, 0, -0.45 * size), (0.35 * size, 0.5 * size, 0.2 * size))
        high = [a + size * c.log(0.03, 0.3) for a in low]
        if not any(all(a - radius < p < b + radius for a, b, p in zip(low, high, light["position"])) for light in lights):
            boxes.append(box(low, high))
    return Drawn(c.camera((c.uniform(-0.4, 0.4) * size, c.uniform(0.3, 0.7) * size, 0.48 * size),
                          (0, 0.45 * size, -0.2 * size)),
                 lights, [c.fog((-size / 2, 0, -size / 2), (size / 2, size, size / 2), c.log(0.1, 4))],
                 [hall(size, size, size, c.color()), Mesh(Material(c.color()), np.concatenate(boxes))])


def keyhole(c):
    """A dark room into which light falls through holes of less than a thousandth of a wall."""
    width, height, depth = c.uniform(3, 12), c.uniform(2.5, 6), c.uniform(3, 12)
    side = math.sqrt(width * height * c.log(1e-4, 9e-4))
    holes = []
    for _ in range(c.choice([1, 1, 2, 3])):
        x, y = c.uniform(-0.3, 0.3) * width, c.uniform(0.3, 0.8) * height
        long = c.choice([1, 1, 4])
        hole = (x, y, x + side / math.sqrt(long), y + side * math.sqrt(long))
        if all(hole[2] < other[0] or hole[0] > other[2] for other in holes):
            holes.append(hole)
    wall = wall_with_holes(width, height, holes, -depth / 2)
    corner = [(x, y, z) for x in (-width / 2, width / 2) for y in (0, height) for z in (-depth / 2, depth / 2)]
    room = quads([[corner[i] for i in face] for face in
                  [(0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]])  # floor, ceiling, left, right
    low, high = math.radians(c.uniform(5, 35)), math.radians(c.uniform(-25, 25))
    light = ({"type": "sun", "direction": [math.sin(high), -math.sin(low), math.cos(low)], "intensity": c.log(30, 300),
              "angle": c.choice([0, 0.27])} if c.happens(0.6)
             else c.spot((0, height * c.uniform(0.5, 1.2), -depth * c.uniform(0.8, 2)), (holes[0][0], holes[0][1], -depth / 2),
                         4 * depth, c.choice([0, 0.05])))
    return Drawn(c.camera((c.uniform(-0.4, 0.4) * width, c.uniform(0.3, 0.7) * height, depth * c.uniform(0.3, 0.48)),
                          (0, 0.4 * height, -0.2 * depth)),
                 [light], [c.fog((-width / 2, 0, -depth / 2), (width / 2, height, depth / 2), c.log(0.2, 3))],
                 [Mesh(Material(c.color(0.1, 0.7)), np.concatenate([wall, room]))], ambient=c.log(0.003, 0.1))


def cathedral(c):
    """A nave whose windows are panes of partly transparent glass."""
    width, height, depth = c.uniform(8, 20), c.uniform(8, 25), c.uniform(15, 50)
    count = c.randint(2, 7)
    holes, panes = [], []
    for i in range(count):
        x = (i + 0.5) / count * depth - depth / 2
        wide = depth / count * c.uniform(0.15, 0.35)
        holes.append((x - wide, 0.35 * height, x + wide, c.uniform(0.6, 0.9) * height))
    side = wall_with_holes(depth, height, holes, 0)
    turned = np.stack([np.full(side.shape[:2], width / 2), side[..., 1], side[..., 0]], -1)
    for x0, y0, x1, y1 in holes:
        across = c.randint(1, 4)
        for k in range(across):
            a, b = x0 + (x1 - x0) * k / across, x0 + (x1 - x0) * (k + 1) / across
            panes.append(Mesh(Material(c.color(), alpha=c.uniform(0.1, 0.9)),
                              quads([[(width / 2, y0, a), (width / 2, y0, b), (width / 2, y1, b), (width / 2, y1, a)]])))
    columns = [cylinder((s * width * 0.25, 0, z), (s * width * 0.25, height, z), width * c.uniform(0.02, 0.05))
               for s in (-1, 1) for z in np.linspace(-0.4, 0.4, c.randint(2, 6)) * depth]
    shell = [box((-width / 2, -0.2, -depth / 2), (width / 2, 0, depth / 2)),
             box((-width / 2, height, -depth / 2), (width / 2, height + 0.2, depth / 2)),
             box((-width / 2 - 0.2, 0, -depth / 2), (-width / 2, height, depth / 2)),
             box((-width / 2, 0, -depth / 2 - 0.2), (width / 2, height, -depth / 2))]
    elevation, around = math.radians(c.uniform(20, 50)), math.radians(c.uniform(-30, 30))
    sun = {"type": "sun", "intensity": 50, "angle": c.choice([0, 0.27, 1]), "direction":
           [-math.cos(elevation) * math.cos(around), -math.sin(elevation), math.cos(elevation) * math.sin(around)]}
    return Drawn(c.camera((c.uniform(-0.2, 0.2) * width, c.uniform(1.5, 0.4 * height), 0.47 * depth),
                          (c.uniform(-0.1, 0.2) * width, 0.35 * height, -0.2 * depth)),
                 [sun], [c.fog((-width / 2, 0, -depth / 2), (width / 2, height, depth / 2), c.log(0.2, 2))],
                 [Mesh(Material(c.color(0.2, 0.7)), np.concatenate([turned, *shell, *columns])), *panes],
                 ambient=c.choice([0, 0.01]))


def underwater(c):
    """Water that absorbs red, the sun through planks or waves of panes, a floor of stones."""
    size = c.uniform(5, 40)
    depth = size * c.uniform(0.3, 0.8)
    albedo = [c.uniform(0.1, 0.4), c.uniform(0.4, 0.8), c.uniform(0.6, 0.95)]
    water = {"type": "homogeneous", "extinction": c.log(0.3, 3) / depth, "albedo": albedo, "g": c.uniform(0.5, 0.92),
             "bounds": {"low": [-3 * size, -depth, -3 * size], "high": [3 * size, 0, 3 * size]}}
    planks = scattered_quads(c, c.randint(10, 400), (-size, -0.05, -size), (size, 0.3, size), size * c.log(0.05, 0.4))
    stones = [sphere(c.point((-size, -depth, -size), (size, -depth, 0.5 * size)), size * c.log(0.02, 0.15))
              for _ in range(c.randint(0, 25))]
    kelp = [cylinder((x := c.uniform(-size, size), -depth, z := c.uniform(-size, 0.5 * size)),
                     (x + c.uniform(-1, 1), c.uniform(-0.8, 0) * depth, z + c.uniform(-1, 1)), size * c.log(0.002, 0.02), 6)
            for _ in range(c.randint(0, 30))]
    floor = box((-4 * size, -depth - 1, -4 * size), (4 * size, -depth, 4 * size))
    media = [water]
    if c.happens(0.5):
        media.append({"type": "noise", **c.optics(c.log(0.1, 1) / depth),
                      "recipe": c.recipe((-size, -depth, -size), (size, -0.5 * depth, size), 50)})
    return Drawn(c.camera((0, -depth * c.uniform(0.3, 0.8), size * c.uniform(0.5, 1)), (0, -depth * c.uniform(0, 0.7), 0)),
                 [c.sun((35, 85), 0.5)], media,
                 [Mesh(Material((0.3, 0.2, 0.1)), planks), Mesh(Material(c.color()), np.concatenate([floor, *stones, *kelp]))],
                 ambient=c.choice([0, 0.02]), background={"color": [0.02, 0.1, 0.15]})


def overlapping(c):
    """Three to six media, stacked and through each other, under lamps and the sun."""
    size = c.uniform(3, 20)
    media = []
    for _ in range(c.randint(3, 6)):
        low = c.point((-size, 0, -size), (0.5 * size, 0.4 * size, 0.3 * size))
        high = [a + size * c.uniform(0.3, 1.5) for a in low]
        media.append(c.fog(low, high, c.log(0.1, 3)))
    if c.happens(0.5):
        media.append({"type": "height", **c.optics(c.log(0.05, 1) / size), "base": 0, "falloff": size * c.log(0.05, 0.5)})
    lights = [c.point_light(c.point((-size, 0.1 * size, -size), (size, size, 0.5 * size)), size, c.choice([0, 0.02, 0.15]))
              for _ in range(c.randint(0, 3))]
    if not lights or c.happens(0.5):
        lights.append(c.sun())
    boxes = [box(low := c.point((-size, 0, -size), (size, 0.2 * size, 0.3 * size)), [a + size * c.log(0.03, 0.3) for a in low])
             for _ in range(c.randint(1, 12))]
    boxes.append(box((-4 * size, -1, -4 * size), (4 * size, 0, 4 * size)))
    return Drawn(c.camera((c.uniform(-0.5, 0.5) * size, c.uniform(0.2, 0.6) * size, size * c.uniform(0.8, 1.6)),
                          (0, 0.3 * size, -0.2 * size)),
                 lights, media, [Mesh(Material(c.color()), np.concatenate(boxes))], ambient=c.choice([0, 0.01]))


def clouds(c):
    """A cloud of voxels, from thin to a hundred optical depths, in the sun."""
    size = c.log(2, 500)
    recipe = c.recipe((-size, -0.5 * size, -size), (size, 0.6 * size, size), c.uniform(60, 110))
    recipe["density"] |= {"threshold": c.uniform(0.4, 0.55), "gain": c.log(2, 10), "border": 0}
    recipe["shape"] = {"kind": "ellipsoid", "strength": c.uniform(0.1, 0.4)}
    medium = {"type": "vdb", **c.optics(c.log(0.5, 100) / size), "recipe": recipe}
    lights = [c.sun((5, 80))]
    if c.happens(0.25):
        lights.append(c.point_light(c.point((-size, -size, -size), (size, size, size)), size))
    return Drawn(c.camera((0, c.uniform(-0.5, 0.5) * size, size * c.uniform(2, 3.5)), (0, 0, 0)), lights, [medium],
                 background={"color": c.color(0.01, 0.3)} if c.happens(0.5) else None)


def smoke(c):
    """The camera stands in smoke."""
    size = c.uniform(2, 15)
    medium = {"type": c.choice(["noise", "vdb"]), **c.optics(c.log(0.5, 10) / size),
              "recipe": c.recipe((-size, 0, -size), (size, size, size), c.uniform(50, 100))}
    lights = [c.spot(c.point((-size, 0.5 * size, -size), (size, size, 0)), (0, 0, -0.3 * size), size) if c.happens(0.5)
              else c.point_light(c.point((-size, 0.1 * size, -size), (size, size, 0)), size, c.choice([0, 0.03]))
              for _ in range(c.randint(1, 3))]
    boxes = [box(low := c.point((-size, 0, -size), (size, 0.5, -0.2 * size)), [a + size * c.log(0.02, 0.2) for a in low])
             for _ in range(c.randint(0, 10))]
    boxes.append(box((-2 * size, -0.5, -2 * size), (2 * size, 0, 2 * size)))
    return Drawn(c.camera((0, c.uniform(0.1, 0.6) * size, c.uniform(0, 0.5) * size), c.point((-1, 0.5, -size), (1, 0.5 * size, -size))),
                 lights, [medium], [Mesh(Material(c.color()), np.concatenate(boxes))])


def moving(c):
    """Lights and camera on their way, seen at a frame in between."""
    drawn = c.choice([slats, headlights, soft_lamps, smoke])(c)
    seconds = c.uniform(0.5, 4)

    def keys(start, end):
        return {"keys": [[0, start], [seconds, end]], "interpolation": c.choice(["linear", "smooth"])}

    camera = drawn.camera["position"]
    drawn.camera["position"] = keys(camera, [a + 0.05 * abs(a) * c.uniform(-1, 1) for a in camera])
    for light in drawn.lights:
        light["intensity"] = keys(light["intensity"], light["intensity"] * c.log(0.2, 5))
        if "position" in light:
            light["position"] = keys(light["position"], [a * c.uniform(0.9, 1.1) for a in light["position"]])
    drawn.frame = c.randint(1, int(24 * seconds))
    return drawn


OTHERS = [  # a file by others, the middle of what it shows and how large that is
    ("gltf/bevy/CornellBox/CornellBox.glb", (0, 1, 0), 2), ("gltf/rayferric/cornell-box/cornell-box.gltf", (0, 1, 0), 2),
    ("gltf/khronos/SimpleInstancing/glTF-Binary/SimpleInstancing.glb", (0, 0, 0), 10),
    ("gltf/bevy/cubes/Cubes.glb", (0, 0, 0), 5), ("gltf/khronos/BoxVertexColors/glTF-Binary/BoxVertexColors.glb", (0, 0, 0), 1)]


def others(c):
    """Meshes that others made, in fog, from any side."""
    name, middle, size = c.choice(OTHERS)
    around, up = c.uniform(0, 2 * math.pi), c.uniform(-0.2, 0.8)
    away = size * c.uniform(1.2, 2.5)
    eye = [middle[0] + away * math.cos(around), middle[1] + away * up, middle[2] + away * math.sin(around)]
    low, high = [m - 1.2 * size for m in middle], [m + 1.2 * size for m in middle]
    lights = [c.sun()] if c.happens(0.5) else [c.point_light(c.point(low, high), size, c.choice([0, 0.05]))]
    return Drawn(c.camera(eye, middle), lights, [c.fog(low, high, c.log(0.2, 4))], gltf=name, ambient=c.choice([0, 0.02]),
                 background={"color": c.color(0, 0.3)} if c.happens(0.5) else None)


def street(c):
    """A street at night: many lamps on posts, walls with lit windows."""
    length, width = c.uniform(20, 100), c.uniform(6, 20)
    count = c.randint(3, 10)
    parts, lights = [box((-100, -1, -length * 2), (100, 0, length))], []
    for i in range(count):
        side = width / 2 * (1 if i % 2 else -1)
        z = -length * i / count
        high = c.uniform(3, 7)
        parts.append(cylinder((side, 0, z), (side, high, z), 0.06, 8))
        parts.append(box((side - 0.3, high, z - 0.3), (side + 0.3, high + 0.1, z + 0.3)))
        lights.append(c.point_light((side * 0.93, high - 0.25, z), width, c.choice([0, 0.05, 0.15])))
    for side in (-1, 1):
        x = side * width
        parts.append(box((min(x, x + side), 0, -length), (max(x, x + side), c.uniform(5, 15), length * 0.3)))
    media = [{"type": "homogeneous", **c.optics(c.log(0.005, 0.08))} if c.happens(0.4)
             else {"type": "height", **c.optics(c.log(0.01, 0.1)), "base": 0, "falloff": c.uniform(2, 10)}]
    if c.happens(0.5):
        media.append(c.fog((-width, 0, -length), (width, 4, 5), c.log(0.2, 2)))
    return Drawn(c.camera((c.uniform(-0.3, 0.3) * width, c.uniform(1.2, 2.5), c.uniform(2, 8)), (0, c.uniform(1, 3), -0.5 * length)),
                 lights, media, [Mesh(Material(c.color()), np.concatenate(parts))], ambient=c.choice([0, 1e-3]))


def scaled(c):
    """One of the others, as small as a millimeter, as vast as a hundred kilometers, or far from the origin."""
    drawn = c.choice([slats, soft_lamps, headlights, clouds, smoke, keyhole, overlapping])(c)
    drawn.plain = copy.deepcopy(drawn)
    if c.happens(0.6):
        resize(drawn, c.log(1e-3, 1) if c.happens(0.5) else c.log(1, 1e4))
    else:
        move(drawn, c.point((-1, -1, -1), (1, 1, 1)), c.log(1e3, 3e5))
    return drawn


LENGTHS = {"position", "target", "radius", "range", "near", "far", "base", "falloff", "low", "high", "voxel_size", "scale",
           "border"}


def resize(drawn, k):
    """Lengths times k; extinction divided by it, candela times its square."""
    def walk(value, key=""):
        if isinstance(value, dict):
            point = value.get("type") in ("point", "spot")
            return {name: walk(part, name) if name != "intensity" else (part * k * k if point else part)
                    for name, part in value.items()}
        if isinstance(value, list) and key in LENGTHS:
            return [part * k for part in value]
        if key == "extinction":
            return value / k
        return value * k if key in LENGTHS else value

    drawn.camera = walk(drawn.camera)
    drawn.camera["near"] = max(0.01 * k, 1e-5)
    drawn.lights, drawn.media = [walk(light) for light in drawn.lights], [walk(medium) for medium in drawn.media]
    for mesh in drawn.meshes:
        mesh.points = mesh.points * k


def move(drawn, way, distance):
    offset = np.array(way) / np.linalg.norm(way) * distance

    def moved(point):
        return [float(a + b) for a, b in zip(point, offset)]

    for thing in [drawn.camera, *drawn.lights]:
        for key in ("position", "target"):
            if key in thing:
                thing[key] = moved(thing[key])
    for medium in drawn.media:
        if "base" in medium:
            medium["base"] += float(offset[1])
        elif "recipe" in medium or "bounds" in medium:
            medium["translate"] = offset.tolist()
    drawn.offset = offset.tolist()


SLOW = {cathedral, street}  # their truths take long: small pictures
FAMILIES = [slats, foliage, headlights, soft_lamps, keyhole, cathedral, underwater, overlapping, clouds, smoke, scaled,
            moving, others, street]


def family_of(seed, families=FAMILIES):
    return families[seed % len(families)]


def draw(seed, attempt=0, families=FAMILIES):
    """The scene of a seed, the same on every machine; `attempt` counts how often it was drawn anew. With it the size of
    its picture."""
    chance = Chance(f"{seed} {attempt}")
    size, family = chance.choice(SIZES), family_of(seed, families)
    return family(chance), SIZES[SIZES.index(size) // 2] if family in SLOW else size
