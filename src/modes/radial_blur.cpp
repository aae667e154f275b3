// Radial blur: bright places smeared away from the light's place in the picture (Mitchell 2007, GPU Gems 3, chapter
// 13).
#include "modes/radial_blur.h"

#include "base/parallel.h"
#include "base/random.h"
#include "base/shrink.h"
#include "modes/even_fog.h"
#include "modes/fog_picture.h"
#include "modes/style.h"
#include "modes/techniques.h"
#include "scene/light.h"

namespace tyndall {
namespace {
constexpr float far_away = 1e6f; // metres: a sun's place in the picture is where this point of it would be
constexpr int published_samples = 32;

float smooth(float x) {
    const float t = std::clamp(x, 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

float luminance_above(vec3 color, float threshold) {
    const float bright = luminance(color);
    return bright > threshold ? (bright - threshold) / bright : 0;
}

// Even fog's answer to the light along the line of sight straight at it: irradiance at the eye times
// Σ albedo p (1 - e^-depth), p for light that travels to the eye, or along a spot's axis. Only a scale: the blur itself
// knows no units.
vec3 brightness(const Snapshot& snapshot, const Light& light, const Ray& towards, float distance) {
    const bool spot = light.kind == LightKind::spot;
    const float cosine = spot ? glm::dot(light.direction, -towards.direction) : 1;
    const float squared = std::max(distance * distance, 1e-6f);
    const vec3 irradiance = light.kind == LightKind::sun ? light.intensity : light.intensity / squared;
    vec3 sum(0);
    for (const Medium& medium : even_media(snapshot.media)) {
        Ray ray = towards;
        ray.t_max = std::min(distance, far_away);
        const float depth = static_cast<float>(optical_depth(medium, ray));
        sum += medium.optics.albedo * (phase_value(medium.optics.phase, cosine) * -std::expm1(-depth));
    }
    return sum * irradiance * light.volume_scale;
}

float squared_length(vec2 v) { return glm::dot(v, v); }

// An image in a black frame two pixels wide, so that look-ups up to a pixel outside need no care.
template<class T> struct Framed {
    static constexpr int frame = 2;
    ivec2 size; // within the frame
    Image<T> image;

    explicit Framed(const Image<T>& inner) : size(inner.size), image(inner.size + 2 * frame) {
        for (int y = 0; y < size.y; ++y) std::copy_n(&inner.at(0, y), size.x, &image.at(frame, y + frame));
    }

    // Bilinear value at a position from -1 to size + 1.
    T at(vec2 position) const {
        const vec2 p = position + (frame - 0.5f);
        const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
        const float u = p.x - static_cast<float>(x), v = p.y - static_cast<float>(y);
        const T *upper = &image.at(x, y), *lower = upper + image.size.x;
        const T a = upper[0] + (upper[1] - upper[0]) * u, b = lower[0] + (lower[1] - lower[0]) * u;
        return a + (b - a) * v;
    }
};

// Narrows the numbers i for which from + i·step lies in low..high.
void keep_inside(float from, float step, float low, float high, Interval& range) {
    if (std::abs(step) < 1e-12f) {
        if (from < low || from > high) range = {};
        return;
    }
    const float a = (low - from) / step, b = (high - from) / step;
    range.low = std::max(range.low, std::min(a, b)), range.high = std::min(range.high, std::max(a, b));
}

// The published sum, Σ decay^i · weight · sample_i / 32 with i from 0 to 31 along `density` of the line. Other numbers
// of samples have their decay stretched over the same line and the same sum of weights; each lies in the middle of its
// part of the line, so that more of them change nothing but smoothness.
struct Line {
    float density;
    std::vector<float> weights;
};
Line make_line(const RadialBlurSettings& settings) {
    Line line{settings.density, {}};
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

struct RadialBlur {
    View view;
    Snapshot snapshot;
    RadialBlurSettings settings;
    std::vector<BlurLight> lights;
    Line line;
};

// `radius`: how far from the centre the source is not black.
template<class T> Image<T> blurred(const RadialBlur& blur, const Image<T>& black_outside, vec2 center, float radius) {
    const Line& line = blur.line;
    const Framed<T> source(black_outside);
    Image<T> result(source.size);
    const float count = static_cast<float>(line.weights.size());
    parallel_for(source.size.y, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < source.size.x; ++x) {
            const float shift = to_unit(jitter_bits(blur.view.jitter, {x, y}, blur.view.frame, blur.view.seed));
            const vec2 step = (center - (vec2(x, y) + 0.5f)) * (line.density / count);
            const vec2 first = vec2(x, y) + 0.5f + shift * step;
            const float away = glm::length(center - first);
            Interval range{0, count - 1};
            if (away > radius) range.low = count / line.density * (1 - radius / away) - 1;
            for (int axis = 0; axis < 2; ++axis)
                keep_inside(first[axis], step[axis], -0.99f, static_cast<float>(source.size[axis]) + 0.99f, range);
            if (range.high < range.low) continue;
            T sum(0);
            const int last = static_cast<int>(range.high);
            for (int i = static_cast<int>(std::ceil(std::max(range.low, 0.0f))); i <= last; ++i)
                sum += line.weights[static_cast<size_t>(i)] * source.at(first + static_cast<float>(i) * step);
            result.at(x, y) = sum;
        }
    });
    return result;
}

// Bright sky around the light where nothing stands before it; BLEND surfaces let their share through.
Image<float> occlusion_buffer(const RadialBlur& blur, const BlurLight& light, ivec2 size) {
    Image<float> mask(size);
    const Occluders* occluders = blur.snapshot.occluders.get();
    const float radius = light.radius * static_cast<float>(size.y) / static_cast<float>(blur.view.size.y);
    const vec2 center = light.position * vec2(size) / vec2(blur.view.size);
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
                const Ray ray = camera_ray(blur.view.camera, size, position);
                rays.ox[i] = ray.origin.x, rays.oy[i] = ray.origin.y, rays.oz[i] = ray.origin.z;
                rays.dx[i] = ray.direction.x, rays.dy[i] = ray.direction.y, rays.dz[i] = ray.direction.z;
                const float along = std::max(glm::dot(ray.direction, blur.view.camera.forward), 1e-6f);
                rays.t_min[i] = blur.view.camera.near / along, rays.t_max[i] = light.depth / along;
                rays.active[i] = falloff[i] > 0 ? -1 : 0;
                any |= falloff[i] > 0;
            }
            if (any && occluders && !occluders->empty()) {
                occluders->transmission(rays, share);
                for (int i = 0; i < 16; ++i) share[i] *= falloff[i];
            }
            for (int i = 0; i < 16 && x0 + i < size.x; ++i) mask.at(x0 + i, y) = rays.active[i] ? share[i] : 0;
        }
    });
    return mask;
}

// Spreads a blurred picture over the full one, in a colour.
template<class T>
void add_light(const RadialBlur& blur, size_t index, const Image<T>& smeared, vec3 color, Addition& addition) {
    const ivec2 size = blur.view.size;
    const vec2 scale = vec2(smeared.size) / vec2(size);
    const Framed<T> source(smeared);
    Image<vec3>* part = blur.view.per_light ? &addition.per_light[index] : nullptr;
    parallel_for(size.y, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < size.x; ++x) {
            // Held at the border, where the blurred picture ends half a pixel early.
            const vec2 position = glm::clamp((vec2(x, y) + 0.5f) * scale, vec2(0.5f), vec2(smeared.size) - 0.5f);
            const vec3 light = color * source.at(position);
            addition.radiance.at(x, y) += light;
            if (part) part->at(x, y) += light;
        }
    });
}

Addition added_rays(const RadialBlur& blur, const PlainPicture& picture) {
    const ivec2 full = blur.view.size, size = shared_size(full, blur.settings.picture);
    Addition addition{Image<vec3>(full), Image<float>(full, 1.0f), {}};
    if (blur.view.per_light) addition.per_light.assign(blur.snapshot.lights.size(), Image<vec3>(full));
    if (blur.lights.empty()) return addition;

    Image<vec3> highlights;
    if (blur.settings.source == BlurSource::highlights)
        highlights = shrunk(picture.color, size,
                            [&](vec3 color) { return color * luminance_above(color, blur.settings.threshold); });
    for (const BlurLight& light : blur.lights) {
        const vec2 center = light.position * vec2(size) / vec2(full);
        const float radius = light.radius * static_cast<float>(size.y) / static_cast<float>(full.y);
        if (blur.settings.source == BlurSource::occlusion)
            add_light(blur, light.index, blurred(blur, occlusion_buffer(blur, light, size), center, radius),
                      light.color * light.fade, addition);
        else
            add_light(blur, light.index, blurred(blur, highlights, center, infinity), vec3(light.share * light.fade),
                      addition);
    }
    for (size_t i = 0; i < addition.validity.pixels.size(); ++i)
        if (max_component(addition.radiance.pixels[i]) > 0) addition.validity.pixels[i] = 0;
    return addition;
}
}

float blur_fade(vec2 position, ivec2 size, float fade) {
    const vec2 off = glm::abs(position / vec2(size) * 2.0f - 1.0f);
    return 1 - smooth((std::max(off.x, off.y) - 1) / fade);
}

namespace {
float pixels_per_metre(const View& view, float depth) {
    const bool flat = view.camera.ortho_height > 0;
    const float height = flat ? view.camera.ortho_height : 2 * depth * std::tan(0.5f * view.camera.vertical_fov);
    return static_cast<float>(view.size.y) / height;
}
}

std::vector<BlurLight> blur_lights(const View& view, const Snapshot& snapshot, const RadialBlurSettings& settings) {
    std::vector<BlurLight> lights;
    float total = 0;
    for (size_t i = 0; i < snapshot.lights.size(); ++i) {
        const Light& light = snapshot.lights[i];
        const bool sun = light.kind == LightKind::sun;
        if (sun && view.camera.ortho_height > 0) continue; // its rays are parallel in the picture
        const vec3 at = sun ? view.camera.position - far_away * light.direction : light.position;
        const std::optional<vec2> position = pixel_of(view.camera, view.size, at);
        const float depth = glm::dot(at - view.camera.position, view.camera.forward);
        if (!position || !(depth > view.camera.near)) continue;
        const float fade = blur_fade(*position, view.size, settings.fade);
        if (!(fade > 0)) continue;
        const vec3 towards = at - view.camera.position;
        const float distance = glm::length(towards);
        BlurLight blur{i, *position, sun ? infinity : depth, 0, fade, vec3(0), 0};
        blur.radius = settings.size * static_cast<float>(view.size.y);
        if (!sun) blur.radius = settings.lamp_size * pixels_per_metre(view, depth);
        blur.color = brightness(snapshot, light, {view.camera.position, towards / distance}, sun ? infinity : distance);
        blur.share = luminance(blur.color);
        total += blur.share;
        lights.push_back(blur);
    }
    for (BlurLight& light : lights) light.share = total > 0 ? light.share / total : 0;
    return lights;
}

std::vector<Limit> radial_blur_limits(const View& view, const Snapshot& snapshot, const Settings& settings) {
    std::vector<Limit> limits{
        {Severity::degraded, "picture",
         "rays are smeared brightness, not light: fog, distance and what is off screen play no part"}};
    for (const Medium& medium : snapshot.media)
        if (medium.kind == DensityKind::bricks && settings.radial_blur.fog)
            limits.push_back({Severity::degraded, "medium " + medium.name,
                              "dims what is behind it as even fog of its mean density in the grid's bounds "
                              "(radial_blur.fog)"});
    const std::vector<BlurLight> seen = blur_lights(view, snapshot, settings.radial_blur);
    for (size_t i = 0; i < snapshot.lights.size(); ++i) {
        const auto found = std::ranges::find(seen, i, &BlurLight::index);
        const std::string where = "light " + snapshot.lights[i].name;
        if (found == seen.end())
            limits.push_back({Severity::wrong, where, "behind the camera or far off screen: it makes no rays"});
        else if (found->fade < 1)
            limits.push_back({Severity::degraded, where, "off screen: its rays are fading out"});
    }
    return limits;
}

ScatterFunction prepare_radial_blur(const View&, const Snapshot& snapshot, const Settings& settings, History*) {
    return dimming_only(settings.radial_blur.fog ? even_media(snapshot.media) : std::vector<Medium>{});
}

PostFunction post_radial_blur(const View& view, const Snapshot& snapshot, const Settings& settings) {
    auto blur = std::make_shared<RadialBlur>();
    blur->view = view, blur->settings = settings.radial_blur;
    blur->snapshot = stylised(snapshot, settings.style);
    blur->lights = blur_lights(view, blur->snapshot, settings.radial_blur);
    blur->line = make_line(settings.radial_blur);
    return [blur](const PlainPicture& picture) { return added_rays(*blur, picture); };
}
}
