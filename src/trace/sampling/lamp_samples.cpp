#include "trace/sampling/lamp_samples.h"

#include "base/random.h"
#include "scene/light.h"
#include "trace/snapshot.h"

#include <algorithm>
#include <array>

namespace tyndall {
namespace {
constexpr uint32_t candidates = 32; // even ones sample the filter, odd ones lamps in the pixel
constexpr uint32_t use_lamp = 0x1a3bu, use_choice = 0x1a3cu;
constexpr float min_distance = 1e-4f; // pixels, below which the glow is clamped
constexpr float beside_share = 0.02f; // fraction of the glow outside a spot's beam
constexpr float away_glow = 0.125f;   // everywhere: the glow of a lamp 8 pixels away

// The beam of a spot in the image: planes through the line of sight touch its cone of half angle θ at an angle ψ from
// the axis in the image, sin ψ = sin θ / sin β, with β between the axis and the line of sight.
void set_beam(const View& view, const Light& light, View::Lamp& lamp) {
    const bool flat = view.camera.ortho_height > 0;
    const vec3 sight = flat ? view.camera.forward : glm::normalize(light.position - view.camera.position);
    const vec3 across = light.direction - glm::dot(light.direction, sight) * sight;
    const float sine = glm::length(across), reach = std::sin(std::min(light.outer_cone, pi / 2));
    if (!has_cone(light) || light.outer_cone >= pi / 2 || reach >= sine) return;
    const float step = 1e-3f * std::max(glm::distance(light.position, view.camera.position), light.core);
    const std::optional<vec2> beside = pixel_of(view.camera, view.size, light.position + step / sine * across);
    if (!beside || *beside == lamp.at) return;
    lamp.axis = glm::normalize(*beside - lamp.at), lamp.half_angle = std::asin(reach / sine);
}

bool in_beam(const View::Lamp& lamp, vec2 off, float distance) {
    return lamp.half_angle >= pi || glm::dot(off, lamp.axis) >= distance * std::cos(lamp.half_angle);
}

// Of all lamps, taken as equally bright.
float glow(const View& view, vec2 position) {
    float sum = away_glow;
    for (const View::Lamp& lamp : view.lamps) {
        const vec2 off = position - lamp.at;
        const float distance = glm::length(off);
        sum += (in_beam(lamp, off, distance) ? 1 : beside_share) / std::max({distance, lamp.radius, min_distance});
    }
    return sum;
}

// A lamp inside a pixel's filter: samples points of its beam up to `reach` pixels away, uniform in distance and angle.
struct Beam {
    const View::Lamp* lamp;
    float reach;

    vec2 point(vec2 u) const {
        const float distance = reach * u.x, angle = lamp->half_angle * (2 * u.y - 1);
        const vec2 side(-lamp->axis.y, lamp->axis.x);
        return lamp->at + distance * (std::cos(angle) * lamp->axis + std::sin(angle) * side);
    }
    float density(vec2 position) const { // per square pixel
        const vec2 off = position - lamp->at;
        const float distance = glm::length(off);
        if (distance > reach || !in_beam(*lamp, off, distance)) return 0;
        return 1 / (2 * lamp->half_angle * reach * std::max(distance, 1e-12f));
    }
};

struct Beams {
    std::array<Beam, 4> beams;
    uint32_t count = 0;
};

Beams beams_in(const View& view, vec2 center) {
    Beams result;
    for (const View::Lamp& lamp : view.lamps) {
        const vec2 off = glm::abs(lamp.at - center);
        if (std::max(off.x, off.y) >= view.filter_radius || result.count == result.beams.size()) continue;
        result.beams[result.count++] = {&lamp, glm::length(off + view.filter_radius)};
    }
    return result;
}
}

std::vector<View::Lamp> lamps_in(const View& view, const Snapshot& snapshot) {
    std::vector<View::Lamp> lamps;
    if (view.filter == PixelFilter::center || snapshot.media.empty()) return lamps;
    for (const Light& light : snapshot.lights) {
        const std::optional<vec2> at =
            is_distant(light) ? std::nullopt : pixel_of(view.camera, view.size, light.position);
        if (!at) continue;
        const vec3 rim = light.position + light.radius * view.camera.right;
        View::Lamp lamp{*at, glm::distance(*at, pixel_of(view.camera, view.size, rim).value_or(*at))};
        if (view.camera.lens) { // adds its defocus blur
            const float depth = glm::dot(light.position - view.camera.position, view.camera.forward);
            lamp.radius += 0.5f * blur_diameter(view.camera, view.size, depth);
        }
        set_beam(view, light, lamp);
        lamps.push_back(lamp);
    }
    return lamps;
}

bool beside_lamp(const View& view, vec2 center) {
    const float reach = view.filter_radius;
    return std::ranges::any_of(view.lamps, [&](const View::Lamp& lamp) {
        return lamp.radius < reach && glm::distance(lamp.at, center) < reach + lamp.radius;
    });
}

SamplePoint lamp_sample(const View& view, vec2 center, SampleIndex sample) {
    const float radius = view.filter_radius;
    const Beams seen = beams_in(view, center);
    const float filter_share = seen.count ? 0.5f : 1.0f;
    const uint32_t lamp_sequence = hash(sample.sequence, use_lamp);
    std::array<vec2, candidates> points;
    std::array<float, candidates> sums;
    float sum = 0;
    for (uint32_t k = 0; k < candidates; ++k) {
        const bool of_lamp = seen.count && k % 2;
        const uint32_t index = sample.index * candidates + k;
        const Sample2 u = sample2(seen.count ? index / 2 : index, of_lamp ? lamp_sequence : sample.sequence);
        points[k] = of_lamp ? seen.beams[k / 2 % seen.count].point({u.x, u.y})
                            : center + radius * filter_point(view.filter, {u.x, u.y});

        // Target density over sampling density, the latter summed over both techniques (balance heuristic).
        const float wanted = filter_density(view.filter, (points[k] - center) / radius) / (radius * radius);
        float density = filter_share * wanted;
        for (uint32_t b = 0; b < seen.count; ++b)
            density += (1 - filter_share) / static_cast<float>(seen.count) * seen.beams[b].density(points[k]);
        sums[k] = sum += wanted > 0 ? wanted * glow(view, points[k]) / density : 0;
    }
    const float wanted = sum * to_unit(hash(sample.sequence, sample.index, use_choice));
    const size_t chosen = std::min<size_t>(std::ranges::upper_bound(sums, wanted) - sums.begin(), candidates - 1);
    return {points[chosen], sum / (candidates * glow(view, points[chosen]))};
}
}
