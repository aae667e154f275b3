#include "render/sequence/auto_exposure.h"

#include "base/error.h"
#include "modes/mode.h"
#include "render/frame/frame.h"
#include "scene/scene.h"
#include "trace/frame_cache.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <algorithm>
#include <set>

namespace tyndall {
namespace {
constexpr int small_side = 64;       // pixels along the longer side
constexpr double average_to = 0.15;  // target for the log-average luminance
constexpr double highlight_to = 1.6; // target for the highlights: the exposure is halfway between the two, in stops
constexpr double highlights = 0.98;  // share of the lit pixels that are darker
constexpr float black = 1e-4f;       // relative to the highlights: darker pixels are ignored

Settings small_settings(const RenderRequest& request, int orders) {
    const Settings& asked = request.settings;
    Settings settings = settings_for(Quality::draft);
    settings.style = asked.style;
    settings.terms.phase = asked.terms.phase, settings.terms.heterogeneity = asked.terms.heterogeneity;
    settings.terms.emission = asked.terms.emission, settings.terms.ambient = asked.terms.ambient;
    settings.pixel.samples = settings.pixel.lamp_samples = settings.pixel.edge_samples = 1;
    settings.fluence.orders = orders;
    settings.fluence.resolution = 16, settings.fluence.paths = 4000;
    return settings;
}

RenderRequest small_request(const Scene& scene, const RenderRequest& request) {
    const ivec2 whole = request.resolution.x > 0 ? request.resolution : scene.resolution;
    const float scale = static_cast<float>(small_side) / static_cast<float>(std::max(whole.x, whole.y));
    RenderRequest small;
    small.camera = request.camera, small.background = request.background;
    small.resolution = glm::max(ivec2(glm::round(scale * vec2(whole))), ivec2(8));
    small.exr.layers.clear();
    small.shutter = Shutter{}; // motion blur does not change the brightness
    return small;
}

std::vector<float> luminances_of(const Scene& scene, const RenderRequest& request, int orders, const Snapshot& snapshot,
                                 const Camera* camera) {
    const Settings settings = small_settings(request, orders);
    View view = view_of(scene, small_request(scene, request), settings, snapshot.frame);
    if (camera) view.camera = *camera;
    FrameStats stats;
    const Layers layers = render_frame(main_mode(), view, snapshot, settings, {}, stats);
    std::vector<float> result;
    for (const vec3 color : layers.color.pixels) result.push_back(luminance(color));
    return result;
}
}

std::optional<double> exposure_for(std::vector<float> luminances) {
    std::erase_if(luminances, [](float value) { return !(value > 0 && value < infinity); });
    if (luminances.empty()) return {};
    const auto place = [&] {
        return luminances.begin() +
               static_cast<std::ptrdiff_t>(highlights * static_cast<double>(luminances.size() - 1));
    };
    std::nth_element(luminances.begin(), place(), luminances.end());
    const float high = *place();
    double sum = 0, count = 0;
    for (const float value : luminances)
        if (value > black * high) sum += std::log2(std::min(value, high)), ++count;
    const double stops = 0.5 * (std::log2(average_to) - sum / count + std::log2(highlight_to / high));
    return std::round(10 * std::clamp(stops, -64.0, 64.0)) / 10;
}

bool needs_auto_exposure(const Scene& scene, const RenderRequest& request) {
    return request.automatic_exposure || (!request.exposure && !scene.own_exposure);
}

double automatic_exposure(const Scene& scene, const RenderRequest& request, int orders, const Snapshot* previous,
                          const Camera* camera) {
    std::optional<double> darkest;
    Snapshot snapshot;
    const std::set<int> frames{scene.first_frame, (scene.first_frame + scene.last_frame) / 2, scene.last_frame};
    for (const int frame : frames) {
        try {
            snapshot = make_snapshot(scene, moment_of(scene, frame), previous, MissingFrame::hold);
            const auto exposure = exposure_for(luminances_of(scene, request, orders, snapshot, camera));
            if (exposure) darkest = std::min(*exposure, darkest.value_or(*exposure));
            previous = &snapshot;
        } catch (const Error&) {
            continue; // reported when this frame is rendered
        }
    }
    return darkest.value_or(0.0);
}

int orders_of(const Mode& mode, const Settings& settings) {
    if (mode.accuracy == Accuracy::multiple_scattering) return settings.path.orders;
    return mode.adds_fluence ? settings.fluence.orders : 1;
}

Display display_of(const Scene& scene, const RenderRequest& request, const RenderPlan& plan, int frame) {
    if (needs_auto_exposure(scene, request)) return {plan.exposure.value_or(0.0), request.view_transform};
    return {request.exposure.value_or(scene.exposure.at(moment_of(scene, frame).seconds)), request.view_transform};
}
}
