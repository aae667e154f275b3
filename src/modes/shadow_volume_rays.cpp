// Where rays are cut: at shadows, and where the fog changes its kind.
#include "modes/shadow_volume.h"

#include "volume/spans.h"

namespace tyndall {
namespace {
constexpr double most_depth = 2; // optical depth between cuts

bool comes_from(const ShadowView& view, const Camera& camera, const Ray& ray) {
    if (view.parallel) return glm::distance(ray.direction, camera.forward) < 1e-5f;
    const vec3 from = ray.origin - camera.position;
    const float along = glm::dot(from, ray.direction);
    return glm::length(from - along * ray.direction) <= 1e-5f * (0.1f + std::abs(along)) && along > -1e-3f;
}

// The tile all positions lie in, or -1.
int tile_of(const ShadowView& view, std::span<const vec2> positions, float margin) {
    if (positions.empty() || view.tiles.x == 0) return -1;
    vec2 middle(0);
    for (const vec2 p : positions) middle += p / static_cast<float>(positions.size());
    const ivec2 tile = glm::clamp(ivec2(glm::floor(middle / float(shadow_tile_side))), ivec2(0), view.tiles - 1);
    for (const vec2 p : positions) {
        const vec2 low = vec2(tile * shadow_tile_side) - margin, high = vec2((tile + 1) * shadow_tile_side) + margin;
        if (glm::any(glm::lessThan(p, low)) || glm::any(glm::greaterThan(p, high))) return -1;
    }
    return tile.y * view.tiles.x + tile.x;
}

void find_in_view(const ShadowView& view, ShadowRays& rays, const double (&origin)[16],
                  std::vector<ShadowCrossing> (&crossings)[16], int (&dark)[16]) {
    find_crossings(view, rays, crossings);
    for (int i = 0; i < 16; ++i) {
        if (!(rays.active >> i & 1)) continue;
        dark[i] = view.dark;
        for (ShadowCrossing& crossing : crossings[i]) crossing.t -= origin[i];
    }
}

// Density of height fog changes by e^1.5 from one of these levels to the next.
void add_levels(const Medium& medium, const Ray& ray, Stretch inside, std::vector<double>& cuts) {
    const double dy = ray.direction.y, y = ray.origin.y;
    if (std::abs(dy) < 1e-12) return;
    for (int level = 0; level <= 12; ++level) {
        const double t = (medium.height_base + 1.5 * level * medium.height_falloff - y) / dy;
        if (t > inside.low && t < inside.high) cuts.push_back(t);
    }
}

// Where the way from the ray to a light begins to leave a medium's box through another face: the light that fog lets
// through has a kink there. With the way x + u·(light - far·x), far = 0 for suns, the faces f of axes i and j are met
// at the same u where (f_i - x_i)(light_j - far·x_j) = (f_j - x_j)(light_i - far·x_i), which is linear in x.
void add_exits(const Medium& medium, const Light& light, const Ray& ray, Stretch inside, std::vector<double>& cuts) {
    const double far = light.kind == LightKind::sun ? 0 : 1;
    const glm::dvec4 source = far == 0 ? glm::dvec4(-dvec3(light.direction), 0) : glm::dvec4(light.position, 1);
    const dvec3 to(dmat4(medium.world_to_local) * source);
    const LocalRay local = local_ray(medium.world_to_local, ray);
    dvec3 face(0);
    bool leaves[3];
    for (int i = 0; i < 3; ++i) {
        const double low = medium.bounds.low[i], high = medium.bounds.high[i];
        const double beyond = far == 0 ? 0 : high, before = far == 0 ? 0 : low;
        face[i] = to[i] > beyond ? high : low;
        leaves[i] = (to[i] > beyond || to[i] < before) && std::isfinite(face[i]);
    }
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        if (!leaves[i] || !leaves[j]) continue;
        const double of_i = far * face[j] - to[j], of_j = to[i] - far * face[i];
        const double along = of_i * local.direction[i] + of_j * local.direction[j];
        const double t = -(face[i] * to[j] - face[j] * to[i] + of_i * local.origin[i] + of_j * local.origin[j]) / along;
        if (!(t > inside.low && t < inside.high)) continue;
        const dvec3 x = local.origin + t * local.direction, way = to - far * x;
        const double u = (face[i] - x[i]) / way[i];
        if (!leaves[k] || (face[k] - x[k]) / way[k] >= u) cuts.push_back(t);
    }
}

// Divides low..high evenly so that no part holds more than a given optical depth.
void divide(const ShadowVolumeFrame& frame, const Ray& ray, double low, double high, std::vector<double>& cuts) {
    double extinction = 0;
    const vec3 middle = ray.at(static_cast<float>(0.5 * (low + high)));
    for (const Medium& medium : frame.snapshot.media)
        extinction += double(medium.optics.extinction) * density_at(medium, middle);
    const int parts = static_cast<int>(std::clamp(std::ceil(extinction * (high - low) / most_depth), 1.0, 64.0));
    for (int i = 1; i <= parts; ++i) cuts.push_back(low + (high - low) * i / parts);
}

// Steps; the most where the scene is when fog reaches far beyond it.
void add_steps(const ShadowVolumeFrame& frame, const Ray& ray, Stretch fog, std::vector<double>& cuts) {
    const int steps = frame.settings.steps;
    const auto add = [&](double low, double high, int count) {
        const double step = (high - low) / count;
        for (int i = 1; i < count && step > 0; ++i) cuts.push_back(low + step * i);
        if (step > 0) cuts.push_back(high);
    };
    cuts.push_back(fog.low);
    const Interval scene = clip(frame.snapshot.bounds, ray.origin, ray.direction,
                                {static_cast<float>(fog.low), static_cast<float>(fog.high)});
    if (scene.empty() || fog.length() < 2 * double(scene.length())) return add(fog.low, fog.high, steps);
    const int few = std::max(steps / 4, 1);
    add(fog.low, scene.low, few), add(scene.low, scene.high, steps), add(scene.high, fog.high, few);
}
}

void find_cuts(const ShadowVolumeFrame& frame, const Ray& ray, FogCuts& cuts) {
    static thread_local std::vector<double> kinks;
    cuts.at.clear(), kinks.clear();
    Stretch fog{std::numeric_limits<double>::infinity(), 0};
    const double end = std::min<double>(ray.t_max, horizon(ray, frame.snapshot.media));
    for (const Medium& medium : frame.snapshot.media) {
        const bool bricks = medium.kind == DensityKind::bricks;
        const Stretch inside = clip(bricks ? medium.world_bounds : medium.bounds,
                                    local_ray(bricks ? mat4(1) : medium.world_to_local, ray), {0, end});
        if (inside.empty()) continue;
        kinks.push_back(inside.low), kinks.push_back(inside.high);
        if (medium.kind == DensityKind::height) add_levels(medium, ray, inside, kinks);
        if (!frame.sampled)
            for (const Light& light : frame.snapshot.lights) add_exits(medium, light, ray, inside, kinks);
        fog.low = std::min(fog.low, inside.low), fog.high = std::max(fog.high, inside.high);
    }
    if (fog.empty()) return;
    if (frame.sampled) return add_steps(frame, ray, fog, cuts.at);
    std::sort(kinks.begin(), kinks.end());
    cuts.at.push_back(kinks.front());
    for (size_t i = 1; i < kinks.size(); ++i)
        if (kinks[i] > kinks[i - 1]) divide(frame, ray, kinks[i - 1], kinks[i], cuts.at);
}

void find_shadows(const ShadowVolumeFrame& frame, size_t light, const RayBatch& batch, const Stretch (&reached)[16],
                  std::vector<ShadowCrossing> (&crossings)[16], int (&dark)[16]) {
    const ShadowCaster& caster = frame.casters[light];
    ShadowRays rays;
    rays.edges = frame.settings.draw == ShadowDraw::shells;
    double origin[16] = {};
    for (size_t i = 0; i < batch.rays.size(); ++i) {
        crossings[i].clear(), dark[i] = 0;
        if (!caster.volumes.mesh || reached[i].empty()) continue;
        const Ray ray{batch.rays[i].origin, batch.rays[i].direction,
                      std::nextafter(static_cast<float>(reached[i].high), infinity)};
        const int lane = static_cast<int>(i);
        if (comes_from(caster.view, frame.camera, ray)) {
            origin[i] = place_ray(caster.view, ray, lane, rays);
        } else { // not a ray of the camera: its origin is an eye of its own
            ShadowRays alone;
            alone.edges = rays.edges;
            const ShadowView view = view_from(caster.volumes, dvec3(ray.origin));
            double start[16] = {};
            start[i] = place_ray(view, ray, lane, alone);
            find_in_view(view, alone, start, crossings, dark);
        }
    }
    if (!rays.active) return;
    rays.tile = tile_of(caster.view, batch.positions, frame.margin);
    find_in_view(caster.view, rays, origin, crossings, dark);
}
}
