"""The grid of a .vdb as an array, for programs without OpenVDB: /usr/bin/python3 voxels.py FILE.vdb OUT.npz
OUT.npz holds density [x, y, z], first (the centre of the first voxel in the world) and size (edge of a voxel), metres.
In OpenVDB whole index coordinates are where voxels have their value: their centres here."""
import sys

import numpy as np

if __name__ == "__main__":
    try:
        import pyopenvdb
    except ImportError:
        sys.exit("voxels.py: pyopenvdb is missing (Debian: apt-get install python3-openvdb; run with /usr/bin/python3)")
    grid = pyopenvdb.readAllGridMetadata(sys.argv[1])[0]
    grid = pyopenvdb.read(sys.argv[1], grid.name)
    low, high = grid.evalActiveVoxelBoundingBox()
    density = np.zeros([b - a + 1 for a, b in zip(low, high)], np.float32)
    grid.copyToArray(density, ijk=low)
    np.savez(sys.argv[2], first=grid.transform.indexToWorld(low), size=grid.transform.voxelSize()[0], density=density)
