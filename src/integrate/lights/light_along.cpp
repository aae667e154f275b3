#include "integrate/lights/light_along.h"

#include "base/random.h"
#include "scene/light.h"
#include "scene/lights/light_filter.h"
#include "scene/lights/light_reach.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
constexpr uint32_t use_light_point = 0x51ce5u; // decorrelates these random numbers from others of the same sample
}

LightPoint light_point(const RayBatch& batch, size_t ray, const Light& light, size_t light_index, uint32_t k,
                       uint32_t count) {
    if (!is_soft(light)) return center_of(light);
    const uint32_t index = static_cast<uint32_t>(light_index);
    Sample2 u, v;
    if (batch.sample_indices.empty()) {
        const uint32_t key =
            k ? hash(batch.ids[ray], use_light_point, index, k) : hash(batch.ids[ray], use_light_point, index);
        u = {to_unit(hash(key, 0u)), to_unit(hash(key, 1u))}, v = {to_unit(hash(key, 2u)), 0};
    } else {
        const SampleIndex sample = batch.sample_indices[ray];
        u = sample2(sample.index * count + k, hash(sample.sequence, use_light_point, index, 0u));
        v = sample2(sample.index * count + k, hash(sample.sequence, use_light_point, index, 1u));
    }
    return point_on(light, batch.rays[ray], {u.x, u.y, v.x});
}

namespace {
double radius_of(const Light& light) { return capped_radius(light); }

void set_cone(const Light& light, LightAlong& along) {
    const double inner = std::cos(double(light.inner_cone)), outer = std::cos(double(light.outer_cone));
    along.cone_scale = 1 / std::max(inner - outer, min_cone_edge(light.outer_cone)),
    along.cone_offset = -outer * along.cone_scale;
}

// Collects the distances at which the intensity of a local light has kinks.
void note_kinks(const Light& light, LightAlong& along) {
    const auto note = [&](Interval<double> stretch) {
        if (!stretch.empty()) along.kinks.push_back(stretch.low), along.kinks.push_back(stretch.high);
    };
    along.kinks.push_back(along.nearest);
    note(chord(along.nearest, along.distance, radius_of(light), glm::length(along.direction)));
    if (has_cone(light)) {
        set_cone(light, along);
        const double full = (1 - along.cone_offset) / along.cone_scale; // cosine of the uniform inner cone
        note(inside_cone(light.position, glm::normalize(dvec3(light.direction)), std::acos(std::min(full, 1.0)),
                         along.origin, along.direction));
    }
}

// The part of the ray whose path to the light may cross the bounding sphere of a box: inside a cylinder for distant
// lights, a cone for local lights.
Interval<double> behind(const Box& box, const LightAlong& along) {
    constexpr double endless = std::numeric_limits<double>::infinity();
    const dvec3 center = 0.5 * (dvec3(box.low) + dvec3(box.high));
    const double radius = glm::length(dvec3(box.high) - center);
    if (along.local()) {
        const dvec3 apex(along.light->position), axis = center - apex;
        const double away = glm::length(axis);
        if (away <= radius * 1.0001) return {-endless, endless};
        return inside_cone(apex, axis / away, std::asin(radius / away), along.origin, along.direction);
    }
    const dvec3 light = glm::normalize(dvec3(along.light->direction));
    const auto across = [&](dvec3 v) { return v - glm::dot(v, light) * light; };
    const dvec3 start = across(along.origin - center), way = across(along.direction);
    const double a = glm::dot(way, way), b = glm::dot(start, way);
    const double inside = b * b - a * (glm::dot(start, start) - radius * radius);
    if (!(a > 0) || !(inside > 0)) return {};
    return {(-b - std::sqrt(inside)) / a, (-b + std::sqrt(inside)) / a};
}

void find_shadowed(std::span<const Medium> media, LightAlong& along) {
    for (const Medium& medium : media) {
        if (medium.density.kind != DensityKind::bricks || medium.density.bricks->empty()) continue;
        const Interval<double> stretch = behind(medium.density.bricks->bounds, along);
        const vec3 voxel = medium.density.bricks->voxel_size;
        if (stretch.empty()) continue;
        along.shadowed.push_back({stretch, 1.0 / std::min({voxel.x, voxel.y, voxel.z})});
        along.kinks.push_back(stretch.low), along.kinks.push_back(stretch.high);
    }
}

// Splits the lit intervals at the kinks and clips them to the range of the light.
void cut_lit(Interval<double> range, LightAlong& along) {
    std::sort(along.kinks.begin(), along.kinks.end());
    static thread_local std::vector<Interval<double>> pieces;
    pieces.clear();
    for (Interval<double> stretch : along.lit) {
        stretch = intersection(stretch, range);
        for (const double kink : along.kinks)
            if (kink > stretch.low && kink < stretch.high) pieces.push_back({stretch.low, kink}), stretch.low = kink;
        if (!stretch.empty()) pieces.push_back(stretch);
    }
    std::swap(pieces, along.lit);
}
}

double LightAlong::distance_to(double low, double high) const {
    if (!local()) return infinity;
    const double off = std::max({low - nearest, nearest - high, 0.0}) * glm::length(direction);
    return std::sqrt(off * off + distance * distance);
}

double LightAlong::height() const { return std::max(distance, radius_of(*light)); }

EquiAngular<double> LightAlong::angles(double low, double high) const {
    return equi_angular(nearest, height(), low, high);
}

double LightAlong::shadow_voxels(double low, double high) const {
    double voxels = 0;
    for (const ShadowedInterval& one : shadowed)
        if (one.stretch.low < high && one.stretch.high > low) voxels = std::max(voxels, one.voxels);
    if (voxels == 0) return 0;
    // Only motion perpendicular to the light direction changes what occludes it.
    if (local()) return voxels * std::min(distance / std::max(distance_to(low, high), 1e-12), 1.0);
    return voxels * glm::length(glm::cross(direction, glm::normalize(dvec3(light->direction))));
}

LightSamplesAt arriving_at(const LightAlong& along, double t) {
    const Light& light = *along.light;
    if (!along.local()) return {-glm::normalize(dvec3(light.direction)), 1};
    const dvec3 towards = (dvec3(light.position) - along.origin) - t * along.direction;
    const double squared = glm::dot(towards, towards), away = std::sqrt(squared), reach = radius_of(light);
    const dvec3 to_light = away > 0 ? towards / away : -dvec3(light.direction);
    double amount = 1 / std::max(squared, reach * reach);
    if (!std::isinf(light.range)) {
        const double share = away / light.range;
        amount *= std::clamp(1 - share * share * share * share, 0.0, 1.0);
    }
    if (has_cone(light)) {
        const double cosine = -glm::dot(to_light, dvec3(light.direction));
        const double edge = std::clamp(cosine * along.cone_scale + along.cone_offset, 0.0, 1.0);
        amount *= edge * edge;
    }
    if (!light.filter || !(amount > 0)) return {to_light, amount};
    const dvec3 factors = filtered(*light.filter, -to_light);
    const double most = std::max({factors.x, factors.y, factors.z});
    return most > 0 ? LightSamplesAt{to_light, amount * most, factors / most} : LightSamplesAt{to_light, 0};
}

void find_light(const Light& light, const LightPoint& point, const Ray& ray, const ShadowSlices* slices,
                std::span<const Medium> media, LightAlong& along) {
    along.light = &light, along.point = point;
    along.origin = dvec3(ray.origin), along.direction = dvec3(ray.direction);
    along.kinks.clear(), along.lit.clear(), along.shadowed.clear();
    Interval<double> range{0, ray.t_max};
    if (along.local()) range = intersection(range, light_reach(light, along.origin, along.direction));
    if (range.empty()) return;
    if (along.local()) {
        const dvec3 towards = dvec3(light.position) - along.origin;
        along.nearest = glm::dot(towards, along.direction) / glm::dot(along.direction, along.direction);
        along.distance = glm::length(towards - along.nearest * along.direction);
        note_kinks(light, along);
    }
    find_shadowed(media, along);
    if (slices && light.shadows) {
        const float end = std::nextafter(static_cast<float>(range.high), infinity);
        find_lit(*slices, {ray.origin, ray.direction, std::min(end, ray.t_max)}, point, along.lit);
    } else {
        along.lit.push_back(range);
    }
    cut_lit(range, along);
}
}
