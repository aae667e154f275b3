"""Grids of a .vdb as arrays, through the OpenVDB inside Blender's module: python voxels.py FILE.vdb OUT.npz
OUT.npz holds each grid [x, y, z] by its name over one box of voxels, first (the center of the first voxel in the world)
and size (edge of a voxel), meters. In OpenVDB whole index coordinates are where voxels have their value: their centers here."""
import pathlib
import sys

import numpy as np

if __name__ == "__main__":
    try:
        import bpy
    except ImportError:
        sys.exit("voxels.py: bpy is missing (pip install bpy==5.0.1)")
    sys.path += map(str, pathlib.Path(bpy.__file__).parents[3].glob("python/lib/python*/site-packages"))
    import openvdb

    grids = openvdb.readAll(sys.argv[1])[0]
    bounds = [grid.evalActiveVoxelBoundingBox() for grid in grids]
    low, high = np.min([b[0] for b in bounds], 0).tolist(), np.max([b[1] for b in bounds], 0).tolist()
    arrays = {}
    for grid in grids:
        arrays[grid.name] = np.zeros([b - a + 1 for a, b in zip(low, high)], np.float32)
        grid.copyToArray(arrays[grid.name], ijk=low)
    transform = grids[0].transform
    np.savez(sys.argv[2], first=transform.indexToWorld(low), size=transform.voxelSize()[0], **arrays)
