"""Scenes in other units of length, and far from the origin: files that show the picture of the ones they are made from."""
import copy
import json
import pathlib
import shutil
import struct


def _at_keys(value, change):
    """A value of the scene file, or each of its keys, changed."""
    if isinstance(value, dict):
        return {**value, "keys": [[time, change(key)] for time, key in value["keys"]]}
    return change(value)


def _times(factor):
    def change(value):
        return [change(each) for each in value] if isinstance(value, list) else value * factor
    return change


def _plus(offset):
    return lambda value: [a + b for a, b in zip(value, offset)]


def _change(table, keys, change):
    for key in keys:
        if key in table:
            table[key] = _at_keys(table[key], change)


def _read_glb(path):
    data = path.read_bytes()
    if data[:4] != b"glTF":
        return json.loads(data), b""
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + length]), data[20 + length:]


def _write_glb(path, gltf, rest):
    if not rest:
        return path.write_text(json.dumps(gltf))
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(b"glTF" + struct.pack("<II", 2, 20 + len(text) + len(rest)) +
                     struct.pack("<I", len(text)) + b"JSON" + text + rest)


def _move_gltf(source, target, factor, offset):
    """All under one node that scales and moves it; lights and cameras, which no node scales, by themselves."""
    gltf, rest = _read_glb(source)
    for buffer in gltf.get("buffers", []) + gltf.get("images", []):
        if "uri" in buffer and not buffer["uri"].startswith("data:"):
            name = f"{target.stem}_{pathlib.Path(buffer['uri']).name}"
            shutil.copy(source.parent / buffer["uri"], target.with_name(name))
            buffer["uri"] = name
    for light in gltf.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", []):
        if light["type"] != "directional":
            light["intensity"] = light.get("intensity", 1) * factor**2
        if "range" in light:
            light["range"] *= factor
    for camera in gltf.get("cameras", []):
        for part in ("perspective", "orthographic"):
            _change(camera.get(part, {}), ("znear", "zfar", "xmag", "ymag"), _times(factor))
    nodes = gltf.setdefault("nodes", [])
    for scene in gltf.get("scenes", []):
        if scene.get("nodes"):
            nodes.append({"children": scene["nodes"], "scale": [factor] * 3, "translation": list(offset)})
            scene["nodes"] = [len(nodes) - 1]
    _write_glb(target, gltf, rest)


def _scale_recipe(recipe, factor):
    _change(recipe["bounds"], ("low", "high"), _times(factor))
    _change(recipe, ("voxel_size", "wind"), _times(factor))
    _change(recipe.setdefault("noise", {}), ("scale",), _times(factor))
    recipe["noise"].setdefault("scale", factor)
    _change(recipe.get("density", {}), ("border",), _times(factor))
    _change(recipe.get("height", {}), ("base", "falloff"), _times(factor))
    if "swirl" in recipe:
        recipe["swirl"].setdefault("scale", 1)
        _change(recipe["swirl"], ("amount", "scale"), _times(factor))
    recipe.setdefault("optics", {}).setdefault("extinction", 0.1)
    recipe["optics"]["extinction"] /= factor


def _move_medium(medium, folder, target, factor, offset, number):
    _change(medium, ("voxel_size", "wind", "translate", "base", "falloff"), _times(factor))
    _change(medium, ("extinction", "emission"), _times(1 / factor))
    if medium["type"] == "vdb":
        medium["file"] = str((folder / medium["file"]).resolve())
        medium["scale"] = _at_keys(medium.get("scale", 1), _times(factor))
    elif medium["type"] == "noise":
        recipe = json.loads((folder / medium["recipe"]).read_text())
        _scale_recipe(recipe, factor)
        medium["recipe"] = f"{target.stem}_{number}_recipe.json"
        (target.parent / medium["recipe"]).write_text(json.dumps(recipe))
    elif "bounds" in medium:
        _change(medium["bounds"], ("low", "high"), _times(factor))
    medium["translate"] = _at_keys(medium.get("translate", [0, 0, 0]), _plus(offset))
    if medium["type"] == "height":
        medium["base"] = _at_keys(medium.get("base", 0), lambda base: base + offset[1])


def write_moved(source, target, factor=1, offset=(0, 0, 0)):
    """Writes at `target` the scene of the file `source`, all lengths times `factor`, then moved by `offset`. Media of
    files must state their extinction: the file's own is not changed."""
    source, target = pathlib.Path(source), pathlib.Path(target)
    scene = copy.deepcopy(json.loads(source.read_text()))
    scene.pop("$schema", None)
    if "gltf" in scene:
        moved = target.with_name(target.stem + "_scene.glb")
        _move_gltf(source.parent / scene["gltf"], moved, factor, offset)
        scene["gltf"] = moved.name
    cameras = scene.get("cameras", []) + ([scene["camera"]] if isinstance(scene.get("camera"), dict) else [])
    for camera in cameras:
        if "position" in camera:  # not a lens on a camera of the glTF
            camera.setdefault("near", 0.01)
        _change(camera, ("position", "target", "ortho_height", "near", "far", "aperture_radius", "focus_distance"), _times(factor))
        _change(camera, ("position", "target"), _plus(offset))
    for light in scene.get("lights", []):
        _change(light, ("position", "target", "range", "radius"), _times(factor))
        _change(light, ("position", "target"), _plus(offset))
        if light.get("type") in ("point", "spot"):
            light["intensity"] = _at_keys(light.get("intensity", 1), _times(factor**2))
    for number, medium in enumerate(scene.get("media", [])):
        _move_medium(medium, source.parent, target, factor, offset, number)
    for card in scene.get("billboards", []):
        _change(card, ("from", "to", "width_from", "width_to"), _times(factor))
        _change(card, ("from", "to"), _plus(offset))
    if "image" in scene.get("background", {}):
        scene["background"]["image"] = str((source.parent / scene["background"]["image"]).resolve())
    target.write_text(json.dumps(scene))
