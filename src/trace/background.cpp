// The background, seen where a ray hits no surface: a color, a sky gradient or an image.
#include "base/image.h"
#include "scene/scene.h"
#include "trace/snapshot.h"

namespace tyndall {
namespace {
// Bilinear lookup between pixel centers; clamps at the edges, or wraps around horizontally.
vec3 sample_image(const Image<vec3>& image, vec2 uv, bool wrap) {
    const vec2 position = uv * vec2(image.size) - 0.5f;
    const vec2 corner = glm::floor(position), share = position - corner;
    const auto column = [&](int x) {
        return wrap ? (x % image.size.x + image.size.x) % image.size.x : std::clamp(x, 0, image.size.x - 1);
    };
    const auto row = [&](int y) { return std::clamp(y, 0, image.size.y - 1); };
    const int x0 = column(static_cast<int>(corner.x)), x1 = column(static_cast<int>(corner.x) + 1);
    const int y0 = row(static_cast<int>(corner.y)), y1 = row(static_cast<int>(corner.y) + 1);
    const vec3 upper = glm::mix(image.at(x0, y0), image.at(x1, y0), share.x);
    const vec3 lower = glm::mix(image.at(x0, y1), image.at(x1, y1), share.x);
    return glm::mix(upper, lower, share.y);
}
}

vec2 lat_long_position(vec3 direction, float rotation) {
    const float turn = (std::atan2(direction.x, -direction.z) + rotation) / (2 * pi);
    return {0.5f + turn - std::floor(0.5f + turn), std::acos(std::clamp(direction.y, -1.0f, 1.0f)) / pi};
}

BackgroundState background_at(const Background& background, const Moment& moment) {
    const auto brightness = [&](double seconds) {
        return background.intensity.at(seconds) * std::exp2(background.exposure.at(seconds));
    };
    BackgroundState now;
    now.intensity = mean_brightness(moment, brightness);
    const auto color_of = [&](const Keyed<vec3>& color) {
        if (color.constant() || !(now.intensity > 0)) return color.at(moment.seconds);
        const auto radiance = [&](double seconds) { return brightness(seconds) * color.at(seconds); };
        return mean_brightness(moment, radiance) / now.intensity;
    };
    now.stated = background.stated;
    now.kind = background.kind;
    now.color = color_of(background.color);
    now.zenith = color_of(background.zenith), now.ground = color_of(background.ground);
    now.image = background.image;
    now.lat_long = background.lat_long;
    now.rotation = background.rotation.at(moment.seconds);
    return now;
}

bool has_background(const BackgroundState& background) {
    const vec3 brightest = glm::max(background.color, glm::max(background.zenith, background.ground));
    return background.stated || background.image || max_component(brightest) > 0;
}

vec3 background_radiance(const BackgroundState& background, vec3 direction, vec2 screen) {
    switch (background.kind) {
    case BackgroundKind::color:
        return background.color * background.intensity;
    case BackgroundKind::sky: {
        const vec3 end = direction.y >= 0 ? background.zenith : background.ground;
        const float height = std::clamp(std::abs(direction.y), 0.0f, 1.0f);
        return glm::mix(background.color, end, height * height * (3 - 2 * height)) * background.intensity;
    }
    case BackgroundKind::image: {
        if (!background.image || background.image->empty()) return vec3(0);
        const vec2 uv = background.lat_long ? lat_long_position(direction, background.rotation) : screen;
        return sample_image(*background.image, uv, background.lat_long) * background.intensity;
    }
    }
    return vec3(0);
}
}
