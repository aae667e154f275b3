#include "integrate/lobe_cuts.h"

#include "base/gauss_legendre.h"
#include "volume/medium.h"

#include <algorithm>
#include <iterator>
#include <numbers>
#include <vector>

namespace tyndall {
namespace {
// Angles of rays at ±1, ±3 ... ±81 times the light's distance, where integration along rays is split anyway.
std::vector<double> usual_angles() {
    std::vector<double> angles{0};
    for (const double slope : {-81, -27, -9, -3, -1, 1, 3, 9, 27, 81}) angles.push_back(std::atan2(1, -slope));
    angles.push_back(std::numbers::pi);
    return angles;
}

// A table over the scattering angle in radians, with its integral up to each entry.
struct AngularTable {
    const PhaseTable& table;
    std::vector<double> angles, integrals;

    explicit AngularTable(const PhaseTable& from) : table(from), angles(from.values.size()), integrals(angles.size()) {
        for (size_t i = 0; i < angles.size(); ++i) {
            angles[i] = std::acos(std::clamp(table.cosine(i), -1.0, 1.0));
            if (i > 0)
                integrals[i] = integrals[i - 1] +
                               0.5 * (double{table.values[i]} + table.values[i - 1]) * (angles[i] - angles[i - 1]);
        }
    }

    size_t entry_at(double angle) const {
        return static_cast<size_t>(std::ranges::lower_bound(angles, angle) - angles.begin());
    }

    double slope(size_t i) const {
        return (double{table.values[i + 1]} - table.values[i]) / (angles[i + 1] - angles[i]);
    }

    // Error of quadrature with few nodes between two entries.
    double error(size_t low, size_t high) const {
        const double wide = angles[high] - angles[low], exact = integrals[high] - integrals[low];
        double worst = 0;
        for (const int nodes : {2, 4}) {
            double sum = 0;
            for (const QuadratureNode& node : gauss_legendre(nodes))
                sum += node.weight * table_value<double>(table, std::cos(angles[low] + node.at * wide));
            worst = std::max(worst, std::abs(sum * wide - exact));
        }
        return worst;
    }

    // The entry with the sharpest bend between two others, and not just beside them: a bend falls on two entries.
    size_t sharpest(size_t low, size_t high) const {
        const size_t margin = 1 + (high - low) / 64;
        size_t found = low + 1;
        double most = 0;
        for (size_t i = low + margin; i + margin <= high; ++i)
            if (const double bend = std::abs(slope(i) - slope(i - 1)); bend > most) most = bend, found = i;
        return found;
    }

    // Where to split so that the error becomes smallest: at the sharpest bend or at one of several regular places.
    size_t split(size_t low, size_t high) const {
        constexpr size_t places = 16;
        size_t best = sharpest(low, high);
        double least = error(low, best) + error(best, high);
        for (size_t place = 1; place < places; ++place) {
            const size_t at = low + (high - low) * place / places;
            if (at == low) continue;
            if (const double left = error(low, at) + error(at, high); left < least) least = left, best = at;
        }
        return best;
    }
};

// Entries of a table between which quadrature is off by `error`, of which `allowed` does no harm.
struct Part {
    size_t low, high;
    double error, allowed;

    double excess() const { return high - low < 2 ? 0 : error - allowed; }
};

// Adds the angles at which to split a table's integral for 0.3 % of each of the usual parts.
void add_angles(const PhaseTable& shape, std::vector<double>& angles) {
    constexpr double share = 3e-3, share_of_all = 1e-5;
    constexpr int most = 30;
    const AngularTable table(shape);
    std::vector<Part> parts;
    const std::vector<double> usual = usual_angles();
    for (size_t i = 0; i + 1 < usual.size(); ++i) {
        const size_t low = table.entry_at(usual[i]),
                     high = std::min(table.entry_at(usual[i + 1]), table.angles.size() - 1);
        if (low >= high) continue;
        const double allowed =
            share * (table.integrals[high] - table.integrals[low]) + share_of_all * table.integrals.back();
        parts.push_back({low, high, table.error(low, high), allowed});
    }
    for (int i = 0; i < most; ++i) {
        Part& worst = *std::ranges::max_element(parts, {}, &Part::excess);
        if (!(worst.excess() > 0)) return;
        const Part whole = worst;
        const size_t at = table.split(whole.low, whole.high);
        angles.push_back(table.angles[at]);
        worst = {whole.low, at, table.error(whole.low, at), whole.allowed / 2};
        parts.push_back({at, whole.high, table.error(at, whole.high), whole.allowed / 2});
    }
}

// Adds angles that double from a lobe's width on, forward and backward.
void add_angles(float width, std::vector<double>& angles) {
    if (width > wide_lobe) return;
    for (double angle = std::max(width, 1e-3f); angle < 1; angle *= 2)
        angles.push_back(angle), angles.push_back(std::numbers::pi - angle);
}
}

float narrowest_halo(const Medium& medium) {
    const auto& shape = medium.optics.phase.shape;
    if (!shape || !shape->lobes.empty()) return pi;
    const std::vector<float>& values = shape->table.values;
    const AngularTable table(shape->table);
    double narrowest = pi;
    for (size_t i = 1; i + 1 < values.size(); ++i) {
        if (!(values[i] > values[i - 1] && values[i] >= values[i + 1])) continue;
        size_t low = i, high = i;
        while (low > 0 && values[low] > 0.5f * values[i]) --low;
        while (high + 1 < values.size() && values[high] > 0.5f * values[i]) ++high;
        if (std::max(values[low], values[high]) <= 0.5f * values[i])
            narrowest = std::min(narrowest, table.angles[high] - table.angles[low]);
    }
    return static_cast<float>(narrowest);
}

LobeCuts lobe_cuts(std::span<const Medium> media) {
    std::vector<double> angles;
    float width = 1; // of the narrowest lobe, radians
    for (const Medium& medium : media)
        if (const auto& shape = medium.optics.phase.shape; shape && shape->lobes.empty())
            add_angles(shape->table, angles);
        else if (shape)
            width = std::min(width, 1 - shape->narrowest);
    add_angles(width, angles);
    std::ranges::sort(angles);
    angles.erase(std::ranges::unique(angles).begin(), angles.end());
    LobeCuts cuts;
    for (const double angle : angles)
        if (cuts.count < static_cast<int>(std::size(cuts.slopes)))
            cuts.slopes[cuts.count++] = static_cast<float>(-1 / std::tan(angle));
    return cuts;
}
}
