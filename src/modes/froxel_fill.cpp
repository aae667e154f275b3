#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/froxel_fill.cpp"
#include <hwy/foreach_target.h>

#include "modes/froxel_fill.h"

#include "base/parallel.h"
#include "base/simd.h"
#include "modes/froxel_light_simd.h"
#include "modes/froxel_lit.h"
#include "modes/style.h"
#include "volume/medium_simd.h"
#include "volume/phase_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
struct Fill {
    const FroxelScene& scene;
    const FroxelGrid& grid;
    const FroxelTiles& tiles;
    const FillPass& pass;
    FroxelLight& light;

    bool exact() const { return scene.settings.visibility == FroxelVisibility::slices; }
    bool wants(size_t part) const { return pass.only < 0 || static_cast<size_t>(pass.only) == part; }
    // One look at a soft light is at its centre: other points would be noise that nothing averages.
    bool spreads() const { return scene.settings.shadow_rays > 1 || pass.frame > 0; }
    int samples() const { return scene.settings.shadow_rays; }
};

// 4×4 tiles of one slice. Lanes beyond the grid's edge are not there.
struct Lanes {
    ivec2 at[16];
    size_t tile[16];
    bool there[16];
};

// Where the lanes look: a ray of the tile that still sees this slice, and a depth.
struct Looks {
    alignas(64) float x[16], y[16], z[16], active[16], lit[16], low[16], high[16];
    int ray[16];
};

// Numbers that spread over 4×4 neighbouring tiles, samples and frames; other ones for each slice and use.
uint32_t spread_index(const Fill& fill, ivec2 at, int sample) {
    const auto cell = static_cast<uint32_t>((at.y & 3) * 4 + (at.x & 3));
    const auto samples = static_cast<uint32_t>(fill.samples());
    return (static_cast<uint32_t>(fill.pass.frame) * 16 + cell) * samples + static_cast<uint32_t>(sample);
}

// Radical inverse of base 2, from ½ on: ½, ¼, ¾, …
float halton(int index) { return to_unit(reverse_bits(static_cast<uint32_t>(index) + 1)); }

// The ray of every tile that a sample looks along, where it is not stopped.
size_t first_ray(const Fill& fill, int sample) {
    return static_cast<size_t>(fill.pass.frame + sample) % fill.tiles.rays();
}

Looks look(const Fill& fill, const Lanes& lanes, int slice, int sample) {
    const FroxelTiles& tiles = fill.tiles;
    const size_t rays = tiles.rays(), k = static_cast<size_t>(slice);
    const float near = fill.grid.faces[k], far = fill.grid.faces[k + 1];
    const int samples = fill.samples(), frame = fill.pass.frame;
    Looks looks{};
    for (size_t i = 0; i < 16; ++i) {
        looks.low[i] = near, looks.high[i] = far, looks.z[i] = 0.5f * (near + far);
        if (!lanes.there[i] || is_hidden(fill.grid, tiles, lanes.tile[i], slice)) continue;
        float u = fill.exact() ? 0.5f : halton(frame);
        const size_t first = first_ray(fill, sample);
        if (samples > 1 && !fill.exact()) {
            const uint32_t index = spread_index(fill, lanes.at[i], sample);
            u = (static_cast<float>(sample) + to_unit(hash(index, k))) / static_cast<float>(samples);
        }
        // The first ray in turn that is not yet stopped at that depth; or the deepest, just before it is.
        const float* depth = tiles.depth.data() + lanes.tile[i] * rays;
        float z = near + u * (far - near);
        size_t ray = static_cast<size_t>(tiles.deepest[lanes.tile[i]]);
        if (fill.exact() && depth[first] > near) ray = first;
        if (depth[ray] <= z) z = 0.5f * (near + depth[ray]);
        for (size_t j = 0; j < rays && ray != first; ++j)
            if (const size_t next = (first + j) % rays; depth[next] > z) {
                ray = next;
                break;
            }
        const vec2 pixel = fill.grid.pixel_of(vec2(lanes.at[i]) + tiles.offsets[ray]);
        looks.x[i] = pixel.x, looks.y[i] = pixel.y, looks.z[i] = z, looks.ray[i] = static_cast<int>(ray);
        looks.high[i] = std::min(far, depth[ray]);
        const size_t froxel = lanes.tile[i] * static_cast<size_t>(fill.grid.slices()) + k;
        looks.active[i] = 1, looks.lit[i] = fill.pass.stale && fill.pass.stale[froxel] ? 0.0f : 1.0f;
    }
    return looks;
}

// Points of the lanes' lines at planar depths.
struct Lines {
    Vec3s origin, step;
};
HWY_INLINE Lines lines_of(const FroxelGrid& grid, const Looks& looks) {
    const Floats x = load(looks.x), y = load(looks.y);
    return {fused(splat(grid.origin_x), x, fused(splat(grid.origin_y), y, splat(grid.origin))),
            fused(splat(grid.step_x), x, fused(splat(grid.step_y), y, splat(grid.step)))};
}

FroxelLanes froxel_lanes(const FroxelGrid& grid, const Looks& looks) {
    const Lines lines = lines_of(grid, looks);
    const Floats slant = sqrt(dot(lines.step, lines.step)), z = load(looks.z), low = load(looks.low);
    FroxelLanes lanes;
    lanes.point = fused(lines.step, z, lines.origin);
    lanes.start = fused(lines.step, low, lines.origin);
    lanes.toward = lines.step * (1.0f / slant);
    lanes.length = slant * max(load(looks.high) - low, 0.0f);
    lanes.active = load(looks.active) > 0.0f;
    const float wide = glm::length(grid.origin_x), wider = glm::length(grid.step_x);
    const Floats side = fused(z, wider, wide) * static_cast<float>(grid.tile);
    lanes.width2 = side * side * (1 / pi);
    return lanes;
}

// Mean extinction along the stretches: exact for formulas, up to four samples for bricks.
Floats mean_extinction(const Medium& medium, const FroxelLanes& lanes, float thickness) {
    if (medium.kind != DensityKind::bricks) {
        const LightPaths paths{lanes.start, lanes.toward, lanes.length};
        return zero_unless(lanes.active, analytic_depth16(medium, paths) / max(lanes.length, 1e-20f));
    }
    const float voxels = thickness * glm::length(vec3(medium.bricks->world_to_index[0]));
    const int count = static_cast<int>(std::clamp(std::ceil(0.5f * voxels), 1.0f, 4.0f));
    if (count == 1) return zero_unless(lanes.active, density16(medium, lanes.point) * medium.optics.extinction);
    Floats sum = 0.0f;
    for (int i = 0; i < count; ++i) {
        const Floats at = lanes.length * ((static_cast<float>(i) + 0.5f) / static_cast<float>(count));
        sum = sum + density16(medium, fused(lanes.toward, at, lanes.start));
    }
    return zero_unless(lanes.active, sum * (medium.optics.extinction / static_cast<float>(count)));
}

// What arrives of a light in each lane, through the surfaces in its way, and where.
struct LaneArrivals {
    Vec3s point;
    Floats amount;
};

// A packet of froxels under way: 16 tiles, one slice, one sample.
struct Job {
    const Lanes& where;
    const Looks& looks;
    int slice, sample;
    const FroxelLit* exact;        // with slices
    const float (*extinction)[16]; // of each medium
};

// Froxels whose size counts beside their distance from a local light. An exact line answers for their depth, and for
// their width where that is a single ray.
Mask16 near_lanes(const Fill& fill, const Light& light, const FroxelLanes& lanes, const Floats& distance) {
    constexpr float near = 4; // beyond, the centre stands for the froxel within 1 %
    if (light.kind == LightKind::sun || (fill.exact() && fill.tiles.rays() == 1)) return Floats(1.0f) < Floats(0.0f);
    const Floats wide2 = lanes.width2 * 4.0f, size2 = fill.exact() ? wide2 : max(lanes.length * lanes.length, wide2);
    return lanes.active & (distance * distance < size2 * (near * near));
}

LaneArrivals arrivals(const Fill& fill, size_t index, const FroxelLanes& lanes, const Mask16& lit, const Job& job) {
    const Light& light = fill.scene.snapshot.lights[index];
    const Arriving plain = arriving_at_points(light, fill.scene.cones[index], lanes);
    alignas(64) float v[4][16], wanted[16], near[16], traced[16] = {}, visible[16];
    store(lanes.point.x, v[0]), store(lanes.point.y, v[1]), store(lanes.point.z, v[2]), store(plain.amount, v[3]);
    store(select(lit, 1.0f, 0.0f), wanted);
    store(select(near_lanes(fill, light, lanes, plain.distance), 1.0f, 0.0f), near);
    const size_t ray = first_ray(fill, job.sample);
    for (size_t i = 0; i < 16; ++i) {
        if (!(wanted[i] > 0)) continue;
        const bool sliced = job.exact && job.looks.ray[i] == static_cast<int>(ray) && !(near[i] > 0);
        traced[i] = !sliced && !(near[i] > 0) && v[3][i] > 0;
        if (!sliced && !(near[i] > 0)) continue;
        const FroxelArrival one = sliced ? job.exact->at(i, index, job.slice)
                                         : near_arrival(fill.scene, fill.grid, fill.tiles, job.where.at[i], job.slice,
                                                        index, spread_index(fill, job.where.at[i], job.sample));
        v[3][i] = one.amount;
        for (int c = 0; c < 3 && one.amount > 0; ++c) v[c][i] = one.point[c];
    }
    const Mask16 by_rays = load(traced) > 0.0f;
    const Occluders* occluders = fill.scene.snapshot.occluders.get();
    Floats amount = zero_unless(lit, load(v[3]));
    if (light.shadows && occluders && !occluders->empty() && any(by_rays) &&
        fill.scene.settings.visibility != FroxelVisibility::off) {
        Sample2 places[16];
        const bool soft = is_soft(light) && fill.spreads();
        for (size_t i = 0; i < 16 && soft; ++i) {
            const ivec2 at = job.where.at[i];
            const auto block = static_cast<uint32_t>((at.y >> 2) * fill.grid.size.x + (at.x >> 2));
            const uint32_t key = hash(block, static_cast<uint32_t>(job.slice), static_cast<uint32_t>(index));
            places[i] = sample2(spread_index(fill, at, job.sample), key);
        }
        store(visible_at_points(*occluders, light, lanes, plain, by_rays, soft ? places : nullptr), visible);
        amount = select(by_rays, amount * load(visible), amount);
    }
    return {{load(v[0]), load(v[1]), load(v[2])}, amount};
}

// Light of one kind scattered towards the eye, per metre.
Vec3s scattered_from(const Fill& fill, size_t index, const FroxelLanes& lanes, const Mask16& lit, const Job& job) {
    const Light& light = fill.scene.snapshot.lights[index];
    const LaneArrivals arriving = arrivals(fill, index, lanes, lit, job);
    const Mask16 reached = arriving.amount > 0.0f;
    if (!any(reached)) return splat(vec3(0));

    Floats cosine = dot(splat(-light.direction), lanes.toward);
    if (light.kind != LightKind::sun) {
        const Vec3s offset = splat(light.position) - arriving.point;
        cosine = dot(offset, lanes.toward) / max(sqrt(dot(offset, offset)), 1e-12f);
    }
    Vec3s scattering = splat(vec3(0));
    for (size_t m = 0; m < fill.scene.snapshot.media.size(); ++m) {
        const Optics& optics = fill.scene.snapshot.media[m].optics;
        const Floats weight = load(job.extinction[m]) * phase_value(optics.phase, cosine);
        scattering = fused(splat(optics.albedo), weight, scattering);
    }
    const Floats dimmed = exp(-light_depth16(fill.scene.depths[index], arriving.point, reached));
    const Floats amount = zero_unless(reached, arriving.amount * dimmed);
    return scattering * amount * splat(light.intensity * light.volume_scale);
}

// Emission and ambient light, per metre.
Vec3s glow_of(const Snapshot& snapshot, const float (*extinction)[16]) {
    Vec3s glow = splat(vec3(0));
    for (size_t m = 0; m < snapshot.media.size(); ++m) {
        const Optics& optics = snapshot.media[m].optics;
        const vec3 each = optics.albedo * snapshot.ambient + optics.emission / optics.extinction;
        glow = fused(splat(each), load(extinction[m]), glow);
    }
    return glow;
}

Floats faded(const StyleSettings& style, const FroxelGrid& grid, const FroxelLanes& lanes) {
    const Vec3s offset = lanes.point - splat(grid.camera.position);
    const float scale = 1 / (0.2f * style.range);
    return max(min((style.range - sqrt(dot(offset, offset))) * scale, 1.0f), 0.0f);
}

void fill_lanes(const Fill& fill, const Lanes& where, int slice, const std::vector<FroxelLit>& exact) {
    const Snapshot& snapshot = fill.scene.snapshot;
    static thread_local std::vector<std::array<float, 16>> scratch;
    scratch.resize(snapshot.media.size());
    auto* extinction = reinterpret_cast<float(*)[16]>(scratch.data());
    const size_t k = static_cast<size_t>(slice);
    const float thickness = fill.grid.faces[k + 1] - fill.grid.faces[k];

    // Extinctions and lights add up over the samples.
    Vec3s light = splat(vec3(0));
    Floats total = 0.0f;
    for (int sample = 0; sample < fill.samples(); ++sample) {
        const Looks looks = look(fill, where, slice, sample);
        const FroxelLanes lanes = froxel_lanes(fill.grid, looks);
        if (!any(lanes.active)) return;
        Floats here = 0.0f;
        for (size_t m = 0; m < snapshot.media.size(); ++m) {
            const Floats one = mean_extinction(snapshot.media[m], lanes, thickness);
            store(one, extinction[m]);
            here = here + one;
        }
        total = total + here;
        const Mask16 lit = lanes.active & (here > 0.0f) & (load(looks.lit) > 0.0f);
        if (!any(lit)) continue;
        Vec3s sum = fill.wants(snapshot.lights.size()) ? glow_of(snapshot, extinction) : splat(vec3(0));
        const Job job{where,     looks, slice, sample, fill.exact() ? &exact[static_cast<size_t>(sample)] : nullptr,
                      extinction};
        for (size_t i = 0; i < snapshot.lights.size(); ++i)
            if (fill.wants(i)) sum = sum + scattered_from(fill, i, lanes, lit, job);
        light = fused(sum, faded(fill.scene.style, fill.grid, lanes), light);
    }

    const Floats inverse = zero_unless(total > 0.0f, 1.0f / max(total, 1e-30f));
    alignas(64) float rgbs[4][16];
    store(light.x * inverse, rgbs[0]), store(light.y * inverse, rgbs[1]), store(light.z * inverse, rgbs[2]);
    store(total * (1 / static_cast<float>(fill.samples())), rgbs[3]);
    for (size_t i = 0; i < 16; ++i) {
        if (!where.there[i]) continue;
        float* values = fill.light.at(fill.grid, where.tile[i], slice);
        for (int c = 0; c < 4; ++c) values[c] = rgbs[c][i];
    }
}

// Whether any froxel of a tile is to be lit anew.
bool is_wanted(const Fill& fill, const Lanes& lanes, int i) {
    if (!lanes.there[i] || !fill.pass.stale) return lanes.there[i];
    const size_t slices = static_cast<size_t>(fill.grid.slices());
    for (size_t k = 0; k < slices && !is_hidden(fill.grid, fill.tiles, lanes.tile[i], static_cast<int>(k)); ++k)
        if (!fill.pass.stale[lanes.tile[i] * slices + k]) return true;
    return false;
}

// Exact light for every sample of 16 tiles.
std::vector<FroxelLit> find_all_lit(const Fill& fill, const Lanes& lanes) {
    ivec2 wanted[16];
    for (int i = 0; i < 16; ++i) wanted[i] = is_wanted(fill, lanes, i) ? lanes.at[i] : fill.grid.size;
    std::vector<FroxelLit> lit;
    for (int sample = 0; sample < fill.samples(); ++sample) {
        uint32_t indices[16];
        for (int i = 0; i < 16; ++i) indices[i] = spread_index(fill, lanes.at[i], sample);
        lit.push_back(find_froxel_lit(fill.scene, fill.grid, fill.tiles, wanted, first_ray(fill, sample),
                                      fill.spreads() ? indices : nullptr));
    }
    return lit;
}

// A block of tiles through all slices. Every second tile in both directions makes a packet when only a quarter of the
// froxels is new in a frame: then packets are wholly new or wholly remembered.
void fill_block(const Fill& fill, ivec2 corner, int stride) {
    std::vector<FroxelLit> exact;
    for (int phase = 0; phase < stride * stride; ++phase) {
        Lanes lanes;
        bool some = false;
        for (int i = 0; i < 16; ++i) {
            lanes.at[i] = corner + ivec2(phase % stride, phase / stride) + stride * ivec2(i % 4, i / 4);
            lanes.there[i] = lanes.at[i].x < fill.grid.size.x && lanes.at[i].y < fill.grid.size.y;
            lanes.tile[i] = lanes.there[i] ? fill.grid.tile_index(lanes.at[i]) : 0;
            some |= lanes.there[i];
        }
        if (!some) continue;
        if (fill.exact()) exact = find_all_lit(fill, lanes);
        for (int slice = 0; slice < fill.grid.slices(); ++slice) fill_lanes(fill, lanes, slice, exact);
    }
}

void fill_kernel(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles, const FillPass& pass,
                 FroxelLight& light) {
    const Fill fill{scene, grid, tiles, pass, light};
    const int stride = pass.stale ? 2 : 1, side = 4 * stride;
    const ivec2 blocks = (grid.size + side - 1) / side;
    parallel_for(int64_t{blocks.x} * blocks.y,
                 [&](int64_t b) { fill_block(fill, side * ivec2(b % blocks.x, b / blocks.x), stride); });
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(fill_kernel);
FroxelLight fill_froxels(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles,
                         const FillPass& pass) {
    FroxelLight light;
    light.values.assign(4 * grid.tiles() * static_cast<size_t>(grid.slices()), 0.0f);
    HWY_DYNAMIC_DISPATCH(fill_kernel)(scene, grid, tiles, pass, light);
    return light;
}
}
#endif
