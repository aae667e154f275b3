"""More kinds of scenes: skies, faces, fire, glowing meshes, colored water, an open shutter, wind, projectors, droplets, lenses,
plates. They stand apart so that the seeds of the others keep their scenes."""
import numpy as np

from families import Drawn, clouds, foliage, hall, headlights, keyhole, moving, slats, smoke, soft_lamps, underwater
from geometry import Deformation, Material, Mesh, box, cylinder, sphere
from light_files import gobo_image, ies_profile, sky_image


def gradient(c, brightness):
    return {"sky": {name: [brightness * part for part in c.color()] for name in ("zenith", "horizon", "ground")}}


def sky(c):
    """Light from all around in open places, beside what was there or alone."""
    drawn = c.choice([foliage, headlights, smoke])(c)
    drawn.background = gradient(c, c.log(0.5, 20)) if c.happens(0.7) else {"color": c.color(0.5, 5)}
    drawn.ambient = 0
    if c.happens(0.3):
        drawn.lights = []
    drawn.lights.append({"type": "environment", "intensity": c.log(0.3, 3)})
    return drawn


def faces(c):
    """Rectangles, discs and balls in a room, some of them seen, and boxes between them."""
    drawn = soft_lamps(c)
    for light in drawn.lights:
        radius = c.log(0.01, 0.5)
        light |= {"type": c.choice(["rectangle", "rectangle", "disc", "sphere"]), "radius": radius,
                  "intensity": light["intensity"] / (4 * radius * radius), "visible": c.happens(0.5)}
        if light["type"] != "sphere":
            light |= {"target": c.point((-3, 0, -3), (3, 2, 3)), "two_sided": c.happens(0.3)}
        if light["type"] == "rectangle":
            light |= {"width": 2 * radius, "height": 2 * radius * c.log(0.1, 3)}
            del light["radius"]
    return drawn


def fire(c):
    """A flame of a recipe in a hall or in the open, that lights its smoke, pillars and the fog around."""
    height = c.log(0.3, 3)
    radius, wide = height * c.uniform(0.15, 0.5), height * c.uniform(1.2, 3)
    core = c.uniform(1300, 2200)
    recipe = {"bounds": {"low": [-radius * 2, 0, -radius * 2], "high": [radius * 2, 1.8 * height, radius * 2]},
              "voxel_size": height / c.uniform(20, 60),
              "fire": {"base": [0, 0.03 * height, 0], "height": height, "radius": radius, "taper": c.uniform(0, 3), "core": core,
                       "edge": core * c.uniform(0.5, 0.8), "flicker": c.uniform(0, 1.5), "rise": height,
                       "noise": {"octaves": c.randint(1, 4), "scale": height * c.log(0.1, 0.4), "seed": c.randrange(1000)},
                       "soot": c.uniform(0, 0.3)},
              "noise": {"octaves": 3, "scale": height * 0.4}, "density": {"threshold": c.uniform(0.4, 0.6), "gain": 3}}
    media = [{"type": "noise", **c.optics(c.log(0.1, 3) / height), "recipe": recipe,
              "blackbody": {"convention": "kelvin", "emission_scale": c.log(1e-4, 1e-2) / height}},
             c.fog((-2 * wide, 0, -2 * wide), (2 * wide, 2 * height, 2 * wide), c.log(0.03, 1))]
    pillars = [cylinder((x := wide * c.choice([-1, 1]) * c.uniform(0.3, 1), 0, z := wide * c.uniform(-1, 0.5)),
                        (x, height * c.uniform(0.4, 2), z), height * c.log(0.03, 0.2)) for _ in range(c.randint(1, 8))]
    ground = box((-4 * wide, -0.1, -4 * wide), (4 * wide, 0, 4 * wide))
    return Drawn(c.camera((c.uniform(-0.5, 0.5) * wide, height * c.uniform(0.2, 1), wide * c.uniform(1, 1.9)),
                          (0, 0.5 * height, 0)),
                 [], media, [Mesh(Material(c.color()), np.concatenate([ground, *pillars]))], frame=c.randint(1, 48))


def glowing(c):
    """Meshes that glow in a room, of many sizes."""
    drawn = soft_lamps(c)
    for light in drawn.lights:
        radius = c.log(0.02, 0.3)
        nits = light["intensity"] / (3 * radius * radius)
        shape = (sphere(light["position"], radius, c.randint(3, 10)) if c.happens(0.6) else
                 box([p - radius for p in light["position"]], [p + radius * c.log(0.05, 1) for p in light["position"]]))
        drawn.meshes.append(Mesh(Material((0, 0, 0), emission=tuple(nits * part for part in light["color"])), shape))
    drawn.lights = []
    return drawn


def colored(c):
    """Water or fog that dims red, green and blue differently."""
    drawn = c.choice([underwater, underwater, keyhole, slats])(c)
    for medium in drawn.media:
        if c.happens(0.8):
            medium["extinction"] = [medium["extinction"] * c.log(0.3, 3) for _ in range(3)]
    return drawn


def reeds(c, drawn, seconds):
    """Thin columns around what the camera looks at, that lean over or bend meanwhile."""
    eye, middle = (np.array(place["keys"][0][1] if isinstance(place, dict) else place, float)
                   for place in (drawn.camera["position"], drawn.camera["target"]))
    size = np.linalg.norm(middle - eye)
    for _ in range(c.randint(1, 5)):
        height, base = size * c.uniform(0.3, 0.9), middle + size * np.array(c.point((-0.4, -0.4, -0.4), (0.4, -0.2, 0.4)))
        radius, rings = size * c.log(0.003, 0.03), [base + (0, height * part, 0) for part in np.linspace(0, 1, 7)]
        shape = np.concatenate([cylinder(low, high, radius, 6) for low, high in zip(rings, rings[1:])])
        angle, around = c.uniform(0.2, 1.2), c.uniform(0, 2 * np.pi)
        if c.happens(0.5):
            lean = np.array([np.cos(around), -0.3, np.sin(around)]) * np.sin(angle)
            target = shape + lean * ((shape[..., 1:2] - base[1]) ** 2 / height)
            how = Deformation(seconds, target=target)
        else:
            half = np.sin(angle / 2)
            how = Deformation(seconds, pivot=tuple(rings[2]), height=height / 2,
                              turn=(half * np.cos(around), 0, half * np.sin(around), np.cos(angle / 2)))
        drawn.meshes.append(Mesh(Material(c.color()), shape, how))


def open_shutter(c):
    """What moves is seen while it does, meshes that change their shape among it."""
    drawn = moving(c)
    middle, half = c.uniform(-0.5, 0.5), c.uniform(0.1, 0.5)
    drawn.camera["shutter"] = {"open": middle - half, "close": middle + half, "curve": c.choice(["box", "triangle"])}
    if c.happens(0.5):
        reeds(c, drawn, c.uniform(0.5, 3) * (drawn.frame + 1) / 24)
    return drawn


def mapped(c):
    """An image of a sky around open places, its sun no brighter than such images have it."""
    drawn = c.choice([foliage, headlights, smoke])(c)
    drawn.files["sky.hdr"] = sky_image(c)
    drawn.background = {"image": "sky.hdr", "projection": "lat_long", "intensity": c.log(0.5, 10), "rotation": c.uniform(-180, 180)}
    drawn.ambient, drawn.lights = 0, [{"type": "environment", "intensity": c.log(0.3, 3)}]
    return drawn


def projectors(c):
    """Lamps with measured profiles, and spots that project images."""
    drawn = c.choice([headlights, soft_lamps, smoke])(c)
    for i, light in enumerate(drawn.lights):
        if light["type"] == "spot" and c.happens(0.6):
            drawn.files[f"gobo{i}.png"] = gobo_image(c)
            light["gobo"] = {"image": f"gobo{i}.png", "scale": c.uniform(0.6, 1.5), "rotate": c.uniform(-180, 180)}
        elif light["type"] in ("point", "spot"):
            drawn.files[f"lamp{i}.ies"] = ies_profile(c)
            light["ies"] = {"file": f"lamp{i}.ies", "rotate": c.uniform(-180, 180)}
            if light["type"] == "point":
                light["target"] = c.point((-3, -3, -3), (3, 0, 3))
    return drawn


def phase_function(c):
    one = lambda: c.choice([
        lambda: {"type": "draine", "g": c.uniform(-0.3, 0.8), "alpha": c.uniform(0, 1)},
        lambda: {"type": "mie", "droplet_diameter": c.log(0.2, 50)},
        lambda: {"type": "henyey_greenstein", "g": c.uniform(-0.5, 0.95)},
        lambda: {"type": "rayleigh"}])()
    kind = c.choice(["one", "mix", "table", "legendre"])
    if kind == "one":
        return one()
    if kind == "mix":
        return {"type": "mix", "weight": c.uniform(0.1, 0.9), "lobes": [one(), one()]}
    if kind == "table":
        ahead, fall = c.log(1, 300), c.uniform(5, 60)
        return {"type": "table", "values": [[angle, 1 + ahead * np.exp(-angle / fall) + c.uniform(0, 0.5)]
                                            for angle in np.linspace(0, 180, c.randint(10, 90)).tolist()]}
    g = c.uniform(-0.5, 0.7)
    return {"type": "legendre", "coefficients": [(2 * l + 1) * g ** l for l in range(c.randint(16, 40))]}


def droplets(c):
    """Fog and clouds whose phase functions are anything but one Henyey-Greenstein."""
    drawn = c.choice([clouds, smoke, headlights, underwater])(c)
    for medium in drawn.media:
        medium["phase"] = phase_function(c)
        del medium["g"]
    return drawn


def blown(c):
    """Clouds from files in wind and eddies, moved by their velocities while the shutter is open."""
    drawn = c.choice([clouds, smoke])(c)
    for medium in drawn.media:
        bounds = medium["recipe"]["bounds"]
        size = max(b - a for a, b in zip(bounds["low"], bounds["high"]))
        medium["recipe"] |= {"wind": c.point([-size] * 3, [size] * 3), "voxel_size": size / c.uniform(20, 50)}
        medium |= {"type": "vdb", "grids": {"velocity": "vel"}}
    half = c.log(0.05, 0.5)
    drawn.camera["shutter"] = {"open": -half, "close": half}
    return drawn


def lenses(c):
    """Depth of field, with lamps in view that are out of focus."""
    drawn = c.choice([soft_lamps, slats, foliage, headlights])(c)
    away = np.linalg.norm(np.subtract(drawn.camera["position"], drawn.camera["target"]))
    drawn.camera |= {"aperture_radius": away * c.log(0.002, 0.05), "focus_distance": away * c.log(0.3, 3)}
    if c.happens(0.5):
        drawn.camera |= {"aperture_blades": c.randint(5, 9), "blade_rotation": c.uniform(0, 90)}
    return drawn


def plates(c):
    """Fog for a plate: some of the meshes hold it out, and lights are linked to some."""
    drawn = c.choice([foliage, slats, soft_lamps])(c)
    for i, mesh in enumerate(drawn.meshes):
        mesh.name = f"mesh {i + 1}"
    names = [mesh.name for mesh in drawn.meshes]
    drawn.objects = [{"name": name, **({"matte": True} if i == 0 or c.happens(0.4) else {"casts_shadows": c.happens(0.5)})}
                     for i, name in enumerate(names)]
    for light in drawn.lights:
        link = c.choice(["light_link", "shadow_link", None])
        if link:
            light[link] = {c.choice(["include", "exclude"]): [c.choice(names)]}
    return drawn


AUTHORED = [sky, faces, fire, glowing, colored, open_shutter, mapped, projectors, droplets, blown, lenses, plates]
