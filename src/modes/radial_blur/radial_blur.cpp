// Radial blur: bright regions blurred along the lines from the light's position in the image (Mitchell 2007, GPU Gems
// 3, chapter 13).
#include "modes/radial_blur/radial_blur.h"
#include "modes/radial_blur/limitations.h"
#include "modes/radial_blur/settings.h"

#include "integrate/homogeneous_fog.h"
#include "integrate/style.h"
#include "modes/fog_buffer.h"
#include "modes/light_filters.h"
#include "modes/mode.h"
#include "modes/radial_blur/glow.h"
#include "scene/light.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
struct RadialBlur {
    View view;
    Snapshot snapshot;
    RadialBlurSettings settings;
    std::vector<BlurLight> lights;
    BlurLine line;
};

PostOutput added_rays(const RadialBlur& blur, const PostInput& input) {
    const View& view = blur.view;
    const ivec2 size = reduced_size(view.size, blur.settings.resolution);
    PostOutput addition{Image<vec3>(view.size), Image<float>(view.size, 1.0f), {}};
    if (view.fog_parts) addition.per_light.assign(blur.snapshot.lights.size(), Image<vec3>(view.size));
    if (blur.lights.empty()) return addition;

    const bool highlights = blur.settings.source == BlurSource::highlights;
    const BlurImage bright =
        highlights ? highlights_image(input.color, blur.settings.threshold, size) : BlurImage({}, 1);
    for (const BlurLight& light : blur.lights) {
        const vec2 center = light.position * vec2(size) / vec2(view.size);
        const float radius = light.radius * static_cast<float>(size.y) / static_cast<float>(view.size.y);
        const BlurImage smeared =
            highlights ? blurred(bright, blur.line, center, infinity, view)
                       : blurred(unoccluded_image(view, blur.snapshot, light, size), blur.line, center, radius, view);
        const vec3 color = (highlights ? vec3(light.share) : light.color) * light.fade;
        add_glow(smeared, color, addition.radiance, view.fog_parts ? &addition.per_light[light.index] : nullptr);
    }
    for (size_t i = 0; i < addition.validity.pixels.size(); ++i)
        if (max_component(addition.radiance.pixels[i]) > 0) addition.validity.pixels[i] = 0;
    return addition;
}
}

ScatterFunction prepare_radial_blur(const View&, const Snapshot& snapshot, const Settings& settings, History*) {
    return dimming_only(settings.of<RadialBlurSettings>().fog ? homogeneous_media(snapshot.media)
                                                              : std::vector<Medium>{});
}

PostFunction post_radial_blur(const View& view, const Snapshot& snapshot, const Settings& settings) {
    auto blur = std::make_shared<RadialBlur>();
    blur->view = view, blur->settings = settings.of<RadialBlurSettings>();
    blur->snapshot = stylized(snapshot, settings.style);
    average_filters(blur->snapshot);
    blur->lights = blur_lights(view, blur->snapshot, settings.of<RadialBlurSettings>());
    blur->line = make_line(settings.of<RadialBlurSettings>());
    return [blur](const PostInput& input) { return added_rays(*blur, input); };
}

Mode radial_blur_mode() {
    return {.name = "radial-blur",
            .summary = "brightness smeared away from the lights in the finished image",
            .use = "a quick effect over a finished image, with the light in or near the frame",
            .accuracy = Accuracy::artistic,
            .surfaces = Surfaces::post,
            .limitations = radial_blur_limitations,
            .prepare = prepare_radial_blur,
            .prepare_post = post_radial_blur,
            .append_rows = append_radial_blur_rows,
            .rungs = radial_blur_rungs,
            .color = "#D55E00",
            .interactive = true};
}
}
