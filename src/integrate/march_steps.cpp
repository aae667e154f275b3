#include "integrate/march_steps.h"

#include "scene/light.h"
#include "scene/lights/light_reach.h"
#include "trace/snapshot.h"
#include "volume/medium.h"
#include "volume/rays/fog_reach.h"

namespace tyndall {
namespace {
constexpr int max_steps = 65536;              // per ray; steps are lengthened to fit
constexpr float step_share_of_extent = 1e-4f; // minimum distance to a light for step lengths

// The parts of a piece of a ray inside spot light cones, relative to the start of the piece.
void find_beams(const MarchSteps& rule, const Ray& ray, Interval<float> piece, std::vector<Step>& beams) {
    beams.clear();
    for (const Light& light : rule.lights) {
        if (!has_cone(light)) continue;
        const Interval<double> cone =
            inside_cone(light.position, light.direction, light.outer_cone, ray.origin, ray.direction);
        const float low = std::max(static_cast<float>(cone.low), piece.low) - piece.low;
        const float high = std::min(static_cast<float>(cone.high), piece.high) - piece.low;
        if (!cone.empty() && low < high) beams.push_back({low, high});
    }
}

// Appends the steps of one piece of a ray, with the longest step relative to the piece's length.
void append_piece(const MarchSteps& march, const Snapshot& snapshot, const Ray& ray, Interval<float> piece,
                  std::vector<Step>& steps) {
    if (piece.empty()) return;
    const MarchSettings& settings = march.settings;
    static thread_local std::vector<Step> beams;
    find_beams(march, ray, piece, beams);
    const StepRule rule{settings.step_depth,
                        settings.step_voxels,
                        settings.step_share * piece.length(),
                        max_steps,
                        march.near_points,
                        settings.near_light,
                        beams,
                        8 / settings.near_light,
                        step_share_of_extent * snapshot.extent};
    const size_t first = steps.size();
    append_steps({ray.at(piece.low), ray.direction, piece.length()}, snapshot.media, rule, steps);
    for (size_t i = first; i < steps.size(); ++i) steps[i].low += piece.low, steps[i].high += piece.low;
}
}

MarchSteps march_steps(const MarchSettings& settings, std::vector<Light> lights) {
    MarchSteps rule{settings, std::move(lights), {}};
    for (const Light& light : rule.lights)
        if (!is_distant(light)) rule.near_points.push_back(light.position);
    return rule;
}

Interval<float> scene_part(const Snapshot& snapshot, const Ray& ray, Interval<float> fog) {
    const Interval<float> scene = clip(snapshot.bounds, ray.origin, ray.direction, fog);
    return scene.empty() || fog.length() < 2 * scene.length() ? fog : scene;
}

void append_march_steps(const MarchSteps& rule, const Snapshot& snapshot, const Ray& ray, std::vector<Step>& steps) {
    const Interval<float> stretch = fog_interval(snapshot.media, ray);
    const Interval<float> scene = scene_part(snapshot, ray, stretch);
    append_piece(rule, snapshot, ray, {stretch.low, scene.low}, steps);
    append_piece(rule, snapshot, ray, scene, steps);
    append_piece(rule, snapshot, ray, {scene.high, stretch.high}, steps);
}
}
