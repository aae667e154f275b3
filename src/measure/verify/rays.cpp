// Scenes made in memory and estimates along rays.
#include "measure/verify/rays.h"

#include "base/error.h"
#include "base/random.h"
#include "modes/mode.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks/bricks.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

namespace tyndall {
bool Check::holds() const { return std::abs(measured - expected) <= tolerance; }

void Checks::add(std::string name, double measured, double expected, double tolerance, std::string basis) {
    list.push_back({topic, std::move(name), measured, expected, tolerance, std::move(basis)});
}

std::vector<Check> run_checks(std::span<const CheckGroup> groups, const VerifyControl& control) {
    Checks checks;
    double total = 0, done = 0;
    for (const CheckGroup& group : groups) total += group.share;
    for (const CheckGroup& group : groups) {
        if (control.cancel && *control.cancel) fail(ExitCode::internal, "verify", "cancelled");
        checks.topic = group.topic;
        if (control.progress)
            checks.progress = [&, done](double part) { control.progress((done + part * group.share) / total); };
        group.run(checks);
        if (control.progress) control.progress((done += group.share) / total);
    }
    return std::move(checks.list);
}

Medium grid_medium(float extinction, int voxels, const std::function<float(vec3)>& density) {
    return medium_of(unit_volume(voxels, density), extinction);
}

Medium noise_medium(float extinction, Phase phase, vec3 albedo) {
    Medium medium = grid_medium(extinction, 32, [](vec3 p) {
        const glm::uvec3 cell(p * 32.0f);
        return std::max(0.0f, 2 * to_unit(hash(cell.x, cell.y, cell.z)) - 0.8f);
    });
    medium.optics.phase = phase, medium.optics.albedo = albedo;
    return medium;
}

RayEstimate path_light(const Snapshot& snapshot, const Ray& ray, int samples, int orders) {
    Settings settings;
    settings.path.orders = orders;
    const ScatterFunction scatter = mode_of_all_orders().prepare(View{}, snapshot, settings, nullptr);
    return estimate_ray(scatter, ray, samples, [](const Scatter& s) { return s.whole(); });
}

Scatter reference_light(const Snapshot& snapshot, const Ray& ray) {
    const ScatterFunction scatter = main_mode().prepare(View{}, snapshot, settings_for(Quality::reference), nullptr);
    Scatter result;
    const uint32_t id = 7;
    scatter({.rays = {&ray, 1}, .ids = {&id, 1}}, {&result, 1});
    return result;
}
}
