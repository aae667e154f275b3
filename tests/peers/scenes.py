"""The scenes every renderer is given, described once: Y up, meters, right-handed, candela, lux and nit, linear colors."""
import dataclasses

SIZE = (160, 96)  # pixels
SMALL = (64, 40)  # of the scenes with soft lights, which are noisier
ALL_ORDERS = 0  # as a number of orders: every one of them


@dataclasses.dataclass
class Box:
    """An axis-aligned box: Lambert with one reflectance on all sides, and a radiance of its own in nit."""
    low: tuple
    high: tuple
    color: tuple = (0, 0, 0)
    emission: float = 0


@dataclasses.dataclass
class Sphere:
    """A black ball that moves straight and evenly by `motion` while the shutter is open; `center` is half way."""
    center: tuple
    radius: float
    motion: tuple


@dataclasses.dataclass
class Light:
    """point: `place` is where it is, `intensity` in candela. sun: `place` is the way it travels, `intensity` in lux.
    rectangle: `place` is its middle, it looks at `target`, `size` is width and height, the latter along Y as seen from
    it, `intensity` in nit. environment: a lat-long map (environment.py) times `intensity`."""
    kind: str
    place: tuple
    intensity: float
    target: tuple = None
    size: tuple = None


@dataclasses.dataclass
class Fog:
    """Even fog in a box, or the grid that `tyndall bake` makes of a recipe with these bounds. `extinction` may be a
    color. Above 0, `alpha` makes the phase function Draine's; with a `fire` in the recipe the temperature glows as in
    Blender's Principled Volume."""
    low: tuple
    high: tuple
    extinction: float
    albedo: tuple
    g: float
    recipe: dict = None
    alpha: float = 0


@dataclasses.dataclass
class Camera:
    position: tuple
    target: tuple
    vertical_fov: float  # degrees


@dataclasses.dataclass
class Scene:
    name: str
    camera: Camera
    light: Light  # or None: boxes or the fog glow
    fog: Fog
    boxes: list = dataclasses.field(default_factory=list)
    size: tuple = SIZE  # of the picture, pixels
    sphere: Sphere = None


def room(color):
    """Floor, ceiling, back and right wall; the left wall is six slats with gaps as wide; the front is open."""
    walls = [((-2.1, -0.1, -2.1), (2.1, 0, 2)), ((-2.1, 3, -2.1), (2.1, 3.1, 2)),
             ((-2.1, 0, -2.1), (2.1, 3, -2)), ((2, 0, -2), (2.1, 3, 2))]
    slats = [((-2.1, 0.5 * i, -2), (-2, 0.5 * i + 0.25, 2)) for i in range(6)]
    return [Box(low, high, color) for low, high in walls + slats]


ROOM_CAMERA = Camera((0.6, 1.7, 7.5), (0.1, 1.4, 0), 30)
ROOM_FOG = dict(low=(-1.95, 0.05, -1.95), high=(1.95, 2.95, 1.95), extinction=0.3)
SLAB_CAMERA = Camera((0.9, 0.5, 4), (0, 0.1, 0), 33)
SLAB = dict(low=(-1, -0.9, -0.6), high=(1.2, 1, 0.6))
WHITE = (0.9, 0.9, 0.9)
SUN = Light("sun", (0.3, -0.8, -0.5), 10)
FLOOR = Box((-1.6, -1.1, -1.2), (1.8, -1, 1.2), (0.6, 0.4, 0.3))
SHADE = Box((-0.5, 1.12, -0.5), (0.05, 1.16, 0.4))
RECIPE = {"bounds": {"low": [-1, -1, -1], "high": [1, 1, 1]}, "voxel_size": 0.0625,
          "noise": {"octaves": 3, "scale": 0.8, "seed": 3},
          "density": {"threshold": 0.42, "gain": 4, "border": 0.25},
          "optics": {"extinction": 3, "albedo": 0.9, "g": 0.3}}
FIRE = {"bounds": {"low": [-0.5, 0, -0.5], "high": [0.5, 1.5, 0.5]}, "voxel_size": 0.03125,
        "fire": {"base": [0, 0.1, 0], "height": 0.8, "radius": 0.25, "taper": 2, "core": 2200, "edge": 1400,
                 "noise": {"octaves": 2, "scale": 0.3, "seed": 3}, "soot": 0.5, "smoke": {"start": 0.5, "spread": 0.25}},
        "noise": {"octaves": 2, "scale": 0.5, "seed": 5},
        "density": {"threshold": 0.3, "gain": 3, "soft_edge": 0.3, "border": 0.1},
        "optics": {"extinction": 3, "albedo": 0.8, "g": 0.4}}

SCENES = [
    Scene("slab", SLAB_CAMERA, SUN, Fog(**SLAB, extinction=1, albedo=WHITE, g=0.5)),
    Scene("slats", ROOM_CAMERA, Light("point", (-4.5, 3.6, -0.4), 300), Fog(**ROOM_FOG, albedo=WHITE, g=0.5),
          room((0, 0, 0))),
    Scene("diffuse", ROOM_CAMERA, Light("sun", (0.8, -0.5, -0.2), 10), Fog(**ROOM_FOG, albedo=(0.95, 0.8, 0.6), g=-0.3),
          room((0.3, 0.5, 0.7))),
    Scene("grid", Camera((1.2, 0.6, 4.2), (0, 0, 0), 33), Light("point", (1.6, 2.1, 1.2), 20),
          Fog((-1, -1, -1), (1, 1, 1), 3, WHITE, 0.3, RECIPE)),
    Scene("environment", SLAB_CAMERA, Light("environment", None, 1), Fog(**SLAB, extinction=1, albedo=WHITE, g=0.5),
          [FLOOR], SMALL),
    Scene("rectangle", SLAB_CAMERA, Light("rectangle", (0.2, 1.6, 0.1), 20, (0.4, -0.5, -0.3), (0.8, 0.5)),
          Fog(**SLAB, extinction=1, albedo=WHITE, g=0.3), [FLOOR, SHADE], SMALL),
    Scene("mesh", SLAB_CAMERA, None, Fog(**SLAB, extinction=1, albedo=WHITE, g=0.3),
          [FLOOR, SHADE, Box((-0.3, 1.45, -0.3), (0.4, 1.6, 0.2), (0, 0, 0), 20)], SMALL),
    Scene("fire", Camera((0.6, 0.9, 3.2), (0, 0.7, 0), 28), None, Fog((-0.5, 0, -0.5), (0.5, 1.5, 0.5), 3, (0.8, 0.8, 0.8),
                                                                    0.4, FIRE), [], SMALL),
    Scene("chromatic", SLAB_CAMERA, SUN, Fog(**SLAB, extinction=(0.4, 1, 2.5), albedo=(0.95, 0.8, 0.6), g=0.5), [], SMALL),
    Scene("draine", SLAB_CAMERA, SUN, Fog(**SLAB, extinction=1, albedo=WHITE, g=0.6, alpha=2), [], SMALL),
    Scene("moving", SLAB_CAMERA, Light("point", (0.1, 2.4, 0.1), 20), Fog(**SLAB, extinction=1, albedo=WHITE, g=0.3),
          [FLOOR], SMALL, Sphere((0.1, 1.4, 0), 0.25, (0.7, 0, 0.2))),
]

# Floor and back wall, black, and seven slats under a point light in a cube of 128 x 128 x 128 voxels of fog. The lamp
# hangs above the picture: in it, the one pixel around it would decide every renderer's error.
SHAFTS = Scene(
    "shafts", Camera((0, 2, 7), (0, 2, 0), 32.27), Light("point", (0.3, 4.5, 0), 60),
    Fog((-2, 0, -2), (2, 4, 2), 0.8, WHITE, 0.4,
        {"bounds": {"low": [-2, 0, -2], "high": [2, 4, 2]}, "voxel_size": 0.03125,
         "noise": {"octaves": 4, "scale": 1.3, "seed": 1}, "density": {"threshold": 0.2, "gain": 0.7, "border": 0},
         "optics": {"extinction": 0.8, "albedo": 0.9, "g": 0.4}}),
    [Box((-4, -0.1, -4), (4, 0, 4)), Box((-4, -2, -2.55), (4, 6, -2.45))] +
    [Box((-1.625 + 0.5 * i, 2.575, -2), (-1.375 + 0.5 * i, 2.625, 2)) for i in range(7)], (640, 360))
