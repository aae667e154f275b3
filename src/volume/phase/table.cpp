#include "volume/phase/table.h"

#include <algorithm>
#include <cassert>
#include <numbers>

namespace tyndall {
namespace {
constexpr int min_half = 2048, max_half = 8192;
constexpr double circle = 2 * std::numbers::pi;

// Table coordinate of a cosine: 0 forward, 1 perpendicular, 2 backward.
double place_of(double cosine) {
    return cosine < 0 ? 2 - std::sqrt(1 + std::max(cosine, -1.0)) : std::sqrt(1 - std::min(cosine, 1.0));
}

// A power-of-two resolution at least twice as fine as `step` in table coordinates, within limits.
int half_for(double step) {
    int half = min_half;
    while (half < max_half && half * step < 2) half *= 2;
    return half;
}

PhaseTable empty_table(int half) {
    PhaseTable table{half, {}, {}};
    table.values.resize(static_cast<size_t>(2 * half + 1)), table.cdf.resize(table.values.size());
    return table;
}

// Integral between entry i and the next, linear in the cosine.
double cell_light(const PhaseTable& table, size_t i) {
    const double a = table.values[i], b = table.values[i + 1];
    return circle * 0.5 * (a + b) * (table.cosine(i) - table.cosine(i + 1));
}

// Fills a table with value(cosine), in any unit, and normalizes it; returns the original integral over the sphere.
template<class Value> double fill(PhaseTable& table, const Value& value) {
    std::vector<double> given(table.values.size());
    double sum = 0;
    for (size_t i = 0; i < given.size(); ++i) given[i] = value(table.cosine(i));
    for (size_t i = 0; i + 1 < given.size(); ++i)
        sum += circle * 0.5 * (given[i] + given[i + 1]) * (table.cosine(i) - table.cosine(i + 1));
    if (!(sum > 0)) return 0;
    for (size_t i = 0; i < given.size(); ++i) table.values[i] = static_cast<float>(given[i] / sum);
    for (size_t i = 0; i + 1 < given.size(); ++i) table.cdf[i + 1] = table.cdf[i] + cell_light(table, i);
    const double all = table.cdf.back();
    for (double& share : table.cdf) share /= all;
    return sum;
}

// Σ coefficient[l] P_l(c), by Bonnet's recursion.
double series(std::span<const double> coefficients, double c) {
    double sum = 0, last = 0, current = 1;
    for (size_t l = 0; l < coefficients.size(); ++l) {
        sum += coefficients[l] * current;
        const double next = ((2.0 * double(l) + 1) * c * current - double(l) * last) / (double(l) + 1);
        last = current, current = next;
    }
    return sum;
}
}

double PhaseTable::cosine(size_t i) const {
    const double place = static_cast<double>(i) / half;
    return place <= 1 ? 1 - place * place : (2 - place) * (2 - place) - 1;
}

PhaseTable make_table(std::span<const PhaseEntry> entries, PhaseTableNotes& notes) {
    assert(entries.size() > 1);
    std::vector<double> cosines;
    for (const PhaseEntry& entry : entries) cosines.push_back(std::cos(entry.angle / 180 * std::numbers::pi));
    double finest = 2;
    notes = {.integral = 0};
    for (size_t i = 0; i + 1 < entries.size(); ++i) {
        finest = std::min(finest, place_of(cosines[i + 1]) - place_of(cosines[i]));
        notes.integral += circle * 0.5 * (entries[i].value + entries[i + 1].value) * (cosines[i] - cosines[i + 1]);
    }
    PhaseTable table = empty_table(half_for(finest));
    size_t at = 0; // index of the entry before c; cosines are descending
    const double sum = fill(table, [&](double c) {
        while (at + 2 < cosines.size() && cosines[at + 1] > c) ++at;
        const double wide = cosines[at] - cosines[at + 1], share = wide > 0 ? (cosines[at] - c) / wide : 0;
        return entries[at].value + std::clamp(share, 0.0, 1.0) * (entries[at + 1].value - entries[at].value);
    });
    notes.kept = sum / notes.integral;
    return table;
}

PhaseTable make_table(std::span<const double> coefficients, PhaseTableNotes& notes) {
    assert(!coefficients.empty() && coefficients[0] > 0);
    // About 25 entries for the shortest wavelength of the series, 2π / degree.
    PhaseTable table = empty_table(half_for(0.25 / static_cast<double>(coefficients.size())));
    const double scale = 1 / (4 * std::numbers::pi);
    double below = 0, above = 0;
    fill(table, [&](double c) {
        const double value = scale * series(coefficients, c), wide = std::sqrt(1 - c * c);
        (value < 0 ? below : above) += std::abs(value) * wide; // entries are roughly uniform in the angle
        return std::max(value, 0.0);
    });
    notes = {.integral = coefficients[0], .negative = below / (above + below)};
    return table;
}

PhaseTable make_table(const std::function<double(double)>& value, double finest) {
    PhaseTable table = empty_table(half_for(finest / std::numbers::sqrt2)); // coordinates near forward: angle / √2
    fill(table, value);
    return table;
}

double mean_cosine(const PhaseTable& table) {
    double sum = 0;
    for (size_t i = 0; i + 1 < table.values.size(); ++i) {
        // ∫ c p dc of a linear segment, from its midpoint and slope.
        const double a = table.values[i], b = table.values[i + 1], wide = table.cosine(i) - table.cosine(i + 1);
        const double middle = 0.5 * (table.cosine(i) + table.cosine(i + 1));
        sum += circle * wide * (0.5 * (a + b) * middle + (a - b) * wide / 12);
    }
    return sum;
}

double sampled_cosine(const PhaseTable& table, double u) {
    const double share = 1 - u;
    const auto after = std::ranges::upper_bound(table.cdf, share);
    const size_t last = table.values.size() - 2;
    const size_t i = std::min(static_cast<size_t>(std::max<std::ptrdiff_t>(after - table.cdf.begin() - 1, 0)), last);
    const double inside = table.cdf[i + 1] - table.cdf[i];
    const double r = inside > 0 ? std::clamp((share - table.cdf[i]) / inside, 0.0, 1.0) : 0.5;
    // Invert the CDF of a linear segment: a x + (b - a) x² / 2 = r (a + b) / 2.
    const double a = table.values[i], b = table.values[i + 1], root = std::sqrt(a * a + r * (b * b - a * a));
    const double x = a + root > 0 ? std::min(r * (a + b) / (a + root), 1.0) : r;
    return table.cosine(i) + x * (table.cosine(i + 1) - table.cosine(i));
}

double cosine_cdf(const PhaseTable& table, double cosine) {
    const auto i = std::min(static_cast<size_t>(place_of(cosine) * table.half), table.values.size() - 2);
    const double a = table.values[i], wide = table.cosine(i) - table.cosine(i + 1);
    const double x = std::clamp((table.cosine(i) - cosine) / wide, 0.0, 1.0), b = a + x * (table.values[i + 1] - a);
    return 1 - (table.cdf[i] + circle * 0.5 * (a + b) * x * wide);
}

double narrowness(const PhaseTable& table) {
    const size_t last = table.values.size() - 1;
    size_t i = 1;
    for (; i < last; ++i) {
        const float ahead = table.values[i], back = table.values[last - i];
        if (ahead < 0.5f * table.values[0] || back < 0.5f * table.values[last]) break;
    }
    // An HG lobe falls to half its peak at θ = 0.77 (1 - g), for g near 1.
    const double angle = std::acos(table.cosine(i));
    return std::clamp(1 - angle / 0.77, 0.0, 0.999);
}
}
