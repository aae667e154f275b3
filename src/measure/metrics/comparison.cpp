#include "measure/metrics/comparison.h"

#include "measure/metrics/ssim.h"

namespace tyndall {
namespace {
const Errors* find_layer(const Comparison& comparison, const std::string& name) {
    for (const auto& [own_name, errors] : comparison.layers)
        if (own_name == name) return &errors;
    return nullptr;
}

// Halves and variance estimate the image's noise; they are not compared as layers.
bool is_statistic(const std::string& name) { return name == "half_a" || name == "half_b" || name == "Variance"; }

double root_mean(const Image<vec3>& squares) {
    double sum = 0;
    for (const vec3 value : squares.pixels) sum += (static_cast<double>(value.x) + value.y + value.z) / 3;
    return std::sqrt(sum / static_cast<double>(squares.pixels.size()));
}

void add_halves(const ExrColors& test, const ExrColors& reference, Comparison& result) {
    const Image<vec3>*r1 = reference.layer("half_a"), *r2 = reference.layer("half_b");
    const Image<vec3>*a1 = test.layer("half_a"), *a2 = test.layer("half_b");
    if (!r1 || !r2) return;
    result.mse = product_of_errors(test.beauty, test.beauty, *r1, *r2);
    if (a1 && a2) result.bias_squared = product_of_errors(*a1, *a2, *r1, *r2);
}

// Mean over frames, taken as independent.
std::optional<Estimate> averaged(std::span<const Comparison> frames, std::optional<Estimate> Comparison::*member) {
    double sum = 0, variance = 0;
    for (const Comparison& frame : frames) {
        if (!(frame.*member)) return {};
        sum += (frame.*member)->value, variance += std::pow((frame.*member)->standard_error, 2);
    }
    const double count = static_cast<double>(frames.size());
    return Estimate{sum / count, std::sqrt(variance) / count};
}
}

Viewing viewing_of(const Image<vec3>& reference) {
    return {flip_exposures(reference), flip_pixels_per_degree, mean_luminance(reference)};
}

Viewing covering(std::span<const Viewing> frames) {
    Viewing all = frames[0];
    std::vector<FlipExposures> exposures;
    all.mean_luminance = 0;
    for (const Viewing& frame : frames) {
        exposures.push_back(frame.exposures);
        all.mean_luminance += frame.mean_luminance / static_cast<double>(frames.size());
    }
    all.exposures = covering(exposures);
    return all;
}

double Comparison::worst_rmse() const {
    const double own = relative(beauty.rmse, beauty.mean_reference);
    const Errors* fog = find_layer(*this, "inscatter");
    const double other = fog ? relative(fog->rmse, fog->mean_reference) : own;
    return other > own || std::isnan(other) ? other : own;
}

uint64_t Comparison::non_finite() const {
    uint64_t count = beauty.non_finite_test + beauty.non_finite_reference;
    for (const auto& [name, errors] : layers) count += errors.non_finite_test + errors.non_finite_reference;
    return count;
}

Comparison compare(const ExrColors& test, const ExrColors& reference, const Viewing& viewing, Image<float>* flip_map) {
    check_same_frame(test, reference);
    Comparison result;
    result.stylized = test.stylized || reference.stylized;
    result.beauty = measure_errors(test.beauty, reference.beauty);
    for (const auto& [name, image] : reference.layers)
        if (const Image<vec3>* own = test.layer(name); own && !is_statistic(name))
            result.layers.emplace_back(name, measure_errors(*own, image));
    result.ssim = ssim(test.beauty, reference.beauty, viewing.mean_luminance);
    Image<float> map = flip_hdr(test.beauty, reference.beauty, viewing.exposures, viewing.pixels_per_degree);
    result.flip = flip_mean(map);
    if (flip_map) *flip_map = std::move(map);
    result.flip_ldr = flip_mean(flip_ldr(test.beauty, reference.beauty, viewing.pixels_per_degree));
    if (const Image<vec3>* variance = test.layer("Variance")) result.noise = root_mean(*variance);
    add_halves(test, reference, result);
    return result;
}

Comparison pooled(std::span<const Comparison> frames) {
    Comparison all;
    std::vector<Errors> errors;
    double noise = 0;
    const bool noisy = std::ranges::all_of(frames, [](const Comparison& frame) { return frame.noise.has_value(); });
    for (const Comparison& frame : frames) {
        errors.push_back(frame.beauty);
        all.stylized |= frame.stylized;
        noise += std::pow(frame.noise.value_or(0), 2) / static_cast<double>(frames.size());
        all.flip_ldr += frame.flip_ldr / static_cast<double>(frames.size());
        all.ssim += frame.ssim / static_cast<double>(frames.size());
        all.flip += frame.flip / static_cast<double>(frames.size());
    }
    all.beauty = pooled(errors);
    if (noisy) all.noise = std::sqrt(noise);
    for (const auto& [name, first] : frames[0].layers) {
        errors.clear();
        for (const Comparison& frame : frames)
            if (const Errors* e = find_layer(frame, name)) errors.push_back(*e);
        if (errors.size() == frames.size()) all.layers.emplace_back(name, pooled(errors));
    }
    all.mse = averaged(frames, &Comparison::mse), all.bias_squared = averaged(frames, &Comparison::bias_squared);
    return all;
}
}
