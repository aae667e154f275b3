// The sources of the radial blur: bright sky around lights, or highlights of the image.
#include "modes/radial_blur/glow.h"
#include "modes/radial_blur/settings.h"

#include "base/parallel.h"
#include "base/shrink.h"
#include "scene/light.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"

namespace tyndall {
namespace {
constexpr int published_samples = 32;

float squared_length(vec2 v) { return glm::dot(v, v); }

float share_above(vec3 color, float threshold) {
    const float bright = luminance(color);
    return bright > threshold ? (bright - threshold) / bright : 0;
}

// Adds a camera ray that ends at the light's planar depth.
void set_ray(Occluders::ShadowRays& rays, int i, const Camera& camera, const Ray& ray, float depth) {
    const float along = std::max(glm::dot(ray.direction, camera.forward), 1e-6f);
    rays.set(static_cast<size_t>(i), {ray.origin, ray.direction, depth / along}, camera.near / along);
}

// Fraction of the glow that surfaces let through: those that shadow the light, or all for a light without shadows.
void see_through(const Snapshot& snapshot, const Light& light, const Occluders::ShadowRays& rays, float share[16]) {
    const auto& occluders = light.shadows ? shadow_casters(light, snapshot) : snapshot.occluders;
    if (occluders && !occluders->empty()) return occluders->transmission(rays, share);
    std::fill_n(share, 16, 1.0f);
}
}

BlurImage unoccluded_image(const View& view, const Snapshot& snapshot, const BlurLight& light, ivec2 size) {
    BlurImage glow(size, 1);
    const float radius = light.radius * static_cast<float>(size.y) / static_cast<float>(view.size.y);
    const vec2 center = light.position * vec2(size) / vec2(view.size);
    parallel_for(size.y, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x0 = 0; x0 < size.x; x0 += 16) {
            Occluders::ShadowRays rays{};
            alignas(64) float falloff[16] = {}, share[16];
            bool any = false;
            for (int i = 0; i < std::min(16, size.x - x0); ++i) {
                const vec2 position = vec2(x0 + i, y) + 0.5f;
                const float off = 1 - squared_length(position - center) / (radius * radius);
                if (!(off > 0)) continue;
                falloff[i] = off * off, any = true;
                set_ray(rays, i, view.camera, camera_ray(view.camera, size, position), light.depth);
            }
            if (!any) continue;
            see_through(snapshot, snapshot.lights[light.index], rays, share);
            for (int i = 0; i < std::min(16, size.x - x0); ++i)
                glow.row(0, y)[x0 + i] = rays.active[i] ? share[i] * falloff[i] : 0;
        }
    });
    return glow;
}

BlurImage highlights_image(const Image<vec3>& color, float threshold, ivec2 size) {
    const Image<vec3> bright = shrunk(color, size, [&](vec3 pixel) { return pixel * share_above(pixel, threshold); });
    BlurImage glow(size, 3);
    for (int channel = 0; channel < 3; ++channel)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) glow.row(static_cast<size_t>(channel), y)[x] = bright.at(x, y)[channel];
    return glow;
}

// The published sum, Σ decay^i · weight · sample_i / 32 with i from 0 to 31 along `density` of the line (Mitchell
// 2007). For other numbers of samples, the decay is stretched over the same line and the weights have the same sum;
// samples are at the centers of equal segments, so that more of them only make the result smoother.
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
