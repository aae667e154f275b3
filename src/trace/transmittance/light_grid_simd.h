// Columns of a light's grid, integrated when sixteen points first need them (see base/simd/simd.h for how such files
// are compiled).
#if defined(TYNDALL_TRACE_TRANSMITTANCE_LIGHT_GRID_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_TRACE_TRANSMITTANCE_LIGHT_GRID_SIMD_H
#undef TYNDALL_TRACE_TRANSMITTANCE_LIGHT_GRID_SIMD_H
#else
#define TYNDALL_TRACE_TRANSMITTANCE_LIGHT_GRID_SIMD_H
#endif

#include "trace/transmittance/light_depth_simd.h"
#include "trace/transmittance/light_grid.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// The first and last of the corners around the active lanes' coordinates.
struct Range {
    int low, high;
};
HWY_INLINE Range range_of(const Floats& value, const Mask16& active, int size) {
    const float last = static_cast<float>(size - 1);
    const Floats low = select(active, value, infinity), high = select(active, value, -infinity);
    auto least = low.part[0], most = high.part[0];
    for (size_t i = 1; i < vectors_per_packet; ++i)
        least = hn::Min(least, low.part[i]), most = hn::Max(most, high.part[i]);
    const float from = hn::GetLane(hn::MinOfLanes(FloatTag(), least));
    const float to = hn::GetLane(hn::MaxOfLanes(FloatTag(), most));
    const int low_cell = std::max(std::min(static_cast<int>(std::clamp(from, 0.0f, last)), size - 2), 0);
    return {low_cell, static_cast<int>(std::clamp(to + 1, 0.0f, last))};
}

// Fills the columns around the active points.
HWY_INLINE void fill_around(const GridColumns& columns, const Vec3s& point, const Mask16& active) {
    const LightDepthGrid& grid = columns.grid();
    Mask16 valid = active;
    const Vec3s at = grid_coordinates(grid, point, valid);
    if (!any(valid)) return;
    const Range across = range_of(fma(at.x, grid.scale.x, grid.offset.x), valid, grid.size.x);
    const Range down = range_of(fma(at.y, grid.scale.y, grid.offset.y), valid, grid.size.y);
    for (int row = down.low; row <= down.high; ++row)
        for (int i = across.low / 16; i <= across.high / 16; ++i)
            if (const int packet = row * columns.packets_across() + i; !columns.is_filled(packet)) columns.fill(packet);
}
}
HWY_AFTER_NAMESPACE();
#endif
