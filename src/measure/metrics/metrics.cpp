#include "measure/metrics/metrics.h"

#include <cassert>

namespace tyndall {
namespace {
constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
constexpr double rel_mse_epsilon = 0.01, rel_mse_outliers = 0.001;

// The smallest value that at least `share` of the values do not exceed. Reorders them.
double percentile(std::vector<double>& values, double share) {
    const double rank = std::ceil(share * static_cast<double>(values.size()) - 1e-9);
    const auto at = values.begin() + static_cast<ptrdiff_t>(std::max(rank, 1.0)) - 1;
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

double mean(const std::vector<double>& values, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; ++i) sum += values[i];
    return sum / static_cast<double>(count);
}

// Means and squares; |I − R| of every value goes to `magnitudes`.
void add_up(const Image<vec3>& test, const Image<vec3>& reference, Errors& e, std::vector<double>& magnitudes) {
    double squares = 0;
    for (size_t i = 0; i < test.pixels.size(); ++i) {
        const dvec3 t = test.pixels[i], r = reference.pixels[i], error = t - r;
        e.non_finite_test += !is_finite(test.pixels[i]), e.non_finite_reference += !is_finite(reference.pixels[i]);
        if (!comparable(test.pixels[i], reference.pixels[i])) continue;
        ++e.pixels;
        e.mean_test += t.x + t.y + t.z, e.mean_reference += r.x + r.y + r.z, e.bias += error.x + error.y + error.z;
        squares += glm::dot(error, error);
        for (int c = 0; c < 3; ++c) magnitudes.push_back(std::abs(error[c]));
    }
    const double values = 3 * static_cast<double>(e.pixels);
    e.mean_test /= values, e.mean_reference /= values, e.bias /= values;
    e.rmse = std::sqrt(squares / values);
}

// Terms of relMSE; multiplying numerator and denominator by mean² avoids scaling the images.
void add_rel_mse(const Image<vec3>& test, const Image<vec3>& reference, Errors& e) {
    if (e.rmse == 0 || !(e.mean_reference > 0)) {
        e.rel_mse = e.rel_mse_trimmed = relative(e.rmse, e.mean_reference);
        return;
    }
    const double epsilon = rel_mse_epsilon * e.mean_reference * e.mean_reference;
    std::vector<double> terms;
    terms.reserve(3 * e.pixels);
    for (size_t i = 0; i < test.pixels.size(); ++i) {
        if (!comparable(test.pixels[i], reference.pixels[i])) continue;
        for (int c = 0; c < 3; ++c) {
            const double r = reference.pixels[i][c], error = test.pixels[i][c] - r;
            terms.push_back(error * error / (r * r + epsilon));
        }
    }
    e.rel_mse = mean(terms, terms.size());
    const size_t kept = terms.size() - static_cast<size_t>(rel_mse_outliers * static_cast<double>(terms.size()));
    std::nth_element(terms.begin(), terms.begin() + static_cast<ptrdiff_t>(kept) - 1, terms.end());
    e.rel_mse_trimmed = mean(terms, kept);
}
}

Image<vec3> minus(const Image<vec3>& a, const Image<vec3>& b) {
    Image<vec3> result = a;
    for (size_t i = 0; i < result.pixels.size(); ++i) result.pixels[i] -= b.pixels[i];
    return result;
}

double relative(double error, double mean_reference) {
    if (error == 0 || std::isnan(error)) return error;
    return mean_reference > 0 ? error / mean_reference : std::copysign(std::numeric_limits<double>::infinity(), error);
}

Errors measure_errors(const Image<vec3>& test, const Image<vec3>& reference) {
    assert(test.size == reference.size);
    Errors e;
    std::vector<double> magnitudes;
    magnitudes.reserve(3 * test.pixels.size());
    add_up(test, reference, e, magnitudes);
    if (e.pixels == 0) {
        e.mae = e.p95 = e.p99_9 = e.most = e.rel_mse = e.rel_mse_trimmed = undefined;
        return e;
    }
    e.mae = mean(magnitudes, magnitudes.size());
    e.p95 = percentile(magnitudes, 0.95), e.p99_9 = percentile(magnitudes, 0.999), e.most = percentile(magnitudes, 1);
    add_rel_mse(test, reference, e);
    return e;
}

Errors pooled(std::span<const Errors> frames) {
    Errors all;
    for (const Errors& e : frames) all.pixels += e.pixels;
    double square = 0;
    for (const Errors& e : frames) {
        all.non_finite_test += e.non_finite_test, all.non_finite_reference += e.non_finite_reference;
        if (e.pixels == 0) continue;
        const double weight = static_cast<double>(e.pixels) / static_cast<double>(all.pixels);
        all.mean_test += weight * e.mean_test, all.mean_reference += weight * e.mean_reference;
        all.bias += weight * e.bias, all.mae += weight * e.mae, square += weight * e.rmse * e.rmse;
        all.rel_mse += weight * e.rel_mse, all.rel_mse_trimmed += weight * e.rel_mse_trimmed;
        all.p95 = std::max(all.p95, e.p95), all.p99_9 = std::max(all.p99_9, e.p99_9);
        all.most = std::max(all.most, e.most);
    }
    all.rmse = std::sqrt(square);
    if (all.pixels == 0) {
        all.mean_test = all.mean_reference = all.bias = all.rmse = all.mae = undefined;
        all.p95 = all.p99_9 = all.most = all.rel_mse = all.rel_mse_trimmed = undefined;
    }
    return all;
}

void Flicker::add_frame(const Image<vec3>& test, const Image<vec3>& reference) {
    assert(test.size == reference.size && (error_.empty() || error_.size == test.size));
    const bool first = error_.empty();
    if (first) error_ = Image<vec3>(test.size);
    for (size_t i = 0; i < test.pixels.size(); ++i) {
        const vec3 r = reference.pixels[i], error = test.pixels[i] - r;
        const dvec3 change = dvec3(error) - dvec3(error_.pixels[i]);
        error_.pixels[i] = error;
        if (is_finite(r)) reference_ += double{r.x} + r.y + r.z, values_ += 3;
        if (first || !std::isfinite(glm::dot(change, change))) continue;
        squares_ += glm::dot(change, change), differences_ += 3;
    }
}

double Flicker::value() const {
    if (differences_ == 0) return undefined;
    return relative(std::sqrt(squares_ / static_cast<double>(differences_)), reference_ / static_cast<double>(values_));
}
}
