"""Grids as OpenVDB has them: values at whole index coordinates, trilinear between, 0 outside."""
import numpy as np


def density(voxels, points, name="density"):
    padded = np.pad(voxels[name], 1)
    place = np.clip((points - voxels["first"]) / voxels["size"] + 1, 0, np.array(padded.shape) - 1.001)
    cell = place.astype(np.int64)
    part = place - cell
    strides = np.array(padded.strides) // padded.itemsize
    flat, index = padded.ravel(), cell @ strides
    at = [[flat[index + (x * strides[0] + y * strides[1])], flat[index + (x * strides[0] + y * strides[1] + 1)]]
          for x in (0, 1) for y in (0, 1)]
    rows = [a + part[:, 2] * (b - a) for a, b in at]
    planes = [rows[2 * x] + part[:, 1] * (rows[2 * x + 1] - rows[2 * x]) for x in (0, 1)]
    return planes[0] + part[:, 0] * (planes[1] - planes[0])


def bounds_of(fog, voxels):
    if voxels is None:
        return fog.low, fog.high
    first, size = voxels["first"], voxels["size"]
    return first - size, first + np.array(voxels["density"].shape) * size
