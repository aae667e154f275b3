"""The scenes every renderer is given, described once: Y up, metres, right-handed, candela and lux, linear colours."""
import dataclasses

SIZE = (160, 96)  # pixels
ALL_ORDERS = 0  # as a number of orders: every one of them


@dataclasses.dataclass
class Box:
    """An axis-aligned box: Lambert with one reflectance on all sides."""
    low: tuple
    high: tuple
    color: tuple = (0, 0, 0)


@dataclasses.dataclass
class Light:
    """point: `place` is where it is, `intensity` in candela. sun: `place` is the way it travels, `intensity` in lux."""
    kind: str
    place: tuple
    intensity: float


@dataclasses.dataclass
class Fog:
    """Even fog in a box, or the grid that `tyndall bake` makes of a recipe with these bounds."""
    low: tuple
    high: tuple
    extinction: float
    albedo: tuple
    g: float
    recipe: dict = None


@dataclasses.dataclass
class Camera:
    position: tuple
    target: tuple
    vertical_fov: float  # degrees


@dataclasses.dataclass
class Scene:
    name: str
    camera: Camera
    light: Light
    fog: Fog
    boxes: list = dataclasses.field(default_factory=list)
    size: tuple = SIZE  # of the picture, pixels


def room(color):
    """Floor, ceiling, back and right wall; the left wall is six slats with gaps as wide; the front is open."""
    walls = [((-2.1, -0.1, -2.1), (2.1, 0, 2)), ((-2.1, 3, -2.1), (2.1, 3.1, 2)),
             ((-2.1, 0, -2.1), (2.1, 3, -2)), ((2, 0, -2), (2.1, 3, 2))]
    slats = [((-2.1, 0.5 * i, -2), (-2, 0.5 * i + 0.25, 2)) for i in range(6)]
    return [Box(low, high, color) for low, high in walls + slats]


ROOM_CAMERA = Camera((0.6, 1.7, 7.5), (0.1, 1.4, 0), 30)
ROOM_FOG = dict(low=(-1.95, 0.05, -1.95), high=(1.95, 2.95, 1.95), extinction=0.3)
RECIPE = {"bounds": {"low": [-1, -1, -1], "high": [1, 1, 1]}, "voxel_size": 0.0625,
          "noise": {"octaves": 3, "scale": 0.8, "seed": 3},
          "density": {"threshold": 0.42, "gain": 4, "border": 0.25},
          "optics": {"extinction": 3, "albedo": 0.9, "g": 0.3}}

SCENES = [
    Scene("slab", Camera((0.9, 0.5, 4), (0, 0.1, 0), 33), Light("sun", (0.3, -0.8, -0.5), 10),
          Fog((-1, -0.9, -0.6), (1.2, 1, 0.6), 1, (0.9, 0.9, 0.9), 0.5)),
    Scene("slats", ROOM_CAMERA, Light("point", (-4.5, 3.6, -0.4), 300), Fog(**ROOM_FOG, albedo=(0.9, 0.9, 0.9), g=0.5),
          room((0, 0, 0))),
    Scene("diffuse", ROOM_CAMERA, Light("sun", (0.8, -0.5, -0.2), 10), Fog(**ROOM_FOG, albedo=(0.95, 0.8, 0.6), g=-0.3),
          room((0.3, 0.5, 0.7))),
    Scene("grid", Camera((1.2, 0.6, 4.2), (0, 0, 0), 33), Light("point", (1.6, 2.1, 1.2), 20),
          Fog((-1, -1, -1), (1, 1, 1), 3, (0.9, 0.9, 0.9), 0.3, RECIPE)),
]

# Floor and back wall, black, and seven slats under a point light in a cube of 128 x 128 x 128 voxels of fog. The lamp
# hangs above the picture: in it, the one pixel around it would decide every renderer's error.
SHAFTS = Scene(
    "shafts", Camera((0, 2, 7), (0, 2, 0), 32.27), Light("point", (0.3, 4.5, 0), 60),
    Fog((-2, 0, -2), (2, 4, 2), 0.8, (0.9, 0.9, 0.9), 0.4,
        {"bounds": {"low": [-2, 0, -2], "high": [2, 4, 2]}, "voxel_size": 0.03125,
         "noise": {"octaves": 4, "scale": 1.3, "seed": 1}, "density": {"threshold": 0.2, "gain": 0.7, "border": 0},
         "optics": {"extinction": 0.8, "albedo": 0.9, "g": 0.4}}),
    [Box((-4, -0.1, -4), (4, 0, 4)), Box((-4, -2, -2.55), (4, 6, -2.45))] +
    [Box((-1.625 + 0.5 * i, 2.575, -2), (-1.375 + 0.5 * i, 2.625, 2)) for i in range(7)], (640, 360))
