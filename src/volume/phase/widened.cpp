// Phase functions averaged over discs, as for lights of finite angular size.
#include "volume/phase.h"

#include <numbers>

namespace tyndall {
namespace {
// Mean over a disc whose center lies at `angle` from the forward axis (side 1) or the backward axis (side -1): sums
// rings around that axis, each weighted by its arc inside the disc. Rings are finest near the axis, where lobes are
// narrow.
double mean_over_disc(const PhaseShape& shape, double side, double angle, double radius) {
    constexpr int rings = 200;
    const double low = std::max(angle - radius, 0.0), high = angle + radius;
    double light = 0, area = 0, from = low;
    for (int i = 1; i <= rings; ++i) {
        const double share = static_cast<double>(i) / rings, to = low + (high - low) * share * share;
        const double ring = 0.5 * (from + to);
        double arc = std::numbers::pi;
        if (ring > radius - angle) {
            const double over = std::cos(radius) - std::cos(angle) * std::cos(ring),
                         below = std::max(std::sin(angle) * std::sin(ring), 1e-12);
            arc = std::acos(std::clamp(over / below, -1.0, 1.0));
        }
        const double weight = arc * std::sin(ring) * (to - from);
        light += weight * shape_value<double>(shape, side * std::cos(ring)), area += weight;
        from = to;
    }
    return light / area;
}
}

Phase widened(const Phase& phase, double radius) {
    const PhaseShape& shape = *phase.shape;
    const auto value = [&](double cosine) {
        const double side = cosine < 0 ? -1 : 1, angle = std::acos(std::min(std::abs(cosine), 1.0));
        return angle < 10 * radius ? mean_over_disc(shape, side, angle, radius) : shape_value<double>(shape, cosine);
    };
    return table_phase(PhaseKind::table, make_table(value, radius / 12));
}
}
