#include "integrate/ray_estimate.h"

#include "base/parallel.h"
#include "base/random.h"

namespace tyndall {
RayEstimate estimate_ray(const ScatterFunction& scatter, const Ray& ray, int samples,
                         const std::function<vec3(const Scatter&)>& part) {
    constexpr int batches = 64;
    std::vector<dvec3> means(batches, dvec3(0));
    parallel_for(batches, [&](int64_t b) {
        for (int first = 0; first < samples; first += 16) {
            const size_t count = static_cast<size_t>(std::min(16, samples - first));
            Ray rays[16];
            uint32_t ids[16];
            SampleIndex sample_indices[16];
            Scatter results[16];
            for (size_t i = 0; i < count; ++i) {
                const uint32_t index = static_cast<uint32_t>(first) + static_cast<uint32_t>(i);
                rays[i] = ray;
                ids[i] = hash(index, static_cast<uint32_t>(b), 77u);
                sample_indices[i] = {hash(static_cast<uint32_t>(b), 78u), index};
            }
            scatter({.rays = {rays, count}, .ids = {ids, count}, .sample_indices = {sample_indices, count}},
                    {results, count});
            for (size_t i = 0; i < count; ++i) means[b] += dvec3(part(results[i])) / static_cast<double>(samples);
        }
    });
    RayEstimate result;
    for (const dvec3& mean : means) result.value += mean / static_cast<double>(batches);
    for (const dvec3& mean : means) result.error += (mean - result.value) * (mean - result.value);
    result.error = glm::sqrt(result.error / static_cast<double>(batches * (batches - 1)));
    return result;
}
}
