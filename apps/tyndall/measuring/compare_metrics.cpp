// The metrics of tyndall compare by name.
#include "measuring/compare_report.h"

#include "base/error.h"
#include "base/text.h"

namespace tyndall {
namespace {
using Value = std::optional<double>;

double share(const CompareResult& r, double error) { return relative(error, r.overall.beauty.mean_reference); }
}

const std::vector<Metric>& metrics() {
    static const std::vector<Metric> table{
        {"E", "rmse_rel of the image or of its fog light (inscatter), the worse of both",
         [](const CompareResult& r) -> Value { return r.overall.worst_rmse(); }},
        {"rmse_rel", "root of the mean squared difference / mean of the reference",
         [](const CompareResult& r) -> Value { return share(r, r.overall.beauty.rmse); }},
        {"bias_rel", "mean difference / mean of the reference; its absolute value counts",
         [](const CompareResult& r) -> Value { return share(r, r.overall.beauty.bias); }},
        {"mae_rel", "mean absolute difference / mean of the reference",
         [](const CompareResult& r) -> Value { return share(r, r.overall.beauty.mae); }},
        {"p95_rel", "95th percentile of the differences / mean of the reference",
         [](const CompareResult& r) -> Value { return share(r, r.overall.beauty.p95); }},
        {"p99_9_rel", "99.9th percentile of the differences / mean of the reference",
         [](const CompareResult& r) -> Value { return share(r, r.overall.beauty.p99_9); }},
        {"max_rel", "largest difference / mean of the reference",
         [](const CompareResult& r) -> Value { return share(r, r.overall.beauty.most); }},
        {"rmse", "as rmse_rel, but in units of the image, like the next five",
         [](const CompareResult& r) -> Value { return r.overall.beauty.rmse; }},
        {"bias", "mean difference", [](const CompareResult& r) -> Value { return r.overall.beauty.bias; }},
        {"mae", "mean absolute difference", [](const CompareResult& r) -> Value { return r.overall.beauty.mae; }},
        {"p95", "95th percentile", [](const CompareResult& r) -> Value { return r.overall.beauty.p95; }},
        {"p99_9", "99.9th percentile", [](const CompareResult& r) -> Value { return r.overall.beauty.p99_9; }},
        {"max", "largest difference", [](const CompareResult& r) -> Value { return r.overall.beauty.most; }},
        {"rel_mse", "mean of squared difference / (squared reference + 0.01), scaled to a mean of 1",
         [](const CompareResult& r) -> Value { return r.overall.beauty.rel_mse; }},
        {"rel_mse_trimmed", "the same without the largest 0.1 % of the terms",
         [](const CompareResult& r) -> Value { return r.overall.beauty.rel_mse_trimmed; }},
        {"ssim_loss", "1 - SSIM, structural similarity of what a display shows",
         [](const CompareResult& r) -> Value { return 1 - r.overall.ssim; }},
        {"flip", "mean HDR-FLIP: visible difference when flipping between both, 0 to 1",
         [](const CompareResult& r) -> Value { return r.overall.flip; }},
        {"flip_ldr", "mean LDR-FLIP: of the images as stored, clamped to 0..1",
         [](const CompareResult& r) -> Value { return r.overall.flip_ldr; }},
        {"noise_rel", "standard error of the image / mean of the reference, if it has a layer Variance",
         [](const CompareResult& r) { return r.overall.noise ? Value(share(r, *r.overall.noise)) : Value(); }},
        {"flicker", "changes between frames that the reference does not have / mean of the reference",
         [](const CompareResult& r) { return r.frames.size() > 1 ? Value(r.flicker) : Value(); }},
        {"mse_unbiased", "mean squared difference without the noise of a reference with half_a, half_b",
         [](const CompareResult& r) { return r.overall.mse ? Value(r.overall.mse->value) : Value(); }},
        {"bias_squared", "squared bias without noise, if both files have half_a and half_b",
         [](const CompareResult& r) {
             return r.overall.bias_squared ? Value(r.overall.bias_squared->value) : Value();
         }},
    };
    return table;
}

Bound parsed_bound(const std::string& text) {
    const size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    std::vector<std::string> names;
    for (const Metric& metric : metrics()) {
        names.push_back(metric.name);
        if (metric.name == name && equals != text.npos)
            return {&metric, number_option("--fail-above", text.substr(equals + 1), 0, 1e300)};
    }
    const std::string wrong = equals == text.npos
                                  ? "expected METRIC=VALUE, as in rmse_rel=0.05; got '" + printable(text, 40) + "'"
                                  : unknown_name("metric", name, names);
    fail(ExitCode::usage, "--fail-above", wrong);
}
}
