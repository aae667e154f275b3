"""Writes a drawn scene as files that tyndall reads."""
import json
import pathlib
import subprocess

from geometry import write_glb

DATA = pathlib.Path(__file__).parents[1] / "data"


def write_scene(drawn, size, folder, program):
    """Returns the path of the scene file. Recipes of VDB media are baked."""
    folder.mkdir(parents=True, exist_ok=True)
    document = {"tyndall": 1, "resolution": list(size), "camera": drawn.camera, "ambient": drawn.ambient, "media": [],
                "lights": [{"name": f"{light['type']} {i + 1}", **light} for i, light in enumerate(drawn.lights)]}
    for i, medium in enumerate(drawn.media):
        medium = {"name": f"{medium['type']} {i + 1}", **medium}
        if "recipe" in medium:
            recipe = folder / f"recipe{i + 1}.json"
            recipe.write_text(json.dumps(medium["recipe"]))
            medium["recipe"] = recipe.name
            if medium["type"] == "vdb":
                del medium["recipe"]
                sequence = "sequence" in medium
                medium["file"] = f"fog{i + 1}.####.vdb" if sequence else f"fog{i + 1}.vdb"
                more = ["--velocity"] if "velocity" in medium.get("grids", {}) else []
                subprocess.run([program, "bake", recipe, "-o", folder / medium["file"], "--frames", "1-3" if sequence else "1",
                                "-q", *more], check=True)
        document["media"].append(medium)
    for name, content in drawn.files.items():
        (folder / name).write_bytes(content)
    if drawn.objects:
        document["objects"] = drawn.objects
    if drawn.background:
        document["background"] = drawn.background
    if drawn.gltf:
        document |= {"gltf": str(DATA / drawn.gltf), "gltf_lights": False}
    elif drawn.meshes:
        write_glb(drawn.meshes, folder / "meshes.glb", drawn.offset)
        document["gltf"] = "meshes.glb"
    path = folder / "scene.json"
    path.write_text(json.dumps(document, indent=1))
    return path
