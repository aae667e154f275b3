#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/froxel_lookup.cpp"
#include <hwy/foreach_target.h>

#include "modes/froxel_lookup.h"

#include "base/random.h"
#include "base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
using TapTag = hn::CappedTag<float, 8>;
constexpr size_t tap_lanes = hn::MaxLanes(TapTag());
constexpr size_t tap_parts = 8 / tap_lanes;

// A ray's place in the grid: planar depths of its ends, metres of ray per metre of depth, and the tiles around it.
struct Place {
    float start = 0, end = 0, slant = 1;
    bool seen = false; // by the grid's camera
    uint32_t tiles[16];
    float weights[16]; // sum 1
    int count = 0;
    float kept = 1;           // weight of the tiles that see as far as the ray
    float nearest = infinity; // surface that the pixel's own tile sees
};

// Tile and weights of one axis: 2 of a linear look-up, 4 of a cubic B-spline.
struct Axis {
    int first = 0, count = 2;
    float weights[4];
};
Axis axis_of(float place, int size, bool cubic) {
    const float held = std::clamp(place, 0.0f, static_cast<float>(size - 1));
    const int cell = std::min(static_cast<int>(held), size - 2);
    const float f = held - static_cast<float>(cell), g = 1 - f;
    if (!cubic) return {cell, 2, {g, f}};
    return {cell - 1, 4, {g * g * g / 6, (4 - 3 * f * f * (2 - f)) / 6, (4 - 3 * g * g * (2 - g)) / 6, f * f * f / 6}};
}

// Behind what a tile sees its sums mean nothing; only where no tile sees far enough are they taken after all.
void distrust_blind(const FroxelTiles& tiles, Place& place) {
    constexpr float least = 1e-5f;
    float total = 0;
    place.kept = 0;
    for (int i = 0; i < place.count; ++i) {
        const size_t tile = place.tiles[i];
        const float behind = std::max(place.end - tiles.trusted[tile], 0.0f);
        const float trusted = behind > 0 ? std::max(1 - behind * tiles.distrust[tile], 0.0f) : 1.0f;
        place.kept += place.weights[i] * trusted;
        total += place.weights[i] *= std::max(trusted, least);
    }
    for (int i = 0; i < place.count; ++i) place.weights[i] /= total;
}

void find_tiles(const FroxelPicture& picture, vec2 pixel, const RayBatch& batch, size_t i, Place& place) {
    const FroxelGrid& grid = picture.grid;
    vec2 at = grid.tile_of(pixel);
    if (picture.lookup == FroxelLookup::jittered) {
        const float jitter = i < batch.jitter.size() ? batch.jitter[i] : 0.5f;
        at += vec2(jitter, to_unit(hash(i < batch.ids.size() ? batch.ids[i] : 0u, 0x66726fu))) - 0.5f;
    }
    const bool cubic = picture.lookup == FroxelLookup::tricubic;
    const Axis x = axis_of(at.x, grid.size.x, cubic), y = axis_of(at.y, grid.size.y, cubic);
    const ivec2 cell(x.first + cubic, y.first + cubic); // the tile at or before the pixel
    const bool all_see = place.end <= picture.tiles.trusted_around[grid.tile_index(cell)];
    place.nearest = picture.tiles.nearest[grid.tile_index(grid.tile_of_pixel(pixel))];
    for (int j = 0; j < y.count; ++j)
        for (int k = 0; k < x.count; ++k) {
            const ivec2 tile = glm::clamp(ivec2(x.first + k, y.first + j), ivec2(0), grid.size - 1);
            place.tiles[place.count] = static_cast<uint32_t>(grid.tile_index(tile));
            place.weights[place.count++] = x.weights[k] * y.weights[j];
        }
    if (!all_see) distrust_blind(picture.tiles, place);
}

Place place_of(const FroxelPicture& picture, const RayBatch& batch, size_t i) {
    const FroxelGrid& grid = picture.grid;
    const Camera& camera = grid.camera;
    const Ray& ray = batch.rays[i];
    const float along = glm::dot(ray.direction, camera.forward);
    Place place;
    if (!(along > 1e-6f)) return place;
    place.slant = 1 / along;
    place.start = std::max(planar_depth(camera, ray, 0), 0.0f);
    place.end = std::min(place.start + ray.t_max * along, std::numeric_limits<float>::max());
    vec2 pixel;
    if (i < batch.positions.size()) {
        pixel = batch.positions[i];
    } else {
        const vec3 projected = project(grid, ray.at((std::max(grid.faces.back() - place.start, 1.0f)) / along));
        pixel = vec2(projected);
    }
    if (!std::isfinite(pixel.x + pixel.y)) return place;
    place.seen = true;
    find_tiles(picture, pixel, batch, i, place);
    return place;
}

// Sums at the faces before and behind a depth, of 16 rays: red, green, blue and optical depth of each.
struct FaceSums {
    alignas(64) float values[8][16] = {};
    alignas(64) float share[16] = {}; // of the slice before the depth

    HWY_INLINE Floats near(int c) const { return load(values[c]); }
    HWY_INLINE Floats far(int c) const { return load(values[4 + c]); }
};

void add_faces(const FroxelPicture& picture, const FroxelSums& sums, const Place& place, float z, size_t lane,
               FaceSums& faces) {
    const FroxelGrid& grid = picture.grid;
    const int k = slice_of(grid, z);
    const float near = grid.faces[static_cast<size_t>(k)], far = grid.faces[static_cast<size_t>(k) + 1];
    faces.share[lane] = std::clamp((z - near) / (far - near), 0.0f, 1.0f);
    // Both faces of a slice lie side by side in memory: eight floats per tile.
    const TapTag tag;
    hn::Vec<TapTag> total[tap_parts];
    for (size_t p = 0; p < tap_parts; ++p) total[p] = hn::Zero(tag);
    for (int t = 0; t < place.count; ++t) {
        const float* from = sums.at(grid, place.tiles[t], k);
        const auto weight = hn::Set(tag, place.weights[t]);
        for (size_t p = 0; p < tap_parts; ++p)
            total[p] = hn::MulAdd(weight, hn::LoadU(tag, from + p * tap_lanes), total[p]);
    }
    alignas(64) float values[8];
    for (size_t p = 0; p < tap_parts; ++p) hn::Store(total[p], tag, values + p * tap_lanes);
    for (int c = 0; c < 8; ++c) faces.values[c][lane] = values[c];
}

// Metres per metre of depth: of the rays, and of the tiles' lines around them on average.
struct Slants {
    Floats ray, tiles;
};

// Light before a depth and optical depth up to it. Within the slice the light comes as from even fog.
struct Reached {
    Vec3s light;
    Floats depth;     // of the ray
    Floats last;      // share of the slice's light that lies before the depth
    Vec3s last_light; // from the last slice
};
Reached reach(const FaceSums& faces, const Slants& slants, float view_depth) {
    const Floats& slant = slants.ray;
    const Floats share = load(faces.share), before = faces.near(3) * slant;
    const Floats across = max(faces.far(3) * slant - before, 0.0f), within = across * share;
    Reached reached;
    reached.depth = before + within;
    reached.last = share * mean_transmittance(within * view_depth) / mean_transmittance(across * view_depth);
    reached.last_light =
        Vec3s{faces.far(0) - faces.near(0), faces.far(1) - faces.near(1), faces.far(2) - faces.near(2)} * reached.last;
    // The tiles' lines are a little longer or shorter than the ray: in even fog the light is as 1 - e^-depth.
    const Floats depth = reached.depth * view_depth, ratio = slant / slants.tiles;
    const Floats fitted = ratio * mean_transmittance(depth) / mean_transmittance(depth / ratio);
    reached.light = (Vec3s{faces.near(0), faces.near(1), faces.near(2)} + reached.last_light) * fitted;
    reached.last_light = reached.last_light * fitted;
    return reached;
}

float slant_of_tiles(const FroxelGrid& grid, const Place& place) {
    float slant = 0;
    for (int i = 0; i < place.count; ++i) slant += place.weights[i] * grid.slants[place.tiles[i]];
    return slant;
}

struct Lookup {
    const FroxelPicture& picture;
    const RayBatch& batch;
    Place places[16];
    alignas(64) float slant[16], tile_slant[16];
    bool late = false; // some ray starts behind the first slice

    FaceSums faces(const FroxelSums& sums, bool at_end) const {
        FaceSums result;
        for (size_t i = 0; i < batch.rays.size(); ++i)
            if (places[i].seen)
                add_faces(picture, sums, places[i], at_end ? places[i].end : places[i].start, i, result);
        return result;
    }
};

// Light of a stretch that begins behind fog: what lies before it is taken off, and what dims it is undone. Where hardly
// anything passes the fog before, neither can be told from rounding, nor seen.
Vec3s light_between(const Reached& start, const Reached& end, float view_depth) {
    constexpr float least = 1e-4f;
    const Floats undone = 1.0f / max(exp(start.depth * -view_depth), least);
    const Vec3s difference = (end.light - start.light) * undone;
    return {max(difference.x, 0.0f), max(difference.y, 0.0f), max(difference.z, 0.0f)};
}

void store_light(const Vec3s& light, float rgb[3][16]) {
    store(light.x, rgb[0]), store(light.y, rgb[1]), store(light.z, rgb[2]);
}

void look_up_kernel(const FroxelPicture& picture, const RayBatch& batch, std::span<Scatter> results,
                    std::span<const FroxelSums> parts, std::span<vec3> of_parts) {
    Lookup lookup{picture, batch, {}, {}, {}};
    for (size_t i = 0; i < 16; ++i) {
        lookup.slant[i] = lookup.tile_slant[i] = 1;
        if (i >= batch.rays.size()) continue;
        lookup.places[i] = place_of(picture, batch, i);
        if (!lookup.places[i].seen) continue;
        lookup.slant[i] = lookup.places[i].slant, lookup.tile_slant[i] = slant_of_tiles(picture.grid, lookup.places[i]);
        lookup.late |= lookup.places[i].start > picture.grid.faces.front();
    }
    const Slants slants{load(lookup.slant), load(lookup.tile_slant)};
    const auto light_of = [&](const FroxelSums& sums, Reached& start, Reached& end) HWY_ATTR {
        end = reach(lookup.faces(sums, true), slants, picture.view_depth);
        if (!lookup.late) return end.light;
        start = reach(lookup.faces(sums, false), slants, picture.view_depth);
        return light_between(start, end, picture.view_depth);
    };
    Reached start{splat(vec3(0)), 0.0f, 0.0f, splat(vec3(0))}, end = start;
    const Vec3s light = light_of(picture.sums, start, end);
    alignas(64) float rgb[3][16], through[16], last[16];
    store_light(light, rgb);
    store(exp(start.depth - max(end.depth, start.depth)), through);
    const Floats all = end.light.x + end.light.y + end.light.z;
    const Floats of_last = end.last_light.x + end.last_light.y + end.last_light.z;
    store(zero_unless(all > 0.0f, of_last / max(all, 1e-30f)), last);

    for (size_t i = 0; i < batch.rays.size(); ++i) {
        const Place& place = lookup.places[i];
        if (!place.seen) {
            results[i] = Scatter{.validity = 0};
            continue;
        }
        results[i].radiance = {rgb[0][i], rgb[1][i], rgb[2][i]};
        results[i].transmittance = through[i];
        // A surface may cut the ray's last froxels short: their light is known for the part before it only.
        const int k = slice_of(picture.grid, place.end);
        const float straddling = place.nearest < picture.grid.faces[static_cast<size_t>(k) + 1] ? 1.0f : 0.0f;
        results[i].validity = std::clamp(place.kept * (1 - straddling * last[i]), 0.0f, 1.0f);
        results[i].steps = place.count;
    }

    for (size_t part = 0; part < parts.size(); ++part) {
        Reached part_start = start, part_end = end;
        store_light(light_of(parts[part], part_start, part_end), rgb);
        for (size_t i = 0; i < batch.rays.size(); ++i)
            if (lookup.places[i].seen) of_parts[i * parts.size() + part] = {rgb[0][i], rgb[1][i], rgb[2][i]};
    }
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(look_up_kernel);
void look_up_froxels(const FroxelPicture& picture, const RayBatch& batch, std::span<Scatter> results,
                     std::span<const FroxelSums> parts, std::span<vec3> of_parts) {
    HWY_DYNAMIC_DISPATCH(look_up_kernel)(picture, batch, results, parts, of_parts);
}
}
#endif
