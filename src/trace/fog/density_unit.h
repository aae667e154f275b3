// The density that a stored 1 stands for, so that half floats hold the densities of any unit of measurement.
#pragma once
#include <cstdint>

namespace tyndall {
struct SparseVolume;

// 1 where the largest densities, but for a thousandth of the voxels, lie within 2^-10 and 65504; else the power of two
// below them.
float density_unit(const SparseVolume& volume);

// Divides the densities by `unit`; returns how many voxels are then above 65504.
uint64_t divide_by(float unit, SparseVolume& volume);
}
