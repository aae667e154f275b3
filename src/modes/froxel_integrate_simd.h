// One tile of froxels added up (see base/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_INTEGRATE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_INTEGRATE_SIMD_H
#undef TYNDALL_MODES_FROXEL_INTEGRATE_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_INTEGRATE_SIMD_H
#endif

#include "base/simd.h"
#include "modes/froxel_integrate.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
using SumTag = hn::CappedTag<float, 4>;
constexpr size_t sum_lanes = hn::MaxLanes(SumTag()), sum_parts = 4 / sum_lanes;

// One tile. Optical depths are summed first; then the weights T (1-e^-D) of 16 slices at a time.
HWY_INLINE void integrate_tile(const FroxelGrid& grid, const FroxelTiles& tiles, const FroxelLight& light,
                               float view_depth, size_t tile, float* sums) {
    const int slices = grid.slices();
    const float slant = grid.slants[tile];
    std::fill_n(sums, 4, 0.0f);
    const SumTag tag;
    hn::Vec<SumTag> sum[sum_parts];
    for (size_t p = 0; p < sum_parts; ++p) sum[p] = hn::Zero(tag);
    double depth = 0; // rounds less than the differences that look-ups take of it
    const int seen = static_cast<int>(seen_slices(grid, tiles, tile));
    for (int first = 0; first < slices; first += 16) {
        alignas(64) float before[16] = {}, across[16] = {}, up_to[16], weight[16];
        const int count = std::min(16, slices - first);
        const auto source = [&](int i) { return light.at(grid, tile, std::max(std::min(first + i, seen - 1), 0)); };
        for (int i = 0; i < count; ++i) {
            const size_t k = static_cast<size_t>(first + i);
            const float extinction = source(i)[3] * (grid.faces[k + 1] - grid.faces[k]);
            before[i] = static_cast<float>(depth), across[i] = extinction;
            depth += extinction;
            up_to[i] = static_cast<float>(depth);
        }
        const Floats crossed = load(across) * slant;
        store(exp(load(before) * (-view_depth * slant)) * crossed * mean_transmittance(crossed * view_depth), weight);
        for (int i = 0; i < count; ++i) {
            float* to = sums + 4 * (first + i + 1);
            for (size_t p = 0; p < sum_parts; ++p) {
                const auto froxel = hn::LoadU(tag, source(i) + p * sum_lanes);
                sum[p] = hn::MulAdd(hn::Set(tag, weight[i]), froxel, sum[p]);
                hn::StoreU(sum[p], tag, to + p * sum_lanes);
            }
            to[3] = up_to[i];
        }
    }
}

}
HWY_AFTER_NAMESPACE();
#endif
