// Evaluates modes at one pixel.
#include "measure/explain/parts.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "modes/mode.h"
#include "render/frame/pixel_sum.h"
#include "render/frame/samples.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"

namespace tyndall {
namespace {
constexpr int noisy_batches = 32;
constexpr int largest_picture = 1 << 20; // pixels rendered by a mode that works on whole images

FrameTracer tracer_of(const Mode& mode, const RayScene& scene, const View& view, const Prepared& prepared) {
    return frame_tracer(mode, view, scene.snapshot, scene.settings, prepared);
}

void take(const PixelSample& sample, ModeResult& result) {
    result.inscatter = sample.inscatter, result.color = sample.color();
    result.transmittance = sample.transmittance, result.validity = sample.validity, result.steps = sample.steps;
    result.finite = sample.finite();
}

// Traces the pixel together with its tile: a mode may let neighbors share steps.
void ask_tile(const Mode& mode, const RayScene& scene, ivec2 pixel, ModeResult& result) {
    const Prepared prepared = prepare_frame(mode, scene.view, scene.snapshot, scene.settings, nullptr);
    const ivec2 corner = pixel / tile_side * tile_side, end = glm::min(corner + tile_side, scene.view.size);
    ivec2 pixels[16];
    PixelSample samples[16];
    size_t count = 0, own = 0;
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x) {
            if (ivec2(x, y) == pixel) own = count;
            pixels[count++] = {x, y};
        }
    trace_samples(tracer_of(mode, scene, scene.view, prepared), {pixels, count}, 0, {samples, count}, {});
    take(samples[own], result);
}

// The mean of many samples, and its standard error from independent batches.
void ask_often(const Mode& mode, const RayScene& scene, ivec2 pixel, ModeResult& result) {
    View view = scene.view;
    view.pixel_samples = result.samples = scene.options.noisy_samples, view.batches = noisy_batches;
    const Prepared prepared = prepare_frame(mode, view, scene.snapshot, scene.settings, nullptr);
    const FrameTracer tracer = tracer_of(mode, scene, view, prepared);
    std::vector<PixelSample> samples(static_cast<size_t>(view.pixel_samples));
    parallel_for(view.pixel_samples, [&](int64_t s) {
        if (scene.options.cancel && *scene.options.cancel) fail(ExitCode::internal, "explain", "cancelled");
        trace_samples(tracer, {&pixel, 1}, static_cast<int>(s), {&samples[static_cast<size_t>(s)], 1}, {});
    });

    PixelSum sum;
    double steps = 0;
    const int batch_size = view.pixel_samples / noisy_batches;
    for (size_t s = 0; s < samples.size(); ++s) {
        result.finite = result.finite && samples[s].finite();
        steps += samples[s].steps;
        sum.add(samples[s]);
        if ((s + 1) % static_cast<size_t>(batch_size) == 0) sum.end_batch(batch_size);
    }
    const float count = static_cast<float>(view.pixel_samples);
    result.inscatter = vec3(sum.inscatter_mean.mean), result.color = sum.mean_color();
    result.transmittance = sum.transmittance / count, result.validity = sum.validity / count;
    result.steps = static_cast<int>(std::lround(steps / view.pixel_samples));
    result.standard_error = glm::sqrt(sum.inscatter_mean.variance());
    result.remark = formatted("mean of %d samples, +- its standard error", result.samples);
    if (scene.settings.path.orders > 1) result.remark += "; light may scatter more than once, the reference's does not";
}

// Renders the whole image, reduced in size if it is large.
void ask_picture(const Mode& mode, const RayScene& scene, ivec2 pixel, ModeResult& result) {
    View view = scene.view;
    int shrink = 1;
    while (view.size.x / shrink * (view.size.y / shrink) > largest_picture) ++shrink;
    view.size = glm::max(view.size / shrink, ivec2(1));
    const ivec2 p = glm::min(pixel / shrink, view.size - 1);
    FrameStats stats;
    FrameOptions options;
    options.cancel = scene.options.cancel;
    const Layers layers = render_frame(mode, view, scene.snapshot, scene.settings, options, stats);
    result.inscatter = layers.inscatter.at(p.x, p.y), result.color = layers.color.at(p.x, p.y);
    result.transmittance = layers.transmittance.at(p.x, p.y), result.validity = layers.validity.at(p.x, p.y);
    result.image_size = view.size;
    result.remark = formatted("taken from a whole image of %dx%d", view.size.x, view.size.y);
    result.finite = is_finite(result.inscatter) && is_finite(result.color);
}

// Whether the limitation's light reaches the ray, or its medium lies on it.
bool concerns(const Limitation& limitation, const RayReport& report) {
    const auto reaches = [](const LightStretch& stretch) { return stretch.state != LightState::out_of_reach; };
    if (limitation.subject == Subject::light)
        return std::ranges::any_of(report.lights, [&](const LightOnRay& on) {
            return on.name == limitation.name && std::ranges::any_of(on.stretches, reaches);
        });
    if (limitation.subject == Subject::medium)
        return std::ranges::any_of(report.media,
                                   [&](const MediumOnRay& on) { return on.name == limitation.name && on.depth > 0; });
    return true;
}
}

ModeResult mode_result(const Mode& mode, const RayScene& scene, const RayReport& report) {
    ModeResult result;
    result.mode = mode.name, result.accuracy = mode.accuracy;
    for (Limitation& limitation : mode.limitations(scene.view, scene.snapshot, scene.settings))
        if (concerns(limitation, report)) result.limitations.push_back(std::move(limitation));
    if (mode.surfaces == Surfaces::post)
        ask_picture(mode, scene, report.pixel, result);
    else
        (is_unbiased(mode) ? ask_often : ask_tile)(mode, scene, report.pixel, result);
    return result;
}
}
