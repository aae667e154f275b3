#!/usr/bin/env python3
"""Makes the .glb models of the example scenes: python3 scenes/make_geometry.py [names]. Y up, meters."""
import json
import math
import pathlib
import random
import struct
import sys


class Model:
    """Triangles by material and node, written as one GLB."""

    def __init__(self):
        self.materials, self.nodes, self.animations, self.images = [], [], [], []

    def material(self, name, color, emission=None, leaf=None, alpha=1):
        """leaf: the bytes of a PNG whose alpha cuts out what is there, seen from both sides; one PNG may serve several."""
        entry = {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*color, alpha], "metallicFactor": 0}}
        if alpha < 1:
            entry.update(alphaMode="BLEND", doubleSided=True)
        if emission:
            peak = max(emission)
            entry["emissiveFactor"] = [c / peak for c in emission]
            entry["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": peak}}
        if leaf:
            if leaf not in self.images:
                self.images.append(leaf)
            entry["pbrMetallicRoughness"]["baseColorTexture"] = {"index": self.images.index(leaf)}
            entry.update(alphaMode="MASK", doubleSided=True)
        self.materials.append(entry)
        return len(self.materials) - 1

    def node(self, name, parts, translation=(0, 0, 0), spin=None, path=None, turn=0, scale=1, matrix=None):
        """parts: list of (material, triangles), a mesh that nodes given the same list share; spin: (axis, [(seconds, degrees),
        ...]) animates the rotation, path: [(seconds, place, scale), ...] the rest; turn: degrees about Y; matrix: in place of all that."""
        self.nodes.append({"name": name, "parts": parts, "translation": list(translation), "spin": spin, "path": path,
                           "turn": turn, "scale": scale, "matrix": matrix})

    def write(self, path):
        blob, views, accessors, meshes, nodes = bytearray(), [], [], [], []

        def accessor(values, kind, component="f", limits=False):
            flat = [x for v in values for x in v] if kind != "SCALAR" else list(values)
            while len(blob) % 4:
                blob.append(0)
            views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": 4 * len(flat)})
            blob.extend(struct.pack(f"<{len(flat)}{component}", *flat))
            entry = {"bufferView": len(views) - 1, "componentType": 5126 if component == "f" else 5125,
                     "count": len(values), "type": kind}
            if limits:
                rows = values if kind != "SCALAR" else [(v,) for v in values]
                packed = [struct.unpack(f"<{len(r)}f", struct.pack(f"<{len(r)}f", *r)) for r in rows]
                entry["min"] = [min(c) for c in zip(*packed)]
                entry["max"] = [max(c) for c in zip(*packed)]
            accessors.append(entry)
            return len(accessors) - 1

        def primitive(material, triangles):
            points, index = {}, []
            for triangle in triangles:
                for vertex in triangle:
                    key = tuple(round(c, 6) for part in vertex for c in part)
                    index.append(points.setdefault(key, len(points)))
            rows = list(points)
            entry = {"material": material, "indices": accessor(index, "SCALAR", "I"),
                     "attributes": {"POSITION": accessor([r[:3] for r in rows], "VEC3", limits=True),
                                    "NORMAL": accessor([r[3:6] for r in rows], "VEC3")}}
            if len(rows[0]) > 6:
                entry["attributes"]["TEXCOORD_0"] = accessor([r[6:] for r in rows], "VEC2")
            return entry

        samplers, channels, known = [], [], {}

        def animate(path, times, values, kind):
            samplers.append({"input": times, "output": accessor(values, kind), "interpolation": "LINEAR"})
            channels.append({"sampler": len(samplers) - 1, "target": {"node": len(nodes) - 1, "path": path}})

        for node in self.nodes:
            if id(node["parts"]) not in known:
                known[id(node["parts"])] = len(meshes)
                meshes.append({"name": node["name"], "primitives": [primitive(*part) for part in node["parts"]]})
            nodes.append({"name": node["name"], "mesh": known[id(node["parts"])]})
            nodes[-1].update({"matrix": node["matrix"]} if node["matrix"] else {"translation": node["translation"]})
            if node["turn"]:
                half = math.radians(node["turn"]) / 2
                nodes[-1]["rotation"] = [0, round(math.sin(half), 6), 0, round(math.cos(half), 6)]
            if node["scale"] != 1:
                nodes[-1]["scale"] = [node["scale"]] * 3
            if node["spin"]:
                axis, keys = node["spin"]
                times = accessor([k[0] for k in keys], "SCALAR", limits=True)
                half = [math.radians(k[1]) / 2 for k in keys]
                animate("rotation", times, [(*(math.sin(h) * a for a in axis), math.cos(h)) for h in half], "VEC4")
            if node["path"]:
                times = accessor([k[0] for k in node["path"]], "SCALAR", limits=True)
                animate("translation", times, [k[1] for k in node["path"]], "VEC3")
                animate("scale", times, [(k[2],) * 3 for k in node["path"]], "VEC3")
        images = []
        for png in self.images:
            blob.extend(b"\0" * (-len(blob) % 4))
            images.append({"mimeType": "image/png", "bufferView": len(views)})
            views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(png)})
            blob.extend(png)
        document = {"asset": {"version": "2.0", "generator": "tyndall make_geometry.py"}, "scene": 0,
                    "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": meshes,
                    "materials": self.materials, "accessors": accessors, "bufferViews": views,
                    "buffers": [{"byteLength": len(blob)}]}
        if any("extensions" in m for m in self.materials):
            document["extensionsUsed"] = ["KHR_materials_emissive_strength"]
        if images:
            document.update(images=images, textures=[{"source": i} for i in range(len(images))])
        if channels:
            document["animations"] = [{"name": "motion", "samplers": samplers, "channels": channels}]
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        blob.extend(b"\0" * (-len(blob) % 4))
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(blob), 0x004E4942) + blob
        path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks)
        print(f"{path}: {path.stat().st_size} bytes, {sum(len(t) for n in self.nodes for _, t in n['parts'])} triangles")


# --- shapes: lists of triangles, each three (position, normal) ---------------------------------------------------

def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(v):
    length = math.sqrt(sum(c * c for c in v))
    return tuple(c / length for c in v)


def add(a, b, k=1.0):
    return tuple(p + k * q for p, q in zip(a, b))


def quad(a, b, c, d, normals=None):
    if normals is None:
        n = unit(cross([q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, d)]))
        normals = (n, n, n, n)
    return [((a, normals[0]), (b, normals[1]), (c, normals[2])), ((a, normals[0]), (c, normals[2]), (d, normals[3]))]


def box(low, high):
    (x0, y0, z0), (x1, y1, z1) = low, high
    corners = {k: (x1 if k & 1 else x0, y1 if k & 2 else y0, z1 if k & 4 else z0) for k in range(8)}
    faces = [(4, 5, 7, 6), (1, 0, 2, 3), (5, 1, 3, 7), (0, 4, 6, 2), (6, 7, 3, 2), (0, 1, 5, 4)]
    return [t for f in faces for t in quad(*(corners[k] for k in f))]


def moved(triangles, offset=(0, 0, 0), turn=(0, 1, 0), degrees=0.0):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))

    def turned(v):  # Rodrigues
        k, d = cross(turn, v), sum(a * b for a, b in zip(turn, v))
        return tuple(v[i] * c + k[i] * s + turn[i] * d * (1 - c) for i in range(3))

    return [tuple((tuple(p + o for p, o in zip(turned(v), offset)), turned(n), *uv) for v, n, *uv in t) for t in triangles]


def lathe(profile, sides, hole=None, inward=False):
    """Turns (radius, height) points about Y; hole(x, y) in patches around and up says where there is nothing, and which
    way patches there are cut in two."""
    result, sign = [], -1 if inward else 1
    for ring in range(len(profile) - 1):
        (r0, y0), (r1, y1) = profile[ring], profile[ring + 1]
        slope = unit((y1 - y0, r0 - r1, 0))
        for side in range(sides):
            a0, a1 = 2 * math.pi * side / sides, 2 * math.pi * (side + 1) / sides
            at = lambda r, y, a: (r * math.cos(a), y, -r * math.sin(a))
            normal = lambda a: tuple(sign * c for c in (slope[0] * math.cos(a), slope[1], -slope[0] * math.sin(a)))
            corners = [at(r0, y0, a0), at(r0, y0, a1), at(r1, y1, a1), at(r1, y1, a0)]
            normals = [normal(a0), normal(a1), normal(a1), normal(a0)]
            rising = hole is not None and hole(side + 0.5, ring + 0.5)[1]
            if rising:  # cut from the other corner
                corners, normals = corners[1:] + corners[:1], normals[1:] + normals[:1]
            halves = quad(*corners, normals)
            if hole is not None:
                place = {0: (0, 0), 1: (1, 0), 2: (1, 1), 3: (0, 1)}
                order = [1, 2, 3, 0] if rising else [0, 1, 2, 3]
                middles = [[sum(place[order[k]][c] for k in ks) / 3 for c in (0, 1)] for ks in ((0, 1, 2), (0, 2, 3))]
                halves = [h for h, m in zip(halves, middles) if not hole(side + m[0], ring + m[1])[0]]
            if inward:
                halves = [t[::-1] for t in halves]
            result += [t for t in halves if area(t) > 1e-10]
    return result


def area(triangle):
    a, b, c = (v[0] for v in triangle)
    n = cross([q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)])
    return 0.5 * math.sqrt(sum(x * x for x in n))


def limb(places, radii, sides):
    """A tapered tube along places, open at its ends."""
    rings, axis = [], unit(add(places[-1], places[0], -1))
    across = unit(cross(axis, (0.3, 0.1, 0.9)))
    deep = cross(axis, across)
    for place, radius in zip(places, radii):
        ring = []
        for k in range(sides):
            a = 2 * math.pi * k / sides
            out = add(tuple(c * math.cos(a) for c in across), deep, math.sin(a))
            ring.append((add(place, out, radius), out))
        rings.append(ring)
    triangles = []
    for low, high in zip(rings, rings[1:]):
        for k in range(sides):
            n = (k + 1) % sides
            triangles += [(low[k], low[n], high[n]), (low[k], high[n], high[k])]
    return triangles


def sphere(radius, center, sides=32, rings=16):
    profile = [(radius * math.sin(math.pi * i / rings), -radius * math.cos(math.pi * i / rings)) for i in range(rings + 1)]
    return moved(lathe(profile, sides), center)


def rough(triangles, size, amount, seed, along=(1, 1, 1)):
    """Moved by a few waves some `size` long, and shaded smoothly; `along` scales the movement by axis."""
    chance = random.Random(seed)
    waves = [([chance.gauss(0, 1) * 2.5 / size / 2 ** (i / 3) for _ in range(3)], chance.uniform(0, 6.3),
              [chance.gauss(0, 1) for _ in range(3)]) for i in range(8)]

    def place(p):
        shift = [0, 0, 0]
        for k, phase, way in waves:
            s = math.sin(sum(a * b for a, b in zip(k, p)) + phase) * amount / math.sqrt(len(waves))
            shift = [c + s * w * a for c, w, a in zip(shift, way, along)]
        return tuple(c + d for c, d in zip(p, shift))

    return smooth([[place(v) for v, _ in t] for t in triangles])


def smooth(faces):
    """Triangles of corners with the mean normals of the faces that meet in each."""
    key = lambda p: tuple(round(c, 5) for c in p)
    sums, kept = {}, []
    for a, b, c in faces:
        n = cross([q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)])
        if sum(x * x for x in n) < 1e-16:
            continue
        kept.append((a, b, c))
        for corner in (a, b, c):
            sums[key(corner)] = [x + y for x, y in zip(sums.get(key(corner), (0, 0, 0)), n)]
    return [tuple((corner, unit(sums[key(corner)])) for corner in t) for t in kept]


def between(triangles, low, high):
    """What stands on the y axis from 0 to 1, put from one place to another."""
    way = [b - a for a, b in zip(low, high)]
    length = math.sqrt(sum(c * c for c in way))
    axis = cross((0, 1, 0), [c / length for c in way])
    sine = math.sqrt(sum(c * c for c in axis))
    tall = [tuple(((p[0], p[1] * length, p[2]), n) for p, n in t) for t in triangles]
    if sine < 1e-6:
        return moved(tall, low)
    return moved(tall, low, tuple(c / sine for c in axis), math.degrees(math.atan2(sine, way[1] / length)))


# --- the scenes -----------------------------------------------------------------------------------------------------

def window():
    """A room of 6 x 3.4 x 8 m; two tall windows with slatted blinds in its left wall."""
    m = Model()
    plaster = m.material("plaster", (0.62, 0.57, 0.50))
    boards = m.material("floor boards", (0.33, 0.22, 0.14))
    wood = m.material("painted wood", (0.55, 0.50, 0.44))
    dark = m.material("dark wood", (0.16, 0.10, 0.07))
    cloth = m.material("cloth", (0.45, 0.12, 0.09))
    x0, x1, y1, z0, z1 = -3.0, 3.0, 3.4, -4.0, 4.0
    shell = box((x0, y1, z0), (x1, y1 + 0.2, z1)) + box((x0, -0.2, z0 - 0.2), (x1, y1, z0))
    shell += box((x0, -0.2, z1), (x1, y1, z1 + 0.2)) + box((x1, -0.2, z0 - 0.2), (x1 + 0.2, y1 + 0.2, z1 + 0.2))
    openings = [(-2.6, -1.2), (-0.2, 1.2)]  # along z
    sill, top = 0.75, 2.75
    edges = [z0 - 0.2] + [z for o in openings for z in o] + [z1 + 0.2]
    for a, b in zip(edges[::2], edges[1::2]):
        shell += box((x0 - 0.25, -0.2, a), (x0, y1 + 0.2, b))
    for a, b in openings:
        shell += box((x0 - 0.25, -0.2, a), (x0, sill, b)) + box((x0 - 0.25, top, a), (x0, y1 + 0.2, b))
    m.node("walls", [(plaster, shell)])

    floor = []
    for i in range(15):  # boards along z with hair-wide gaps
        floor += box((x0 + 0.4 * i + 0.004, -0.2, z0), (x0 + 0.4 * (i + 1) - 0.004, 0, z1))
    m.node("floor", [(boards, floor + box((x0 - 0.2, -0.3, z0 - 0.2), (x1 + 0.2, -0.05, z1 + 0.2)))])

    frames, slats = [], []
    for a, b in openings:
        frames += box((x0 - 0.06, sill - 0.04, a - 0.06), (x0 + 0.12, sill, b + 0.06))
        middle = 0.5 * (a + b)
        frames += box((x0 - 0.2, sill, middle - 0.03), (x0 - 0.14, top, middle + 0.03))
        frames += box((x0 - 0.2, 2.05, a), (x0 - 0.14, 2.11, b))
        for i in range(13):
            y = sill + 0.09 + i * (top - sill - 0.12) / 13
            slat = box((-0.045, -0.004, a + 0.01), (0.045, 0.004, b - 0.01))
            slats += moved(slat, (x0 - 0.07, y, 0), (0, 0, 1), 24)
    m.node("window frames", [(wood, frames)])
    m.node("blinds", [(wood, slats)])

    table = box((-0.7, 0.70, -0.45), (0.7, 0.75, 0.45))
    for x in (-0.62, 0.62):
        for z in (-0.38, 0.38):
            table += box((x - 0.035, 0, z - 0.035), (x + 0.035, 0.70, z + 0.035))
    chair = box((-0.22, 0.42, -0.22), (0.22, 0.46, 0.22)) + box((-0.22, 0.46, 0.18), (0.22, 0.98, 0.22))
    for x in (-0.2, 0.2):
        for z in (-0.2, 0.2):
            chair += box((x - 0.02, 0, z - 0.02), (x + 0.02, 0.42, z + 0.02))
    m.node("table", [(dark, table)], (0.55, 0, -1.3))
    m.node("chair", [(dark, moved(chair, (1.65, 0, -1.15), (0, 1, 0), 70))])
    vase = lathe([(0.001, 0), (0.07, 0.0), (0.11, 0.08), (0.12, 0.16), (0.08, 0.26), (0.05, 0.31), (0.06, 0.34)], 24)
    books = box((-0.16, 0, -0.11), (0.16, 0.04, 0.11)) + moved(box((-0.14, 0.04, -0.1), (0.14, 0.075, 0.1)), (0, 0, 0), (0, 1, 0), 17)
    m.node("vase", [(cloth, moved(vase, (0.3, 0.75, -1.4)))])
    m.node("books", [(cloth, moved(books, (0.85, 0.75, -1.2), (0, 1, 0), 25))])
    shelf = box((2.62, 0, -3.6), (2.66, 2.1, -2.0)) + box((2.96, 0, -3.6), (3.0, 2.1, -2.0))
    for y in (0.1, 0.6, 1.1, 1.6, 2.06):
        shelf += box((2.62, y, -3.6), (3.0, y + 0.04, -2.0))
    m.node("shelf", [(dark, shelf)])
    return m


def spotlight():
    """A stage 14 m wide: risers, a pedestal with a sphere, standing figures, a truss."""
    m = Model()
    floor = m.material("stage floor", (0.10, 0.10, 0.11))
    curtain = m.material("curtain", (0.20, 0.03, 0.04))
    steel = m.material("steel", (0.35, 0.35, 0.37))
    figure = m.material("figures", (0.30, 0.28, 0.26))
    m.node("stage", [(floor, box((-9, -0.3, -6), (9, 0, 7)) + box((-3, 0, -3.4), (3, 0.35, -1)) + box((-1.6, 0.35, -3), (1.6, 0.7, -1.4)))])
    folds = []
    for i in range(72):  # a wavy curtain
        at = lambda j: (-9 + 0.25 * j, -5.2 + 0.16 * math.sin(1.9 * j) + 0.08 * math.sin(0.7 * j))
        (xa, za), (xb, zb) = at(i), at(i + 1)
        folds += quad((xa, 0, za), (xb, 0, zb), (xb, 7, zb), (xa, 7, za))
    m.node("curtain", [(curtain, folds)])
    truss = []
    for y in (5.6, 5.95):
        for z in (-0.2, 0.15):
            truss += box((-8, y - 0.03, z - 0.03), (8, y + 0.03, z + 0.03))
    for i in range(32):
        x = -7.75 + 0.5 * i
        truss += moved(box((-0.015, -0.22, -0.015), (0.015, 0.22, 0.015)), (x, 5.775, -0.02), (0, 0, 1), 40 if i % 2 else -40)
    for x in (-5, -2.5, 0, 2.5, 5):  # housings behind the lights, open below
        truss += moved(lathe([(0.13, -0.05), (0.16, 0.25), (0.05, 0.4)], 16), (x, 5.35, 0))
    m.node("truss", [(steel, truss)])
    pedestal = lathe([(0.45, 0.7), (0.45, 0.78), (0.3, 0.85), (0.28, 1.5), (0.4, 1.56), (0.4, 1.62), (0.001, 1.62)], 32)
    m.node("pedestal", [(steel, moved(pedestal, (0, 0, -2.2)) + sphere(0.45, (0, 2.07, -2.2)))])
    person = lathe([(0.16, 0), (0.14, 0.4), (0.17, 0.85), (0.15, 1.05), (0.21, 1.38), (0.17, 1.48), (0.06, 1.52)], 20) + sphere(0.12, (0, 1.66, 0), 20, 12)
    people = []
    for x, z, turn in ((-4.2, -0.8, 20), (-2.6, 0.4, 70), (2.9, 0.2, -40), (4.6, -1.2, 10)):
        people += moved(person, (x, 0, z), (0, 1, 0), turn)
    m.node("figures", [(figure, people)])
    return m


def pillars():
    """Two rows of columns on a terrace, with bases, capitals and a lintel."""
    m = Model()
    stone = m.material("stone", (0.50, 0.46, 0.40))
    ground = m.material("ground", (0.20, 0.19, 0.15))
    m.node("ground", [(ground, quad((-120, 0, 60), (120, 0, 60), (120, 0, -160), (-120, 0, -160)))])
    steps = box((-7.5, 0, -42), (7.5, 0.15, 6)) + box((-7, 0.15, -41.5), (7, 0.3, 5.5))
    m.node("terrace", [(stone, steps)])
    shaft = [(0.55, 0.5), (0.56, 1.5), (0.54, 3.5), (0.47, 6.0)]
    column = box((-0.75, 0.3, -0.75), (0.75, 0.48, 0.75)) + lathe([(0.72, 0.48), (0.74, 0.54), (0.62, 0.64), (0.55, 0.68)] + shaft[1:] + [(0.6, 6.12), (0.72, 6.3)], 28)
    column += box((-0.8, 6.3, -0.8), (0.8, 6.5, 0.8))
    rows = []
    for i in range(9):
        for x in (-5.2, 5.2):
            if (i, x) in ((3, 5.2), (6, -5.2)):  # broken ones
                rows += moved(box((-0.75, 0.3, -0.75), (0.75, 0.48, 0.75)) + lathe([(0.72, 0.48), (0.55, 0.68), (0.56, 1.4), (0.42, 1.62), (0.001, 1.55)], 28), (x, 0, 2 - 5 * i))
                continue
            rows += moved(column, (x, 0, 2 - 5 * i))
    m.node("columns", [(stone, rows)])
    m.node("lintels", [(stone, box((4.5, 6.5, -39), (5.9, 7.3, -13.7)) + box((-5.9, 6.5, -26.3), (-4.5, 7.3, 2.8)))])
    drum = moved(lathe([(0.001, 0), (0.54, 0), (0.54, 1.7), (0.001, 1.7)], 28), (0, 0, 0), (0, 0, 1), 90)
    m.node("fallen drums", [(stone, moved(drum, (2.6, 0.84, -9.2), (0, 1, 0), 25) + moved(drum, (-2.2, 0.84, -17.5), (0, 1, 0), -55))])
    return m


def lantern():
    """A perforated brass lamp that turns slowly on a table in a small dark room."""
    m = Model()
    wall = m.material("walls", (0.48, 0.42, 0.36))
    wood = m.material("table", (0.22, 0.13, 0.08))
    brass = m.material("brass", (0.45, 0.30, 0.12))
    m.node("room", [(wall, box((-2.6, -0.1, -2.3), (2.6, 0, 2.6)) + box((-2.6, 0, -2.4), (2.6, 2.9, -2.3)) +
                     box((-2.7, 0, -2.3), (-2.6, 2.9, 2.6)) + box((2.6, 0, -2.3), (2.7, 2.9, 2.6)) + box((-2.6, 2.9, -2.3), (2.6, 3.0, 2.6)) +
                     box((-2.6, 0, 2.6), (2.6, 2.9, 2.7)))])
    table = moved(lathe([(0.001, 0.72), (0.72, 0.72), (0.74, 0.74), (0.72, 0.76), (0.001, 0.76)], 48), (0, 0, 0))
    table += lathe([(0.3, 0), (0.26, 0.04), (0.06, 0.1), (0.05, 0.72)], 24)
    m.node("table", [(wood, table)])

    rings, sides, radius, squash = 44, 120, 0.26, 1.15
    profile = [(radius * math.sin(math.pi * i / rings), -squash * radius * math.cos(math.pi * i / rings)) for i in range(rings + 1)]

    def diamond(x, y):  # rows of diamonds, every other row shifted by half; patches are cut along their edges
        band = (y - 6) // 8
        if not 0 <= band < 4:
            return False, False
        across, up = (x + (5 if band % 2 else 0)) % 10 - 5, (y - 6) % 8 - 4
        return abs(across) + abs(up) < 3, across * up > 0

    shell = lathe(profile, sides, diamond) + lathe([(0.97 * r, 0.97 * y) for r, y in profile], sides, diamond, inward=True)
    foot = lathe([(0.17, -0.40), (0.15, -0.36), (0.07, -0.32), (0.06, -0.29)], 32)
    knob = lathe([(0.05, 0.29), (0.03, 0.32), (0.045, 0.35), (0.001, 0.40)], 24)
    m.node("lantern", [(brass, shell + foot + knob)], (0, 1.16, 0), ((0, 1, 0), [(0, 0), (2, 45), (4, 90), (6, 135), (8, 180)]))
    cup = lathe([(0.001, 0.76), (0.05, 0.76), (0.06, 0.86), (0.055, 0.86), (0.045, 0.77)], 24)
    m.node("cup", [(brass, moved(cup, (0.48, 0, 0.26)))])
    frame = box((-0.5, 1.5, -2.29), (0.5, 2.2, -2.26))
    m.node("picture", [(wood, moved(frame, (1.35, 0, 0)))])
    return m


if __name__ == "__main__":
    from campfire import campfire
    from concert import concert
    from forest import forest_morning
    from pbrt_models import explosion_ground, matchbulb

    makers = {"window": window, "spotlight": spotlight, "pillars": pillars, "lantern": lantern, "campfire": campfire,
              "forest_morning": forest_morning, "concert": concert, "pbrt/matchbulb": matchbulb, "pbrt/ground": explosion_ground}
    for name in sys.argv[1:] or makers:
        makers[name]().write(pathlib.Path(__file__).parent / f"{name}.glb")
