// Runs the cases and judges them.
#include "measure/stress/stress.h"

#include "base/clock.h"
#include "base/error.h"
#include "measure/stress/trial.h"
#include "modes/limitation.h"
#include "modes/mode.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/phase.h"

namespace tyndall {
namespace {
constexpr double small_error = 0.05; // below it a warning of severity wrong is idle
constexpr double degraded_times = 3; // factor on the allowed error for a mode that reports severity degraded

std::vector<std::string_view> pieces(std::string_view text, char separator) {
    std::vector<std::string_view> result;
    while (!text.empty()) {
        const size_t end = std::min(text.find(separator), text.size());
        if (end > 0) result.push_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return result;
}

// Largest relative RMSE that a mode may have at quality preview.
double allowed_rmse(const Mode& mode) {
    switch (mode.accuracy) {
    case Accuracy::homogeneous:
    case Accuracy::multiple_scattering:
        return 0.03;
    default:
        return 0.1;
    }
}

bool names(std::string_view list, std::string_view name) { return std::ranges::count(pieces(list, ' '), name) > 0; }

double allowed_to(const Mode* mode, const StressMeasure& measure) {
    if (mode && names(measure.exact_modes, mode->name)) return measure.exact;
    return measure.allowed >= 0 || !mode ? measure.allowed : allowed_rmse(*mode);
}

// The largest error that a limitation excuses; below 0: none.
double excused_by(const Limitation& limitation, const StressCase& stress, double allowed) {
    double most = -1;
    for (const Excuse& excuse : stress.excuses) {
        if (limitation.severity == Severity::info || !limitation.is(*excuse.kind)) continue;
        if (limitation.severity == Severity::wrong) return infinity;
        if (excuse.amount) {
            most = std::max(most, excuse.amount(limitation));
            continue;
        }
        most = std::max({most, degraded_times * allowed, excuse.up_to});
    }
    return most;
}

// The limitations that the mode reports for the scene before it renders.
void ask_limitations(const StressCase& stress, const Mode& mode, const StressScene& scene, StressPoint& point) {
    View view = scene.view;
    view.has_history = stress.modes.claims == static_cast<uint16_t>(Claim::history);
    for (const Limitation& limitation : mode.limitations(view, scene.snapshot, scene.settings)) {
        point.wrong |= limitation.severity == Severity::wrong;
        const double excused = excused_by(limitation, stress, point.allowed);
        if (excused <= point.excused_up_to) continue;
        point.excused_up_to = excused;
        point.warning = line_of({limitation, {limitation.name}});
    }
}

StressPoint run_point(const StressCase& stress, const Mode* mode, double value, const StressScene& scene,
                      std::optional<Truth>& truth, std::atomic<bool>* cancel) {
    if (cancel && *cancel) fail(ExitCode::internal, "stress", "cancelled");
    StressPoint point;
    point.value = value;
    point.allowed = allowed_to(mode, stress.measure), point.allowed_bias = stress.measure.allowed_bias;
    Trial trial{mode, value, point.allowed, scene, truth, cancel};
    if (mode) ask_limitations(stress, *mode, scene, point);
    point.error = stress.measure.error ? stress.measure.error(trial) : error_to_truth(trial);
    if (point.wrong) point.measured = stress.measure.error ? error_to_truth(trial) : point.error;
    if (std::isnan(point.error)) point.error = infinity;
    point.bias = std::isnan(trial.bias) ? infinity : trial.bias;
    point.non_finite = trial.faults.non_finite, point.negative = trial.faults.negative;
    if (truth) point.non_finite += truth->faults.non_finite, point.negative += truth->faults.negative;
    return point;
}
}

bool takes_part(const StressCase& stress, const Mode& mode) {
    if (!stress.modes.claims) return stress.modes.name == mode.name;
    const bool physical = mode.accuracy != Accuracy::artistic;
    const std::pair<Claim, bool> made[] = {{Claim::along_rays, mode.surfaces != Surfaces::post},
                                           {Claim::physical, physical},
                                           {Claim::noise_free, physical && !is_unbiased(mode)},
                                           {Claim::density, physical && mode.resolves_density},
                                           {Claim::shadows, physical && mode.casts_shadows},
                                           {Claim::lamps, physical && mode.resolves_lamps},
                                           {Claim::history, mode.uses_history},
                                           {Claim::fluence, mode.adds_fluence},
                                           {Claim::adaptive, physical && mode.adapts_steps}};
    return std::ranges::all_of(made, [&](const auto& one) {
        return one.second || !(*stress.modes.claims & static_cast<uint16_t>(one.first));
    });
}

std::vector<StressResult> run_stress(const StressCase& stress, std::span<const Mode> modes, std::atomic<bool>* cancel) {
    std::vector<const Mode*> taking;
    for (const Mode& mode : modes)
        if (takes_part(stress, mode)) taking.push_back(&mode);
    if (stress.modes.program()) taking.push_back(nullptr);

    std::vector<StressResult> results;
    for (const Mode* mode : taking) results.push_back({&stress, std::string(mode ? mode->name : "program"), {}, 0});
    for (const double value : stress.values) {
        if (taking.empty()) break;
        const StressScene scene = stress.scene ? stress.scene(value) : StressScene{};
        std::optional<Truth> truth;
        for (size_t i = 0; i < taking.size(); ++i) {
            const double start = steady_seconds();
            results[i].points.push_back(run_point(stress, taking[i], value, scene, truth, cancel));
            results[i].seconds += steady_seconds() - start;
        }
    }
    return results;
}

const StressPoint* StressResult::first() const {
    const auto silent = std::ranges::find_if(points, &StressPoint::silent);
    if (silent != points.end()) return &*silent;
    const auto off = std::ranges::find_if(points, [](const StressPoint& point) { return !point.holds(); });
    return off != points.end() ? &*off : nullptr;
}

Verdict StressResult::verdict() const {
    const StressPoint* point = first();
    return !point ? Verdict::holds : point->silent() ? Verdict::fails : Verdict::degrades;
}

WrongWarnings wrong_warnings(std::span<const StressResult> results) {
    WrongWarnings warnings;
    for (const StressResult& result : results)
        for (const StressPoint& point : result.points)
            warnings.count += point.wrong, warnings.idle += point.wrong && point.measured < small_error;
    return warnings;
}

std::string_view name_of(Verdict verdict) {
    constexpr std::string_view names[] = {"holds", "degrades", "fails"};
    return names[static_cast<size_t>(verdict)];
}

const std::vector<StressCase>& stress_cases() {
    static const std::vector<StressCase> cases = [] {
        std::vector<StressCase> all;
        for (auto* group :
             {stress_lamps, stress_filters, stress_beams, stress_fog, stress_shadows, stress_history, stress_scattering,
              stress_lobes, stress_colors, stress_orders, stress_fire, stress_glow, stress_faces, stress_skies,
              stress_shutters, stress_files, stress_data, stress_looks, stress_program})
            for (StressCase& stress : group()) all.push_back(std::move(stress));
        return all;
    }();
    return cases;
}
}
