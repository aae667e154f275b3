"""A scene for Mitsuba 3 and its pictures. The variant scalar_rgb runs everywhere; the faster llvm_ad_rgb needs a newer
LLVM than Debian 12's 14 and 15 and ends the process without one."""
import sys

try:
    import mitsuba as mi
except ImportError:
    sys.exit("mitsuba_peer.py: mitsuba is missing (pip install mitsuba)")
import numpy as np

from scenes import ALL_ORDERS

mi.set_variant("scalar_rgb")


def box_to_world(low, high):
    """Where the cube -1..1 goes."""
    middle, half = [(a + b) / 2 for a, b in zip(low, high)], [(b - a) / 2 for a, b in zip(low, high)]
    return mi.ScalarTransform4f().translate(middle).scale(half)


def medium(fog, voxels):
    """voxels: (centre of the first voxel, voxel size, densities [x, y, z]) of a grid."""
    common = {"albedo": {"type": "rgb", "value": list(fog.albedo)}, "phase": {"type": "hg", "g": fog.g}}
    if voxels is None:
        return {"type": "homogeneous", "sigma_t": float(fog.extinction), **common}, (fog.low, fog.high)
    # A layer of zeros around the voxels, so that density falls to 0 between the last voxel centre and the next as in
    # OpenVDB. Mitsuba's grid spans the voxels' outer faces: half a voxel beyond the centres.
    first, size, density = voxels
    padded = np.pad(density, 1)
    low = first - 1.5 * size
    high = low + np.array(padded.shape) * size
    grid = np.ascontiguousarray(padded.transpose(2, 1, 0)[..., None], dtype=np.float32)  # x runs fastest
    to_world = mi.ScalarTransform4f().translate(low.tolist()).scale((high - low).tolist())
    volume = {"type": "gridvolume", "grid": mi.VolumeGrid(grid), "to_world": to_world, "raw": True}
    return {"type": "heterogeneous", "sigma_t": volume, "scale": float(fog.extinction), **common}, (low, high)


def load(scene, orders, voxels):
    camera, light = scene.camera, scene.light
    fog, (low, high) = medium(scene.fog, voxels)
    world = {
        "type": "scene",
        "integrator": {"type": "volpath", "max_depth": -1 if orders == ALL_ORDERS else orders + 1, "rr_depth": 64},
        "sensor": {"type": "perspective", "fov": camera.vertical_fov, "fov_axis": "y",
                   "to_world": mi.ScalarTransform4f().look_at(camera.position, camera.target, (0, 1, 0)),
                   "film": {"type": "hdrfilm", "width": scene.size[0], "height": scene.size[1], "rfilter": {"type": "box"}}},
        "fog": {"type": "cube", "to_world": box_to_world(low, high), "bsdf": {"type": "null"}, "interior": fog},
    }
    if light.kind == "sun":
        world["light"] = {"type": "directional", "direction": light.place,
                          "irradiance": {"type": "rgb", "value": float(light.intensity)}}
    else:
        world["light"] = {"type": "point", "position": light.place,
                          "intensity": {"type": "rgb", "value": float(light.intensity)}}
    for i, box in enumerate(scene.boxes):
        world[f"box{i}"] = {"type": "cube", "to_world": box_to_world(box.low, box.high),
                            "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(box.color)}}}
    return mi.load_dict(world)


def render(scene, orders, voxels, samples, seeds):
    """One picture [y, x, rgb] per seed."""
    world = load(scene, orders, voxels)
    return [np.array(mi.render(world, spp=samples, seed=seed))[..., :3] for seed in seeds]


def read_exr(path):
    bitmap = mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, srgb_gamma=False)
    return np.array(bitmap)
