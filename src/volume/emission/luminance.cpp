#include "volume/emission/luminance.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/process.h"
#include "volume/bricks/bricks.h"
#include "volume/bricks/half.h"
#include "volume/emission/blackbody.h"

#include <algorithm>
#include <tuple>

namespace tyndall {
namespace {
// Sums over voxels.
struct LightSums {
    dvec3 light{0};
    double luminance = 0, of_voxels = 0; // of_voxels: luminance at voxel centers
    double out_of_gamut = 0, deviation = 0;

    void add(const LightSums& other) {
        light += other.light, luminance += other.luminance, of_voxels += other.of_voxels;
        out_of_gamut += other.out_of_gamut;
        deviation += other.deviation;
    }
};

// Appends the lower corners of a pool's nonempty bricks, in index space.
void append_corners(const BrickPool& pool, std::vector<ivec3>& corners) {
    size_t at = 0;
    for (int x = 0; x < pool.size.x; ++x)
        for (int y = 0; y < pool.size.y; ++y)
            for (int z = 0; z < pool.size.z; ++z, ++at)
                if (pool.index[at] != 0) corners.push_back(pool.low + ivec3(x, y, z) * 8);
}

std::vector<ivec3> corners_of(const EmissionField& field) {
    std::vector<ivec3> corners;
    for (size_t c = 0; c < 3; ++c)
        if (field.source[c] && (c == 0 || field.source[c] != field.source[0]))
            append_corners(*field.source[c], corners);
    const auto key = [](ivec3 a) { return std::tuple(a.x, a.y, a.z); };
    std::ranges::sort(corners, {}, key);
    corners.erase(std::ranges::unique(corners).begin(), corners.end());
    return corners;
}

// A leaf takes 2 KB even where its brick took almost nothing.
void check_room(size_t leaves, const std::string& name) {
    const double bytes = static_cast<double>(leaves) * sizeof(Leaf);
    const double memory = static_cast<double>(physical_memory());
    if (bytes > memory / 2)
        fail(ExitCode::out_of_memory, name,
             "the emission of its voxels takes " + std::to_string(static_cast<int64_t>(bytes / 1e6)) +
                 " MB. Use larger voxels or a smaller active box");
}

template<class Visit> void visit_voxels(ivec3 corner, const dmat4& index_to_world, const Visit& visit) {
    for (int v = 0; v < 512; ++v) {
        const ivec3 voxel = corner + ivec3(v >> 6, (v >> 3) & 7, v & 7);
        visit(v, vec3(index_to_world * glm::dvec4(dvec3(voxel), 1)));
    }
}

// A quasirandom point in the voxel around `point` (R3 sequence: Roberts 2018): emission is nonlinear between voxels, so
// voxel centers alone would bias the sums.
vec3 spread_in_voxel(vec3 point, int v, const dmat4& index_to_world) {
    const dvec3 place = glm::fract(dvec3(0.8191725133961645, 0.6710436067037893, 0.5497004779019703) * double(v)) - 0.5;
    return point + vec3(glm::dmat3(index_to_world) * place);
}

// Fills a leaf with the luminance at its voxels and returns sums over their volume.
LightSums fill_leaf(const EmissionField& field, const dmat4& index_to_world, Leaf& leaf) {
    const auto limit = static_cast<float>(field.table ? lowest_in_gamut() : 0);
    LightSums sums;
    visit_voxels(leaf.origin, index_to_world, [&](int v, vec3 point) {
        leaf.values[static_cast<size_t>(v)] = luminance(emission_at(field, point));
        const vec3 within = spread_in_voxel(point, v, index_to_world), light = emission_at(field, within);
        sums.light += dvec3(light), sums.luminance += luminance(light), sums.of_voxels += leaf.values[size_t(v)];
        if (field.table && sample_density(*field.source[0], within) < limit) sums.out_of_gamut += luminance(light);
    });
    return sums;
}

double deviation_in(const EmissionField& field, const dmat4& index_to_world, const Leaf& leaf, dvec3 color) {
    double sum = 0;
    visit_voxels(leaf.origin, index_to_world, [&](int v, vec3 point) {
        const dvec3 light(emission_at(field, spread_in_voxel(point, v, index_to_world)));
        const dvec3 off = glm::abs(light - color * double(luminance(vec3(light))));
        sum += off.x + off.y + off.z;
    });
    return sum;
}

// Calls body(i) for 0 <= i < count in parallel and adds up the results in order.
template<class Body> LightSums summed(size_t count, const Body& body) {
    std::vector<LightSums> parts(count);
    parallel_ranges(static_cast<int64_t>(count), 4, [&](int64_t begin, int64_t end) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) parts[i] = body(i);
    });
    LightSums sums;
    for (const LightSums& part : parts) sums.add(part);
    return sums;
}

double sum_of(dvec3 v) { return v.x + v.y + v.z; }

// True if a single grid determines the emission, so that constant bricks emit uniformly.
bool has_one_grid(const EmissionField& field) {
    return (field.table || field.source[1] == field.source[0]) && !field.strength && !field.absorber && !field.albedo;
}

// Moves constant bricks from `corners` to `tiles`, merging neighbors along z.
LightSums take_even_bricks(const EmissionField& field, const dmat4& index_to_world, std::vector<ivec3>& corners,
                           std::vector<Tile>& tiles) {
    LightSums sums;
    if (!has_one_grid(field)) return sums;
    const BrickPool& pool = *field.source[0];
    const auto limit = static_cast<float>(field.table ? lowest_in_gamut() : 0);
    std::erase_if(corners, [&](ivec3 corner) {
        const ivec3 at = (corner - pool.low) / 8;
        const int32_t id = pool.index[static_cast<size_t>((at.x * pool.size.y + at.y) * pool.size.z + at.z)];
        if (id > 0) return false;
        const vec3 light = emission_at(field, vec3(index_to_world * glm::dvec4(dvec3(corner) + 4.0, 1)));
        const double bright = 512 * double(luminance(light));
        sums.light += 512.0 * dvec3(light), sums.luminance += bright, sums.of_voxels += bright;
        if (field.table && pool.constants[static_cast<size_t>(-id - 1)] < limit) sums.out_of_gamut += bright;
        Tile* last = tiles.empty() ? nullptr : &tiles.back();
        const bool goes_on = last && last->value == luminance(light) && last->low.x == corner.x &&
                             last->low.y == corner.y && last->high.z + 1 == corner.z;
        if (goes_on)
            last->high.z += 8;
        else
            tiles.push_back({corner, corner + 7, luminance(light)});
        return true;
    });
    return sums;
}

// deviation_in() for a tile.
double deviation_of(const EmissionField& field, const dmat4& index_to_world, const Tile& tile, dvec3 color) {
    const dvec3 light(emission_at(field, vec3(index_to_world * glm::dvec4(dvec3(tile.low) + 4.0, 1))));
    const dvec3 size(tile.high - tile.low + 1);
    return size.x * size.y * size.z * sum_of(glm::abs(light - color * double(tile.value)));
}
}

LuminanceBricks luminance_bricks(const EmissionField& field, const dmat4& index_to_world, const std::string& name) {
    std::vector<ivec3> corners = corners_of(field);
    SparseVolume volume;
    volume.name = name, volume.index_to_world = index_to_world;
    LightSums sums = take_even_bricks(field, index_to_world, corners, volume.tiles);
    check_room(corners.size(), name);
    volume.leaves.resize(corners.size());
    sums.add(summed(corners.size(), [&](size_t i) {
        volume.leaves[i].origin = corners[i];
        return fill_leaf(field, index_to_world, volume.leaves[i]);
    }));
    float highest = 0;
    for (const Leaf& leaf : volume.leaves) highest = std::max(highest, std::ranges::max(leaf.values));
    for (const Tile& tile : volume.tiles) highest = std::max(highest, tile.value);
    LuminanceBricks result;
    if (!(highest > 0) || !(sums.luminance > 0) || !(sums.of_voxels > 0)) return result;

    const dvec3 color = sums.light / sums.luminance;
    LightSums off = summed(corners.size(), [&](size_t i) {
        LightSums part;
        part.deviation = deviation_in(field, index_to_world, volume.leaves[i], color);
        return part;
    });
    for (const Tile& tile : volume.tiles) off.deviation += deviation_of(field, index_to_world, tile, color);
    for (Leaf& leaf : volume.leaves)
        for (float& value : leaf.values) value /= highest;
    for (Tile& tile : volume.tiles) tile.value /= highest;
    result.bricks = make_bricks(volume);
    result.radiance = vec3(sums.light / sums.of_voxels * double(highest));
    result.spread = static_cast<float>(off.deviation / sum_of(sums.light));
    result.out_of_gamut = static_cast<float>(sums.out_of_gamut / sums.luminance);
    return result;
}

MeanFactor mean_factor(const AlbedoField& field, const PlacedBricks& density) {
    std::vector<ivec3> corners;
    if (density.bricks) append_corners(*density.bricks, corners);
    const auto over_voxels = [&](const auto& add) {
        return summed(corners.size(), [&](size_t i) {
            LightSums sums;
            visit_voxels(corners[i], density.index_to_world, [&](int, vec3 point) {
                const float amount = sample_density(*density.bricks, point);
                if (amount > 0) add(sums, double(amount), dvec3(albedo_factor(field, point)));
            });
            return sums;
        });
    };
    const LightSums sums = over_voxels(
        [](LightSums& to, double amount, dvec3 factor) { to.light += amount * factor, to.luminance += amount; });
    MeanFactor result;
    if (!(sums.luminance > 0)) return result;
    const dvec3 mean = sums.light / sums.luminance;
    const LightSums off = over_voxels(
        [&](LightSums& to, double amount, dvec3 factor) { to.deviation += amount * sum_of(glm::abs(factor - mean)); });
    result.mean = vec3(mean);
    result.spread = static_cast<float>(sum_of(sums.light) > 0 ? off.deviation / sum_of(sums.light) : 0);
    return result;
}
}
