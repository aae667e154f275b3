"""Meshes of triangles, and the .glb they are written to: meters, Y up, one mesh a material."""
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
class Deformation:
    """Within so many seconds a morph target takes the mesh to other points, or a joint turns what is above its pivot: the
    more, the higher, up to `height` above it."""
    seconds: float
    target: np.ndarray = None
    pivot: tuple = None
    height: float = 1
    turn: tuple = None  # a quaternion: x, y, z, w


@dataclasses.dataclass
class Mesh:
    """`points` are three a triangle, N x 3 x 3; a leaf's texture coordinates repeat every two triangles."""
    material: Material
    points: np.ndarray
    deformation: Deformation = None
    name: str = None  # of a node of its own


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
    """Quads of about `size`, turned any way, with centers in a box or, given a function, where it says."""
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


def flat_normals(triangles):
    edges = triangles[:, 1:] - triangles[:, :1]
    normals = np.cross(edges[:, 0], edges[:, 1])
    return np.repeat(normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30), 3, 0)


class Glb:
    """A binary glTF document as it grows: node 0 holds all others."""

    def __init__(self, offset):
        self.parts, self.accessors, self.animation = [], [], {"samplers": [], "channels": []}
        self.nodes, self.meshes, self.skins = [{"children": []} | ({"translation": list(offset)} if offset else {})], [], []

    def append(self, rows, kind, component=5126, ends=False):
        rows = np.asarray(rows)
        self.parts.append(rows.astype({5126: "<f4", 5123: "<u2"}[component]).tobytes())
        accessor = {"bufferView": len(self.parts) - 1, "componentType": component, "count": len(rows), "type": kind}
        if ends:
            rows = rows.reshape(len(rows), -1)
            accessor |= {"min": rows.min(0).tolist(), "max": rows.max(0).tolist()}
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def node(self, **node):
        self.nodes.append(node)
        self.nodes[0]["children"].append(len(self.nodes) - 1)
        return len(self.nodes) - 1

    def animate(self, node, path, seconds, values, kind):
        self.animation["samplers"].append({"input": self.append([0, seconds], "SCALAR", ends=True),
                                           "output": self.append(values, kind)})
        self.animation["channels"].append({"sampler": len(self.animation["samplers"]) - 1,
                                           "target": {"node": node, "path": path}})

    def primitive(self, mesh, material):
        points = mesh.points.reshape(-1, 3)
        attributes = {"POSITION": self.append(points, "VEC3", ends=True), "NORMAL": self.append(flat_normals(mesh.points), "VEC3")}
        if mesh.material.leaf:
            corners = np.array([(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1)], float)
            attributes["TEXCOORD_0"] = self.append(np.tile(corners, (len(points) // 6, 1)), "VEC2")
        return {"attributes": attributes, "material": material}

    def deforming(self, mesh, primitive):
        """A node of its own, with the keys of its target or joint."""
        how, points = mesh.deformation, mesh.points.reshape(-1, 3)
        self.meshes.append({"primitives": [primitive]})
        node = self.node(mesh=len(self.meshes) - 1)
        if how.target is not None:
            moved = how.target.reshape(-1, 3) - points
            turned = flat_normals(how.target) - flat_normals(mesh.points)
            primitive["targets"] = [{"POSITION": self.append(moved, "VEC3", ends=True), "NORMAL": self.append(turned, "VEC3")}]
            self.animate(node, "weights", how.seconds, [0, 1], "SCALAR")
            return
        still, joint = self.node(), self.node(translation=list(how.pivot))
        back = np.eye(4)
        back[3, :3] = [-part for part in how.pivot]  # columns follow one another
        share = np.clip((points[:, 1] - how.pivot[1]) / how.height, 0, 1)
        none = np.zeros_like(share)
        primitive["attributes"] |= {
            "JOINTS_0": self.append(np.tile([0, 1, 0, 0], (len(points), 1)), "VEC4", 5123),
            "WEIGHTS_0": self.append(np.stack([1 - share, share, none, none], 1), "VEC4")}
        self.skins.append({"joints": [still, joint], "inverseBindMatrices": self.append(np.stack([np.eye(4), back]).reshape(2, 16), "MAT4")})
        self.nodes[node]["skin"] = len(self.skins) - 1
        self.animate(joint, "rotation", how.seconds, [(0, 0, 0, 1), how.turn], "VEC4")


def write_glb(meshes, path, offset=None):
    """Flat shaded; the same points give the same bytes. `offset` moves all of them."""
    glb = Glb(offset)
    primitives = [glb.primitive(mesh, index) for index, mesh in enumerate(meshes)]
    still = [primitive for mesh, primitive in zip(meshes, primitives) if not (mesh.deformation or mesh.name)]
    if still:
        glb.meshes.append({"primitives": still})
        glb.nodes[0]["mesh"] = 0
    for mesh, primitive in zip(meshes, primitives):
        if mesh.deformation:
            glb.deforming(mesh, primitive)
        elif mesh.name:
            glb.meshes.append({"primitives": [primitive]})
            glb.node(mesh=len(glb.meshes) - 1, name=mesh.name)
    leaves = any(mesh.material.leaf for mesh in meshes)
    if leaves:
        picture = leaf_picture()
        glb.parts.append(picture + b"\0" * (-len(picture) % 4))
    starts = [sum(map(len, glb.parts[:i])) for i in range(len(glb.parts))]
    lists = {"skins": glb.skins, "animations": [glb.animation] if glb.animation["channels"] else []}
    if not glb.nodes[0]["children"]:
        del glb.nodes[0]["children"]
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": glb.nodes, "meshes": glb.meshes,
        "materials": [gltf_material(mesh.material) for mesh in meshes],
        "accessors": glb.accessors, "buffers": [{"byteLength": sum(map(len, glb.parts))}],
        "bufferViews": [{"buffer": 0, "byteOffset": s, "byteLength": len(p)} for s, p in zip(starts, glb.parts)]}
    document |= {name: rows for name, rows in lists.items() if rows}
    if any(max(mesh.material.emission) > 0 for mesh in meshes):
        document["extensionsUsed"] = ["KHR_materials_emissive_strength"]
    if leaves:
        document |= {"textures": [{"source": 0}],
                     "images": [{"bufferView": len(glb.parts) - 1, "mimeType": "image/png"}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    blob = b"".join(glb.parts)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(blob), 0x004E4942) + blob
    path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks)
