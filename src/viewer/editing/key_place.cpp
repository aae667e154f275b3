#include "viewer/editing/key_place.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
KeyLookup find_key(std::span<const float> times, bool loop, double seconds, double frame_rate) {
    const double first = times.front(), length = times.back() - first, reach = 0.05 / frame_rate;
    const bool turns = loop && length > 0;
    if (turns) seconds = first + (seconds - first) - std::floor((seconds - first) / length) * length;

    // The end of a loop is the start of the next.
    const auto near = [&](float time) {
        return std::abs(time - seconds) <= reach || time == static_cast<float>(seconds);
    };
    if (turns && (near(times.front()) || near(times.back()))) return {0, true, true, times.front()};
    const auto after = std::lower_bound(times.begin(), times.end(), seconds);
    const size_t index = after - times.begin();
    const bool onto = index < times.size() && near(times[index]), behind = index > 0 && near(times[index - 1]);
    if (behind && !(onto && times[index] - seconds < seconds - times[index - 1]))
        return {index - 1, true, false, times[index - 1]};
    return {index, onto, false, onto ? times[index] : static_cast<float>(seconds)};
}
}
