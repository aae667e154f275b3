"""The model, gobos and scene of concert.json: make_geometry.py writes the model, python3 scenes/concert.py the rest."""
import json
import math
import pathlib
import random

from drawing import breakup, spokes
from make_geometry import Model, add, box, lathe, limb, moved, quad, sphere

STAGE = 1.2  # meters above the hall


# --- what stands there ------------------------------------------------------------------------------------------------

def person(arms=(), lean=0.0, knees=True):
    """1.75 m tall, facing +z, without legs where nobody sees them. arms: (elbow, hand) of the left and right arm."""
    chest, hips = (0, 1.38, lean), (0, 0.92, 0)
    body = limb([hips, (0, 1.15, 0.4 * lean), chest, (0, 1.5, lean)], [0.17, 0.15, 0.20, 0.08], 8) + sphere(0.115, (0, 1.66, 1.2 * lean), 10, 7)
    if knees:
        for side in (-1, 1):
            body += limb([(0.1 * side, 0.95, 0), (0.15 * side, 0.5, 0.05), (0.17 * side, 0.02, 0)], [0.10, 0.07, 0.05], 6)
    for side, (elbow, hand) in zip((-1, 1), arms):
        body += limb([(0.19 * side, 1.42, lean), elbow, hand], [0.06, 0.05, 0.035], 5)
    return body


def band():
    """Singer, guitar, bass, drums, keys: left to right as the hall sees them -3.4, 0, 3.3; the drums on a riser."""
    singer = person([((-0.42, 1.2, 0.15), (-0.12, 1.45, 0.42)), ((0.45, 1.62, 0.05), (0.62, 2.02, 0.1))], 0.06)
    singer += limb([(-0.1, 0, 0.45), (-0.1, 1.5, 0.43)], [0.012, 0.012], 5) + lathe_at([(0.2, 0), (0.001, 0.03)], (-0.1, 0, 0.45))
    player = person([((-0.42, 1.12, 0.12), (-0.12, 1.02, 0.28)), ((0.44, 1.12, 0.15), (0.62, 1.2, 0.25))], 0.03)
    player += moved(box((-0.22, -0.16, 0), (0.2, 0.16, 0.07)) + box((0.2, -0.03, 0.02), (0.95, 0.03, 0.05)), (-0.08, 1.02, 0.2), (0, 0, 1), 14)
    drums = lathe_turned(0.32, 0.45, (0, 0.62, 0.35)) + box((-0.3, 0.3, -0.75), (0.3, 0.5, -0.45))
    for x, y, z, r, h in ((-0.55, 0.72, 0.2, 0.18, 0.25), (0.55, 0.72, 0.2, 0.2, 0.3), (-0.35, 0.95, 0.4, 0.15, 0.2), (0.35, 0.95, 0.4, 0.15, 0.2)):
        drums += lathe_at([(r, -h / 2), (r, h / 2), (0.001, h / 2)], (x, y, z))
    for x, y, z in ((-0.95, 1.25, 0.3), (0.95, 1.3, 0.3), (0.0, 1.42, 0.55)):
        drums += lathe_at([(0.24, 0), (0.001, 0.035)], (x, y, z)) + limb([(x, 0, z), (x, y, z)], [0.014, 0.012], 4)
    drums += moved(person([((-0.4, 1.25, 0.2), (-0.35, 1.25, 0.5)), ((0.45, 1.55, 0.1), (0.5, 1.85, 0.3))], 0.05, False), (0, -0.35, -0.55))
    triangles = moved(singer, (0, STAGE, -1.7), (0, 1, 0), 8) + moved(player, (-3.3, STAGE, -2.4), (0, 1, 0), 24)
    triangles += moved(player, (3.2, STAGE, -2.7), (0, 1, 0), -30) + moved(drums, (0, STAGE + 0.6, -5.6))
    keys = box((-0.7, 0.85, -0.2), (0.7, 0.97, 0.2)) + limb([(-0.5, 0, 0), (0.5, 0.86, 0)], [0.02, 0.02], 4)
    keys += limb([(0.5, 0, 0), (-0.5, 0.86, 0)], [0.02, 0.02], 4)
    keys += moved(person([((-0.36, 1.1, -0.1), (-0.3, 1.0, 0.35)), ((0.36, 1.1, -0.1), (0.3, 1.0, 0.35))], 0.1), (0, 0, -0.5))
    return triangles + moved(keys, (-5.6, STAGE, -4.2), (0, 1, 0), 40)


def lathe_at(profile, place, sides=14):
    return moved(lathe(profile, sides), place)


def lathe_turned(radius, depth, place):
    """A drum on its side, its head towards +z."""
    return moved(lathe([(0.001, -depth / 2), (radius, -depth / 2), (radius, depth / 2), (0.001, depth / 2)], 18), place, (1, 0, 0), 90)


def truss(y, z, half=8.5):
    triangles = []
    for dy in (0, 0.4):
        for dz in (-0.2, 0.2):
            triangles += box((-half, y + dy - 0.025, z + dz - 0.025), (half, y + dy + 0.025, z + dz + 0.025))
    count = int(2 * half / 0.6)
    for i in range(count):
        x = -half + 0.6 * (i + 0.5)
        triangles += moved(box((-0.015, -0.29, -0.015), (0.015, 0.29, 0.015)), (x, y + 0.2, z + 0.2), (0, 0, 1), 46 if i % 2 else -46)
    return triangles


def crowd(m, cloth):
    """72 people from the barrier to where the eye is, each one of three; they share three meshes."""
    chance = random.Random(11)
    up = ((-0.30, 1.72, 0.02), (-0.26, 2.10, -0.05)), ((0.30, 1.72, 0.02), (0.24, 2.12, -0.05))
    clap = ((-0.34, 1.62, -0.1), (-0.06, 1.95, -0.16)), ((0.34, 1.62, -0.1), (0.06, 1.95, -0.16))
    kinds = [[(cloth, moved(person(arms, -0.03, False), (0, 0, 0), (0, 1, 0), 180))] for arms in ((), up, (up[0],), clap)]
    for k in range(72):
        z, x = 1.7 + 0.85 * (k // 9) + chance.uniform(-0.25, 0.25), -6.6 + 1.65 * (k % 9) + 0.8 * (k // 9 % 2) + chance.uniform(-0.45, 0.45)
        m.node(f"listener {k + 1}", kinds[chance.choice((0, 0, 0, 0, 1, 2, 2, 3))], (round(x, 3), round(chance.uniform(-0.12, 0.08), 3), round(z, 3)),
               turn=round(chance.uniform(-25, 25)), scale=round(chance.uniform(0.94, 1.05), 3))


def concert():
    """A stage 18 m wide with band, risers, three trusses and stacks of loudspeakers, and the crowd before it."""
    m = Model()
    floor, drape, steel = m.material("floor", (0.07, 0.07, 0.075)), m.material("drapes", (0.10, 0.09, 0.11)), m.material("steel", (0.28, 0.28, 0.30))
    people, cloth, black = m.material("band", (0.26, 0.23, 0.21)), m.material("crowd", (0.16, 0.15, 0.16)), m.material("cabinets", (0.05, 0.05, 0.05))
    m.node("hall", [(floor, box((-18, -0.2, -10.5), (18, 0, 16)))])
    m.node("stage", [(floor, box((-9, 0, -9.5), (9, STAGE, 0)) + box((-1.5, STAGE, -6.9), (1.5, STAGE + 0.6, -4.6)) + box((-9, STAGE, -9.2), (9, STAGE + 0.35, -7.6)))])
    folds = []
    for i in range(80):
        at = lambda j: (-18 + 36 * j / 80, -10 + 0.22 * math.sin(1.9 * j) + 0.1 * math.sin(0.7 * j))
        (xa, za), (xb, zb) = at(i), at(i + 1)
        folds += quad((xa, 0, za), (xb, 0, zb), (xb, 10, zb), (xa, 10, za))
    m.node("drapes", [(drape, folds)])
    m.node("truss", [(steel, truss(8.1, 0.6) + truss(8.3, -4) + truss(7.9, -8))])
    towers = []
    for x in (-7.0, 7.0):
        for y in range(6):
            towers += moved(box((-0.7, -0.24, -0.4), (0.7, 0.24, 0.4)), (x, 5.0 + 0.5 * y, 0.4 - 0.06 * (5 - y) ** 1.6), (1, 0, 0), 2.5 * (5 - y))
        towers += box((x - 0.75, 0, 0.1), (x + 0.75, 1.1, 1.0))
    for x in (-4.6, -2.4, 2.2, 4.6):
        towers += box((x - 0.4, STAGE, -4.6), (x + 0.4, STAGE + 1.15, -4.1))
    m.node("loudspeakers", [(black, towers)])
    m.node("barrier", [(steel, box((-8, 1.05, 1.05), (8, 1.12, 1.12)))])
    m.node("band", [(people, band())])
    crowd(m, cloth)
    fixtures = []
    for _, lamps in sorted(LAMPS.items()):
        for lamp in lamps:
            x, y, z = lamp["position"]
            side = 1 if y > 4 else -1  # hung, or standing; clear of the beam
            fixtures += box((x - 0.16, y + 0.3 * side - 0.09, z - 0.16), (x + 0.16, y + 0.3 * side + 0.09, z + 0.16))
    m.node("fixtures", [(black, fixtures)])
    return m


# --- the lighting desk --------------------------------------------------------------------------------------------------

ICE, AMBER = [0.22, 0.55, 1.0], [1.0, 0.52, 0.16]  # the two families: each lamp leans a little away from its own


def sweep(first, second, late):
    """From one target to another and back in four seconds, eased at both ends; late by some seconds of it."""
    rounded = lambda place: [round(c, 2) for c in place]
    return {"keys": [[late, rounded(first)], [late + 2, rounded(second)], [late + 4, rounded(first)]], "interpolation": "smooth", "loop": True}


def tinted(color, k):
    return [round(min(1, c * (1 + k * (0.5 - i / 2))), 3) for i, c in enumerate(color)]


def lamp(name, position, color, intensity, cone, target, **more):
    return {"name": name, "type": "spot", "position": position, "color": color, "intensity": intensity,
            "inner_cone": round(0.7 * cone, 1), "outer_cone": cone, "radius": 0.05, "target": target, **more}


def beams():
    """Eight cold beams from the back truss, over the band into the hall; neighbors follow each other, both halves mirrored."""
    lamps = []
    for k in range(8):
        x = -7 + 2 * k
        side, rank = (1 if x > 0 else -1), abs(k - 3.5)
        lamps.append(lamp(f"beam {k + 1}", [x, 7.6, -8], tinted(ICE, 0.25 * side), 160000, 3,
                          sweep((x * 0.55 + 1.2 * side, 1.4, 1.5), (x * 1.25 + 2.4 * side, 2.4, 7), 0.25 * (rank - 0.5))))
    return lamps


def uplights():
    """Six amber shafts from the floor behind the band, a fan that opens and closes; a profile with a bright core."""
    lamps = []
    for k in range(6):
        x = -6.5 + 2.6 * k
        side = 1 if x > 0 else -1
        lamps.append(lamp(f"floor {k + 1}", [x, STAGE + 0.75, -8.4], tinted(AMBER, 0.15 * side), 600000, 9,
                          sweep((x * 2.0, 12, -5), (x * 0.3 - 1.5 * side, 11, -6), 0.4 * abs(k - 2.5)), ies={"file": "narrow_beam.ies"}))
    return lamps


def patterns():
    """Six spots with gobos from the middle truss, on band and stage, turning as they move."""
    lamps = []
    for k in range(6):
        x, way = -6 + 2.4 * k, 1 if k % 2 else -1
        lamps.append(lamp(f"gobo {k + 1}", [x, 8.0, -4], tinted(AMBER if k in (1, 4) else ICE, -0.2 * way), 52000, 13,
                          sweep((x * 0.9, STAGE, -2.2), (x * 0.55 + 0.6 * way, STAGE, -0.4), 0.5 * (k % 4)),
                          gobo={"image": f"gobo_{'spokes' if k in (1, 4) else 'breakup'}.png", "color_space": "linear",
                                "rotate": {"keys": [[0, 0], [4, 120 * way if k in (1, 4) else 360 * way]], "loop": True}}))
    return lamps


def keys_light():
    """Four soft, warm white lamps from the front truss, one for each musician."""
    places = ((-5.4, (-3.3, -2.4)), (-1.8, (0, -1.7)), (1.8, (0, -1.7)), (5.4, (3.2, -2.7)))
    return [lamp(f"key {k + 1}", [x, 7.8, 0.6], [1.0, 0.80, 0.58], 14000, 11,
                 sweep((tx - 0.2, STAGE + 1.2, tz), (tx + 0.2, STAGE + 1.2, tz + 0.2), k), ies={"file": "downlight.ies"}) for k, (x, (tx, tz)) in enumerate(places)]


LAMPS = {"beams": beams(), "floor": uplights(), "gobos": patterns(), "keys": keys_light()}


def narrow_beam():
    """An IES profile of a beam lamp: candela ~ exp(-(angle / 2.6)^2), with a faint wide skirt."""
    angles = [0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 10, 15, 20, 90]
    candela = [100000 * math.exp(-((a / 2.6) ** 2)) + 800 * math.exp(-a / 6) for a in angles]
    lines = ["IESNA:LM-63-2002", "[TEST] none: a made-up beam, candela ~ exp(-(angle / 2.6)^2) and a skirt", "[MANUFAC] Tyndall", "[LUMCAT] narrow beam",
             "TILT=NONE", f"1 -1 1 {len(angles)} 1 1 2 -0.1 -0.1 0", "1 1 400", " ".join(f"{a:g}" for a in angles), "0", " ".join(f"{c:.4g}" for c in candela)]
    return "\n".join(lines) + "\n"


def scene():
    """The scene file, a lamp a line or two."""
    head = {"$schema": "scene.schema.json", "tyndall": 1,
            "description": "A band, its crowd and 24 moving lamps in haze: beams, gobos, IES profiles, motion blur. Repeats after four seconds. Written by concert.py.",
            "gltf": "concert.glb", "frame_rate": 24, "frames": "1-96", "resolution": [640, 360],
            "camera": {"name": "hall", "position": [-1.1, 2.55, 11.8], "target": [0.15, 4.0, -4], "vertical_fov": 40, "shutter": {"open": -0.25, "close": 0.25}}}
    tail = {"ambient": [0.7, 0.9, 1.7], "media": [{"name": "haze", "type": "noise", "recipe": "../volumes/concert_haze.json"}], "exposure": -4.9}
    lines = [f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in head.items()]
    lamps = ",\n".join(f"    {json.dumps(one)}" for group in ("beams", "floor", "gobos", "keys") for one in LAMPS[group])
    lines.append(f'  "lights": [\n{lamps}\n  ]')
    lines += [f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in tail.items()]
    return "{\n" + ",\n".join(lines) + "\n}\n"


if __name__ == "__main__":
    here = pathlib.Path(__file__).parent
    (here / "gobo_breakup.png").write_bytes(breakup())
    (here / "gobo_spokes.png").write_bytes(spokes())
    (here / "narrow_beam.ies").write_text(narrow_beam())
    (here / "concert.json").write_text(scene())
