// What the radial blur smears: the sky around lights, or highlights.
#include "modes/radial_blur_glow.h"

#include "base/parallel.h"
#include "base/shrink.h"

namespace tyndall {
namespace {
constexpr int published_samples = 32;

float squared_length(vec2 v) { return glm::dot(v, v); }

float share_above(vec3 color, float threshold) {
    const float bright = luminance(color);
    return bright > threshold ? (bright - threshold) / bright : 0;
}
}

Glow unoccluded_glow(const View& view, const Snapshot& snapshot, const BlurLight& light, ivec2 size) {
    Glow glow(size, 1);
    const Occluders* occluders = snapshot.occluders.get();
    const float radius = light.radius * static_cast<float>(size.y) / static_cast<float>(view.size.y);
    const vec2 center = light.position * vec2(size) / vec2(view.size);
    parallel_for(size.y, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x0 = 0; x0 < size.x; x0 += 16) {
            Occluders::ShadowRays rays;
            alignas(64) float share[16], falloff[16];
            bool any = false;
            for (int i = 0; i < 16; ++i) {
                const vec2 position = vec2(std::min(x0 + i, size.x - 1), y) + 0.5f;
                const float off = 1 - squared_length(position - center) / (radius * radius);
                falloff[i] = share[i] = off > 0 ? off * off : 0;
                const Ray ray = camera_ray(view.camera, size, position);
                rays.ox[i] = ray.origin.x, rays.oy[i] = ray.origin.y, rays.oz[i] = ray.origin.z;
                rays.dx[i] = ray.direction.x, rays.dy[i] = ray.direction.y, rays.dz[i] = ray.direction.z;
                const float along = std::max(glm::dot(ray.direction, view.camera.forward), 1e-6f);
                rays.t_min[i] = view.camera.near / along, rays.t_max[i] = light.depth / along;
                rays.active[i] = falloff[i] > 0 ? -1 : 0;
                any |= falloff[i] > 0;
            }
            if (any && occluders && !occluders->empty()) {
                occluders->transmission(rays, share);
                for (int i = 0; i < 16; ++i) share[i] *= falloff[i];
            }
            for (int i = 0; i < 16 && x0 + i < size.x; ++i) glow.row(0, y)[x0 + i] = rays.active[i] ? share[i] : 0;
        }
    });
    return glow;
}

Glow highlights_glow(const Image<vec3>& color, float threshold, ivec2 size) {
    const Image<vec3> bright = shrunk(color, size, [&](vec3 pixel) { return pixel * share_above(pixel, threshold); });
    Glow glow(size, 3);
    for (int channel = 0; channel < 3; ++channel)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) glow.row(static_cast<size_t>(channel), y)[x] = bright.at(x, y)[channel];
    return glow;
}

// The published sum, Σ decay^i · weight · sample_i / 32 with i from 0 to 31 along `density` of the line. Other numbers
// of samples have their decay stretched over the same line and the same sum of weights; each lies in the middle of its
// part of the line, so that more of them change nothing but smoothness.
BlurLine make_line(const RadialBlurSettings& settings) {
    BlurLine line{settings.density, {}};
    double published = 0, sum = 0;
    for (int i = 0; i < published_samples; ++i) published += std::pow(double(settings.decay), i);
    for (int i = 0; i < settings.samples; ++i) {
        const double at = (i + 0.5) * published_samples / settings.samples;
        line.weights.push_back(static_cast<float>(std::pow(double(settings.decay), at)));
        sum += line.weights.back();
    }
    const double scale = settings.exposure * settings.weight * published / (published_samples * std::max(sum, 1e-30));
    for (float& weight : line.weights) weight = static_cast<float>(weight * scale);
    return line;
}
}
