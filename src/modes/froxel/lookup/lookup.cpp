#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/froxel/lookup/lookup.cpp"
#include <hwy/foreach_target.h>

#include "modes/froxel/lookup/lookup.h"

#include "modes/froxel/beams/beam_lookup_simd.h"
#include "modes/froxel/lookup/place_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
using TapTag = hn::CappedTag<float, 8>;
constexpr size_t tap_lanes = hn::MaxLanes(TapTag());
constexpr size_t tap_parts = 8 / tap_lanes;

// Sums at the slice faces in front of and behind the depths of 16 rays: red, green, blue and optical depth of each.
struct FaceSums {
    Floats near[4], far[4];
    Floats share;  // fraction of the slice in front of the depth
    Floats behind; // planar depth of the face behind
};

// For rays between the same tiles that end in slices least..most: interpolates each slice for all rays at once.
void mix_slices(const FroxelTaps& taps, const float* const* columns, const Ints& slice, int least, int most,
                FaceSums& result) {
    const Floats place = to_floats(slice);
    for (int k = least; k <= most; ++k) {
        const Mask16 here = place == static_cast<float>(k);
        for (size_t c = 0; c < 4; ++c) {
            Floats near = 0.0f, far = 0.0f;
            for (int t = 0; t < taps.count; ++t) {
                const float* from = columns[t] + 4 * k + c;
                const Floats weight = load(taps.weights[t]);
                near = fma(weight, from[0], near), far = fma(weight, from[4], far);
            }
            result.near[c] = k == least ? near : select(here, near, result.near[c]);
            result.far[c] = k == least ? far : select(here, far, result.far[c]);
        }
    }
}

// Interpolates ray by ray. Both faces of a slice are adjacent in memory: eight floats per tile.
void mix_rays(const FroxelGrid& grid, const FroxelSums& sums, const FroxelTaps& taps, const int32_t (&slice)[16],
              FaceSums& result) {
    alignas(64) float values[2][64]; // [face][4 · lane + channel]
    const TapTag tag;
    for (size_t lane = 0; lane < 16; ++lane) {
        hn::Vec<TapTag> total[tap_parts];
        for (size_t p = 0; p < tap_parts; ++p) total[p] = hn::Zero(tag);
        for (int t = 0; t < taps.count; ++t) {
            const float* from = sums.at(grid, static_cast<size_t>(taps.tiles[t][lane]), slice[lane]);
            const auto weight = hn::Set(tag, taps.weights[t][lane]);
            for (size_t p = 0; p < tap_parts; ++p)
                total[p] = hn::MulAdd(weight, hn::LoadU(tag, from + p * tap_lanes), total[p]);
        }
        alignas(32) float both[8];
        for (size_t p = 0; p < tap_parts; ++p) hn::Store(total[p], tag, both + p * tap_lanes);
        std::memcpy(values[0] + 4 * lane, both, 16), std::memcpy(values[1] + 4 * lane, both + 4, 16);
    }
    for (size_t i = 0; i < vectors_per_packet; ++i) {
        const auto load_four = [&](const float* from, Floats(&to)[4]) HWY_ATTR {
            hn::LoadInterleaved4(FloatTag(), from + 4 * i * lane_step, to[0].part[i], to[1].part[i], to[2].part[i],
                                 to[3].part[i]);
        };
        load_four(values[0], result.near), load_four(values[1], result.far);
    }
}

FaceSums sums_at(const FroxelBuffer& froxels, const FroxelSums& sums, const FroxelTaps& taps, const Floats& z) {
    constexpr int few = 4;
    const FroxelGrid& grid = froxels.grid;
    const float* columns[16]; // of the surrounding tiles, if they are the same for all rays
    for (int t = 0; t < taps.count && taps.together; ++t)
        columns[t] = sums.at(grid, static_cast<size_t>(taps.tiles[t][0]), 0);
    const SliceLanes slices = slices_around(grid, z);
    FaceSums result;
    result.behind = slices.behind;
    result.share = max(min((z - slices.before) / (slices.behind - slices.before), 1.0f), 0.0f);
    for (int t = 0; t < taps.count && taps.together; ++t) __builtin_prefetch(columns[t] + 4 * slices.least);
    if (taps.together && slices.most - slices.least < few) {
        mix_slices(taps, columns, slices.slice, slices.least, slices.most, result);
        return result;
    }
    alignas(64) int32_t slice[16];
    store(slices.slice, slice);
    mix_rays(grid, sums, taps, slice, result);
    return result;
}

// Light in front of a depth, and optical depth up to it. Inside a slice, light is interpolated as in homogeneous fog.
struct Reached {
    Vec3s light;
    Floats depth;     // of the ray
    Floats last;      // fraction of the slice's light in front of the depth
    Vec3s last_light; // from the last slice
};
Reached reach(const FaceSums& faces, const FroxelTaps& taps, float view_depth) {
    const Floats& slant = taps.slant;
    const Floats before = faces.near[3] * slant;
    const Floats across = max(faces.far[3] * slant - before, 0.0f), within = across * faces.share;
    Reached reached;
    reached.depth = before + within;
    reached.last = faces.share * mean_transmittance(within * view_depth) / mean_transmittance(across * view_depth);
    const Vec3s near{faces.near[0], faces.near[1], faces.near[2]}, far{faces.far[0], faces.far[1], faces.far[2]};
    reached.last_light = (far - near) * reached.last;
    // The tiles' lines are slightly longer or shorter than the ray: in homogeneous fog, light is proportional to 1 -
    // e^-depth.
    const Floats depth = reached.depth * view_depth, ratio = slant / taps.tile_slant;
    const Floats fitted = ratio * mean_transmittance(depth) / mean_transmittance(depth / ratio);
    reached.light = (near + reached.last_light) * fitted;
    reached.last_light = reached.last_light * fitted;
    return reached;
}

// Light of a segment that starts behind fog: subtracts the light in front of it and divides by the transmittance up to
// it. Very small transmittances are clamped: such a segment is invisible, and its light would be rounding errors.
Vec3s light_between(const Reached& start, const Reached& end, float view_depth) {
    constexpr float least = 1e-4f;
    const Floats undone = 1.0f / max(exp(start.depth * -view_depth), least);
    const Vec3s difference = (end.light - start.light) * undone;
    return {max(difference.x, 0.0f), max(difference.y, 0.0f), max(difference.z, 0.0f)};
}

void store_light(const Vec3s& light, float (&rgb)[3][16]) {
    store(light.x, rgb[0]), store(light.y, rgb[1]), store(light.z, rgb[2]);
}

// Validity, reduced by the fraction of light from the ray's last slice if a surface may cut through its froxels, whose
// light is known only in front of the surface.
Floats validity_of(const FroxelTaps& taps, const FaceSums& faces, const Reached& end, const Vec3s& beams) {
    const Floats all = end.light.x + end.light.y + end.light.z + beams.x + beams.y + beams.z;
    const Floats of_last = end.last_light.x + end.last_light.y + end.last_light.z;
    const Floats last = zero_unless(taps.nearest < faces.behind, of_last / max(all, 1e-30f));
    return max(min(taps.kept * (1.0f - last), 1.0f), 0.0f);
}

// Light of all beams; that of each goes to `of_beams`, unless empty.
Vec3s all_beams(const FroxelBuffer& froxels, const RayBatch& batch, const FroxelTaps& taps, const Floats& depth_before,
                std::span<vec3> of_beams) {
    Vec3s sum = splat(vec3(0));
    const size_t count = froxels.beams.lights.size();
    if (count == 0) return sum;
    const BeamRays rays = beam_rays(froxels, batch, taps);
    static thread_local RayDepths depths;
    depths.depths.clear();
    alignas(64) float rgb[3][16];
    for (size_t beam = 0; beam < count; ++beam) {
        const Vec3s light = beam_light(froxels, beam, rays, batch, taps, depth_before, depths);
        sum = sum + light;
        if (of_beams.empty()) continue;
        store_light(light, rgb);
        for (size_t i = 0; i < batch.rays.size(); ++i) of_beams[i * count + beam] = {rgb[0][i], rgb[1][i], rgb[2][i]};
    }
    return sum;
}

void look_up_kernel(const FroxelBuffer& froxels, const RayBatch& batch, std::span<Scatter> results,
                    std::span<const FroxelSums> shares, std::span<vec3> of_shares, std::span<vec3> of_beams) {
    FroxelTaps taps;
    find_taps(froxels, batch, taps);
    const bool late = any(taps.start > froxels.grid.faces.front()); // some ray starts behind the first slice
    const auto light_of = [&](const FroxelSums& sums, FaceSums& faces, Reached& start, Reached& end) HWY_ATTR {
        faces = sums_at(froxels, sums, taps, taps.end);
        end = reach(faces, taps, froxels.view_depth);
        if (!late) return end.light;
        start = reach(sums_at(froxels, sums, taps, taps.start), taps, froxels.view_depth);
        return light_between(start, end, froxels.view_depth);
    };
    FaceSums faces;
    Reached start{splat(vec3(0)), 0.0f, 0.0f, splat(vec3(0))}, end = start;
    const Vec3s of_froxels = light_of(froxels.sums, faces, start, end);
    const Vec3s beams = all_beams(froxels, batch, taps, start.depth, of_beams);
    const Vec3s light = of_froxels + beams;
    const Floats through = exp(start.depth - max(end.depth, start.depth));
    alignas(64) float rgb[3][16], first[64], seen[16], valid[16];
    for (size_t i = 0; i < vectors_per_packet; ++i)
        hn::StoreInterleaved4(light.x.part[i], light.y.part[i], light.z.part[i], through.part[i], FloatTag(),
                              first + 4 * i * lane_step);
    store(select(taps.seen, 1.0f, 0.0f), seen), store(validity_of(taps, faces, end, beams), valid);
    for (size_t i = 0; i < batch.rays.size(); ++i) {
        const float* f = first + 4 * i;
        if (seen[i] > 0)
            results[i] = {{f[0], f[1], f[2]}, f[3], valid[i], taps.count, vec3(0)};
        else
            results[i] = Scatter{.validity = 0};
    }

    for (size_t share = 0; share < shares.size(); ++share) {
        store_light(light_of(shares[share], faces, start, end), rgb);
        for (size_t i = 0; i < batch.rays.size(); ++i)
            if (seen[i] > 0) of_shares[i * shares.size() + share] = {rgb[0][i], rgb[1][i], rgb[2][i]};
    }
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(look_up_kernel);
void look_up_froxels(const FroxelBuffer& froxels, const RayBatch& batch, std::span<Scatter> results,
                     std::span<const FroxelSums> parts, std::span<vec3> of_parts, std::span<vec3> of_beams) {
    HWY_DYNAMIC_DISPATCH(look_up_kernel)(froxels, batch, results, parts, of_parts, of_beams);
}
}
#endif
