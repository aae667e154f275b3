"""Meshes of triangles, and the .glb they are written to: metres, Y up, one mesh a material."""
import dataclasses
import io
import json
import math
import struct

import numpy as np

FACES = [(4, 5, 7, 6), (1, 0, 2, 3), (5, 1, 3, 7), (0, 4, 6, 2), (6, 7, 3, 2), (0, 1, 5, 4)]  # +z -z +x -x +y -y


@dataclasses.dataclass
class Material:
    color: tuple = (0.5, 0.5, 0.5)
    alpha: float = 1  # below 1: BLEND
    emission: tuple = (0, 0, 0)  # nits
    leaf: bool = False  # MASK: a leaf is cut out of each quad


@dataclasses.dataclass
class Mesh:
    """`points` are three a triangle, N x 3 x 3; a leaf's texture coordinates repeat every two triangles."""
    material: Material
    points: np.ndarray


def quads(corners):
    """Two triangles for each of N x 4 x 3 corners."""
    corners = np.asarray(corners, float).reshape(-1, 4, 3)
    return corners[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3, 3)


def box(low, high):
    corner = [[(high if i >> axis & 1 else low)[axis] for axis in range(3)] for i in range(8)]
    return quads([[corner[i] for i in face] for face in FACES])


def inward_box(low, high):
    return box(low, high)[:, ::-1]


def cylinder(base, top, radius, sides=12):
    """A closed cylinder from `base` to `top`."""
    base, top = np.array(base, float), np.array(top, float)
    axis = (top - base) / np.linalg.norm(top - base)
    u = np.cross(axis, (1, 0, 0) if abs(axis[0]) < 0.7 else (0, 1, 0))
    u /= np.linalg.norm(u)
    v = np.cross(axis, u)
    angles = np.arange(sides + 1) * 2 * math.pi / sides
    ring = radius * (np.cos(angles)[:, None] * u + np.sin(angles)[:, None] * v)
    side = quads(np.stack([base + ring[:-1], base + ring[1:], top + ring[1:], top + ring[:-1]], 1))
    ends = [np.stack([np.broadcast_to(at, (sides, 3)), at + first, at + second], 1)
            for at, first, second in [(top, ring[:-1], ring[1:]), (base, ring[1:], ring[:-1])]]
    return np.concatenate([side, *ends])


def sphere(center, radius, rings=10):
    theta = np.linspace(0, math.pi, rings + 1)
    phi = np.linspace(0, 2 * math.pi, 2 * rings + 1)
    t, p = np.meshgrid(theta, phi, indexing="ij")
    shell = np.array(center) + radius * np.stack([np.sin(t) * np.cos(p), np.cos(t), -np.sin(t) * np.sin(p)], -1)
    return quads(np.stack([shell[:-1, :-1], shell[1:, :-1], shell[1:, 1:], shell[:-1, 1:]], 2))


def wall_with_holes(width, height, holes, at):
    """A wall in the plane z = `at`, x from -width/2, y from 0; `holes` are (x0, y0, x1, y1) that do not overlap. It is cut
    into columns at the holes' sides."""
    cuts = sorted({-width / 2, width / 2, *(x for hole in holes for x in (hole[0], hole[2]))})
    corners = []
    for left, right in zip(cuts, cuts[1:]):
        open_parts = sorted((hole[1], hole[3]) for hole in holes if hole[0] <= left and hole[2] >= right)
        bottom = 0
        for low, high in [*open_parts, (height, height)]:
            if low > bottom:
                corners.append([(left, bottom, at), (right, bottom, at), (right, low, at), (left, low, at)])
            bottom = max(bottom, high)
    return quads(corners)


def scattered_quads(chance, count, low, high, size):
    """Quads of about `size`, turned any way, with centres in a box or, given a function, where it says."""
    numbers = np.random.default_rng(chance.getrandbits(32))
    centers = numbers.uniform(low, high, (count, 3))
    u = numbers.normal(size=(count, 3))
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    v = np.cross(u, numbers.normal(size=(count, 3)))
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    half = size * numbers.uniform(0.5, 1, (count, 1)) / 2
    u, v = u * half, v * half
    return quads(np.stack([centers - u - v, centers + u - v, centers + u + v, centers - u + v], 1))


def leaf_picture():
    """A PNG of 64 x 64 with a leaf's outline as alpha."""
    from PIL import Image
    y, x = np.mgrid[0:64, 0:64] / 31.5 - 1
    inside = (np.abs(x) < 0.55 * np.cos(y * math.pi / 2)) & (np.abs(y) < 0.95)
    pixels = np.zeros((64, 64, 4), np.uint8)
    pixels[..., :3], pixels[..., 3] = (110, 150, 70), 255 * inside
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "PNG")
    return file.getvalue()


def gltf_material(material):
    result = {"pbrMetallicRoughness": {"baseColorFactor": [*material.color, material.alpha], "metallicFactor": 0},
              "doubleSided": True}
    if material.alpha < 1:
        result["alphaMode"] = "BLEND"
    if material.leaf:
        result["alphaMode"] = "MASK"
        result["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
    brightest = max(material.emission)
    if brightest > 0:
        result["emissiveFactor"] = [channel / brightest for channel in material.emission]
        result["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": brightest}}
    return result


def write_glb(meshes, path, offset=None):
    """Flat shaded; the same points give the same bytes. `offset` moves the node."""
    parts, accessors, primitives = [], [], []

    def append(rows, kind):
        parts.append(rows.astype("<f4").tobytes())
        accessors.append({"bufferView": len(parts) - 1, "componentType": 5126, "count": len(rows), "type": kind})
        return len(accessors) - 1

    for index, mesh in enumerate(meshes):
        points = mesh.points.reshape(-1, 3)
        edges = mesh.points[:, 1:] - mesh.points[:, :1]
        normals = np.cross(edges[:, 0], edges[:, 1])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
        attributes = {"POSITION": append(points, "VEC3"), "NORMAL": append(np.repeat(normals, 3, 0), "VEC3")}
        accessors[attributes["POSITION"]] |= {"min": points.min(0).tolist(), "max": points.max(0).tolist()}
        if mesh.material.leaf:
            corners = np.array([(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1)], float)
            attributes["TEXCOORD_0"] = append(np.tile(corners, (len(points) // 6, 1)), "VEC2")
        primitives.append({"attributes": attributes, "material": index})
    leaves = any(mesh.material.leaf for mesh in meshes)
    if leaves:
        picture = leaf_picture()
        parts.append(picture + b"\0" * (-len(picture) % 4))
    starts = [sum(map(len, parts[:i])) for i in range(len(parts))]
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0} | ({"translation": list(offset)} if offset else {})],
        "meshes": [{"primitives": primitives}], "materials": [gltf_material(mesh.material) for mesh in meshes],
        "accessors": accessors, "buffers": [{"byteLength": sum(map(len, parts))}],
        "bufferViews": [{"buffer": 0, "byteOffset": s, "byteLength": len(p)} for s, p in zip(starts, parts)]}
    if any(max(mesh.material.emission) > 0 for mesh in meshes):
        document["extensionsUsed"] = ["KHR_materials_emissive_strength"]
    if leaves:
        document |= {"textures": [{"source": 0}],
                     "images": [{"bufferView": len(parts) - 1, "mimeType": "image/png"}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    blob = b"".join(parts)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(blob), 0x004E4942) + blob
    path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks)
