#include "modes/fog_buffer.h"

#include "base/parallel.h"
#include "modes/fog_buffer_mix.h"
#include "volume/rays/fog_reach.h"

namespace tyndall {
namespace {
constexpr float longest_age = 10; // frames; beyond, an exponential average
// Limits on what accumulates over these frames when fog moves across the image:
constexpr float max_smear = 0.5f; // pixels of parallax between near and far fog
constexpr float max_blur = 0.1f;  // pixels² of variance added by bilinear resampling

// Range of radiance in a pixel's 3×3 neighborhood; ghosts of lights that moved or went out lie outside it.
struct Range {
    vec3 low{infinity}, high{-infinity};
};
Range range_around(const FogBuffer& buffer, ivec2 pixel) {
    Range range;
    const ivec2 low = glm::max(pixel - 1, 0), high = glm::min(pixel + 1, buffer.fog.size - 1);
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
            range.low = glm::min(range.low, buffer.fog.at(x, y).radiance);
            range.high = glm::max(range.high, buffer.fog.at(x, y).radiance);
        }
    return range;
}

// Mean position, as a fraction of a segment, from which the light of homogeneous fog comes: 1/τ - T/(1 - T), the mean
// of s under the density e^(-τs), 0 <= s <= 1.
float mean_share(float transmittance) {
    const float depth = -std::log(std::clamp(transmittance, 1e-6f, 1.0f));
    return depth < 0.05f ? 0.5f - depth / 12 : 1 / depth - transmittance / (1 - transmittance);
}

// Where the last frame shows a ray's fog.
struct Seen {
    vec2 pixel{0};   // of the mean position of its light
    float smear = 0; // pixels between the near and far half of that light
};
std::optional<Seen> seen_before(const FogBuffer& before, const Interval<float>& fog, const Ray& ray,
                                float transmittance) {
    const auto pixel = [&](float share) {
        return pixel_of(before.view.camera, before.fog.size, ray.at(glm::mix(fog.low, fog.high, share)));
    };
    const float middle = mean_share(transmittance);
    const std::optional<vec2> light = pixel(middle), near = pixel(0.5f * middle), far = pixel(1.5f * middle);
    if (!light || !near || !far) return {};
    return Seen{*light, glm::distance(*near, *far)};
}

// Variance of the bilinear kernel at a position, pixels²: the blur that one resampling adds.
float blur_of(vec2 pixel) {
    const vec2 share = glm::fract(pixel - 0.5f);
    return glm::dot(share, 1.0f - share);
}
}

void blur_pattern(FogBuffer& buffer) {
    const ivec2 size = buffer.fog.size;
    const FogBuffer source = buffer;
    parallel_for(size.y, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < size.x; ++x) {
            Scatter sum{vec3(0), 0, 0, 0, vec3(0)};
            std::vector<vec3> parts(buffer.parts.size(), vec3(0));
            float total = 0;
            for (int j = std::max(y - 2, 0); j <= std::min(y + 2, size.y - 1); ++j)
                for (int i = std::max(x - 2, 0); i <= std::min(x + 2, size.x - 1); ++i) {
                    if (!similar_length(source.length.at(i, j), source.length.at(x, y))) continue;
                    const float weight = (std::abs(i - x) == 2 ? 0.5f : 1) * (std::abs(j - y) == 2 ? 0.5f : 1);
                    add(sum, source.fog.at(i, j), weight), total += weight;
                    for (size_t l = 0; l < parts.size(); ++l) parts[l] += source.parts[l].at(i, j) * weight;
                }
            Scatter& result = buffer.fog.at(x, y);
            const int steps = result.steps;
            result = {vec3(0), 0, 0, steps, vec3(0)};
            add(result, sum, 1 / total);
            for (size_t l = 0; l < parts.size(); ++l) buffer.parts[l].at(x, y) = parts[l] / total;
        }
    });
}

void accumulate_fog(const FogBuffer& before, std::span<const Medium> media, FogBuffer& buffer) {
    const FogBuffer now = buffer;
    parallel_for(now.fog.size.y, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < now.fog.size.x; ++x) {
            Ray ray = ray_through(now, {x, y});
            ray.t_max = now.length.at(x, y);
            const Interval<float> stretch = fog_interval(media, ray);
            if (stretch.empty()) continue;
            const std::optional<Seen> seen = seen_before(before, stretch, ray, now.fog.at(x, y).transmittance);
            if (!seen || !glm::all(glm::greaterThanEqual(seen->pixel, vec2(0))) ||
                !glm::all(glm::lessThanEqual(seen->pixel, vec2(before.fog.size))))
                continue;
            Taps taps = taps_at(before.fog.size, seen->pixel);
            const Camera& eye = before.view.camera;
            const vec3 place = ray.at(ray.t_max);
            const float length =
                eye.ortho_height > 0 ? glm::dot(place - eye.position, eye.forward) : glm::length(place - eye.position);
            const Mixed old = mixed(before, taps, length);
            if (!(old.weight >= min_weight) || !is_finite(old.fog.radiance)) continue;

            float age = 0;
            for (int k = 0; k < 4; ++k) age += before.age.at(taps.at[k].x, taps.at[k].y) * taps.weight[k];
            const float sharp = 1 + max_blur / blur_of(seen->pixel), still = max_smear / seen->smear;
            age = std::max(1.0f, std::min({age + 1, longest_age, sharp, still}));
            const Range range = range_around(now, {x, y});
            const float share = 1 / age;
            Scatter& fog = buffer.fog.at(x, y);
            fog.radiance = glm::mix(glm::clamp(old.fog.radiance, range.low, range.high), fog.radiance, share);
            fog.transmittance = glm::mix(old.fog.transmittance, fog.transmittance, share);
            buffer.age.at(x, y) = age;
            // Parts keep their fractions of the total; where the new frame has no light, the history's goes to the
            // first part.
            for (int c = 0; c < 3 && !now.parts.empty(); ++c) {
                const float whole = now.fog.at(x, y).radiance[c];
                if (whole > 0)
                    for (Image<vec3>& part : buffer.parts) part.at(x, y)[c] *= fog.radiance[c] / whole;
                else
                    buffer.parts[0].at(x, y)[c] = fog.radiance[c];
            }
        }
    });
}
}
