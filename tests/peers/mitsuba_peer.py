"""A scene for Mitsuba 3 and its pictures. The variant scalar_rgb runs everywhere; the faster llvm_ad_rgb needs a newer
LLVM than Debian 12's 14 and 15 and ends the process without one."""
import pathlib
import sys
import tempfile

try:
    import mitsuba as mi
except ImportError:
    sys.exit("mitsuba_peer.py: mitsuba is missing (pip install mitsuba)")
import numpy as np

import environment
from phase import phase
from scenes import ALL_ORDERS

mi.set_variant("scalar_rgb")
TABLE = 4096  # values of a tabulated phase function


def lacks(scene):
    """What of a scene Mitsuba does not have, or None."""
    if scene.sphere:
        return "motion blur of shapes"
    return "emission of media" if scene.fog.recipe and "fire" in scene.fog.recipe else None


def rgb(value):
    return {"type": "rgb", "value": np.broadcast_to(np.asarray(value, float), 3).tolist()}


def box_to_world(low, high):
    """Where the cube -1..1 goes."""
    middle, half = [(a + b) / 2 for a, b in zip(low, high)], [(b - a) / 2 for a, b in zip(low, high)]
    return mi.ScalarTransform4f().translate(middle).scale(half)


def phase_function(fog):
    """It has no Draine: a table over the cosine stands for it."""
    if not fog.alpha:
        return {"type": "hg", "g": fog.g}
    values = phase(fog, np.linspace(-1, 1, TABLE))
    return {"type": "tabphase", "values": ",".join(f"{value:.8g}" for value in values)}


def medium(fog, voxels):
    """voxels: (center of the first voxel, voxel size, densities [x, y, z]) of a grid."""
    common = {"albedo": rgb(fog.albedo), "phase": phase_function(fog)}
    if voxels is None:
        strongest = float(np.max(fog.extinction))  # a color has to stay within 0..1
        return {"type": "homogeneous", "sigma_t": rgb(np.divide(fog.extinction, strongest)), "scale": strongest,
                **common}, (fog.low, fog.high)
    # A layer of zeros around the voxels, so that density falls to 0 between the last voxel center and the next as in
    # OpenVDB. Mitsuba's grid spans the voxels' outer faces: half a voxel beyond the centers.
    padded = np.pad(voxels["density"], 1)
    low = voxels["first"] - 1.5 * voxels["size"]
    high = low + np.array(padded.shape) * voxels["size"]
    grid = np.ascontiguousarray(padded.transpose(2, 1, 0)[..., None], dtype=np.float32)  # x runs fastest
    to_world = mi.ScalarTransform4f().translate(low.tolist()).scale((high - low).tolist())
    volume = {"type": "gridvolume", "grid": mi.VolumeGrid(grid), "to_world": to_world, "raw": True}
    return {"type": "heterogeneous", "sigma_t": volume, "scale": float(fog.extinction), **common}, (low, high)


def emitter(light):
    if light.kind == "sun":
        return {"type": "directional", "direction": light.place, "irradiance": rgb(light.intensity)}
    if light.kind == "point":
        return {"type": "point", "position": light.place, "intensity": rgb(light.intensity)}
    if light.kind == "rectangle":
        place = mi.ScalarTransform4f().look_at(light.place, light.target, (0, 1, 0))
        return {"type": "rectangle", "to_world": place.scale([light.size[0] / 2, light.size[1] / 2, 1]),
                "bsdf": {"type": "diffuse", "reflectance": rgb(0)}, "emitter": {"type": "area", "radiance": rgb(light.intensity)}}
    with tempfile.TemporaryDirectory() as folder:  # envmap's own middle is +Z
        environment.write(pathlib.Path(folder) / "map.hdr")
        picture = mi.Bitmap(str(pathlib.Path(folder) / "map.hdr"))
    return {"type": "envmap", "bitmap": picture, "scale": float(light.intensity),
            "to_world": mi.ScalarTransform4f().rotate([0, 1, 0], 180)}


def load(scene, orders, voxels):
    camera = scene.camera
    fog, (low, high) = medium(scene.fog, voxels)
    world = {
        "type": "scene",
        "integrator": {"type": "volpath", "max_depth": -1 if orders == ALL_ORDERS else orders + 1, "rr_depth": 64},
        "sensor": {"type": "perspective", "fov": camera.vertical_fov, "fov_axis": "y",
                   "to_world": mi.ScalarTransform4f().look_at(camera.position, camera.target, (0, 1, 0)),
                   "film": {"type": "hdrfilm", "width": scene.size[0], "height": scene.size[1], "rfilter": {"type": "box"}}},
        "fog": {"type": "cube", "to_world": box_to_world(low, high), "bsdf": {"type": "null"}, "interior": fog},
    }
    if scene.light:
        world["light"] = emitter(scene.light)
    for i, box in enumerate(scene.boxes):
        world[f"box{i}"] = {"type": "cube", "to_world": box_to_world(box.low, box.high),
                            "bsdf": {"type": "diffuse", "reflectance": rgb(box.color)}}
        if box.emission:
            world[f"box{i}"]["emitter"] = {"type": "area", "radiance": rgb(box.emission)}
    return mi.load_dict(world)


def render(scene, orders, voxels, samples, seeds):
    """One picture [y, x, rgb] per seed."""
    world = load(scene, orders, voxels)
    return [np.array(mi.render(world, spp=samples, seed=seed))[..., :3] for seed in seeds]


def read_exr(path):
    bitmap = mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, srgb_gamma=False)
    return np.array(bitmap)
