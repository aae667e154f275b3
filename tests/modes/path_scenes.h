// Means of many paths, and scenes with surfaces made in memory.
#pragma once
#include "tiny_scenes.h"
#include "trace/scene_fixtures.h"

#include "base/parallel.h"
#include "base/random.h"

#include <mutex>

namespace tyndall::test {
// Mean and standard error of what paths along one ray bring, from independent batches.
struct Estimate {
    dvec3 value{0}, error{0};
};

// `part` picks what counts of a sample. 64 batches of `samples` each, every batch a sequence of its own.
template<class Part> Estimate estimate(const ScatterFunction& scatter, const Ray& ray, int samples, const Part& part) {
    constexpr int batches = 64;
    std::vector<dvec3> means(batches, dvec3(0));
    parallel_for(batches, [&](int64_t b) {
        for (int first = 0; first < samples; first += 16) {
            const size_t count = static_cast<size_t>(std::min(16, samples - first));
            Ray rays[16];
            uint32_t ids[16];
            SamplePlace places[16];
            Scatter results[16];
            for (size_t i = 0; i < count; ++i) {
                const uint32_t index = static_cast<uint32_t>(first) + static_cast<uint32_t>(i);
                rays[i] = ray;
                ids[i] = hash(index, static_cast<uint32_t>(b), 77u);
                places[i] = {hash(static_cast<uint32_t>(b), 78u), index};
            }
            scatter({{rays, count}, {ids, count}, {}, {}, {places, count}}, {results, count});
            for (size_t i = 0; i < count; ++i) means[b] += dvec3(part(results[i])) / static_cast<double>(samples);
        }
    });
    Estimate result;
    for (const dvec3& mean : means) result.value += mean / static_cast<double>(batches);
    for (const dvec3& mean : means) result.error += (mean - result.value) * (mean - result.value);
    result.error = glm::sqrt(result.error / static_cast<double>(batches * (batches - 1)));
    return result;
}

inline vec3 all_light(const Scatter& s) { return s.radiance + s.surface; }
inline vec3 fog_light(const Scatter& s) { return s.radiance; }
inline vec3 surface_light(const Scatter& s) { return s.surface; }

inline ScatterFunction path_mode(const Snapshot& snapshot, int orders = all_orders) {
    Settings settings;
    settings.path.orders = orders;
    return find_mode("path").prepare(View{}, snapshot, settings, nullptr);
}

inline Estimate traced(const Snapshot& snapshot, const Ray& ray, int samples, int orders = all_orders) {
    return estimate(path_mode(snapshot, orders), ray, samples, all_light);
}

// Surfaces of a scene, added to a snapshot that points to it.
inline void add_surfaces(const Scene& scene, Snapshot& snapshot) {
    snapshot.scene = &scene;
    snapshot.occluders = Occluders::make(scene, 0, nullptr);
    snapshot.bounds.grow(snapshot.occluders->bounds());
}

inline Material lambert(vec3 base_color, vec3 emission = vec3(0)) {
    Material material;
    material.base_color = base_color, material.emission = emission;
    return material;
}

// A floor of `half` metres to each side at a height, facing up and down alike.
inline Mesh floor_at(float height, float half, int material = -1) {
    return quad({-half, height, -half}, {2 * half, 0, 0}, {0, 0, 2 * half}, material);
}
}
