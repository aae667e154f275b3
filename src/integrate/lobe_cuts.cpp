#include "integrate/lobe_cuts.h"

#include "volume/medium.h"

#include <algorithm>
#include <vector>

namespace tyndall {
namespace {
constexpr int max_angles = 16; // in the forward hemisphere; mirrored backward

// Angles in radians from the forward (or backward) direction between which a table falls off from its peak there.
// Quadrature must not cross them, because the falloff is not polynomial.
Interval<float> fall_of(const PhaseTable& table, bool back) {
    const size_t last = table.values.size() - 1;
    const auto value = [&](size_t i) { return table.values[back ? last - i : i]; };
    size_t high = 1;
    while (high < last && value(high) >= 0.5f * value(0)) ++high;
    const float steep = 0.05f * value(0);
    size_t low = high - 1;
    while (low > 0 && value(low - 1) - value(low) > steep) --low;
    while (high < last && value(high) - value(high + 1) > steep) ++high;
    const auto angle = [&](size_t i) { return static_cast<float>(std::acos(table.cosine(i))); };
    return {angle(low), angle(high)};
}

void add_angle(float angle, std::vector<float>& angles) {
    if (angle > 1e-3f && angle < 1) angles.push_back(angle);
}
}

LobeCuts lobe_cuts(std::span<const Medium> media) {
    float width = 1; // approximate lobe width, radians
    std::vector<float> angles;
    for (const Medium& medium : media) {
        const auto& shape = medium.optics.phase.shape;
        if (!shape) continue;
        width = std::min(width, 1 - shape->narrowest);
        if (!shape->lobes.empty()) continue;
        for (const bool back : {false, true}) {
            const Interval<float> fall = fall_of(shape->table, back);
            add_angle(fall.low, angles), add_angle(fall.high, angles);
        }
    }
    LobeCuts cuts;
    if (width > wide_lobe) return cuts;
    for (float angle = std::max(width, 1e-3f); angle < 1; angle *= 2) angles.push_back(angle);
    std::ranges::sort(angles);
    for (const float angle : angles)
        if (cuts.count < max_angles) cuts.slopes[cuts.count++] = -1 / std::tan(angle);
    for (int i = cuts.count - 1; i >= 0; --i) cuts.slopes[cuts.count++] = -cuts.slopes[i];
    return cuts;
}
}
