#include "volume/phase/shape.h"

#include <algorithm>

namespace tyndall {
PhaseShape shape_of(std::vector<PhaseLobe> lobes) {
    PhaseShape shape;
    double cosine = 0;
    for (const PhaseLobe& lobe : lobes) {
        cosine += lobe.weight * mean_cosine(lobe);
        shape.narrowest = std::max(shape.narrowest, static_cast<float>(std::abs(lobe.g)));
    }
    shape.mean_cosine = static_cast<float>(cosine), shape.lobes = std::move(lobes);
    return shape;
}

PhaseShape shape_of(PhaseTable table) {
    PhaseShape shape;
    shape.mean_cosine = static_cast<float>(mean_cosine(table));
    shape.narrowest = static_cast<float>(narrowness(table));
    shape.table = std::move(table);
    return shape;
}

// Selects a lobe in proportion to its weight and reuses u, rescaled, to sample its cosine.
double sampled_cosine(const PhaseShape& shape, double u) {
    if (shape.lobes.empty()) return sampled_cosine(shape.table, u);
    size_t i = 0;
    for (; i + 1 < shape.lobes.size() && u >= shape.lobes[i].weight; ++i) u -= shape.lobes[i].weight;
    return sampled_cosine(shape.lobes[i], std::clamp(u / shape.lobes[i].weight, 0.0, 1.0));
}

double cosine_cdf(const PhaseShape& shape, double cosine) {
    if (shape.lobes.empty()) return cosine_cdf(shape.table, cosine);
    double sum = 0;
    for (const PhaseLobe& lobe : shape.lobes) sum += lobe.weight * cosine_cdf(lobe, cosine);
    return sum;
}

// For lobes: over small intervals of the cosine, combines the minima of each lobe's factors.
double min_value(const PhaseShape& shape) {
    if (shape.lobes.empty()) return *std::ranges::min_element(shape.table.values);
    constexpr int pieces = 512;
    double least = infinity;
    for (int i = 0; i < pieces; ++i) {
        const double a = -1 + 2.0 * i / pieces, b = -1 + 2.0 * (i + 1) / pieces;
        const double square = a * b < 0 ? 0 : std::min(a * a, b * b);
        double sum = 0;
        for (PhaseLobe lobe : shape.lobes) {
            const double factor = (1 + lobe.alpha * square) / (1 + lobe.alpha * (1 + 2 * lobe.g * lobe.g) / 3);
            lobe.alpha = 0;
            sum += factor * std::min(lobe_value(lobe, a), lobe_value(lobe, b));
        }
        least = std::min(least, sum);
    }
    return least;
}
}
