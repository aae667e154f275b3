// Integration of one tile of froxels (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_LOOKUP_INTEGRATE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_LOOKUP_INTEGRATE_SIMD_H
#undef TYNDALL_MODES_FROXEL_LOOKUP_INTEGRATE_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_LOOKUP_INTEGRATE_SIMD_H
#endif

#include "base/simd/simd.h"
#include "modes/froxel/lookup/integrate.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// Lanes shifted up by n, zeros in front.
template<int n> HWY_INLINE Floats moved_up(const Floats& a) {
#if HWY_ARCH_X86 && HWY_MAX_BYTES == 64
    const __m512i bits = _mm512_castps_si512(a.part[0].raw);
    Floats r;
    r.part[0] = hn::Vec<FloatTag>{_mm512_castsi512_ps(_mm512_alignr_epi32(bits, _mm512_setzero_si512(), 16 - n))};
    return r;
#else
    alignas(64) float values[32];
    store(0.0f, values), store(a, values + 16);
    return load(values + 16 - n);
#endif
}

// Inclusive prefix sums. The order of the additions is the same with every instruction set.
HWY_INLINE Floats running_sums(Floats a) {
    a = a + moved_up<1>(a), a = a + moved_up<2>(a), a = a + moved_up<4>(a);
    return a + moved_up<8>(a);
}

HWY_INLINE float last_lane(const Floats& a) { return hn::ExtractLane(a.part[vectors_per_packet - 1], lane_step - 1); }

// 16 froxels or sums, one per lane: red, green, blue, and extinction or optical depth.
struct Quads {
    Floats channel[4];
};
HWY_INLINE Quads load_quads(const float* from) {
    Quads q;
    for (size_t i = 0; i < vectors_per_packet; ++i)
        hn::LoadInterleaved4(FloatTag(), from + 4 * i * lane_step, q.channel[0].part[i], q.channel[1].part[i],
                             q.channel[2].part[i], q.channel[3].part[i]);
    return q;
}
HWY_INLINE void store_quads(const Quads& q, float* to) {
    for (size_t i = 0; i < vectors_per_packet; ++i)
        hn::StoreInterleaved4(q.channel[0].part[i], q.channel[1].part[i], q.channel[2].part[i], q.channel[3].part[i],
                              FloatTag(), to + 4 * i * lane_step);
}

// Up to 16 slices of a tile from `first` on. Behind what the tile sees, its last visible froxel is repeated.
HWY_INLINE Quads froxels_from(const float* tile, size_t first, size_t seen) {
    if (first + 16 <= seen) return load_quads(tile + 4 * first);
    alignas(64) float padded[64];
    const float* last = tile + 4 * (std::max<size_t>(seen, 1) - 1);
    for (size_t i = 0; i < 16; ++i) std::memcpy(padded + 4 * i, first + i < seen ? tile + 4 * (first + i) : last, 16);
    return load_quads(padded);
}

HWY_INLINE Floats thicknesses(const FroxelGrid& grid, size_t first, size_t count) {
    const float* faces = grid.faces.data() + first;
    if (count == 16) return load(faces + 1) - load(faces);
    alignas(64) float padded[16] = {};
    for (size_t i = 0; i < count; ++i) padded[i] = faces[i + 1] - faces[i];
    return load(padded);
}

// Integrates one tile, 16 slices at a time: optical depths first, then light with weights T (1-e^-D).
HWY_INLINE void integrate_tile(const FroxelGrid& grid, const FroxelTiles& tiles, const FroxelLight& light,
                               float view_depth, size_t tile, float* sums) {
    const size_t slices = static_cast<size_t>(grid.slices()), seen = seen_slices(grid, tiles, tile);
    const float slant = grid.slants[tile];
    const float* froxels = light.at(grid, tile, 0);
    std::fill_n(sums, 4, 0.0f);
    double depth = 0; // double, as look-ups take differences of it
    float sum[3] = {};
    for (size_t first = 0; first < slices; first += 16) {
        const size_t count = std::min<size_t>(16, slices - first);
        Quads q = froxels_from(froxels, first, seen);
        const Floats across = q.channel[3] * thicknesses(grid, first, count), within = running_sums(across);
        const Floats before = moved_up<1>(within) + static_cast<float>(depth), crossed = across * slant;
        q.channel[3] = within + static_cast<float>(depth);
        depth += last_lane(within);
        const Floats weight = exp(before * (-view_depth * slant)) * crossed * mean_transmittance(crossed * view_depth);
        for (size_t c = 0; c < 3; ++c) {
            q.channel[c] = running_sums(q.channel[c] * weight) + sum[c];
            sum[c] = last_lane(q.channel[c]);
        }
        float* to = sums + 4 * (first + 1);
        if (count == 16) {
            store_quads(q, to);
            continue;
        }
        alignas(64) float padded[64];
        store_quads(q, padded), std::copy_n(padded, 4 * count, to);
    }
}
}
HWY_AFTER_NAMESPACE();
#endif
