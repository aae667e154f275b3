"""The boxes and the moving ball of a scene as a .glb: a primitive for every material, a node that moves for the ball."""
import json
import struct

import numpy as np

from mesh import box_mesh, sphere_mesh

FLOATS, INDICES = 5126, 5125  # glTF's componentType
FRAME = 1 / 24  # seconds


class Parts:
    """The binary chunk and what points into it."""

    def __init__(self):
        self.blob, self.views, self.accessors = b"", [], []

    def add(self, array, kind, component):
        data = np.ascontiguousarray(array, np.float32 if component == FLOATS else np.uint32)
        self.views.append({"buffer": 0, "byteOffset": len(self.blob), "byteLength": data.nbytes})
        self.blob += data.tobytes()
        rows = data.reshape(len(data), -1)
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": component, "count": len(data), "type": kind,
                               "min": rows.min(0).tolist(), "max": rows.max(0).tolist()})
        return len(self.accessors) - 1

    def primitive(self, mesh, material):
        points, normals, triangles = mesh
        return {"attributes": {"POSITION": self.add(points, "VEC3", FLOATS), "NORMAL": self.add(normals, "VEC3", FLOATS)},
                "indices": self.add(triangles.reshape(-1), "SCALAR", INDICES), "material": material}


def material_of(color, emission):
    result = {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": 0}}
    if emission:
        result |= {"emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": emission}}}
    return result


def moving_node(parts, sphere, document):
    """The ball is half way at frame 1, and the shutter is open from half a frame before to half a frame after."""
    document["meshes"].append({"primitives": [parts.primitive(sphere_mesh(sphere.radius), len(document["materials"]))]})
    document["materials"].append(material_of((0, 0, 0), 0))
    document["nodes"].append({"mesh": len(document["meshes"]) - 1})
    center, motion = np.array(sphere.center), np.array(sphere.motion)
    sampler = {"input": parts.add([0, 2 * FRAME], "SCALAR", FLOATS), "interpolation": "LINEAR",
               "output": parts.add([center - motion, center + motion], "VEC3", FLOATS)}
    target = {"node": len(document["nodes"]) - 1, "path": "translation"}
    document["animations"] = [{"samplers": [sampler], "channels": [{"sampler": 0, "target": target}]}]


def write(boxes, sphere, path):
    parts, document = Parts(), {"asset": {"version": "2.0"}, "scene": 0, "nodes": [], "meshes": [], "materials": []}
    primitives = []
    for kind in dict.fromkeys((tuple(box.color), box.emission) for box in boxes):
        alike = [box for box in boxes if (tuple(box.color), box.emission) == kind]
        primitives.append(parts.primitive(box_mesh(alike), len(document["materials"])))
        document["materials"].append(material_of(*kind))
    if primitives:
        document["nodes"].append({"mesh": 0})
        document["meshes"].append({"primitives": primitives})
    if sphere:
        moving_node(parts, sphere, document)
    if any(box.emission for box in boxes):
        document["extensionsUsed"] = ["KHR_materials_emissive_strength"]
    document |= {"scenes": [{"nodes": list(range(len(document["nodes"])))}], "accessors": parts.accessors,
                 "bufferViews": parts.views, "buffers": [{"byteLength": len(parts.blob)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(parts.blob), 0x004E4942) + parts.blob
    path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks)
