"""A scene with something in every layer."""
from cli.program import gltf

PARTS = "surface,background,inscatter,lights,ambient,emission,multiple"


def panes():
    """A glowing pane of glass before a wall that glows too; both catch light."""
    def material(red, alpha):
        return {"pbrMetallicRoughness": {"baseColorFactor": [red, 0.6, 0.4, alpha], "metallicFactor": 0},
                "emissiveFactor": [0.05, 0.02, 0.01], "alphaMode": "BLEND" if alpha < 1 else "OPAQUE",
                "doubleSided": True}

    meshes = [{"primitives": [{"attributes": {"POSITION": 0}, "material": i}]} for i in range(2)]
    nodes = [{"mesh": 0, "translation": [-0.5, 0, 0.5]}, {"mesh": 1, "translation": [-0.2, 0.1, -0.5]}]
    return gltf(scenes=[{"nodes": [0, 1]}], nodes=nodes, meshes=meshes, materials=[material(0.8, 0.4), material(0.5, 1)])


def fog(**changes):
    return {"type": "homogeneous", "extinction": 0.6, "emission": [0.02, 0.03, 0.01],
            "bounds": {"low": [-1, -1, -1], "high": [1, 1, 1]}, **changes}


LAMPS = [{"name": "sun", "type": "sun", "direction": [-0.6, -0.7, -0.3], "intensity": 3},
         {"name": "a lamp", "type": "point", "position": [0.3, 0.8, 0.2], "intensity": 0.5,
         "color": [0.4, 0.8, 1]}]
