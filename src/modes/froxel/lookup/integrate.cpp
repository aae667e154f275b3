#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/froxel/lookup/integrate.cpp"
#include <hwy/foreach_target.h>

#include "modes/froxel/lookup/integrate.h"

#include "base/parallel.h"
#include "modes/froxel/lookup/integrate_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
void integrate_kernel(const FroxelGrid& grid, const FroxelTiles& tiles, const FroxelLight& light, float view_depth,
                      FroxelSums& sums) {
    const size_t row = static_cast<size_t>(grid.size.x);
    parallel_for(grid.size.y, [&](int64_t y) {
        for (size_t tile = static_cast<size_t>(y) * row; tile < (static_cast<size_t>(y) + 1) * row; ++tile)
            integrate_tile(grid, tiles, light, view_depth, tile, sums.values.data() + 4 * tile * grid.faces.size());
    });
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(integrate_kernel);
FroxelSums integrate_froxels(const FroxelGrid& grid, const FroxelTiles& tiles, const FroxelLight& light,
                             float view_depth) {
    FroxelSums sums;
    sums.values.resize(4 * grid.tiles() * grid.faces.size());
    HWY_DYNAMIC_DISPATCH(integrate_kernel)(grid, tiles, light, view_depth, sums);
    return sums;
}
}
#endif
