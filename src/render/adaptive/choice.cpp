#include "render/adaptive/choice.h"

#include "modes/mode.h"

#include <algorithm>
#include <cassert>

namespace tyndall {
double noise_target(const Choice& choice, double error) {
    const double bound = choice.has_integrator ? choice.measured.integrator.bound : 0;
    if (bound == 0) return error;
    const double squared = error * error;
    if (bound < squared) return std::sqrt(squared - bound);
    return std::max(error * integrator_share, 0.1 * std::sqrt(bound));
}

bool leaves_room(const Choice& choice, double error) {
    return choice.measured.integrator.bound <= std::pow(integrator_share * error, 2);
}

Allotment Choice::spread(const AllotLimits& limits, int unit) const {
    assert(scout);
    AllotLimits of_scout = limits;
    of_scout.squared_error /= noise_ratio;
    Allotment result = allot(scout->layers, scout_samples, of_scout, power, unit);
    result.squared_error *= noise_ratio;
    return result;
}

double Choice::work_to(double error, double squared_integrator) const {
    const double left = error * error - squared_integrator;
    if (!(left > 0) || !scout) return infinity;
    const double pixels = static_cast<double>(scout->layers.size.x) * scout->layers.size.y;
    return spread({left, infinity}, scout_samples).rays / pixels * measured.sample_work;
}

double Choice::times_to(double error, double squared_integrator, const Noise& noise) const {
    const double left = error * error - squared_integrator;
    return left > 0 ? std::pow(noise.bound * noise.bound / left, 1 / power) : double{infinity};
}

double Choice::expected(double samples) const {
    if (samples < 2) return measured.integrator.value + measured.sample.value;
    if (!scout) return measured.integrator.value + measured.sample.value / std::pow(samples, power);
    const double pixels = static_cast<double>(scout->layers.size.x) * scout->layers.size.y;
    return measured.integrator.value + spread({0, samples * pixels}, scout_samples).squared_error;
}

double check_seconds(const Choice& choice) {
    if (!choice.has_integrator || choice.is_truth || !choice.pilot) return 0;
    const Pilot& pilot = *choice.pilot;
    const double own = choice.measured.sample_seconds * pilot.samples() / pilot.pixels();
    return (pilot.cost.seconds + own) / (pilot.drawings * pilot.passes);
}
}
