#include "viewer/painting/pace.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr double late = 1.15;      // times the wanted time
constexpr double in_time = 0.85;   // times the wanted time, for the predicted time of a larger image
constexpr double min_share = 0.25; // fraction of the wanted time that pixels always get
constexpr int retry_after = 60;

double area(int level) {
    const double scale = pace_scales[static_cast<size_t>(level)];
    return scale * scale;
}
}

void update_pace(Pace& pace, double seconds, double fixed) {
    const int last = static_cast<int>(pace_scales.size()) - 1, level = pace.level;
    const double pixels = std::max(seconds - fixed, 0.0);
    if (pace.retry_in > 0) --pace.retry_in;

    // Drop to a level that fits; do not retry the one that was too slow for a while.
    if (seconds > late * pace.wanted && level < last) {
        const double time = std::max(pace.wanted - fixed, min_share * pace.wanted);
        int lower = level;
        while (lower < last && pixels * area(lower) / area(level) > time) ++lower;
        if (lower != level) {
            pace.level = lower, pace.slow_level = level, pace.retry_in = retry_after;
            return;
        }
    }
    if (level == 0 || (pace.retry_in > 0 && level - 1 <= pace.slow_level)) return;
    const double time = std::max(in_time * pace.wanted - fixed, in_time * min_share * pace.wanted);
    if (pixels * area(level - 1) / area(level) < time) --pace.level;
}
}
