#include "render/adaptive/errors/shutter_error.h"

#include "base/clock.h"
#include "trace/shutter_motion.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"

#include <algorithm>
#include <bit>

namespace tyndall {
namespace {
constexpr uint32_t moments_salt = 0x5b17u; // independent tiles

// A mode's values at each moment so far.
struct Moments {
    const View& view;
    const Snapshot& snapshot;
    std::vector<PilotRun> runs;
};

Moments start_runs(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                   const Prepared& prepared) {
    Moments moments{view, snapshot, {}};
    for (size_t k = 0; k < snapshot.moments->size(); ++k) {
        const std::shared_ptr<const Prepared> borrowed(std::shared_ptr<void>(), &prepared.moments[k]);
        moments.runs.push_back({mode, settings, borrowed, &(*snapshot.moments)[k]});
    }
    return moments;
}

// Traces the tiles and passes that a moment's look lacks.
void follow(const Pilot& pilot, size_t moment, PilotRun& run, const View& view) {
    Pilot still = pilot;
    still.view.camera = view.shutter->cameras[moment], still.view.shutter = nullptr;
    measure(still, run, steady_seconds);
}

SquaredError compare(const Pilot& pilot, Moments& moments) {
    const size_t count = moments.runs.size(), values = pilot.tiles.size() * pilot_values;
    std::vector<vec3> mean(values, vec3(0)), difference(values, vec3(0));
    float sum_of_signs = 0;
    for (size_t k = 0; k < count; ++k) {
        follow(pilot, k, moments.runs[k], moments.view);
        const float share = 1 / static_cast<float>(count), sign = std::popcount(k) % 2 ? -1.0f : 1.0f;
        sum_of_signs += sign;
        for (size_t i = 0; i < values; ++i) {
            mean[i] += share * moments.runs[k].values[i];
            difference[i] += share * sign * moments.runs[k].values[i];
        }
    }
    for (size_t i = 0; i < values; ++i)
        difference[i] += mean[i] * (1 - sum_of_signs / static_cast<float>(count)); // mean plus signed difference
    return error_of(pilot, mean, difference, of_integrator);
}
}

SquaredError moments_error(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                           const Prepared& prepared, const TileChances& chances, double error, bool once,
                           const FrameOptions& options) {
    constexpr double small = 0.15;     // relative to the target error: at most 2 % of its square
    constexpr size_t few_moments = 32; // with more, the error is small and every tile is traced through all of them
    constexpr int many_passes = 8;     // each of them traces every moment
    Pilot pilot = make_pilot(mode, view, snapshot, nullptr, chances, moments_salt, options);
    Moments moments = start_runs(mode, view, snapshot, settings, prepared);
    while (true) {
        const SquaredError found = compare(pilot, moments);
        const double enough = std::max(2 * found.value, small * small * error * error);
        const bool enough_passes = found.by_noise && pilot.passes >= many_passes;
        if (once || moments.runs.size() > few_moments || found.bound <= enough || enough_passes ||
            !pilot.can_grow(found.by_noise))
            return found;
        grow(pilot, found.by_noise);
    }
}

int moments_for(const Noise& error, int count, const Goal& goal) {
    constexpr double largest = 0.7, wanted = 0.5; // of the goal's error
    if (goal.error == 0 || goal.seconds > 0 || error.bound <= largest * goal.error) return 0;
    const double times = std::min(std::ceil(error.bound / (wanted * goal.error)), double{max_moments});
    const int more = std::min(goal.moment_limit, count * static_cast<int>(std::bit_ceil(static_cast<unsigned>(times))));
    return more > count ? more : 0;
}
}
