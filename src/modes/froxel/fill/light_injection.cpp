#include "modes/froxel/fill/light_injection.h"

#include "base/gauss_legendre.h"
#include "base/random.h"
#include "integrate/lights/light_along.h"
#include "scene/lights/light_reach.h"

#include <array>

namespace tyndall {
namespace {
LightPoint light_point(const Light& light, const Ray& ray, uint32_t index, uint32_t seed) {
    if (!is_soft(light)) return center_of(light);
    const Sample2 u = sample2(index, seed);
    return point_on(light, ray, {u.x, u.y, random_unit(index, 0, 2, seed)});
}

struct Moments {
    double amount = 0, first = 0; // ∫ of the light along the ray, and of light times t
};

// Light on a segment without kinks: 2 Gauss points along it or, near the light, 4 in the angle seen from it
// (equi-angular).
Moments light_on(const LightAlong& along, const NearLight& near, double low, double high) {
    const double length = high - low;
    if (!along.local()) return {length, length * 0.5 * (low + high)};
    Moments sum;
    const auto add = [&](double t, double weight) {
        const double off = t - along.nearest, distance = std::sqrt(off * off + along.distance * along.distance);
        const double light = weight * arriving_at(along, t).amount * (1 - near.at(static_cast<float>(distance)));
        sum.amount += light, sum.first += light * t;
    };
    if (length < 0.25 * along.distance_to(low, high)) {
        for (const QuadratureNode& node : gauss_legendre(2)) add(low + length * node.at, length * node.weight);
        return sum;
    }
    const EquiAngular<double> angles =
        equi_angular(along.nearest, std::max(along.distance, 0.1 * double(along.light->core)), low, high);
    for (const QuadratureNode& node : gauss_legendre(4)) {
        const auto [t, stands_for] = angles.at(node.at);
        add(t, stands_for * node.weight);
    }
    return sum;
}

// Adds a lit segment, in lengths of the ray, to the slices it crosses.
void add_stretch(const FroxelGrid& grid, const LightAlong& along, const NearLight& near, Interval<double> stretch,
                 double per_meter, std::vector<Moments>& slices) {
    const auto end = [&](int k) { return grid.faces[static_cast<size_t>(k) + 1] / per_meter; };
    int k = slice_of(grid, static_cast<float>(stretch.low * per_meter));
    while (k > 0 && end(k - 1) > stretch.low) --k;
    for (double low = stretch.low; k < grid.slices() && low < stretch.high; ++k) {
        const double high = std::min(stretch.high, end(k));
        if (!(high > low)) continue;
        if (low * per_meter >= grid.faces[0]) {
            const Moments part = light_on(along, near, low, high);
            slices[static_cast<size_t>(k)].amount += part.amount, slices[static_cast<size_t>(k)].first += part.first;
        }
        low = high;
    }
}

// Lines through up to 16 tiles, up to the surface.
struct Lines {
    std::array<Ray, 16> rays;
    std::array<double, 16> per_meter; // planar depth per meter of the line
    std::array<LightPoint, 16> points;
    uint32_t active = 0; // bits
    int bin = 0;         // block of 8×8 tiles that contains them all
};

Lines find_lines(const FroxelGrid& grid, const FroxelTiles& tiles, const Light& light, uint32_t light_index,
                 const ivec2* lanes, size_t ray, const uint32_t* indices) {
    Lines lines;
    for (size_t lane = 0; lane < 16; ++lane) {
        const ivec2 at = lanes[lane];
        if (at.x >= grid.size.x || at.y >= grid.size.y) continue;
        Ray& line = lines.rays[lane] = line_ray(grid, grid.pixel_of(vec2(at) + tiles.offsets[ray]));
        lines.per_meter[lane] = glm::dot(line.direction, grid.camera.forward);
        const float surface = tiles.depth[grid.tile_index(at) * tiles.rays() + ray];
        line.t_max = static_cast<float>(std::min(grid.faces.back(), surface) / lines.per_meter[lane]);
        if (!(line.t_max * lines.per_meter[lane] > grid.faces.front())) continue;
        // Different points for each block of 4×4 tiles: repeated ones would show as a pattern.
        const auto block = static_cast<uint32_t>((at.y >> 2) * grid.size.x + (at.x >> 2));
        lines.points[lane] =
            indices ? light_point(light, line, indices[lane], hash(block, light_index)) : center_of(light);
        lines.active |= 1u << lane;
        lines.bin = (at.y / shadow_tile_side) * ((grid.size.x + shadow_tile_side - 1) / shadow_tile_side) +
                    at.x / shadow_tile_side;
    }
    return lines;
}

// The segments that see the light: by shadow volumes if all lines see the same point of it, else by slices; all of the
// line without either.
void find_stretches(const FroxelScene& scene, size_t light, const Lines& lines, LitSegments& lit) {
    for (std::vector<Interval<double>>& stretches : lit) stretches.clear();
    if (!lines.active) return;
    if (light < scene.views.size() && scene.views[light]) {
        Interval<double> ranges[16];
        for (size_t lane = 0; lane < 16; ++lane)
            if (lines.active >> lane & 1) ranges[lane] = {0, lines.rays[lane].t_max};
        return append_lit(*scene.views[light], lines.rays, ranges, lines.bin, lit);
    }
    static thread_local std::vector<Ray> rays;
    static thread_local std::vector<LightPoint> points;
    rays.clear(), points.clear();
    for (size_t lane = 0; lane < 16; ++lane)
        if (lines.active >> lane & 1) rays.push_back(lines.rays[lane]), points.push_back(lines.points[lane]);
    const ShadowSlices* slices = light < scene.slices.size() ? scene.slices[light] : nullptr;
    const ShadowSlices near = slices ? coherent_slices(*slices, rays, points) : ShadowSlices{};
    static thread_local LitSegments found;
    find_lit(near, rays, points, found);
    for (size_t lane = 0, i = 0; lane < 16; ++lane)
        if (lines.active >> lane & 1) std::swap(found[i++], lit[lane]);
}

// Adds a segment lit by a sun, in planar depth, to the slices it crosses.
void add_depths(const FroxelGrid& grid, float low, float high, size_t lane, LightInjection::Depths* slices) {
    low = std::max(low, grid.faces.front());
    for (int k = slice_of(grid, low); k < grid.slices() && low < high; ++k) {
        const float end = std::min(high, grid.faces[static_cast<size_t>(k) + 1]);
        if (!(end > low)) continue;
        slices[k].length[lane] += end - low, slices[k].first[lane] += (end - low) * (0.5f * (low + end));
        low = end;
    }
}

void add_sun(const FroxelScene& scene, const FroxelGrid& grid, size_t light, const Lines& lines,
             LightInjection::Depths* slices) {
    static thread_local LitSegments lit;
    find_stretches(scene, light, lines, lit);
    for (size_t lane = 0; lane < 16; ++lane)
        for (const Interval<double>& stretch : lit[lane])
            add_depths(grid, static_cast<float>(stretch.low * lines.per_meter[lane]),
                       static_cast<float>(stretch.high * lines.per_meter[lane]), lane, slices);
}

// Adds the light on one line of a tile to its slices: sums of amounts, and of points times amounts.
void add_line(const FroxelGrid& grid, const Ray& line, double per_meter, const LightAlong& along, const NearLight& near,
              size_t lane, LightInjection::Arrivals* slices) {
    static thread_local std::vector<Moments> moments;
    const double start = grid.faces.front() / per_meter;
    moments.assign(static_cast<size_t>(grid.slices()), {});
    for (const Interval<double>& s : along.lit)
        add_stretch(grid, along, near, {std::max(s.low, start), s.high}, per_meter, moments);
    for (size_t k = 0; k < moments.size(); ++k) {
        if (!(moments[k].amount > 0)) continue;
        const auto amount = static_cast<float>(moments[k].amount);
        const vec3 point = line.at(static_cast<float>(moments[k].first / moments[k].amount));
        slices[k].amount[lane] += amount;
        for (int c = 0; c < 3; ++c) slices[k].point[c][lane] += amount * point[c];
    }
}

// Intersects two ascending lists of intervals.
void keep_common(const std::vector<Interval<double>>& other, std::vector<Interval<double>>& stretches) {
    static thread_local std::vector<Interval<double>> intersection;
    intersection.clear();
    for (size_t i = 0, j = 0; i < stretches.size() && j < other.size();) {
        const Interval<double> both{std::max(stretches[i].low, other[j].low),
                                    std::min(stretches[i].high, other[j].high)};
        if (!both.empty()) intersection.push_back(both);
        (stretches[i].high < other[j].high ? i : j) += 1;
    }
    std::swap(intersection, stretches);
}

// Adds one line of each tile. Shadows are found only where the light reaches.
void add_lines(const FroxelScene& scene, const FroxelGrid& grid, size_t light, Lines lines,
               LightInjection::Arrivals* slices) {
    static thread_local LightAlong along[16];
    static thread_local LitSegments lit;
    for (size_t lane = 0; lane < 16; ++lane) {
        if (!(lines.active >> lane & 1)) continue;
        Ray& ray = lines.rays[lane];
        find_light(scene.snapshot.lights[light], lines.points[lane], ray, nullptr, {}, along[lane]);
        if (along[lane].lit.empty())
            lines.active &= ~(1u << lane);
        else
            ray.t_max = std::min(ray.t_max, std::nextafter(static_cast<float>(along[lane].lit.back().high), infinity));
    }
    find_stretches(scene, light, lines, lit);
    for (size_t lane = 0; lane < 16; ++lane) {
        if (!(lines.active >> lane & 1)) continue;
        keep_common(lit[lane], along[lane].lit);
        add_line(grid, lines.rays[lane], lines.per_meter[lane], along[lane], scene.near(light), lane, slices);
    }
}

// Adds the length of one line of a tile in each slice.
void add_lengths(const FroxelGrid& grid, const Lines& lines, size_t lane, std::vector<double>& lengths) {
    const Ray& line = lines.rays[lane];
    const double per_meter = lines.per_meter[lane];
    for (size_t k = 0; k < lengths.size(); ++k) {
        const double length = std::min<double>(grid.faces[k + 1] / per_meter, line.t_max) - grid.faces[k] / per_meter;
        if (!(length > 0)) return;
        lengths[k] += length;
    }
}

// Adds a local light on the tiles' lines: on all rays of each tile for spots and filters, whose edges cross froxels;
// otherwise on one.
void add_local(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles, size_t light,
               const ivec2* lanes, size_t ray, const uint32_t* indices, LightInjection::Arrivals* slices) {
    static thread_local std::vector<double> lengths[16];
    const Light& shining = scene.snapshot.lights[light];
    const bool all = has_cone(shining) || shining.filter;
    for (std::vector<double>& of_lane : lengths) of_lane.assign(static_cast<size_t>(grid.slices()), 0);
    for (size_t i = all ? 0 : ray; i < (all ? tiles.rays() : ray + 1); ++i) {
        const Lines lines = find_lines(grid, tiles, shining, static_cast<uint32_t>(light), lanes, i, indices);
        for (size_t lane = 0; lane < 16; ++lane)
            if (lines.active >> lane & 1) add_lengths(grid, lines, lane, lengths[lane]);
        add_lines(scene, grid, light, lines, slices);
    }
    // Converts sums over a tile's lines to means.
    for (size_t k = 0; k < lengths[0].size(); ++k)
        for (size_t lane = 0; lane < 16; ++lane) {
            float& amount = slices[k].amount[lane];
            if (!(amount > 0)) continue;
            for (int c = 0; c < 3; ++c) slices[k].point[c][lane] /= amount;
            amount /= static_cast<float>(lengths[lane][k]);
        }
}
}

void find_froxel_lit(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles, const ivec2* lanes,
                     size_t ray, const uint32_t* indices, LightInjection& lit) {
    const std::vector<Light>& lights = scene.snapshot.lights;
    const size_t slices = static_cast<size_t>(grid.slices());
    const auto is_sun = [](const Light& light) { return is_distant(light); };
    const bool suns = std::ranges::any_of(lights, is_sun), all_suns = std::ranges::all_of(lights, is_sun);
    lit.depths.assign(suns ? lights.size() * slices : 0, {});
    lit.arrivals.assign(all_suns ? 0 : lights.size() * slices, {});
    for (size_t i = 0; i < lights.size(); ++i)
        if (scene.is_beam(i))
            continue;
        else if (is_sun(lights[i]))
            add_sun(scene, grid, i, find_lines(grid, tiles, lights[i], static_cast<uint32_t>(i), lanes, ray, indices),
                    lit.depths.data() + i * slices);
        else
            add_local(scene, grid, tiles, i, lanes, ray, indices, lit.arrivals.data() + i * slices);
}

namespace {
// The interval of a line in which the light is integrated per ray.
Interval<double> near_reach(const Light& light, const NearLight& near, const Ray& line) {
    const dvec3 origin(line.origin), direction(line.direction);
    const Interval<double> reach = light_reach(light, origin, direction);
    return std::isinf(near.radius)
               ? reach
               : intersection(reach, inside_ball(dvec3(light.position), near.radius, origin, direction));
}
}

void find_beam_lengths(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles, size_t light,
                       const ivec2* lanes, size_t ray, const uint32_t* indices, const FroxelBeams::Reach* reaches,
                       LightInjection::Depths* inside, LightInjection::Depths* lit) {
    const Light& lamp = scene.snapshot.lights[light];
    Lines lines = find_lines(grid, tiles, lamp, static_cast<uint32_t>(light), lanes, ray, indices);
    Interval<double> chords[16];
    for (size_t lane = 0; lane < 16; ++lane) {
        if (!(lines.active >> lane & 1)) continue;
        Ray& line = lines.rays[lane];
        if (reaches[lane].end > 0)
            chords[lane] = intersection({0, line.t_max}, near_reach(lamp, scene.near(light), line));
        if (chords[lane].empty())
            lines.active &= ~(1u << lane);
        else
            line.t_max = std::min(line.t_max, std::nextafter(static_cast<float>(chords[lane].high), infinity));
    }
    static thread_local LitSegments stretches;
    find_stretches(scene, light, lines, stretches);
    for (size_t lane = 0; lane < 16; ++lane) {
        if (!(lines.active >> lane & 1)) continue;
        const auto add = [&](Interval<double> stretch, LightInjection::Depths* slices) {
            add_depths(grid, static_cast<float>(stretch.low * lines.per_meter[lane]),
                       static_cast<float>(stretch.high * lines.per_meter[lane]), lane, slices);
        };
        add(chords[lane], inside);
        for (const Interval<double>& stretch : stretches[lane])
            if (const Interval<double> part = intersection(stretch, chords[lane]); !part.empty()) add(part, lit);
    }
}
}
