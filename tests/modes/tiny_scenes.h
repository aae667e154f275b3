// Scenes of one medium and one light, made in memory.
#pragma once
#include "modes/mode.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks.h"
#include "volume/medium.h"
#include "volume/phase.h"
#include "volume/sparse_volume.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <functional>

namespace tyndall::test {
inline Medium even_fog(float extinction, Box box = everywhere(), Phase phase = {PhaseKind::isotropic, 0}) {
    Medium medium;
    medium.name = "even";
    medium.optics = {extinction, vec3(1), phase, vec3(0)};
    medium.bounds = medium.world_bounds = box;
    return medium;
}

inline Light sun(vec3 direction, float lux = 1) {
    Light light;
    light.name = "sun", light.kind = LightKind::sun;
    light.direction = glm::normalize(direction), light.intensity = vec3(lux);
    return light;
}

inline Light point_light(vec3 position, float candela = 1) {
    Light light;
    light.name = "point", light.kind = LightKind::point, light.position = position, light.intensity = vec3(candela);
    return light;
}

inline Snapshot scene_of(std::vector<Medium> media, std::vector<Light> lights, vec3 ambient = vec3(0)) {
    Snapshot snapshot;
    snapshot.media = std::move(media), snapshot.lights = std::move(lights), snapshot.ambient = ambient;
    for (const Medium& medium : snapshot.media)
        if (!std::isinf(medium.world_bounds.low.x)) snapshot.bounds.grow(medium.world_bounds);
    if (snapshot.bounds.empty()) snapshot.bounds = Box{vec3(-10), vec3(10)};
    return snapshot;
}

// A grid of n³ voxels that fills the unit box 0..1; density at voxel centres from `value`.
inline SparseVolume unit_grid(int n, const std::function<float(vec3)>& value) {
    SparseVolume volume;
    volume.index_to_world = glm::scale(dmat4(1), dvec3(1.0 / n));
    volume.index_to_world[3] = glm::dvec4(0.5 / n, 0.5 / n, 0.5 / n, 1);
    volume.active_low = ivec3(0), volume.active_high = ivec3(n - 1);
    for (int x = 0; x < n; x += 8)
        for (int y = 0; y < n; y += 8)
            for (int z = 0; z < n; z += 8) {
                Leaf leaf{{x, y, z}, {}};
                for (int i = 0; i < 512; ++i) {
                    const ivec3 voxel = leaf.origin + ivec3(i / 64, i / 8 % 8, i % 8);
                    leaf.values[i] = value((vec3(voxel) + 0.5f) / static_cast<float>(n));
                }
                volume.leaves.push_back(leaf);
            }
    return volume;
}

inline Medium grid_fog(float extinction, const SparseVolume& volume) {
    Medium medium;
    medium.name = "grid", medium.kind = DensityKind::bricks;
    medium.optics = {extinction, vec3(1), {PhaseKind::isotropic, 0}, vec3(0)};
    medium.bricks = make_bricks(volume);
    medium.world_bounds = medium.bounds = medium.bricks->bounds;
    return medium;
}

inline std::vector<Scatter> marched(const Snapshot& snapshot, const Settings& settings, const std::vector<Ray>& rays) {
    const ScatterFunction scatter = find_mode("march").prepare(View{}, snapshot, settings, nullptr);
    std::vector<Scatter> results(rays.size());
    const std::vector<uint32_t> ids(16, 7);
    for (size_t first = 0; first < rays.size(); first += 16) {
        const size_t count = std::min<size_t>(16, rays.size() - first);
        scatter({std::span(rays).subspan(first, count), std::span(ids).first(count), {}, {}},
                std::span(results).subspan(first, count));
    }
    return results;
}

inline Scatter marched(const Snapshot& snapshot, const Settings& settings, const Ray& ray) {
    return marched(snapshot, settings, std::vector{ray})[0];
}

// The reference, and the sampled march in very short steps.
inline Settings exact_settings() { return settings_for(Quality::reference); }
inline Settings sampled_settings() {
    Settings settings = exact_settings();
    settings.march.visibility = Visibility::rays;
    settings.march.step_depth = 0.02f, settings.march.step_voxels = 0.5f, settings.march.step_share = 1.0f / 512;
    settings.march.near_light = 0.1f;
    return settings;
}

// Steps as short, inside lit stretches.
inline Settings sliced_settings() {
    Settings settings = sampled_settings();
    settings.march.visibility = Visibility::slices;
    return settings;
}

// ∫ f over a..b by composite Gauss–Legendre with 5 nodes on `pieces` pieces.
inline double integral(const std::function<double(double)>& f, double a, double b, int pieces = 4000) {
    constexpr double x[] = {0, 0.5384693101056831, 0.9061798459386640},
                     w[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
    double sum = 0;
    for (int i = 0; i < pieces; ++i) {
        const double half = 0.5 * (b - a) / pieces, middle = a + (2 * i + 1) * half;
        sum += half * w[0] * f(middle);
        for (int k = 1; k < 3; ++k) sum += half * w[k] * (f(middle - half * x[k]) + f(middle + half * x[k]));
    }
    return sum;
}
}
