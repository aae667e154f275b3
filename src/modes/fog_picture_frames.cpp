#include "modes/fog_picture_frames.h"

#include "base/parallel.h"
#include "modes/fog_picture_mix.h"

namespace tyndall {
namespace {
constexpr float longest_age = 10; // frames; older ones count less and less

// Least and most light among a pixel and its neighbours: what a light that moved or went out leaves behind lies
// outside.
struct Range {
    vec3 low{infinity}, high{-infinity};
};
Range range_around(const FogPicture& picture, ivec2 pixel) {
    Range range;
    const ivec2 low = glm::max(pixel - 1, 0), high = glm::min(pixel + 1, picture.fog.size - 1);
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
            range.low = glm::min(range.low, picture.fog.at(x, y).radiance);
            range.high = glm::max(range.high, picture.fog.at(x, y).radiance);
        }
    return range;
}
}

void blur_pattern(FogPicture& picture) {
    const ivec2 size = picture.fog.size;
    const FogPicture source = picture;
    parallel_for(size.y, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < size.x; ++x) {
            Scatter sum{vec3(0), 0, 0, 0, vec3(0)};
            std::vector<vec3> parts(picture.per_light.size(), vec3(0));
            float total = 0;
            for (int j = std::max(y - 2, 0); j <= std::min(y + 2, size.y - 1); ++j)
                for (int i = std::max(x - 2, 0); i <= std::min(x + 2, size.x - 1); ++i) {
                    if (!like(source.length.at(i, j), source.length.at(x, y))) continue;
                    const float weight = (std::abs(i - x) == 2 ? 0.5f : 1) * (std::abs(j - y) == 2 ? 0.5f : 1);
                    add(sum, source.fog.at(i, j), weight), total += weight;
                    for (size_t l = 0; l < parts.size(); ++l) parts[l] += source.per_light[l].at(i, j) * weight;
                }
            Scatter& result = picture.fog.at(x, y);
            const int steps = result.steps;
            result = {vec3(0), 0, 0, steps, vec3(0)};
            add(result, sum, 1 / total);
            for (size_t l = 0; l < parts.size(); ++l) picture.per_light[l].at(x, y) = parts[l] / total;
        }
    });
}

void go_on_from(const FogPicture& before, FogPicture& picture) {
    const FogPicture now = picture;
    parallel_for(now.fog.size.y, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < now.fog.size.x; ++x) {
            const vec3 place = ray_through(now, {x, y}).at(now.length.at(x, y));
            const std::optional<vec2> seen = pixel_of(before.view.camera, before.fog.size, place);
            if (!seen || glm::any(glm::lessThan(*seen, vec2(0))) ||
                glm::any(glm::greaterThan(*seen, vec2(before.fog.size))))
                continue;
            Taps taps = taps_at(before.fog.size, *seen);
            const Camera& eye = before.view.camera;
            const float length =
                eye.ortho_height > 0 ? glm::dot(place - eye.position, eye.forward) : glm::length(place - eye.position);
            const Mixed old = mixed(before, taps, length);
            if (!(old.weight >= enough) || !is_finite(old.fog.radiance)) continue;

            float age = 0;
            for (int k = 0; k < 4; ++k) age += before.age.at(taps.at[k].x, taps.at[k].y) * taps.weight[k];
            age = std::min(age + 1, longest_age);
            const Range range = range_around(now, {x, y});
            const float share = 1 / age;
            Scatter& fog = picture.fog.at(x, y);
            fog.radiance = glm::mix(glm::clamp(old.fog.radiance, range.low, range.high), fog.radiance, share);
            fog.transmittance = glm::mix(old.fog.transmittance, fog.transmittance, share);
            picture.age.at(x, y) = age;
            // Parts keep their shares of the whole.
            for (size_t l = 0; l < now.per_light.size(); ++l)
                picture.per_light[l].at(x, y) *= fog.radiance / glm::max(now.fog.at(x, y).radiance, vec3(1e-30f));
        }
    });
}
}
