"""A scene for tyndall: scene file, glTF of the boxes, baked fog, environment map; and its pictures."""
import json
import pathlib
import subprocess
import sys

import environment
import glb


def run(command):
    if subprocess.run(command, stdout=subprocess.DEVNULL).returncode:
        sys.exit("compare.py: this failed: " + " ".join(command))


def medium(scene, folder, program):
    fog = scene.fog
    result = {"name": "fog", "extinction": fog.extinction, "albedo": list(fog.albedo)}
    result |= {"phase": {"type": "draine", "g": fog.g, "alpha": fog.alpha}} if fog.alpha else {"g": fog.g}
    if not fog.recipe:
        return result | {"type": "homogeneous", "bounds": {"low": list(fog.low), "high": list(fog.high)}}
    recipe = folder / f"{scene.name}_recipe.json"
    recipe.write_text(json.dumps(fog.recipe))
    run([program, "bake", str(recipe), "-o", str(folder / f"{scene.name}.vdb"), "-q"])
    result |= {"type": "vdb", "file": f"{scene.name}.vdb"}
    if "fire" in fog.recipe:
        result |= {"grids": {"temperature": "temperature"}, "blackbody": {"convention": "cycles"}}
    return result


def light_entry(light, folder):
    result = {"name": "light", "type": light.kind, "intensity": light.intensity}
    if light.kind == "environment":
        environment.write(folder / "environment.hdr")
        return result | {"image": "environment.hdr"}
    result["direction" if light.kind == "sun" else "position"] = list(light.place)
    if light.kind == "rectangle":
        result |= {"target": list(light.target), "width": light.size[0], "height": light.size[1]}
    return result


def write_scene(scene, folder, program):
    """Writes NAME.json and what it names; returns its path."""
    folder = pathlib.Path(folder)
    camera = {"position": list(scene.camera.position), "target": list(scene.camera.target),
              "vertical_fov": scene.camera.vertical_fov}
    document = {"tyndall": 1, "resolution": list(scene.size), "camera": camera, "media": [medium(scene, folder, program)]}
    if scene.light:
        document["lights"] = [light_entry(scene.light, folder)]
    if scene.boxes or scene.sphere:
        glb.write(scene.boxes, scene.sphere, folder / f"{scene.name}.glb")
        document["gltf"] = f"{scene.name}.glb"
    if scene.sphere:
        camera["shutter"] = {"open": -0.5, "close": 0.5}
    path = folder / f"{scene.name}.json"
    path.write_text(json.dumps(document, indent=1))
    return path


def render(scene_file, options, seed, path, program):
    """A box filter one pixel wide is the filter every renderer here has."""
    command = [program, "render", str(scene_file), "-o", str(path), "--frames", "1", "--aov", "none", "-q", "--seed",
               str(seed), "--set", "pixel.filter=box", "--set", "pixel.filter_radius=0.5", *options]
    run(command)
