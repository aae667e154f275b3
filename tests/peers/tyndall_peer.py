"""A scene for tyndall: scene file, glTF of the boxes, baked fog; and its pictures."""
import json
import pathlib
import struct
import subprocess
import sys

FACES = [(4, 5, 7, 6), (1, 0, 2, 3), (5, 1, 3, 7), (0, 4, 6, 2), (6, 7, 3, 2), (0, 1, 5, 4)]  # +z -z +x -x +y -y
NORMALS = [(0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)]


def write_glb(boxes, path):
    """All boxes as one mesh: they share a colour."""
    points, normals, index = [], [], []
    for box in boxes:
        for face, normal in zip(FACES, NORMALS):
            first = len(points)
            points += [tuple((box.high if corner >> axis & 1 else box.low)[axis] for axis in range(3))
                       for corner in face]
            normals += [normal] * 4
            index += [first, first + 1, first + 2, first, first + 2, first + 3]
    parts = [struct.pack(f"<{3 * len(rows)}f", *(c for row in rows for c in row)) for rows in (points, normals)]
    parts.append(struct.pack(f"<{len(index)}I", *index))
    starts = [sum(map(len, parts[:i])) for i in range(3)]
    accessors = [{"bufferView": i, "componentType": 5126, "count": len(points), "type": "VEC3"} for i in range(2)]
    accessors[0] |= {"min": [min(c) for c in zip(*points)], "max": [max(c) for c in zip(*points)]}
    accessors.append({"bufferView": 2, "componentType": 5125, "count": len(index), "type": "SCALAR"})
    material = {"pbrMetallicRoughness": {"baseColorFactor": [*boxes[0].color, 1], "metallicFactor": 0}}
    text = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]}],
        "materials": [material], "accessors": accessors,
        "bufferViews": [{"buffer": 0, "byteOffset": s, "byteLength": len(p)} for s, p in zip(starts, parts)],
        "buffers": [{"byteLength": sum(map(len, parts))}]}).encode()
    text += b" " * (-len(text) % 4)
    blob = b"".join(parts)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(blob), 0x004E4942) + blob
    path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks)


def run(command):
    if subprocess.run(command, stdout=subprocess.DEVNULL).returncode:
        sys.exit("compare.py: this failed: " + " ".join(command))


def write_scene(scene, folder, program):
    """Writes NAME.json and what it names; returns its path."""
    folder = pathlib.Path(folder)
    fog, light, camera = scene.fog, scene.light, scene.camera
    medium = {"name": "fog", "extinction": fog.extinction, "albedo": list(fog.albedo), "g": fog.g}
    if fog.recipe:
        recipe = folder / f"{scene.name}_recipe.json"
        recipe.write_text(json.dumps(fog.recipe))
        run([program, "bake", str(recipe), "-o", str(folder / f"{scene.name}.vdb"), "-q"])
        medium |= {"type": "vdb", "file": f"{scene.name}.vdb"}
    else:
        medium |= {"type": "homogeneous", "bounds": {"low": list(fog.low), "high": list(fog.high)}}
    document = {"tyndall": 1, "resolution": list(scene.size), "media": [medium],
                "camera": {"position": list(camera.position), "target": list(camera.target),
                           "vertical_fov": camera.vertical_fov},
                "lights": [{"name": "light", "type": light.kind, "intensity": light.intensity,
                            "direction" if light.kind == "sun" else "position": list(light.place)}]}
    if scene.boxes:
        write_glb(scene.boxes, folder / f"{scene.name}.glb")
        document["gltf"] = f"{scene.name}.glb"
    path = folder / f"{scene.name}.json"
    path.write_text(json.dumps(document, indent=1))
    return path


def render(scene_file, options, seed, path, program):
    """A box filter one pixel wide is the filter every renderer here has."""
    command = [program, "render", str(scene_file), "-o", str(path), "--frames", "1", "--aov", "none", "-q", "--seed",
               str(seed), "--set", "pixel.filter=box", "--set", "pixel.filter_radius=0.5", *options]
    run(command)

