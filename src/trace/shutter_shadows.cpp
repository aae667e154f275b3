#include "trace/shutter_shadows.h"

#include "scene/pose.h"
#include "scene/scene.h"
#include "trace/lights/light_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tyndall {
namespace {
constexpr size_t max_rays = 2048, max_of_pair = 256;
constexpr int places = 8;           // points of a ray
constexpr float cone_margin = 0.1f; // radians: surfaces between the chosen points reach into the beam
constexpr float nowhere = std::numeric_limits<float>::quiet_NaN();

// The size of a light that is not a point: nearer surfaces throw no shadow with an edge.
float size_of(const LightSource& light, double seconds) {
    if (light.kind != LightKind::rectangle) return is_distant(light) ? 0 : light.radius.at(seconds);
    return 0.5f * std::max(light.width.at(seconds), light.height.at(seconds));
}

struct Pair {
    size_t light, instance;
};

// Lights and meshes whose shadows move, because either does.
std::vector<Pair> moving_pairs(const Scene& scene) {
    std::vector<Pair> pairs;
    std::vector<bool> moves;
    for (const LightSource& light : scene.lights) {
        const auto& place = is_distant(light) ? light.direction : light.position;
        moves.push_back(light.node >= 0 ? is_moving(scene, light.node) : !place.constant());
    }
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        if (instance.mesh < 0 || !instance.casts_shadows) continue;
        if (scene.meshes[static_cast<size_t>(instance.mesh)].triangles.empty()) continue;
        const bool itself = is_moving(scene, instance);
        for (size_t k = 0; k < scene.lights.size(); ++k) {
            const LightSource& light = scene.lights[k];
            const bool shadows = light.shadows && (light.casters.empty() || light.casters[i]);
            if (shadows && (itself || moves[k])) pairs.push_back({k, i});
        }
    }
    return pairs;
}

// The i-th of `count` points spread over the edges of a mesh: their ends, and with more points than edges also places
// between, as the nearest one throws the fastest shadow. `first` shifts the choice.
ShadowRay ray_through(const Mesh& mesh, Pair pair, size_t i, size_t count, size_t first) {
    const size_t edges = 3 * mesh.triangles.size();
    const size_t edge = ((count <= edges ? i * edges / count : i) + first) % edges;
    const auto pass = static_cast<uint32_t>(count <= edges ? 0 : i / edges);
    const glm::uvec3 triangle = mesh.triangles[edge / 3];
    const int corner = static_cast<int>(edge % 3);
    const float share = std::ldexp(static_cast<float>(glm::bitfieldReverse(pass)), -32); // 0, 1/2, 1/4, 3/4, ...
    return {pair.light, pair.instance, triangle[corner], triangle[(corner + 1) % 3], share, 0};
}

// Positions of a ray's light and of its point on the mesh; keeps what rays in sequence share.
struct Places {
    const Scene& scene;
    double seconds;
    std::vector<NodeFrame> lights{};
    size_t instance = SIZE_MAX;
    Pose pose{};
    mat4 matrix{1};

    Places(const Scene& of, double at) : scene(of), seconds(at) {
        for (const LightSource& light : scene.lights) lights.push_back(light_frame(scene, light, seconds));
    }

    vec3 on_mesh(const ShadowRay& ray) {
        const Instance& one = scene.instances[ray.instance];
        if (ray.instance != instance)
            pose = pose_of(scene, one, seconds), matrix = instance_matrix(scene, one, seconds), instance = ray.instance;
        const Mesh& mesh = scene.meshes[static_cast<size_t>(one.mesh)];
        const vec3 from = posed_position(mesh, pose, ray.from), to = posed_position(mesh, pose, ray.to);
        return vec3(matrix * vec4(glm::mix(from, to, ray.share), 1));
    }
};

bool shines_along(const LightSource& light, vec3 forward, vec3 direction, double seconds) {
    const float cosine = glm::dot(forward, direction);
    if (has_cone(light)) return cosine > std::cos(std::min(light.outer_cone.at(seconds) + cone_margin, pi));
    return !is_aimed(light) || light.two_sided || cosine > 0;
}
}

std::vector<ShadowRay> shadow_rays(const Scene& scene, double seconds, float extent) {
    const std::vector<Pair> pairs = moving_pairs(scene);
    const size_t used = std::min(pairs.size(), max_rays);
    std::vector<ShadowRay> rays;
    Places at(scene, seconds);
    for (size_t k = 0; k < used; ++k) {
        const Pair pair = pairs[k * pairs.size() / used];
        const LightSource& light = scene.lights[pair.light];
        const Mesh& mesh = scene.meshes[static_cast<size_t>(scene.instances[pair.instance].mesh)];
        const float size = size_of(light, seconds), reach = std::min(light.range.at(seconds), extent);
        const size_t count = std::min(max_rays / used, max_of_pair);
        for (size_t i = 0; i < count; ++i) {
            ShadowRay ray = ray_through(mesh, pair, i, count, k);
            ray.distance = glm::distance(at.on_mesh(ray), at.lights[pair.light].position);
            if (is_distant(light) || (ray.distance > size && ray.distance < reach)) rays.push_back(ray);
        }
    }
    return rays;
}

void add_shadows(const Scene& scene, const std::vector<ShadowRay>& rays, double seconds, float extent,
                 std::vector<vec3>& points) {
    Places at(scene, seconds);
    for (const ShadowRay& ray : rays) {
        const LightSource& light = scene.lights[ray.light];
        const NodeFrame& frame = at.lights[ray.light];
        const vec3 mesh = at.on_mesh(ray);
        const bool distant = is_distant(light);
        const float nearest = distant ? extent / 128 : ray.distance;
        const float reach = std::min(light.range.at(seconds), extent);
        const vec3 origin = distant ? mesh : frame.position;
        vec3 direction = distant ? frame.forward : glm::normalize(mesh - origin);
        if (!distant && !shines_along(light, frame.forward, direction, seconds)) direction = vec3(nowhere);
        for (int i = 0; i < places; ++i) {
            const float step = static_cast<float>(i) / (places - 1);
            points.push_back(origin + nearest * std::pow(reach / nearest, step) * direction);
        }
    }
}
}
