#include "trace/lights/enclosed_lights.h"

#include "base/error.h"
#include "base/text.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"

#include <map>
#include <optional>

namespace tyndall {
namespace {
constexpr int directions = 256;
constexpr float near_share = 0.1f;    // of the scene's extent: surfaces farther away count as a room
constexpr double all_blocked = 0.95;  // of the light: an open bulb's neck lets out less than the rest, a shade more
constexpr double of_one_object = 0.8; // fraction of the light
constexpr double around_spot = 0.75;  // of all directions: a spot's housing blocks more, an illuminated surface half

// Uniform over the directions whose cosine with the light's exceeds `lowest` (a Fibonacci lattice).
vec3 direction_of(const Light& light, float lowest, int i) {
    const float golden = 2.3999632f; // π (3 - √5)
    const float cosine = 1 - (1 - lowest) * (static_cast<float>(i) + 0.5f) / directions;
    const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine)), turned = golden * static_cast<float>(i);
    vec3 x, y;
    make_frame(light.direction, x, y);
    return sine * std::cos(turned) * x + sine * std::sin(turned) * y + cosine * light.direction;
}

// What blocks a light within a distance; the search ends once less than `least` can be blocked.
struct Surroundings {
    double blocked = 0;            // fraction of its light
    std::map<int, double> by_node; // of that, by the node that is hit first
    std::map<int, int> instance;   // an instance of each node that was hit
    float farthest = 0;            // distance of a hit
};

Surroundings look_around(const Light& light, float lowest, double least, const Occluders& occluders, const Scene& scene,
                         float distance) {
    Surroundings around;
    const float start = std::max(light.radius, shadow_offset(light.position));
    double open = 0;
    for (int i = 0; i < directions; ++i) {
        // In scattered order, so that most lights turn out to be free after a few rays.
        const Ray ray{light.position, direction_of(light, lowest, i * 97 % directions), distance};
        Hits hits;
        occluders.closest({&ray, 1}, start, hits);
        const double share = (1 - occluders.transmission(ray, start)) / directions;
        open += 1.0 / directions - share;
        if (open > 1 - least) break;
        if (hits.instance[0] < 0) continue;
        const int node = scene.instances[static_cast<size_t>(hits.instance[0])].node;
        around.blocked += share, around.by_node[node] += share;
        around.instance[node] = hits.instance[0];
        around.farthest = std::max(around.farthest, hits.t[0]);
    }
    return around;
}

// Whether a camera is inside as well, or sees the light.
bool seen_by_camera(const Light& light, const Snapshot& snapshot, const Occluders& occluders, float farthest) {
    for (size_t i = 0; i < snapshot.scene->cameras.size(); ++i) {
        const vec3 eye = camera_at(*snapshot.scene, static_cast<int>(i), snapshot.seconds).position;
        const float away = glm::distance(eye, light.position);
        if (!(away > farthest)) return true;
        const float start = std::max(light.radius, shadow_offset(light.position));
        const Ray ray{light.position, (eye - light.position) / away, away};
        const float cosine = glm::dot(ray.direction, light.direction);
        const bool shone_at = !has_cone(light) || cosine >= std::cos(light.outer_cone);
        if (shone_at && occluders.transmission(ray, start) > 0) return true;
    }
    return false;
}

std::optional<std::string> line_of(const Light& light, const Snapshot& snapshot) {
    const auto& occluders = shadow_casters(light, snapshot);
    if (!occluders || is_distant(light)) return {};
    const auto look = [&](float lowest, double least) {
        return look_around(light, lowest, least, *occluders, *snapshot.scene, near_share * snapshot.extent);
    };
    const Surroundings around = look(has_cone(light) ? std::cos(light.outer_cone) : -1, all_blocked);
    if (around.blocked < all_blocked) return {};
    if (has_cone(light) && look(-1, around_spot).blocked < around_spot) return {};
    const auto by_share = [](const auto& a, const auto& b) { return a.second < b.second; };
    const auto most = std::ranges::max_element(around.by_node, by_share);
    if (most->second < of_one_object || seen_by_camera(light, snapshot, *occluders, around.farthest)) return {};
    const std::string object = printable(name_of_instance(*snapshot.scene, around.instance.at(most->first)), 80);
    return named("light", printable(light.name, 80)) + " is enclosed by the object \"" + object + "\": " +
           formatted("%.0f %% of its light is blocked within %.2g m", 100 * around.blocked, double(around.farthest)) +
           "; to let it through, add {\"name\": \"" + object + "\", \"casts_shadows\": false} to \"objects\"";
}
}

std::vector<std::string> enclosed_lights(const Snapshot& snapshot) {
    std::vector<std::string> lines;
    if (!snapshot.scene) return lines;
    for (const Light& light : snapshot.lights)
        if (std::optional<std::string> line = line_of(light, snapshot)) lines.push_back(*std::move(line));
    return lines;
}

std::vector<std::string> enclosed_lights(const Scene& scene) {
    Scene clear = scene;
    std::erase_if(clear.media, [](const MediumSource& medium) { return medium.kind == MediumKind::vdb; });
    for (MediumSource& medium : clear.media) { // keeps the scene's extent
        if (medium.kind == MediumKind::noise) medium.bounds = medium.recipe->bounds;
        medium.kind = MediumKind::homogeneous;
    }
    return enclosed_lights(make_snapshot(clear, moment_of(clear, clear.first_frame)));
}
}
